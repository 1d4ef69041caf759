/* abut_plugin.h: all that a plugin author needs. Plugin interface version 1.6.
 *
 * One source file makes one shared object. The object exports one symbol, and it is data:
 *
 *     AB_EXPORT const ab_plugin abut_plugin_v1 = { ... };
 *
 * abut reads this table before it runs any code of the plugin. A plugin offers classes of three kinds:
 *   material  turns strain into stress                                   (ab_material_ops)
 *   boundary  turns the state of an edge into a force                    (ab_boundary_ops)
 *   contact   finds contact points, or responds to them, or both        (ab_contact_ops)
 *
 * Conventions, stated once:
 *   units        SI everywhere: m, kg, s, N, Pa. The host converts what the user wrote.
 *   sign         tension is positive.
 *   components   stress, strain: (xx, yy, zz, xy) in plane strain, (xx, yy, zz, xy, yz, zx) in 3-D;
 *                axisymmetric scenes have the rows of plane strain, x the radius, y the axis, zz of hoops;
 *                strain increments hold *engineering* shear (gamma_xy = 2 eps_xy), so that the work is the plain
 *                sum of products of the components;
 *                deformation gradient (xx, xy, yx, yy, zz) in plane strain, row by row (9) in 3-D;
 *                velocity gradient    (xx, xy, yx, yy)     in plane strain, row by row (9) in 3-D; L_ij = dv_i/dx_j.
 *   arrays       component c of item i is a[c*ld + i]. ld >= count. Rows are 64-byte aligned when ld is a multiple of 8.
 *   ownership    every pointer that the host hands over belongs to the host and is valid until the call returns, except
 *                the ab_host table and the settings' texts and tables, which live until destroy() has returned.
 *   old state    is never written: state0, stress0 in; state1, stress1 out. The host may call again with the same input.
 *   threads      create, destroy: one at a time. update (materials): several threads at once on disjoint batches of the
 *                same self, so keep no hidden state, no globals, and allocate nothing. find, respond, apply: one thread at a time.
 *   returns      0; a positive code: "cut the step and try again"; a negative code: an error. Flag the culprits in
 *                batch->flag and say why through host->message.
 *   structs      each struct that crosses begins with its size in bytes; the host copies min(size, own size) into a zeroed one,
 *                so fields are only ever added at the end.
 */
#ifndef ABUT_PLUGIN_H
#define ABUT_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define AB_ABI_MAJOR 1u /* changes when an old plugin can no longer be understood */
#define AB_ABI_MINOR 6u /* grows when something is added; a plugin may be older than the host, never newer. 1: surfaces, springs;
                            2: density gradients, nearest faces, needs that hang on settings; 3: save and load;
                            4: boundaries; 5: points say whether they are about an axis */

#if defined(__GNUC__)
#define AB_EXPORT __attribute__((visibility("default")))
#else
#define AB_EXPORT
#endif

/* ---- settings: what the user may write in the scene ------------------------------------------------------------------ */

enum ab_type {
    AB_REAL = 1,  /* value.real, SI */
    AB_INTEGER,   /* value.integer */
    AB_FLAG,      /* value.integer, 0 or 1 */
    AB_CHOICE,    /* value.integer, the place of the word in `choices`, from 0 */
    AB_TABLE      /* value.table, rows x columns, row by row */
};

enum ab_param_flags {
    AB_REQUIRED = 1u,     /* no default: a scene without it is refused */
    AB_MIN_OPEN = 2u,     /* the value must be > min, not >= */
    AB_MAX_OPEN = 4u,     /* the value must be < max, not <= */
    AB_OR_DIRECTION = 8u, /* AB_CHOICE only: a vector [x, y(, z)] may stand instead of a word;
                             then value.integer = -1 and value.table is the unit vector, 3 numbers */
    AB_COLUMNS_2 = 16u,   /* AB_TABLE only: each row is a pair */
    AB_INCREASING = 32u   /* AB_TABLE only, since 1.4: the first column (a time) grows from row to row */
};

