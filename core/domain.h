/* domain.h: a body as the scheduler sees it. A method (material points; finite elements, rigid bodies later) fills in one ab_domain_ops
 * and never learns of the others. Arrays in plane strain have two components, velocities per second, SI throughout. */
#ifndef AB_DOMAIN_H
#define AB_DOMAIN_H

#include <math.h>
#include <stdint.h>

#include "core/scene.h"

struct ab_checkpoint;

typedef struct ab_domain ab_domain;

typedef struct ab_step { /* one time step, the same for every domain */
    double time;         /* at the beginning, s */
    double dt;
    long number;       /* from 0 */
    double gravity[3]; /* m/s2, at time + dt/2 */
    double damping;    /* local non-viscous factor in this step */
    size_t stage;      /* of the scene; 0 where it has none */
    bool settling;     /* what is driven stands still: velocities that are given are 0 */
    bool measure;      /* balance() will be asked for */
    bool early; /* some body in contact strains first: until trial() dofs have old velocities, and contact's work on those is forgotten */
    bool from_rest; /* bodies were at rest at its start, not half a step before: forces act for half of dt on velocities */
} ab_step;

/* What a body did in one step or since the start; J (per m of thickness in plane strain): the ledger. */
typedef struct ab_energy {
    double kinetic;   /* state */
    double strain;    /* accumulated work of stress less plastic work */
    double potential; /* minus the accumulated work of gravity */
    double plastic;   /* dissipated by the material */
    double friction;  /* dissipated by slip; booked by the contact loop, half to each body */
    double contact;   /* lost (or, negative, given back) by normal impulses; half to each body */
    double boundary;  /* taken away by sides of the grid and boundary plugins */
    double damping;   /* taken away by local damping */
    double external;  /* work done on the body by loads, and by the forces that move what is prescribed */
    double outflow;   /* carried out by points that left through an outflow side */
} ab_energy;

typedef struct ab_motion {
    double mass, momentum[3], angular_momentum[3], centre[3];
    double own_inertia; /* kg m2: what points with a spin of their own (affine transfers) have by it, beside their places */
} ab_motion;

/* A field a domain can write or monitor. Values come in order of id. */
typedef struct ab_field {
    const char *name, *unit;
    int components;
    const char *component_names; /* "x y", "xx yy zz xy"; NULL or "": ab_component_names */
} ab_field;

/* The velocities of a body on dofs, as the contact loop sees them: dof k has velocity[k*velocity_stride + c] and
 * inverse_mass[k*mass_stride + c] (1/kg; 0 where a side or the user holds the direction). */
typedef struct ab_dofs {
    double *velocity;           /* current; the loop changes it */
    const double *velocity_old; /* at the start of the step: work = impulse . (old + new)/2 */
    const double *inverse_mass;
    size_t velocity_stride, old_stride, mass_stride;
    /* A body that turns as a whole (rigid) has one dof, 0; its place x moves with velocity + spin x (x - centre). spin NULL: all others. */
    double *spin;           /* 1/s, changed by the loop as velocities are */
    const double *spin_old; /* at the start of the step */
    double inverse_inertia; /* 1/(kg m2); 0 where the spin is held */
    double centre[2];       /* m from the grid's corner */
    /* N s: NULL, or where the loop adds up what it gives each dof in this solve, held directions included (impulse[k*2 + c]; of a body that turns as a whole
     * impulse[2] is the moment about centre): supports that move do work against it, and reactions hold it. */
    double *impulse;
} ab_dofs;

/* Cells in which the faces of one body may be touched: tiles (as of the background grid, ascending) with a bit per cell, bit (j%AB_TILE)*AB_TILE + i%AB_TILE
 * for the cell whose lower left corner is node (i, j). */
typedef struct ab_region {
    double cell; /* m; the grid's where there is one */
    size_t count;
    const uint64_t *key, *cells;
} ab_region;

/* The edges of a body that one boundary plugin acts on (plugins/abut_plugin.h: ab_edges), as they are in this step. The velocity of an edge is the sum of weight x
 * velocity of dof, and an impulse j on it is weight x j on the dofs: what a traction does at the nodes and what its plugin is told of their motion belong
 * together, so that a dashpot can never make energy. An edge keeps its place in the list for the whole run; one whose material is gone (through an outflow side) has
 * area 0 and no dofs. */
