/* trace.c: what a contact finder sees of a material-point body at the nodes it shares with another: mass, gradients, and the points near each node. */
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/node_list.h"
#include "mpm/outline.h"

typedef struct near_point {
    uint32_t node;
    uint32_t slot;
} near_point;

enum { TIED = sizeof(((mpm_tie *)0)->to) / sizeof(uint32_t) }; /* nodes that a light one goes by, at most */

struct mpm_trace {
    ab_node_list list;
    size_t entry_capacity, tile_capacity;
    near_point *entries;
    mpm_near_pieces pieces; /* of the outline, where that is what touches */
    uint32_t *stamp;        /* per tile: candidate in call number stamp */
    uint32_t *tile_list;
    uint32_t call;
};

void mpm_trace_destroy(struct mpm_trace *t) {
    if (!t) return;
    ab_node_list_clear(&t->list);
    free(t->entries), free(t->stamp), free(t->tile_list), free(t->pieces.list), free(t);
}

static bool reserve(mpm_body *body, size_t count, uint32_t needs) {
    if (!body->trace) body->trace = calloc(1, sizeof *body->trace);
    struct mpm_trace *t = body->trace;
    if (!t) return false;
    if (body->tile_count > t->tile_capacity) {
        const size_t n = body->tile_count * 2;
        if (!ab_memory_resize(&t->stamp, n, sizeof *t->stamp) || !ab_memory_resize(&t->tile_list, n, sizeof *t->tile_list)) return false;
        memset(t->stamp, 0, n * sizeof *t->stamp);
        t->tile_capacity = n;
        t->call = 0;
    }
    return ab_node_list_reserve(&t->list, count, needs) && ab_node_list_reserve_stencil(&t->list, TIED * count);
}

/* The tiles whose points can reach a wanted node: its own and the eight around it. Ascending. */
static int compare_numbers(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}
static size_t candidate_tiles(mpm_body *body, const uint32_t *nodes, size_t count) {
    struct mpm_trace *t = body->trace;
    ++t->call;
    size_t tiles = 0;
    for (size_t k = 0; k < count; ++k) {
        if (k && nodes[k] / AB_TILE_NODES == nodes[k - 1] / AB_TILE_NODES) continue;
        const mpm_tile *home = body->tiles + nodes[k] / AB_TILE_NODES;
        for (int s = 0; s < 9; ++s) {
            const int32_t near = home->around[s];
            if (near < 0 || body->tiles[near].patch < 0 || t->stamp[near] == t->call) continue;
            t->stamp[near] = t->call;
            t->tile_list[tiles++] = (uint32_t)near;
        }
    }
    qsort(t->tile_list, tiles, sizeof *t->tile_list, compare_numbers);
    return tiles;
}

bool mpm_trace_wanted(const mpm_tile *tile, int before, int width, const uint32_t *nodes, size_t count, uint32_t *wanted) {
    memset(wanted, 0, (size_t)(width * width) * sizeof *wanted);
    bool any = false;
    for (int s = 0; s < 9; ++s) {
        if (tile->around[s] < 0) continue;
        const uint32_t first = (uint32_t)tile->around[s] * AB_TILE_NODES;
        size_t low = 0, high = count;
        while (low < high) {
            const size_t middle = (low + high) / 2;
            if (nodes[middle] < first)
                low = middle + 1;
            else
                high = middle;
        }
        for (; low < count && nodes[low] < first + AB_TILE_NODES; ++low) {
            const int n = (int)(nodes[low] - first), i = n % AB_TILE + (s % 3 - 1) * AB_TILE + before,
                      j = n / AB_TILE + (s / 3 - 1) * AB_TILE + before;
            if (i < 0 || j < 0 || i >= width || j >= width) continue;
            wanted[j * width + i] = (uint32_t)low + 1;
            any = true;
        }
    }
    return any;
}

