/* fill_checks.h: shapes to fill, and what to measure on what comes back. */
#ifndef FILL_CHECKS_H
#define FILL_CHECKS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "mpm/fill.h"

#define PI 3.14159265358979323846
static const double zero[2] = {0, 0};

/* ---- shapes ---------------------------------------------------------------------------------------------------------------- */

static inline ab_shape_spec box(double x0, double y0, double x1, double y1) {
    return (ab_shape_spec){.kind = AB_SHAPE_BOX, .low = {x0, y0}, .high = {x1, y1}};
}

static inline ab_shape_spec ring(double x, double y, double radius, double inner) {
    return (ab_shape_spec){.kind = inner > 0 ? AB_SHAPE_RING : AB_SHAPE_DISC, .center = {x, y}, .radius = radius, .inner = inner};
}

static inline ab_shape_spec polygon(double (*vertices)[2], size_t count) {
    return (ab_shape_spec){.kind = AB_SHAPE_POLYGON, .vertices = vertices, .count = count};
}

static inline ab_fill *fill_of(const ab_shape_spec *shape, ab_fill_rule rule, int per_cell, double cell) {
    ab_report *report = ab_report_create();
    ab_fill *fill = NULL;
    const ab_status status = ab_fill_create(shape, rule, per_cell, cell, zero, "body", &fill, report);
    if (status != AB_OK) ab_report_print(report, stderr);
    assert_int_equal(status, AB_OK);
    ab_report_destroy(report);
    return fill;
}

static inline double shoelace(double (*v)[2], size_t n) {
    long double sum = 0;
    for (size_t k = 0; k < n; k++) {
        const double *a = v[k], *b = v[(k + 1) % n];
        sum +=
            ((long double)a[0] - v[0][0]) * ((long double)b[1] - v[0][1]) - ((long double)b[0] - v[0][0]) * ((long double)a[1] - v[0][1]);
    }
    return (double)fabsl(sum / 2);
}

static inline double perimeter(double (*v)[2], size_t n) {
    double sum = 0;
    for (size_t k = 0; k < n; k++) sum += hypot(v[(k + 1) % n][0] - v[k][0], v[(k + 1) % n][1] - v[k][1]);
    return sum;
}

/* Distance out of a polygon: 0 inside. */
static inline double outside(double (*v)[2], size_t n, double x, double y) {
    bool in = false;
    double nearest = INFINITY;
    for (size_t k = 0; k < n; k++) {
        const double *a = v[k], *b = v[(k + 1) % n];
        if ((a[1] <= y) != (b[1] <= y) && a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > x) in = !in;
        const double l2 = (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]);
        const double t = fmin(1, fmax(0, ((x - a[0]) * (b[0] - a[0]) + (y - a[1]) * (b[1] - a[1])) / l2));
        nearest = fmin(nearest, hypot(x - a[0] - t * (b[0] - a[0]), y - a[1] - t * (b[1] - a[1])));
    }
    return in ? 0 : nearest;
}

/* ---- measures -------------------------------------------------------------------------------------------------------------- */

static inline double volume_of(const ab_fill *f) {
    long double sum = 0;
    for (size_t p = 0; p < f->count; p++) sum += f->volume[p];
    return (double)sum;
}

static inline double length_of(const ab_fill *f) {
    long double sum = 0;
    for (size_t k = 0; k < f->surface_count; k++) sum += f->surface[k].length;
    return (double)sum;
}

static inline double moment_of(const ab_fill *f, const double *x) {
    long double sum = 0;
    for (size_t p = 0; p < f->count; p++) sum += (long double)f->volume[p] * x[p];
    return (double)sum;
}

/* The largest difference between half size and distance of a piece of outline from its point. */
static inline double surface_error(const ab_fill *f) {
    double worst = 0;
    for (size_t k = 0; k < f->surface_count; k++) {
        const ab_outline_piece *s = &f->surface[k];
        assert_true(s->point < f->count);
        const double *a = &f->extent[3 * (size_t)s->point], *n = s->normal;
        assert_true(fabs(hypot(n[0], n[1]) - 1) < 1e-14);
        assert_true(s->length > 0);
        const double half = sqrt(n[0] * n[0] * a[0] + n[1] * n[1] * a[1] + 2 * n[0] * n[1] * a[2]);
        const double away = n[0] * (s->position[0] - f->x[s->point]) + n[1] * (s->position[1] - f->y[s->point]);
        worst = fmax(worst, fabs(half - away));
    }
    return worst;
}

