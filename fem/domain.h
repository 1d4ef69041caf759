/* domain.h: how a finite-element body lies in memory. Inside fem/ only.
 *
 * Nodes are plain arrays of pairs in the order of the mesh; places are measured from the grid's corner. Elements stand in blocks of eight, lane l being element
 * 8*block + l; the last block is filled up with copies of the last element that nothing gathers from. A Gauss point of a block is `rows.count` rows of
 * eight doubles. Blocks go through the step in groups that make one batch for the material.
 *
 * No element writes to a node: it leaves its forces in the block, and each node adds up those of its elements in the order of the mesh. So no two threads write to
 * one place and no sum depends on their number. */
#ifndef AB_FEM_DOMAIN_H
#define AB_FEM_DOMAIN_H

#include "core/domain.h"
#include "core/material.h"
#include "fem/element.h"
#include "fem/mesh.h"
#include "fem/trace.h"

struct ab_initial;

enum {
    FEM_ROW_STRESS = 0, /* xx, yy, zz, xy, Pa */
    FEM_ROW_MASS = 4,   /* kg */
    FEM_ROW_OTHERS = 5,
    FEM_GROUP = 8,              /* blocks in a group, at most */
    FEM_BATCH = 8 * FEM_GAUSS,  /* Gauss points in a group, at most */
    FEM_RUN = 1024,             /* nodes that are summed up together */
    FEM_GROUPS_PER_THREAD = 64, /* a thread is worth its waking up from about this many on */
};

typedef struct fem_rows { /* of a Gauss point; -1: not allocated */
    int count;
    int gradient;      /* 4: deformation gradient xx, xy, yx, yy */
    int state, states; /* the material's */
    bool turns;        /* some state is a vector or a tensor */
} fem_rows;

typedef struct fem_sums { /* of a group, one step */
    double work;          /* J: of stress, with that of hourglass forces */
    double first_work;    /* J: of the stress at the beginning of the step alone */
    double plastic;       /* J */
} fem_sums;

typedef struct fem_node_sums {                            /* of FEM_RUN nodes */
    double mass, kinetic, momentum[2], angular, first[2]; /* first: sum m x */
    double damping, weight;                               /* J: taken by damping, done by gravity in this step */
} fem_node_sums;

typedef enum fem_trouble { FEM_FINE = 0, FEM_INVERTED, FEM_NEARLY_INVERTED, FEM_MATERIAL } fem_trouble;

typedef struct fem_load {   /* on an outer face, or on one node */
    uint32_t node[3], spec; /* first, last, middle of the face, FEM_NONE: no such; which load of the scene */
    double share[3];        /* m: integrals of their basis functions along the face at the start; of a point force 1 */
    double force[3][2];     /* N: in this step */
} fem_load;

typedef struct fem_held { /* a direction of a node whose velocity is given */
    uint32_t node;
    uint32_t component;
    uint32_t fix; /* entry of the body's fix */
} fem_held;

typedef struct fem_outer { /* the outer faces, for contact */
    fem_faces *faces;
    uint32_t *place;      /* of a node among faces->node; FEM_NONE: inside */
    size_t *start;        /* 0, 1, 2, ...: each stands for itself */
    uint32_t *dof;        /* faces->node */
    double *weight;       /* 1 */
    size_t face_count;    /* those of faces but, in axisymmetric scenes, what lies on the axis */
    uint32_t *vertex;     /* their vertices by place */
    uint32_t *beside;     /* 2 a face */
    double *vertex_place; /* rows of faces->node_count */
    double *area;         /* by place */
    uint64_t *key;        /* of the points last asked for */
    uint32_t *point_dof, *point_vertex;
    double *point_place, *point_area, *point_extent;
} fem_outer;

