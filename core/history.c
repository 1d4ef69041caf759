/* history.c: history.csv, a row per step or per history.every steps. Rows are gathered and put on the disk at least once a second and with
 * every frame, so that a run that is killed keeps them. A file that lost its last rows still ends on a whole one or on a part without line end. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/files.h"
#include "core/results_inner.h"

struct ab_history {
    const ab_scene *scene;
    FILE *file;
    char *path;
    size_t columns;
    long last_step;
    double flushed; /* s */
};

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static ab_status failed(const ab_history *history, ab_report *report) {
    return ab_report_failure(report, "cannot write '%s': %s; %s", history->path, strerror(errno),
                             history->last_step < 0 ? "name another folder with -o" : "the rows before are kept");
}

/* A name as a field of a csv file: quoted where it has to be. */
static void put_name(FILE *file, const char *name) {
    if (strpbrk(name, ",\"\n") == NULL) {
        fputs(name, file);
        return;
    }
    fputc('"', file);
    for (; *name != '\0'; name++) {
        if (*name == '"') fputc('"', file);
        fputc(*name, file);
    }
    fputc('"', file);
}

ab_status ab_history_create(const char *folder, const ab_scene *scene, ab_history **result, ab_report *report) {
    ab_history *history = calloc(1, sizeof *history);
    *result = history;
    if (history == NULL || (history->path = ab_path_join(folder, "history.csv")) == NULL)
        return ab_report_failure(report, "no memory for history.csv");
    history->scene = scene;
    history->columns = ab_column_count(scene);
    history->last_step = -1;
    history->file = fopen(history->path, "we");
    if (history->file == NULL) return failed(history, report);
    setvbuf(history->file, NULL, _IOFBF, 1 << 18);
    char name[320];
    for (size_t c = 0; c < history->columns; c++) {
        ab_column_name(scene, c, name, sizeof name);
        if (c > 0) fputc(',', history->file);
        put_name(history->file, name);
    }
    for (size_t m = 0; m < scene->monitor_count; m++) {
        fputc(',', history->file);
        put_name(history->file, scene->monitors[m].name);
    }
    fputc('\n', history->file);
    return ab_history_flush(history, report);
}

/* Every digit that matters; the zeros that fill most ledgers and whole numbers take a short way. */
static void put_number(FILE *file, double value) {
    if (value == 0 || (fabs(value) < 1e15 && value == (double)(long long)value))
        fprintf(file, "%lld", (long long)value);
    else
        fprintf(file, "%.17g", value);
}

ab_status ab_history_row(ab_history *history, const ab_state_view *view, ab_monitors *monitors, ab_report *report) {
    if (history->last_step == view->step) return AB_OK;
    for (size_t c = 0; c < history->columns; c++) {
        if (c > 0) fputc(',', history->file);
        put_number(history->file, ab_column_value(view, c));
    }
    for (size_t m = 0; m < history->scene->monitor_count; m++) {
        double value = 0;
        AB_TRY(ab_monitor_value(monitors, m, view, &value, report));
        fputc(',', history->file);
        put_number(history->file, value);
    }
    fputc('\n', history->file);
    history->last_step = view->step;
    if (ferror(history->file)) return failed(history, report);
    return now() - history->flushed > 1.0 ? ab_history_flush(history, report) : AB_OK;
}

ab_status ab_history_flush(ab_history *history, ab_report *report) {
    history->flushed = now();
    return fflush(history->file) != 0 || ferror(history->file) ? failed(history, report) : AB_OK;
}

long ab_history_last_step(const ab_history *history) { return history->last_step; }

ab_status ab_history_close(ab_history *history, ab_report *report) {
    FILE *file = history->file;
    history->file = NULL;
    if (file == NULL) return AB_OK;
    const bool bad = ferror(file) != 0;
    return fclose(file) != 0 || bad ? failed(history, report) : AB_OK;
}

void ab_history_destroy(ab_history *history) {
    if (history == NULL) return;
    if (history->file != NULL) fclose(history->file);
    free(history->path);
    free(history);
}
