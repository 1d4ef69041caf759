/* contact.h: the host's half of contact: which nodes bodies share, the plugins' find and respond, and the loop that applies impulses until they stand
 * still. Inside contact/ and for main. */
#ifndef AB_CONTACT_H
#define AB_CONTACT_H

#include "core/interaction.h"

/* For main: fills the scheduler's table. */
ab_status contact_create(const ab_scene *, ab_domain **, ab_interaction **, ab_report *);

/* What the loop itself remembers of a point: how it was left by the dynamic stage, and with which relative velocity along and across the normal. */
enum { HISTORY_STATUS, HISTORY_NORMAL, HISTORY_TANGENTIAL, HISTORY };
enum { STATUS_FREE, STATUS_SLIPS, STATUS_STICKS };

/* Contact points of one pair of bodies, and what the loop keeps beside them. Arrays over points; component c of point i is a[c*ld + i]. */
typedef struct contact_points {
    ab_points view;              /* what plugins see */
    double *relative_old;        /* relative velocity at the start of the step */
    double *applied;             /* impulse that the dofs have felt already; the loop applies the difference */
    size_t stencil_a, stencil_b; /* capacity of the stencils */
    size_t states;               /* rows of history: the response's, then the loop's own HISTORY rows */
    bool shared;                 /* some dof serves more than one point: one point after the other, and again until impulses stand still */
    bool held;                   /* a side holds one direction of some dof: normal and tangential answers act on each other */
    uint64_t *old_key;           /* of the last step, ascending, with their states: history */
    double *old_state;
    size_t old_count, old_capacity;
} contact_points;

typedef struct contact_pair {
    const ab_contact_spec *spec;
    ab_domain *a, *b;
    ab_service finder_service, responder_service;
    void *finder, *responder;
    uint64_t version_a, version_b; /* of the tile lists that `tiles` was made from */
    uint32_t (*tiles)[2];          /* tiles both bodies have: numbers in a's and in b's list */
    size_t tile_count, tile_capacity;
    uint32_t *nodes_a, *nodes_b; /* nodes both bodies have mass at */
    size_t node_count, node_capacity;
    contact_points points;
    ab_contact_totals totals;
} contact_pair;

/* shared_nodes.c */
ab_status contact_shared_nodes(contact_pair *, ab_report *);

/* points.c */
bool contact_points_reserve(contact_points *, size_t points, size_t stencil); /* false: no memory */
void contact_points_destroy(contact_points *);
bool contact_points_prepare(contact_points *, const ab_dofs *a, const ab_dofs *b); /* effective masses, history; false: no memory */
void contact_points_remember(contact_points *);

#endif
