/* volumetric.c: f_bar, against volumetric locking: where volume is kept, every point would hold the nodes to a volume of its own, and there are more points than
 * nodes. Instead the change of volume in a step is averaged,
 *   dbar = A d,  A: by volumes over the points of each cell ("cell"), or from there to the nodes around and back to the cells ("patch"),
 * and each point is strained with dbar for its own d (volumes, domains and deformation gradients follow that strain). The nodes must feel the same average: the
 * mean stress in their forces is A q for q = (xx + yy)/2 of the points (with hoops (xx + yy + zz)/3). A is symmetric with the volumes as weights, so the forces' power is that of the strain,
 *   sum V (A q) d = sum V q (A d),
 * in every step, whatever cells the points have come from; with dbar alone, points that carry their pressure into another cell drive d - dbar there without
 * cost, and a body that moves through the grid blows up. All eigenvalues of A lie between 0 and 1: the stiffness is nowhere larger than without, nor the critical
 * step smaller.
 *
 * De Souza Neto, Peric, Dutko and Owen 1996 (F-bar; patches of elements: de Souza Neto, Pires and Owen 2005); Hughes 1980 (the same average in the forces, B-bar);
 * Coombs, Charlton, Cortis and Augarde 2018 (F-bar for material points). Cells alone leave a pressure that changes sign from cell to cell almost free, as constant
 * pressure on bilinear elements does; a patch takes nothing of it over.
 *
 * A cell that the body's edge leaves next to nothing of (a sliver) has a volume to keep, but no freedom of its own: its nodes are those of the cells behind it, or go by them
 * (light_nodes.c). Its sums go to the full cells beside it, in equal parts, before anything is averaged, and it has the mean of theirs in the end: A becomes
 * W^T A W, symmetric and no longer than what it averages as before, and a uniform change of volume is left as it is. The pressure in a thick tube is off by half as much. */
#include "mpm/volumetric.h"

/* What is kept of a cell, under its lower left node: the mean over its points, their volume (m2); the mean over the patch. */
enum { MEAN = 0, VOLUME = 1, PATCH_MEAN = 2 };

/* Of h^2, which the points of a cell within the body hold: one with less is a sliver. Of 0.15, 0.3 and 0.55 the first does nothing where a cell has four points, the last takes
 * half cells as well: a tube is better still (its pressure off by 0.051, not 0.069), a vibrating block is not (0.2, not 0.07 of what 8 cells lose is left on 16). */
static const double SLIVER = 0.3;

/* Means over the points of each cell from the sums in the patches; which cells are slivers. (In space: axisymmetric none: volumes grow with the radius.) */
static void find_means(mpm_body *body) {
    const double least = body->axisymmetric ? 0.0 : SLIVER * body->h * body->h;
#pragma omp parallel for schedule(dynamic, 4) num_threads(body->threads)
    for (size_t k = 0; k < body->tile_count; ++k) {
        double sum[2 * AB_TILE_NODES] __attribute__((aligned(64)));
        mpm_grid_add_pairs(body, k, sum);
        uint64_t slivers = 0;
        double *cell = body->volumetric + k * VOLUMETRIC_RECORD * AB_TILE_NODES;
        for (int n = 0; n < AB_TILE_NODES; ++n, cell += VOLUMETRIC_RECORD) {
            cell[VOLUME] = sum[2 * n + 1];
            cell[MEAN] = cell[VOLUME] > 1e-300 ? sum[2 * n] / cell[VOLUME] : 0.0;
            slivers |= (uint64_t)(cell[VOLUME] > 1e-300 && cell[VOLUME] < least) << n;
        }
        body->slivers[k] = slivers;
    }
}

