/* light_mass.c: motion of the nodes that light ones go by, with the mass that goes with it. With v_i = sum_j w_ij v_j at light nodes the kinetic energy is that of
 *     M = D + sum_i m_i w_i w_i^T,   D the nodes' own masses.
 * Lumped, M_j = m_j + sum_i w_ij m_i, it keeps the momentum, but not its moment: a light node's part of that is m_i x_i x v_i, and w (x x v) at its line is not. Affine transfers, which keep
 * angular momentum to rounding, solve with M itself: T^T m T v = T^T p for T = (1, w), and as rigid motions are of the form T v, both momenta of v are those of p. M is
 * a lumped matrix but for a row of nodes along the edge, and conjugate gradients by the lumped masses find it in some ten steps.
 * Stress, loads, boundaries, contact and damping work on velocities one by one, and so by the lumped masses. What they have given together, sum J, is given anew by M at the step's
 * end (mpm_light_settle). Part by part would not do: where two that balance, a dashpot and the stress behind it, went by different masses, a twentieth of each would be left. */
#include <stdbool.h>
#include <stddef.h>

#include "core/memory.h"
#include "mpm/body.h"

enum { MOST_STEPS = 60 };
static const double SMALL = 1e-33; /* of r.M^-1.r at first: rounding */

static double *record(const mpm_body *body, uint32_t dof) { return body->own + (size_t)dof * OWN_RECORD; }

bool mpm_light_mass_reserve(mpm_body *body) {
    return body->finish != MPM_FINISH_AFFINE || !body->kernel->moment || body->work_capacity >= 5 * body->line_capacity ||
           ab_memory_grow((void **)&body->work, &body->work_capacity, 5 * body->line_capacity, sizeof *body->work);
}

bool mpm_light_mass_consistent(const mpm_body *body) { return body->finish == MPM_FINISH_AFFINE && body->kernel->moment; }

/* q = M d in direction c. */
static void multiply(const mpm_body *body, size_t c, const double *d, double *q) {
    for (size_t k = 0; k < body->line_count; ++k) q[k] = record(body, body->lines[k])[OWN_MASS] * d[k];
    for (size_t k = 0; k < body->tie_count; ++k) {
        const mpm_tie *t = body->ties + k;
        const double *own = record(body, t->dof);
        if (own[OWN_INVERSE + c] == 0.0) continue;
        double line = 0.0;
        for (int e = 0; e < t->count; ++e) line += t->weight[e] * d[mpm_light_line(body, t->to[e])];
        for (int e = 0; e < t->count; ++e) q[mpm_light_line(body, t->to[e])] += t->weight[e] * own[OWN_MASS] * line;
    }
}

/* z = r over the lumped masses, 0 where a side holds the node; r.z. */
static double lump(const mpm_body *body, size_t c, const double *r, double *z) {
    double sum = 0.0;
    for (size_t k = 0; k < body->line_count; ++k) {
        z[k] = r[k] * record(body, body->lines[k])[OWN_INVERSE + c];
        sum += r[k] * z[k];
    }
    return sum;
}

void mpm_light_mass_solve(mpm_body *body, size_t c) {
    const size_t n = body->line_count;
    double *r = body->work, *x = r + n, *z = x + n, *d = z + n, *q = d + n;
    for (size_t k = 0; k < n; ++k) x[k] = 0.0;
    double rz = lump(body, c, r, z);
    const double least = SMALL * rz;
    for (size_t k = 0; k < n; ++k) d[k] = z[k];
    for (int step = 0; step < MOST_STEPS && rz > least; ++step) {
        multiply(body, c, d, q);
        double dq = 0.0;
        for (size_t k = 0; k < n; ++k) dq += d[k] * q[k];
        const double part = rz / dq;
        for (size_t k = 0; k < n; ++k) {
            x[k] += part * d[k];
            r[k] -= part * q[k];
        }
        const double before = rz;
        rz = lump(body, c, r, z);
        for (size_t k = 0; k < n; ++k) d[k] = z[k] + rz / before * d[k];
    }
}