typedef struct ab_param {
    const char *name;    /* the key in the scene, lower_case; the field's usual symbol where there is one (E, nu) */
    const char *unit;    /* SI unit as UDUNITS reads it: "Pa", "kg m-3"; "1" for a pure number. AB_TABLE, since 1.4: of each column, "s, m s-2";
                            the last one stands for the columns after it, too */
    const char *help;    /* one line */
    const char *choices; /* AB_CHOICE: words separated by '|' ; else NULL */
    uint32_t type;       /* enum ab_type */
    uint32_t flags;      /* enum ab_param_flags */
    double initial;      /* default; for AB_CHOICE the place of the word */
    double min, max;     /* allowed range, -INFINITY and INFINITY (or 0, 0 for "any") where there is none */
} ab_param;

typedef struct ab_value { /* one per ab_param, in its order */
    double real;
    int64_t integer;
    const double *table;
    size_t rows, columns;
    uint32_t given; /* 1 where the scene had it, 0 where it is the default */
} ab_value;

/* ---- state: what the host keeps for the plugin, per material point, Gauss point or contact point ---------------------- */

enum ab_shape { AB_SCALAR = 1, AB_VECTOR, AB_SYMMETRIC, AB_FULL }; /* how it turns with the material; symmetric: as stress */
/* When points are split or merged. Contact points on shared nodes come and go while bodies slide: an AB_SUM is shared out in every step among points in cells
 * beside each other, in proportion to area x gap^2 where the gap is negative; it is not lost as long as one of them overlaps. */
enum ab_travel { AB_COPY = 1, AB_AVERAGE, AB_SUM };

typedef struct ab_state {
    const char *name, *unit, *help;
    uint32_t shape, travel;
    double initial; /* every component starts with it */
} ab_state;

/* ---- services of the host --------------------------------------------------------------------------------------------- */

struct ab_points;

typedef struct ab_host {
    uint32_t struct_size, abi_major, abi_minor;
    void *context;                                                       /* hand it back in each call */
    void *(*allocate)(void *context, size_t bytes);                      /* 64-byte aligned, zeroed; NULL when there is no memory; not in update */
    void (*release)(void *context, void *pointer);
    void (*message)(void *context, const char *text);                    /* what went wrong; kept for the error that follows; any thread */
    void (*log)(void *context, const char *text);                        /* a line for the user; create only */
    int (*reserve)(void *context, struct ab_points *points, size_t points_more, size_t stencil_more); /* find only: room for more; 0 or negative */
} ab_host;

/* ---- materials -------------------------------------------------------------------------------------------------------- */

