/* surface.c: what a finder that looks at surfaces sees of a material-point body: its points in given cells, each with its size and its nodes. */
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "mpm/outline.h"

enum { ROOM = 36 }; /* nodes of a point, at most: with light ones' own those of 6 x 6 */

struct mpm_surface {
    size_t capacity, count; /* points; ld of the arrays */
    double *position, *extent, *area;
    uint64_t *key;
    size_t *start;
    uint32_t *dof;
    double *weight;
    size_t tile_capacity;
    uint32_t *stamp; /* per tile: candidate in call number `call` */
    uint32_t *tiles;
    uint32_t call;
};

void mpm_surface_destroy(struct mpm_surface *s) {
    if (!s) return;
    free(s->position), free(s->extent), free(s->area), free(s->key), free(s->start), free(s->dof), free(s->weight);
    free(s->stamp), free(s->tiles), free(s);
}

static bool reserve_tiles(mpm_body *body) {
    if (!body->surface) body->surface = calloc(1, sizeof *body->surface);
    struct mpm_surface *s = body->surface;
    if (!s) return false;
    if (body->tile_count <= s->tile_capacity) return true;
    const size_t n = 2 * body->tile_count;
    if (!ab_memory_resize(&s->stamp, n, sizeof *s->stamp) || !ab_memory_resize(&s->tiles, n, sizeof *s->tiles)) return false;
    for (size_t k = 0; k < n; ++k) s->stamp[k] = 0;
    s->call = 0;
    s->tile_capacity = n;
    return true;
}

/* Room for eight points more than there are. Rows move apart when the arrays grow. */
static bool reserve_points(struct mpm_surface *s) {
    const size_t old = s->capacity;
    if (s->count + 8 <= old) return true;
    const size_t n = (2 * s->count + 64) / 8 * 8;
    if (!ab_memory_resize(&s->position, 2 * n, sizeof(double)) || !ab_memory_resize(&s->extent, 3 * n, sizeof(double)) ||
        !ab_memory_resize(&s->area, n, sizeof(double)) || !ab_memory_resize(&s->key, n, sizeof *s->key) ||
        !ab_memory_resize(&s->start, n + 1, sizeof *s->start) || !ab_memory_resize(&s->dof, ROOM * n, sizeof *s->dof) ||
        !ab_memory_resize(&s->weight, ROOM * n, sizeof(double)))
        return false;
    for (size_t i = s->count; i-- > 0;) s->position[n + i] = s->position[old + i];
    for (size_t row = 2; row > 0; --row)
        for (size_t i = s->count; i-- > 0;) s->extent[row * n + i] = s->extent[row * old + i];
    s->capacity = n;
    return true;
}

