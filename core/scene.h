/* scene.h: a scene as the user meant it: every number in SI or as a formula, every name resolved, every plugin setting checked.
 * The file format is docs/scene.md. ab_scene_read reports every mistake at once. */
#ifndef AB_SCENE_H
#define AB_SCENE_H

#include <stdint.h>

#include "core/expression.h"
#include "core/plugin_host.h"

typedef enum ab_space { AB_SPACE_PLANE_STRAIN = 0, AB_SPACE_AXISYMMETRIC, AB_SPACE_3D_ } ab_space;

/* Length of the circle at a radius (axisymmetric scenes), m. */
static inline double ab_circumference(double radius) { return 6.283185307179586 * radius; }

typedef enum ab_side_kind { AB_SIDE_FREE = 0, AB_SIDE_ROLLER, AB_SIDE_FIXED, AB_SIDE_OUTFLOW } ab_side_kind;
enum { AB_LEFT = 0, AB_RIGHT, AB_BOTTOM, AB_TOP, AB_SIDES }; /* x min, x max, y min, y max */

typedef struct ab_material_spec {
    char *name;
    ab_mark mark;
    const ab_loaded_class *loaded; /* model */
    ab_value *settings;            /* class_.nparam of them */
    double density;                /* kg/m3 */
} ab_material_spec;

typedef enum ab_shape_kind {
    AB_SHAPE_BOX = 1,
    AB_SHAPE_DISC,
    AB_SHAPE_RING,
    AB_SHAPE_POLYGON,
    AB_SHAPE_UNION,
    AB_SHAPE_MESH
} ab_shape_kind;
typedef struct ab_shape_spec {
    ab_shape_kind kind;
    ab_mark mark;
    double low[2], high[2];          /* box */
    double center[2], radius, inner; /* disc, ring (inner radius) */
    double (*vertices)[2];           /* polygon: either way round; stored counter-clockwise */
    size_t count;                    /* vertices, or members */
    struct ab_shape_spec *holes;     /* polygon: polygons inside of it */
    size_t hole_count;
    struct ab_shape_spec *members; /* union */
} ab_shape_spec;

typedef enum ab_fill_rule { AB_FILL_REGULAR = 0, AB_FILL_GAUSS, AB_FILL_CVT } ab_fill_rule;

/* where: a set of places on or in a body's initial outline */
typedef struct ab_where {
    bool all;
    int side;           /* AB_LEFT.. or -1 */
    bool has[2];        /* x, y */
    double range[2][2]; /* a single value v is [v, v] */
    ab_mark mark;
} ab_where;

typedef enum ab_element_type { AB_ELEMENT_Q4 = 0, AB_ELEMENT_Q4R, AB_ELEMENT_Q6, AB_ELEMENT_Q8, AB_ELEMENT_Q8R } ab_element_type;
typedef enum ab_mesh_kind { AB_MESH_NONE = 0, AB_MESH_BOX, AB_MESH_PATCH, AB_MESH_FILE } ab_mesh_kind;

typedef struct ab_edge_spec { /* of a patch: straight from point to point, or an arc of a circle */
    double (*points)[2];      /* count of them, from one corner to the other */
    size_t count;
    bool arc;
    double center[2]; /* arc: from points[0] to points[1], the short way round */
} ab_edge_spec;

typedef struct ab_mesh_spec {
    ab_mesh_kind kind;
    ab_mark mark;
    ab_element_type type;
    double low[2], high[2]; /* box */
    ab_edge_spec edge[4];   /* patch: bottom, right, top, left; bottom and top run left to right, left and right upwards */
    long elements[2];       /* box, patch: along x (bottom), along y (left) */
    double grading[2];      /* size of the last element over that of the first; default 1 */
    char *file;             /* as written, from the scene's folder */
    bool f_bar;             /* q4: mean dilatation */
    double hourglass;       /* q4r: part of the physical stabilisation, default 1 */
} ab_mesh_spec;

typedef struct ab_fix_spec { /* nodes whose velocity is given */
    ab_where where;
    bool has[2];           /* false: that direction is free */
    ab_number velocity[2]; /* m/s, formulas of t */
    uint64_t absent;       /* a bit for each stage in which it does not act */
} ab_fix_spec;