/* The full cells beside cell n of tile k, by its sides or, where there are none, by its corners; their number. */
static int full_beside(const mpm_body *body, size_t k, int n, double *full[4]) {
    static const int ROUND[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    int count = 0;
    for (int d = 0; d < 8 && !(d == 4 && count > 0); ++d) {
        const uint32_t at = mpm_dof_beside(body, k, n, ROUND[d][0], ROUND[d][1]);
        if (at == UINT32_MAX || (body->slivers[at / AB_TILE_NODES] >> at % AB_TILE_NODES & 1)) continue;
        double *cell = body->volumetric + (size_t)at * VOLUMETRIC_RECORD;
        if (cell[VOLUME] > 1e-300) full[count++] = cell;
    }
    return count;
}

/* Slivers hand their sums on and are empty (hand_on), then take the means of those that have them (take_back). One with no full cell beside it keeps its own. */
static void hand_on(mpm_body *body) {
    for (size_t k = 0; k < body->tile_count; ++k)
        for (uint64_t bits = body->slivers[k]; bits; bits &= bits - 1) {
            const int n = __builtin_ctzll(bits);
            double *cell = body->volumetric + (k * AB_TILE_NODES + (size_t)n) * VOLUMETRIC_RECORD, *full[4];
            const int count = full_beside(body, k, n, full);
            for (int f = 0; f < count; ++f) {
                const double share = cell[VOLUME] / count;
                full[f][MEAN] += share / (full[f][VOLUME] + share) * (cell[MEAN] - full[f][MEAN]);
                full[f][VOLUME] += share;
            }
            if (count > 0) cell[VOLUME] = 0.0;
        }
}

static void take_back(mpm_body *body, int what) {
    for (size_t k = 0; k < body->tile_count; ++k)
        for (uint64_t bits = body->slivers[k]; bits; bits &= bits - 1) {
            const int n = __builtin_ctzll(bits);
            double *cell = body->volumetric + (k * AB_TILE_NODES + (size_t)n) * VOLUMETRIC_RECORD, *full[4];
            if (cell[VOLUME] > 0.0) continue;
            const int count = full_beside(body, k, n, full);
            cell[what] = 0.0;
            for (int f = 0; f < count; ++f) cell[what] += full[f][what] / count;
        }
}

/* A node has the mean over the four cells around it, by their volumes, and a cell that of its four nodes. */
static void spread_means(mpm_body *body) {
    const int size = body->kernel->patch;
#pragma omp parallel for schedule(dynamic, 4) num_threads(body->threads)
    for (size_t k = 0; k < body->tile_count; ++k) {
        double cells[2 * MPM_PATCH_MOST + 8] __attribute__((aligned(64))), node[AB_TILE + 1][AB_TILE + 1];
        mpm_grid_fetch_volumetric(body, k, MEAN, cells);
        for (int j = 0; j <= AB_TILE; ++j)
            for (int i = 0; i <= AB_TILE; ++i) {
                double whole = 0.0, volume = 0.0;
                for (int around = 0; around < 4; ++around) {
                    const double *pair = cells + 2 * ((j + around / 2) * size + i + around % 2);
                    whole += pair[MEAN] * pair[VOLUME];
                    volume += pair[VOLUME];
                }
                node[j][i] = volume > 1e-300 ? whole / volume : 0.0;
            }
        double *cell = body->volumetric + k * VOLUMETRIC_RECORD * AB_TILE_NODES;
        for (int n = 0; n < AB_TILE_NODES; ++n, cell += VOLUMETRIC_RECORD) {
            const int i = n % AB_TILE, j = n / AB_TILE;
            cell[PATCH_MEAN] = 0.25 * ((node[j][i] + node[j][i + 1]) + (node[j + 1][i] + node[j + 1][i + 1]));
        }
    }
}

static void average(mpm_body *body) {
    find_means(body);
    hand_on(body);
    if (body->f_bar == AB_F_BAR_PATCH) spread_means(body);
    take_back(body, body->f_bar == AB_F_BAR_PATCH ? PATCH_MEAN : MEAN);
}

void mpm_volumetric_fetch(const mpm_body *body, size_t tile, double *means) {
    mpm_grid_fetch_volumetric(body, tile, body->f_bar == AB_F_BAR_PATCH ? PATCH_MEAN : MEAN, means);
}

void mpm_volumetric_strain(mpm_body *body, const ab_step *step) {
#pragma omp parallel for schedule(dynamic, 1) num_threads(body->threads)
    for (size_t k = 0; k < body->tile_count; ++k)
        if (body->tiles[k].patch >= 0) body->kernel->dilate(body, k, step);
    average(body);
}

void mpm_volumetric_stress(mpm_body *body) {
    const size_t stride = 8 * (size_t)body->rows.count, own = 8 * (size_t)body->rows.mean_stress;
    const bool hoops = body->axisymmetric;
#pragma omp parallel for schedule(dynamic, 1) num_threads(body->threads)
    for (size_t k = 0; k < body->tile_count; ++k) {
        const mpm_tile *tile = body->tiles + k;
        if (tile->patch < 0) continue;
        double *patch = mpm_cells_open(body, tile), *block = mpm_block(body, tile->first);
        for (uint32_t b = 0; b < tile->blocks; ++b, block += stride) {
            const v8 mean = hoops ? mpm_mean_stress(block, true) : mpm_mean_stress(block, false);
            v8_store(block + own, mean);
            mpm_cells_add(body, tile, block, mean, patch);
        }
    }
    average(body);
#pragma omp parallel for schedule(dynamic, 1) num_threads(body->threads)
    for (size_t k = 0; k < body->tile_count; ++k) {
        const mpm_tile *tile = body->tiles + k;
        if (tile->patch < 0) continue;
        double means[2 * MPM_PATCH_MOST + 8] __attribute__((aligned(64))), *block = mpm_block(body, tile->first);
        mpm_volumetric_fetch(body, k, means);
        for (uint32_t b = 0; b < tile->blocks; ++b, block += stride) {
            const v8 mean = mpm_cells_mean(body, tile, block, means);
            if (hoops)
                mpm_set_mean_stress(block, mean, true);
            else
                mpm_set_mean_stress(block, mean, false);
        }
    }
}
