/* run.c: a whole run: steps between files, checkpoints, signals and progress, and what is told at its end. */
#define _GNU_SOURCE
#include <string.h>

#include "core/checkpoint_run.h"
#include "core/doubts.h"
#include "core/drag.h"
#include "core/memory.h"
#include "core/phases.h"
#include "core/plan.h"
#include "core/progress.h"
#include "core/scheduler.h"
#include "core/stages.h"
#include "core/stop.h"
#include "core/watchdog.h"

static const char *const PHASE_NAMES[PHASES] = {"nodes from points",          "contact", "points from nodes", "nodes again",
                                                "stress and points to nodes", "results", "boundaries"};

static void warn_of_failures(const ab_schedule *s, ab_report *report) {
    const ab_contact_totals *totals = s->interaction ? s->interaction->totals(s->interaction) : NULL;
    for (size_t c = 0; totals && c < s->scene->contact_count; ++c)
        if (totals[c].failures > 0)
            ab_report_warning(
                report, s->scene->contacts[c].mark,
                "contact of '%s' and '%s': %zu places could not be decided and were passed over (summary.json: failures); look "
                "for faces that have no length or are strongly bent",
                s->scene->bodies[s->scene->contacts[c].body[0]].name, s->scene->bodies[s->scene->contacts[c].body[1]].name,
                totals[c].failures);
}

/* Steps until the end, a failure or a signal. A run that is stopped between two steps leaves a checkpoint; one that fails within a step cannot. */
static ab_status advance(ab_schedule *s, ab_results *results, ab_checkpoints *checkpoints, ab_progress *progress, ab_report *report) {
    while (!ab_stages_done(s) && !ab_stop_signal()) {
        ab_state_view view;
        bool datum;
        AB_TRY(ab_schedule_next(s, &datum, report));
        ab_schedule_view(s, &view);
        if (datum) AB_TRY(ab_results_datum(results, &view, report));
        const ab_status stepped = ab_schedule_step(s, report);
        if (stepped != AB_OK && !s->half_done) TIMED(PHASE_RESULTS, ab_checkpoints_step(checkpoints, s, results, true, report));
        AB_TRY(stepped);
        ab_schedule_view(s, &view);
        ab_status status = AB_OK;
        TIMED(PHASE_RESULTS, status = ab_results_step(results, &view, report));
        AB_TRY(status);
        ab_progress_step(progress, &view);
        const ab_status watched = ab_watchdog_step(s, report);
        TIMED(PHASE_RESULTS, status = ab_checkpoints_step(checkpoints, s, results, watched != AB_OK, report));
        AB_TRY(watched);
        AB_TRY(status);
    }
    return ab_stop_signal() ? ab_checkpoints_step(checkpoints, s, results, true, report) : AB_OK;
}

static void count_work(ab_schedule *s) {
    for (size_t b = 0; b < s->body_count; ++b) {
        const ab_domain *domain = s->domains[b];
        ab_cells cells = {0};
        if (ab_domain_is_rigid(domain)) {
            s->rigid++;
            continue;
        }
        if (domain->ops->cells) domain->ops->cells(domain, &cells);
        *(domain->ops->cells ? &s->nodes : &s->points) += domain->ops->count(domain);
        s->elements += cells.count;
    }
}

/* The files, from the start or from where they were at a checkpoint. */
static ab_status open_results(ab_schedule *s, ab_checkpoint *from, const char *folder, ab_results **results, ab_report *report) {
    ab_state_view view;
    ab_schedule_view(s, &view);
    AB_TRY(ab_results_create(folder, s->scene, &view, results, report));
    if (from) {
        AB_TRY(ab_checkpoint_restore(from, s, *results));
        return ab_results_continue(*results, report);
    }
    AB_TRY(ab_results_begin(*results, report));
    return ab_results_step(*results, &view, report);
}

