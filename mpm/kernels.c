/* kernels.c: the bases there are. */
#include <string.h>

#include "mpm/body.h"

extern const mpm_kernel mpm_kernel_linear, mpm_kernel_gimp, mpm_kernel_bspline2, mpm_kernel_bspline3, mpm_kernel_cpdi;
extern const mpm_kernel mpm_kernel_linear_axisymmetric, mpm_kernel_gimp_axisymmetric, mpm_kernel_bspline2_axisymmetric,
    mpm_kernel_bspline3_axisymmetric, mpm_kernel_cpdi_axisymmetric;

const mpm_kernel *mpm_kernel_of(const char *basis, ab_space space) {
    static const mpm_kernel *const kernels[] = {&mpm_kernel_linear, &mpm_kernel_gimp, &mpm_kernel_bspline2, &mpm_kernel_bspline3,
                                                &mpm_kernel_cpdi};
    static const mpm_kernel *const rings[] = {&mpm_kernel_linear_axisymmetric, &mpm_kernel_gimp_axisymmetric,
                                              &mpm_kernel_bspline2_axisymmetric, &mpm_kernel_bspline3_axisymmetric,
                                              &mpm_kernel_cpdi_axisymmetric};
    const mpm_kernel *const *list = space == AB_SPACE_AXISYMMETRIC ? rings : kernels;
    for (size_t k = 0; k < sizeof kernels / sizeof *kernels; ++k)
        if (!strcmp(list[k]->basis, basis)) return list[k];
    return NULL;
}