/* Gradients at the wanted nodes and the list of points near them, from one tile's points. */
static bool look_at_tile(mpm_body *body, const mpm_tile *tile, const uint32_t wanted[MPM_PATCH_MOST], uint32_t needs, size_t *entries) {
    struct mpm_trace *t = body->trace;
    const int nodes = body->kernel->nodes, patch = body->kernel->patch;
    const size_t ld = t->list.capacity;
    bool reached[MPM_PATCH_MOST] = {false};             /* by the stencil that begins here */
    double low[2] = {patch, patch}, high[2] = {-1, -1}; /* bounds of the wanted nodes, then of the points that can reach them, m */
    for (int n = 0; n < patch * patch; ++n) {
        if (!wanted[n]) continue;
        for (int j = 0; j < nodes && j <= n / patch; ++j)
            for (int i = 0; i < nodes && i <= n % patch; ++i) reached[n - j * patch - i] = true;
        const double at[2] = {n % patch - 1, n / patch - 1};
        for (int c = 0; c < 2; ++c) {
            if (at[c] < low[c]) low[c] = at[c];
            if (at[c] > high[c]) high[c] = at[c];
        }
    }
    for (int c = 0; c < 2; ++c) {
        const double corner = (c ? tile->ty : tile->tx) * AB_TILE, farthest = body->kernel->reach;
        low[c] = (corner + low[c] - farthest) * body->h;
        high[c] = (corner + high[c] + farthest) * body->h;
    }
    for (uint32_t b = 0; b < tile->blocks; ++b) {
        const double *block = mpm_block(body, tile->first + b);
        const v8 x = v8_load(block + 8 * ROW_X), y = v8_load(block + 8 * (ROW_X + 1));
        const v8_mask inside = (x > low[0]) & (x < high[0]) & (y > low[1]) & (y < high[1]);
        int64_t any = 0;
        for (int l = 0; l < 8; ++l) any |= inside[l];
        if (!any) continue;
        mpm_stencils w;
        body->kernel->stencils(body, tile, block, &w);
        for (int l = 0; l < 8; ++l) {
            if (!reached[w.node[l]]) continue;
            const uint32_t slot = (tile->first + b) * 8 + (uint32_t)l;
            if (body->ids[slot] == UINT64_MAX) continue;
            if (*entries + MPM_STENCIL > t->entry_capacity) {
                const size_t more = 2 * t->entry_capacity + 1024;
                if (!ab_memory_resize(&t->entries, more, sizeof *t->entries)) return false;
                t->entry_capacity = more;
            }
            const double round =
                body->axisymmetric ? 1.0 / ab_circumference(x[l] + body->origin[0]) : 1.0; /* normals are those of the plane */
            const double mass = block[8 * ROW_MASS + l] * round, volume = block[8 * ROW_VOLUME + l] * round;
            for (int j = 0; j < nodes; ++j)
                for (int i = 0; i < nodes; ++i) {
                    const uint32_t at = wanted[w.node[l] + j * patch + i];
                    if (!at) continue;
                    const int k = j * nodes + i;
                    const double value = w.value[k][l], gx = w.gx[k][l], gy = w.gy[k][l];
                    t->list.mass_gradient[at - 1] += mass * gx;
                    t->list.mass_gradient[ld + at - 1] += mass * gy;
                    t->list.area_vector[at - 1] += volume * gx;
                    t->list.area_vector[ld + at - 1] += volume * gy;
                    if ((needs & AB_NEED_NEAR_POINTS) && value > 0.0) t->entries[(*entries)++] = (near_point){at - 1, slot};
                }
        }
    }
    return true;
}

/* The points near each node, one node after the other. Where a body touches by its own outline, its points have no size, and the outline's pieces follow them. */
static bool list_near(mpm_body *body, const uint32_t *nodes, size_t count, size_t entries) {
    struct mpm_trace *t = body->trace;
    const bool outline = body->outline && body->outline->touching;
    if (outline && !mpm_pieces_near(body, nodes, count, &t->pieces)) return false;
    const size_t pieces = outline ? t->pieces.count : 0;
    if (!ab_node_list_reserve_near(&t->list, entries + pieces)) return false;
    memset(t->list.near_start, 0, (count + 1) * sizeof *t->list.near_start); /* counting sort by node keeps the order of tiles and points */
    for (size_t e = 0; e < entries; ++e) ++t->list.near_start[t->entries[e].node + 1];
    for (size_t e = 0; e < pieces; ++e) ++t->list.near_start[t->pieces.list[e].node + 1];
    for (size_t k = 0; k < count; ++k) t->list.near_start[k + 1] += t->list.near_start[k];
    for (size_t e = 0; e < entries; ++e) {
        const size_t to = t->list.near_start[t->entries[e].node]++;
        const double *point = mpm_block(body, t->entries[e].slot / 8) + t->entries[e].slot % 8;
        for (size_t c = 0; c < 2; ++c) t->list.near_position[c * t->list.near_capacity + to] = point[8 * (ROW_X + c)];
        for (size_t c = 0; c < 3; ++c)
            t->list.near_extent[c * t->list.near_capacity + to] = outline ? 0.0 : point[8 * ((size_t)body->rows.extent + c)];
    }
    for (size_t e = 0; e < pieces; ++e) {
        const mpm_near_piece *piece = t->pieces.list + e;
        const size_t to = t->list.near_start[piece->node]++;
        for (size_t c = 0; c < 2; ++c) t->list.near_position[c * t->list.near_capacity + to] = piece->x[c];
        for (size_t c = 0; c < 3; ++c) t->list.near_extent[c * t->list.near_capacity + to] = piece->extent[c];
    }
    for (size_t k = count; k > 0; --k) t->list.near_start[k] = t->list.near_start[k - 1];
    t->list.near_start[0] = 0;
    return true;
}