typedef struct ab_motion_spec { /* of a rigid body; what is not given follows from forces */
    bool has[2], has_spin, has_center, has_mass, has_inertia;
    ab_number velocity[2], spin; /* m/s, 1/s (counter-clockwise); formulas of t */
    double center[2];            /* m: the point that velocity is of; default: centre of mass */
    double mass, inertia;        /* kg, kg m2 (per m of thickness) */
} ab_motion_spec;

/* What a body begins with. K0: vertical stress = weight of what the body has above + surcharge, k0 times that in both other directions. */
typedef enum ab_initial_kind { AB_INITIAL_NONE = 0, AB_INITIAL_K0, AB_INITIAL_STRESS, AB_INITIAL_GRAVITY } ab_initial_kind;
typedef struct ab_initial_spec {
    ab_initial_kind kind;
    ab_mark mark;
    double k0, surcharge; /* 1, Pa */
    const char *rule;     /* K0: where k0 is from, in words */
    ab_number stress[4];  /* AB_INITIAL_STRESS: xx, yy, zz, xy, Pa, formulas of x, y */
    double time;          /* AB_INITIAL_GRAVITY: s, at most; 0: not said */
} ab_initial_spec;

typedef enum ab_transfer { AB_TRANSFER_FLIP = 0, AB_TRANSFER_APIC, AB_TRANSFER_TPIC, AB_TRANSFER_XPIC, AB_TRANSFER_FMPM } ab_transfer;

typedef enum ab_f_bar { AB_F_BAR_NONE = 0, AB_F_BAR_CELL, AB_F_BAR_PATCH } ab_f_bar; /* which cells share the mean change of volume */

typedef struct ab_body_spec {
    char *name;
    ab_mark mark;
    char *method;    /* "material-points" | "finite-elements" | "rigid"; main maps it to a domain maker */
    size_t material; /* index into materials; SIZE_MAX: none (a rigid body may do without) */
    ab_shape_spec shape;
    ab_fill_rule fill;
    int per_cell;
    long points, seed;     /* cvt: points 0: by per_cell */
    double fill_tolerance; /* cvt */
    long fill_rounds;      /* cvt: at most */
    char *basis;           /* "linear" | "gimp" */
    bool contiguous;       /* domains of gimp follow the stretch */
    ab_transfer transfer;
    ab_f_bar f_bar;        /* material-points; elements have mesh.f_bar */
    int order;             /* AB_TRANSFER_XPIC, _FMPM: m */
    double flip;           /* AB_TRANSFER_FLIP: 1 flip, 0 pic */
    char *update;          /* "usf" | "usl" | "musl" | "usavg" */
    double surface_points; /* cells between points on the outline, which touch other bodies; 0: domains of material points do */
    ab_number velocity[2]; /* formulas of x, y */
    ab_initial_spec initial;
    bool gravity;
    bool has_force;
    ab_number force[2]; /* m/s2, formulas of t, x, y now and X, Y at the start */
    ab_mark mark_fill;
    ab_mesh_spec mesh; /* finite-elements; rigid may have one instead of a shape; of points: shape.kind is AB_SHAPE_MESH */
    ab_fix_spec *fix;
    size_t fix_count;
    ab_motion_spec motion; /* rigid */
    bool has_shape;
} ab_body_spec;

typedef struct ab_contact_spec {
    ab_mark mark;
    size_t body[2];
    const ab_loaded_class *finder, *responder;
    ab_value *finder_settings, *responder_settings;
} ab_contact_spec;

/* AB_NEED_*: what a contact's finder needs of the bodies, and its response of contact points, with their settings. */
static inline uint32_t ab_contact_needs(const ab_contact_spec *contact) {
    const ab_class *finder = &contact->finder->class_;
    return finder->needs | (finder->needs_with ? finder->needs_with(contact->finder_settings) : 0u);
}
static inline uint32_t ab_response_needs(const ab_contact_spec *contact) {
    const ab_class *responder = &contact->responder->class_;
    return responder->needs | (responder->needs_with ? responder->needs_with(contact->responder_settings) : 0u);
}

