/* report.h: what went wrong, collected where it is known and printed once. Also the status every fallible function returns. */
#ifndef AB_REPORT_H
#define AB_REPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef enum ab_status { /* the exit status of the program, too */
                         AB_OK = 0,
                         AB_FAILED = 1,    /* the run failed: blow-up, a lost point, a full disk, no memory */
                         AB_BAD_INPUT = 2, /* the input is wrong */
                         AB_MISSED = 3     /* an expect missed with --strict */
} ab_status;

/* A place in a text the user wrote. line 0: no place known; file NULL: none. Line and column count from 1. */
typedef struct ab_mark {
    const char *file; /* borrowed; lives as long as the document it came from. "--set PATH" for an override */
    int line, column;
} ab_mark;

typedef struct ab_report ab_report;

ab_report *ab_report_create(void);
void ab_report_destroy(ab_report *report);

/* Each adds one line "file:line:column: error: text" (the place is left out where it is not known). The text says what, where and the remedy.
 * ab_report_error returns AB_BAD_INPUT and ab_report_failure AB_FAILED, so that `return ab_report_error(...)` reads well. Thread-safe. */
ab_status ab_report_error(ab_report *report, ab_mark mark, const char *format, ...) __attribute__((format(printf, 3, 4)));
ab_status ab_report_failure(ab_report *report, const char *format, ...) __attribute__((format(printf, 2, 3)));
void ab_report_warning(ab_report *report, ab_mark mark, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* How far a long preparation is (share: 0 .. 1), for whoever watches; nothing is kept. Not from several threads at once. */
typedef void (*ab_report_watcher)(void *data, double share, const char *text);
void ab_report_watch(ab_report *report, ab_report_watcher watcher, void *data); /* NULL: nobody */
void ab_report_progress(ab_report *report, double share, const char *format, ...) __attribute__((format(printf, 3, 4)));

size_t ab_report_errors(const ab_report *report); /* errors and failures so far */
size_t ab_report_warnings(const ab_report *report);
const char *ab_report_text(const ab_report *report, size_t item); /* item-th line, in order of place; NULL past the end */
const char *ab_report_first_error(const ab_report *report);       /* the same of the first line that is no warning; NULL without */

/* Prints all lines, sorted by file order and place, errors and warnings; then forgets them (the counts stay). */
void ab_report_print(ab_report *report, FILE *stream);

#define AB_NOWHERE ((ab_mark){NULL, 0, 0})

/* Returns up when a call failed. */
#define AB_TRY(call)                                                                                                                       \
    do {                                                                                                                                   \
        const ab_status ab_try_status_ = (call);                                                                                           \
        if (ab_try_status_ != AB_OK) return ab_try_status_;                                                                                \
    } while (0)

#endif
