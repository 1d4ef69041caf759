/* axisymmetric.h: what the passes over points need besides where x is the radius r, y is z and points are rings (torsion apart). Inside mpm/ only.
 *
 * A point stands for the ring that its area A sweeps about the axis, V = 2 pi r A, m = rho V; forces are those on whole rings. The internal force gains the hoops'
 *   f_r = - sum V (G_r s_rr + G_z s_rz + (N/r) s_tt),   f_z = - sum V (G_r s_rz + G_z s_zz),   hoop rate v_r/r = sum N v_i / r
 * (Sulsky and Schreyer 1996). Masses and velocities go with the weights of the plane, which keep linear precision: v_r = a r strains by a in both directions,
 * exactly, and a ring's radius grows as its hoop does.
 *
 * Equilibrium of a uniform stress s asks for sum V (G_r + N/r) = 0 at nodes inside, that is for the integral of d(r N)/dr over the domains, which cancels from
 * neighbour to neighbour. With domains (gimp) the mean of N over r, weighted by r, is N/r as it stands (N the mean of the plane), and that of dN/dr is
 *   G_r = integral of r dN/dr dr / (2 l r):
 * where a domain lies in two cells, the outer of them counts for more (Nairn and Guilkey 2015, "Axisymmetric form of the generalized interpolation material point
 * method", weight everything so; masses and velocities would lose linear precision by it). Points alone (linear, splines) take both where they are. */
#ifndef AB_MPM_AXISYMMETRIC_H
#define AB_MPM_AXISYMMETRIC_H

#include "core/vector.h"

/* 1/r, 1/m; of a point that has strayed onto the axis that of a radius too small to matter. */
static inline __attribute__((always_inline)) v8 mpm_inverse_radius(v8 radius) { return v8_set(1.0) / v8_max(radius, v8_set(1e-12)); }

/* Slopes of three nodes weighted by r. In the parts f0, f1 of the domain in the inner and the outer cell, whose slopes are 1/h, r is l f1 less and l f0 more than in
 * the middle; slenderness: l/r, 1 at most, as no domain reaches beyond the axis. */
static inline __attribute__((always_inline)) void mpm_weigh_by_radius(v8 slenderness, v8 h, v8 g[3]) {
    const v8 shift = -v8_min(slenderness, v8_set(1.0)) * h * g[0] * g[2];
    g[0] += shift;
    g[2] += shift;
    g[1] = -(g[0] + g[2]);
}

#endif
