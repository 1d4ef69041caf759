/* fill_interior.h: the inside of an outline as trapezoids, and the cells of a Voronoi diagram cut by it. Inside the fill only.
 *
 * Lengths here are in units of the mean distance between points, from the middle of the outline's bounding box: a scene that is moved or scaled has the same
 * numbers up to rounding. */
#ifndef AB_FILL_INTERIOR_H
#define AB_FILL_INTERIOR_H

#include <math.h>

#include "mpm/fill_outline.h"

typedef struct ab_trapezoid { /* between two heights and two edges: left one going down, right one going up */
    double low, high;
    uint32_t left, right;
} ab_trapezoid;

typedef struct ab_buckets { /* square buckets over the bounding box */
    double low[2], size;
    uint32_t count[2];
} ab_buckets;

typedef struct ab_interior {
    const ab_edge *edge; /* borrowed; body on the left */
    size_t edge_count;
    ab_trapezoid *part; /* disjoint; sides that two of them share have one height */
    size_t part_count;
    double *sum; /* part_count + 1: of their areas */
    double low[2], high[2];
    ab_buckets buckets;
    size_t *start;  /* of each bucket, and one more: parts whose bounding box overlaps it are list[start[b]] .. */
    uint32_t *list; /* ascending in a bucket */
    bool *whole;    /* buckets that no edge comes near and that lie inside */
} ab_interior;

/* From closed chains of edges that do not cross. points: about so many will stand in it. */
ab_status ab_interior_create(const ab_edge *edge, size_t count, double points, ab_interior *interior, const char *body, ab_report *report);
void ab_interior_clear(ab_interior *interior);

bool ab_interior_holds(const ab_interior *interior, const double x[2]);
/* A place inside for two numbers in [0, 1): equal areas of their square become equal areas of the body. */
void ab_interior_place(const ab_interior *interior, const double random[2], double x[2]);

static inline uint32_t ab_bucket_of(const ab_buckets *b, int k, double x) {
    const double at = (x - b->low[k]) / b->size;
    return at <= 0 ? 0 : at >= b->count[k] ? b->count[k] - 1 : (uint32_t)at;
}
static inline size_t ab_bucket_at(const ab_buckets *b, uint32_t i, uint32_t j) { return (size_t)j * b->count[0] + i; }

/* Where an edge is at a height; within its own range of x. */
static inline double ab_edge_at(const ab_edge *e, double y) {
    const double share = (y - e->from[1]) / (e->to[1] - e->from[1]);
    const double x = e->from[0] + fmin(fmax(share, 0), 1) * (e->to[0] - e->from[0]);
    return fmin(fmax(x, fmin(e->from[0], e->to[0])), fmax(e->from[0], e->to[0]));
}

/* ---- fill_voronoi.c ------------------------------------------------------------------------------------------------------- */

/* What lies behind a side of a cell: another point (0 ..), or one of these, or edge e of the outline as AB_SIDE_EDGE - e. */
enum { AB_SIDE_BOX = -1, AB_SIDE_LOW = -2, AB_SIDE_HIGH = -3, AB_SIDE_EDGE = -4 };

typedef struct ab_convex { /* counter-clockwise, from the generator; side[k] runs from vertex k to the next */
    size_t count, capacity;
    double (*x)[2];
    int32_t *side;
} ab_convex;

typedef struct ab_voronoi { /* generators sorted into the buckets of the interior */
    const ab_interior *interior;
    size_t count;
    const double (*x)[2];
    size_t *start; /* of each bucket, and one more */
    uint32_t *list;
} ab_voronoi;

ab_status ab_voronoi_create(const ab_interior *interior, size_t count, ab_voronoi *voronoi, const char *body, ab_report *report);
void ab_voronoi_sort(ab_voronoi *voronoi, const double (*x)[2]); /* after the generators have moved */
void ab_voronoi_clear(ab_voronoi *voronoi);

typedef struct ab_cell_piece { /* of a cell within one trapezoid */
    ab_convex shape;
    uint32_t part;
    uint32_t root;      /* first piece that it is connected with */
    ab_moments moments; /* from the generator */
} ab_cell_piece;

typedef struct ab_cell_work { /* one per thread */
    ab_convex cell, spare;
    ab_cell_piece *piece;
    size_t count, capacity; /* pieces; 0: the cell lies inside as a whole, or is empty (cell.count 0) */
    size_t home;            /* root of the pieces around the generator */
    ab_moments moments;     /* of those, from the generator */
    bool no_memory;
} ab_cell_work;

void ab_cell_work_clear(ab_cell_work *work);

/* The cell of a generator: everything inside that is nearer to it than to any other. */
void ab_voronoi_cell(const ab_voronoi *voronoi, size_t i, ab_cell_work *work);
/* The centroid of the part of the cell around the generator; where that is not in the body, the place in the cell nearest to it and a little inside. */
void ab_voronoi_centroid(const ab_voronoi *voronoi, size_t i, const ab_cell_work *work, double x[2]);

#endif
