/* damping.c: local damping of a body of points, and what the ledger says of it.
 *
 * FLIP adds to the velocities of points what nodes change by, v_p += sum N_i dv_i. With v_i = sum N_i m_p v_p / m_i before and v_i' after it, mapped from the points,
 *     sum m_p v_p'^2/2 - sum m_p v_p^2/2 = sum_i m_i dv_i (v_i + v_i')/2
 * to rounding, so a part of dv_i takes from the points its share of the right side. (v_i + dv_i is not v_i': a single point sees the mean of its nodes' changes alone, and of what
 * nodes are damped in against each other it has nothing.) v_i' is there with the updates that map velocities back. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "mpm/body.h"
#include "mpm/share.h"

static const double LIGHT = 1e-4; /* of a point's mass: nodes with less are thrown about by a finite stress, which the points hardly see */

/* Points keep a motion of their own; with the other transfers they take theirs from the nodes anew in each step. */
static bool has_own_motion(const mpm_body *body) { return body->finish == MPM_FINISH_BLEND && body->flip > 0.0; }

bool mpm_damp_reserve(mpm_body *body, size_t tiles) {
    const ab_scene *scene = body->scene;
    bool wanted = scene->damping_local > 0.0;
    for (size_t k = 0; k < scene->stage_count; ++k) wanted = wanted || scene->stages[k].local > 0.0;
    if (!wanted || !mpm_maps_back(body->update) || !has_own_motion(body)) return true;
    return ab_memory_grow((void **)&body->damped, &body->damped_capacity, tiles, 2 * sizeof(double) * AB_TILE_NODES);
}

size_t mpm_damp_bytes(const mpm_body *body) { return body->damped_capacity * 2 * sizeof(double) * AB_TILE_NODES; }

void mpm_damp_destroy(mpm_body *body) { ab_memory_give(body->damped, mpm_damp_bytes(body)); }

static double mass_of(const mpm_body *body, const double *own, int c) {
    return body->tie_count && own[OWN_INVERSE + c] > 0.0 ? 1.0 / own[OWN_INVERSE + c] : own[OWN_MASS];
}

/* Local non-viscous damping (Cundall 1987): against the velocity, in proportion to the force out of balance, here all that changed the node's velocity
 * in this step, contact and sides included; so a body at rest on another is not held up by it. It never turns a velocity round. Light nodes are left alone. */
void mpm_damp(mpm_body *body, const ab_step *step) {
    double taken = 0.0;
    for (size_t n = 0; n < body->tile_count * AB_TILE_NODES; ++n) {
        double *own = body->own + n * OWN_RECORD, *kept = body->damped ? body->damped + 2 * n : NULL;
        const bool light = own[OWN_MASS] < LIGHT * body->point_mass;
        for (int c = 0; c < 2; ++c) {
            if (kept) kept[c] = 0.0;
            if (light) continue;
            const double old = own[OWN_OLD + c], v = own[OWN_VELOCITY + c];
            const double change = -copysign(fmin(step->damping * fabs(v - old), fabs(v)), v);
            own[OWN_VELOCITY + c] = v + change;
            taken -= mass_of(body, own, c) * change * 0.5 * (old + v + change);
            if (kept) kept[c] = change;
        }
    }
    if (!body->damped) body->energy.damping += taken;
}

void mpm_damp_book(mpm_body *body) {
    if (!body->damped) return;
    double taken = 0.0;
    for (size_t n = 0; n < body->tile_count * AB_TILE_NODES; ++n) {
        const double *own = body->own + n * OWN_RECORD, *change = body->damped + 2 * n;
        for (int c = 0; c < 2; ++c) taken -= mass_of(body, own, c) * change[c] * 0.5 * (own[OWN_OLD + c] + own[OWN_VELOCITY + c]);
    }
    body->energy.damping += taken;
}
