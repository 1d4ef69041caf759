/* stages.c: the run from stage to stage. A stage that is over before its time leaves the rest of it out: the next one begins at this one's end. */
#include "core/stages.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/checkpoint.h"

enum { CALM_STEPS = 10 };          /* on end that meet `until`: a body that swings passes through its place of rest, too */
static const double PERIODS = 200; /* of the slowest body's first mode, 4 height/wave speed: the longest that a stage that is made takes */
static const double RAMP = 2;      /* periods, in which gravity grows in it */

const ab_stage_spec *ab_stages_spec(const ab_schedule *s) { return s->scene->stages + s->stages->now; }

bool ab_stages_done(const ab_schedule *s) {
    const bool last = !s->stages || s->stages->now + 1 >= s->scene->stage_count;
    return last && !(s->time < s->end);
}

/* s: how long the first mode of the slowest body is that asks for the stress of gravity; or what the scene says. */
static ab_status find_period(const ab_schedule *s, double *period, double *longest, ab_report *report) {
    *period = *longest = 0.0;
    for (size_t b = 0; b < s->body_count; ++b) {
        const ab_domain *domain = s->domains[b];
        const ab_body_spec *spec = domain->spec;
        if (spec->initial.kind != AB_INITIAL_GRAVITY) continue;
        *longest = fmax(*longest, spec->initial.time);
        const size_t count = domain->ops->count(domain);
        double *place = malloc((2 * count + 1) * sizeof *place), low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        if (!place) return ab_report_failure(report, "no memory for the places of body '%s'", spec->name);
        const ab_status status = domain->ops->read(domain, "position", place, report);
        for (size_t k = 0; status == AB_OK && k < 2 * count; ++k)
            low[k % 2] = fmin(low[k % 2], place[k]), high[k % 2] = fmax(high[k % 2], place[k]);
        free(place);
        AB_TRY(status);
        const double speed = sqrt(domain->ops->modulus(domain) / s->scene->materials[spec->material].density);
        *period = fmax(*period, 4.0 * fmax(high[0] - low[0], high[1] - low[1]) / speed);
    }
    if (*longest == 0.0) *longest = PERIODS * *period;
    return AB_OK;
}

/* The stage `now` begins at the time that s->begin says. */
static ab_status enter(ab_schedule *s, ab_report *report) {
    ab_stages *k = s->stages;
    const ab_stage_spec *spec = ab_stages_spec(s);
    s->end = spec->end;
    s->fixed_dt = spec->dt;
    s->cfl = spec->cfl;
    if (!spec->made) k->ramp = spec->ramp;
    for (size_t b = 0; b < s->body_count; ++b)
        if (s->domains[b]->ops->enter) AB_TRY(s->domains[b]->ops->enter(s->domains[b], spec, k->now, report));
    return AB_OK;
}

ab_status ab_stages_create(ab_schedule *s, ab_report *report) {
    ab_stages *k = s->stages = calloc(1, sizeof *k);
    if (!k) return ab_report_failure(report, "no memory for the stages");
    k->force_ratio = k->energy_ratio = NAN;
    if (s->scene->stages[0].made) {
        double period, longest;
        AB_TRY(find_period(s, &period, &longest, report));
        k->ramp = fmin(RAMP * period, 0.5 * longest);
        s->begin = s->time = -longest;
    }
    return enter(s, report);
}

/* Part of the scene's gravity that acts at a time. */
static double gravity_at(const ab_schedule *s, double time) {
    const ab_stages *k = s->stages;
    const ab_stage_spec *spec = ab_stages_spec(s);
    if (spec->gravity == AB_GRAVITY_OFF) return 0.0;
    if (spec->gravity == AB_GRAVITY_KEEP || !(time < s->begin + k->ramp)) return 1.0;
    return k->gravity_begin + (1.0 - k->gravity_begin) * 0.5 * (1.0 - cos(3.14159265358979324 * (time - s->begin) / k->ramp));
}

void ab_stages_fill(const ab_schedule *s, ab_step *step) {
    const ab_stage_spec *spec = ab_stages_spec(s);
    const double middle = step->time + 0.5 * step->dt, part = gravity_at(s, middle);
    step->stage = s->stages->now;
    step->damping = step->time < spec->local_until ? spec->local : 0.0;
    step->measure = spec->has_until;
    step->settling = spec->made;
    step->from_rest = s->stages->from_rest;
    if (spec->made) step->time = -0.5 * step->dt; /* formulas are taken at the middle of a step: at t = 0 */
    for (int c = 0; c < s->scene->dimension; ++c)
        step->gravity[c] = part * ab_number_at(s->scene->gravity + c, spec->made ? 0.0 : middle, 0.0, 0.0, 0.0);
}

/* All velocities that are not given to zero; they move no more from the end of the step on. */
static void rest(ab_schedule *s, const ab_step *step) {
    for (size_t b = 0; b < s->body_count; ++b)
        if (s->domains[b]->ops->rest) s->domains[b]->ops->rest(s->domains[b], step);
    s->stages->from_rest = true;
    ab_schedule_look(s);
}

