/* contact.h: the host's half of contact: which nodes bodies share and which faces their points are near, the plugins' find and respond, and the loop that
 * applies impulses until they stand still. Inside contact/ and for main. */
#ifndef AB_CONTACT_H
#define AB_CONTACT_H

#include "core/interaction.h"

/* For main: fills the scheduler's table. */
ab_status contact_create(const ab_scene *, ab_domain **, ab_interaction **, ab_report *);

/* What the loop itself remembers of a point: along which directions the dynamic stage pushed, with which relative velocity it left the point and with which force
 * along and across the normal, and what the kinematic stage needed along and across it. */
enum { HISTORY_STATUS, HISTORY_NORMAL, HISTORY_TANGENTIAL, HISTORY_FORCE, HISTORY_FRICTION, HISTORY_STRAIN, HISTORY_SHEAR, HISTORY };
enum { STATUS_FREE, STATUS_NORMAL, STATUS_BOTH };

/* share.c: states of the response that are sums, and what it takes to share them out among points that come and go */
typedef struct contact_sums {
    uint64_t rows;     /* bit r: row r of the states is a sum; 0 with points from surfaces, which go with their body */
    double *old_place; /* m, of the points of the last step, two each, in the order of old_key */
    uint32_t *now;     /* by point of the last step: which one it is now, UINT32_MAX: none */
    struct contact_cell *cell;
    double *weight, *around; /* of each point; of all in the cells around it */
    size_t capacity;
} contact_sums;

/* spread.c: forces shared among points that are more than the freedoms they push on */
typedef struct contact_spread {
    bool wanted;
    int side;             /* of the body whose nodes they go through */
    double *force;        /* 4 rows of ld: along the normal and across it; the pressure, and what acts across, of the last step, Pa */
    double *node;         /* 3 per dof: force along the normal, across it, area */
    uint32_t *mark, look; /* by dof: the look that met it last */
    size_t ld, dofs;
} contact_spread;

/* light_dofs.c: dofs with next to no mass under points from surfaces */
typedef struct contact_light_dof {
    uint32_t dof;
    double weight, velocity[2]; /* of all points it serves; weight x m/s of what it goes with */
    double left[2];             /* N s beyond that */
} contact_light_dof;
typedef struct contact_light {
    contact_light_dof *list;
    uint32_t *place; /* by dof: where in the list, UINT32_MAX: not */
    size_t count, capacity, dofs;
} contact_light;

/* Contact points of one pair of bodies, and what the loop keeps beside them. Arrays over points; component c of point i is a[c*ld + i]. */
typedef struct contact_points {
    ab_points view;              /* what plugins see */
    double *relative_old;        /* relative velocity at the start of the step */
    double *applied;             /* impulse that the dofs have felt already; the loop applies the difference */
    double *change, *direction;  /* of the impulses: in the last round, and where the rounds are going */
    double *begun;               /* impulses that a stage began with, where points give way: those of the last step */
    double unrest;               /* largest change of an impulse since the last step over the largest impulse; 1: not known */
    double give;                 /* inverse mass with which points give way to a change of their impulse, as a part of their own; 0: not */
    size_t stencil_a, stencil_b; /* capacity of the stencils */
    size_t states;               /* rows of history: the response's, then the loop's own HISTORY rows */
    bool shared;                 /* some dof serves more than one point: one point after the other, and again until impulses stand still */
    bool held;         /* of some point: normal and tangential answers act on each other (one direction of a dof is held, a body turns) */
    bool surfaces;     /* points come from surfaces, not from shared nodes */
    bool meshes;       /* both bodies are meshes or rigid */
    bool gives;        /* one body is of points, and no response of springs: points may give way, see rounds.c */
    bool distances;    /* the response needs them */
    uint64_t *old_key; /* of the last step, ascending, with their states: history */
    double *old_state;
    size_t old_count, old_capacity;
    contact_sums sums;
    contact_spread spread;
    contact_light light;
    double *carried; /* area that each point's impulse acts on, where shared nodes are asked for areas: carried.c */
    size_t carried_capacity;
    uint32_t *seen; /* by dof: the last look for shared dofs that met it */
    size_t seen_capacity;
    uint32_t look; /* number of the last one */
} contact_points;

typedef struct contact_broad contact_broad; /* broad_phase.c */

/* approach.c: how fast two bodies may come at each other, m/s, and what they may close in a step, m: half of what lies between them and a cell */
typedef struct contact_approach {
    double speed, way;
} contact_approach;

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
    contact_broad *broad;        /* NULL unless the finder needs surfaces */
    struct contact_faces *faces; /* NULL unless the finder needs the nearest faces of nodes */
    contact_points points;
    size_t failures; /* of the finder, so far */
    double cell;     /* m: the grid's, or without one the mean length of a face of the finer body */
    contact_approach approach; /* as the step was chosen */
} contact_pair;

/* sides.c: one side of a pair's contact points, on the dofs of its body */
typedef struct contact_side {
    ab_dofs dofs;
    const ab_points *points;
    const size_t *start;
    const uint32_t *dof;
    const double *weight;
    double sign; /* of its velocity in the relative one: a 1, b -1. The impulse on it is -sign times the point's */
} contact_side;