enum ab_needs { /* what a class asks for; what nobody asks for is not computed and arrives as NULL */
    AB_NEED_DEFORMATION_GRADIENT = 1u,
    AB_NEED_VELOCITY_GRADIENT = 2u,
    AB_NEED_DENSITY = 4u, /* materials with this or the first one are asked for their wave speed again and again, for their stiffness may change; others once */
    /* contact finders */
    AB_NEED_SHARED_NODES = 16u,
    AB_NEED_MASS_GRADIENT = 32u,
    AB_NEED_AREA_VECTOR = 64u,
    AB_NEED_NEAR_POINTS = 128u,
    AB_NEED_SURFACE = 256u, /* trace->surface: points of one body and the faces of the other near them (since 1.1) */
    AB_NEED_DISTANCE = 512u, /* responses: points->distance (since 1.1) */
    AB_NEED_GAP = 1024u,     /* responses: a points->gap that is known: not that of a finder with the setting gap: none (since 1.1) */
    AB_NEED_FIXED_PLACES = 2048u, /* responses: contact points that stay where they are on the bodies: points->fixed_places (since 1.1) */
    /* since 1.2; these may be asked for by needs_with, and no others */
    AB_NEED_DENSITY_GRADIENT = 4096u, /* contact finders: trace->density_gradient */
    AB_NEED_NEAREST_FACE = 8192u,     /* contact finders: trace->face_normal, face_distance, face_turn: of bodies that have faces (finite elements, rigid) */
    AB_NEED_AREA = 16384u,            /* responses: a points->area that adds up to the length of the face: points->measure_area */
    /* boundaries, since 1.4: what `abut plugins check` must not ask of a class */
    AB_NEED_WHOLE_SIDE = 32768u, /* its answer at an edge hangs on the other edges of the call */
    AB_NEED_AXES = 65536u        /* its settings are of x and y of space (beyond those with AB_OR_DIRECTION): turned edges do not get turned answers */
};
enum ab_gives {
    AB_GIVE_STRESS = 1u,
    AB_GIVE_DISSIPATION = 2u, /* fills batch->dissipation */
    AB_GIVE_WAVE_SPEED = 4u,  /* fills batch->wave_speed when it is not NULL */
    /* contact */
    AB_GIVE_POINTS = 16u,  /* has find */
    AB_GIVE_IMPULSE = 32u, /* has respond */
    /* boundaries, since 1.4; traction or motion, or both */
    AB_GIVE_TRACTION = 64u,
    AB_GIVE_DAMPING = 128u,   /* fills edges->damping */
    AB_GIVE_STIFFNESS = 256u, /* fills edges->stiffness */
    AB_GIVE_MOTION = 512u     /* fills edges->prescribed */
};

typedef struct ab_batch {
    uint32_t struct_size;
    uint32_t dimension;  /* 2 (plane strain) or 3 */
    uint32_t components; /* of stress: 4 or 6 */
    size_t count, ld;
    double time, dt;     /* s; in start: dt = 0 */
    const double *density;              /* kg/m3, current; count; when needed or when wave_speed is asked for; else NULL */
    const double *strain_increment;     /* components rows; engineering shear; objective (rigid rotation taken out) */
    const double *deformation_gradient; /* at the end of the step, when needed; else NULL */
    const double *velocity_gradient;    /* 1/s, when needed; else NULL */
    const double *stress0;              /* Pa, already turned with the material's spin */
    double *stress1;                    /* Pa, Cauchy, to be written for every item */
    const double *state0;               /* rows in the order of the declared states, already turned; NULL without states */
    double *state1;
    double *dissipation; /* J per m3 of current volume in this step, with AB_GIVE_DISSIPATION; else NULL */
    double *wave_speed;  /* m/s, P-wave; NULL in steps that do not ask */
    uint8_t *flag;       /* set to 1 for an item that failed; zeroed by the host */
} ab_batch;

typedef struct ab_material_ops {
    uint32_t struct_size;
    int (*start)(void *self, ab_batch *batch);  /* optional. Before the first step: may set stress1, state1; wave_speed is always asked for. stress0 is the stress that
                                                   the scene gives (initial), 0 where it gives none: states that follow from it are set by it, stress1 is it.
                                                   Without it stress starts at 0, states at `initial`, and update must give the wave speed. */
    int (*update)(void *self, ab_batch *batch); /* from several threads at once */
} ab_material_ops;

/* ---- boundaries ------------------------------------------------------------------------------------------------------- */

/* The edges of a body that one boundary of the scene acts on: pieces of its outer surface, of material points or of finite elements, or the share of it that stands at
 * a grid node. They follow the material, stretch and turn with it. What is read is as of the start of the step; what is written acts over the step. */
