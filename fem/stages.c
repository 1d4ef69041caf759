/* stages.c: what stages ask of a body of finite elements, and of a rigid one: other supports, rest, another datum of displacements, how far it is from equilibrium. */
#include <string.h>

#include "fem/domain.h"

ab_status fem_enter(ab_domain *domain, const ab_stage_spec *stage, size_t number, ab_report *report) {
    (void)stage;
    fem_body *body = (fem_body *)domain;
    return fem_held_choose(body, body->outer->faces, number, report);
}

/* Velocities stand in the middle of the step and stresses and places at its end: until there the body has moved on with them, so the second half of what forces did in
 * the step is booked before the rest is taken. */
void fem_rest(ab_domain *domain, const ab_step *step) {
    fem_body *body = (fem_body *)domain;
    const double half = 0.5 * step->dt, before = body->energy.kinetic;
    double weight = 0.0;
    for (int c = 0; c < 2 && body->gravity; ++c) weight += half * step->gravity[c] * body->motion.momentum[c];
    const double work = 0.5 * (body->energy.external - body->external_before);
    for (size_t d = 0; d < 2 * body->nodes; ++d)
        if (body->inverse_mass[d] > 0.0) body->velocity[d] = 0.0;
    fem_nodes_measure(body);
    body->energy.damping += before - body->energy.kinetic + weight + work - body->ahead;
    body->energy.potential -= weight;
    body->energy.external += work;
    body->ahead = 0.0;
    body->external_before = body->energy.external;
}

ab_status fem_datum(ab_domain *domain, ab_report *report) {
    fem_body *body = (fem_body *)domain;
    if (!body->datum) body->datum = fem_take(body, 2 * body->nodes, sizeof *body->datum);
    if (!body->datum) return ab_report_failure(report, "body '%s': no memory for the places of %zu nodes", domain->spec->name, body->nodes);
    for (size_t d = 0; d < 2 * body->nodes; ++d) body->datum[d] = body->x[d] + body->origin[d % 2];
    return AB_OK;
}

void fem_balance(const ab_domain *domain, double *unbalanced, double *applied) {
    const fem_body *body = (const fem_body *)domain;
    *unbalanced = body->unbalanced;
    *applied = body->applied;
}
