/* kernel_bspline3_axisymmetric.c: mpm/kernel_bspline3.c once more, for rings about an axis. */
#define AXISYMMETRIC 1
#include "mpm/kernel_bspline3.c"
