/* node_normals.h: normals of a shared node other than from gradients of mass and volume. Each gives one direction out of a, which is that into b (collinear), or
 * says that it has no answer there. For finders in this folder. */
#ifndef NODE_NORMALS_H
#define NODE_NORMALS_H

#include <math.h>
#include <string.h>

#include "abut_plugin.h"
#include "closest_approach.h"

static inline double normals_dot(const double *a, const double *b, uint32_t d) {
    double sum = 0.0;
    for (uint32_t c = 0; c < d; ++c) sum += a[c] * b[c];
    return sum;
}

static inline double normals_unit(double *v, uint32_t d) {
    const double length = sqrt(normals_dot(v, v, d));
    if (length > 0.0)
        for (uint32_t c = 0; c < d; ++c) v[c] /= length;
    return length;
}

/* ---- density gradient ------------------------------------------------------------------------------------------------------ */

/* From the slopes of both densities, each by its body's own density, so that a heavy body does not have the say. That density is what the gradients of
 * mass and volume have between them. */
static int density_normal(const ab_trace *a, const ab_trace *b, size_t i, double n[3]) {
    const uint32_t d = a->dimension;
    n[0] = n[1] = n[2] = 0.0;
    for (int side = 0; side < 2; ++side) {
        const ab_trace *t = side ? b : a;
        double mass = 0.0, volume = 0.0;
        for (uint32_t c = 0; c < d; ++c) {
            mass += t->mass_gradient[c * t->ld + i] * t->mass_gradient[c * t->ld + i];
            volume += t->area_vector[c * t->ld + i] * t->area_vector[c * t->ld + i];
        }
        if (!(mass > 0.0)) continue;
        const double specific = sqrt(volume / mass) * (side ? 1.0 : -1.0);
        for (uint32_t c = 0; c < d; ++c) n[c] += specific * t->density_gradient[c * t->ld + i];
    }
    return normals_unit(n, d) > 0.0;
}

/* ---- geometric -------------------------------------------------------------------------------------------------------------- */

/* From which of the 2^d cells that meet at the node hold points of a body: the sum of the directions from their centres to the node. One cell gives a diagonal, two
 * side by side an axis, three the diagonal away from them; two across from each other and all of them give nothing. Both bodies' counted alike. */
static int geometric_normal(const ab_trace *a, const ab_trace *b, size_t i, double n[3]) {
    const uint32_t d = a->dimension;
    n[0] = n[1] = n[2] = 0.0;
    for (int side = 0; side < 2; ++side) {
        const ab_trace *t = side ? b : a;
        uint32_t active = 0;
        for (size_t k = t->near_start[i]; k < t->near_start[i + 1]; ++k) {
            uint32_t cell = 0;
            int in = 1;
            for (uint32_t c = 0; c < d; ++c) {
                const double r = t->near_position[c * t->near_ld + k] - t->position[c * t->ld + i];
                cell |= (uint32_t)(r >= 0.0) << c;
                in = in && fabs(r) <= t->cell;
            }
            if (in) active |= 1u << cell;
        }
        double out[3] = {0};
        for (uint32_t cell = 0; cell < 1u << d; ++cell)
            for (uint32_t c = 0; c < d && (active >> cell & 1); ++c) out[c] += cell >> c & 1 ? -1.0 : 1.0;
        normals_unit(out, d);
        for (uint32_t c = 0; c < d; ++c) n[c] += side ? -out[c] : out[c];
    }
    return normals_unit(n, d) > 1e-6;
}

/* ---- logistic regression ---------------------------------------------------------------------------------------------------- */

typedef struct separation { /* of the points near a node by a plane: phi.(x - x_i)/h + phi[d] is 0 on it, positive on b's side */
    double phi[4];
} separation;

static const double REGRESSION_PENALTY = 1e-5; /* on |slope|^2, against weights that sum to 1 for each body */

/* What is made least, and with `gradient` its derivatives: sum_p w_p log(1 + exp(-c_p f(x_p))) + penalty/2 |slope|^2; c_p = -1 for points of a and 1 for those of b,
 * w_p = 1/(points of the body). Nairn, Hammerquist and Smith 2020 take the squares (c_p - tanh(f/2))^2 with such a penalty; the logarithm of the likelihood has the same plane where points
 * are separable, is convex, and so has one least value which Newton's method finds from anywhere. */
