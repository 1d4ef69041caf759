/* results.c: what a run leaves, in the order in which it is made. Everything the scene asks for is found before the first file is touched;
 * results of an earlier run in the same folder are replaced. */
#include "core/results.h"

#include <dirent.h>
#include <fnmatch.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/checkpoint.h"
#include "core/files.h"
#include "core/results_inner.h"

static ab_status expects_begin(ab_results *results, ab_report *report) {
    const ab_scene *scene = results->scene;
    results->expects = calloc(scene->expect_count + 1, sizeof *results->expects);
    results->expect_column = calloc(scene->expect_count + 1, sizeof *results->expect_column);
    if (results->expects == NULL || results->expect_column == NULL) return ab_report_failure(report, "no memory for expects");
    results->expect_count = scene->expect_count;
    ab_status status = AB_OK;
    for (size_t e = 0; e < scene->expect_count; e++) {
        const ab_expect_spec *spec = &scene->expects[e];
        ab_status one = ab_expect_begin(&results->expects[e], spec, report);
        results->expect_column[e] = SIZE_MAX;
        if (one == AB_OK && spec->monitor == SIZE_MAX) {
            results->expect_column[e] = spec->column != NULL ? ab_column_find(scene, spec->column) : SIZE_MAX;
            if (results->expect_column[e] == SIZE_MAX)
                one = ab_report_error(report, spec->mark, "expect '%s': no monitor and no column '%s' in history.csv", spec->name,
                                      spec->column != NULL ? spec->column : "");
        }
        if (one != AB_OK) status = one;
    }
    return status;
}

static ab_status find_all(ab_results *results, const ab_state_view *view, ab_report *report) {
    const ab_scene *scene = view->scene;
    results->motion_start = calloc(scene->body_count + 1, sizeof *results->motion_start);
    results->energy_start = calloc(scene->body_count + 1, sizeof *results->energy_start);
    results->contacts = calloc(scene->contact_count + 1, sizeof *results->contacts);
    if (results->motion_start == NULL || results->energy_start == NULL || results->contacts == NULL)
        return ab_report_failure(report, "no memory for results");
    for (size_t b = 0; b < scene->body_count; b++) {
        results->motion_start[b] = view->motion[b];
        results->energy_start[b] = view->energy[b];
    }
    const ab_status monitors = ab_monitors_create(view, &results->monitors, report), expects = expects_begin(results, report),
                    frames = scene->has_output ? ab_frames_create(scene, view->domains, &results->frames, report) : AB_OK;
    return monitors != AB_OK ? monitors : expects != AB_OK ? expects : frames;
}

/* What an earlier run left under names that this one will write, or not. */
ab_status ab_results_clear(const ab_results *results, bool checkpoints, ab_report *report) {
    static const char *const names[] = {"summary.json", "results.h5", "results.xdmf", AB_CHECKPOINT_NAME, AB_CHECKPOINT_PREVIOUS};
    for (size_t k = 0; k < (checkpoints ? sizeof names / sizeof *names : 3); k++) {
        char *path = ab_path_join(results->folder, names[k]);
        if (path == NULL) return ab_report_failure(report, "no memory for results");
        unlink(path);
        free(path);
    }
    DIR *folder = opendir(results->folder); /* results_BODY.xdmf: the bodies may have had other names */
    for (const struct dirent *entry; folder != NULL && (entry = readdir(folder)) != NULL;)
        if (fnmatch("results_*.xdmf", entry->d_name, 0) == 0) unlinkat(dirfd(folder), entry->d_name, 0);
    if (folder != NULL) closedir(folder);
    return AB_OK;
}

ab_status ab_results_check(const ab_scene *scene, const ab_state_view *view, ab_report *report) {
    ab_results *results = calloc(1, sizeof *results);
    if (results == NULL) return ab_report_failure(report, "no memory for results");
    results->scene = scene;
    const ab_status status = find_all(results, view, report);
    ab_results_destroy(results);
    return status;
}

