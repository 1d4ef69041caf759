/* kernel_gimp.c: the passes over points with the generalised interpolation (GIMP) basis. */
#define NODES 3
#define GIMP 1
#define BASIS "gimp"
#define NAME(f) f##_gimp
#include "mpm/kernel.inc"
