/* stages.h: the run from stage to stage: what each step of it is told, when it is over, what happens at its end. */
#ifndef AB_STAGES_H
#define AB_STAGES_H

#include "core/scheduler.h"

struct ab_checkpoint;

typedef struct ab_stages { /* where the run is in its stages */
    size_t now;
    double gravity_begin;             /* part of the scene's gravity that acts at its begin, 0 to 1 */
    double ramp;                      /* s */
    double external, potential;       /* J: of all bodies at its begin */
    double kinetic;                   /* J: after the last step; for peaks */
    double force_ratio, energy_ratio; /* as measured last; NaN: not measured */
    int calm;                         /* steps on end that met both */
    bool met;                         /* the stage is over before its time */
    bool from_rest;                   /* all velocities were set to zero after the last step */
} ab_stages;

/* Of a scene with stages: the first one is entered, before the first step. */
ab_status ab_stages_create(ab_schedule *, ab_report *);
/* True when no step is left. The scene may have no stages. */
bool ab_stages_done(const ab_schedule *);
/* These only where schedule->stages is not NULL. next: before a step: where the stage is over, ends it and enters the one behind. */
ab_status ab_stages_next(ab_schedule *, bool *datum, ab_report *); /* datum: displacements are counted from here on */
const ab_stage_spec *ab_stages_spec(const ab_schedule *);
void ab_stages_fill(const ab_schedule *, ab_step *); /* time, gravity, damping of the step */
ab_status ab_stages_after(ab_schedule *, const ab_step *,
                          ab_report *); /* damping by kinetic energy, ratios; the schedule's time is after the step */
bool ab_stages_keep(ab_schedule *, struct ab_checkpoint *);

#endif
