/* stages.c: what stages ask of a body of points: other sides, rest, another datum of displacements, how far it is from equilibrium. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mpm/body.h"

static const double LIGHT = 1e-4; /* of a point's mass: what pulls at a node with less, no point feels (as for damping, grid.c) */

ab_status mpm_enter(ab_domain *domain, const ab_stage_spec *stage, size_t number, ab_report *report) {
    (void)number, (void)report;
    mpm_body *body = (mpm_body *)domain;
    memcpy(body->side, stage->side, sizeof body->side);
    mpm_tiles_hold(body);
    body->scattered = false; /* weights near sides may be others */
    return AB_OK;
}

/* Velocities stand in the middle of the step and stresses and places at its end: until there the body has moved on with them, so the second half of what forces did in
 * the step is booked before the rest is taken. */
void mpm_rest(ab_domain *domain, const ab_step *step) {
    mpm_body *body = (mpm_body *)domain;
    const double half = 0.5 * step->dt;
    double weight = 0.0;
    for (int c = 0; c < 2 && body->gravity; ++c) weight += half * step->gravity[c] * body->motion.momentum[c];
    const double work = 0.5 * (body->energy.external - body->external_before);
    const double stored = mpm_strains_first(body->update) ? 0.0 : 0.5 * body->last_strain;
    body->energy.damping += body->energy.kinetic + weight + work - stored;
    body->energy.potential -= weight;
    body->energy.external += work;
    if (!mpm_strains_first(body->update)) body->last_strain = 0.0;
    body->external_before = body->energy.external;
    for (size_t b = 0; b < body->block_count; ++b) {
        double *block = mpm_block(body, b);
        memset(block + 8 * ROW_V, 0, 16 * sizeof *block);
        if (body->rows.affine >= 0) memset(block + 8 * body->rows.affine, 0, 32 * sizeof *block);
    }
    body->energy.kinetic = 0.0;
    body->motion.momentum[0] = body->motion.momentum[1] = body->motion.angular_momentum[2] = 0.0;
    body->largest_speed = 0.0;
    body->scattered = false;
}

ab_status mpm_datum(ab_domain *domain, ab_report *report) {
    mpm_body *body = (mpm_body *)domain;
    if (!body->birth) return AB_OK; /* nobody looks at displacements */
    if (!body->datum) body->datum = malloc(2 * body->born * sizeof *body->datum);
    if (!body->datum) return ab_report_failure(report, "body '%s': no memory for the places of %zu points", domain->spec->name, body->born);
    memcpy(body->datum, body->birth, 2 * body->born * sizeof *body->datum); /* of points that have left */
    for (size_t slot = 0; slot < body->block_count * 8; ++slot)
        if (body->ids[slot] != UINT64_MAX)
            for (size_t c = 0; c < 2; ++c) body->datum[2 * body->ids[slot] + c] = mpm_block(body, slot / 8)[8 * (ROW_X + c) + slot % 8];
    return AB_OK;
}

void mpm_measure(mpm_body *body, const ab_step *step) {
    const double g[2] = {body->gravity ? step->gravity[0] : 0.0, body->gravity ? step->gravity[1] : 0.0};
    body->unbalanced = 0.0;
    body->applied = mpm_loads_size(body) + mpm_body_force_size(body);
    for (size_t n = 0; n < body->tile_count * AB_TILE_NODES; ++n) {
        const double *own = body->own + n * OWN_RECORD;
        double out[2], weight[2];
        if (own[OWN_MASS] < LIGHT * body->point_mass) continue;
        for (int c = 0; c < 2; ++c) {
            const double mass = own[OWN_INVERSE + c] > 0.0 ? 1.0 / own[OWN_INVERSE + c] : 0.0;
            out[c] = mass * (own[OWN_VELOCITY + c] - own[OWN_OLD + c]) / step->dt;
            weight[c] = mass * g[c];
        }
        body->unbalanced += hypot(out[0], out[1]);
        body->applied += hypot(weight[0], weight[1]);
    }
}

void mpm_balance(const ab_domain *domain, double *unbalanced, double *applied) {
    const mpm_body *body = (const mpm_body *)domain;
    *unbalanced = body->unbalanced;
    *applied = body->applied;
}
