/* progress.h: how far a run is, on a terminal as a bar, elsewhere as a line now and then. */
#ifndef AB_PROGRESS_H
#define AB_PROGRESS_H

#include "core/results.h"

typedef struct ab_progress { /* filled by begin; no part of it is for others */
    FILE *stream;
    bool quiet, terminal, drawn;
    double time_end;                /* s, of the scene */
    size_t work;                    /* points, elements and rigid bodies, each taken on by a step at a time */
    long stride, next;              /* the clock is looked at every `stride` steps */
    double started, checked, shown; /* s, of the clock */
    double rate_clock, rate_time;   /* where the rates below were measured last */
    long rate_step;
    double work_per_second, time_per_second;
    int tenth; /* of the run, shown last */
} ab_progress;

/* stream: stderr in a run. A bar where it is a terminal, else lines: at each tenth, though not within a second of the one before, and every 10 s. */
void ab_progress_begin(ab_progress *progress, FILE *stream, bool quiet, double time_end, size_t work);
/* After every step; costs a comparison in most of them. At most ten redrawings a second. */
void ab_progress_step(ab_progress *progress, const ab_state_view *view);
/* Of what comes before the run, such as filling a body: an ab_report_watcher, `progress` as its data. Nothing in the first second. */
void ab_progress_prepare(void *progress, double share, const char *text);
/* Takes the bar away. */
void ab_progress_end(ab_progress *progress);
/* The line as shown (share, t, remaining time, million point- and element-steps per second, remainder, step, dt and what binds it), no longer than `width` characters; for a terminal with a bar. */
void ab_progress_format(const ab_progress *progress, const ab_state_view *view, int width, char *line, size_t size);

#endif
