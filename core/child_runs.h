/* child_runs.h: one scene run many times with settings changed, each run a process of its own, so that its time and memory are its own and that one that fails takes nothing
 * with it. Each has a folder under DIR/runs; one that is there already, of the same scene, program and plugins, is not run again. */
#ifndef AB_CHILD_RUNS_H
#define AB_CHILD_RUNS_H

#include <stdio.h>

#include "core/scene.h"

typedef enum ab_child_state {
    AB_CHILD_WAITING = 0,
    AB_CHILD_RUNNING,
    AB_CHILD_DONE,
    AB_CHILD_FAILED,  /* the run broke off: blow-up, no memory */
    AB_CHILD_REFUSED, /* the settings do not go together: exit 2 */
    AB_CHILD_LIMIT,   /* stopped at the limit of seconds */
    AB_CHILD_SKIPPED  /* not to be run */
} ab_child_state;

#define AB_CHILD_THREADS "threads"

typedef struct ab_child { /* one run */
    ab_override
        *settings; /* after those that all runs share; texts are borrowed. Path AB_CHILD_THREADS: of the command line, not of the scene */
    size_t setting_count;
    ab_child_state state;
    char *folder, *label, *why; /* label: "constants.cells=40, basis=gimp"; why: it is not done; one line */
    bool kept;                  /* from an earlier call */
    bool killed;                /* failed: by a signal, not by an error of its own */
    bool machine;               /* failed: for lack of memory or room */
    double wall, cpu;           /* s, of the process */
    double bytes;               /* largest resident set */
    int process;                /* while it runs */
    double started;
} ab_child;

typedef struct ab_child_runs { /* what the runs share, and whose they are */
    const char *scene, *folder, *plugin_path;
    const ab_override *overrides; /* of the command line, before the settings of a run */
    size_t override_count;
    int jobs, threads;
    bool quiet, force_plugins;
    bool
        keep_failures; /* a run that broke off is an answer: it is not tried again, unless the machine was the reason (no memory, no room) */
    double limit;      /* s of wall time for a run; INFINITY: none */
    char fingerprint[40];
    FILE *lock; /* of the folder, while these runs are at work there; NULL: not yet */
    void *owner;
    ab_child *(*next)(void *owner);                 /* to be run now; NULL: none, or none before another has ended */
    void (*ended)(void *owner, ab_child *child);    /* one has ended, or was there */
    size_t (*count)(void *owner, size_t *expected); /* how many have ended, and of how many: for the progress */
} ab_child_runs;

/* Settings (borrowed texts), label (copied) and folder of a run. */
ab_status ab_child_plan(const ab_child_runs *runs, ab_child *child, const ab_override *settings, size_t count, const char *label,
                        ab_report *report);
void ab_child_clear(ab_child *child);
void ab_child_say_why(ab_child *child, const char *why); /* copied */

/* Runs what `next` gives and is not there yet, `jobs` at a time, with progress on stderr. 128 + n where signal n stopped it; what is done stays. The folder is these runs' own
 * until ab_child_runs_end: AB_FAILED where others are at work there. */
ab_status ab_child_runs_run(ab_child_runs *runs, const ab_scene *scene, ab_registry *registry, ab_report *report);

void ab_child_runs_end(ab_child_runs *runs);

/* child_kept.c: of all that decides what a run gives: the scene but for what only commands read, meshes in files, overrides, the program and every plugin it finds. */
void ab_child_fingerprint(ab_child_runs *runs, const ab_scene *scene, ab_registry *registry);
bool ab_child_take_kept(const ab_child_runs *runs, ab_child *child);
ab_status ab_child_keep(const ab_child_runs *runs, const ab_child *child, int status, ab_report *report);
void ab_child_over_limit(const ab_child_runs *runs, ab_child *child);
enum { AB_CHILD_STOPPED = 143 }; /* exit status of a run that was over the limit: 128 + SIGTERM */
/* From the exit status of `abut run`: its state, and why it is not done. */
void ab_child_conclude(ab_child *child, int status);

#endif
