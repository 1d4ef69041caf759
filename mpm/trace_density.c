/* trace_density.c: slopes of a material-point body's density at nodes (core/density.h). A point reaches two cells, half a cell further than any basis, so that
 * the stencils of the trace do not do. Asked for only by finders that use it. */
#include <string.h>

#include "core/density.h"
#include "mpm/body.h"

enum {
    BELOW = 4,
    WIDE = AB_TILE + 8
}; /* nodes left of a tile and below it that its points can reach, some drift included; across all of them */

void mpm_trace_density(const mpm_body *body, const mpm_tile *tile, const uint32_t *nodes, size_t count, double *gradient, size_t ld) {
    uint32_t wanted[WIDE * WIDE];
    if (!mpm_trace_wanted(tile, BELOW, WIDE, nodes, count, wanted)) return;
    const double scale = body->inverse_h * body->inverse_h * body->inverse_h; /* a density, by the cell's size */
    const int32_t corner[2] = {tile->tx * AB_TILE - BELOW, tile->ty * AB_TILE - BELOW};
    for (uint32_t b = 0; b < tile->blocks; ++b) {
        const double *block = mpm_block(body, tile->first + b);
        for (int l = 0; l < 8; ++l) {
            const double round = body->axisymmetric ? ab_circumference(block[8 * ROW_X + l] + body->origin[0]) : 1.0;
            const double m = scale * block[8 * ROW_MASS + l] / round;
            const double s[2] = {block[8 * ROW_X + l] * body->inverse_h - corner[0],
                                 block[8 * (ROW_X + 1) + l] * body->inverse_h - corner[1]};
            const int i0 = (int)floor(s[0]) - 1, j0 = (int)floor(s[1]) - 1; /* of the sixteen nodes it reaches */
            if (!(m > 0.0) || i0 < 0 || j0 < 0 || i0 + 3 >= WIDE || j0 + 3 >= WIDE) continue;
            double slope[2][4], mean[2][4];
            for (int k = 0; k < 4; ++k) {
                ab_density_pair(s[0] - (i0 + k), &slope[0][k], &mean[0][k]);
                ab_density_pair(s[1] - (j0 + k), &slope[1][k], &mean[1][k]);
            }
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < 4; ++i) {
                    const uint32_t at = wanted[(j0 + j) * WIDE + i0 + i];
                    if (!at) continue;
                    gradient[at - 1] += m * slope[0][i] * mean[1][j];
                    gradient[ld + at - 1] += m * mean[0][i] * slope[1][j];
                }
        }
    }
}
