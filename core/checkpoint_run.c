/* checkpoint_run.c: what a checkpoint of a run holds: the scene as text, the schedule, every body, contact, results. */
#include "core/checkpoint_run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/boundary.h"
#include "core/drag.h"
#include "core/scene_text.h"
#include "core/stages.h"
#include "core/watchdog.h"

static double wall_clock(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- the scene -------------------------------------------------------------------------------------------------------------- */

static size_t line_length(const char *text, size_t left) {
    const char *end = memchr(text, '\n', left);
    return end != NULL ? (size_t)(end - text) : left;
}

/* "bodies.block.basis: linear" of a line that may be long. */
static void quote(const char *line, size_t length, char *out, size_t size) {
    snprintf(out, size, "%.*s%s", (int)(length < 200 ? length : 200), line, length > 200 ? "..." : "");
}

static ab_status compare_scenes(ab_checkpoint *c, const char *before, size_t before_count, const ab_text *now) {
    size_t a = 0, b = 0;
    while (a < before_count || b < now->count) {
        const size_t la = line_length(before + a, before_count - a), lb = line_length(now->bytes + b, now->count - b);
        if (la == lb && memcmp(before + a, now->bytes + b, la) == 0) {
            a += la + 1, b += lb + 1;
            continue;
        }
        char was[256], is[256];
        quote(before + a, la, was, sizeof was);
        quote(now->bytes + b, lb, is, sizeof is);
        ab_checkpoint_refuse(c,
                             "the scene has changed since: '%s' was there, '%s' is now; only title, time.end, monitors, history, output, "
                             "expect, checkpoint, "
                             "watchdog, checked, trade and extremes may change: take that back, or run the scene from its start",
                             la > 0 ? was : "nothing more", lb > 0 ? is : "nothing more");
        break;
    }
    return ab_checkpoint_status(c);
}

ab_status ab_checkpoint_open_for(const char *path, const ab_scene *scene, ab_checkpoint **checkpoint, ab_report *report) {
    AB_TRY(ab_checkpoint_open(path, checkpoint, report));
    size_t count = 0;
    const char *before = ab_checkpoint_get(*checkpoint, "scene", &count);
    ab_text now = {0};
    ab_scene_text(scene, &now);
    if (before == NULL)
        ab_checkpoint_refuse(*checkpoint, "says nothing of its scene");
    else if (now.failed)
        ab_checkpoint_refuse(*checkpoint, "no memory to compare its scene");
    else
        compare_scenes(*checkpoint, before, count, &now);
    ab_text_clear(&now);
    const ab_status status = ab_checkpoint_status(*checkpoint);
    if (status == AB_OK) return AB_OK;
    ab_checkpoint_destroy(*checkpoint);
    *checkpoint = NULL;
    return status;
}

/* ---- the state -------------------------------------------------------------------------------------------------------------- */

static bool keep_schedule(ab_schedule *s, ab_checkpoint *c) {
    const size_t bodies = s->body_count, energies = bodies * sizeof *s->energy / sizeof(double),
                 motions = bodies * sizeof *s->motion / sizeof(double);
    ab_checkpoint_enter(c, "run");
    const bool good = ab_keep_doubles(c, "time", &s->time, 1) && ab_keep_doubles(c, "dt", &s->dt, 1) &&
                      ab_keep_long(c, "step", &s->number) && ab_keep_doubles(c, "critical_dt", &s->critical_dt, 1) &&
                      ab_keep_doubles(c, "first_critical_dt", &s->first_critical_dt, 1) && ab_keep_flags(c, "warned", &s->warned, 1) &&
                      ab_keep_doubles(c, "energy", (double *)s->energy, energies) &&
                      ab_keep_doubles(c, "energy_start", (double *)s->energy_start, energies) &&
                      ab_keep_doubles(c, "motion", (double *)s->motion, motions) && ab_keep_struct(c, "total", &s->total) &&
                      ab_keep_doubles(c, "total_now", &s->total_now, 1) && ab_keep_doubles(c, "total_start", &s->total_start, 1) &&
                      ab_watchdog_keep(s, c) && ab_drag_keep(s, c) && ab_stages_keep(s, c);
    ab_checkpoint_leave(c);
    return good;
}

static ab_status keep_all(ab_schedule *s, ab_results *results, ab_checkpoint *c) {
    if (keep_schedule(s, c)) {
        for (size_t b = 0; b < s->body_count; ++b) {
            ab_checkpoint_enter(c, "bodies.%s", s->scene->bodies[b].name);
            s->domains[b]->ops->keep(s->domains[b], c);
            ab_checkpoint_leave(c);
        }
        if (s->interaction) {
            ab_checkpoint_enter(c, "contacts");
            s->interaction->keep(s->interaction, c);
            ab_checkpoint_leave(c);
        }
        if (s->boundaries) {
            ab_checkpoint_enter(c, "boundaries");
            ab_boundaries_keep(s->boundaries, c);
            ab_checkpoint_leave(c);
        }
        ab_checkpoint_enter(c, "results");
        ab_results_keep(results, c);
        ab_checkpoint_leave(c);
    }
    return ab_checkpoint_status(c);
}

ab_status ab_checkpoint_restore(ab_checkpoint *c, ab_schedule *s, ab_results *results) {
    AB_TRY(keep_all(s, results, c));
    if (!(s->time >= 0.0 || s->stages) || s->number < 0) ab_checkpoint_refuse(c, "its time %g s is none", s->time);
    if (s->time > s->scene->time_end)
        ab_checkpoint_refuse(c, "is of t = %.9g s, and time.end of the scene is %.9g s: write a later one", s->time, s->scene->time_end);
    return ab_checkpoint_status(c);
}

static ab_status write_one(const ab_checkpoints *checkpoints, ab_schedule *s, ab_results *results, ab_report *report) {
    ab_checkpoint *c = NULL;
    AB_TRY(ab_checkpoint_create(checkpoints->path, &c, report));
    ab_text scene = {0};
    ab_scene_text(s->scene, &scene);
    if (scene.failed)
        ab_checkpoint_refuse(c, "no memory");
    else
        ab_checkpoint_put(c, "scene", scene.bytes, scene.count);
    ab_text_clear(&scene);
    ab_status status = keep_all(s, results, c);
    if (status == AB_OK) status = ab_checkpoint_commit(c, checkpoints->previous);
    ab_checkpoint_destroy(c);
    return status;
}

/* ---- when ------------------------------------------------------------------------------------------------------------------- */

static double next_time(const ab_schedule *s) {
    const double every = s->scene->checkpoint_every;
    return every > 0.0 ? every * (floor((s->time + 1e-6 * s->dt) / every) + 1.0) : (double)INFINITY;
}

ab_status ab_checkpoints_begin(ab_checkpoints *k, const ab_schedule *s, const char *folder, ab_report *report) {
    const ab_scene *scene = s->scene;
    *k = (ab_checkpoints){
        .path = ab_path_join(folder, AB_CHECKPOINT_NAME), .previous = ab_path_join(folder, AB_CHECKPOINT_PREVIOUS), .last = -1};
    if (k->path == NULL || k->previous == NULL) return ab_report_failure(report, "no memory for checkpoints");
    k->next = next_time(s);
    k->wall = scene->checkpoint_wall > 0.0 ? scene->checkpoint_wall : (double)INFINITY;
    k->steps = scene->checkpoint_steps;
    k->at_end = scene->has_checkpoint;
    if (k->wall < (double)INFINITY) k->written = wall_clock();
    return AB_OK;
}

ab_status ab_checkpoints_step(ab_checkpoints *k, ab_schedule *s, ab_results *results, bool now, ab_report *report) {
    if (k->last == s->number) return AB_OK;
    const bool due = now || s->time >= k->next - 1e-6 * s->dt || (k->steps > 0 && s->number % k->steps == 0) ||
                     (k->wall < (double)INFINITY && wall_clock() - k->written >= k->wall) || (k->at_end && ab_stages_done(s));
    if (!due) return AB_OK;
    AB_TRY(write_one(k, s, results, report));
    k->next = next_time(s);
    k->last = s->number;
    if (k->wall < (double)INFINITY) k->written = wall_clock();
    return AB_OK;
}

void ab_checkpoints_tell(const ab_checkpoints *k, const ab_schedule *s, const char *from, FILE *stream) {
    static const char *const AGAIN = "the same bits again up to here; with a smaller output.every its frames show how it came";
    if (k->last == s->number)
        fprintf(stream, "a checkpoint of this moment, step %ld, is %s\n", k->last, k->path);
    else if (k->last >= 0)
        fprintf(stream, "the last checkpoint is of step %ld; --restart %s computes %s\n", k->last, k->path, AGAIN);
    else if (from)
        fprintf(stream, "there is no checkpoint since; --restart %s computes %s\n", from, AGAIN);
    else
        fprintf(stream,
                "there is no checkpoint: with checkpoint: {wall: 10} in the scene a run can be gone over again from shortly before\n");
}

void ab_checkpoints_end(ab_checkpoints *k) {
    free(k->path), free(k->previous);
    *k = (ab_checkpoints){0};
}
