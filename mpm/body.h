/* body.h: how a material-point body lies in memory. Inside mpm/ only.
 *
 * Points stand in blocks of eight; a block is `fields` rows of eight doubles, so that row f of block b is one vector. Each tile of the grid owns a run of
 * blocks, its points sorted by cell; the last block of a tile is filled up with massless copies. Positions are measured from the grid's corner.
 *
 * A tile scatters into a patch of its own (PATCH x PATCH nodes, one node more on each side than its stencils need at rest, so that points may drift by a
 * cell before they are sorted again); then each tile adds up the nodes it owns from the nine patches around it, in one fixed order. No two
 * threads ever write to one place and no sum depends on their number. */
#ifndef AB_MPM_BODY_H
#define AB_MPM_BODY_H

#include "core/domain.h"
#include "core/material.h"
#include "core/vector.h"
#include "mpm/fill.h"

/* Rows of a block every body has; the others are behind them where the plan asks for them. */
enum { ROW_X = 0, ROW_V = 2, ROW_NEXT = 4, ROW_MASS = 6, ROW_VOLUME = 7, ROW_STRESS = 8, ROW_OTHERS = 12 };

enum { PATCH = AB_TILE + 4, PATCH_NODES = PATCH * PATCH, PATCH_DOUBLES = 8 * PATCH_NODES };

/* A node in a patch: mass, momentum, and the internal force in two halves (terms with dN/dx, terms with dN/dy) that assembly adds. */
enum { NODE_MASS = 0, NODE_MOMENTUM = 1, NODE_FORCE_X = 4, NODE_FORCE_Y = 6 };

/* A node a tile owns, 64 bytes: current velocity, velocity at the start of the step, mass, inverse masses (0 where held). */
enum { OWN_VELOCITY = 0, OWN_OLD = 2, OWN_MASS = 4, OWN_INVERSE = 5, OWN_RECORD = 8 };

/* A node's part in the filter of xpic and fmpm: what is left to correct, and the sum of corrections, m/s. */
enum { FILTER_REST = 0, FILTER_SUM = 2, FILTER_RECORD = 4 };

typedef struct mpm_rows { /* where the optional rows begin; -1: not allocated */
    int count;            /* rows in a block */
    int extent;           /* 3: (xx, yy, xy) of the domain tensor, m2 */
    int half;             /* 2: half sizes of the point's domain, m (gimp) */
    int inverse_half;     /* 2: their inverses */
    int gradient;         /* 4: deformation gradient xx, xy, yx, yy */
    int affine;           /* 4: of the velocity about the point, xx, xy, yx, yy (apic, tpic): see transfer.inc */
    int state, states;    /* the material's */
    bool turns;           /* some state is a vector or a tensor */
} mpm_rows;

typedef struct mpm_sums {                                 /* of one tile, one step */
    double mass, kinetic, momentum[2], angular, first[2]; /* first: sum m x */
    double own_inertia;                                   /* sum m tr D of points with an affine part */
    double potential, strain, plastic;                    /* increments */
    double low[2], high[2];                               /* bounds of the new positions */
    double speed2;                                        /* largest v.v */
    double wave_speed;                                    /* largest, when asked for */
} mpm_sums;

typedef struct mpm_tile {
    int32_t tx, ty;
    uint32_t first, blocks, points; /* run of blocks; points without the massless copies */
    int32_t patch;                  /* number of its patch; -1: holds nodes only */
    int32_t around[9];              /* tiles around it by (dy+1)*3 + dx+1; -1: none */
    bool held;                      /* some node on or beyond a roller or fixed side */
} mpm_tile;

typedef struct mpm_load {      /* a piece of outline with a traction or a pressure */
    uint32_t id;               /* of the point under it */
    uint32_t spec;             /* which load of the scene */
    double length;             /* m, at the start */
    double arm[2];             /* m, from the point to the middle of the piece; follows the material */
    double half[2];            /* m, from there to its end, the body on the left */
    double place[2];           /* m, of its middle at the start, as drawn */
    uint32_t prior, next;      /* loads of the same pressure on the pieces before and behind it; UINT32_MAX: none */
    double now[2], stretch[2]; /* m, where its middle is in this step, and from there to its end */
    double force[2];           /* N, in this step */
} mpm_load;

typedef struct
    mpm_weights { /* of a block: values and gradients (1/m) of the 2 or 3 nodes per direction, and the first of them in the patch */
    v8 n[2][3], g[2][3];
    int32_t node[8]; /* patch node (j+1)*PATCH + i+1 for node (i, j) of the tile */
} mpm_weights;

