/* kernel_bspline2.c: the passes over points with quadratic B-splines. */
#ifndef AXISYMMETRIC
#define AXISYMMETRIC 0
#endif
#define NODES 3
#define GIMP 0
#define SPLINE 1
#define BASIS "bspline2"
#define COURANT 0.866, 0.954, 0.999, 1.023, 1.044, 1.063, 1.078, 1.091
#define LIGHT (AXISYMMETRIC ? 0 : 0.05)
#define CARRY NAME(carry)
#if AXISYMMETRIC
#define NAME(f) f##_bspline2_axisymmetric
#else
#define NAME(f) f##_bspline2
#endif
#include "mpm/kernel.inc"
