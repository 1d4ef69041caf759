/* trade.h: what accuracy costs: one scene run with several settings, its errors beside its cost.
 *
 * A ladder is a setting with its values, from coarse to fine (trade_order.c); the runs (child_runs.h) are all combinations, or those of a walk along the front
 * from the scene's own settings (trade_path.c). */
#ifndef AB_TRADE_H
#define AB_TRADE_H

#include <stdio.h>

#include "core/child_runs.h"
#include "core/document.h"
#include "core/files.h"
#include "core/scene.h"
#include "core/scheduler.h"

enum { AB_TRADE_LADDERS = 8, AB_TRADE_VALUES = 64, AB_TRADE_PATHS = 16, AB_TRADE_RUNS = 4096 };

typedef struct ab_trial { /* one run */
    ab_child run;
    size_t rung[AB_TRADE_LADDERS];
    double remainder;       /* of the ledger, relative to the largest energy that moved */
    double work;            /* points and nodes of elements, times steps */
    double error;           /* the largest of `errors`; NaN: not known */
    double *errors;         /* per judge */
    double *values, *peaks; /* per judge: what was measured; of a monitor, its largest size in the run */
    bool front;             /* no other run is both cheaper and better */
    bool read;              /* what it wrote has been read */
    bool wanted, first;     /* of a walk: it is to be run, or was; it is one of those that a walk begins with */
} ab_trial;

typedef struct ab_judge { /* what errors are measured of: an expect, or a monitor's last value against the best that the runs know */
    const char *name;
    bool monitor;
    double reference; /* monitors: extrapolated, or of the finest run */
    double order;     /* with which it tends to a limit; NaN: to none */
    char doubt[300];  /* why its reference is none to rely on; "": no such thing */
} ab_judge;

typedef struct ab_trade {
    ab_child_runs runs;
    const ab_trade_spec *spec;
    ab_report *report; /* while it runs */
    bool stale;        /* a run has ended that a walk has not seen */
    ab_trial *trials;
    size_t count;
    ab_judge *judges;
    size_t judge_count;
    double work[AB_TRADE_LADDERS][AB_TRADE_VALUES]; /* point-steps with one value, all else as the scene has it; not positive: not known */
    const ab_trial *finest;                         /* against which errors of monitors are; NULL: none, or expects */
    char reference[600];                            /* how the references of monitors were found; "" with expects */
} ab_trade;

/* trade_order.c: brings the values of every ladder into their order from coarse to fine, that of rising point-steps; before ab_trade_plan. */
ab_status ab_trade_order(ab_trade *trade, const ab_run_options *options, ab_registry *registry, ab_report *report);
/* The same with what is known: numbers by their work, words only where it differs by a tenth; all else stays as it was given. */
void ab_trade_sort(ab_ladder *ladder, double *work);
/* Whether the three rungs up to `top` of a ladder refine a run by a constant factor. */
bool ab_trade_refines(const ab_trade *trade, size_t ladder, size_t top, double *factor);
/* All combinations as trials, the last ladder changing fastest; folders named. */
ab_status ab_trade_plan(ab_trade *trade, ab_report *report);
void ab_trade_clear(ab_trade *trade);
/* Runs what is not there yet or had failed, `jobs` at a time, with progress on stderr. 128 + n where signal n stopped it; what is done stays. */
ab_status ab_trade_run(ab_trade *trade, const ab_scene *scene, ab_registry *registry, ab_report *report);
/* The run to be made now, of the `ab_trade` that `owner` is: the cheapest that waits, that is, the lowest on all ladders together; of a walk, among those it wants. NULL: none,
 * or none before another has ended. */
ab_child *ab_trade_next(void *owner);
/* What errors are measured of; before any run. */
ab_status ab_trade_choose_judges(ab_trade *trade, const ab_scene *scene, ab_report *report);
/* Errors, remainders and the front from what the runs wrote; may be called again when there are more. */
void ab_trade_judge(ab_trade *trade, ab_report *report);
/* s of the processor or of wall time, as the trade asks. */
double ab_trade_cost(const ab_trade *trade, const ab_trial *trial);
/* The cheapest run with an error of at most `tolerance`, the most accurate within `seconds` of processor time; SIZE_MAX: none. */
size_t ab_trade_cheapest(const ab_trade *trade, double tolerance);
size_t ab_trade_most_accurate(const ab_trade *trade, double seconds);
/* "constants.cells=40, basis=gimp" */
const char *ab_trade_settings(const ab_trade *trade, const ab_trial *trial, char *text, size_t size);

/* trade_path.c: the first runs that a walk wants, and those next to what is best so far. */
ab_status ab_trade_walk_begin(ab_trade *trade, ab_report *report);
void ab_trade_walk_on(ab_trade *trade);
/* A value of a ladder of words that a walk does not try any more. */
bool ab_trade_given_up(const ab_trade *trade, size_t ladder, size_t value);
bool ab_ladder_is_numeric(const ab_ladder *ladder);

/* trade_write.c, trade_picture.c: the table on a stream; trade.csv, trade.json, trade.svg in the folder. */
void ab_trade_table(const ab_trade *trade, FILE *stream);
ab_status ab_trade_write(const ab_trade *trade, ab_report *report);
void ab_trade_picture(const ab_trade *trade, ab_text *svg);

#endif
