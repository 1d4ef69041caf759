/* doubts_weight.c: gravity that no body of the scene could bear. */
#include "core/doubts_weight.h"

#include <math.h>
#include <stdlib.h>

/* m, from the lowest to the highest of a body's points or nodes along the direction g (of length `size`). */
static ab_status height_along(const ab_domain *domain, const double g[2], double size, double *height, ab_report *report) {
    const size_t count = domain->ops->count(domain);
    double *x = malloc((2 * count + 1) * sizeof *x), low = INFINITY, high = -INFINITY;
    if (!x) return ab_report_failure(report, "no memory for the places of %zu points", count);
    const ab_status status = domain->ops->read(domain, "position", x, report);
    for (size_t k = 0; k < count && status == AB_OK; ++k) {
        const double along = (x[2 * k] * g[0] + x[2 * k + 1] * g[1]) / size;
        low = fmin(low, along), high = fmax(high, along);
    }
    free(x);
    *height = high > low ? high - low : 0.0;
    return status;
}

ab_status ab_doubt_weight(const ab_schedule *s, size_t b, ab_report *report) {
    const ab_scene *scene = s->scene;
    const ab_body_spec *body = scene->bodies + b;
    const ab_domain *domain = s->domains[b];
    if (!body->gravity || body->material >= scene->material_count || ab_domain_is_rigid(domain) || !scene->watch) return AB_OK;
    const double density = scene->materials[body->material].density, modulus = domain->ops->modulus(domain),
                 speed = sqrt(modulus / density);
    double g[2], most = 0.0, at_once[2];
    for (int c = 0; c < 2; ++c) {
        at_once[c] = ab_number_at(scene->gravity + c, 0.5 * s->dt, 0.0, 0.0, 0.0);
        g[c] = ab_number_at(scene->gravity + c, scene->time_end, 0.0, 0.0, 0.0);
    }
    /* A step lasts as long as a wave takes through a cell, or element: what is faster than the wave after one has fallen by that much. */
    if (hypot(at_once[0], at_once[1]) * s->dt > speed)
        return ab_report_error(report, scene->mark_gravity,
                               "gravity: by %.4g m/s2 body '%s' would move at %.4g m/s after its first step of %.4g s, faster than waves "
                               "in it (%.4g m/s); look at the units of gravity "
                               "(9.81 m/s2, 9810 mm/s2), E and density. (watchdog: {stop: false} lets it be tried)",
                               hypot(at_once[0], at_once[1]), body->name, hypot(at_once[0], at_once[1]) * s->dt, s->dt, speed);
    const double size = hypot(g[0], g[1]);
    if (!(size > 0.0)) return AB_OK;
    AB_TRY(height_along(domain, g, size, &most, report));
    if (density * size * most > modulus)
        ab_report_warning(report, scene->mark_gravity,
                          "gravity: by %.4g m/s2 a column of body '%s', %.3g m high, weighs %.3g Pa, %.3g times the modulus that bears it: "
                          "nothing of it would be left standing; look at the "
                          "units of gravity (9.81 m/s2, 9810 mm/s2), E and density",
                          size, body->name, most, density * size * most, density * size * most / modulus);
    return AB_OK;
}
