/* kernels.c: the bases there are. */
#include <string.h>

#include "mpm/body.h"

extern const mpm_kernel mpm_kernel_linear, mpm_kernel_gimp, mpm_kernel_bspline2, mpm_kernel_bspline3, mpm_kernel_cpdi;

const mpm_kernel *mpm_kernel_of(const char *basis) {
    static const mpm_kernel *const kernels[] = {&mpm_kernel_linear, &mpm_kernel_gimp, &mpm_kernel_bspline2, &mpm_kernel_bspline3,
                                                &mpm_kernel_cpdi};
    for (size_t k = 0; k < sizeof kernels / sizeof *kernels; ++k)
        if (!strcmp(kernels[k]->basis, basis)) return kernels[k];
    return NULL; /* the scene knows no other words */
}