void contact_sides(const contact_pair *, contact_side side[2]);
/* Velocity of a relative to b at point i, m/s; old: at the start of the step. */
void contact_relative_velocity(const contact_side side[2], bool old, size_t i, double v[2]);
/* Changes the velocities of both sides by impulse j on b, N s. */
void contact_push(const contact_side side[2], size_t i, const double j[2]);
/* Inverse effective mass along d, 1/kg. *held becomes true where some dof has one direction held. */
double contact_inverse_mass(const contact_side side[2], size_t i, const double d[2], bool *held);
/* How a unit impulse along n changes the velocity across it, 1/kg: what makes answers along and across act on each other. turns: only what comes from bodies
 * that turn. */
double contact_coupling(const contact_side side[2], size_t i, const double n[2], bool turns);
/* True where nothing that an impulse along component c does moves either side. */
bool contact_all_held(const contact_side side[2], size_t i, size_t c);

/* shared_nodes.c */
ab_status contact_shared_nodes(contact_pair *, ab_report *);

/* nearest_face.c: fills what both traces say of faces. The arrays stay the pair's, until the next call. */
ab_status contact_nearest_faces(contact_pair *, ab_trace *a, ab_trace *b, ab_report *);
void contact_faces_destroy(struct contact_faces *);

/* broad_phase.c */
ab_status contact_broad_create(const ab_scene *, contact_pair *, ab_report *);
void contact_broad_destroy(contact_broad *);
/* Surfaces of both bodies, each point with the other body's faces near it. They stay the domains' and the broad phase's, until the next call. */
ab_status contact_surfaces(contact_pair *, double dt, ab_surface *a, ab_surface *b, ab_report *);
double contact_broad_cell(const contact_broad *); /* m; the grid's, or without one the mean length of a face of the finer body */
double contact_broad_face(const contact_broad *); /* m, typical, the longer one of the two bodies. Known after the first call */
void contact_broad_note_depth(contact_broad *, double depth); /* m, by which the bodies overlap now: the next call looks that much deeper */
bool contact_broad_tell(contact_broad *);           /* true once: the user has not been told yet that the bodies are deep in each other */
double contact_broad_speed(const contact_broad *);  /* m/s, largest of a place on one surface against one on the other */
size_t contact_broad_visits(const contact_broad *); /* pairs of a point and a face that were looked at in the last call */
size_t contact_broad_builds(const contact_broad *); /* how often regions and buckets were made so far */

/* approach.c */
contact_approach contact_approach_of(const contact_pair *);
/* The step is one that may carry one body through the other: stops. */
ab_status contact_stop_passing(const ab_scene *, const contact_pair *, const contact_approach *, const ab_step *, ab_report *);

/* find.c */
ab_status contact_can_find(const contact_pair *, ab_report *); /* the bodies have what the finder needs */
ab_status contact_find(contact_pair *, const ab_step *, ab_report *);
ab_status contact_complain(const contact_pair *, const ab_service *, const char *what, int code, ab_report *);

/* Rows of HISTORY_*: as the dynamic stage of this step has left the points (answered), or that of the last step. */
const double *contact_history(const contact_pair *, bool answered);

/* overlap.c: contact keeps bodies from getting deeper into each other and does not push apart what is drawn one inside the other: says so, after the first find. */
void contact_warn_of_overlap(const ab_scene *, const contact_pair *, ab_report *);
/* Surfaces alone: says once that bodies have come deeper into each other than a face is long; and lets the next look reach as deep. After every find. */
void contact_watch_depth(contact_pair *, ab_report *);

/* rounds.c: impulses of all pairs' points in one stage; answered: the dynamic stage of this step is done. */
ab_status contact_rounds(contact_pair *, size_t count, ab_stage, bool answered, ab_report *);
double contact_give(const contact_points *, ab_stage); /* contact_points.give of bodies of points by surfaces */

/* spread.c: room for forces, rows of ld (NULL: no memory); and their sharing, in place, with positive weights alone. False: no memory */
double *contact_spread_room(contact_points *);
bool contact_spread_forces(contact_points *, const contact_side side[2]);
/* Shares out the step's forces, for what is reported: fills the last two rows; the largest pressure, Pa. */
double contact_spread_pressure(contact_points *, const contact_side side[2], const double *normal, const double *tangential);
void contact_spread_destroy(contact_spread *);

/* light_dofs.c: before the impulses of the dynamic stage. False: no memory */
bool contact_light_dofs(contact_light *, const contact_side side[2]);
void contact_light_destroy(contact_light *);

/* share.c */
bool contact_share_sums(contact_points *); /* into state0, from the states of the last step; false: no memory */
void contact_sums_destroy(contact_sums *);
bool contact_carried_areas(
    contact_points
        *); /* into carried, of shared nodes, once impulses stand: m, sum kept but for what nobody near carries; false: no memory */

/* keep.c: checkpoints. False: refused */
struct ab_checkpoint;
bool contact_keep_pair(contact_pair *, struct ab_checkpoint *);
bool contact_keep_totals(ab_contact_totals *, struct ab_checkpoint *);
bool contact_keep_spread(contact_points *, struct ab_checkpoint *);

/* points.c */
bool contact_points_reserve(contact_points *, size_t points, size_t stencil); /* false: no memory */
void contact_points_destroy(contact_points *);
bool contact_points_prepare(contact_points *, const contact_side side[2], ab_stage); /* effective masses, give, history; false: no memory */
bool contact_points_remember(contact_points *);                            /* false: no memory */

#endif
