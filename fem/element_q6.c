/* element_q6.c: the quadrilateral with four nodes, 2 x 2 Gauss points and the incompatible modes 1 - xi^2 and 1 - eta^2 (Wilson et al.
 * 1973) in the form of Taylor, Beresford and Wilson (1976): their gradients go by the Jacobian at the centre, (J0/J) J0^-T grad N, so
 * that they do no work on constant stress and the patch test holds for every shape.
 *
 * The modes keep no state. In each step their increments are those that an elastic element would take (by strains without the element's rotation), and bring back half of what is
 * left of the residual sum V_q sigma_q G at the start: half, because a material that has grown more than twice as stiff as at its
 * beginning would otherwise be led beyond the mark in every step.
 *
 * Compiled once more with RINGS, as a ring about the axis x = 0. There the gradients of the modes would work on constant stress, as points farther out
 * count for more: xi and eta in them are measured from where their mean over the ring is zero, xi_0 = r,xi/(3 r) and eta_0 = r,eta/(3 r) at the centre (Simo and Rifai 1990,
 * section 3.3, whose modes of the plane these are; the modes do not strain the hoops). */
#include "fem/element_inner.h"

#ifndef RINGS
#define RINGS 0
#endif
#if RINGS
#define NAME(f) fem_q6_##f##_rings
#else
#define NAME(f) fem_q6_##f
#endif

static const double PLACE[4][2] = {
    {-FEM_GAUSS_2, -FEM_GAUSS_2}, {FEM_GAUSS_2, -FEM_GAUSS_2}, {-FEM_GAUSS_2, FEM_GAUSS_2}, {FEM_GAUSS_2, FEM_GAUSS_2}};
static const double RETURN = 0.5;

/* Solves k a = r for symmetric positive k, lower triangle given. */
static inline void solve_modes(lanes k[4][4], lanes r[4]) {
    lanes inverse[4];
    for (int i = 0; i < 4; i++) {
        inverse[i] = 1.0 / k[i][i];
        for (int m = i + 1; m < 4; m++) {
            const lanes factor = k[m][i] * inverse[i];
            for (int n = m; n < 4; n++) k[n][m] -= factor * k[n][i];
            r[m] -= factor * r[i];
        }
    }
    for (int i = 3; i >= 0; i--) {
        for (int m = i + 1; m < 4; m++) r[i] -= k[m][i] * r[m];
        r[i] *= inverse[i];
    }
}

