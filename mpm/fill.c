/* fill.c: the door of the fill: checks the request, hands each shape to its filler, keeps the growing lists; and answers `where`. */
#define _POSIX_C_SOURCE 200809L
#include "mpm/fill_cvt.h"
#include "mpm/fill_union.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

ab_status ab_fill_check(const ab_filler *filler, const ab_shape_spec *shape) {
    const double radius = shape->radius, inner = shape->kind == AB_SHAPE_RING ? shape->inner : 0;
    switch (shape->kind) {
    case AB_SHAPE_BOX:
        for (int k = 0; k < 2; k++)
            if (!(shape->high[k] > shape->low[k]) || !isfinite(shape->high[k] - shape->low[k]))
                return ab_report_error(
                    filler->report, shape->mark,
                    "body '%s': its box goes from %g to %g in %c; its first corner must be below its second in both directions",
                    filler->body, shape->low[k], shape->high[k], "xy"[k]);
        return AB_OK;
    case AB_SHAPE_DISC:
    case AB_SHAPE_RING:
        if (!(radius > 0) || !isfinite(radius) || !isfinite(shape->center[0]) || !isfinite(shape->center[1]))
            return ab_report_error(filler->report, shape->mark, "body '%s': radius %g about (%g, %g); the radius must be positive",
                                   filler->body, radius, shape->center[0], shape->center[1]);
        if (!(inner >= 0) || !(inner < radius))
            return ab_report_error(filler->report, shape->mark,
                                   "body '%s': inner radius %g of a ring of radius %g; it must be less than the radius and not negative",
                                   filler->body, inner, radius);
        return AB_OK;
    case AB_SHAPE_POLYGON:
    case AB_SHAPE_UNION: return AB_OK;
    case AB_SHAPE_MESH: break;
    }
    return ab_report_error(filler->report, shape->mark,
                           "body '%s': a shape of this kind cannot be filled; use box, disc, ring, polygon or union", filler->body);
}

static ab_status fill_polygon(ab_filler *filler, const ab_shape_spec *shape) {
    ab_outline outline;
    AB_TRY(ab_outline_create(shape, &outline, filler->body, filler->report));
    const ab_status status = ab_fill_outline(filler, shape->mark, &outline);
    ab_outline_clear(&outline);
    return status;
}

ab_status ab_fill_shape(ab_filler *filler, const ab_shape_spec *shape) {
    AB_TRY(ab_fill_check(filler, shape));
    switch (shape->kind) {
    case AB_SHAPE_BOX: return ab_fill_box(filler, shape);
    case AB_SHAPE_DISC:
    case AB_SHAPE_RING: return ab_fill_round(filler, shape);
    case AB_SHAPE_POLYGON: return fill_polygon(filler, shape);
    case AB_SHAPE_UNION: return ab_fill_union(filler, shape);
    case AB_SHAPE_MESH: break;
    }
    return AB_BAD_INPUT;
}

ab_status ab_fill_make(const ab_shape_spec *shape, const ab_fill_request *request, const char *body, ab_fill **fill, ab_report *report) {
    const int per_cell = request->per_cell;
    const double cell = request->cell;
    *fill = NULL;
    if (per_cell < 1)
        return ab_report_error(report, shape->mark, "body '%s': %d points per cell; there must be at least 1", body, per_cell);
    if (!(cell > 0) || !isfinite(cell))
        return ab_report_error(report, shape->mark, "body '%s': cells of %g m; the size must be positive", body, cell);
    ab_filler filler = {.rule = request->rule,
                        .per_cell = per_cell,
                        .cell = cell,
                        .spacing = cell / sqrt(per_cell),
                        .points = request->points,
                        .seed = request->seed,
                        .tolerance = request->tolerance > 0 ? request->tolerance : 1e-3,
                        .iterations = request->iterations > 0 ? request->iterations : 1000,
                        .threads = request->threads,
                        .body = body,
                        .report = report};
    filler.fill = calloc(1, sizeof *filler.fill);
    if (!filler.fill) return ab_report_failure(report, "body '%s': no memory to fill it", body);
    for (int k = 0; k < 2; k++) {
        filler.fill->low[k] = INFINITY;
        filler.fill->high[k] = -INFINITY;
    }
    ab_status status = shape->kind == AB_SHAPE_MESH && request->mesh ? AB_OK : ab_fill_check(&filler, shape);
    if (status == AB_OK)
        status = shape->kind == AB_SHAPE_MESH   ? ab_fill_mesh(&filler, shape->mark, request->mesh)
                 : request->rule == AB_FILL_CVT ? ab_fill_cvt(&filler, shape)
                                                : ab_fill_shape(&filler, shape);
    if (status != AB_OK) {
        ab_fill_destroy(filler.fill);
        return status;
    }
    *fill = filler.fill;
    return AB_OK;
}

ab_status ab_fill_create(const ab_shape_spec *shape, ab_fill_rule rule, int per_cell, double cell, const double origin[2], const char *body,
                         ab_fill **fill, ab_report *report) {
    (void)origin; /* the points follow the outline, wherever the grid stands */
    const ab_fill_request request = {.rule = rule, .per_cell = per_cell, .cell = cell};
    return ab_fill_make(shape, &request, body, fill, report);
}