typedef struct ab_edge_list {
    size_t count, ld;
    const double *position;                    /* m from the grid's corner; 2 rows of ld, as normal */
    const double *normal;                      /* unit, out of the body */
    const double *area;                        /* m2 (m in plane strain; of the ring in axisymmetric scenes), now */
    const double *density;                     /* kg/m3, of the body there, now */
    const double *p_wave_speed, *s_wave_speed; /* m/s, of the moduli at the start and the density now */
    const size_t *start;                       /* count + 1: dofs of edge e are dof[start[e]] .. dof[start[e+1]-1] */
    const uint32_t *dof;
    const double *weight; /* sum 1 */
    /* By which changes of the dofs' velocities in this step change the edge's: sum 1; NULL: the weights. Nodes of material points that hardly carry mass are thrown about
     * by stresses that points average over more than reaches them; the mapped velocities that a step begins with know nothing of it. */
    const double *answer;
    const double *own_traction; /* Pa, 2 rows: what the body's stress pulls with there; where the boundary is to hold it, else NULL */
    /* N, pairs by dof: what pulls at the nodes in this step, by stress, loads and weight, boundaries and contact left out. Bodies whose edges hang on one dof each, where the
     * boundary is to hold it; else NULL. */
    const double *own_force;
    size_t group; /* so many edges on end are shares of one piece of outline and have its displacement; 0: each is one */
} ab_edge_list;

/* Rows of ld edges: place (2), normal (2), area, density, speeds of P and S waves. */
enum { AB_EDGE_ROWS = 8 };
static inline ab_edge_list ab_edge_list_of(const double *rows, size_t count, size_t ld) {
    return (ab_edge_list){.count = count,
                          .ld = ld,
                          .position = rows,
                          .normal = rows + 2 * ld,
                          .area = rows + 4 * ld,
                          .density = rows + 5 * ld,
                          .p_wave_speed = rows + 6 * ld,
                          .s_wave_speed = rows + 7 * ld};
}

/* Elements for results: how a body's points (nodes) hang together. */
typedef struct ab_cells {
    size_t count;
    int nodes;                    /* per cell: 4 or 8, corners counter-clockwise, then the middles of the sides 0-1, 1-2, 2-3, 3-0 */
    const uint32_t *connectivity; /* count x nodes, places in the order of ids */
} ab_cells;

/* The background grid is one for all bodies, cut into tiles of AB_TILE x AB_TILE nodes. Node (i, j) stands at from + cell*(i, j); tile
 * (I, J) holds nodes i = AB_TILE*I .. AB_TILE*I + AB_TILE-1. A body lists only the tiles where it has mass. */
enum { AB_TILE = 8, AB_TILE_NODES = AB_TILE * AB_TILE };
static inline uint64_t ab_tile_key(int32_t tx, int32_t ty) {
    return ((uint64_t)(uint32_t)(ty + 0x40000000) << 32) | (uint32_t)(tx + 0x40000000);
}
static inline int32_t ab_tile_x(uint64_t key) { return (int32_t)((uint32_t)key - 0x40000000u); }
static inline int32_t ab_tile_y(uint64_t key) { return (int32_t)((uint32_t)(key >> 32) - 0x40000000u); }

typedef struct ab_node_tiles { /* borrowed; valid until the next begin */
    size_t count;
    const uint64_t *key; /* ascending */
    const double *mass;  /* of node n of tile k: mass[(k*AB_TILE_NODES + n)*stride], n = (j%AB_TILE)*AB_TILE + i%AB_TILE */
    size_t stride;
    uint64_t version; /* another number when the list is another */
} ab_node_tiles;

typedef struct ab_plan_body {    /* what a body will cost; filled by plan() */
    size_t points, cells, tiles; /* points: nodes where the body has elements; cells, tiles: of the grid, 0 where it is not on it */
    size_t elements;             /* of a mesh */
    size_t bytes, bytes_per_point;
    char fields[512]; /* names of the arrays allocated, separated by ", " */
    char passes[512]; /* passes per step, separated by ", " */
} ab_plan_body;

typedef struct ab_bounds { /* of a body, now: where it is, m from the grid's corner, and least and most of its velocities, m/s */
    double low[2], high[2], least_velocity[2], most_velocity[2];
} ab_bounds;

