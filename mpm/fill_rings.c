/* fill_rings.c: points in a disc or a ring, in circles around its centre, so that the round outline stands exactly where it was drawn.
 *
 * regular: circles of equal width, each divided evenly. gauss: circles of about a cell's width with Gauss points along the radius; around
 * the centre the points stay evenly spaced, since on a closed circle no rule is better than the even one. Every circle has a multiple of four
 * points, none on an axis, so that the points are mirrored in both axes and turned into themselves by a quarter turn. Volumes are exact. */
#include <math.h>

#include "mpm/fill_parts.h"

/* One circle of points at radius r, reaching half a width in and out of it, that share an area. Outline pieces at outer, inner where >= 0. */
typedef struct circle {
    double r, half, area, around;
    double outer, inner;
} circle;

static void add_circle(ab_filler *filler, const double center[2], const circle *c) {
    const size_t quarter = (size_t)(c->around / 4), count = 4 * quarter;
    const double tangential = AB_PI * c->r / c->around; /* half the arc */
    const double rr = c->half * c->half, tt = tangential * tangential;
    for (size_t i = 0; i < count; i++) {
        const double angle = 2 * AB_PI * ((double)(i % quarter) + 0.5) / c->around;
        double nx = cos(angle), ny = sin(angle);
        for (size_t turn = i / quarter; turn > 0; turn--) { /* a quarter turn, exact */
            const double old = nx;
            nx = -ny;
            ny = old;
        }
        const uint32_t p = ab_filler_point(filler, center[0] + c->r * nx, center[1] + c->r * ny, c->area / c->around,
                                           rr * nx * nx + tt * ny * ny, rr * ny * ny + tt * nx * nx, (rr - tt) * nx * ny);
        if (c->outer >= 0)
            ab_filler_piece(filler, p, center[0] + c->outer * nx, center[1] + c->outer * ny, nx, ny, 2 * AB_PI * c->outer / c->around);
        if (c->inner >= 0)
            ab_filler_piece(filler, p, center[0] + c->inner * nx, center[1] + c->inner * ny, -nx, -ny, 2 * AB_PI * c->inner / c->around);
    }
}

/* A disc too small for four points: one, with four pieces of outline. */
static ab_status add_single(ab_filler *filler, const ab_shape_spec *shape) {
    const double radius = shape->radius, *center = shape->center;
    if (AB_PI * radius * radius < 0.5 * filler->spacing * filler->spacing)
        ab_report_warning(filler->report, shape->mark,
                          "body '%s': its disc of radius %g m is small against the %g m between points and has a single one; use a smaller "
                          "cell or more per_cell",
                          filler->body, radius, filler->spacing);
    AB_TRY(ab_filler_reserve(filler, shape->mark, 1, 4));
    const uint32_t p = ab_filler_point(filler, center[0], center[1], AB_PI * radius * radius, radius * radius, radius * radius, 0);
    for (int k = 0; k < 4; k++) {
        const double nx = (k == 0) - (k == 2), ny = (k == 1) - (k == 3);
        ab_filler_piece(filler, p, center[0] + radius * nx, center[1] + radius * ny, nx, ny, 0.5 * AB_PI * radius);
    }
    return AB_OK;
}

ab_status ab_fill_round(ab_filler *filler, const ab_shape_spec *shape) {
    const double radius = shape->radius, inner = shape->kind == AB_SHAPE_RING ? shape->inner : 0;
    ab_filler_bound(filler, shape->center[0] - radius, shape->center[1] - radius);
    ab_filler_bound(filler, shape->center[0] + radius, shape->center[1] + radius);
    const bool gauss = filler->rule == AB_FILL_GAUSS;
    const double total = AB_PI * (radius - inner) * (radius + inner), share = filler->spacing * filler->spacing;
    if (inner == 0 && total < 2.5 * share) return add_single(filler, shape);
    if (radius - inner < 0.5 * filler->spacing)
        ab_report_warning(filler->report, shape->mark,
                          "body '%s': its ring is %g m thick, less than half of the %g m between points, and has a single row of them; use "
                          "a smaller cell or more per_cell",
                          filler->body, radius - inner, filler->spacing);

    ab_gauss rule;
    ab_gauss_rule(gauss ? (int)fmin(AB_GAUSS_MOST, floor(sqrt(filler->per_cell) + 0.5)) : 1, &rule);
    const double bands = ab_fill_parts(radius - inner, gauss ? filler->cell : filler->spacing), width = (radius - inner) / bands;
    AB_TRY(ab_filler_reserve(filler, shape->mark, total / share + 4 * bands * rule.count + 4, 0)); /* each circle rounds by 2 at most */
    for (double k = 0; k < bands; k++) {
        const double low = inner + k * width, high = k + 1 < bands ? inner + (k + 1) * width : radius;
        const double area = AB_PI * (high - low) * (high + low);
        const double around = 4 * ab_fill_parts(area / share / rule.count, 4); /* so that a point stands for about spacing^2 */
        AB_TRY(ab_filler_reserve(filler, shape->mark, around * rule.count, 2 * around));
        for (int q = 0; q < rule.count; q++) {
            /* the weights integrate r dr exactly: the areas of the circles add up to that of the band */
            const double r = q + 1 == rule.count ? high - rule.half[q] * (high - low) : low + rule.place[q] * (high - low);
            const circle c = {.r = r,
                              .half = rule.half[q] * (high - low),
                              .area = area * rule.weight[q] * 2 * (low + rule.place[q] * (high - low)) / (low + high),
                              .around = around,
                              .outer = k + 1 == bands && q + 1 == rule.count ? radius : -1,
                              .inner = k == 0 && q == 0 && inner > 0 ? inner : -1};
            add_circle(filler, shape->center, &c);
        }
    }
    return AB_OK;
}