typedef struct ab_load_spec {
    ab_mark mark;
    size_t body;
    ab_where where;
    ab_number traction[2]; /* Pa, formulas of t and of the place x, y at the start */
    bool press;            /* a pressure instead of the traction */
    ab_number pressure;    /* Pa, against the outline as it lies now; a formula of t and of the place x, y at the start */
    bool point;            /* a force at one place instead */
    double at[2];          /* m: the node nearest to it carries the force; of a rigid body the place itself */
    ab_number force[2];    /* N (per m of thickness), formulas of t */
    uint64_t absent;       /* a bit for each stage in which it does not act */
} ab_load_spec;

typedef struct ab_boundary_spec { /* a boundary plugin on part of a body's outline */
    ab_mark mark;
    size_t body;
    ab_where where;
    const ab_loaded_class *loaded;
    ab_value *settings;
    bool nodes;      /* acts at the nodes that its pieces of outline hang on, each with its share; else at the pieces */
    bool hold;       /* carries besides the traction with which the body's own stress stood there when it began to act */
    bool on_side;    /* written at a side of the grid: a body that has nothing there is passed over */
    uint64_t absent; /* a bit for each stage in which it does not act */
} ab_boundary_spec;

typedef struct ab_monitor_spec {
    char *name;
    ab_mark mark;
    int body, contact; /* index or -1. Both -1: of the whole scene */
    bool of_boundary;  /* of a boundary; body and contact are -1 */
    size_t boundary;   /* which one */
    bool has_at;
    double at[2]; /* value at the point nearest to this place of the initial body */
    char *
        value; /* "position.x", "velocity.y", "displacement.x", "stress.xx", "force.y", "energy.kinetic", "momentum.x", "angular-momentum", ... */
    char *over; /* "mass" | "volume" | "max" | "min" | "sum" | "rms" or NULL */
    bool has_minus;
    ab_number minus; /* formula of t and of a point's place X, Y at the start, taken from its value */
    ab_where where;
    bool has_where;
} ab_monitor_spec;

typedef struct ab_expect_spec {
    char *name;
    ab_mark mark;
    size_t monitor; /* index into monitors; or SIZE_MAX with `column` naming a history column (kinetic, remainder, block.kinetic ...) */
    char *column;
    ab_number reference;     /* formula of t */
    char *norm;              /* "final" | "max" | "l2" | "mean" | "peak" | "duration" | "impulse" ... (docs/scene.md) */
    double from, to;         /* time window, defaults 0 and end */
    double level;            /* threshold of norms that have one */
    double tolerance, scale; /* scale 0: the reference's own size */
} ab_expect_spec;

typedef struct ab_ladder { /* of `trade`: a setting and its values; once they are to be run (trade_order.c) from coarse to fine */
    const char *name;
    const char **paths; /* as for --set; all of them get the value */
    size_t path_count;
    const char **values; /* YAML */
    size_t value_count;
    ab_mark mark;
} ab_ladder;

typedef struct ab_trade_spec { /* no ladders: the scene has no `trade` */
    ab_ladder *ladders;
    size_t ladder_count;
    size_t *judges; /* expects, or monitors of a scene without expects, that count; none: all */
    size_t judge_count;
    double tolerance, seconds; /* of the closing sentence */
    double limit;              /* s of wall time for a run; INFINITY: none */
    bool path;                 /* search: path */
    bool wall;                 /* cost is wall time, not processor time */
} ab_trade_spec;

typedef struct ab_override {
    const char *path, *value;
} ab_override; /* --set PATH=VALUE */

typedef struct ab_extreme { /* of `extremes`: a quantity to drive */
    const char *name;
    const char **paths; /* as for --set; all of them get the value */
    size_t path_count;
    const char *value; /* what they get, @ standing for the number; NULL: the number */
    double from, to, until;
    bool logarithmic, whole;
    size_t rungs;
    const char **values; /* in place of from and to; NULL: none */
    size_t value_count;
    ab_override *with; /* what else is set meanwhile */
    size_t with_count;
    const char *open; /* why it does not hold yet; NULL: it must */
    double right_to;  /* NaN: not said */
    double same;      /* 0: not asked for */
    ab_mark mark;
} ab_extreme;

