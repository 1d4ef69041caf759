/* kernel_bspline2_axisymmetric.c: mpm/kernel_bspline2.c once more, for rings about an axis. */
#define AXISYMMETRIC 1
#include "mpm/kernel_bspline2.c"