ab_status ab_results_create(const char *folder, const ab_scene *scene, const ab_state_view *start, ab_results **result, ab_report *report) {
    ab_results *results = calloc(1, sizeof *results);
    *result = NULL;
    if (results == NULL || (results->folder = strdup(folder)) == NULL) {
        free(results);
        return ab_report_failure(report, "no memory for results");
    }
    results->scene = scene;
    results->frame_step = -1;
    const ab_status status = find_all(results, start, report);
    if (status != AB_OK)
        ab_results_destroy(results);
    else
        *result = results;
    return status;
}

ab_status ab_results_begin(ab_results *results, ab_report *report) {
    AB_TRY(ab_folder_make(results->folder, report));
    AB_TRY(ab_history_is_free(results->folder, report));
    AB_TRY(ab_results_clear(results, true, report));
    AB_TRY(ab_history_create(results->folder, results->scene, &results->history, report));
    return results->frames != NULL ? ab_frames_begin(results->frames, results->folder, report) : AB_OK;
}

ab_status ab_results_open(const char *folder, const ab_scene *scene, const ab_state_view *view, ab_results **result, ab_report *report) {
    AB_TRY(ab_results_create(folder, scene, view, result, report));
    const ab_status status = ab_results_begin(*result, report);
    if (status == AB_OK) return AB_OK;
    ab_results_destroy(*result);
    *result = NULL;
    return status;
}

double ab_results_moved(const ab_results *results, const ab_state_view *view) {
    double most = results->largest_moved;
    for (size_t term = 0; term < AB_TERMS; term++) {
        double start = 0;
        for (size_t b = 0; b < view->scene->body_count; b++) start += ab_term_value(&results->energy_start[b], term);
        most = fmax(most, fabs(ab_term_value(&view->total, term) - start));
    }
    return most;
}

/* Of the kinetic energy: a remainder of less is rounding. A body that only moves on moves no energy but that. */
static const double ROUNDING = 1e-6;

double ab_results_remainder(const ab_results *results, const ab_state_view *view) {
    const double moved = ab_results_moved(results, view);
    return moved > 0 && !(fabs(view->remainder) <= ROUNDING * view->total.kinetic) ? view->remainder / moved : 0;
}

static ab_status sample(ab_results *results, const ab_state_view *view, bool last, ab_report *report) {
    for (size_t e = 0; e < results->expect_count; e++) {
        ab_expect *expect = &results->expects[e];
        if (!(last ? ab_expect_wants_last(expect, view->time) : ab_expect_wants(expect, view->time, view->dt))) continue;
        double value = 0;
        if (results->expect_column[e] != SIZE_MAX)
            value = ab_column_value(view, results->expect_column[e]);
        else
            AB_TRY(ab_monitor_value(results->monitors, expect->spec->monitor, view, &value, report));
        ab_expect_sample(expect, view->time, value);
    }
    return AB_OK;
}

static ab_status frame(ab_results *results, const ab_state_view *view, ab_report *report) {
    AB_TRY(ab_history_flush(results->history, report));
    if (results->frames == NULL || results->frame_step == view->step) return AB_OK;
    AB_TRY(ab_frames_write(results->frames, view->contacts, view->time, view->step, report));
    results->frame_step = view->step;
    return AB_OK;
}

static void add_contacts(ab_results *results, const ab_state_view *view) {
    for (size_t k = 0; view->step > 0 && k < view->scene->contact_count; k++) {
        const ab_contact_totals *now = &view->contacts[k];
        ab_contact_sums *sums = &results->contacts[k];
        for (int c = 0; c < 2; c++) sums->impulse[c] += now->impulse[c];
        sums->normal += now->normal_force * view->dt;
        sums->friction += now->friction_force * view->dt;
        sums->peak = fmax(sums->peak, now->normal_force);
        sums->deepest = fmax(sums->deepest, now->penetration);
    }
}

