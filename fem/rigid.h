/* rigid.h: how a rigid body lies in memory. Inside fem/ only.
 *
 * The body keeps its shape as it was drawn; where anything of it is now follows from the place of its centre of mass and one angle, so that no step can bend it.
 * Its velocity and spin are one dof of the contact loop. */
#ifndef AB_FEM_RIGID_H
#define AB_FEM_RIGID_H

#include "core/domain.h"
#include "fem/mesh.h"
#include "fem/trace.h"

/* An outline as it is drawn: vertices and faces with the body on their left, straight or through a middle vertex; a curved one is a parabola. */
typedef struct rigid_outline {
    size_t vertex_count, face_count, point_count;
    double (*vertex)[2]; /* m */
    uint32_t *face;      /* 3 a face: first, last, middle (FEM_NONE: straight) */
    uint32_t *beside;    /* 2 a face: the one before, the one after */
    double (*point)[2];  /* m: places that may touch another body's faces: vertices, and between them where faces stand for a circle */
    double *point_area;  /* m: share of the outline */
    uint32_t *point_vertex;
    double area, centre[2], polar; /* m2, m, m4: second moment of area about the centre; of a disc or ring those of the circle */
    double radius, inner;          /* m: of a disc or ring about centre; 0: another shape */
    fem_mesh *mesh;                /* NULL: drawn as a shape */
} rigid_outline;

ab_status rigid_outline_create(const ab_scene *, const ab_body_spec *, rigid_outline *, ab_report *);
void rigid_outline_clear(rigid_outline *);

/* Points along the outline that the grid sees (rigid_layer.c): reference places from the centre of mass, m, as drawn. */
typedef struct rigid_layer {
    size_t count, capacity;
    double (*place)[2], *volume, (*extent)[3];
} rigid_layer;

/* A layer of `depth` m along the outline, points no further apart than `spacing` m. False: no memory. */
bool rigid_layer_create(const rigid_outline *, double spacing, double depth, rigid_layer *);
void rigid_layer_clear(rigid_layer *);

typedef struct rigid_body {
    ab_domain domain; /* first */
    const ab_scene *scene;
    double origin[2];
    rigid_outline outline;
    bool gravity, held[2], held_spin;
    bool hinged;          /* turns freely about a place that is not its centre of mass and whose velocity is given */
    double mass, inertia; /* kg, kg m2 about the centre of mass */
    double mass_density;  /* kg/m3: of the points on the grid */
    double arm[2];        /* m: from the place whose velocity is given to the centre of mass, as drawn */

    /* where it is; places from the grid's corner */
    double angle, cosine, sine;
    double centre[2]; /* of mass */
    double given[2];  /* the place whose velocity is given */
    /* the dof: velocity of the reference place, which is the given one of a hinged body and else the centre of mass */
    double velocity[2], old[2], spin, spin_old;
    double reference[2];                     /* m, at the start of the step */
    double offset[2];                        /* m, from there to the centre of mass, at the start of the step; 0 unless hinged */
    double inverse_mass[2], inverse_inertia; /* between trial and finish */
    double closed[2];                        /* zeros: what contact sees at other times */
    double impulse[3];                       /* of contact in this step; the third: moment about the reference */
    bool open;                               /* between trial and finish */
    double force[3];                         /* N, N m about the reference: gravity and loads in this step */
    double weight[2];                        /* N: gravity's part of it */
    double reaction[3];                      /* N, N m about the scene's origin, of the last step */
    double unbalanced, applied;              /* N: of the last step that measured them */
    bool has_datum;                          /* displacements are counted from datum: centre of mass, m from the grid's corner, and angle */
    double datum[3];

    ab_energy energy;
    ab_motion motion;

    uint32_t *loads; /* numbers of this body's loads */
    size_t load_count;

    /* what finders see */
    bool moved;        /* since the arrays below were filled */
    size_t face_count; /* those of the outline but, in axisymmetric scenes, what lies on the axis */
    uint32_t *face, *beside;
    double *vertex_place; /* rows of outline.vertex_count */
    double *point_place, *point_area, *point_extent, *ones;
    uint32_t *zeros, *point_vertex;
    uint64_t *key;
    size_t *counting; /* 0, 1, 2, ...: stencils of one dof each */
    rigid_layer layer;
    fem_trace *trace; /* NULL unless a contact needs shared nodes */
    fem_inner inner;
    size_t bytes;
} rigid_body;

/* Velocity of a place, m from the reference, with the old or the new velocities or the mean of both. */
static inline void rigid_turn(const rigid_body *body, const double x[2], double to[2]) {
    to[0] = body->cosine * x[0] - body->sine * x[1];
    to[1] = body->sine * x[0] + body->cosine * x[1];
}
/* Where a place of the body as drawn is now, m from the grid's corner. */
static inline void rigid_place(const rigid_body *body, const double drawn[2], double now[2]) {
    const double x[2] = {drawn[0] - body->outline.centre[0], drawn[1] - body->outline.centre[1]};
    rigid_turn(body, x, now);
    now[0] += body->centre[0];
    now[1] += body->centre[1];
}
void *rigid_take(rigid_body *, size_t count, size_t size); /* zeroed, counted; NULL when there is no memory. To be freed with free */

/* rigid_step.c: the motion */
ab_status rigid_motion_create(rigid_body *, ab_report *);
ab_status rigid_begin(ab_domain *, const ab_step *, ab_report *);
ab_status rigid_trial(ab_domain *, const ab_step *, ab_report *);
ab_status rigid_finish(ab_domain *, const ab_step *, ab_report *);

void rigid_rest(ab_domain *, const ab_step *);
ab_status rigid_datum(ab_domain *, ab_report *);
void rigid_balance(const ab_domain *, double *unbalanced, double *applied);

/* rigid_surface.c: what finders see */
ab_status rigid_surface_create(rigid_body *, ab_report *);
void rigid_surface_destroy(rigid_body *);
ab_status rigid_surface_follow(rigid_body *, ab_report *); /* at the start of a step */
ab_status rigid_faces(ab_domain *, ab_surface *, ab_report *);
ab_status rigid_surface_points(ab_domain *, const ab_region *, ab_surface *, ab_report *);
ab_status rigid_trace(ab_domain *, const uint32_t *nodes, size_t count, uint32_t needs, ab_trace *, ab_report *);
void rigid_node_tiles(const ab_domain *, ab_node_tiles *);

/* bounds.c */
void rigid_bounds(const ab_domain *, ab_bounds *);

/* keep.c: checkpoints */
void rigid_keep(ab_domain *, struct ab_checkpoint *);

/* rigid_fields.c: what results show */
const ab_field *rigid_fields(const ab_domain *, size_t *count);
size_t rigid_count(const ab_domain *);
ab_status rigid_read(const ab_domain *, const char *field, double *values, ab_report *);
void rigid_cells(const ab_domain *, ab_cells *);

#endif