typedef struct ab_edges {
    uint32_t struct_size, dimension;
    size_t count, ld; /* all edges of this boundary in one call; an edge keeps its place in the list for the whole run */
    double time, dt;  /* s; time at the start of the step */
    const double *position;     /* m, as drawn in the scene; dimension rows */
    const double *normal;       /* unit, out of the body; dimension rows */
    const double *displacement; /* m, since the boundary began to act; dimension rows */
    const double *velocity;     /* m/s; dimension rows */
    const double *area;         /* m2 (m in plane strain; of the ring, m2, in axisymmetry), now */
    const double *density, *p_wave_speed, *s_wave_speed; /* of the body there, now; kg/m3, m/s by the moduli of the material at its start */
    double *traction; /* Pa on the body, at this place and velocity; dimension rows. Zeroed by the host */
    const double *state0;
    double *state1;
    /* since 1.4. Zeroed by the host; NULL unless the class gives it */
    double *damping;    /* Pa s/m, two rows, along the normal and across it, both >= 0: how much less traction a larger velocity gets. With it the host takes the traction at
                           the mean velocity of the step, which is stable for any light edge; without it at the velocity at its start */
    double *stiffness;  /* Pa/m, two rows as damping: how much less traction a larger displacement gets; the host keeps dt below its limit */
    double *prescribed; /* m/s, dimension rows: what the velocity is to be at the end of the step. The host begins with NaN: free */
    uint8_t *flag;      /* set to 1 for an edge that failed; zeroed by the host */
} ab_edges;

typedef struct ab_boundary_ops {
    uint32_t struct_size;
    int (*apply)(void *self, ab_edges *edges); /* once a step; one thread at a time */
} ab_boundary_ops;

/* ---- contact ---------------------------------------------------------------------------------------------------------- */

/* The surface of one body of a pair: points that may touch faces of the other body, and faces that points of the other may touch. Either list may be
 * empty (material points without an outline have no faces). Positions are measured from the grid's corner, as everywhere in a trace. A velocity anywhere on the
 * surface is that of its stencil: sum of weight x velocity of dof; the weights of a point or a vertex sum to 1. In two dimensions a face runs from its first
 * vertex to its last with the body on its left, so that its outside is on its right. */
typedef struct ab_surface {
    uint32_t struct_size, dimension;
    size_t point_count, point_ld;
    const double *point_position; /* m; dimension rows */
    const double *point_extent;   /* m2; symmetric, as near_extent: the half size along n is sqrt(n.A.n); 0 for nodes */
    const double *point_area;     /* m2 (m in plane strain): share of the surface; of a material point sqrt(V), so that on a face
                                     with normal n it stands for area^2/(2 half size along n): exact where a side of its domain lies along the face */
    const uint64_t *point_key;    /* names the point in every step */
    const size_t *point_start;    /* point_count + 1: its stencil */
    const uint32_t *point_dof;
    const double *point_weight;
    const size_t *near_start; /* point_count + 1: faces of the *other* body within reach of the point, ascending */
    const uint32_t *near_face;
    size_t vertex_count, vertex_ld;
    const double *vertex_position; /* m; dimension rows */
    const size_t *vertex_start;    /* vertex_count + 1: its stencil */
    const uint32_t *vertex_dof;
    const double *vertex_weight;
    size_t face_count;
    const uint32_t *face_vertex; /* 3 per face: first, last, middle (UINT32_MAX: a straight face) */
    const uint32_t *face_beside; /* 2 per face: the face before its first vertex, the face after its last (UINT32_MAX: none) */
    const uint32_t *point_vertex; /* point_count: the body's own vertex that the point is, so that its own faces say where its outside is
                                     (UINT32_MAX: none); NULL: no point is one (material points) */
} ab_surface;

/* One body of a pair as a finder sees it. Shared nodes: grid nodes that have mass of both bodies; item i of side a and item i of
 * side b are the same node. "Near points" are the body's own points whose basis reaches the node, listed per node:
 * those of node i are near_start[i] .. near_start[i+1]-1. The half size of a point in direction n is sqrt(n.A.n), A its extent. */
