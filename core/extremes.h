/* extremes.h: how far quantities of a scene go: where a run stops being right, where it stops being stable, from where it is refused.
 *
 * A quantity (ab_extreme) is tried on a ladder from its easy end to its hard one; then the rungs between which it stops being right, stable or accepted are halved, and those
 * between which it begins to be, where its easy end is not. Verdicts need not be monotone: all that was tried is kept, and pieces beyond this stretch are told. Runs are
 * processes (child_runs.h). */
#ifndef AB_EXTREMES_H
#define AB_EXTREMES_H

#include <stdio.h>

#include "core/child_runs.h"
#include "core/files.h"

enum { AB_EXTREMES_QUANTITIES = 64, AB_EXTREMES_PATHS = 16, AB_EXTREMES_VALUES = 64, AB_EXTREMES_TEXT = 400 };

typedef enum ab_verdict {                      /* in the order of the worse */
                          AB_VERDICT_NONE = 0, /* not run, or the machine failed: no memory, no room */
                          AB_VERDICT_RIGHT,
                          AB_VERDICT_WRONG,    /* came to its end, but an expect is missed */
                          AB_VERDICT_UNSTABLE, /* broke off, or made energy, or lost mass, or no number came out, or over the limit of time */
                          AB_VERDICT_REFUSED   /* exit 2: the input says that it will not do */
} ab_verdict;
const char *ab_verdict_name(ab_verdict verdict);

typedef struct ab_sample { /* one run */
    ab_child run;
    size_t quantity, rung; /* rung: of the ladder; SIZE_MAX where it was halved */
    size_t second;         /* of a map: its other quantity, SIZE_MAX: none */
    size_t second_rung;
    double value;                                         /* NaN: a word */
    char text[AB_EXTREMES_TEXT], other[AB_EXTREMES_TEXT]; /* what the paths of either get */
    char shown[80], other_shown[80];                      /* the value, as tables have it */
    ab_verdict verdict;
    bool told;               /* the run itself said why, or refused */
    double error, tolerance; /* of the expect that is off most; NaN: none */
    double remainder;
    double *parts;  /* per expect: what was measured, as a part of its reference */
    char why[2000]; /* one line: what is not right; "" where all is */
} ab_sample;

typedef struct ab_bracket {          /* neighbours between which a verdict changes */
    const ab_sample *before, *after; /* before NULL: from the first value on; after NULL: never */
} ab_bracket;

typedef struct ab_stretch { /* the first one along which verdicts are better than a given one */
    ab_bracket begin, end;  /* begin.after NULL: there is none; then end.after is the first value, if any has a verdict */
} ab_stretch;

typedef struct ab_extremes {
    ab_child_runs runs;
    const ab_scene *scene;
    const ab_extremes_spec *spec;
    ab_sample **samples;
    size_t count, capacity;
    bool failed;  /* no memory for one more */
    size_t tried; /* samples that have a verdict */
} ab_extremes;

/* The ladders of all quantities and the cells of the map as samples. */
ab_status ab_extremes_plan(ab_extremes *extremes, ab_report *report);
void ab_extremes_clear(ab_extremes *extremes);
/* Runs them, and those between them. 128 + n where signal n stopped it; what is done stays. */
ab_status ab_extremes_run(ab_extremes *extremes, const ab_scene *scene, ab_registry *registry, ab_report *report);

/* The samples of one quantity (not of the map) in the order of its way, in `list` of extremes->count places; how many. */
size_t ab_extremes_along(const ab_extremes *extremes, size_t quantity, ab_sample **list);
/* Of verdicts better than `worst`. */
ab_stretch ab_extremes_stretch(ab_sample *const *list, size_t count, ab_verdict worst);
/* The sample of a map's cell, or NULL. */
const ab_sample *ab_extremes_cell(const ab_extremes *extremes, size_t rung, size_t second_rung);
size_t ab_extremes_rungs(const ab_extreme *quantity);

/* extremes_verdict.c: from what a run left. */
void ab_extremes_judge(const ab_extremes *extremes, ab_sample *sample);
/* With `same`: what is right but not the same as with the first value is wrong. */
void ab_extremes_compare(const ab_extremes *extremes, size_t quantity);
/* The sample against which a quantity does not hold, NULL: it holds. */
const ab_sample *ab_extremes_fault(const ab_extremes *extremes, size_t quantity);

/* extremes_write.c, extremes_map.c: the table; extremes.csv, extremes.json, map.svg in the folder. */
void ab_extremes_table(const ab_extremes *extremes, FILE *stream);
ab_status ab_extremes_write(const ab_extremes *extremes, ab_report *report);
void ab_extremes_map(const ab_extremes *extremes, ab_text *svg);

#endif
