/* kernel_linear.c: the passes over points with the linear basis. */
#define NODES 2
#define GIMP 0
#define BASIS "linear"
#define NAME(f) f##_linear
#include "mpm/kernel.inc"
