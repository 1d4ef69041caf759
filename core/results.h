/* results.h: what a run leaves: results.h5 + results.xdmf, history.csv, summary.json; monitors and expects. */
#ifndef AB_RESULTS_H
#define AB_RESULTS_H

#include "core/domain.h"

typedef struct ab_contact_totals {      /* of one contact of the scene */
    double impulse[3];                  /* N s on the second body in the last step */
    double force[3];                    /* impulse / dt */
    double moment;                      /* N m about the origin, on the second body */
    double normal_force;                /* N, sum of |normal| parts */
    double friction_force;              /* N, |sum of tangential parts| */
    size_t points, active;              /* contact points in the last step; those with an impulse */
    double penetration;                 /* m, deepest in the last step, >= 0 */
    double friction_work, contact_work; /* J so far */
    size_t failures;                    /* what the finder could not decide, so far */
    double peak_pressure;               /* Pa, largest normal impulse / (dt * area) of a point in the last step */
    double area;                        /* m (of length, in plane strain), sum of the areas of the points with an impulse */
    const ab_points *list;              /* the points of the last step, until the next one; NULL before the first */
    /* list->count each: N, force on the second body along the normal and along the tangent (-normal.y, normal.x); m/s, velocity of the first body against the
     * second along that tangent */
    const double *normal, *tangential, *slip;
    const double *pressure, *shear; /* Pa; NULL: force over area */
} ab_contact_totals;

typedef struct ab_boundary_totals { /* of one boundary of the scene */
    double force[2];                /* N on the body in the last step */
    double moment;                  /* N m about the origin of the scene */
    double impulse[2];              /* N s on the body so far */
    double work;                    /* J, done on the body so far; of it: */
    double dashpot, spring;         /* J, taken by what the class calls damping (never negative) and by what it calls stiffness */
    double area;                    /* m2 (m in plane strain), of the edges in the last step */
    double other;                   /* J, done on the body by all else: work + dashpot + spring */
    size_t edges;
} ab_boundary_totals;

typedef struct ab_state_view { /* what monitors and writers look at; borrowed from the scheduler */
    const ab_scene *scene;
    double time, dt;
    long step;
    const char *limit;                    /* what binds dt */
    size_t stage;                         /* 0 where the scene has none */
    ab_domain **domains;                  /* body_count */
    const ab_contact_totals *contacts;    /* contact_count */
    const ab_boundary_totals *boundaries; /* boundary_count */
    const ab_energy *energy;              /* per body, friction and contact booked */
    const ab_motion *motion;
    const ab_energy *energy_start; /* per body at t = 0 */
    ab_energy total;
    double remainder; /* J: what the discretisation made (+) or lost (-) */
} ab_state_view;

typedef struct ab_results ab_results;

/* Are there all the values and fields that monitors, expects and output ask for? Nothing is made. */
ab_status ab_results_check(const ab_scene *scene, const ab_state_view *view, ab_report *report);
/* Makes the folder and files. Nothing is written when anything is wrong. */
ab_status ab_results_open(const char *folder, const ab_scene *scene, const ab_state_view *view, ab_results **results, ab_report *report);
/* The two halves of opening: looks for everything in the state of the start; makes the folder and files. */
ab_status ab_results_create(const char *folder, const ab_scene *scene, const ab_state_view *start, ab_results **results, ab_report *report);
ab_status ab_results_begin(ab_results *results, ab_report *report);
/* For checkpoints, after a step: how far files and expects are. Loading: between create and continue. */
void ab_results_keep(ab_results *results, struct ab_checkpoint *checkpoint);
/* Goes on with the files of the folder from where they were at the checkpoint. In a folder without history.csv new ones are made, that begin there. */
ab_status ab_results_continue(ab_results *results, ab_report *report);
/* After every step (and once before the first): history row when due, monitors and expects always, a frame when due. */
ab_status ab_results_step(ab_results *results, const ab_state_view *view, ab_report *report);
/* Between two steps: displacements of monitors are counted from here on. */
ab_status ab_results_datum(ab_results *results, const ab_state_view *view, ab_report *report);
/* A frame now, whatever is due (the end, a failure). */
ab_status ab_results_frame(ab_results *results, const ab_state_view *view, ab_report *report);

typedef struct ab_run_facts {                                                           /* for the summary and the closing table */
    double wall_seconds, cpu_seconds, point_steps_per_second, element_steps_per_second; /* both over the same time: that of all steps */
    size_t peak_bytes, bytes_per_point;
    size_t points, nodes, elements, rigid; /* points of clouds; nodes and elements of meshes; bodies that move as a whole, without theirs */
    long steps;
    int threads;
    const char *version, *outcome; /* "done", "failed: ...", "stopped by signal 2" */
    const char *plan_json;         /* the plan as JSON text, or NULL */
    double phase_seconds[8];       /* where the time went */
    const char *phase_names[8];
} ab_run_facts;

/* Evaluates expects, writes summary.json, closes the files. *missed: expects that missed. */
ab_status ab_results_close(ab_results *results, const ab_state_view *view, const ab_run_facts *facts, size_t *missed, ab_report *report);
/* The closing table on a stream (from the same numbers as summary.json). Call before close. */
void ab_results_table(const ab_results *results, const ab_state_view *view, const ab_run_facts *facts, FILE *stream);
void ab_results_destroy(ab_results *results);

#endif