static void measure(ab_schedule *s, const ab_step *step) {
    ab_stages *k = s->stages;
    double unbalanced = 0.0, applied = 0.0, mass = 0.0;
    for (size_t b = 0; b < s->body_count; ++b) {
        double out = 0.0, from_outside = 0.0;
        if (s->domains[b]->ops->balance) s->domains[b]->ops->balance(s->domains[b], &out, &from_outside);
        unbalanced += out, applied += from_outside, mass += s->motion[b].mass;
    }
    k->force_ratio = applied > 0.0 ? unbalanced / applied : unbalanced > 0.0 ? INFINITY : 0.0;
    /* Where nothing has moved yet no work was done: then against the energy that the forces applied would give in a step. */
    const double work = fabs(s->total.external - k->external) + fabs(s->total.potential - k->potential),
                 kick = mass > 0.0 ? 0.5 * (applied * step->dt) * (applied * step->dt) / mass : 0.0;
    k->energy_ratio = s->total.kinetic > 0.0 ? s->total.kinetic / fmax(work, kick) : 0.0;
}

static ab_status missed(const ab_schedule *s, ab_report *report) {
    const ab_stages *k = s->stages;
    const ab_stage_spec *spec = ab_stages_spec(s);
    char force[120] = "", energy[120] = "";
    if (isfinite(spec->unbalanced))
        snprintf(force, sizeof force, "; the force out of balance is %.3g of that applied (wanted: %.3g)", k->force_ratio,
                 spec->unbalanced);
    if (isfinite(spec->at_rest))
        snprintf(energy, sizeof energy, "; the kinetic energy is %.3g of the work from outside (wanted: %.3g)", k->energy_ratio,
                 spec->at_rest);
    static const char remedy[] =
        "give it more time or another damping (local: 0.7, or kinetic: true), look in the last frame for what still moves, or ask for less";
    if (!spec->go_on)
        return ab_report_failure(report, "stage '%s' has not come to rest by t = %.6g s (step %ld)%s%s; %s, or write missed: warn",
                                 spec->name, s->time, s->number, force, energy, remedy);
    ab_report_warning(report, spec->mark, "stage '%s' has not come to rest by t = %.6g s (step %ld)%s%s, and is gone on from; %s",
                      spec->name, s->time, s->number, force, energy, remedy);
    return AB_OK;
}

ab_status ab_stages_after(ab_schedule *s, const ab_step *step, ab_report *report) {
    ab_stages *k = s->stages;
    const ab_stage_spec *spec = ab_stages_spec(s);
    k->from_rest = false;
    if (spec->has_until) {
        measure(s, step);
        const bool grown = spec->gravity != AB_GRAVITY_RAMP || !(s->time < s->begin + k->ramp);
        k->calm = grown && k->force_ratio <= spec->unbalanced && k->energy_ratio <= spec->at_rest ? k->calm + 1 : 0;
        if (k->calm >= CALM_STEPS) k->met = true, s->time = s->end; /* the clock leaves the rest out */
        if (!k->met && !(s->time < s->end)) AB_TRY(missed(s, report));
    }
    if (spec->kinetic && s->total.kinetic < k->kinetic) rest(s, step);
    k->kinetic = s->total.kinetic;
    return AB_OK;
}

ab_status ab_stages_next(ab_schedule *s, bool *datum, ab_report *report) {
    ab_stages *k = s->stages;
    *datum = false;
    if (s->time < s->end || k->now + 1 >= s->scene->stage_count) return AB_OK;
    const ab_stage_spec *spec = ab_stages_spec(s);
    ab_step step = {.time = s->time - s->dt, .dt = s->dt, .number = s->number - 1};
    ab_stages_fill(s, &step);
    if (spec->zero_velocities) rest(s, &step);
    if (spec->zero_displacements) {
        *datum = true;
        for (size_t b = 0; b < s->body_count; ++b)
            if (s->domains[b]->ops->datum) AB_TRY(s->domains[b]->ops->datum(s->domains[b], report));
    }
    *k = (ab_stages){.now = k->now + 1,
                     .from_rest = k->from_rest,
                     .gravity_begin = gravity_at(s, s->end),
                     .external = s->total.external,
                     .potential = s->total.potential,
                     .force_ratio = NAN,
                     .energy_ratio = NAN};
    s->time = s->begin = s->end;
    s->first_step = s->number;
    AB_TRY(enter(s, report));
    s->warned = s->fixed_dt > s->first_critical_dt; /* that was told before the run */
    return AB_OK;
}

bool ab_stages_keep(ab_schedule *s, ab_checkpoint *c) {
    ab_stages *k = s->stages;
    if (!k) return true;
    long calm = k->calm;
    double *const numbers[] = {&s->begin,     &k->gravity_begin, &k->ramp,        &k->external,
                               &k->potential, &k->kinetic,       &k->force_ratio, &k->energy_ratio};
    enum { COUNT = sizeof numbers / sizeof *numbers };
    double values[COUNT];
    for (size_t n = 0; n < COUNT; ++n) values[n] = *numbers[n];
    size_t now = k->now;
    if (!ab_keep_size(c, "stage", &now) || !ab_keep_doubles(c, "stage_numbers", values, COUNT) || !ab_keep_long(c, "stage_calm", &calm) ||
        !ab_keep_long(c, "stage_first_step", &s->first_step) || !ab_keep_flags(c, "stage_from_rest", &k->from_rest, 1) ||
        !ab_keep_flags(c, "stage_met", &k->met, 1))
        return false;
    if (!ab_checkpoint_loads(c)) return true;
    if (now >= s->scene->stage_count) return ab_checkpoint_refuse(c, "its stage %zu is none of the scene", now);
    for (size_t n = 0; n < COUNT; ++n) *numbers[n] = values[n];
    k->now = now;
    k->calm = (int)calm;
    const double ramp = k->ramp;
    const bool good = enter(s, ab_checkpoint_report(c)) == AB_OK;
    k->ramp = ramp;
    return good || ab_checkpoint_refuse(c, "its stage cannot be entered");
}
