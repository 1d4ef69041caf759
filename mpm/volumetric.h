/* volumetric.h: f_bar where it meets the points: sums over the points of each cell, and what comes back to them. mpm/volumetric.c says what is done and why.
 * Nothing here knows the basis. Inside mpm/ only. */
#ifndef AB_MPM_VOLUMETRIC_H
#define AB_MPM_VOLUMETRIC_H

#include "mpm/batch.h"

/* The cells that the points of a block are in, by their lower left nodes in the patch. A cell lies in the stencils of its points, so it is in the patch wherever they are. */
static inline void mpm_cells_of(const mpm_body *body, const mpm_tile *tile, const double *block, int32_t cell[8]) {
    const v8 one = v8_set(1.0);
    v8 corner[2];
    for (int c = 0; c < 2; ++c)
        corner[c] = v8_floor((v8_load(block + 8 * (ROW_X + c)) - v8_set((c ? tile->ty : tile->tx) * (AB_TILE * body->h))) *
                             v8_set(body->inverse_h));
    const v8 node = (corner[1] + one) * v8_set(body->kernel->patch) + corner[0] + one;
    *(v8_int *)cell = __builtin_convertvector(node, v8_int);
    V8_IN_MEMORY(cell);
}

/* An empty patch of pairs by cells: sum of V a, sum of V. */
static inline double *mpm_cells_open(mpm_body *body, const mpm_tile *tile) {
    double *patch = body->patches + (size_t)tile->patch * mpm_patch_doubles(body);
    for (int n = 0; n < 2 * body->kernel->patch * body->kernel->patch; ++n) patch[n] = 0.0;
    return patch;
}

static inline void mpm_cells_add(const mpm_body *body, const mpm_tile *tile, const double *block, v8 a, double *patch) {
    int32_t cell[8] __attribute__((aligned(64)));
    mpm_cells_of(body, tile, block, cell);
    const v8 volume = v8_load(block + 8 * ROW_VOLUME), whole = volume * a;
    for (int l = 0; l < 8; ++l) { /* massless copies have no volume */
        patch[2 * cell[l]] += whole[l];
        patch[2 * cell[l] + 1] += volume[l];
    }
}

/* For the points of a block what a patch of pairs, their first, says of their cells. */
static inline v8 mpm_cells_mean(const mpm_body *body, const mpm_tile *tile, const double *block, const double *means) {
    int32_t cell[8] __attribute__((aligned(64)));
    mpm_cells_of(body, tile, block, cell);
    v8 mean;
    for (int l = 0; l < 8; ++l) mean[l] = means[2 * cell[l]];
    return mean;
}

/* (xx + yy)/2 of a block's stresses, what a change of volume in the plane works against; with hoops (xx + yy + zz)/3. */
static inline __attribute__((always_inline)) v8 mpm_mean_stress(const double *block, const bool axisymmetric) {
    const v8 plane = v8_load(block + 8 * ROW_STRESS) + v8_load(block + 8 * (ROW_STRESS + 1));
    return axisymmetric ? v8_set(1.0 / 3.0) * (plane + v8_load(block + 8 * (ROW_STRESS + 2))) : v8_set(0.5) * plane;
}

/* Shifts the three direct stresses alike: a difference in pressure. */
static inline __attribute__((always_inline)) void mpm_set_mean_stress(double *block, v8 mean, const bool axisymmetric) {
    const v8 shift = mean - mpm_mean_stress(block, axisymmetric);
    for (int c = 0; c < 3; ++c) v8_store(block + 8 * (ROW_STRESS + c), v8_load(block + 8 * (ROW_STRESS + c)) + shift);
}

/* d = det(I + H) - 1 of block b of a batch. */
static inline __attribute__((always_inline)) v8 mpm_dilatation(const double (*h)[LONG], uint32_t b, const bool axisymmetric) {
    const size_t at = 8 * (size_t)b;
    const v8 xx = v8_load(h[0] + at), xy = v8_load(h[1] + at), yx = v8_load(h[2] + at), yy = v8_load(h[3] + at);
    const v8 plane = xx + yy + (xx * yy - xy * yx);
    if (!axisymmetric) return plane;
    const v8 hoop = v8_load(h[4] + at);
    return plane + hoop + plane * hoop;
}

/* I + Hbar = ((1 + dbar)/(1 + d))^(1/2) (I + H), dbar what `means` says of the cell (de Souza Neto et al. 1996; in plane strain the exponent is 1/2, with hoops 1/3). Written with
 * differences, which small steps need. The points get back the mean stress that the material gave them. */
static inline __attribute__((always_inline)) void mpm_average_dilatation(const mpm_body *body, const mpm_tile *tile, const double *means,
                                                                         double *block, uint32_t blocks, double (*h)[LONG],
                                                                         const bool axisymmetric) {
    const v8 one = v8_set(1.0), zero = v8_set(0.0);
    for (uint32_t b = 0; b < blocks; ++b, block += 8 * (size_t)body->rows.count) {
        const v8 own = mpm_dilatation((const double(*)[LONG])h, b, axisymmetric);
        const v8 d = (mpm_cells_mean(body, tile, block, means) - own) / (one + own);
        v8 root, e;
        for (int l = 0; l < 8; ++l) root[l] = axisymmetric ? cbrt(1.0 + d[l]) : __builtin_sqrt(1.0 + d[l]);
        e = axisymmetric ? d / (one + root + root * root) : d / (one + root);
        for (int c = 0; c < (axisymmetric ? 5 : 4); ++c) {
            double *at = h[c] + 8 * (size_t)b;
            const v8 old = v8_load(at);
            v8_store(at, old + e * old + (c == 0 || c == 3 || c == 4 ? e : zero));
        }
        mpm_set_mean_stress(block, v8_load(block + 8 * (size_t)body->rows.mean_stress), axisymmetric);
    }
}

#endif
