/* kernel_cpdi_axisymmetric.c: mpm/kernel_cpdi.c once more, for rings about an axis. */
#define AXISYMMETRIC 1
#include "mpm/kernel_cpdi.c"