typedef struct mpm_body mpm_body;

/* Ways to bring velocities back to the points, each a pass of its own. */
enum { MPM_FINISH_BLEND, MPM_FINISH_AFFINE, MPM_FINISH_EXTENDED, MPM_FINISH_WAYS };

typedef struct mpm_kernel { /* one per basis, from mpm/kernel.inc */
    const char *basis;
    int nodes; /* per direction */
    void (*weights)(const mpm_body *, const mpm_tile *, const double *block, mpm_weights *);
    void (*spreads)(const mpm_body *, const mpm_tile *, const double *block, double d[2][8]); /* sum N (x_i - x_p)^2 by direction, m2 */
    void (*scatter[2])(mpm_body *, size_t tile);                                              /* plain; with the affine part */
    void (*finish[MPM_FINISH_WAYS])(mpm_body *, size_t tile, const ab_step *, bool remap, mpm_sums *);
    void (*filter)(mpm_body *, size_t tile); /* xpic, fmpm: what FILTER_REST holds, to the points and back onto the patch */
    int (*stress)(mpm_body *, size_t tile, const ab_step *, bool advance,
                  mpm_sums *); /* -1, or the block near which the material gave up */
} mpm_kernel;
extern const mpm_kernel mpm_kernel_linear, mpm_kernel_gimp;

typedef enum mpm_update { MPM_USF, MPM_USL, MPM_MUSL } mpm_update;

struct mpm_body {
    ab_domain domain; /* first */
    const ab_scene *scene;
    const mpm_kernel *kernel;
    mpm_update update;
    double flip;
    int finish;  /* MPM_FINISH_* */
    bool moment; /* rows.affine holds B, not C: see transfer.inc */
    int order;   /* xpic, fmpm: m */
    bool full;   /* fmpm: the filter takes the velocity after the forces, not the one before */
    bool contiguous, gravity;
    int threads;
    double h, inverse_h, origin[2], span[2]; /* cell, its inverse, grid corner, size of the grid, m */

    mpm_rows rows;
    double *blocks; /* block b begins at blocks + b*8*rows.count */
    uint64_t *ids;  /* of point b*8 + l; UINT64_MAX for a massless copy */
    size_t block_count, block_capacity;
    double *spare_blocks; /* the other half of a sort */
    uint64_t *spare_ids;
    size_t spare_capacity;
    size_t points; /* alive */
    size_t born;   /* ids given out: 0 .. born-1 */
    double *birth; /* (x, y) by id at the start, from the grid's corner; only when displacements are asked for */

    mpm_tile *tiles;
    uint64_t *keys; /* of the tiles, ascending */
    size_t tile_count, tile_capacity;
    double *own;     /* OWN_RECORD * AB_TILE_NODES per tile */
    double *patches; /* PATCH_DOUBLES per tile with points */
    double *filter;  /* FILTER_RECORD * AB_TILE_NODES per tile; NULL but for xpic and fmpm of order 2 and more */
    size_t own_capacity, filter_capacity, patch_capacity, patch_count;
    mpm_sums *sums; /* per tile */
    size_t sums_capacity;
    uint64_t version; /* of the tile list */
    bool scattered;   /* the patches hold this step's points already */
    bool sort_due;

    const ab_material_spec *material;
    void *self; /* the plugin's instance */
    ab_service service;
    double wave_speed;    /* largest, m/s */
    bool ask_wave_speed;  /* in this step's stress pass */
    double modulus;       /* P-wave modulus, Pa */
    double largest_speed; /* m/s */
    double point_mass;    /* kg, largest */
    char limit[128];

    mpm_load *loads;
    size_t load_count;
    uint32_t *slot; /* by id, block*8 + lane, UINT32_MAX: has left; only with loads or an outline */

    ab_energy energy;   /* totals so far */
    double last_strain; /* J: what the last step added to energy.strain */
    ab_motion motion;

    ab_field *fields; /* that can be written */
    size_t field_count;

    /* what a contact finder was last shown */
    struct mpm_trace *trace;
    struct mpm_surface *surface; /* its points in cells where another body has faces */
    struct mpm_outline *outline; /* its own faces; NULL unless another body of points looks for them */
    size_t fixed_bytes;
};

/* body.c: what main hands to the scheduler for `method: material-points`. */
ab_status mpm_create(const ab_scene *, size_t body, int threads, ab_domain **, ab_report *);

