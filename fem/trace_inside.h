/* trace_inside.h: the insides of a trace, for trace.c and trace_nodes.c only. */
#ifndef FEM_TRACE_INSIDE_H
#define FEM_TRACE_INSIDE_H

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/node_list.h"
#include "core/vector.h"
#include "fem/trace.h"

typedef struct fem_trace_tile {
    int32_t around[9]; /* tiles around it by (dy+1)*3 + dx+1; -1: none */
} fem_trace_tile;

struct fem_trace {
    bool axisymmetric; /* masses are those of rings; the grid begins at the axis */
    const char *body;
    double h, inverse_h, modulus;
    int width; /* nodes of a point per direction: 2 hats; 3, 4 quadratic and cubic splines */
    bool saw_inmost;
    /* tiles, ascending */
    size_t tile_count, tile_capacity, key_capacity;
    uint64_t *key, *wanted; /* wanted: for a new list */
    size_t wanted_count;
    fem_trace_tile *tiles;
    double *mass;         /* AB_TILE_NODES per tile */
    double *patch;        /* PATCH_NODES per tile */
    uint32_t *cell_start; /* AB_TILE_NODES*tile_count + 1: places in `order` of the points of each cell */
    uint64_t version;
    /* points */
    size_t point_count, point_capacity;
    uint64_t *cell; /* ab_tile_key of the cell's lower left node */
    uint32_t *slot; /* tile*AB_TILE_NODES + cell in it */
    uint32_t *order;
    /* what a finder was last shown */
    ab_node_list list;
    size_t place_capacity, *place; /* place: by dof, where it stands in the stencil of the node at hand */
};

/* Value and slope at u cells from a node of the function of this width. */
static inline void fem_trace_weigh(const fem_trace *t, double u, double *n, double *slope) {
    const double a = fabs(u), sign = u < 0.0 ? -1.0 : 1.0;
    if (t->width == 3) {
        const double rest = ab_larger(1.5 - a, 0.0);
        *n = a < 0.5 ? 0.75 - a * a : 0.5 * rest * rest;
        *slope = a < 0.5 ? -2.0 * u : -sign * rest;
    } else {
        const double rest = ab_larger(2.0 - a, 0.0);
        *n = a < 1.0 ? 2.0 / 3.0 - a * a * (1.0 - 0.5 * a) : rest * rest * rest / 6.0;
        *slope = sign * (a < 1.0 ? a * (1.5 * a - 2.0) : -0.5 * rest * rest);
    }
}

/* The points that can reach a node stand in the four cells around it (sixteen, where the functions are wider): places in `order`; cells from left to right, then
 * upwards. Their number. */
int fem_trace_cells_around(const fem_trace *t, uint32_t node, uint32_t first[16], uint32_t last[16]);

#endif