static double regression_misfit(const ab_trace *a, const ab_trace *b, size_t i, const double phi[4], double *gradient, double *hessian) {
    const uint32_t d = a->dimension, rows = d + 1;
    double misfit = 0.5 * REGRESSION_PENALTY * normals_dot(phi, phi, d);
    for (uint32_t r = 0; gradient && r < rows; ++r) {
        gradient[r] = r < d ? REGRESSION_PENALTY * phi[r] : 0.0;
        for (uint32_t c = 0; c < rows; ++c) hessian[4 * r + c] = r == c && r < d ? REGRESSION_PENALTY : 0.0;
    }
    for (int side = 0; side < 2; ++side) {
        const ab_trace *t = side ? b : a;
        const double sign = side ? 1.0 : -1.0, weight = 1.0 / (double)(t->near_start[i + 1] - t->near_start[i]), inverse_h = 1.0 / t->cell;
        for (size_t k = t->near_start[i]; k < t->near_start[i + 1]; ++k) {
            double x[4] = {0};
            for (uint32_t c = 0; c < d; ++c) x[c] = (t->near_position[c * t->near_ld + k] - t->position[c * t->ld + i]) * inverse_h;
            x[d] = 1.0;
            const double f = sign * normals_dot(phi, x, rows), e = exp(-fabs(f)), wrong = f > 0.0 ? e / (1.0 + e) : 1.0 / (1.0 + e);
            misfit += weight * (log1p(e) + (f > 0.0 ? 0.0 : -f));
            if (!gradient) continue;
            const double first = -weight * sign * wrong, second = weight * wrong * (1.0 - wrong);
            for (uint32_t r = 0; r < rows; ++r) {
                gradient[r] += first * x[r];
                for (uint32_t c = 0; c <= r; ++c) hessian[4 * r + c] += second * x[r] * x[c];
            }
        }
    }
    return misfit;
}

/* Solves H s = g by Cholesky's method; H: rows of four, its lower half. 0: not positive. */
static int regression_solve(double *hessian, double *g, uint32_t rows) {
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t c = 0; c <= r; ++c) {
            double sum = hessian[4 * r + c];
            for (uint32_t k = 0; k < c; ++k) sum -= hessian[4 * r + k] * hessian[4 * c + k];
            if (r == c && !(sum > 0.0)) return 0;
            hessian[4 * r + c] = r == c ? sqrt(sum) : sum / hessian[4 * c + c];
        }
    for (uint32_t r = 0; r < rows; ++r) {
        for (uint32_t k = 0; k < r; ++k) g[r] -= hessian[4 * r + k] * g[k];
        g[r] /= hessian[4 * r + r];
    }
    for (uint32_t r = rows; r-- > 0;) {
        for (uint32_t k = r + 1; k < rows; ++k) g[r] -= hessian[4 * k + r] * g[k];
        g[r] /= hessian[4 * r + r];
    }
    return 1;
}

/* The plane that separates the points of both bodies near the node, from a first guess n of its normal. */
static int regression_normal(const ab_trace *a, const ab_trace *b, size_t i, const double guess[3], double n[3]) {
    enum { MOST = 30, HALVINGS = 20 };
    static const double STEEP = 4.0, ENOUGH = 1e-10; /* of the first plane; of the change of the misfit */
    const uint32_t d = a->dimension, rows = d + 1;
    if (a->near_start[i + 1] == a->near_start[i] || b->near_start[i + 1] == b->near_start[i]) return 0;
    double phi[4] = {0}, gradient[4], hessian[16];
    for (uint32_t c = 0; c < d; ++c) phi[c] = STEEP * guess[c];
    double misfit = regression_misfit(a, b, i, phi, gradient, hessian);
    for (int step = 0; step < MOST; ++step) {
        if (!regression_solve(hessian, gradient, rows)) break;
        double part = 1.0, trial[4] = {0}, now = misfit;
        for (int half = 0; half < HALVINGS; ++half, part *= 0.5) {
            for (uint32_t r = 0; r < rows; ++r) trial[r] = phi[r] - part * gradient[r];
            now = regression_misfit(a, b, i, trial, NULL, NULL);
            if (now < misfit) break;
        }
        if (!(now < misfit)) break;
        memcpy(phi, trial, sizeof phi);
        if (misfit - now <= ENOUGH) break;
        misfit = regression_misfit(a, b, i, phi, gradient, hessian);
    }
    n[2] = 0.0;
    for (uint32_t c = 0; c < d; ++c) n[c] = phi[c];
    return normals_unit(n, d) > 0.0;
}

/* ---- flat or convex against concave ------------------------------------------------------------------------------------------ */

static const double CONCAVE = 0.02; /* of a cell: the face beside a node rises above it by more */

/* How far a body's face bulges at the node, m: how far its material reaches along its own normal beside the node, less the mean of how far it does to
 * either side (half a cell to one and a half across, at most a cell lower); the sum over the directions across. Positive: convex, 0: flat, negative: concave. */