ab_status ab_results_step(ab_results *results, const ab_state_view *view, ab_report *report) {
    const ab_scene *scene = results->scene;
    results->largest_moved = ab_results_moved(results, view);
    add_contacts(results, view);
    AB_TRY(sample(results, view, false, report));
    const long every = scene->history_every > 0 ? scene->history_every : 1;
    if (view->step % every == 0) AB_TRY(ab_history_row(results->history, view, results->monitors, report));
    if (results->frames == NULL) return AB_OK;
    const double slack = 1e-6 * view->dt; /* a frame that is due at the end of this step, but for rounding */
    const bool first = results->frame_step < 0;
    if (!first && (scene->output_every <= 0 || view->time < results->next_frame - slack)) return AB_OK;
    if (scene->output_every > 0) results->next_frame = scene->output_every * (floor((view->time + slack) / scene->output_every) + 1);
    return frame(results, view, report);
}

ab_status ab_results_datum(ab_results *results, const ab_state_view *view, ab_report *report) {
    return ab_monitors_datum(results->monitors, view, report);
}

ab_status ab_results_frame(ab_results *results, const ab_state_view *view, ab_report *report) {
    AB_TRY(sample(results, view, true, report));
    return frame(results, view, report);
}

/* A run whose ledger is left open by more than this part of the energy that moved is no result to build on, and says so. */
static const double ALARM = 0.1;

static void alarm_of_remainder(const ab_results *results, const ab_state_view *view, ab_report *report) {
    const double relative = ab_results_remainder(results, view);
    if (!(fabs(relative) > ALARM)) return;
    bool points = false, elements = false, linear = false, usl = false;
    for (size_t b = 0; b < view->scene->body_count; b++) {
        const ab_body_spec *spec = &view->scene->bodies[b];
        if (ab_domain_is_rigid(view->domains[b])) continue;
        *(view->domains[b]->ops->cells != NULL ? &elements : &points) = true;
        linear = linear || (spec->basis != NULL && strcmp(spec->basis, "linear") == 0);
        usl = usl || (spec->update != NULL && strcmp(spec->update, "usl") == 0);
    }
    ab_report_warning(
        report, view->scene->mark_time,
        "the discretisation %s %.3g %% of the energy that moved (the ledger's remainder): no result to build on; %s%s%s%s%s may help",
        view->remainder > 0.0 ? "made" : "lost", 100.0 * fabs(relative), points ? "a finer grid, " : "", linear ? "basis gimp, " : "",
        usl ? "update musl, " : "", elements ? "more elements, " : "", points || elements ? "or a smaller dt" : "a smaller dt");
}

/* Each part is finished whatever happens to the others; the first trouble is the answer. */
ab_status ab_results_close(ab_results *results, const ab_state_view *view, const ab_run_facts *facts, size_t *missed, ab_report *report) {
    const ab_status parts[] = {
        sample(results, view, true, report),
        ab_history_row(results->history, view, results->monitors, report),
        frame(results, view, report), /* the end is shown, due or not */
        ab_history_close(results->history, report),
        results->frames != NULL ? ab_frames_finish(results->frames, report) : AB_OK,
        ab_summary_write(results, view, facts, report),
    };
    alarm_of_remainder(results, view, report);
    *missed = 0;
    for (size_t e = 0; e < results->expect_count; e++) *missed += ab_expect_end(&results->expects[e]).pass ? 0 : 1;
    for (size_t part = 0; part < sizeof parts / sizeof *parts; part++)
        if (parts[part] != AB_OK) return parts[part];
    return AB_OK;
}

void ab_results_destroy(ab_results *results) {
    if (results == NULL) return;
    ab_monitors_destroy(results->monitors);
    ab_history_destroy(results->history);
    ab_frames_destroy(results->frames);
    free(results->expects);
    free(results->expect_column);
    free(results->motion_start);
    free(results->energy_start);
    free(results->contacts);
    free(results->folder);
    free(results);
}