/* Of the mass of a node that is not light: a light one with less shows no face, so that contact there need not be solved together with that of others. */
static const double LITTLE = 0.03;

ab_status mpm_trace(ab_domain *domain, const uint32_t *nodes, size_t count, uint32_t needs, ab_trace *trace, ab_report *report) {
    mpm_body *body = (mpm_body *)domain;
    if (!reserve(body, count, needs)) goto no_memory;
    struct mpm_trace *t = body->trace;
    const size_t ld = t->list.capacity;
    memset(t->list.mass_gradient, 0, 2 * ld * sizeof(double));
    memset(t->list.area_vector, 0, 2 * ld * sizeof(double));
    size_t stencil = 0;
    for (size_t k = 0; k < count; ++k) {
        const mpm_tile *tile = body->tiles + nodes[k] / AB_TILE_NODES;
        const int n = (int)(nodes[k] % AB_TILE_NODES), i = tile->tx * AB_TILE + n % AB_TILE, j = tile->ty * AB_TILE + n / AB_TILE;
        t->list.position[k] = body->h * i;
        t->list.position[ld + k] = body->h * j;
        t->list.mass[k] = body->own[(size_t)nodes[k] * OWN_RECORD + OWN_MASS];
        t->list.key[k] = ab_tile_key(i, j);
        const mpm_tie *tie = body->tie_count ? mpm_light_tie_of(body, nodes[k]) : NULL;
        t->list.stencil_start[k] = stencil;
        for (int e = 0; tie && e < tie->count; ++e, ++stencil)
            t->list.stencil_dof[stencil] = tie->to[e], t->list.stencil_weight[stencil] = tie->weight[e];
        if (!tie) t->list.stencil_dof[stencil] = nodes[k], t->list.stencil_weight[stencil++] = 1.0;
    }
    t->list.stencil_start[count] = stencil;
    size_t entries = 0;
    if (needs & (AB_NEED_MASS_GRADIENT | AB_NEED_AREA_VECTOR | AB_NEED_NEAR_POINTS)) {
        const size_t tiles = candidate_tiles(body, nodes, count);
        for (size_t k = 0; k < tiles; ++k) {
            uint32_t wanted[MPM_PATCH_MOST];
            const mpm_tile *tile = body->tiles + t->tile_list[k];
            if (mpm_trace_wanted(tile, 1, body->kernel->patch, nodes, count, wanted) && !look_at_tile(body, tile, wanted, needs, &entries))
                goto no_memory;
        }
    }
    if (body->kernel->moment && (needs & AB_NEED_AREA_VECTOR)) /* what little they see of a face is borne by those that they go by */
        for (size_t k = 0; body->tie_count && k < count; ++k) {
            const mpm_tie *tie = mpm_light_tie_of(body, nodes[k]);
            if (tie && t->list.mass[k] < LITTLE * tie->heavy) t->list.area_vector[k] = t->list.area_vector[ld + k] = 0.0;
        }
    if (needs & AB_NEED_DENSITY_GRADIENT) {
        memset(t->list.density_gradient, 0, 2 * ld * sizeof(double));
        const size_t tiles = candidate_tiles(body, nodes, count);
        for (size_t k = 0; k < tiles; ++k)
            mpm_trace_density(body, body->tiles + t->tile_list[k], nodes, count, t->list.density_gradient, ld);
    }
    for (size_t k = 0; body->axisymmetric && k < count; ++k) { /* on the axis: the other side of it is alike */
        if (t->list.position[k] + body->origin[0] > 0.0) continue;
        t->list.mass_gradient[k] = t->list.area_vector[k] = 0.0;
        if (needs & AB_NEED_DENSITY_GRADIENT) t->list.density_gradient[k] = 0.0;
    }
    if ((needs & AB_NEED_NEAR_POINTS) && !list_near(body, nodes, count, entries)) goto no_memory;
    *trace = ab_node_list_show(&t->list, count, needs);
    trace->body = domain->spec->name, trace->stiffness = body->modulus, trace->cell = body->h;
    return AB_OK;
no_memory:
    return ab_report_failure(report, "body '%s': no memory for %zu nodes in contact", domain->spec->name, count);
}
