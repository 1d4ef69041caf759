/* scheduler.c: the time loop. It knows bodies only as domains, contact only as an interaction, and neither by name. */
#define _GNU_SOURCE
#include "core/scheduler.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "core/boundary.h"
#include "core/drag.h"
#include "core/phases.h"
#include "core/progress.h"
#include "core/stages.h"

static const double MOST_STEPS = 1e12; /* of a run; more would take years */
static const double COLLAPSED = 1e-9;  /* of the first limit of the step: a run that has come to this does not end */

static double choose_dt(ab_schedule *s);

/* ---- making and unmaking ------------------------------------------------------------------------------------------------ */

ab_status ab_schedule_create(const ab_scene *scene, const ab_run_options *options, ab_schedule **out, ab_report *report) {
    ab_schedule *s = calloc(1, sizeof *s);
    if (!s) return ab_report_failure(report, "no memory for the schedule");
    s->scene = scene;
    s->body_count = scene->body_count;
    s->domains = calloc(s->body_count + 1, sizeof *s->domains);
    s->energy = calloc(s->body_count + 1, sizeof *s->energy);
    s->energy_start = calloc(s->body_count + 1, sizeof *s->energy_start);
    s->motion = calloc(s->body_count + 1, sizeof *s->motion);
    s->limit = "none";
    s->end = scene->time_end, s->fixed_dt = scene->time_dt, s->cfl = scene->time_cfl;
    omp_set_num_threads(options->threads);
    ab_status status = s->domains && s->energy && s->energy_start && s->motion
                           ? AB_OK
                           : ab_report_failure(report, "no memory for %zu bodies", s->body_count);
    ab_progress progress;
    ab_progress_begin(&progress, stderr, options->quiet, 1.0, 1);
    ab_report_watch(report, ab_progress_prepare, &progress);
    for (size_t b = 0; status == AB_OK && b < s->body_count; ++b) {
        const ab_body_spec *spec = scene->bodies + b;
        const ab_method *method = NULL;
        for (size_t m = 0; m < options->method_count; ++m)
            if (!strcmp(options->methods[m].name, spec->method)) method = options->methods + m;
        if (!method)
            status = ab_report_error(report, spec->mark, "body '%s': method '%s' is not in this version", spec->name, spec->method);
        else
            status = method->create(scene, b, options->threads, s->domains + b, report);
    }
    ab_report_watch(report, NULL, NULL);
    ab_progress_end(&progress);
    if (status == AB_OK && scene->boundary_count) status = ab_boundaries_create(scene, s->domains, &s->boundaries, report);
    if (status == AB_OK && scene->contact_count) status = options->interact(scene, s->domains, &s->interaction, report);
    if (status != AB_OK) {
        ab_schedule_destroy(s);
        return status;
    }
    ab_schedule_look(s);
    if (scene->stage_count) {
        status = ab_stages_create(s, report);
        if (status != AB_OK) {
            ab_schedule_destroy(s);
            return status;
        }
    }
    memcpy(s->energy_start, s->energy, s->body_count * sizeof *s->energy);
    s->total_start = s->total_now;
    for (size_t b = 0; b < s->body_count; ++b)
        for (int c = 0; c < 3; ++c) s->watch_momentum[c] += s->motion[b].momentum[c];
    s->dt = choose_dt(s);
    s->first_critical_dt = s->critical_dt;
    if (!(s->fixed_dt > 0.0) && isinf(s->critical_dt)) {
        ab_schedule_destroy(s);
        return ab_report_error(
            report, scene->mark_time,
            "time: nothing in this scene limits the step, as rigid bodies have no waves; write time.dt, a small part of the "
            "time in which they move by their size");
    }
    if (scene->time_end / s->dt > MOST_STEPS) {
        ab_report_error(report, scene->mark_time,
                        "time.end: steps of about %.3g s (limit: %s) up to %g s would be %.3g, more than %g; look at what makes the step so short (cells, E, density, velocities and their "
                        "units), or use a smaller end",
                        s->dt, s->limit, scene->time_end, scene->time_end / s->dt, MOST_STEPS);
        ab_schedule_destroy(s);
        return AB_BAD_INPUT;
    }
    *out = s;
    return AB_OK;
}

void ab_schedule_destroy(ab_schedule *s) {
    if (!s) return;
    if (s->interaction) s->interaction->destroy(s->interaction);
    ab_boundaries_destroy(s->boundaries);
    for (size_t b = 0; s->domains && b < s->body_count; ++b)
        if (s->domains[b]) s->domains[b]->ops->destroy(s->domains[b]);
    free(s->domains), free(s->energy), free(s->energy_start), free(s->motion), free(s->stages), free(s);
}

