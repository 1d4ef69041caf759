/* body_force.c: a force per mass that is a field, on the nodes of a finite-element body: by their lumped masses, as gravity. It is taken at the places and at the
 * time of the start of the step, where the stresses are, too. Formulas are evaluated on one thread. */
#include "fem/domain.h"

ab_status fem_body_force_add(fem_body *body, const ab_step *step, ab_report *report) {
    const ab_body_spec *spec = body->domain.spec;
    if (!spec->has_force) return AB_OK;
    for (size_t i = 0; i < body->nodes; ++i) {
        double now[2];
        for (size_t c = 0; c < 2; ++c) now[c] = body->x[2 * i + c] + body->origin[c];
        for (size_t c = 0; c < 2; ++c) {
            const double b = ab_number_of(spec->force + c, step->time, now, body->mesh->x + 2 * i);
            AB_TRY(ab_number_finite(spec->force + c, b, step->time, now, report, "bodies.%s.body_force[%zu]", spec->name, c));
            body->body_force[2 * i + c] = body->mass[i] * b;
            body->force[2 * i + c] += body->mass[i] * b;
        }
    }
    return AB_OK;
}

void fem_body_force_work(fem_body *body, const ab_step *step) {
    if (!body->domain.spec->has_force) return;
    double work = 0.0;
    for (size_t k = 0; k < 2 * body->nodes; ++k) work += body->body_force[k] * 0.5 * (body->old[k] + body->velocity[k]);
    body->energy.external += step->dt * work;
}
