/* face_curve.h: a face of a surface as a curve of degree one or two, and the closest place of it to a point. For finders in this folder. */
#ifndef FACE_CURVE_H
#define FACE_CURVE_H

#include <math.h>
#include <string.h>

#include "abut_plugin.h"

/* As fmax and fmin, a NaN being ignored, but inline: calls of the library's cost ten times as much. */
static inline double larger(double a, double b) { return b > a || a != a ? b : a; }
static inline double smaller(double a, double b) { return b < a || a != a ? b : a; }

enum { FACE_MOST_STEPS = 30 };
static const double FACE_TOLERANCE = 1e-12; /* of a face's length: of the projection */

static double dot(const double a[2], const double b[2]) { return a[0] * b[0] + a[1] * b[1]; }
static double cross(const double a[2], const double b[2]) { return a[0] * b[1] - a[1] * b[0]; }

/* r(xi) = from + (1 + xi)/2 along + (1 - xi^2) bow, -1 <= xi <= 1: what the shape functions of two or three nodes make of their places. */
typedef struct curve {
    double from[2], along[2], bow[2], length;
    int bent;
} curve;

static const double FACE_SHORTEST = 1e-100, FACE_LONGEST = 1e100; /* m: beyond them squares are no numbers any more */

/* False: it has no length, or is nowhere. */
static int curve_of(const ab_surface *s, uint32_t face, curve *c) {
    const uint32_t *v = s->face_vertex + 3 * (size_t)face;
    double square = 0.0;
    c->bent = v[2] != UINT32_MAX;
    for (size_t d = 0; d < 2; ++d) {
        const double *x = s->vertex_position + d * s->vertex_ld;
        c->from[d] = x[v[0]];
        c->along[d] = x[v[1]] - x[v[0]];
        c->bow[d] = c->bent ? x[v[2]] - 0.5 * (x[v[0]] + x[v[1]]) : 0.0;
        square += c->along[d] * c->along[d];
    }
    c->length = sqrt(square);
    return c->length >= FACE_SHORTEST && c->length <= FACE_LONGEST && fabs(c->bow[0]) + fabs(c->bow[1]) <= FACE_LONGEST &&
           isfinite(c->from[0] + c->from[1]);
}

static void place_of(const curve *c, double xi, double x[2]) {
    for (int d = 0; d < 2; ++d) x[d] = c->from[d] + 0.5 * (1.0 + xi) * c->along[d] + (1.0 - xi * xi) * c->bow[d];
}

static void slope_at(const curve *c, double xi, double slope[2]) {
    for (int d = 0; d < 2; ++d) slope[d] = 0.5 * c->along[d] - 2.0 * xi * c->bow[d];
}

/* Unit normal, outwards: right of the way along the face. False where the face folds back and has none. */
static int normal_at(const curve *c, double xi, double n[2]) {
    double slope[2];
    slope_at(c, xi, slope);
    const double size = sqrt(dot(slope, slope));
    n[0] = slope[1] / size;
    n[1] = -slope[0] / size;
    return size > 1e-12 * c->length;
}

/* t - r(xi) for the point at from + q. */
static void from_place(const curve *c, const double q[2], double xi, double r[2]) {
    for (int d = 0; d < 2; ++d) r[d] = q[d] - 0.5 * (1.0 + xi) * c->along[d] - (1.0 - xi * xi) * c->bow[d];
}

/* f = r'.(t - r), which falls through zero where the distance is least; *derivative: f' = r''.(t - r) - r'.r'. */
static double stationary(const curve *c, const double q[2], double xi, double *derivative) {
    double r[2], slope[2];
    from_place(c, q, xi, r);
    slope_at(c, xi, slope);
    *derivative = -2.0 * dot(c->bow, r) - dot(slope, slope);
    return dot(slope, r);
}

/* The root of f between low and high, where f(low) > 0 > f(high): Newton's method from `start`; a step that leaves the interval is replaced by its middle. */
static int root_between(const curve *c, const double q[2], double low, double high, double start, double *xi) {
    *xi = start > low && start < high ? start : start <= low ? low : high;
    if ((start <= low && low > -1.0) || (start >= high && high < 1.0)) *xi = 0.5 * (low + high);
    for (int step = 0; step < FACE_MOST_STEPS; ++step) {
        double derivative, slope[2];
        const double f = stationary(c, q, *xi, &derivative), change = -f / derivative;
        slope_at(c, *xi, slope);
        if (fabs(change) * sqrt(dot(slope, slope)) <= FACE_TOLERANCE * c->length) return 1;
        if (f > 0.0)
            low = *xi;
        else
            high = *xi;
        const double next = *xi + change;
        *xi = next > low && next < high ? next : 0.5 * (low + high);
        if (high - low <= FACE_TOLERANCE) return 1;
    }
    return 0;
}

/* The closest place of a curve to the point at from + q, over all places where f falls through zero, and the ends. False: Newton's method has not ended. */
static int project(const curve *c, const double q[2], int closed, double *xi) {
    const double chord = fmax(-1.0, fmin(1.0, 2.0 * dot(q, c->along) / (c->length * c->length) - 1.0));
    *xi = chord;
    if (closed && !c->bent) return 1;
    /* f' = p0 + p1 xi + p2 xi^2: its roots cut [-1, 1] where f turns. */
    const double bow2 = dot(c->bow, c->bow), p2 = -6.0 * bow2, p1 = 3.0 * dot(c->along, c->bow),
                 p0 = -2.0 * dot(c->bow, q) + dot(c->along, c->bow) + 2.0 * bow2 - 0.25 * c->length * c->length;
    double cut[4] = {-1.0, 1.0, 1.0, 1.0};
    int pieces = 1;
    const double inside = p1 * p1 - 4.0 * p2 * p0;
    if (p2 < 0.0 && inside > 0.0) {
        const double half = -0.5 * (p1 + copysign(sqrt(inside), p1)), first = half / p2, second = half != 0.0 ? p0 / half : first;
        const double turn[2] = {fmin(first, second), fmax(first, second)};
        for (int k = 0; k < 2; ++k)
            if (turn[k] > cut[pieces - 1] && turn[k] < 1.0) cut[pieces++] = turn[k];
        cut[pieces] = 1.0;
    }
    int ended = 1;
    double best = INFINITY, unused;
    if (pieces == 1) { /* often the chord's answer is the answer */
        double derivative, slope[2];
        const double f = stationary(c, q, chord, &derivative);
        slope_at(c, chord, slope);
        if (fabs(f / derivative) * sqrt(dot(slope, slope)) <= FACE_TOLERANCE * c->length) return 1;
    }
    for (int k = 0; k < pieces; ++k) {
        double at[3], r[2];
        int places = 0;
        const double f_low = stationary(c, q, cut[k], &unused), f_high = stationary(c, q, cut[k + 1], &unused);
        if (k == 0 && f_low <= 0.0) at[places++] = -1.0;
        if (k == pieces - 1 && f_high >= 0.0) at[places++] = 1.0;
        if (f_low > 0.0 && f_high < 0.0) {
            ended = root_between(c, q, cut[k], cut[k + 1], chord, &at[places]) && ended;
            ++places;
        }
        for (int p = 0; p < places; ++p) {
            from_place(c, q, at[p], r);
            if (dot(r, r) < best) best = dot(r, r), *xi = at[p];
        }
    }
    return ended;
}

#endif