/* points.c */
void mpm_rows_plan(mpm_body *); /* which rows this scene needs */
ab_status mpm_points_insert(mpm_body *, const ab_fill *, ab_report *);
ab_status mpm_points_sort(mpm_body *, ab_report *); /* after begin's bounds were broken, or the first time */
bool mpm_points_index(mpm_body *);                  /* from now on body->slot says where a point is; false: no memory */
static inline double *mpm_block(const mpm_body *body, size_t block) { return body->blocks + block * 8 * (size_t)body->rows.count; }

/* material.c */
ab_status mpm_material_start(mpm_body *, ab_report *); /* the material's instance; stress and states of the points at the start */

/* transfer.c */
void mpm_transfer_choose(mpm_body *);               /* from the scene: before the rows are planned */
void mpm_filter(mpm_body *);                        /* xpic, fmpm: after contact and damping, before finish */
void mpm_affine_start(mpm_body *, const ab_fill *); /* the slope of the velocity drawn */
/* Of the point in a slot, at rows.x: twice the kinetic energy of its affine part, tr(C D C^T) (0 without one), and its angular momentum, per kg. */
double mpm_affine_inner(const mpm_body *, size_t slot, double *spin, double *inertia);

/* tiles.c */
ab_status mpm_tiles_build(mpm_body *, const uint64_t *filled, size_t count,
                          ab_report *);                               /* the tiles of `filled` (ascending) and their neighbours */
long mpm_tile_find(const uint64_t *keys, size_t count, uint64_t key); /* place, or -1 */
size_t mpm_tile_of_block(const mpm_body *, uint32_t block);           /* that owns it: tiles with points hold ascending runs */
uint32_t mpm_dof_of(const mpm_tile *, int patch_node);                /* the node's number among the body's dofs */

/* grid.c */
void mpm_grid_assemble(mpm_body *, const ab_step *, bool forces);              /* old velocity, trial velocity */
void mpm_grid_assemble_remap(mpm_body *);                                      /* velocity of the points mapped back */
void mpm_grid_fetch_velocity(const mpm_body *, size_t tile, double *pairs);    /* a patch of velocities */
void mpm_grid_fetch_motion(const mpm_body *, size_t tile, double *quadruples); /* a patch of velocities and their changes in this step */
void mpm_grid_fetch_filter(const mpm_body *, size_t tile, int from, double *pairs); /* a patch of FILTER_REST or FILTER_SUM */
void mpm_grid_filter_start(mpm_body *);                                             /* the rest is the whole velocity to be corrected */
void mpm_grid_filter_assemble(mpm_body *);       /* the rest loses what came back, the sum gains the rest */
double mpm_grid_damp(mpm_body *, double factor); /* after contact; energy taken, J */
void mpm_grid_limit_light(mpm_body *);           /* USL: light nodes take their old velocity for the strain */

/* loads.c */
ab_status mpm_loads_create(mpm_body *, const ab_fill *, ab_report *);
void mpm_loads_scatter(mpm_body *, const ab_step *);
void mpm_loads_work(mpm_body *, const ab_step *);
void mpm_loads_follow(mpm_body *, const ab_step *); /* with the velocities that strain the points, before they are strained */

/* trace.c */
ab_status mpm_trace(ab_domain *, const uint32_t *nodes, size_t count, uint32_t needs, ab_trace *, ab_report *);
void mpm_trace_destroy(struct mpm_trace *);

/* surface.c */
ab_status mpm_surface_points(ab_domain *, const ab_region *, ab_surface *, ab_report *);
void mpm_surface_destroy(struct mpm_surface *);

/* outline.c: the body's faces. No outline: nothing is done, and there are none. */
ab_status mpm_outline_create(mpm_body *, const ab_fill *, ab_report *);
ab_status mpm_outline_move(mpm_body *, const ab_step *, ab_report *); /* with the velocities that move the points */
void mpm_outline_follow(mpm_body *, const ab_step *);                 /* with the velocities that strain them, before they are strained */
ab_status mpm_faces(ab_domain *, ab_surface *, ab_report *);
size_t mpm_outline_bytes(const struct mpm_outline *);
void mpm_outline_destroy(struct mpm_outline *);

/* fields.c */
ab_status mpm_fields_create(mpm_body *, ab_report *);
const ab_field *mpm_fields(const ab_domain *, size_t *count);
ab_status mpm_read(const ab_domain *, const char *field, double *values, ab_report *);
size_t mpm_count(const ab_domain *);

#endif
