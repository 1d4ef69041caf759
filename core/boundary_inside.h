/* boundary_inside.h: the insides of the boundaries of a scene, for boundary*.c only. */
#ifndef AB_BOUNDARY_INSIDE_H
#define AB_BOUNDARY_INSIDE_H

#include <math.h>

#include "core/boundary.h"

typedef struct ab_boundary {
    const ab_boundary_spec *spec;
    size_t number; /* of the scene */
    ab_domain *domain;
    ab_dofs dofs;
    ab_service service;
    void *self;
    size_t count, ld, states; /* states: rows */
    ab_edge_list list;        /* of this step */
    ab_edges view;            /* what the plugin sees */
    double *storage;          /* all the arrays of the view that the host fills or reads, and those below */
    bool active;              /* in this step; its displacements count from its first one */
    bool begins;              /* with this step */
    double *held;             /* 2 rows: what it carries besides, Pa; N where the body says own_force */
    double *moved;            /* m, in the last step */
    double *base;             /* m/s, 2 rows: what of the velocity no dof's velocity of now has a part in */
    double *position, *displacement, *velocity, *traction, *damping, *stiffness, *prescribed, *state0, *state1;
    double *impulse;  /* N s, 2 rows, of this step */
    double *given[2]; /* last step's over dt and area, where the next one begins */
    double *answer;   /* 4 rows: of (1 + B S)^-1, which makes an impulse of what is missing of it */
    uint8_t *flag;
    ab_boundary_totals totals;
} ab_boundary;

struct ab_boundaries {
    const ab_scene *scene;
    ab_boundary *list;
    size_t count;
    ab_boundary_totals *totals;
    double *taken; /* J, per body */
    double *rate2; /* 1/s2, per body: square of the frequency that springs of boundaries alone could reach */
    double *sum;   /* per dof: stiffness there, N/m */
    size_t sum_room;
    char limit[200];
};

/* True where the plugin says how edge e moves along c. */
static inline bool ab_boundary_holds(const ab_boundary *b, size_t e, size_t c) {
    return (b->spec->loaded->class_.gives & AB_GIVE_MOTION) && !isnan(b->prescribed[c * b->ld + e]);
}

/* s: how long forces act on velocities in a step: those of a body that was at rest at its start, and not half a step before, come up to its middle. */
static inline double ab_boundary_acts(const ab_step *step) { return step->from_rest ? 0.5 * step->dt : step->dt; }

/* boundary_hold.c: boundaries that begin with this step take over what bodies with own_force have out of balance at their edges. All have been asked. */
ab_status ab_boundary_take_over(ab_boundaries *all, ab_report *report);
/* Frequencies that springs can reach go to rate2. */
ab_status ab_boundary_note_springs(ab_boundaries *all, ab_report *report);
/* What moves an edge must be alone with it: an error where a side of the grid or a support holds it, too, */
ab_status ab_boundary_refuse_held(const ab_boundary *b, ab_report *report);
/* or another boundary. */
ab_status ab_boundary_refuse_two(const ab_boundaries *all, const ab_boundary *b, ab_report *report);

#endif
