/* body.h: how a material-point body lies in memory. Inside mpm/ only.
 *
 * Points stand in blocks of eight; a block is `fields` rows of eight doubles, so that row f of block b is one vector. Each tile of the grid owns a run of
 * blocks, its points sorted by cell; the last block of a tile is filled up with massless copies. Positions are measured from the grid's corner.
 *
 * A tile scatters into a patch of its own (patch x patch nodes, one node more on each side than its stencils need at rest, so that points may drift by a
 * cell before they are sorted again); then each tile adds up the nodes it owns from the nine patches around it, in one fixed order. No two
 * threads ever write to one place and no sum depends on their number.
 *
 * How a basis (a kernel) is added: a source file mpm/kernel_<basis>.c that defines one mpm_kernel, its name in the table of mpm/kernels.c and in the words of
 * `basis` (core/scene_keys_bodies.c). A basis whose weights are products of one weight per direction needs a branch in mpm/kernel.inc, which has all passes and is
 * compiled per basis. Any other writes its own passes; what they owe each other is said at mpm_kernel. Nothing outside of a kernel assumes anything of a
 * basis: not that weights are products, not where a stencil begins, not how far it reaches. */
#ifndef AB_MPM_BODY_H
#define AB_MPM_BODY_H

#include "core/domain.h"
#include "core/material.h"
#include "core/mesh.h"
#include "core/vector.h"
#include "mpm/fill.h"

/* Rows of a block every body has; the others are behind them where the plan asks for them. */
enum { ROW_X = 0, ROW_V = 2, ROW_NEXT = 4, ROW_MASS = 6, ROW_VOLUME = 7, ROW_STRESS = 8, ROW_OTHERS = 12 };

/* Nodes per direction of a patch, for stencils of 2 or 3 and of 4 nodes; a kernel has one of the two. */
enum { MPM_PATCH_NARROW = AB_TILE + 4, MPM_PATCH_WIDE = AB_TILE + 5, MPM_PATCH_MOST = MPM_PATCH_WIDE * MPM_PATCH_WIDE };
enum { MPM_STENCIL = 16 }; /* nodes of a point, at most */

/* A node in a patch: mass, momentum, the radial force of hoops (axisymmetric scenes), and the internal force in two halves (terms with dN/dx, terms with dN/dy)
 * that assembly adds. */
enum { NODE_MASS = 0, NODE_MOMENTUM = 1, NODE_HOOP = 3, NODE_FORCE_X = 4, NODE_FORCE_Y = 6 };

/* A node a tile owns, 64 bytes: current velocity, velocity at the start of the step, mass, inverse masses (0 where held). */
enum { OWN_VELOCITY = 0, OWN_OLD = 2, OWN_MASS = 4, OWN_INVERSE = 5, OWN_RECORD = 8 };

/* A node's part in the filter of xpic and fmpm: what is left to correct, and the sum of corrections, m/s. */
enum { FILTER_REST = 0, FILTER_SUM = 2, FILTER_RECORD = 4 };

enum { VOLUMETRIC_RECORD = 4 }; /* what f_bar keeps of a cell: see mpm/volumetric.c */

typedef struct mpm_rows { /* where the optional rows begin; -1: not allocated */
    int count;            /* rows in a block */
    int extent;           /* 3: (xx, yy, xy) of the domain tensor, m2 */
    int half;             /* 2: half sizes of the point's domain, m (gimp) */
    int inverse_half;     /* 2: their inverses */
    int corners;          /* 4: half sides of the point's domain, (x, y) of one and of the other, m (cpdi) */
    int gradient;         /* 4: deformation gradient xx, xy, yx, yy; 5 with zz in axisymmetric scenes */
    int mean_stress;      /* 1: (xx + yy)/2 as the material gave it, while that of the stress is averaged (f_bar) */
    int affine;           /* 4: of the velocity about the point, xx, xy, yx, yy (apic, tpic): see transfer.inc */
    int state, states;    /* the material's */
    bool turns;           /* some state is a vector or a tensor */
} mpm_rows;

