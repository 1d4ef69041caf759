/* kernel_bspline2.c: the passes over points with quadratic B-splines. */
#define NODES 3
#define GIMP 0
#define SPLINE 1
#define BASIS "bspline2"
#define COURANT                                                                                                                            \
    { 0.954, 1.023 }
#define CARRY carry_bspline2
#define NAME(f) f##_bspline2
#include "mpm/kernel.inc"