static inline void strain(fem_block *block, const fem_elastic *elastic, int first) {
    const double lambda = elastic->lambda, mu = elastic->mu;
    const fem_bilinear x = fem_bilinear_of(block->start, NULL, first), u = fem_bilinear_of(block->end, block->start, first),
                       y = fem_bilinear_sum(&x, &u, 1);
    const fem_jacobian j0 = fem_bilinear_at(&x, 0, 0);
    const lanes det0 = fem_det(j0), r0 = 1.0 / det0;
    /* the rotation of the element in this step; 1 - cosine without cancellation */
    const fem_jacobian centre = fem_gradient(fem_bilinear_at(&u, 0, 0), j0, r0);
    lanes cosine, sine;
    fem_frame((fem_jacobian){1.0 + centre.xx, centre.xy, centre.yx, 1.0 + centre.yy}, &cosine, &sine);
    const lanes below = sine * sine / (1.0 + cosine);
    const lanes gx[2] = {j0.yy * r0, -j0.yx * r0}, gy[2] = {-j0.xy * r0, j0.xx * r0}; /* J0^-T of the two directions */
    fem_jacobian h[4];
    lanes ratio[4], area = {0}, r[4] = {{0}};
#if RINGS
    const lanes radius = fem_radius_centre(block->start, first), now = fem_radius_centre(block->end, first), third = 1.0 / (3.0 * radius);
    const lanes middle[2] = {x.a[0] * third, x.b[0] * third};
    lanes over[3] = {{0}};
#else
    lanes same = {0}, mixed = {0};
#endif
    for (int q = 0; q < 4; q++) {
        const double xi = PLACE[q][0], eta = PLACE[q][1];
        const fem_jacobian j = fem_bilinear_at(&x, xi, eta);
        const lanes det = fem_det(j), end = fem_det(fem_bilinear_at(&y, xi, eta)), inverse = 1.0 / det;
        h[q] = fem_gradient(fem_bilinear_at(&u, xi, eta), j, inverse);
        ratio[q] = det0 * inverse;
#if RINGS
        const lanes r_start = fem_radius_at(radius, &x, PLACE[q]), r_end = fem_radius_at(now, &y, PLACE[q]),
                    hoop = (r_end - r_start) / r_start;
        const lanes round = fem_circumference(r_start), off[2] = {xi - middle[0], eta - middle[1]}, part = 4.0 * round * ratio[q];
        over[0] += part * off[0] * off[0];
        over[1] += part * off[0] * off[1];
        over[2] += part * off[1] * off[1];
        lanes_store(block->hoop[q] + first, hoop);
        lanes_store(block->volume0[q] + first, round * det);
        lanes_store(block->volume[q] + first, fem_circumference(r_end) * end);
#else
        same += ratio[q];
        mixed += (xi * eta > 0 ? 1.0 : -1.0) * ratio[q];
        lanes_store(block->volume0[q] + first, det);
        lanes_store(block->volume[q] + first, end);
#endif
        area += end;
        /* what the modes feel: the stress that an elastic element without them would gain, and what was left over */
        const lanes exx = cosine * h[q].xx + sine * h[q].yx - below, eyy = cosine * h[q].yy - sine * h[q].xy - below;
        const lanes exy = cosine * (h[q].xy + h[q].yx) + sine * (h[q].yy - h[q].xx);
#if RINGS
        const lanes pressure = lambda * (exx + eyy + hoop);
#else
        const lanes pressure = lambda * (exx + eyy);
#endif
        const lanes xx = pressure + 2 * mu * exx + RETURN * lanes_load(block->stress[q][0] + first);
        const lanes yy = pressure + 2 * mu * eyy + RETURN * lanes_load(block->stress[q][1] + first);
        const lanes xy = mu * exy + RETURN * lanes_load(block->stress[q][3] + first);
        for (int m = 0; m < 2; m++) {
#if RINGS
            const lanes w = -2 * off[m] * det0 * round;
#else
            const lanes w = (-2 * PLACE[q][m]) * det0;
#endif
            r[2 * m] -= w * (xx * gx[m] + xy * gy[m]);
            r[2 * m + 1] -= w * (xy * gx[m] + yy * gy[m]);
        }
    }
    /* stiffness of the modes: 4 det0 (sum of xi_m xi_n J0/J) (lambda g_m g_n^T + mu (g_n g_m^T + g_m.g_n I)) */
    lanes k[4][4];
    for (int m = 0; m < 2; m++)
        for (int n = 0; n <= m; n++) {
#if RINGS
            const lanes w = det0 * over[m + n], dot = mu * (gx[m] * gx[n] + gy[m] * gy[n]);
#else
            const lanes w = 4.0 / 3.0 * det0 * (m == n ? same : mixed), dot = mu * (gx[m] * gx[n] + gy[m] * gy[n]);
#endif
            k[2 * m][2 * n] = w * ((lambda + mu) * gx[m] * gx[n] + dot);
            k[2 * m + 1][2 * n + 1] = w * ((lambda + mu) * gy[m] * gy[n] + dot);
            k[2 * m + 1][2 * n] = w * (lambda * gy[m] * gx[n] + mu * gx[m] * gy[n]);
            if (m != n) k[2 * m][2 * n + 1] = w * (lambda * gx[m] * gy[n] + mu * gy[m] * gx[n]);
        }
    solve_modes(k, r);
    for (int m = 0; m < 4; m += 2) { /* and turned with the element */
        const lanes x_ = r[m], y_ = r[m + 1];
        r[m] = cosine * x_ - sine * y_;
        r[m + 1] = sine * x_ + cosine * y_;
    }
    for (int q = 0; q < 4; q++) {
#if RINGS
        const lanes a = -2 * (PLACE[q][0] - middle[0]) * ratio[q], b = -2 * (PLACE[q][1] - middle[1]) * ratio[q];
#else
        const lanes a = (-2 * PLACE[q][0]) * ratio[q], b = (-2 * PLACE[q][1]) * ratio[q];
#endif
        lanes_store(block->h[q][0] + first, h[q].xx + a * r[0] * gx[0] + b * r[2] * gx[1]);
        lanes_store(block->h[q][1] + first, h[q].xy + a * r[0] * gy[0] + b * r[2] * gy[1]);
        lanes_store(block->h[q][2] + first, h[q].yx + a * r[1] * gx[0] + b * r[3] * gx[1]);
        lanes_store(block->h[q][3] + first, h[q].yy + a * r[1] * gy[0] + b * r[3] * gy[1]);
    }
    lanes_store(block->jacobian + first, fem_relative_jacobian(fem_bilinear_lowest(&y), area));
    lanes_store(block->control_work + first, (lanes){0});
    lanes_store(block->control_first + first, (lanes){0});
}

void NAME(strain)(fem_block *block, const fem_elastic *elastic, bool f_bar, double hourglass) {
    (void)f_bar, (void)hourglass; /* free of locking as it is */
    for (int first = 0; first < 8; first += LANES) strain(block, elastic, first);
}

void NAME(force)(fem_block *block, bool f_bar) {
    (void)f_bar;
#if RINGS
    fem_q4_force_rings(block, false);
#else
    fem_q4_force(block, false);
#endif
}
