/* fill_parts.h: what the files of the fill share: the growing list of points and pieces of outline, and one filler per kind of shape. */
#ifndef AB_FILL_PARTS_H
#define AB_FILL_PARTS_H

#include "mpm/fill.h"

#define AB_PI 3.14159265358979323846

typedef struct ab_filler { /* one fill under way */
    ab_fill *fill;
    size_t capacity, surface_capacity;
    ab_fill_rule rule;
    int per_cell;
    double cell;             /* m */
    double spacing;          /* m, cell / sqrt(per_cell): side of the square that one point stands for */
    size_t points;           /* cvt: how many; 0: as many as per_cell asks for */
    uint64_t seed;           /* cvt */
    double tolerance;        /* cvt: largest move in the last round, in distances between points */
    int iterations, threads; /* cvt */
    const char *body;        /* name, for messages */
    ab_report *report;
} ab_filler;

/* Room for so many more points and pieces. wanted is a double so that a hopeless number arrives here unclipped. */
ab_status ab_filler_reserve(ab_filler *filler, ab_mark mark, double points, double pieces);

/* Adds a point (volume m2, extent (xx, yy, xy) m2), or a piece of outline of the point; the caller has reserved the room. */
uint32_t ab_filler_point(ab_filler *filler, double x, double y, double volume, double xx, double yy, double xy);
void ab_filler_piece(ab_filler *filler, uint32_t point, double x, double y, double normal_x, double normal_y, double length);

/* Widens the bounding box. */
void ab_filler_bound(ab_filler *filler, double x, double y);

/* n >= 1 parts of about `size` in `length`. A tie goes up, whichever way rounding leans, so that mirrored and turned shapes agree. */
double ab_fill_parts(double length, double size);

/* Gauss-Legendre on [0, 1]: places and weights (sum 1), symmetric to the last bit; and where each point's share begins and how
 * far it reaches: from the sum of weights before it, half its weight, or for the outermost points the distance to the edge. */
enum { AB_GAUSS_MOST = 64 };
typedef struct ab_gauss {
    int count;
    double place[AB_GAUSS_MOST], weight[AB_GAUSS_MOST], share[AB_GAUSS_MOST + 1], half[AB_GAUSS_MOST];
} ab_gauss;
void ab_gauss_rule(int count, ab_gauss *rule);

/* The two factors of per_cell closest to each other, *more >= *fewer. An error where a direction would need more than AB_GAUSS_MOST
 * points, a warning where one would have more than twice as many as the other. */
ab_status ab_gauss_factors(const ab_filler *filler, ab_mark mark, int *more, int *fewer);

/* Refuses a box, disc or ring of no size, and a kind that is unknown. */
ab_status ab_fill_check(const ab_filler *filler, const ab_shape_spec *shape);

ab_status ab_fill_shape(ab_filler *filler, const ab_shape_spec *shape); /* any kind */
ab_status ab_fill_box(ab_filler *filler, const ab_shape_spec *shape);
ab_status ab_fill_mesh(ab_filler *filler, ab_mark mark, const ab_mesh *mesh); /* Gauss points */
ab_status ab_fill_round(ab_filler *filler, const ab_shape_spec *shape); /* disc, ring */

#endif
