/* kernel_gimp_axisymmetric.c: mpm/kernel_gimp.c once more, for rings about an axis. */
#define AXISYMMETRIC 1
#include "mpm/kernel_gimp.c"
