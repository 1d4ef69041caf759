/* element_q4.c: the quadrilateral with four nodes and 2 x 2 Gauss points, with or without mean dilatation; in the plane and, compiled once more with RINGS, as a ring
 * about the axis x = 0: volumes times 2 pi r, and hoops that stretch by u_r/r. */
#include <math.h>

#include "fem/element_inner.h"

#ifndef RINGS
#define RINGS 0
#endif
#if RINGS
#define NAME(f) fem_q4_##f##_rings
#else
#define NAME(f) fem_q4_##f
#endif

static const double PLACE[4][2] = {
    {-FEM_GAUSS_2, -FEM_GAUSS_2}, {FEM_GAUSS_2, -FEM_GAUSS_2}, {-FEM_GAUSS_2, FEM_GAUSS_2}, {FEM_GAUSS_2, FEM_GAUSS_2}};

/* I + Hbar = (Jbar/J)^(1/2) (I + H) with J = det(I + H), Jbar its average over the volume at the start (de Souza Neto et al. 1996; in
 * plane strain the exponent is 1/2, with hoops 1/3, and the volume that is averaged that of the step). Written with J - 1, which small steps need. */
static void average_dilatation(fem_block *block, int first) {
    lanes volume0 = {0}, change = {0}, dilatation[4];
    for (int q = 0; q < 4; q++) {
        const lanes v = lanes_load(block->volume0[q] + first), xx = lanes_load(block->h[q][0] + first),
                    xy = lanes_load(block->h[q][1] + first), yx = lanes_load(block->h[q][2] + first),
                    yy = lanes_load(block->h[q][3] + first);
        dilatation[q] = xx + yy + (xx * yy - xy * yx);
#if RINGS
        const lanes hoop = lanes_load(block->hoop[q] + first);
        dilatation[q] += hoop + dilatation[q] * hoop;
#endif
        volume0 += v;
        change += v * dilatation[q];
    }
    const lanes average = change / volume0;
    for (int q = 0; q < 4; q++) {
        const lanes d = (average - dilatation[q]) / (1.0 + dilatation[q]);
#if RINGS
        lanes root;
        for (int l = 0; l < LANES; l++) root[l] = cbrt(1.0 + d[l]);
        const lanes e = d / (1.0 + root + root * root), hoop = lanes_load(block->hoop[q] + first);
        lanes_store(block->hoop[q] + first, hoop + e * hoop + e);
#else
        const lanes e = d / (1.0 + lanes_root(1.0 + d));
#endif
        for (int c = 0; c < 4; c++) {
            const lanes h = lanes_load(block->h[q][c] + first);
            lanes_store(block->h[q][c] + first, h + e * h + (c == 0 || c == 3 ? e : (lanes){0}));
        }
    }
}

static inline void strain(fem_block *block, bool f_bar, int first) {
    const fem_bilinear x = fem_bilinear_of(block->start, NULL, first), u = fem_bilinear_of(block->end, block->start, first),
                       y = fem_bilinear_sum(&x, &u, 1);
    lanes area = {0};
    for (int q = 0; q < 4; q++) {
        const fem_jacobian j = fem_bilinear_at(&x, PLACE[q][0], PLACE[q][1]);
        const lanes det = fem_det(j), end = fem_det(fem_bilinear_at(&y, PLACE[q][0], PLACE[q][1]));
        const fem_jacobian h = fem_gradient(fem_bilinear_at(&u, PLACE[q][0], PLACE[q][1]), j, 1.0 / det);
        lanes_store(block->h[q][0] + first, h.xx);
        lanes_store(block->h[q][1] + first, h.xy);
        lanes_store(block->h[q][2] + first, h.yx);
        lanes_store(block->h[q][3] + first, h.yy);
#if RINGS
        const lanes r0 = fem_radius_at(fem_radius_centre(block->start, first), &x, PLACE[q]),
                    r1 = fem_radius_at(fem_radius_centre(block->end, first), &y, PLACE[q]);
        lanes_store(block->hoop[q] + first, (r1 - r0) / r0);
        lanes_store(block->volume0[q] + first, fem_circumference(r0) * det);
        lanes_store(block->volume[q] + first, fem_circumference(r1) * end);
#else
        lanes_store(block->volume0[q] + first, det);
        lanes_store(block->volume[q] + first, end);
#endif
        area += end;
    }
    lanes_store(block->jacobian + first, fem_relative_jacobian(fem_bilinear_lowest(&y), area));
    lanes_store(block->control_work + first, (lanes){0});
    lanes_store(block->control_first + first, (lanes){0});
    if (f_bar) average_dilatation(block, first);
}

