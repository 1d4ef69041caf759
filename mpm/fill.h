/* fill.h: turns a shape into material points: places, volumes, extents, and which of them lie under which piece of the outline.
 * The volumes add up to the area of the shape to rounding; the outermost points stand so that point + half size = outline. */
#ifndef AB_FILL_H
#define AB_FILL_H

#include <stdint.h>

#include "core/mesh.h"
#include "core/scene.h"

typedef struct ab_outline_piece { /* a piece of the outline and the point under it */
    uint32_t point;
    double position[2]; /* m, middle of the piece, on the outline */
    double normal[2];   /* out of the body */
    double length;      /* m */
} ab_outline_piece;

typedef struct ab_fill {
    size_t count;
    double *x, *y;  /* m */
    double *volume; /* m2 (per m of thickness) */
    double *extent; /* m2: (xx, yy, xy) per point, extent[3*i + c]; half size in direction n is sqrt(n.A.n) */
    ab_outline_piece *surface;
    size_t surface_count;
    double low[2], high[2]; /* bounding box of the outline */
} ab_fill;

typedef struct ab_fill_request { /* how to fill; what is 0 and has a default takes it */
    ab_fill_rule rule;
    int per_cell;        /* points wanted per cell, any number >= 1 */
    double cell;         /* m, of the background grid */
    size_t points;       /* cvt: how many points in all; 0: by per_cell */
    uint64_t seed;       /* cvt: of the random places that it starts from */
    double tolerance;    /* cvt: the last round moved no point by more than this part of the mean distance of points; default 1e-3 */
    int iterations;      /* cvt: rounds at most, a warning where they do not do; default 1000 */
    int threads;         /* cvt: the answer does not depend on it; default 1 */
    const ab_mesh *mesh; /* of a shape that is one: gauss, per_cell points (a square) in each element */
} ab_fill_request;

/* Fills a shape by any rule; ab_fill_create says what regular and gauss do.
 *   cvt  the points are the centroids of their own Voronoi cells (cut by the outline), to the tolerance, from random places (mpm/fill_cvt.c). Volumes are those of the cells,
 *        extents three times their second moments, so that a square cell has its half side, and stretched where the outline is so that point + half
 *        size reaches it. Members of a union are one body. Up to 1e6 points. */
ab_status ab_fill_make(const ab_shape_spec *shape, const ab_fill_request *request, const char *body, ab_fill **fill, ab_report *report);

/* Fills a shape. cell: m, of the background grid; per_cell: points wanted per cell of that size, any number >= 1. The lattice follows the
 * outline, not the grid, so that origin (the grid's corner) does not matter to any rule there is.
 *   regular  box: a lattice whose spacings divide the sides. disc, ring: circles of equal width. polygon: a lattice along its longest edge that stands
 *            on every straight side along it; cells that the outline cuts have their exact volume and centroid, and one filled less than 0.3 goes
 *            with its neighbour.
 *   gauss    Gauss points in lattice cells of about the grid's size (along the radius of a disc or ring); cells that the outline cuts are regular.
 *   union    members that touch are filled each on its own, and where they touch there is no outline; members that overlap are joined first, where
 *            a disc becomes a polygon of the same area.
 * A regular point of volume V in an uncut cell has V = 4 sqrt(det A). Sums: volumes and lengths to 1e-12. Wrong shapes and too many
 * points are errors (AB_BAD_INPUT) before anything is allocated, a shape thinner than half the distance between points a warning. */
ab_status ab_fill_create(const ab_shape_spec *shape, ab_fill_rule rule, int per_cell, double cell, const double origin[2], const char *body,
                         ab_fill **fill, ab_report *report);
void ab_fill_destroy(ab_fill *fill);

/* True where the piece of outline is in the set. Sides: pieces whose normal is within 45 degrees of the side's (closed at one end, so that a
 * corner piece belongs to one side). */
bool ab_where_holds(const ab_where *where, const ab_fill *fill, const ab_outline_piece *surface);

#endif
