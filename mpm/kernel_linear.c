/* kernel_linear.c: the passes over points with the linear basis. That it has a stable step at frozen points is owed to light_nodes.c: a point just behind a node
 * leaves it next to no mass. Loads are those of points, which is all it knows. */
#ifndef AXISYMMETRIC
#define AXISYMMETRIC 0
#endif
#define NODES 2
#define GIMP 0
#define SPLINE 0
#define BASIS "linear"
#define COURANT 0.564, 0.664, 0.632, 0.664, 0.664, 0.664, 0.664, 0.664 /* over places in both directions, nu up to 0.45: tests/verification/study_light_nodes.py */
#define LIGHT (AXISYMMETRIC ? 0 : 0.15) /* not where masses grow with the radius: those at the axis are no slivers */
#define CARRY NULL
#if AXISYMMETRIC
#define NAME(f) f##_linear_axisymmetric
#else
#define NAME(f) f##_linear
#endif
#include "mpm/kernel.inc"
