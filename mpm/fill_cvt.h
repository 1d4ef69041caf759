/* fill_cvt.h: points at the centroids of their own Voronoi cells. Inside the fill only. */
#ifndef AB_FILL_CVT_H
#define AB_FILL_CVT_H

#include "mpm/fill_interior.h"

typedef struct ab_round { /* edges first .. first + count - 1 stand for a circle, walked in their order */
    size_t first, count;
    double center[2], radius; /* m */
    bool hole;
} ab_round;

typedef struct ab_cvt { /* one fill under way */
    ab_filler *filler;
    ab_mark mark;
    ab_outline outline; /* m, as drawn */
    ab_round round[2];
    size_t round_count;
    ab_edge *edge;             /* of the outline in units of `spacing` from `middle` */
    double middle[2], spacing; /* m */
    size_t count;
    double (*x)[2]; /* generators */
    ab_interior interior;
    ab_voronoi voronoi;
    ab_cell_work *work; /* one per thread */
    int threads;
} ab_cvt;

/* Fills any shape by Lloyd's iteration. */
ab_status ab_fill_cvt(ab_filler *filler, const ab_shape_spec *shape);

/* fill_cvt_cells.c: from the generators as they stand to points, volumes, extents and pieces of outline. */
ab_status ab_cvt_finish(ab_cvt *cvt);

#endif
