/* drag.c: damping while something is driven, and the warning of it. */
#include "core/drag.h"

#include <math.h>

#include "core/checkpoint.h"

static bool moves(const ab_number *number) { return !ab_number_is_constant(number) || number->value != 0.0; }

static bool is_driven(const ab_body_spec *body) {
    const ab_motion_spec *motion = &body->motion;
    for (int c = 0; c < 2; ++c) {
        if (motion->has[c] && moves(motion->velocity + c)) return true;
        for (size_t f = 0; f < body->fix_count; ++f)
            if (body->fix[f].has[c] && moves(body->fix[f].velocity + c)) return true;
    }
    return motion->has_spin && moves(&motion->spin);
}

/* J so far: work done on all bodies that are driven, and what gravity has taken from the others. */
static void look(const ab_schedule *s, double *work, double *potential) {
    *work = *potential = 0.0;
    for (size_t b = 0; b < s->body_count; ++b)
        if (is_driven(s->scene->bodies + b))
            *work += s->energy[b].external;
        else
            *potential += s->energy[b].potential;
}

void ab_drag_before(ab_schedule *s) {
    look(s, &s->drag.external, &s->drag.potential);
    s->drag.damping = s->total.damping;
}

void ab_drag_after(ab_schedule *s, const ab_step *step) {
    ab_drag *d = &s->drag;
    double work, potential;
    look(s, &work, &potential);
    work -= d->external;
    if (step->settling || work == 0.0) return;
    d->work += work;
    d->most = fmax(d->most, fabs(d->work));
    if (!(step->damping > 0.0)) return;
    if (d->steps++ == 0) d->since = step->time;
    d->taken += s->total.damping - d->damping;
    d->fallen += d->potential - potential;
}

void ab_drag_warn(const ab_schedule *s, ab_report *report) {
    const ab_drag *d = &s->drag;
    const double beyond = d->taken - fmax(d->fallen, 0.0);
    if (!(beyond > AB_DRAG_PART * d->most)) return;
    size_t body = 0;
    double most = -1.0;
    for (size_t b = 0; b < s->body_count; ++b) {
        const ab_body_spec *spec = s->scene->bodies + b;
        if (is_driven(spec) && fabs(s->energy[b].external) > most) most = fabs(s->energy[b].external), body = b;
    }
    const ab_body_spec *spec = s->scene->bodies + body;
    char remedy[120];
    if (s->stages)
        snprintf(remedy, sizeof remedy, "leave `damping` out of the stage in which it moves, or take a smaller `local` there");
    else if (d->since > 0.0)
        snprintf(remedy, sizeof remedy, "end damping before it moves (damping.until: %.6g), or take a smaller damping.local", d->since);
    else
        snprintf(remedy, sizeof remedy, "let it move only after damping.until, or take a smaller damping.local");
    ab_report_warning(report, spec->mark,
                      "local damping took %.3g J while body '%s' was driven, %.3g %% of the work of %.3g J that moved it: its reaction "
                      "holds that drag, too; %s",
                      beyond, spec->name, 100.0 * beyond / d->most, d->most, remedy);
}

bool ab_drag_keep(ab_schedule *s, ab_checkpoint *c) {
    ab_drag *d = &s->drag;
    double *const numbers[] = {&d->work, &d->most, &d->taken, &d->fallen, &d->since};
    enum { COUNT = sizeof numbers / sizeof *numbers };
    double values[COUNT];
    for (size_t n = 0; n < COUNT; ++n) values[n] = *numbers[n];
    if (!ab_keep_doubles(c, "drag", values, COUNT) || !ab_keep_long(c, "drag_steps", &d->steps)) return false;
    if (ab_checkpoint_loads(c))
        for (size_t n = 0; n < COUNT; ++n) *numbers[n] = values[n];
    return true;
}
