/* trace_outline.c: what a finder that looks at nodes sees of a body with surface points (surface: points): the outline between them, in pieces.
 *
 * A piece from x - s to x + s is handed over as a point at x with the extent s s^T: its half size along n, sqrt(n.A.n) = |n.s|, is that of the piece, so that how far
 * the outline reaches along any direction is exact to the corner, and along the face the pieces cover all of it. */
#include <math.h>
#include <stdlib.h>

#include "mpm/outline.h"

static const double PIECE = 0.25; /* of a cell, at most: a finder takes or leaves a piece by its middle */

/* Number of the wanted node at (i, j) on the grid, -1: it is not wanted. */
static long wanted_at(const mpm_body *body, const uint32_t *nodes, size_t count, int32_t i, int32_t j) {
    const int32_t a = i & (AB_TILE - 1), b = j & (AB_TILE - 1);
    const long tile = mpm_tile_find(body->keys, body->tile_count, ab_tile_key((i - a) / AB_TILE, (j - b) / AB_TILE));
    if (tile < 0) return -1;
    const uint32_t node = (uint32_t)tile * AB_TILE_NODES + (uint32_t)(b * AB_TILE + a);
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (nodes[middle] < node)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && nodes[low] == node ? (long)low : -1;
}

static bool add(mpm_near_pieces *near, mpm_near_piece piece) {
    if (near->count == near->room) {
        const size_t more = 2 * near->room + 256;
        mpm_near_piece *list = realloc(near->list, more * sizeof *list);
        if (!list) return false;
        near->list = list;
        near->room = more;
    }
    near->list[near->count++] = piece;
    return true;
}

/* Adds the pieces of the edge from x to y for the nodes within reach (m, in each direction) of them. bounds: lowest and highest wanted node along x, along y. */
static bool add_edge(const mpm_body *body, const uint32_t *nodes, size_t count, const int32_t bounds[2][2], double reach, const double x[2],
                     const double y[2], mpm_near_pieces *near) {
    for (int c = 0; c < 2; ++c)
        if (fmax(x[c], y[c]) + reach < bounds[c][0] * body->h || fmin(x[c], y[c]) - reach > bounds[c][1] * body->h) return true;
    const double pieces = fmax(1.0, ceil(hypot(y[0] - x[0], y[1] - x[1]) / (PIECE * body->h) - 1e-9));
    const double half[2] = {0.5 * (y[0] - x[0]) / pieces, 0.5 * (y[1] - x[1]) / pieces};
    mpm_near_piece piece = {.extent = {half[0] * half[0], half[1] * half[1], half[0] * half[1]}};
    for (double k = 0.0; k < pieces; ++k) {
        int32_t from[2], to[2];
        for (int c = 0; c < 2; ++c) {
            piece.x[c] = x[c] + (2.0 * k + 1.0) * half[c];
            const double far = reach + fabs(half[c]);
            from[c] = (int32_t)fmax(ceil((piece.x[c] - far) * body->inverse_h), bounds[c][0]);
            to[c] = (int32_t)fmin(floor((piece.x[c] + far) * body->inverse_h), bounds[c][1]);
        }
        for (int32_t j = from[1]; j <= to[1]; ++j)
            for (int32_t i = from[0]; i <= to[0]; ++i) {
                const long node = wanted_at(body, nodes, count, i, j);
                if (node < 0) continue;
                piece.node = (uint32_t)node;
                if (!add(near, piece)) return false;
            }
    }
    return true;
}

bool mpm_pieces_near(mpm_body *body, const uint32_t *nodes, size_t count, mpm_near_pieces *near) {
    const mpm_loops *loops = &body->outline->loops;
    int32_t bounds[2][2] = {{INT32_MAX, INT32_MIN}, {INT32_MAX, INT32_MIN}};
    near->count = 0;
    if (!count) return true;
    for (size_t k = 0; k < count; ++k) {
        const mpm_tile *tile = body->tiles + nodes[k] / AB_TILE_NODES;
        const int32_t n = (int32_t)(nodes[k] % AB_TILE_NODES), at[2] = {tile->tx * AB_TILE + n % AB_TILE, tile->ty * AB_TILE + n / AB_TILE};
        for (int c = 0; c < 2; ++c) {
            if (at[c] < bounds[c][0]) bounds[c][0] = at[c];
            if (at[c] > bounds[c][1]) bounds[c][1] = at[c];
        }
    }
    mpm_touching_place(body, false); /* vertices that have left through a side stay where they did: no node with mass is near them */
    for (size_t k = 0; k < loops->count; ++k)
        if (!add_edge(body, nodes, count, (const int32_t(*)[2])bounds, body->kernel->reach * body->h, loops->x + 2 * k,
                      loops->x + 2 * (size_t)loops->next[k], near))
            return false;
    return true;
}
