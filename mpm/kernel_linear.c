/* kernel_linear.c: the passes over points with the linear basis. It has no stable step at frozen points (one just behind a node); the figure is what it bears
 * in practice. Loads are those of points, which is all it knows. */
#ifndef AXISYMMETRIC
#define AXISYMMETRIC 0
#endif
#define NODES 2
#define GIMP 0
#define SPLINE 0
#define BASIS "linear"
#define COURANT 0.664, 0.664, 0.664, 0.664, 0.664, 0.664, 0.664, 0.664
#define CARRY NULL
#if AXISYMMETRIC
#define NAME(f) f##_linear_axisymmetric
#else
#define NAME(f) f##_linear
#endif
#include "mpm/kernel.inc"
