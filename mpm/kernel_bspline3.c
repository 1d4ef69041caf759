/* kernel_bspline3.c: the passes over points with cubic B-splines. */
#ifndef AXISYMMETRIC
#define AXISYMMETRIC 0
#endif
#define NODES 4
#define GIMP 0
#define SPLINE 1
#define BASIS "bspline3"
#define COURANT 1.404, 1.472, 1.489, 1.496, 1.498, 1.499, 1.500, 1.500
#define LIGHT 0 /* nodes two beyond the face have no heavy one beside them */
#define CARRY NAME(carry)
#if AXISYMMETRIC
#define NAME(f) f##_bspline3_axisymmetric
#else
#define NAME(f) f##_bspline3
#endif
#include "mpm/kernel.inc"