/* ---- one step ------------------------------------------------------------------------------------------------------------ */

static double sum_of(const ab_energy *e) {
    return e->kinetic + e->strain + e->potential + e->plastic + e->friction + e->contact + e->boundary + e->damping + e->outflow -
           e->external;
}

void ab_schedule_look(ab_schedule *s) {
    ab_energy total = {0};
    for (size_t b = 0; b < s->body_count; ++b) {
        ab_energy *e = s->energy + b;
        s->domains[b]->ops->ledger(s->domains[b], e, s->motion + b);
        if (s->interaction) s->interaction->book(s->interaction, b, &e->friction, &e->contact);
        if (s->boundaries) e->boundary += ab_boundaries_taken(s->boundaries, b);
        total.kinetic += e->kinetic, total.strain += e->strain, total.potential += e->potential, total.plastic += e->plastic,
            total.friction += e->friction;
        total.contact += e->contact, total.boundary += e->boundary, total.damping += e->damping, total.external += e->external,
            total.outflow += e->outflow;
    }
    s->total = total;
    s->total_now = sum_of(&total);
}

/* dt of the next step: the scene's own, or by cfl so that the steps left are equal and end on time. *limit: what binds. */
static double choose_dt(ab_schedule *s) {
    const double left = s->end - s->time;
    double critical = INFINITY;
    for (size_t b = 0; b < s->body_count; ++b) {
        const char *limit = "";
        double dt = s->domains[b]->ops->critical_dt(s->domains[b], &limit);
        if (s->boundaries) dt = ab_boundaries_critical_dt(s->boundaries, b, dt, &limit);
        if (dt < critical) critical = dt, s->limit = limit;
    }
    if (s->interaction && s->interaction->critical_dt) {
        const char *limit = "";
        const double dt = s->interaction->critical_dt(s->interaction, &limit);
        if (dt < critical) critical = dt, s->limit = limit;
    }
    s->critical_dt = critical;
    if (s->fixed_dt > 0.0) {
        const double whole = s->fixed_dt;
        return left < whole * (1.0 + 1e-9) ? left : whole;
    }
    const double wanted = s->cfl * critical;
    const double steps = ceil(left / wanted - 1e-9);
    return left / fmax(steps, 1.0);
}

static ab_status each(ab_schedule *s, const ab_step *step, size_t offset, ab_report *report) {
    typedef ab_status (*act)(ab_domain *, const ab_step *, ab_report *);
    for (size_t b = 0; b < s->body_count; ++b) {
        const act call = *(const act *)((const char *)s->domains[b]->ops + offset);
        if (call) AB_TRY(call(s->domains[b], step, report));
    }
    return AB_OK;
}
#define EACH(what) each(s, &step, offsetof(ab_domain_ops, what), report)

/* Once: springs of contact are only known once bodies have met. */
static void warn_of_dt(ab_schedule *s, ab_report *report) {
    if (s->warned || !(s->fixed_dt > s->critical_dt)) return;
    s->warned = true;
    ab_report_warning(report, s->stages ? ab_stages_spec(s)->mark : s->scene->mark_time,
                      "at %.4g s dt %.4g s is above the stable limit %.4g s (%s); use dt below it or cfl", s->time, s->fixed_dt,
                      s->critical_dt, s->limit);
}

/* A step by cfl that falls and falls: something in the scene runs away, or time does not go on any more. */
static ab_status stop_collapse(const ab_schedule *s, ab_report *report) {
    if (s->fixed_dt > 0.0) return AB_OK;
    const double wanted = s->cfl * s->critical_dt;
    if (wanted >= COLLAPSED * s->cfl * s->first_critical_dt && s->time + wanted > s->time) return AB_OK;
    const bool springs = !strncmp(s->limit, "springs of boundaries", strlen("springs of boundaries"));
    const char *remedy =
        springs ? "The springs of that boundary are too stiff for what they hold: use softer ones (a larger r_b, smaller k_n and k_t), "
                  "or hold the edge by `fix` or a side of the grid"
                : "Look at the last frames: something there is torn, crushed or thrown; use a smaller cfl, finer cells or elements, "
                  "a material that hardens, or for a spring of contact stiffness_of: mass";
    return ab_report_failure(
        report,
        "at %.9g s, after %ld steps, the step has collapsed to %.3g s, from %.3g s at the start, by this limit: %s. The "
        "run would not end; what was computed until now is in the results. %s",
        s->time, s->number, wanted, s->cfl * s->first_critical_dt, s->limit, remedy);
}