typedef struct ab_domain_ops {
    const char *method;
    void (*destroy)(ab_domain *);
    /* dt, s, at which the scheme of this body is neutrally stable; *limit names what binds ("wave speed 126 m/s of soil in cells of 0.5 m"). */
    double (*critical_dt)(ab_domain *, const char **limit);
    ab_status (*begin)(ab_domain *, const ab_step *, ab_report *); /* old velocities on the dofs, mass, internal and external force */
    ab_status (*early)(ab_domain *, const ab_step *,
                       ab_report *); /* NULL unless the body strains first (USF, USAVG): strain, stress, then its internal force */
    ab_status (*trial)(ab_domain *, const ab_step *, ab_report *);  /* v* with sides, damping; NULL where begin has done it */
    ab_status (*finish)(ab_domain *, const ab_step *, ab_report *); /* final dof velocities -> the body's own velocities and places */
    ab_status (*remap)(ab_domain *, const ab_step *, ab_report *);  /* NULL unless the body maps velocities back (MUSL, USAVG) */
    ab_status (*stress)(ab_domain *, const ab_step *, ab_report *); /* strain from dof velocities (unless done early), stress, volumes */
    void (*ledger)(const ab_domain *, ab_energy *, ab_motion *);    /* totals so far; friction and contact left at 0 */
    /* contact */
    void (*node_tiles)(const ab_domain *, ab_node_tiles *); /* the body's mass on the grid at the start of the step */
    /* What a finder sees of the body at `count` nodes (number = tile*AB_TILE_NODES + n, ascending, from node_tiles); needs: AB_NEED_* bits. Arrays stay the
     * domain's and are valid until the next call. */
    ab_status (*trace)(ab_domain *, const uint32_t *nodes, size_t count, uint32_t needs, ab_trace *, ab_report *);
    void (*dofs)(const ab_domain *, ab_dofs *);
    /* The surface, for finders that need it; arrays stay the domain's and are valid until the next call. Each fills its half of ab_surface: faces() vertices and
     * faces; surface_points() the points in the region, with stencils, without near lists. Either NULL: the body has none. */
    ab_status (*faces)(ab_domain *, ab_surface *, ab_report *);
    ab_status (*surface_points)(ab_domain *, const ab_region *, ab_surface *, ab_report *);
    void (*bounds)(const ab_domain *, ab_bounds *); /* between two steps; NULL: a body whose own limit keeps it from passing a cell in a step */
    double (*modulus)(const ab_domain *); /* Pa, P-wave modulus; INFINITY: rigid */
    /* Force, N, and moment about the origin of the scene, N m in [2], that held and prescribed nodes, or the motion prescribed to a rigid body, put on the
     * body in the last step; 0 before the first. NULL: the body has none. */
    void (*reaction)(const ab_domain *, double force[3]);
    /* The edges that boundary `number` of the scene acts on, which creation has chosen (and reported where there are none). After trial velocities are there; the
     * arrays stay the domain's and are valid until the next call with this number. NULL: no boundary plugin can act on such a body yet. */
    ab_status (*edges)(ab_domain *, size_t number, const ab_step *, ab_edge_list *, ab_report *);
    /* results */
    void (*cells)(const ab_domain *, ab_cells *); /* NULL: a cloud of points */
    size_t (*count)(const ab_domain *);           /* points (or nodes) that can be written now */
    const ab_field *(*fields)(const ab_domain *, size_t *count);
    ab_status (*read)(const ab_domain *, const char *field, double *values,
                      ab_report *); /* values[i*components + c], i in order of id; "id" gives ids */
    void (*plan)(const ab_domain *, ab_plan_body *);
    /* Stages; each may be NULL. enter: sides, supports and loads of a stage, before its first step. rest: all velocities that are not given to zero, after a
     * step; their energy is booked as damping. datum: displacements are counted from here. balance: of the last step, which said `measure`, sums over the
     * degrees of freedom that are free, N: of the sizes of the force out of balance (contact included, damping not), and of the forces applied from outside. */
    ab_status (*enter)(ab_domain *, const ab_stage_spec *, size_t stage, ab_report *);
    void (*rest)(ab_domain *, const ab_step *);
    ab_status (*datum)(ab_domain *, ab_report *);
    void (*balance)(const ab_domain *, double *unbalanced, double *applied);
    /* Between two steps: saves all that the next one needs and creation does not give, or brings it back into a body just created. See core/checkpoint.h. */
    void (*keep)(ab_domain *, struct ab_checkpoint *);
} ab_domain_ops;

struct ab_domain { /* first member of each method's own struct */
    const ab_domain_ops *ops;
    const ab_body_spec *spec;
    int dimension;
    size_t index; /* of the body in the scene */
};

/* True for a body that moves as a whole: no step goes over its points or elements. */
static inline bool ab_domain_is_rigid(const ab_domain *domain) {
    return domain->ops->modulus && !(domain->ops->modulus(domain) < (double)INFINITY);
}

#endif
