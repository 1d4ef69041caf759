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
 * pressure on bilinear elements does; a patch takes nothing of it over. */
#include "mpm/volumetric.h"

/* What is kept of a cell, under its lower left node: the mean over its points, their volume (m2); the mean over the patch. */
enum { MEAN = 0, VOLUME = 1, PATCH_MEAN = 2 };

/* Means over the points of each cell from the sums in the patches. */
static void find_means(mpm_body *body) {
#pragma omp parallel for schedule(dynamic, 4) num_threads(body->threads)
    for (size_t k = 0; k < body->tile_count; ++k) {
        double sum[2 * AB_TILE_NODES] __attribute__((aligned(64)));
        mpm_grid_add_pairs(body, k, sum);
        double *cell = body->volumetric + k * VOLUMETRIC_RECORD * AB_TILE_NODES;
        for (int n = 0; n < AB_TILE_NODES; ++n, cell += VOLUMETRIC_RECORD) {
            cell[VOLUME] = sum[2 * n + 1];
            cell[MEAN] = cell[VOLUME] > 1e-300 ? sum[2 * n] / cell[VOLUME] : 0.0;
        }
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
    if (body->f_bar == AB_F_BAR_PATCH) spread_means(body);
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