/* What contact finders had to leave undecided. */

ab_status ab_schedule_next(ab_schedule *s, bool *datum, ab_report *report) {
    *datum = false;
    return s->stages ? ab_stages_next(s, datum, report) : AB_OK;
}

ab_status ab_schedule_step(ab_schedule *s, ab_report *report) {
    const ab_scene *scene = s->scene;
    bool datum;
    AB_TRY(ab_schedule_next(s, &datum, report));
    const double dt = choose_dt(s);
    AB_TRY(stop_collapse(s, report));
    if (s->interaction || s->boundaries || s->stages) warn_of_dt(s, report);
    ab_step step = {.time = s->time, .dt = dt, .number = s->number};
    for (int c = 0; c < scene->dimension; ++c) step.gravity[c] = ab_number_at(scene->gravity + c, s->time + 0.5 * dt, 0.0, 0.0, 0.0);
    step.damping = s->time < scene->damping_until ? scene->damping_local : 0.0;
    if (s->stages) ab_stages_fill(s, &step);
    for (int c = 0; c < scene->dimension; ++c)
        AB_TRY(ab_number_finite(scene->gravity + c, step.gravity[c], step.settling ? 0.0 : s->time + 0.5 * dt, NULL, report, "gravity[%d]",
                                c));
    bool any_early = false, any_remap = false;
    for (size_t b = 0; b < s->body_count; ++b) {
        any_early = any_early || s->domains[b]->ops->early;
        any_remap = any_remap || s->domains[b]->ops->remap;
    }
    ab_interaction *in = s->interaction;
    step.early = any_early && in;
    ab_boundaries *edges = s->boundaries;
    ab_status status = AB_OK;
    ab_drag_before(s);
    s->half_done = true;
    TIMED(PHASE_BEGIN, status = EACH(begin));
    AB_TRY(status);
    if (any_early) {
        if (in) TIMED(PHASE_CONTACT, status = in->solve(in, &step, AB_STAGE_KINEMATIC, report));
        AB_TRY(status);
        TIMED(PHASE_STRESS, status = EACH(early));
        AB_TRY(status);
    }
    TIMED(PHASE_BEGIN, status = EACH(trial));
    AB_TRY(status);
    if (edges) TIMED(PHASE_BOUNDARY, status = ab_boundaries_apply(edges, &step, report));
    AB_TRY(status);
    if (in) TIMED(PHASE_CONTACT, status = in->solve(in, &step, AB_STAGE_DYNAMIC, report));
    AB_TRY(status);
    if (in && edges) TIMED(PHASE_BOUNDARY, ab_boundaries_hold(edges, &step));
    TIMED(PHASE_FINISH, status = EACH(finish));
    AB_TRY(status);
    if (in) TIMED(PHASE_CONTACT, in->settle(in, &step));
    if (edges) TIMED(PHASE_BOUNDARY, ab_boundaries_settle(edges, &step));
    if (any_remap) {
        TIMED(PHASE_REMAP, status = EACH(remap));
        AB_TRY(status);
        if (edges) TIMED(PHASE_BOUNDARY, ab_boundaries_remap(edges, &step));
        if (in) TIMED(PHASE_CONTACT, status = in->solve(in, &step, AB_STAGE_KINEMATIC, report));
        AB_TRY(status);
    }
    TIMED(PHASE_STRESS, status = EACH(stress));
    AB_TRY(status);
    s->dt = dt;
    s->number += 1;
    s->time = s->fixed_dt > 0.0 && fabs(dt - s->fixed_dt) < 1e-9 * dt ? s->begin + (double)(s->number - s->first_step) * s->fixed_dt
                                                                      : s->time + dt;
    if (s->end - s->time < 1e-9 * dt) s->time = s->end;
    s->half_done = false;
    ab_schedule_look(s);
    ab_drag_after(s, &step);
    return s->stages ? ab_stages_after(s, &step, report) : AB_OK;
}

void ab_schedule_view(const ab_schedule *s, ab_state_view *view) {
    *view = (ab_state_view){.scene = s->scene,
                            .time = s->time,
                            .dt = s->dt,
                            .step = s->number,
                            .limit = s->limit,
                            .domains = s->domains,
                            .energy = s->energy,
                            .motion = s->motion,
                            .energy_start = s->energy_start,
                            .total = s->total,
                            .remainder = s->total_now - s->total_start};
    if (s->stages) view->stage = s->stages->now;
    view->boundaries = s->boundaries ? ab_boundaries_totals(s->boundaries) : NULL;
    view->contacts = s->interaction ? s->interaction->totals(s->interaction) : NULL;
}
