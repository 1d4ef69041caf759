/* place_of_impulse.h: where between two bodies an impulse at a shared node acts. For finders in this folder. */
#ifndef PLACE_OF_IMPULSE_H
#define PLACE_OF_IMPULSE_H

#include <math.h>

#include "abut_plugin.h"
#include "closest_approach.h"

/* Half size of near point k in direction n: sqrt(n.A.n). */
static double half_size(const ab_trace *t, size_t k, const double n[3]) {
    const double *e = t->near_extent + k;
    const size_t ld = t->near_ld;
    const double square = t->dimension == 2 ? n[0] * n[0] * e[0] + n[1] * n[1] * e[ld] + 2.0 * n[0] * n[1] * e[2 * ld]
                                            : n[0] * n[0] * e[0] + n[1] * n[1] * e[ld] + n[2] * n[2] * e[2 * ld] +
                                                  2.0 * (n[0] * n[1] * e[3 * ld] + n[1] * n[2] * e[4 * ld] + n[2] * n[0] * e[5 * ld]);
    return sqrt(larger(square, 0.0));
}

typedef struct
    support { /* where a body reaches furthest along a direction, near a node: from the node, m; how far those places spread across it, m2 */
    double place[3], variance;
    int known;
} support;

static const double AS_FAR = 0.001, LEAST_VARIANCE = 1e-6; /* of a cell, of its square */

/* The place along sign n: where the points' domains that reach as far as the furthest, or almost, do so. Points as in `reach`, so that the gap is that of this place. */
static support support_along(const ab_trace *t, size_t i, const double n[3], double sign) {
    const uint32_t d = t->dimension;
    const size_t ld = t->near_ld;
    support found = {.variance = 0.0};
    double furthest = -INFINITY, weights = 0.0, square = 0.0;
    for (int pass = 0; pass < 2; ++pass)
        for (size_t k = t->near_start[i]; k < t->near_start[i + 1]; ++k) {
            const double *e = t->near_extent + k, half = half_size(t, k, n);
            double p[3] = {0}, along = 0.0, across2 = 0.0;
            for (uint32_t c = 0; c < d; ++c) {
                p[c] = t->near_position[c * ld + k] - t->position[c * t->ld + i];
                along += sign * n[c] * p[c];
                across2 += p[c] * p[c];
            }
            if (across2 - along * along > 0.25 * t->cell * t->cell) continue;
            if (pass == 0) {
                furthest = larger(furthest, along + half);
                continue;
            }
            const double near = 1.0 - (furthest - along - half) / (AS_FAR * t->cell), w = near > 0.0 ? near * near : 0.0;
            if (w == 0.0) continue;
            for (uint32_t c = 0; c < d; ++c) { /* the place of an ellipse that lies furthest along n is A.n/sqrt(n.A.n) from its middle */
                const uint32_t next = (c + 1) % 3, last = (c + 2) % 3;
                const double lean = d == 2 ? n[c] * e[c * ld] + n[!c] * e[2 * ld]
                                           : n[c] * e[c * ld] + n[next] * e[(c + 3) * ld] + n[last] * e[(last + 3) * ld];
                p[c] += (half > 0.0 ? sign * lean / half : 0.0) - sign * (along + half) * n[c];
            }
            weights += w;
            for (uint32_t c = 0; c < d; ++c) {
                found.place[c] += w * p[c];
                square += w * p[c] * p[c];
            }
        }
    if (!(weights > 0.0)) return found;
    double mean2 = 0.0;
    for (uint32_t c = 0; c < d; ++c) {
        found.place[c] /= weights;
        mean2 += found.place[c] * found.place[c];
    }
    found.variance = larger(square / weights - mean2, 0.0) + LEAST_VARIANCE * t->cell * t->cell;
    for (uint32_t c = 0; c < d; ++c) found.place[c] += sign * furthest * n[c];
    found.known = 1;
    return found;
}

/* Where an impulse acts, from the node: there, but on a rigid body, which turns by it. A wheel that were pushed at nodes would roll as a polygon with sides of a
 * cell, braked at every corner. So it is pushed where it reaches furthest towards the other body; where it is flat, and that is no one place, beside the node. */
static void place_of_impulse(const ab_trace *a, const ab_trace *b, size_t i, const double n[3], double place[3]) {
    const support of_a = isinf(a->stiffness) ? support_along(a, i, n, 1.0) : (support){.known = 0},
                  of_b = isinf(b->stiffness) ? support_along(b, i, n, -1.0) : (support){.known = 0};
    place[0] = place[1] = place[2] = 0.0;
    if (!of_a.known && !of_b.known) return;
    double along = 0.0, across[3] = {0}, sum = 0.0, sides = 0.0;
    for (int side = 0; side < 2; ++side) {
        const support *s = side ? &of_b : &of_a;
        if (!s->known) continue;
        double far = 0.0;
        for (uint32_t c = 0; c < a->dimension; ++c) far += s->place[c] * n[c];
        for (uint32_t c = 0; c < a->dimension; ++c) across[c] += (s->place[c] - far * n[c]) / s->variance;
        sum += 1.0 / s->variance;
        along += far;
        sides += 1.0;
    }
    /* 1 where it is one place; 0 where all of the half cells round the node reach as far */
    const double one = larger(1.0 - 12.0 / (sum * a->cell * a->cell), 0.0);
    for (uint32_t c = 0; c < a->dimension; ++c) place[c] = along / sides * n[c] + one * across[c] / sum;
}

#endif