typedef struct mpm_sums {                                 /* of one tile, one step */
    double mass, kinetic, momentum[2], angular, first[2]; /* first: sum m x */
    double own_inertia;                                   /* sum m tr D of points with an affine part */
    double potential;                                     /* increment */
    double low[2], high[2];                               /* bounds of the new positions, m */
    double begin[2], end[2];                              /* least and largest first node of the stencils there, from the grid's corner */
    double speed2;                                        /* largest v.v */
    double external;                                      /* of the body force, per s; set by its own pass */
    double strain, plastic;                               /* increments; these and the next are sums of the stress pass */
    double wave_speed;                                    /* largest, when asked for */
    int culprit;                                          /* block in which the material gave up, or -1 */
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

typedef struct mpm_reach { /* the nodes of a piece of outline: its weights, gradients at the point under it, places in its tile's patch */
    double n[MPM_STENCIL], g[MPM_STENCIL][2];
    size_t node[MPM_STENCIL];
    int count;
    const mpm_tile *tile;
} mpm_reach;

typedef struct mpm_body mpm_body;

typedef struct mpm_light_tile {
    uint64_t nodes; /* a bit for each of them with less than light_limit, then for each that is light */
    double most;    /* kg: what the heaviest of them holds */
} mpm_light_tile;

typedef struct mpm_tie { /* a light node, which goes by others: see light_nodes.c */
    uint32_t dof, to[8];
    int32_t count;
    int32_t axes;  /* along which it is light: 1 x, 2 y */
    bool straight; /* on lines of heavy nodes along these */
    double weight[8];
    double rest[2]; /* kg m/s: its momentum that is not of the line */
    double heavy;   /* kg: the least mass of a node of its row or column that is not light */
} mpm_tie;
enum { MPM_LIGHT_MORE = 96 }; /* a stencil is longer by so many at most where light ones go by others; one of four nodes by 32 */

/* What the points of a block are to the nodes: of node k = j*nodes + i, i and j from 0 to nodes-1, the value and the gradient (1/m) for each of the eight
 * points. Nodes of no weight may be among them: values and gradients are 0 there. */
typedef struct mpm_stencils {
    double value[MPM_STENCIL][8], gx[MPM_STENCIL][8], gy[MPM_STENCIL][8] __attribute__((aligned(64)));
    int32_t node[8]; /* place in the tile's patch of node k = 0; node k is at node + j*patch + i */
} mpm_stencils;

/* Ways to bring velocities back to the points, each a pass of its own. */
enum { MPM_FINISH_BLEND, MPM_FINISH_AFFINE, MPM_FINISH_EXTENDED, MPM_FINISH_WAYS };

/* A basis. Node (i, j) of a tile (its own: 0 .. AB_TILE-1) is at (j+1)*patch + i+1 in its patch. A point is kept by the tile of its first node, and may drift so
 * far before the next sort that its first node is -1 or AB_TILE there, per direction; so patch >= AB_TILE + nodes + 1. Lanes without an id are massless copies of a
 * point. */
typedef struct mpm_kernel {
    const char *basis;
    int nodes;                /* per direction, 4 at most: a point's stencil is nodes x nodes */
    int patch;                /* MPM_PATCH_NARROW or MPM_PATCH_WIDE */
    double reach;             /* cells: farther away than this in some direction a point has no weight */
    bool domains;             /* points have domains of their own: rows half, inverse_half, and extent where they follow the stretch */
    double light;             /* of a full node's mass: nodes with less go by their neighbours, see light_nodes.c; 0: none does */
    bool convected;           /* points have parallelograms of their own: rows corners */
    bool moment, same_spread; /* apic takes moments of the velocities; D is the same everywhere but at sides: see transfer.inc */
    /* dt c/h at which the scheme is neutrally stable at frozen points, worst over places, with 1 .. 8 points per direction */
    double courant[8];
    /* First nodes of the stencils of a block's points standing at rows x, x+1 (ROW_X or ROW_NEXT), counted from the grid's corner; with all rows up to date. */
    void (*first)(const mpm_body *, const double *block, int x, int32_t node[2][8]);
    void (*stencils)(const mpm_body *, const mpm_tile *, const double *block, mpm_stencils *);
    void (*spreads)(const mpm_body *, const mpm_tile *, const double *block,
                    double d[3][8]); /* sum N (x_i - x_p)(x_i - x_p)^T: xx, yy, xy, m2 */
    /* Weights on the stencil of the point in `lane` (order of mpm_stencils) for the force on a piece of outline about load->now, half of it load->stretch: such that
     * it balances the internal force of a uniform stress. NULL: those of the point. */
    void (*carry)(const mpm_body *, const mpm_tile *, const double *block, int lane, const mpm_load *, double value[MPM_STENCIL]);
    /* The passes. scatter: patch records (NODE_*) of the points at ROW_X, plain and with the affine part. */
    void (*scatter[2])(mpm_body *, size_t tile);
    /* Velocities and places (ROW_NEXT) of the points from the nodes; with `remap` the new momenta onto the patch (pairs), at the old places. Sums all but the
     * last three of mpm_sums. */
    void (*finish[MPM_FINISH_WAYS])(mpm_body *, size_t tile, const ab_step *, bool remap, mpm_sums *);
    void (*filter)(mpm_body *, size_t tile); /* xpic, fmpm: what FILTER_REST holds, to the points and back onto the patch */
    void (*dilate)(mpm_body *, size_t tile,
                   const ab_step *); /* f_bar: sums of V d and V by cells onto the patch (mpm/volumetric.h); NULL: not with it */
    /* Strain, stress, volumes and domains; with `advance` points then stand at ROW_NEXT. -1, or the block near which the material gave up. */
    int (*stress)(mpm_body *, size_t tile, const ab_step *, bool advance, mpm_sums *);
} mpm_kernel;
const mpm_kernel *mpm_kernel_of(const char *basis, ab_space); /* kernels.c; NULL: the basis is not there in that space */

/* True for a side that holds its nodes. At all others the grid goes on beyond. */
static inline bool mpm_side_holds(ab_side_kind side) { return side == AB_SIDE_ROLLER || side == AB_SIDE_FIXED; }

/* USAVG (update stress averaged: Nairn 2003): half of the step's strain as USF takes it, half as MUSL does. Between two forces points are then strained half by the gradients of their old
 * place and half by those of their new one, which is what the forces there do work on. With the others that work is off by dt/2 sigma (B_new - B_old) v, which has no
 * sign, and makes energy where bodies fly through the grid in time with their vibration (a parametric resonance). */
typedef enum mpm_update { MPM_USF, MPM_USL, MPM_MUSL, MPM_USAVG } mpm_update;
static inline bool mpm_strains_first(mpm_update update) { return update == MPM_USF || update == MPM_USAVG; }
static inline bool mpm_maps_back(mpm_update update) { return update == MPM_MUSL || update == MPM_USAVG; }

struct mpm_body {
    ab_domain domain; /* first */
    const ab_scene *scene;
    const mpm_kernel *kernel;
    mpm_update update;
    bool from_end; /* usavg: the strain being taken is that of the half step that ends where points are */
    double flip;
    int finish;                /* MPM_FINISH_* */
    bool moment, keeps_moment; /* apic by moments of the velocities; rows.affine then holds B, not C: see transfer.inc */
    int order;                 /* xpic, fmpm: m */
    bool full;                 /* fmpm: the filter takes the velocity after the forces, not the one before */
    bool contiguous, gravity;
    bool axisymmetric; /* x is the radius, points are rings: volumes in m3, masses and forces of the whole ring */
    ab_f_bar f_bar;
    int threads;
    struct mpm_share *shares;                /* of the tiles, one a thread: see share.h */
    size_t share_count;                      /* 0: none yet */
    uint64_t shared_version;                 /* of the tile list that is shared out */
    ab_side_kind side[AB_SIDES];             /* of the grid, in this stage */
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
    double area;   /* m2, of the body at the start, in the plane */
    double *birth; /* (x, y) by id at the start, from the grid's corner; only when displacements are asked for */
    double *datum; /* the same of where displacements are counted from; NULL: from the start */

    mpm_tile *tiles;
    uint64_t *keys; /* of the tiles, ascending */
    size_t tile_count, tile_capacity;
    double *own;        /* OWN_RECORD * AB_TILE_NODES per tile */
    double *patches;    /* mpm_patch_doubles per tile with points */
    double *filter;     /* FILTER_RECORD * AB_TILE_NODES per tile; NULL but for xpic and fmpm of order 2 and more */
    double *damped;     /* m/s, a pair per node: its change by damping in this step; NULL: not kept */
    double *volumetric; /* VOLUMETRIC_RECORD * AB_TILE_NODES per tile; NULL without f_bar */
    uint64_t *slivers;  /* per tile, a bit a cell: mpm/volumetric.c */
    size_t own_capacity, filter_capacity, damped_capacity, volumetric_capacity, sliver_capacity, patch_capacity, patch_count;
    mpm_sums *sums; /* per tile */
    size_t sums_capacity;
    double last_limit;  /* s, of the step */
    double light_limit; /* kg: nodes with less are looked at in every step; 0: none */
    mpm_light_tile *light; /* per tile */
    mpm_tie *ties;      /* of this step, by dof */
    uint32_t *lines;    /* nodes that others go by, each once */
    double *work;       /* affine transfers: of light_mass.c, five numbers for each of the lines */
    double *back;       /* xpic, fmpm: a pair per node, what comes back */
    size_t work_capacity, back_capacity, light_capacity, tie_count, tie_capacity, line_count, line_capacity;
    uint64_t version; /* of the tile list */
    bool scattered;   /* the patches hold this step's points already */
    bool sort_due;

    const ab_material_spec *material;
    void *self; /* the plugin's instance */
    ab_service service;
    double wave_speed;    /* largest, m/s */
    bool ask_wave_speed;  /* in this step's stress pass */
    double modulus;       /* P-wave modulus, Pa */
    double shear_modulus; /* Pa; only with boundary plugins, else 0 */
    double largest_speed; /* m/s */
    double point_mass;    /* kg, largest */
    char limit[192];

    mpm_load *loads;
    size_t load_count;
    struct mpm_edges *edges; /* one per boundary plugin on the body; NULL: none */
    size_t edges_count;
    double *body_force; /* N: 16 a block, along x, along y; NULL without one */
    size_t body_force_capacity;
    uint32_t *slot; /* by id, block*8 + lane, UINT32_MAX: has left; only with loads or an outline */

    ab_energy energy;           /* totals so far */
    double last_strain;         /* J: what the last step added to energy.strain */
    double external_before;     /* J: energy.external at the start of the step */
    double unbalanced, applied; /* N: of the last step that measured them */
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
/* The same for a body whose shape is a mesh; borrowed, only until this returns. NULL: as its shape says. */
ab_status mpm_create_in(const ab_scene *, size_t body, const ab_mesh *, int threads, ab_domain **, ab_report *);

/* too_far.c: after the points' new places are known; far: one of them is not in reach of its tile any more. AB_FAILED names the point */
ab_status mpm_too_far(const mpm_body *, const ab_step *, bool far, ab_report *);

/* plan.c */
void mpm_plan(const ab_domain *, ab_plan_body *);

/* points.c */
void mpm_rows_plan(mpm_body *); /* which rows this scene needs */
ab_status mpm_points_insert(mpm_body *, const ab_fill *, ab_report *);
ab_status mpm_points_sort(mpm_body *, ab_report *); /* after begin's bounds were broken, or the first time */
bool mpm_points_index(mpm_body *);                  /* from now on body->slot says where a point is; false: no memory */
static inline size_t mpm_patch_doubles(const mpm_body *body) { return 8 * (size_t)(body->kernel->patch * body->kernel->patch); }
static inline double *mpm_block(const mpm_body *body, size_t block) { return body->blocks + block * 8 * (size_t)body->rows.count; }

/* material.c */
ab_status mpm_material_start(mpm_body *, const ab_fill *,
                             ab_report *); /* the material's instance; stress and states of the points at the start */

/* transfer.c */
void mpm_transfer_choose(mpm_body *);               /* from the scene: before the rows are planned */
void mpm_filter(mpm_body *);                        /* xpic, fmpm: after contact and damping, before finish */
void mpm_affine_start(mpm_body *, const ab_fill *); /* the slope of the velocity drawn */
/* Of the point in a slot, at rows.x: twice the kinetic energy of its affine part, tr(C D C^T) (0 without one), and its angular momentum, per kg. */
double mpm_affine_inner(const mpm_body *, size_t slot, double *spin, double *inertia);

/* volumetric.c: f_bar only */
void mpm_volumetric_strain(mpm_body *, const ab_step *);                 /* averages of the change of volume, before the stress pass */
void mpm_volumetric_fetch(const mpm_body *, size_t tile, double *means); /* into a patch of pairs, their first: the average by cells */
void mpm_volumetric_stress(
    mpm_body *); /* after it: the stress of the points gets the average of the mean stress, theirs is kept in its row */

/* tiles.c */
void mpm_tiles_hold(mpm_body *); /* sides have changed */
ab_status mpm_tiles_build(mpm_body *, const uint64_t *filled, size_t count,
                          ab_report *);                                  /* the tiles of `filled` (ascending) and their neighbours */
long mpm_tile_find(const uint64_t *keys, size_t count, uint64_t key);    /* place, or -1 */
size_t mpm_tile_of_block(const mpm_body *, uint32_t block);              /* that owns it: tiles with points hold ascending runs */
uint32_t mpm_dof_of(const mpm_body *, const mpm_tile *, int patch_node); /* the node's number among the body's dofs */
/* The node that is (dx, dy) from node n of a tile, at most a tile away; UINT32_MAX where the body has none. */
static inline uint32_t mpm_dof_beside(const mpm_body *body, size_t tile, int n, int dx, int dy) {
    const int i = n % AB_TILE + dx, j = n / AB_TILE + dy, tx = i < 0 ? -1 : i >= AB_TILE, ty = j < 0 ? -1 : j >= AB_TILE;
    const int32_t other = body->tiles[tile].around[(ty + 1) * 3 + tx + 1];
    if (other < 0) return UINT32_MAX;
    return (uint32_t)other * AB_TILE_NODES + (uint32_t)((j - ty * AB_TILE) * AB_TILE + i - tx * AB_TILE);
}

/* grid.c */
void mpm_grid_assemble(mpm_body *, const ab_step *, bool forces);              /* old velocity, trial velocity */
void mpm_grid_assemble_remap(mpm_body *);                                      /* velocity of the points mapped back */
void mpm_grid_fetch_velocity(const mpm_body *, size_t tile, double *pairs);    /* a patch of velocities */
void mpm_grid_fetch_motion(const mpm_body *, size_t tile, double *quadruples); /* a patch of velocities and their changes in this step */
void mpm_grid_fetch_filter(const mpm_body *, size_t tile, int from, double *pairs); /* a patch of FILTER_REST or FILTER_SUM */
void mpm_grid_filter_start(mpm_body *);                                             /* the rest is the whole velocity to be corrected */
void mpm_grid_filter_assemble(mpm_body *); /* the rest loses what came back, the sum gains the rest */
void mpm_grid_fetch_volumetric(const mpm_body *, size_t tile, int from, double *pairs); /* a patch of two numbers of the records of f_bar */
void mpm_grid_add_pairs(const mpm_body *, size_t tile, double *sum);                    /* what patches of pairs hold of its own nodes */
void mpm_grid_limit_light(mpm_body *); /* USL: light nodes take their old velocity for the strain */

/* light_nodes.c: where kernel->light is 0, nothing is done and no tie is there */
bool mpm_light_reserve(mpm_body *, size_t tiles); /* false: no memory */
ab_status mpm_light_tie(mpm_body *, ab_report *); /* after mpm_grid_assemble: which nodes are light; their masses and momenta to others */
void mpm_light_follow(mpm_body *);                /* after others have changed the velocities of nodes */
void mpm_light_settle(mpm_body *);                /* affine transfers, before points take up the step: all impulses of the step, given by lumped masses, by the consistent one */
void mpm_light_quiet(mpm_body *);                 /* before mpm_damp: they are not damped on their own */
void mpm_light_remap(mpm_body *);                 /* after mpm_grid_assemble_remap */
void mpm_light_filter(mpm_body *, double *back);  /* what came back to the nodes (pairs), each by its own mass */
const mpm_tie *mpm_light_tie_of(const mpm_body *, uint32_t dof); /* NULL: the node is a degree of freedom */
/* Nodes that a light one goes by in its place, with their weights; the new count. Room for MPM_LIGHT_MORE more. */
size_t mpm_light_expand(const mpm_body *, uint32_t *dof, double *weight, size_t count);
void mpm_light_destroy(mpm_body *);
/* Place of a node that others go by in the list of these. */
static inline size_t mpm_light_line(const mpm_body *body, uint32_t dof) { return (size_t)body->own[(size_t)dof * OWN_RECORD + OWN_RECORD - 1] - 1; }

/* light_mass.c: velocities of the nodes that others go by, from momenta, by the mass matrix that keeps the moment of momentum. */
bool mpm_light_mass_consistent(const mpm_body *);       /* whether the body does so: an affine transfer on a smooth basis */
bool mpm_light_mass_reserve(mpm_body *);                /* false: no memory */
void mpm_light_mass_solve(mpm_body *, size_t direction); /* work: the lines' momenta, kg m/s, on entry; their velocities behind them (at line_count) on return */

/* damping.c */
bool mpm_damp_reserve(mpm_body *, size_t tiles); /* nothing where the scene has no local damping; false: no memory */
void mpm_damp(mpm_body *, const ab_step *);      /* after contact, before finish */
void mpm_damp_book(mpm_body *);                  /* once velocities are mapped back: what it has taken from the points */
size_t mpm_damp_bytes(const mpm_body *);
void mpm_damp_destroy(mpm_body *);

/* loads.c */
ab_status mpm_loads_create(mpm_body *, const ab_fill *, ab_report *);
void mpm_loads_scatter(mpm_body *, const ab_step *);
void mpm_loads_work(mpm_body *, const ab_step *);
void mpm_loads_follow(mpm_body *, const ab_step *); /* with the velocities that strain the points, before they are strained */
/* Of one piece, of loads and of edges. Pieces in a set, to the end of a list (room for them is there), joined with their neighbours where wanted; false: no memory. */
bool mpm_load_pieces(const ab_fill *, const ab_where *, bool join, uint32_t spec, mpm_load *list, size_t *count);
void mpm_load_place(const mpm_body *, const mpm_load *list, mpm_load *); /* now, stretch: with neighbours half-way */
mpm_reach mpm_load_reach(const mpm_body *, const mpm_load *);            /* with now and stretch as they are */
void mpm_load_follow(const mpm_body *, const ab_step *, mpm_load *);

/* edges.c: pieces of outline that boundary plugins act on. None: nothing is done */
ab_status mpm_edges_create(mpm_body *, const ab_fill *, ab_report *);
ab_status mpm_edges(ab_domain *, size_t boundary, const ab_step *, ab_edge_list *, ab_report *);
void mpm_edges_follow(mpm_body *, const ab_step *); /* as mpm_loads_follow */
size_t mpm_edges_bytes(const mpm_body *);
bool mpm_edges_keep(mpm_body *, struct ab_checkpoint *);
void mpm_edges_destroy(mpm_body *);

double mpm_loads_size(const mpm_body *); /* N: sizes of the forces of this step, added up */

/* stages.c */
ab_status mpm_enter(ab_domain *, const ab_stage_spec *, size_t stage, ab_report *);
void mpm_rest(ab_domain *, const ab_step *);
ab_status mpm_datum(ab_domain *, ab_report *);
void mpm_measure(mpm_body *, const ab_step *); /* after contact, before damping */
void mpm_balance(const ab_domain *, double *unbalanced, double *applied);

/* body_force.c: all of it nothing where the body has none */
ab_status mpm_body_force_find(mpm_body *, const ab_step *,
                              ab_report *); /* where the points are; AB_FAILED: a formula has no finite value */
void mpm_body_force_scatter(mpm_body *);
void mpm_body_force_work(mpm_body *, const ab_step *);
double mpm_body_force_size(const mpm_body *); /* N: sizes of the forces of this step, added up */
size_t mpm_body_force_bytes(const mpm_body *);
void mpm_body_force_destroy(mpm_body *);

/* trace.c */
ab_status mpm_trace(ab_domain *, const uint32_t *nodes, size_t count, uint32_t needs, ab_trace *, ab_report *);
void mpm_trace_destroy(struct mpm_trace *);
/* Number of the wanted node + 1 at each place of a square of `width` nodes that begins `before` nodes left of a tile and below it, 0 elsewhere. Nodes ascend, so those
 * of a tile are a run. False: there is none. */
bool mpm_trace_wanted(const mpm_tile *, int before, int width, const uint32_t *nodes, size_t count, uint32_t *wanted);
/* trace_density.c: what one tile's points add to the slopes of the density (2 rows of ld) at the nodes, ascending */
void mpm_trace_density(const mpm_body *, const mpm_tile *, const uint32_t *nodes, size_t count, double *gradient, size_t ld);

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

/* keep.c: checkpoints */
void mpm_keep(ab_domain *, struct ab_checkpoint *);

/* fields.c */
ab_status mpm_fields_create(mpm_body *, ab_report *);
const ab_field *mpm_fields(const ab_domain *, size_t *count);
ab_status mpm_read(const ab_domain *, const char *field, double *values, ab_report *);
size_t mpm_count(const ab_domain *);

#endif