typedef struct ab_trace {
    uint32_t struct_size, dimension;
    const char *body;
    double stiffness; /* Pa, P-wave modulus of the body's material */
    double cell;      /* m, cell size of the grid */
    size_t count, ld;
    const double *position;      /* m from the grid's corner, of the node; dimension rows */
    const size_t *stencil_start; /* count + 1: on which dofs the body's velocity at node i hangs, and with which weights (a material-point */
    const uint32_t *stencil_dof; /* body: the node itself, weight 1; a finite-element body: the nodes of its elements around it) */
    const double *stencil_weight;
    const uint64_t *key;         /* a number that names the node in every step (for history) */
    const double *mass;          /* kg (per m of thickness in plane strain) */
    const double *mass_gradient; /* sum_p m_p G_ip, kg/m; dimension rows; NULL unless needed */
    const double *area_vector;   /* sum_p V_p G_ip, m2 (m in plane strain), out of the body; NULL unless needed */
    const size_t *near_start;    /* count + 1; NULL unless needed */
    size_t near_ld;
    const double *near_position; /* m from the grid's corner; dimension rows */
    const double *near_extent;   /* m2; symmetric: (xx, yy, xy) or (xx, yy, zz, xy, yz, zx) */
    const ab_surface *surface;   /* NULL unless needed; since 1.1. With it alone count is 0: no node is looked for */
    /* since 1.2; dimension rows and single ones of ld; NULL unless needed */
    const double *density_gradient; /* kg/m4: slope of the plane that fits best (least squares) the densities at the centres of the cells that meet
                                       at the node, each sum_p m_p B(x_c - x_p) with B the quadratic B-spline of the cell's size; points into the body */
    const double *face_normal;      /* of the body's face nearest to the node: unit, out of the body; where that is a vertex, from it to the node (from the
                                       node to it inside the body). 0 where no face is within two cells; NULL for a body without faces */
    const double *face_distance;    /* m, from that place to the node; negative inside the body; INFINITY where there is no face */
    const double *face_turn;        /* rad: where that place is a vertex, by how much the outline turns there; else 0 */
} ab_trace;

/* Contact points (side a, side b): v_rel = sum w_a v_a - sum w_b v_b; the normal goes out of a into b; approaching when v_rel.n > 0.
 * An impulse j acts on b, -j on a. */
typedef struct ab_points {
    uint32_t struct_size, dimension;
    double time, dt, cell;
    size_t count, capacity, ld; /* find sets count; ld = capacity */
    /* written by find */
    uint64_t *key;               /* names the point in every step, for history */
    size_t *a_start, *b_start;   /* count + 1: stencil of point i is a_dof[a_start[i]] .. a_dof[a_start[i+1]-1] */
    uint32_t *a_dof, *b_dof;
    double *a_weight, *b_weight; /* sum to 1 per point and side */
    double *position;            /* m, where the impulse acts; dimension rows */
    double *normal;              /* dimension rows, unit */
    double *gap;                 /* m, negative: penetration; 0 where it is not known */
    double *area;                /* m2 (m in plane strain) */
    /* given to respond */
    const double *relative_velocity; /* m/s, dimension rows, with every impulse so far */
    const double *normal_mass;       /* kg, effective mass along the normal; 0: both sides are held */
    const double *tangential_mass;   /* kg, effective mass across the normal */
    double *impulse;                 /* N s on b, dimension rows: in: total of this step so far; out: new total */
    const double *state0;
    double *state1;
    /* since 1.1 */
    double *distance;  /* m, written by find where a response needs it (else NULL): from where the impulse acts to the nearest material of the stiffer body */
    double *stiffness; /* N/m (per m of thickness), written by a response that acts as a spring: the host keeps dt below 2 sqrt(m/k). Zeroed by the host */
    double modulus;    /* Pa: P-wave modulus of the softer body */
    size_t failures;   /* find adds what it could not decide; the run's summary shows the sum */
    double speed;      /* m/s: with AB_NEED_SURFACE, no place listed on one surface moves faster than this against one of the other */
    double density;    /* kg/m3: of the body that modulus is of; 0 where it has none (rigid) */
    const double *relative_velocity_old; /* m/s, dimension rows: at the start of the step. The work that an impulse takes from the bodies is the impulse
                                            times the mean of this and of what relative_velocity ends at */
    int fixed_places; /* 1: a finder keeps its points where they are on the bodies (a response that holds them asked for it, and both are meshes); 0: it may follow the place where
                         round bodies touch, which moves along them as they roll */
    int measure_area; /* since 1.2. 1: areas are read (a response asked for them, or a monitor shows them), and should add up to the length of the face
                         that the bodies share; 0: a finder may leave it at what it has at hand */
    int axisymmetric; /* since 1.5. 1: x is the radius (0, the axis, at the grid's corner), and in respond areas are those of rings: a length l at r stands for 2 pi r l */
    int holds; /* since 1.6. 1: the response lets nothing slip: a tie (AB_NEED_FIXED_PLACES), or one whose setting `friction` is 10 or more */
} ab_points;

