/* closest_approach.h: the direction along which the material of two bodies near a shared node is furthest apart, two dimensions. For finders in this folder. */
#ifndef CLOSEST_APPROACH_H
#define CLOSEST_APPROACH_H

#include <math.h>

#include "abut_plugin.h"

/* As fmax and fmin, a NaN being ignored, but inline: calls of the library's cost ten times as much. */
static inline double larger(double a, double b) { return b > a || a != a ? b : a; }
static inline double smaller(double a, double b) { return b < a || a != a ? b : a; }

typedef struct clearance {
    double angle, distance, slope; /* rad, m, m per rad */
} clearance;

/* Distance along direction (c, s) at `angle` between the material of both bodies near node i (negative: overlap) and how it changes with the angle: what the two
 * points that reach furthest say. Over all directions the largest distance belongs to the direction of closest approach. Two dimensions. */
static clearance look_towards(const ab_trace *a, const ab_trace *b, size_t i, double angle, double c, double s) {
    const double cc = c * c, ss = s * s, cs = 2.0 * c * s;
    clearance seen = {.angle = angle};
    for (int side = 0; side < 2; ++side) {
        const ab_trace *t = side ? b : a;
        const double sign = side ? -1.0 : 1.0;
        const double *x = t->near_position, *y = x + t->near_ld, *xx = t->near_extent, *yy = xx + t->near_ld, *xy = yy + t->near_ld;
        double far = -INFINITY;
        size_t furthest = t->near_start[i];
        for (size_t k = t->near_start[i]; k < t->near_start[i + 1]; ++k) {
            const double along = sign * (x[k] * c + y[k] * s), square = cc * xx[k] + ss * yy[k] + cs * xy[k], left = far - along;
            if (left >= 0.0 && left * left >= square) continue; /* it does not reach as far: most do not, and need no root */
            far = along + sqrt(larger(square, 0.0)), furthest = k;
        }
        const size_t k = furthest;
        const double half = sqrt(larger(cc * xx[k] + ss * yy[k] + cs * xy[k], 0.0));
        seen.distance -= far;
        seen.slope -= sign * (y[k] * c - x[k] * s) + (half > 0.0 ? (c * s * (yy[k] - xx[k]) + (cc - ss) * xy[k]) / half : 0.0);
    }
    return seen;
}

static clearance look_along(const ab_trace *a, const ab_trace *b, size_t i, double angle) {
    return look_towards(a, b, i, angle, cos(angle), sin(angle));
}

/* The largest distance near a direction: uphill until the slope turns, then to where the tangents of both ends meet, until the distance there is what they
 * promise. With radii of curvature r_a and r_b where they reach furthest, the second derivative is -distance - r_a - r_b: where bodies overlap by more than these, as a corner
 * in a corner does in every direction, the distance is more than its tangents promise until both meet at the top, which is a kink. To end before it would leave the direction
 * to where the search began, a mirrored body with another one, and a symmetric body, by rounding, on one of its sides (tests/verification/wall_in_slot.yaml). */
static clearance climb(const ab_trace *a, const ab_trace *b, size_t i, clearance from) {
    static const double FIRST_STEP = 0.02, ROUNDING = 1e-13, PI = 3.141592653589793;
    enum { MOST = 60 };
    clearance low = from, high = from, best;
    for (double step = FIRST_STEP; low.slope < 0.0 && from.angle - low.angle < PI; step *= 2.0)
        high = low, low = look_along(a, b, i, low.angle - step);
    for (double step = FIRST_STEP; high.slope > 0.0 && high.angle - from.angle < PI; step *= 2.0)
        low = high, high = look_along(a, b, i, high.angle + step);
    best = low.distance >= high.distance ? low : high;
    for (int k = 0; k < MOST && low.slope > 0.0 && high.slope < 0.0; ++k) {
        double angle = (high.distance - high.slope * high.angle - low.distance + low.slope * low.angle) / (low.slope - high.slope);
        if (!(angle > low.angle && angle < high.angle)) angle = 0.5 * (low.angle + high.angle);
        best = look_along(a, b, i, angle);
        const double left = low.distance + low.slope * (angle - low.angle) - best.distance;
        if (fabs(left) <= ROUNDING * a->cell) break;
        if (best.slope > 0.0)
            low = best;
        else
            high = best;
    }
    return best;
}

static const double TOUCH = 0.01, APART = 0.5; /* of a cell */

/* The direction of closest approach, out of a, from the best of three guesses (cosine and sine each). On a face it is the face's normal to rounding, also where
 * the other body shows only an edge or a single point. Of bodies that are apart the distance has one maximum over all directions; below zero there may be
 * others, as at a corner that faces along the other body. So at a corner where they seem to overlap every direction is asked whether they are apart, or all but touch. */
static void closest_approach(const ab_trace *a, const ab_trace *b, size_t i, const double guess[3][2], int corner, double n[3]) {
    static const double PI = 3.141592653589793;
    enum { DIRECTIONS = 24 };
    clearance begin = {.distance = -INFINITY};
    for (int k = 0; k < 3; ++k) {
        const double length = sqrt(guess[k][0] * guess[k][0] + guess[k][1] * guess[k][1]);
        if (!(length > 0.0)) continue;
        clearance seen = look_towards(a, b, i, 0.0, guess[k][0] / length, guess[k][1] / length);
        if (!(seen.distance > begin.distance)) continue;
        begin = seen;
        begin.angle = atan2(guess[k][1], guess[k][0]);
    }
    if (begin.distance == -INFINITY) begin = look_along(a, b, i, 0.0);
    clearance found = begin.distance > APART * a->cell ? begin : climb(a, b, i, begin);
    if (corner && found.distance < 0.0) {
        begin = found;
        for (int k = 0; k < DIRECTIONS; ++k) {
            const clearance seen = look_along(a, b, i, 2.0 * PI * k / DIRECTIONS);
            if (seen.distance > begin.distance) begin = seen;
        }
        if (begin.angle != found.angle) {
            const clearance other = climb(a, b, i, begin);
            if (other.distance > -TOUCH * a->cell) found = other;
        }
    }
    n[0] = cos(found.angle);
    n[1] = sin(found.angle);
}

/* Two gradients that lean may agree by chance, and the distance along them is then short by a thousandth of a cell. So where the bodies are apart, or all but touch,
 * and are clearly further apart along another direction near n, n becomes that one. */
static void mend_chance(const ab_trace *a, const ab_trace *b, size_t i, double n[3]) {
    static const double BESIDE = 1e-6 /* rad */, CLEARLY = 1e-4 /* of a cell */;
    const double angle = atan2(n[1], n[0]);
    const clearance here = look_along(a, b, i, angle);
    if (here.distance < -TOUCH * a->cell ||
        (look_along(a, b, i, angle - BESIDE).distance <= here.distance && look_along(a, b, i, angle + BESIDE).distance <= here.distance))
        return;
    const clearance top = climb(a, b, i, here);
    if (!(top.distance > here.distance + CLEARLY * a->cell)) return;
    n[0] = cos(top.angle);
    n[1] = sin(top.angle);
}

#endif
