/* dashpots.h: the dashpots of an edge, a rho c_p along its normal and b rho c_s across it (Lysmer and Kuhlemeyer 1969), beside springs along and across. */
#ifndef ABUT_DASHPOTS_H
#define ABUT_DASHPOTS_H

#include "abut_plugin.h"

typedef struct edge_resistance { /* along the normal, across it */
    double damping[2];           /* Pa s/m */
    double stiffness[2];         /* Pa/m */
} edge_resistance;

static inline edge_resistance edge_dashpots(const ab_edges *e, size_t i, double a, double b) {
    return (edge_resistance){.damping = {a * e->density[i] * e->p_wave_speed[i], b * e->density[i] * e->s_wave_speed[i]}};
}

/* Adds -resistance . (velocity, displacement) to the traction on edge i: velocity is that of the edge less far_velocity (NULL: at rest; dimension numbers). */
static inline void edge_resist(const edge_resistance *r, ab_edges *e, size_t i, const double *far_velocity) {
    double along = 0.0, stretched = 0.0;
    for (size_t c = 0; c < e->dimension; ++c) {
        const double n = e->normal[c * e->ld + i];
        along += (e->velocity[c * e->ld + i] - (far_velocity ? far_velocity[c] : 0.0)) * n;
        stretched += e->displacement[c * e->ld + i] * n;
    }
    for (size_t c = 0; c < e->dimension; ++c) {
        const double n = e->normal[c * e->ld + i], v = e->velocity[c * e->ld + i] - (far_velocity ? far_velocity[c] : 0.0),
                     u = e->displacement[c * e->ld + i];
        e->traction[c * e->ld + i] -= r->damping[0] * along * n + r->damping[1] * (v - along * n) + r->stiffness[0] * stretched * n +
                                      r->stiffness[1] * (u - stretched * n);
    }
    for (size_t k = 0; k < 2; ++k) {
        if (e->damping) e->damping[k * e->ld + i] = r->damping[k];
        if (e->stiffness) e->stiffness[k * e->ld + i] = r->stiffness[k];
    }
}

#endif
