/* results_inner.h: what the files of the results share among themselves. */
#ifndef AB_RESULTS_INNER_H
#define AB_RESULTS_INNER_H

#include "core/columns.h"
#include "core/expect.h"
#include "core/frames.h"
#include "core/monitor.h"

typedef struct ab_history ab_history; /* history.csv */

typedef struct ab_history_mark { /* how far the file was when a checkpoint was written */
    size_t bytes, crc;
    long last_step;
} ab_history_mark;

/* AB_FAILED where another run writes into this folder. */
ab_status ab_history_is_free(const char *folder, ab_report *report);
/* Creates the file with its header. `monitors` may be those of a scene without any. */
ab_status ab_history_create(const char *folder, const ab_scene *scene, ab_history **history, ab_report *report);
ab_status ab_history_row(ab_history *history, const ab_state_view *view, ab_monitors *monitors, ab_report *report);
ab_status ab_history_flush(ab_history *history, ab_report *report);
/* Rows so far are on the disk for good. */
ab_status ab_history_get_mark(ab_history *history, ab_history_mark *mark, ab_report *report);
/* Goes on with a file from the mark; what is behind it is cut off. AB_BAD_INPUT: it is not that file. only_look: nothing is changed, and the history only good to be
 * destroyed. */
ab_status ab_history_continue(const char *folder, const ab_scene *scene, const ab_history_mark *mark, bool only_look, ab_history **history,
                              ab_report *report);
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
    ab_history_mark mark;      /* of the checkpoint that the run goes on from */
};

/* What an earlier run left in the folder, frames apart. checkpoints: these too. */
ab_status ab_results_clear(const ab_results *results, bool checkpoints, ab_report *report);

/* Largest change of a term of the whole scene between the start and now. */
double ab_results_moved(const ab_results *results, const ab_state_view *view);
/* The ledger's remainder as a part of that; 0 where it is no more than rounding of the kinetic energy. */
double ab_results_remainder(const ab_results *results, const ab_state_view *view);
/* summary.json, in one piece. */
ab_status ab_summary_write(const ab_results *results, const ab_state_view *view, const ab_run_facts *facts, ab_report *report);

#endif
