/* checkpoint_run.h: checkpoints of a whole run: when they are due, what is in them, and how a run goes on from one. */
#ifndef AB_CHECKPOINT_RUN_H
#define AB_CHECKPOINT_RUN_H

#include "core/checkpoint.h"
#include "core/scheduler.h"

typedef struct ab_checkpoints {
    char *path, *previous; /* in the folder of the results */
    double next;           /* s, of the scene's time; INFINITY: not by time */
    double wall, written;  /* s of wall time: between checkpoints, INFINITY: not by that; when the last one was written */
    long steps;            /* 0: not by steps */
    long last;             /* step of the last one; -1 */
    bool at_end;           /* the scene asks for checkpoints */
} ab_checkpoints;

ab_status ab_checkpoints_begin(ab_checkpoints *checkpoints, const ab_schedule *schedule, const char *folder, ab_report *report);
/* After a step and its results: writes one where it is due, or `now`. */
ab_status ab_checkpoints_step(ab_checkpoints *checkpoints, ab_schedule *schedule, ab_results *results, bool now, ab_report *report);
/* Of a run that failed: from where it can be gone over again. `from`: the checkpoint it was started from, or NULL. */
void ab_checkpoints_tell(const ab_checkpoints *checkpoints, const ab_schedule *schedule, const char *from, FILE *stream);
void ab_checkpoints_end(ab_checkpoints *checkpoints);

/* A checkpoint to go on from: of this version, and of this scene but for what may change. AB_BAD_INPUT names the first difference. */
ab_status ab_checkpoint_open_for(const char *path, const ab_scene *scene, ab_checkpoint **checkpoint, ab_report *report);
/* Brings a schedule and results just created to where they were. */
ab_status ab_checkpoint_restore(ab_checkpoint *checkpoint, ab_schedule *schedule, ab_results *results);

#endif
