/* results_keep.c: results across a checkpoint: sums that have begun are kept in it; files are gone on with from where they were, or begun anew in another folder. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/checkpoint.h"
#include "core/files.h"
#include "core/results_inner.h"
#include "core/scene_text.h"

/* The running sums of an expect. */
static bool keep_sums(ab_expect *e, ab_checkpoint *c) {
    double *const numbers[] = {&e->first_time,
                               &e->time,
                               &e->value,
                               &e->reference,
                               &e->worst,
                               &e->worst_value,
                               &e->worst_reference,
                               &e->largest_reference,
                               &e->peak,
                               &e->peak_time,
                               &e->least,
                               &e->integral,
                               &e->square_error,
                               &e->square_value,
                               &e->square_reference,
                               &e->first_above,
                               &e->last_above,
                               &e->origin,
                               &e->sum_t,
                               &e->sum_y,
                               &e->sum_tt,
                               &e->sum_ty};
    enum { COUNT = sizeof numbers / sizeof *numbers };
    double values[COUNT];
    for (size_t k = 0; k < COUNT; k++) values[k] = *numbers[k];
    if (!ab_keep_size(c, "samples", &e->samples) || !ab_keep_flags(c, "broken", &e->broken, 1) ||
        !ab_keep_doubles(c, "sums", values, COUNT))
        return false;
    for (size_t k = 0; k < COUNT; k++) *numbers[k] = values[k];
    return true;
}

/* An expect is the one it was when the scene says the same of it; a new one sees only what comes. */
static void keep_expects(ab_results *results, ab_checkpoint *c) {
    const ab_scene *scene = results->scene;
    size_t kept = scene->expect_count;
    if (!ab_keep_count(c, "expects", &kept, 8)) return;
    for (size_t e = 0; e < scene->expect_count; e++) {
        ab_text text = {0};
        ab_scene_text_of_expect(scene, e, &text);
        bool met = false, good = !text.failed;
        for (size_t k = 0; good && !met && k < (ab_checkpoint_loads(c) ? kept : 1); k++) {
            ab_checkpoint_enter(c, "expect[%zu]", ab_checkpoint_loads(c) ? k : e);
            if (ab_checkpoint_loads(c)) {
                size_t length = 0;
                const char *before = ab_checkpoint_get(c, "text", &length);
                met = before != NULL && length == text.count && memcmp(before, text.bytes, length) == 0;
            } else {
                ab_checkpoint_put(c, "text", text.bytes, text.count);
                met = true;
            }
            if (met) good = keep_sums(&results->expects[e], c);
            ab_checkpoint_leave(c);
        }
        ab_text_clear(&text);
        if (!good) {
            ab_checkpoint_refuse(c, "expect '%s' is damaged", scene->expects[e].name);
            return;
        }
        if (!met)
            ab_report_warning(ab_checkpoint_report(c), scene->expects[e].mark,
                              "expect '%s' is new or changed since the checkpoint, and sees only what comes after it",
                              scene->expects[e].name);
    }
}

void ab_results_keep(ab_results *results, ab_checkpoint *c) {
    const ab_scene *scene = results->scene;
    double every = scene->output_every;
    ab_history_mark *mark = &results->mark;
    if (!ab_checkpoint_loads(c) && ab_history_get_mark(results->history, mark, ab_checkpoint_report(c)) != AB_OK) {
        ab_checkpoint_refuse(c, "history.csv could not be written");
        return;
    }
    double next = results->next_frame;
    const bool good =
        ab_keep_size(c, "history_bytes", &mark->bytes) && ab_keep_size(c, "history_crc", &mark->crc) &&
        ab_keep_long(c, "history_step", &mark->last_step) && ab_keep_long(c, "frame_step", &results->frame_step) &&
        ab_keep_doubles(c, "output_every", &every, 1) && ab_keep_doubles(c, "next_frame", &next, 1) &&
        ab_keep_doubles(c, "largest_moved", &results->largest_moved, 1) &&
        ab_keep_doubles(c, "contacts", (double *)results->contacts, scene->contact_count * sizeof *results->contacts / sizeof(double));
    if (!good) return;
    if (every == scene->output_every) results->next_frame = next; /* else the next step has one */
    keep_expects(results, c);
    if (scene->stage_count > 0) ab_monitors_keep(results->monitors, c);
    ab_frames_keep(results->frames, c);
}

ab_status ab_results_continue(ab_results *results, ab_report *report) {
    char *path = ab_path_join(results->folder, "history.csv");
    if (path == NULL) return ab_report_failure(report, "no memory for results");
    struct stat found;
    const bool there = lstat(path, &found) == 0;
    free(path);
    if (!there) {
        AB_TRY(ab_folder_make(results->folder, report));
        AB_TRY(ab_results_clear(results, false, report));
        AB_TRY(ab_history_create(results->folder, results->scene, &results->history, report));
        return results->frames != NULL ? ab_frames_continue(results->frames, results->folder, false, report) : AB_OK;
    }
    AB_TRY(ab_history_is_free(results->folder, report));
    /* nothing is changed before all is known to fit */
    const ab_status fits = ab_history_continue(results->folder, results->scene, &results->mark, true, &results->history, report);
    ab_history_destroy(results->history);
    results->history = NULL;
    AB_TRY(fits);
    if (results->frames != NULL) AB_TRY(ab_frames_continue(results->frames, results->folder, true, report));
    return ab_history_continue(results->folder, results->scene, &results->mark, false, &results->history, report);
}