typedef struct ab_extremes_spec {
    ab_extreme *quantities;
    size_t count;
    bool has_map;
    size_t map[2];
    double limit;  /* s of wall time for a run; INFINITY: none */
    double energy; /* remainder above which energy was made */
} ab_extremes_spec;

enum { AB_STAGES = 64 }; /* at most: a bit each */
typedef enum ab_stage_gravity { AB_GRAVITY_KEEP = 0, AB_GRAVITY_RAMP, AB_GRAVITY_OFF } ab_stage_gravity;

/* A part of the run with settings of its own. A scene with `time` alone has none. */
typedef struct ab_stage_spec {
    char *name;
    ab_mark mark;
    bool made;      /* for bodies whose initial stress is that of gravity: before t = 0, formulas and what is driven stand still */
    double end;     /* s: at the latest; the next one begins at this time whenever it ended. Of one that is made 0 */
    double dt, cfl; /* dt 0: by cfl; cfl 0: by dt */
    ab_stage_gravity gravity;
    double ramp;                /* s, of AB_GRAVITY_RAMP; 0: half of the stage */
    double local, local_until;  /* damping; until: s, INFINITY: all the stage */
    bool kinetic;               /* damping: all velocities to zero where the kinetic energy has passed a peak */
    bool has_until;             /* ends when the two ratios are met: */
    double unbalanced, at_rest; /* force out of balance over force applied; kinetic energy over work from outside; INFINITY: not asked */
    bool go_on;                 /* a warning, and on, where they are not met in time */
    ab_side_kind side[AB_SIDES];
    bool zero_displacements, zero_velocities; /* at its end */
} ab_stage_spec;

typedef struct ab_scene {
    char *path, *title;
    ab_space space;
    int dimension;
    ab_number gravity[2];                /* m/s2, formulas of t */
    bool checked;                        /* plugins run under guard (core/guard.h) */
    bool watch;                          /* end a run that makes energy */
    double watch_energy;                 /* as a part of what was put into it */
    double damping_local, damping_until; /* until: s, INFINITY when always */
    double time_end, time_dt, time_cfl;  /* dt 0: by cfl; cfl 0: by dt */
    ab_mark mark_time, mark_grid, mark_gravity;
    ab_stage_spec *stages; /* in their order; time_end, time_dt and time_cfl are then of the last, and of the first that is not made */
    size_t stage_count;    /* 0: all of the run is one */
    double grid_from[2], grid_to[2], grid_cell; /* cell 0: no grid (finite elements and rigid bodies alone) */
    int grid_cells[2];
    ab_side_kind side[AB_SIDES];
    ab_material_spec *materials;
    size_t material_count;
    ab_body_spec *bodies;
    size_t body_count;
    ab_contact_spec *contacts;
    size_t contact_count;
    ab_load_spec *loads;
    size_t load_count;
    ab_boundary_spec *boundaries;
    size_t boundary_count;
    size_t boundary_listed; /* of them under `boundaries`, the first; the others are written at sides of the grid */
    ab_monitor_spec *monitors;
    size_t monitor_count;
    ab_expect_spec *expects;
    size_t expect_count;
    long history_every;  /* steps; default 1 */
    double output_every; /* s; 0: only first and last frame when fields are asked for */
    char **output_fields;
    size_t output_field_count;
    bool output_contact; /* contact points too */
    bool has_output, has_history;
    bool has_checkpoint;
    double checkpoint_every, checkpoint_wall; /* s of the scene's time, s of wall time; 0: not by that */
    long checkpoint_steps;                    /* 0: not by steps */
    ab_trade_spec trade;
    ab_extremes_spec extremes;
    const struct ab_file_read *files;  /* that settings were read from (core/schema.h) */
    struct ab_scene_private *private_; /* document, parsers, arena */
} ab_scene;

/* Reads, applies overrides, checks everything. On AB_BAD_INPUT the report holds every mistake and *scene is NULL. */
ab_status ab_scene_read(const char *path, const ab_override *overrides, size_t override_count, ab_registry *registry, ab_scene **scene,
                        ab_report *report);
void ab_scene_destroy(ab_scene *scene);

/* Writes the reference of every key (docs/scene.md) from the tables that check it. */
void ab_scene_write_reference(FILE *stream);

#endif
