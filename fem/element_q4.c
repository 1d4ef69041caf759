/* element_q4.c: the quadrilateral with four nodes and 2 x 2 Gauss points, with or without mean dilatation. */
#include <math.h>

#include "fem/element_inner.h"

static const double PLACE[4][2] = {
    {-FEM_GAUSS_2, -FEM_GAUSS_2}, {FEM_GAUSS_2, -FEM_GAUSS_2}, {-FEM_GAUSS_2, FEM_GAUSS_2}, {FEM_GAUSS_2, FEM_GAUSS_2}};

/* I + Hbar = (Jbar/J)^(1/2) (I + H) with J = det(I + H), Jbar its average over the volume at the start (de Souza Neto et al. 1996; in plane strain the
 * exponent is 1/2, and the volume that is averaged that of the step). Written with J - 1, which small steps need. */
static void average_dilatation(fem_block *block) {
    v8 volume0 = {0}, change = {0}, dilatation[4];
    for (int q = 0; q < 4; q++) {
        const v8 v = v8_load(block->volume0[q]), xx = v8_load(block->h[q][0]), xy = v8_load(block->h[q][1]), yx = v8_load(block->h[q][2]),
                 yy = v8_load(block->h[q][3]);
        dilatation[q] = xx + yy + (xx * yy - xy * yx);
        volume0 += v;
        change += v * dilatation[q];
    }
    const v8 average = change / volume0;
    for (int q = 0; q < 4; q++) {
        const v8 d = (average - dilatation[q]) / (1.0 + dilatation[q]);
        v8 root;
        for (int l = 0; l < 8; l++) root[l] = sqrt(1.0 + d[l]);
        const v8 e = d / (1.0 + root);
        for (int c = 0; c < 4; c++) {
            const v8 h = v8_load(block->h[q][c]);
            v8_store(block->h[q][c], h + e * h + (c == 0 || c == 3 ? e : (v8){0}));
        }
    }
}

void fem_q4_strain(fem_block *block, const fem_elastic *elastic, bool f_bar, double hourglass) {
    (void)elastic, (void)hourglass;
    const fem_bilinear x = fem_bilinear_of(block->start, NULL), u = fem_bilinear_of(block->end, block->start),
                       y = fem_bilinear_sum(&x, &u, 1);
    v8 area = {0};
    for (int q = 0; q < 4; q++) {
        const fem_jacobian j = fem_bilinear_at(&x, PLACE[q][0], PLACE[q][1]);
        const v8 det = fem_det(j), end = fem_det(fem_bilinear_at(&y, PLACE[q][0], PLACE[q][1]));
        const fem_jacobian h = fem_gradient(fem_bilinear_at(&u, PLACE[q][0], PLACE[q][1]), j, 1.0 / det);
        v8_store(block->h[q][0], h.xx);
        v8_store(block->h[q][1], h.xy);
        v8_store(block->h[q][2], h.yx);
        v8_store(block->h[q][3], h.yy);
        v8_store(block->volume0[q], det);
        v8_store(block->volume[q], end);
        area += end;
    }
    v8_store(block->jacobian, fem_relative_jacobian(fem_bilinear_lowest(&y), area));
    v8_store(block->control_work, (v8){0});
    if (f_bar) average_dilatation(block);
}

/* With mean dilatation f_a = sum V_q G_a (sigma - p I) + (sum V_q p_q) Gbar_a, Gbar the average of G over the volume, p = (sxx + syy)/2: the same as the force of
 * stresses whose p is the average one. */
void fem_q4_force(fem_block *block, bool f_bar) {
    const fem_bilinear y = fem_bilinear_of(block->end, NULL);
    fem_bilinear sum = {.a = {{0}}};
    v8 mean = {0};
    if (f_bar) {
        v8 volume = {0}, force = {0};
        for (int q = 0; q < 4; q++) {
            const v8 v = fem_det(fem_bilinear_at(&y, PLACE[q][0], PLACE[q][1]));
            volume += v;
            force += v * (v8_load(block->stress[q][0]) + v8_load(block->stress[q][1]));
        }
        mean = 0.5 * force / volume;
    }
    for (int q = 0; q < 4; q++) {
        v8 xx = v8_load(block->stress[q][0]), yy = v8_load(block->stress[q][1]);
        const v8 xy = v8_load(block->stress[q][3]);
        if (f_bar) {
            const v8 half = 0.5 * (xx - yy);
            xx = mean + half;
            yy = mean - half;
        }
        const fem_jacobian p = fem_pull(xx, yy, xy, fem_bilinear_at(&y, PLACE[q][0], PLACE[q][1]));
        sum.a[0] += p.xx;
        sum.b[0] += p.xy;
        sum.h[0] += PLACE[q][1] * p.xx + PLACE[q][0] * p.xy;
        sum.a[1] += p.yx;
        sum.b[1] += p.yy;
        sum.h[1] += PLACE[q][1] * p.yx + PLACE[q][0] * p.yy;
    }
    fem_bilinear_force(&sum, block->force);
}