/* With mean dilatation f_a = sum V_q G_a (sigma - p I) + (sum V_q p_q) Gbar_a, Gbar the average of G over the volume, p = (sxx + syy)/2:
 * the same as the force of stresses whose p is the average one. */
static inline void force(fem_block *block, bool f_bar, int first) {
    const fem_bilinear y = fem_bilinear_of(block->end, NULL, first);
    fem_bilinear sum = {.a = {{0}}};
    lanes mean = {0};
#if RINGS
    const lanes centre = fem_radius_centre(block->end, first);
    lanes all = {0};
#endif
    if (f_bar) {
        lanes volume = {0}, pressure = {0};
        for (int q = 0; q < 4; q++) {
#if RINGS
            const lanes v = fem_det(fem_bilinear_at(&y, PLACE[q][0], PLACE[q][1])) * fem_circumference(fem_radius_at(centre, &y, PLACE[q]));
            pressure += v * lanes_load(block->stress[q][2] + first);
#else
            const lanes v = fem_det(fem_bilinear_at(&y, PLACE[q][0], PLACE[q][1]));
#endif
            volume += v;
            pressure += v * (lanes_load(block->stress[q][0] + first) + lanes_load(block->stress[q][1] + first));
        }
#if RINGS
        mean = (1.0 / 3.0) * pressure / volume;
#else
        mean = 0.5 * pressure / volume;
#endif
    }
    for (int q = 0; q < 4; q++) {
        lanes xx = lanes_load(block->stress[q][0] + first), yy = lanes_load(block->stress[q][1] + first);
#if RINGS /* 2 pi r det J (sigma : G + s_tt N/r): the radius cancels in the second */
        lanes xy = lanes_load(block->stress[q][3] + first), zz = lanes_load(block->stress[q][2] + first);
        if (f_bar) {
            const lanes shift = mean - (1.0 / 3.0) * (xx + yy + zz);
            xx += shift, yy += shift, zz += shift;
        }
        const fem_jacobian j = fem_bilinear_at(&y, PLACE[q][0], PLACE[q][1]);
        const lanes round = fem_circumference(fem_radius_at(centre, &y, PLACE[q])), hoop = fem_circumference(fem_det(j) * zz);
        xx *= round, yy *= round, xy *= round;
        all += hoop;
        sum.a[0] += PLACE[q][0] * hoop;
        sum.b[0] += PLACE[q][1] * hoop;
        sum.h[0] += PLACE[q][0] * PLACE[q][1] * hoop;
#else
        const lanes xy = lanes_load(block->stress[q][3] + first);
        if (f_bar) {
            const lanes half = 0.5 * (xx - yy);
            xx = mean + half;
            yy = mean - half;
        }
#endif
        const fem_jacobian p = fem_pull(xx, yy, xy, fem_bilinear_at(&y, PLACE[q][0], PLACE[q][1]));
        sum.a[0] += p.xx;
        sum.b[0] += p.xy;
        sum.h[0] += PLACE[q][1] * p.xx + PLACE[q][0] * p.xy;
        sum.a[1] += p.yx;
        sum.b[1] += p.yy;
        sum.h[1] += PLACE[q][1] * p.yx + PLACE[q][0] * p.yy;
    }
    fem_bilinear_force(&sum, block->force, first);
#if RINGS
    for (int k = 0; k < 4; k++) lanes_store(block->force[2 * k] + first, lanes_load(block->force[2 * k] + first) + 0.25 * all);
#endif
}

void NAME(strain)(fem_block *block, const fem_elastic *elastic, bool f_bar, double hourglass) {
    (void)elastic, (void)hourglass;
    for (int first = 0; first < 8; first += LANES) strain(block, f_bar, first);
}
void NAME(force)(fem_block *block, bool f_bar) {
    for (int first = 0; first < 8; first += LANES) force(block, f_bar, first);
}
