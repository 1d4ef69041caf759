/* too_far.c: a point that moves more than a cell in a step is lost to its neighbours: whatever it was to push, it has passed. No stable step allows that: dt is at most
 * a cell over wave speed and speed (times 1.5 for the widest basis). */
#include <math.h>

#include "mpm/body.h"

ab_status mpm_too_far(const mpm_body *body, const ab_step *step, bool far, ab_report *report) {
    if (!far && !(body->scene->watch && body->largest_speed * step->dt > body->h)) return AB_OK;
    double most = 0.0, x[2] = {0.0, 0.0}, v[2] = {0.0, 0.0};
    uint64_t id = 0;
    for (size_t slot = 0; slot < body->block_count * 8; ++slot) {
        if (body->ids[slot] == UINT64_MAX) continue;
        const double *p = mpm_block(body, slot / 8) + slot % 8;
        const double moved = hypot(p[8 * ROW_NEXT] - p[8 * ROW_X], p[8 * (ROW_NEXT + 1)] - p[8 * (ROW_X + 1)]);
        if (!(moved > most)) continue;
        most = moved, id = body->ids[slot];
        for (int c = 0; c < 2; ++c) x[c] = p[8 * (ROW_NEXT + c)] + body->origin[c], v[c] = p[8 * (ROW_V + c)];
    }
    if (!far && !(most > body->h)) return AB_OK; /* its own speed is more than that of the nodes which move it */
    const char *remedy = step->dt > body->last_limit ? "dt is above the limit: use a smaller one, or cfl"
                         : body->scene->time_cfl > 0 ? "something threw it: look at the frames before; use a smaller cfl, or a finer grid"
                                                     : "something threw it: look at the frames before; use a smaller dt, or a finer grid";
    return ab_report_failure(
        report,
        "body '%s': point %llu moved %.3g cells in one step, to (%.6g, %.6g) m, velocity (%.4g, %.4g) m/s, at t = %.9g s "
        "(step %ld, dt %.4g s, limit %.4g s: wave speed %.4g m/s in cells of %.4g m). %s. (watchdog: {stop: false} lets "
        "it go on while its cell can be found)",
        body->domain.spec->name, (unsigned long long)id, most / body->h, x[0], x[1], v[0], v[1], step->time + step->dt, step->number,
        step->dt, body->last_limit, body->wave_speed, body->h, remedy);
}
