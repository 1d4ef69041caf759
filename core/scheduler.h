/* scheduler.h: from a scene to a run: domains, contact, the time loop, results. */
#ifndef AB_SCHEDULER_H
#define AB_SCHEDULER_H

#include "core/interaction.h"

typedef struct ab_method { /* a way to compute a body; main lists them */
    const char *name;      /* what a scene writes behind `method:` */
    ab_status (*create)(const ab_scene *, size_t body, int threads, ab_domain **, ab_report *);
} ab_method;

typedef struct ab_run_options {
    const char *folder;  /* for the results */
    const char *restart; /* checkpoint to go on from; NULL: from the start */
    int threads;
    bool quiet, strict;
    const ab_method *methods;
    size_t method_count;
    ab_interaction_maker interact; /* for scenes with contacts */
} ab_run_options;

typedef struct ab_drag { /* drag.h; J */
    double external, damping, potential; /* before the step */
    double work, most;                   /* on what is driven, so far; the largest size of that */
    double taken, fallen, since;         /* of the steps with damping in which that works: what damping took, what gravity gave; s: the first of them */
    long steps;                          /* so many */
} ab_drag;

typedef struct ab_schedule { /* a scene on its way through time */
    const ab_scene *scene;
    ab_domain **domains;
    size_t body_count;
    ab_interaction *interaction;      /* NULL without contacts */
    struct ab_boundaries *boundaries; /* NULL without boundary plugins */
    double time, dt, critical_dt, first_critical_dt;
    long number;
    double begin, end, fixed_dt, cfl; /* of the stage, or of the run: s; dt where it is fixed, else 0; part of the critical one */
    long first_step;                  /* number of the stage's first step */
    const char *limit;                /* what binds dt */
    bool warned;                      /* of a dt above the limit */
    bool half_done;    /* within a step, or after one that failed: no state to go on from */
    ab_energy *energy, *energy_start, total;
    ab_motion *motion;
    double total_now, total_start;         /* J: all terms of the ledger */
    size_t points, nodes, elements, rigid; /* what a step goes over: ab_run_facts */
    double phase_seconds[8];
    double watch_external, watch_potential; /* J: the largest so far; see watchdog.h */
    double watch_momentum[3];               /* kg m/s, of all bodies at the start */
    int watch_count;                        /* steps on end with too much energy made */
    ab_drag drag;
    struct ab_stages *stages;               /* stages.h; NULL where the scene has none */
} ab_schedule;

ab_status ab_schedule_create(const ab_scene *, const ab_run_options *, ab_schedule **, ab_report *);
void ab_schedule_destroy(ab_schedule *);
ab_status ab_schedule_step(ab_schedule *, ab_report *);
/* Before a step, for who has to know (it does so itself): the next stage, where one is over. datum: displacements are counted from here on. */
ab_status ab_schedule_next(ab_schedule *, bool *datum, ab_report *);
void ab_schedule_look(ab_schedule *); /* reads the ledgers */
void ab_schedule_view(const ab_schedule *, ab_state_view *);

/* Runs to the end: AB_OK, AB_FAILED, AB_BAD_INPUT, AB_MISSED (with strict), or 128 + signal. */
ab_status ab_run(const ab_scene *, const ab_run_options *, ab_report *);

/* What the scene needs and what it will not pay for, as text or JSON. Runs a few steps to estimate the time. */
ab_status ab_plan_print(const ab_scene *, const ab_run_options *, bool json, FILE *, ab_report *);

#endif
