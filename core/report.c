/* report.c: keeps every error and warning as a finished line, in order of place. */
#include "core/report.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LINES = 500, MOST_TEXT = 4000 }; /* a file with a mistake in every line must not fill the memory or the screen */

typedef struct line {
    char *text;
    size_t file; /* order in which the file was first named; SIZE_MAX: no file */
    int line, column;
    size_t order;
    bool error; /* or a warning */
} line;

struct ab_report {
    pthread_mutex_t lock;
    line *lines;
    size_t count, capacity, next;
    char **files;
    size_t file_count;
    size_t errors, warnings, dropped;
    bool sorted;
    ab_report_watcher watcher; /* NULL: nobody */
    void *watcher_data;
};

ab_report *ab_report_create(void) {
    ab_report *report = calloc(1, sizeof *report);
    if (report != NULL) pthread_mutex_init(&report->lock, NULL);
    return report;
}

static void forget(ab_report *report) {
    for (size_t i = 0; i < report->count; i++) free(report->lines[i].text);
    report->count = 0;
    report->dropped = 0;
}

void ab_report_destroy(ab_report *report) {
    if (report == NULL) return;
    forget(report);
    free(report->lines);
    for (size_t i = 0; i < report->file_count; i++) free(report->files[i]);
    free(report->files);
    pthread_mutex_destroy(&report->lock);
    free(report);
}

/* The place of a file name among those seen so far; SIZE_MAX where there is none. */
static size_t file_order(ab_report *report, const char *file) {
    if (file == NULL) return SIZE_MAX;
    for (size_t i = 0; i < report->file_count; i++)
        if (strcmp(report->files[i], file) == 0) return i;
    char **files = realloc(report->files, (report->file_count + 1) * sizeof *files);
    if (files == NULL) return SIZE_MAX;
    report->files = files;
    files[report->file_count] = strdup(file);
    if (files[report->file_count] == NULL) return SIZE_MAX;
    return report->file_count++;
}

/* Appends one line; a line that is there already (same place, same text) is not said twice. True when it is new. */
static bool keep(ab_report *report, ab_mark mark, bool error, const char *text) {
    if (report->count >= MOST_LINES) {
        report->dropped++;
        return true;
    }
    for (size_t i = 0; i < report->count; i++)
        if (strcmp(report->lines[i].text, text) == 0) return false;
    if (report->count == report->capacity) {
        const size_t capacity = report->capacity == 0 ? 16 : report->capacity * 2;
        line *lines = realloc(report->lines, capacity * sizeof *lines);
        if (lines == NULL) return true;
        report->lines = lines;
        report->capacity = capacity;
    }
    char *copy = strdup(text);
    if (copy == NULL) return true;
    report->lines[report->count++] = (line){copy, file_order(report, mark.file), mark.line, mark.column, report->next++, error};
    report->sorted = false;
    return true;
}

static void add(ab_report *report, ab_mark mark, const char *kind, size_t *counter, const char *format, va_list arguments) {
    if (report == NULL) return;
    char text[MOST_TEXT];
    int used = 0;
    if (mark.file != NULL && mark.line > 0)
        used = snprintf(text, sizeof text, "%.1000s:%d:%d: %s: ", mark.file, mark.line, mark.column, kind);
    else if (mark.file != NULL)
        used = snprintf(text, sizeof text, "%.1000s: %s: ", mark.file, kind);
    else
        used = snprintf(text, sizeof text, "%s: ", kind);
    vsnprintf(text + used, sizeof text - (size_t)used, format, arguments);
    for (char *c = text; *c != '\0'; c++) /* one line each, and nothing that moves the cursor of a terminal */
        if ((unsigned char)*c < 32 || *c == 127) *c = ' ';
    pthread_mutex_lock(&report->lock);
    if (keep(report, mark, counter == &report->errors, text)) ++*counter;
    pthread_mutex_unlock(&report->lock);
}

void ab_report_watch(ab_report *report, ab_report_watcher watcher, void *data) {
    if (report == NULL) return;
    report->watcher = watcher;
    report->watcher_data = data;
}

void ab_report_progress(ab_report *report, double share, const char *format, ...) {
    if (report == NULL || report->watcher == NULL) return;
    char text[500];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    report->watcher(report->watcher_data, share, text);
}

ab_status ab_report_error(ab_report *report, ab_mark mark, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    add(report, mark, "error", report == NULL ? NULL : &report->errors, format, arguments);
    va_end(arguments);
    return AB_BAD_INPUT;
}

ab_status ab_report_failure(ab_report *report, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    add(report, AB_NOWHERE, "error", report == NULL ? NULL : &report->errors, format, arguments);
    va_end(arguments);
    return AB_FAILED;
}

void ab_report_warning(ab_report *report, ab_mark mark, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    add(report, mark, "warning", report == NULL ? NULL : &report->warnings, format, arguments);
    va_end(arguments);
}

size_t ab_report_errors(const ab_report *report) { return report->errors; }
size_t ab_report_warnings(const ab_report *report) { return report->warnings; }

static int by_place(const void *left, const void *right) {
    const line *a = left, *b = right;
    if (a->file != b->file) return a->file < b->file ? -1 : 1;
    if (a->line != b->line) return a->line < b->line ? -1 : 1;
    if (a->column != b->column) return a->column < b->column ? -1 : 1;
    return a->order < b->order ? -1 : 1;
}

static void sort(ab_report *report) {
    if (!report->sorted && report->count > 1) qsort(report->lines, report->count, sizeof *report->lines, by_place);
    report->sorted = true;
}

const char *ab_report_text(const ab_report *report, size_t item) {
    ab_report *own = (ab_report *)(size_t)report; /* sorting changes no meaning, only the order of what is kept */
    pthread_mutex_lock(&own->lock);
    sort(own);
    const char *text = item < own->count ? own->lines[item].text : NULL;
    pthread_mutex_unlock(&own->lock);
    return text;
}

const char *ab_report_first_error(const ab_report *report) {
    const char *text = NULL;
    ab_report *own = (ab_report *)(size_t)report;
    pthread_mutex_lock(&own->lock);
    sort(own);
    for (size_t i = 0; i < own->count && text == NULL; i++)
        if (own->lines[i].error) text = own->lines[i].text;
    pthread_mutex_unlock(&own->lock);
    return text;
}

void ab_report_print(ab_report *report, FILE *stream) {
    pthread_mutex_lock(&report->lock);
    sort(report);
    for (size_t i = 0; i < report->count; i++) fprintf(stream, "%s\n", report->lines[i].text);
    if (report->dropped > 0) fprintf(stream, "... and %zu more that are not shown\n", report->dropped);
    forget(report);
    pthread_mutex_unlock(&report->lock);
}