static inline void check_sane(const ab_fill *f) {
    assert_true(f->count > 0);
    for (size_t p = 0; p < f->count; p++) {
        const double *a = &f->extent[3 * p];
        assert_true(isfinite(f->x[p]) && isfinite(f->y[p]));
        assert_true(f->volume[p] > 0);
        assert_true(a[0] > 0 && a[1] > 0 && a[0] * a[1] > a[2] * a[2]);
        assert_true(f->x[p] > f->low[0] && f->x[p] < f->high[0] && f->y[p] > f->low[1] && f->y[p] < f->high[1]);
    }
    double closed[2] = {0, 0}; /* the normals of a closed outline add up to nothing */
    for (size_t k = 0; k < f->surface_count; k++)
        for (int c = 0; c < 2; c++) closed[c] += f->surface[k].normal[c] * f->surface[k].length;
    assert_true(hypot(closed[0], closed[1]) < 1e-11 * length_of(f));
}

static inline void near(double value, double wanted, double tolerance) {
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%.17g is not %.17g (off by %.3g, allowed %.3g)", value, wanted, fabs(value - wanted), tolerance);
}

/* All that holds for a polygon. Returns the surface error relative to the distance between points. */
static inline double check_polygon(double (*v)[2], size_t n, ab_fill_rule rule, int per_cell, double cell) {
    const ab_shape_spec shape = polygon(v, n);
    ab_fill *f = fill_of(&shape, rule, per_cell, cell);
    const double area = shoelace(v, n), spacing = cell / sqrt(per_cell);
    check_sane(f);
    near(volume_of(f), area, 1e-12 * area);
    near(length_of(f), perimeter(v, n), 1e-12 * perimeter(v, n));
    for (size_t p = 0; p < f->count; p++) near(outside(v, n, f->x[p], f->y[p]), 0, 0);
    const double error = surface_error(f) / spacing;
    ab_fill_destroy(f);
    return error;
}

typedef struct place {
    double x, y, volume, xx, yy, xy;
} place;

static inline int by_place(const void *a, const void *b) {
    const place *p = a, *q = b;
    if (fabs(p->y - q->y) > 1e-9) return p->y < q->y ? -1 : 1;
    if (fabs(p->x - q->x) > 1e-9) return p->x < q->x ? -1 : 1;
    return 0;
}

/* Points moved by x' = m x, sorted. */
static inline place *moved(const ab_fill *f, const double m[4]) {
    place *list = malloc(f->count * sizeof *list);
    for (size_t p = 0; p < f->count; p++) {
        const double *a = &f->extent[3 * p];
        list[p] = (place){m[0] * f->x[p] + m[1] * f->y[p],
                          m[2] * f->x[p] + m[3] * f->y[p],
                          f->volume[p],
                          m[0] * m[0] * a[0] + m[1] * m[1] * a[1] + 2 * m[0] * m[1] * a[2],
                          m[2] * m[2] * a[0] + m[3] * m[3] * a[1] + 2 * m[2] * m[3] * a[2],
                          m[0] * m[2] * a[0] + m[1] * m[3] * a[1] + (m[0] * m[3] + m[1] * m[2]) * a[2]};
    }
    qsort(list, f->count, sizeof *list, by_place);
    return list;
}

/* a moved by m is b. */
static inline void check_same_points(const ab_fill *a, const double m[4], const ab_fill *b) {
    const double none[4] = {1, 0, 0, 1};
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->surface_count, b->surface_count);
    place *p = moved(a, m), *q = moved(b, none);
    for (size_t k = 0; k < a->count; k++) {
        near(p[k].x, q[k].x, 1e-12);
        near(p[k].y, q[k].y, 1e-12);
        near(p[k].volume, q[k].volume, 1e-13);
        near(p[k].xx, q[k].xx, 1e-13);
        near(p[k].yy, q[k].yy, 1e-13);
        near(p[k].xy, q[k].xy, 1e-13);
    }
    free(p);
    free(q);
}

static inline void move_vertices(double (*v)[2], size_t n, const double m[4], double (*to)[2]) {
    for (size_t k = 0; k < n; k++) {
        to[k][0] = m[0] * v[k][0] + m[1] * v[k][1];
        to[k][1] = m[2] * v[k][0] + m[3] * v[k][1];
    }
}

#endif