typedef struct ab_contact_ops {
    uint32_t struct_size;
    int (*find)(void *self, const ab_trace *a, const ab_trace *b, ab_points *out);        /* optional */
    int (*respond)(void *self, ab_points *points, size_t first, size_t count);            /* optional; called until impulses stand still */
} ab_contact_ops;

/* ---- the descriptor ---------------------------------------------------------------------------------------------------- */

enum ab_kind { AB_MATERIAL = 1, AB_BOUNDARY, AB_CONTACT };
enum ab_spaces { AB_PLANE_STRAIN = 1u, AB_AXISYMMETRIC = 2u, AB_SPACE_3D = 4u };

typedef struct ab_stream { /* bytes of a checkpoint; since 1.3. 0, or negative: no memory, or nothing left to read */
    uint32_t struct_size;
    void *context; /* hand it back in each call */
    int (*write)(void *context, const void *bytes, size_t count);
    int (*read)(void *context, void *bytes, size_t count);
} ab_stream;

typedef struct ab_class {
    uint32_t struct_size;
    uint32_t kind;   /* enum ab_kind */
    uint32_t spaces; /* or of enum ab_spaces */
    uint32_t needs, gives;
    uint32_t nparam, nstate;
    const char *name, *help, *reference; /* name: what a scene writes; reference: the source of the formula */
    const ab_param *param;
    const ab_state *state;
    int (*create)(const ab_host *host, const ab_value *settings, void **self); /* settings in the order of param */
    void (*destroy)(void *self); /* both NULL in a class without settings that keeps nothing: self is then NULL */
    const void *ops; /* ab_material_ops, ab_boundary_ops or ab_contact_ops */
    uint32_t (*needs_with)(const ab_value *settings); /* optional, contact, since 1.2: what it needs beyond `needs` with these settings; pure, called often */
    /* Optional, both or neither, since 1.3: what an instance remembers from one step to the next beside its declared states, for checkpoints. Between two steps, on one
     * thread. load meets an instance just created with the same settings, and has to read all that save wrote. */
    int (*save)(void *self, const ab_stream *stream);
    int (*load)(void *self, const ab_stream *stream);
} ab_class;

typedef struct ab_plugin {
    uint32_t struct_size;
    uint32_t abi_major, abi_minor;
    uint32_t size_of_double, size_of_size_t;
    uint32_t class_count;
    const char *name, *version, *licence;
    const ab_class *const *classes; /* class_count pointers */
} ab_plugin;

extern AB_EXPORT const ab_plugin abut_plugin_v1;

/* First fields of a descriptor: { AB_PLUGIN_HEAD(count), "name", "1.0", "MIT", classes } */
#define AB_PLUGIN_HEAD(classes) \
    (uint32_t)sizeof(ab_plugin), AB_ABI_MAJOR, AB_ABI_MINOR, (uint32_t)sizeof(double), (uint32_t)sizeof(size_t), (uint32_t)(classes)

#ifdef __cplusplus
}
#endif
#endif
