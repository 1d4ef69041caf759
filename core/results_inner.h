/* results_inner.h: what the files of the results share among themselves. */
#ifndef AB_RESULTS_INNER_H
#define AB_RESULTS_INNER_H

#include "core/columns.h"
#include "core/expect.h"
#include "core/frames.h"
#include "core/monitor.h"

typedef struct ab_history ab_history; /* history.csv */

/* Creates the file with its header. `monitors` may be those of a scene without any. */
ab_status ab_history_create(const char *folder, const ab_scene *scene, ab_history **history, ab_report *report);
ab_status ab_history_row(ab_history *history, const ab_state_view *view, ab_monitors *monitors, ab_report *report);
ab_status ab_history_flush(ab_history *history, ab_report *report);
long ab_history_last_step(const ab_history *history); /* of the last row; -1 where there is none */
ab_status ab_history_close(ab_history *history, ab_report *report);
void ab_history_destroy(ab_history *history);

typedef struct ab_contact_sums { /* over the run */
    double impulse[2];           /* N s on the second body */
    double normal, friction;     /* N s: time integrals of the two forces */
    double peak;                 /* N: largest normal force */
    double deepest;              /* m */
} ab_contact_sums;

struct ab_results {
    const ab_scene *scene;
    char *folder;
    ab_monitors *monitors;
    ab_history *history;
    ab_frames *frames; /* NULL without `output` */
    ab_expect *expects;
    size_t *expect_column; /* SIZE_MAX: a monitor */
    size_t expect_count;
    long frame_step;         /* of the last frame; -1 */
    double next_frame;       /* s */
    ab_motion *motion_start; /* per body */
    ab_energy *energy_start;
    ab_contact_sums *contacts; /* per contact */
    double largest_moved;      /* J: the largest change of any term of the ledger so far */
};

/* Largest change of a term of the whole scene between the start and now. */
double ab_results_moved(const ab_results *results, const ab_state_view *view);
/* summary.json, in one piece. */
ab_status ab_summary_write(const ab_results *results, const ab_state_view *view, const ab_run_facts *facts, ab_report *report);

#endif