typedef struct fem_body {
    ab_domain domain; /* first */
    const ab_scene *scene;
    const fem_element *element;
    bool f_bar, gravity;
    double hourglass;
    int threads;
    double origin[2];

    fem_mesh *mesh; /* x as drawn */
    size_t nodes, elements, blocks, groups;
    int blocks_per_group;

    /* nodes: pairs */
    double *x, *x_start;    /* m, now and at the start of the step */
    double *velocity, *old; /* m/s, now and at the start of the step */
    double *force;          /* N: of elements and loads, then with gravity */
    double *inverse_mass;   /* 1/kg; 0 where held */
    double *closed;         /* zeros: what contact sees but between trial and finish */
    double *impulse;        /* N s, of contact in this step; NULL where nothing is held */
    double *mass;           /* kg; one a node */
    size_t *gather_start;   /* nodes + 1: its places in element_force */
    uint32_t *gather;       /* of x; y is 8 behind */
    bool open;              /* between trial and finish */

    /* blocks */
    uint32_t *connectivity; /* element->nodes rows of eight per block */
    double *gauss;          /* rows.count rows of eight per Gauss point */
    double *extra;          /* element->extra rows of eight per block */
    double *element_force;  /* 2*element->nodes rows of eight per block */
    double *stretch;        /* per block: strain travelled since its frequency was found */
    double *volume_start;   /* eight per block: of its elements when the body was drawn, m2 */
    double *frequency2;     /* eight per block, 1/s2 */
    double *stiffening;     /* per block: P-wave modulus over that of the start, when it was last asked for */
    fem_rows rows;
    fem_sums *sums; /* per group */
    fem_node_sums *node_sums;
    size_t runs;    /* of FEM_RUN nodes */
    double slowest; /* critical dt, s */
    size_t slowest_element;
    char limit[160];

    const ab_material_spec *material;
    void *self;
    ab_service service;
    ab_material_start start;
    fem_elastic elastic;
    bool ask_wave_speed;

    fem_load *loads;
    size_t load_count, load_capacity;
    fem_held *held;
    size_t held_count;
    double *given;           /* m/s: two per entry of fix, in this step */
    struct fem_edges *edges; /* one per boundary of the scene that acts on the body */
    size_t edges_count;
    double *body_force; /* N: pairs, in this step; NULL without one */

    ab_energy energy;           /* totals so far */
    double external_before;     /* J: energy.external at the start of the step */
    double unbalanced, applied; /* N: of the last step that measured them */
    double *datum;              /* m, pairs: where displacements are counted from, as drawn; NULL: from the mesh as drawn */
    double ahead;               /* J: what energy.strain has from the second half of the step */
    ab_motion motion;
    double reaction[3]; /* of the last step */

    ab_field *fields;
    size_t field_count;
    fem_outer *outer;
    fem_trace *trace; /* NULL unless a contact needs shared nodes */
    fem_inner inner;
    struct fem_inside *inside; /* inside.c: the elements that have inner points */
    struct piece *pieces;      /* of memory */
    size_t bytes;
} fem_body;

static inline double *fem_gauss_rows(const fem_body *body, size_t block, int point) {
    return body->gauss + (block * (size_t)body->element->gauss + (size_t)point) * 8 * (size_t)body->rows.count;
}
static inline int fem_lanes(const fem_body *body, size_t block) { /* elements in a block */
    return block + 1 < body->blocks ? 8 : (int)(body->elements - 8 * block);
}
/* As a person knows it: its number in the file, or its place in the mesh from 0. */
static inline unsigned long long fem_element_number(const fem_body *body, size_t element) {
    return body->mesh->element_id ? (unsigned long long)body->mesh->element_id[element] : (unsigned long long)element;
}
void *fem_take(fem_body *, size_t count, size_t size);              /* as ab_memory_take, counted; NULL when there is no memory */
bool fem_on_axis(const fem_body *, size_t node);                    /* which holds its nodes radially */
void fem_middle(const fem_body *, size_t element, double place[2]); /* of an element, in the scene's coordinates */

/* step.c: elements from the start of a step to its end */
void fem_gather(const fem_body *, size_t block, const double *pairs, double (*rows)[8]); /* of nodes, to the lanes of a block */
ab_status fem_elements_start(fem_body *, const fem_faces *, ab_report *); /* volumes, stress, states and forces before the first step */
/* Strain from x_start to x, stress, forces; *culprit: the first element in trouble. */
fem_trouble fem_elements_step(fem_body *, const ab_step *, size_t *culprit);
void fem_nodes_force(fem_body *);                    /* force = minus the forces of the elements */
void fem_nodes_trial(fem_body *, const ab_step *);   /* gravity, trial velocities, held directions */
void fem_nodes_finish(fem_body *, const ab_step *);  /* damping, work, motion, new places */
void fem_nodes_measure(fem_body *);                  /* motion and kinetic energy as they are */
void fem_nodes_balance(fem_body *, const ab_step *); /* unbalanced, applied: after contact, before damping */
/* critical.c: looks again at blocks that have changed shape or grown stiffer; all of them with `all`. */
void fem_critical(fem_body *, bool all);

/* material.c */
typedef struct fem_batch { /* rows of FEM_BATCH Gauss points: point q of block k of a group stands at 8*(k*gauss + q) */
    ab_batch view;
    double strain[4][FEM_BATCH] __attribute__((aligned(64)));
    double turned[4][FEM_BATCH] __attribute__((aligned(64))); /* old stress, turned with the material */
    double stress[4][FEM_BATCH] __attribute__((aligned(64)));
    double gradient[5][FEM_BATCH] __attribute__((aligned(64)));
    double spatial[4][FEM_BATCH] __attribute__((aligned(64)));
    double density[FEM_BATCH] __attribute__((aligned(64)));
    double dissipation[FEM_BATCH] __attribute__((aligned(64)));
    double wave_speed[FEM_BATCH] __attribute__((aligned(64)));
    double state0[AB_MATERIAL_STATES][FEM_BATCH] __attribute__((aligned(64)));
    double state1[AB_MATERIAL_STATES][FEM_BATCH] __attribute__((aligned(64)));
    uint8_t flag[FEM_BATCH];
} fem_batch;
ab_status fem_material_create(fem_body *, ab_report *); /* instance, tangent; rows */
void fem_batch_open(fem_batch *, const fem_body *, const ab_step *);
void fem_batch_strain(fem_batch *, const fem_body *, size_t block, const fem_block *,
                      size_t at); /* all Gauss points of a block, from place `at` on */
