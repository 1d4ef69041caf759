/* kernel_linear_axisymmetric.c: mpm/kernel_linear.c once more, for rings about an axis. */
#define AXISYMMETRIC 1
#include "mpm/kernel_linear.c"