static int compare_numbers(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* The tiles whose points may lie in the region's cells: those of the region and the eight around each, where the body has them. Ascending. A body lists the
 * neighbours of every tile with points, so a tile of the region that it does not list has no points near it. */
static size_t candidate_tiles(mpm_body *body, const ab_region *region) {
    struct mpm_surface *s = body->surface;
    ++s->call;
    size_t tiles = 0;
    for (size_t k = 0; k < region->count; ++k) {
        const long at = region->cells[k] ? mpm_tile_find(body->keys, body->tile_count, region->key[k]) : -1;
        if (at < 0) continue;
        for (int d = 0; d < 9; ++d) {
            const int32_t near = body->tiles[at].around[d];
            if (near < 0 || body->tiles[near].patch < 0 || s->stamp[near] == s->call) continue;
            s->stamp[near] = s->call;
            s->tiles[tiles++] = (uint32_t)near;
        }
    }
    qsort(s->tiles, tiles, sizeof *s->tiles, compare_numbers);
    return tiles;
}

/* The region's cells around a tile, its own from (1, 1) on, as places in a patch; the bounds of their corners in m. False: none. */
static bool cells_around(const mpm_body *body, const mpm_tile *tile, const ab_region *region, bool wanted[MPM_PATCH_MOST], double low[2],
                         double high[2]) {
    const int patch = body->kernel->patch;
    int first[2] = {patch, patch}, last[2] = {-1, -1};
    for (int i = 0; i < patch * patch; ++i) wanted[i] = false;
    for (int d = 0; d < 9; ++d) {
        const int dx = d % 3 - 1, dy = d / 3 - 1;
        const long at = mpm_tile_find(region->key, region->count, ab_tile_key(tile->tx + dx, tile->ty + dy));
        if (at < 0) continue;
        for (uint64_t bits = region->cells[at]; bits; bits &= bits - 1) {
            const int bit = __builtin_ctzll(bits), i = bit % AB_TILE + dx * AB_TILE + 1, j = bit / AB_TILE + dy * AB_TILE + 1;
            if (i < 0 || j < 0 || i >= patch || j >= patch) continue;
            wanted[j * patch + i] = true;
            if (i < first[0]) first[0] = i;
            if (j < first[1]) first[1] = j;
            if (i > last[0]) last[0] = i;
            if (j > last[1]) last[1] = j;
        }
    }
    for (int c = 0; c < 2; ++c) { /* wider by more than the rounding of a point's cell */
        const int corner = (c ? tile->ty : tile->tx) * AB_TILE - 1;
        low[c] = (corner + first[c] - 0.01) * body->h;
        high[c] = (corner + last[c] + 1.01) * body->h;
    }
    return last[0] >= 0;
}

/* Adds the point in lane l of a block. Weights are the basis' own: they add up to 1, and a node with weight has mass. */
static void add_point(mpm_body *body, const mpm_tile *tile, const double *block, int l, uint64_t id, const mpm_stencils *w) {
    struct mpm_surface *s = body->surface;
    const size_t to = s->count++, ld = s->capacity;
    const int nodes = body->kernel->nodes;
    for (size_t c = 0; c < 2; ++c) s->position[c * ld + to] = block[8 * (ROW_X + c) + (size_t)l];
    for (size_t c = 0; c < 3; ++c) /* kept where a finder of the scene needs them */
        s->extent[c * ld + to] = body->rows.extent >= 0 ? block[8 * ((size_t)body->rows.extent + c) + (size_t)l] : 0.0;
    s->area[to] = sqrt(block[8 * ROW_VOLUME + l]);
    if (body->axisymmetric)
        s->area[to] /= sqrt(ab_circumference(block[8 * ROW_X + l] + body->origin[0])); /* in the plane, as all finders see it */
    s->key[to] = id + 1;
    size_t at = s->start[to];
    double sum = 0.0;
    for (int j = 0; j < nodes; ++j)
        for (int i = 0; i < nodes; ++i) {
            const double value = w->value[j * nodes + i][l];
            if (!(value > 0.0)) continue;
            const uint32_t dof = mpm_dof_of(body, tile, w->node[l] + j * body->kernel->patch + i);
            if (!(body->own[(size_t)dof * OWN_RECORD + OWN_MASS] > 0.0)) continue;
            s->dof[at] = dof;
            s->weight[at++] = value;
            sum += value;
        }
    for (size_t k = s->start[to]; k < at; ++k) s->weight[k] /= sum;
    at = s->start[to] + mpm_light_expand(body, s->dof + s->start[to], s->weight + s->start[to], at - s->start[to]);
    s->start[to + 1] = at;
    if (at == s->start[to]) --s->count; /* it has no mass that a node could hold */
}

ab_status mpm_surface_points(ab_domain *domain, const ab_region *region, ab_surface *surface, ab_report *report) {
    mpm_body *body = (mpm_body *)domain;
    if (body->outline && body->outline->touching) return mpm_touching_points(body, region, surface, report);
    if (!reserve_tiles(body)) goto no_memory;
    struct mpm_surface *s = body->surface;
    s->count = 0;
    if (!reserve_points(s)) goto no_memory;
    s->start[0] = 0;
    const size_t tiles = candidate_tiles(body, region);
    const int patch = body->kernel->patch;
    for (size_t k = 0; k < tiles; ++k) {
        const mpm_tile *tile = body->tiles + s->tiles[k];
        bool wanted[MPM_PATCH_MOST];
        double low[2], high[2];
        if (!cells_around(body, tile, region, wanted, low, high)) continue;
        for (uint32_t b = tile->first; b < tile->first + tile->blocks; ++b) {
            const double *block = mpm_block(body, b);
            const v8 x = v8_load(block + 8 * ROW_X), y = v8_load(block + 8 * (ROW_X + 1));
            const v8_mask inside = (x > low[0]) & (x < high[0]) & (y > low[1]) & (y < high[1]);
            bool weighed = false;
            mpm_stencils w;
            for (int l = 0; l < 8; ++l) {
                if (!inside[l] || body->ids[b * 8 + (size_t)l] == UINT64_MAX) continue;
                const int i = (int)floor(x[l] * body->inverse_h) - tile->tx * AB_TILE + 1,
                          j = (int)floor(y[l] * body->inverse_h) - tile->ty * AB_TILE + 1;
                if (i < 0 || j < 0 || i >= patch || j >= patch || !wanted[j * patch + i]) continue;
                if (!weighed) {
                    if (!reserve_points(s)) goto no_memory;
                    body->kernel->stencils(body, tile, block, &w);
                    weighed = true;
                }
                add_point(body, tile, block, l, body->ids[b * 8 + (size_t)l], &w);
            }
        }
    }
    surface->point_count = s->count;
    surface->point_ld = s->capacity;
    surface->point_position = s->position;
    surface->point_extent = s->extent;
    surface->point_area = s->area;
    surface->point_key = s->key;
    surface->point_start = s->start;
    surface->point_dof = s->dof;
    surface->point_weight = s->weight;
    return AB_OK;
no_memory:
    return ab_report_failure(report, "body '%s': no memory for its points near another body", domain->spec->name);
}