int fem_batch_call(fem_batch *, const fem_body *, size_t count);
void fem_batch_settle(const fem_batch *, const fem_body *, size_t block, fem_block *, size_t at, fem_sums *);

/* loads.c */
enum { FEM_FACE_PLACES = 3 }; /* of Gauss on a face, -1 .. 1: exact for a parabola of traction or pressure on a straight face */
extern const double FEM_FACE_PLACE[FEM_FACE_PLACES], FEM_FACE_WEIGHT[FEM_FACE_PLACES];
typedef struct fem_face_point {
    double n[3];             /* basis functions of the first, last and middle node */
    double place[2], run[2]; /* m: where it is, and its derivative from -1 (first) to 1 (last) */
} fem_face_point;
/* The place s of a face; pairs: of nodes; node: first, last, middle (FEM_NONE: straight). */
fem_face_point fem_face_point_on(const double *pairs, const uint32_t node[3], double s);
ab_status fem_loads_create(fem_body *, const fem_faces *, ab_report *);
ab_status fem_held_create(fem_body *, const fem_faces *, ab_report *);
/* Supports of a stage; fem_held_create has looked for mistakes, and taken memory for any. */
ab_status fem_held_choose(fem_body *, const fem_faces *, size_t stage, ab_report *);
ab_status fem_loads_add(fem_body *, const ab_step *, ab_report *); /* to force; AB_FAILED: a formula has no finite value */
void fem_loads_work(fem_body *, const ab_step *);                  /* energy.external */
/* body_force.c: all of it nothing where the body has none */
ab_status fem_body_force_add(fem_body *, const ab_step *, ab_report *); /* to force; AB_FAILED: a formula has no finite value */
void fem_body_force_work(fem_body *, const ab_step *);                  /* energy.external */
ab_status fem_held_move(fem_body *, double time, bool settling,
                        ab_report *);            /* their velocities at a time, to velocity; settling: they stand still */
void fem_held_work(fem_body *, const ab_step *); /* force and work of the supports */

/* stages.c */
ab_status fem_enter(ab_domain *, const ab_stage_spec *, size_t stage, ab_report *);
void fem_rest(ab_domain *, const ab_step *);
ab_status fem_datum(ab_domain *, ab_report *);
void fem_balance(const ab_domain *, double *unbalanced, double *applied);
/* initial.c: the stress that the scene begins with; *initial NULL: the material's own */
ab_status fem_initial_open(const fem_body *, const fem_faces *, struct ab_initial **, ab_report *);
ab_status fem_initial_point(fem_body *, const struct ab_initial *, size_t block, int point, ab_material_start *, ab_report *);

/* boundary.c: the outer faces under boundary plugins; nothing where the body has none */
ab_status fem_edges_create(fem_body *, const fem_faces *, ab_report *);
ab_status fem_edges(ab_domain *, size_t boundary, const ab_step *, ab_edge_list *, ab_report *); /* see core/domain.h */

/* fields.c */
ab_status fem_fields_create(fem_body *, ab_report *);
const ab_field *fem_fields(const ab_domain *, size_t *count);
ab_status fem_read(const ab_domain *, const char *field, double *values, ab_report *);
size_t fem_count(const ab_domain *);
void fem_cells(const ab_domain *, ab_cells *);

/* surface.c */
ab_status fem_outer_create(fem_body *, fem_faces *, ab_report *); /* takes the faces over */
void fem_outer_destroy(fem_body *);
/* bounds.c */
void fem_bounds(const ab_domain *, ab_bounds *);

ab_status fem_surface_faces(ab_domain *, ab_surface *, ab_report *);
ab_status fem_surface_points(ab_domain *, const ab_region *, ab_surface *, ab_report *);

/* inside.c: the points inside the elements that the grid sees */
ab_status fem_inner_create(fem_body *, ab_report *);
void fem_inner_destroy(fem_body *);
ab_status fem_inner_follow(fem_body *, long step, ab_report *); /* at the start of a step */
void fem_inner_keep(fem_body *, struct ab_checkpoint *);

/* keep.c: checkpoints */
void fem_keep(ab_domain *, struct ab_checkpoint *);

#endif
