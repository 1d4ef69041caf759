/* watchdog.c: energy that a run makes against what it was given. Everything else that must not go on is stopped where it is seen: no finite numbers, points that
 * leave the grid or move many cells, elements that turn inside out, steps that collapse. */
#include "core/watchdog.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/checkpoint.h"

static const double ROUNDED = 1e-12; /* of a place: a step that moves by less is mostly rounding */
static const double ROUNDING = 1e-6; /* of the kinetic energy of flight: less is not told from rounding */

/* The body that holds the most kinetic and strain energy beyond what it began with. */
static size_t culprit(const ab_schedule *s) {
    size_t body = 0;
    double most = -INFINITY;
    for (size_t b = 0; b < s->body_count; ++b) {
        const double more = s->energy[b].kinetic + s->energy[b].strain - s->energy_start[b].kinetic - s->energy_start[b].strain;
        if (more > most) most = more, body = b;
    }
    return body;
}

/* "body 'block', whose fastest point, 17, moves at 4e3 m/s at (0.3, 1.2) m". False: it moves by no more in a step than its place is rounded by, as in the first
 * steps of a slow load: energies are noise there. */
static bool describe(const ab_domain *domain, double dt, char *text, size_t size, ab_report *report) {
    bool moves = true;
    const size_t count = domain->ops->count(domain);
    double *velocity = malloc((2 * count + 1) * sizeof *velocity), *position = malloc((2 * count + 1) * sizeof *position),
           *id = malloc((count + 1) * sizeof *id);
    snprintf(text, size, "body '%s'", domain->spec->name);
    if (velocity && position && id && count > 0 && domain->ops->read(domain, "velocity", velocity, report) == AB_OK &&
        domain->ops->read(domain, "position", position, report) == AB_OK && domain->ops->read(domain, "id", id, report) == AB_OK) {
        size_t fastest = 0;
        for (size_t k = 1; k < count; ++k)
            if (hypot(velocity[2 * k], velocity[2 * k + 1]) > hypot(velocity[2 * fastest], velocity[2 * fastest + 1])) fastest = k;
        const double far = fmax(fabs(position[2 * fastest]), fabs(position[2 * fastest + 1]));
        moves = hypot(velocity[2 * fastest], velocity[2 * fastest + 1]) * dt > ROUNDED * far;
        snprintf(text, size, "body '%s', whose fastest %s, %.0f, moves at %.4g m/s at (%.6g, %.6g) m", domain->spec->name,
                 domain->ops->cells ? "node" : "point", id[fastest], hypot(velocity[2 * fastest], velocity[2 * fastest + 1]),
                 position[2 * fastest], position[2 * fastest + 1]);
    }
    free(velocity), free(position), free(id);
    return moves;
}

/* What most likely makes energy in such a body, and what to do. */
static const char *remedy(const ab_schedule *s, const ab_body_spec *body) {
    if (s->dt > s->critical_dt) return "dt is above the stable limit: use a cfl below 1, or a dt below the limit";
    if (body->basis && !strcmp(body->basis, "linear"))
        return "points of the linear basis pull at other nodes all at once as they cross cells: use basis gimp or bspline2, a smaller cfl, "
               "or "
               "update usl";
    if (body->basis && body->transfer == AB_TRANSFER_FLIP && body->flip == 1.0)
        return "flip keeps what the nodes do not see, and it may grow while a body moves through cells: use transfer apic or {flip: 0.99}, "
               "or update usl";
    return "use a smaller cfl, or finer cells or elements";
}

ab_status ab_watchdog_step(ab_schedule *s, ab_report *report) {
    const double remainder = s->total_now - s->total_start;
    if (!s->scene->watch || !(remainder > 0.0)) {
        s->watch_count = 0;
        return AB_OK;
    }
    double began = 0.0, kinetic = 0.0, potential = 0.0, mass = 0.0, momentum2 = 0.0;
    for (size_t b = 0; b < s->body_count; ++b) {
        kinetic += s->energy_start[b].kinetic;
        mass += s->motion[b].mass;
        began += s->energy_start[b].strain;
        potential += s->energy_start[b].potential;
    }
    for (int c = 0; c < 3; ++c) momentum2 += s->watch_momentum[c] * s->watch_momentum[c];
    /* as seen from the common centre of mass: what all bodies fly with together is nothing they can give */
    began += fmax(kinetic - (mass > 0.0 ? 0.5 * momentum2 / mass : 0.0), ROUNDING * kinetic);
    s->watch_external =
        fmax(s->watch_external, fabs(s->total.external) + fmax(-s->total.boundary, 0.0)); /* bases that shake give by way of boundaries */
    s->watch_potential = fmax(s->watch_potential, fabs(s->total.potential - potential));
    const double given = began + s->watch_external + s->watch_potential;
    s->watch_count = remainder > s->scene->watch_energy * given && given > 0.0 ? s->watch_count + 1 : 0;
    if (s->watch_count < WATCH_STEPS) return AB_OK;
    const ab_domain *domain = s->domains[culprit(s)];
    char what[400];
    if (!describe(domain, s->dt, what, sizeof what, report)) {
        s->watch_count = 0;
        return AB_OK;
    }
    return ab_report_failure(report,
                             "the run makes energy: %.4g J by t = %.9g s (step %ld), with %.4g J put into it, and stays above %g of that; "
                             "most of it is in %s; dt %.4g s, "
                             "limit %.4g s (%s). %s. (watchdog: {stop: false} lets it go on)",
                             remainder, s->time, s->number, given, s->scene->watch_energy, what, s->dt, s->critical_dt, s->limit,
                             remedy(s, domain->spec));
}

bool ab_watchdog_keep(ab_schedule *s, ab_checkpoint *c) {
    long count = s->watch_count;
    if (!ab_keep_doubles(c, "watch_external", &s->watch_external, 1) || !ab_keep_doubles(c, "watch_potential", &s->watch_potential, 1) ||
        !ab_keep_doubles(c, "watch_momentum", s->watch_momentum, 3) || !ab_keep_long(c, "watch_count", &count))
        return false;
    s->watch_count = (int)count;
    return true;
}