ab_status ab_run(const ab_scene *scene, const ab_run_options *options, ab_report *report) {
    ab_schedule *s = NULL;
    ab_checkpoint *from = NULL;
    if (options->restart) AB_TRY(ab_checkpoint_open_for(options->restart, scene, &from, report));
    ab_status status = ab_schedule_create(scene, options, &s, report);
    if (status == AB_OK && !from) {
        status = ab_doubts(s, report);
        s->warned = s->fixed_dt > s->critical_dt;
        if (status != AB_OK) ab_schedule_destroy(s);
    }
    if (status != AB_OK) {
        ab_checkpoint_destroy(from);
        return status;
    }
    ab_report_print(report, stderr);
    ab_stop_keeper keeper;
    ab_stop_catch(&keeper); /* before the first byte is written: a full disk or a signal must not end the program where nothing is said */
    ab_state_view view;
    ab_results *results = NULL;
    ab_checkpoints checkpoints = {0};
    status = open_results(s, from, options->folder, &results, report);
    ab_checkpoint_destroy(from);
    if (status == AB_OK) status = ab_checkpoints_begin(&checkpoints, s, options->folder, report);
    if (status != AB_OK) {
        ab_results_destroy(results);
        ab_schedule_destroy(s);
        ab_stop_release(&keeper);
        return status;
    }
    const long first = s->number;
    count_work(s);
    ab_progress progress;
    ab_progress_begin(&progress, stderr, options->quiet, scene->time_end, s->points + s->elements + s->rigid);
    ab_text plan_json = {0};
    ab_plan_add_json(&plan_json, s, options, 0.0);
    const double wall = ab_seconds(CLOCK_MONOTONIC), cpu = ab_seconds(CLOCK_PROCESS_CPUTIME_ID);
    status = advance(s, results, &checkpoints, &progress, report);
    ab_progress_end(&progress);
    ab_run_facts facts = {.wall_seconds = ab_seconds(CLOCK_MONOTONIC) - wall,
                          .cpu_seconds = ab_seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu,
                          .steps = s->number,
                          .threads = options->threads,
                          .points = s->points,
                          .nodes = s->nodes,
                          .elements = s->elements,
                          .rigid = s->rigid,
                          .version = ABUT_VERSION,
                          .outcome = "done",
                          .plan_json = plan_json.failed ? NULL : plan_json.bytes};
    char outcome[256];
    if (status != AB_OK) {
        const char *why = ab_report_first_error(report);
        snprintf(outcome, sizeof outcome, "failed: %s", why ? why : "no reason given");
        if (!options->quiet) ab_checkpoints_tell(&checkpoints, s, options->restart, stderr);
        facts.outcome = outcome;
    } else if (ab_stop_signal()) {
        if (!options->quiet) fprintf(stderr, "stopped at t = %.9g s; go on with --restart %s\n", s->time, checkpoints.path);
        snprintf(outcome, sizeof outcome, "stopped by signal %d", ab_stop_signal());
        facts.outcome = outcome;
        status = (ab_status)(128 + ab_stop_signal());
    }
    const double stepping = facts.wall_seconds - s->phase_seconds[PHASE_RESULTS];
    const double rate = stepping > 0.0 ? (double)(s->number - first) / stepping : 0.0;
    facts.point_steps_per_second = rate * (double)s->points;
    facts.element_steps_per_second = rate * (double)s->elements;
    facts.peak_bytes = ab_memory_peak();
    for (int p = 0; p < (s->boundaries ? PHASES : PHASE_BOUNDARY); ++p) {
        facts.phase_names[p] = PHASE_NAMES[p];
        facts.phase_seconds[p] = s->phase_seconds[p];
    }
    size_t bytes = 0;
    for (size_t b = 0; b < s->body_count; ++b) {
        ab_plan_body plan;
        s->domains[b]->ops->plan(s->domains[b], &plan);
        if (!s->domains[b]->ops->cells && !ab_domain_is_rigid(s->domains[b])) bytes += plan.bytes;
    }
    facts.bytes_per_point = s->points ? bytes / s->points : 0;
    ab_schedule_view(s, &view);
    size_t missed = 0;
    warn_of_failures(s, report);
    ab_drag_warn(s, report);
    const ab_status closed = ab_results_frame(results, &view, report); /* the end, as far as it came */
    if (!options->quiet) ab_results_table(results, &view, &facts, stdout);
    const ab_status written = ab_results_close(results, &view, &facts, &missed, report);
    if (status == AB_OK) status = closed != AB_OK ? closed : written;
    if (status == AB_OK && missed && options->strict) status = AB_MISSED;
    ab_results_destroy(results);
    ab_text_clear(&plan_json);
    ab_checkpoints_end(&checkpoints);
    ab_schedule_destroy(s);
    ab_stop_release(&keeper);
    return status;
}