void ab_fill_destroy(ab_fill *fill) {
    if (!fill) return;
    free(fill->x);
    free(fill->y);
    free(fill->volume);
    free(fill->extent);
    free(fill->surface);
    free(fill);
}

/* Which of left, right, bottom, top a normal belongs to: quarters of the circle, each closed at its clockwise end. */
static int side_of(const double normal[2]) {
    const double x = normal[0], y = normal[1];
    if (x > 0 && y >= -x && y < x) return AB_RIGHT;
    if (y > 0 && x <= y && x > -y) return AB_TOP;
    if (x < 0 && y <= -x && y > x) return AB_LEFT;
    return AB_BOTTOM;
}

bool ab_where_holds(const ab_where *where, const ab_fill *fill, const ab_outline_piece *surface) {
    if (where->all) return true;
    if (where->side < 0 && !where->has[0] && !where->has[1]) return false;
    if (where->side >= 0 && side_of(surface->normal) != where->side) return false;
    for (int k = 0; k < 2; k++) {
        if (!where->has[k]) continue;
        /* a value written in decimals finds the outline it was drawn with, wherever the body stands */
        const double slack = 1e-9 * fmax(fill->high[0] - fill->low[0], fill->high[1] - fill->low[1]) +
                             8 * 2.3e-16 * fmax(fabs(fill->low[k]), fabs(fill->high[k]));
        if (surface->position[k] < where->range[k][0] - slack || surface->position[k] > where->range[k][1] + slack) return false;
    }
    return true;
}

/* ---- the lists -------------------------------------------------------------------------------------------------------- */

static ab_status grow(void **array, size_t count, size_t size, const ab_filler *filler) {
    void *bigger = realloc(*array, count * size);
    if (!bigger)
        return ab_report_failure(filler->report, "body '%s': no memory for %zu points; use a larger cell or fewer per_cell", filler->body,
                                 count);
    *array = bigger;
    return AB_OK;
}

ab_status ab_filler_reserve(ab_filler *filler, ab_mark mark, double points, double pieces) {
    ab_fill *fill = filler->fill;
    const double count = (double)fill->count + points, surface_count = (double)fill->surface_count + pieces;
    const double most = 2147483648.0; /* points and dofs are numbered in 32 bits */
    if (!(count <= most) || !(surface_count <= most))
        return ab_report_error(filler->report, mark,
                               "body '%s' would have %.3g points (%d in each cell of %g m), more than the %.0f that can be numbered; use a "
                               "larger cell or fewer per_cell",
                               filler->body, count, filler->per_cell, filler->cell, most);
    const double bytes = count * 6 * sizeof(double) + surface_count * (double)sizeof(ab_outline_piece);
    const double memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (memory > 0 && bytes > memory)
        return ab_report_error(filler->report, mark,
                               "body '%s' would have %.3g points (%d in each cell of %g m): %.3g GB, and the machine has %.3g GB; use a "
                               "larger cell or fewer per_cell",
                               filler->body, count, filler->per_cell, filler->cell, bytes * 1e-9, memory * 1e-9);
    if (count > (double)filler->capacity) {
        const size_t capacity = (size_t)fmin(most, fmax(count, 1.5 * (double)filler->capacity));
        AB_TRY(grow((void **)&fill->x, capacity, sizeof(double), filler));
        AB_TRY(grow((void **)&fill->y, capacity, sizeof(double), filler));
        AB_TRY(grow((void **)&fill->volume, capacity, sizeof(double), filler));
        AB_TRY(grow((void **)&fill->extent, capacity, 3 * sizeof(double), filler));
        filler->capacity = capacity;
    }
    if (surface_count > (double)filler->surface_capacity) {
        const size_t capacity = (size_t)fmin(most, fmax(surface_count, 1.5 * (double)filler->surface_capacity));
        AB_TRY(grow((void **)&fill->surface, capacity, sizeof(ab_outline_piece), filler));
        filler->surface_capacity = capacity;
    }
    return AB_OK;
}

uint32_t ab_filler_point(ab_filler *filler, double x, double y, double volume, double xx, double yy, double xy) {
    ab_fill *fill = filler->fill;
    const size_t p = fill->count++;
    fill->x[p] = x;
    fill->y[p] = y;
    fill->volume[p] = volume;
    fill->extent[3 * p] = xx;
    fill->extent[3 * p + 1] = yy;
    fill->extent[3 * p + 2] = xy;
    return (uint32_t)p;
}

void ab_filler_piece(ab_filler *filler, uint32_t point, double x, double y, double normal_x, double normal_y, double length) {
    filler->fill->surface[filler->fill->surface_count++] =
        (ab_outline_piece){.point = point, .position = {x, y}, .normal = {normal_x, normal_y}, .length = length};
}

void ab_filler_bound(ab_filler *filler, double x, double y) {
    double *low = filler->fill->low, *high = filler->fill->high;
    low[0] = fmin(low[0], x);
    low[1] = fmin(low[1], y);
    high[0] = fmax(high[0], x);
    high[1] = fmax(high[1], y);
}

double ab_fill_parts(double length, double size) { return fmax(1.0, floor(length / size + 0.5 + 1e-9)); }