static double bulge(const ab_trace *t, size_t i, const double n[3]) {
    const uint32_t d = t->dimension;
    double reach[5], across[2][3] = {{0}}; /* beside the node; to both sides along the first direction across, along the second */
    for (int k = 0; k < 5; ++k) reach[k] = -INFINITY;
    uint32_t least = 0;
    for (uint32_t c = 1; c < d; ++c)
        if (fabs(n[c]) < fabs(n[least])) least = c;
    if (d == 2) {
        across[0][0] = -n[1];
        across[0][1] = n[0];
    } else {
        across[0][least] = 1.0;
        for (uint32_t c = 0; c < d; ++c) across[0][c] -= n[least] * n[c];
        normals_unit(across[0], d);
        for (uint32_t c = 0; c < 3; ++c) across[1][c] = n[(c + 1) % 3] * across[0][(c + 2) % 3] - n[(c + 2) % 3] * across[0][(c + 1) % 3];
    }
    for (size_t k = t->near_start[i]; k < t->near_start[i + 1]; ++k) {
        double r[3] = {0};
        for (uint32_t c = 0; c < d; ++c) r[c] = t->near_position[c * t->near_ld + k] - t->position[c * t->ld + i];
        const double *e = t->near_extent + k;
        const size_t ld = t->near_ld;
        const double square = d == 2 ? n[0] * n[0] * e[0] + n[1] * n[1] * e[ld] + 2.0 * n[0] * n[1] * e[2 * ld]
                                     : n[0] * n[0] * e[0] + n[1] * n[1] * e[ld] + n[2] * n[2] * e[2 * ld] +
                                           2.0 * (n[0] * n[1] * e[3 * ld] + n[1] * n[2] * e[4 * ld] + n[2] * n[0] * e[5 * ld]);
        const double far = normals_dot(r, n, d) + sqrt(larger(square, 0.0));
        int beside = 1;
        for (uint32_t s = 0; s + 1 < d; ++s) {
            const double off = normals_dot(r, across[s], d);
            if (fabs(off) <= 0.5 * t->cell) continue;
            beside = 0;
            const uint32_t at = 1 + 2 * s + (off > 0.0);
            if (far > reach[at]) reach[at] = far;
        }
        if (beside && far > reach[0]) reach[0] = far;
    }
    if (!(reach[0] > -INFINITY)) return 0.0;
    double sum = 0.0;
    for (uint32_t s = 0; s + 1 < d; ++s)
        for (uint32_t side = 1; side <= 2; ++side)
            sum += 0.5 * larger(reach[0] - smaller(reach[2 * s + side], reach[0] + t->cell), -t->cell);
    return smaller(sum, t->cell);
}

/* Where one body is concave, the normal of the other, flat or convex one (Huang et al. 2011). along: the best direction known, along which both faces are looked
 * at; na, nb: of each body's own gradient, out of it. 0: neither is concave, or the gradient leans further from `along` than a face does. */
static int convex_normal(const ab_trace *a, const ab_trace *b, size_t i, const double along[3], const double na[3], const double nb[3],
                         double least_cosine, double n[3]) {
    const double back[3] = {-along[0], -along[1], -along[2]}, concave = -CONCAVE * a->cell;
    const double of_a = bulge(a, i, along), of_b = bulge(b, i, back);
    if (!(smaller(of_a, of_b) < concave)) return 0;
    for (uint32_t c = 0; c < 3; ++c) n[c] = of_a >= of_b ? na[c] : -nb[c];
    return normals_dot(n, along, a->dimension) >= least_cosine;
}

/* ---- faces ------------------------------------------------------------------------------------------------------------------- */

static const double SHARP = 0.35; /* rad: a vertex where the outline turns by more is a corner, and says little about the normal */

static int has_face(const ab_trace *t, size_t i) { return t->face_normal && t->face_distance[i] < INFINITY; }

/* The unit normal of the nearest face of either body, out of a (trace->face_normal, found by contact/nearest_face.c); of both, where both show one, that of the stiffer, or the
 * mean where neither is. 0: none is within two cells, or only beside a corner of the outline. */
static int face_normal(const ab_trace *a, const ab_trace *b, size_t i, double n[3]) {
    const uint32_t d = a->dimension;
    const int of_a = has_face(a, i) && a->face_turn[i] <= SHARP, of_b = has_face(b, i) && b->face_turn[i] <= SHARP;
    double weight_a = of_a, weight_b = of_b;
    if (of_a && of_b && a->stiffness != b->stiffness) weight_a = a->stiffness > b->stiffness, weight_b = 1.0 - weight_a;
    n[2] = 0.0;
    for (uint32_t c = 0; c < d; ++c)
        n[c] = (weight_a > 0.0 ? weight_a * a->face_normal[c * a->ld + i] : 0.0) -
               (weight_b > 0.0 ? weight_b * b->face_normal[c * b->ld + i] : 0.0);
    return normals_unit(n, d) > 0.0;
}

#endif
