/* tiles.c: the tiles of the grid where a body has material, and their neighbours. */
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "mpm/body.h"

long mpm_tile_find(const uint64_t *keys, size_t count, uint64_t key) {
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (keys[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && keys[low] == key ? (long)low : -1;
}

static int compare_keys(const void *a, const void *b) {
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* True when a node of the tile lies on or beyond a side that holds it. */
static bool tile_is_held(const mpm_body *body, int32_t tx, int32_t ty) {
    const ab_scene *scene = body->scene;
    const ab_side_kind *side = body->side;
    const int last[2] = {scene->grid_cells[0], scene->grid_cells[1]};
    const bool held[4] = {tx * AB_TILE <= 0, tx * AB_TILE + AB_TILE - 1 >= last[0], ty * AB_TILE <= 0,
                          ty * AB_TILE + AB_TILE - 1 >= last[1]};
    for (int s = 0; s < AB_SIDES; ++s)
        if (held[s] && mpm_side_holds(side[s])) return true;
    return false;
}

void mpm_tiles_hold(mpm_body *body) {
    for (size_t k = 0; k < body->tile_count; ++k) body->tiles[k].held = tile_is_held(body, body->tiles[k].tx, body->tiles[k].ty);
}

ab_status mpm_tiles_build(mpm_body *body, const uint64_t *filled, size_t count, ab_report *report) {
    uint64_t *all = malloc((9 * count + 1) * sizeof *all);
    if (!all) return ab_report_failure(report, "body '%s': no memory for %zu tiles", body->domain.spec->name, 9 * count);
    size_t n = 0;
    for (size_t k = 0; k < count; ++k)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) all[n++] = ab_tile_key(ab_tile_x(filled[k]) + dx, ab_tile_y(filled[k]) + dy);
    qsort(all, n, sizeof *all, compare_keys);
    size_t unique = 0;
    for (size_t k = 0; k < n; ++k)
        if (unique == 0 || all[k] != all[unique - 1]) all[unique++] = all[k];

    size_t keys_capacity = body->tile_capacity, tiles_capacity = body->tile_capacity, own_capacity = body->own_capacity;
    const bool grown =
        ab_memory_grow((void **)&body->keys, &keys_capacity, unique, sizeof *body->keys) &&
        ab_memory_grow((void **)&body->tiles, &tiles_capacity, unique, sizeof *body->tiles) &&
        ab_memory_grow((void **)&body->own, &own_capacity, unique, sizeof(double) * OWN_RECORD * AB_TILE_NODES) &&
        (body->order < 2 ||
         ab_memory_grow((void **)&body->filter, &body->filter_capacity, unique, sizeof(double) * FILTER_RECORD * AB_TILE_NODES)) &&
        (!body->f_bar || ab_memory_grow((void **)&body->volumetric, &body->volumetric_capacity, unique,
                                        sizeof(double) * VOLUMETRIC_RECORD * AB_TILE_NODES)) &&
        (!body->f_bar || ab_memory_grow((void **)&body->slivers, &body->sliver_capacity, unique, sizeof *body->slivers)) &&
        mpm_light_reserve(body, unique) && mpm_damp_reserve(body, unique) &&
        ab_memory_grow((void **)&body->sums, &body->sums_capacity, unique, sizeof *body->sums) &&
        ab_memory_grow((void **)&body->patches, &body->patch_capacity, count, sizeof(double) * mpm_patch_doubles(body));
    body->tile_capacity = tiles_capacity;
    body->own_capacity = own_capacity;
    if (!grown) {
        free(all);
        return ab_report_failure(report, "body '%s': no memory for %zu tiles of the grid", body->domain.spec->name, unique);
    }
    memcpy(body->keys, all, unique * sizeof *all);
    free(all);
    body->tile_count = unique;
    body->patch_count = count;
    for (size_t k = 0; k < unique; ++k) {
        mpm_tile *tile = body->tiles + k;
        *tile = (mpm_tile){
            .tx = ab_tile_x(body->keys[k]), .ty = ab_tile_y(body->keys[k]), .patch = (int32_t)mpm_tile_find(filled, count, body->keys[k])};
        tile->held = tile_is_held(body, tile->tx, tile->ty);
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
                tile->around[(dy + 1) * 3 + dx + 1] = (int32_t)mpm_tile_find(body->keys, unique, ab_tile_key(tile->tx + dx, tile->ty + dy));
    }
    memset(body->own, 0, unique * sizeof(double) * OWN_RECORD * AB_TILE_NODES);
    memset(body->sums, 0, unique * sizeof *body->sums);
    ++body->version;
    return AB_OK;
}

size_t mpm_tile_of_block(const mpm_body *body, uint32_t block) {
    size_t low = 0, high = body->tile_count;
    size_t found = 0;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        size_t filled = middle;
        while (filled < high && body->tiles[filled].patch < 0) ++filled;
        if (filled == high)
            high = middle;
        else if (body->tiles[filled].first <= block)
            found = filled, low = filled + 1;
        else
            high = middle;
    }
    return found;
}

uint32_t mpm_dof_of(const mpm_body *body, const mpm_tile *tile, int patch_node) {
    const int patch = body->kernel->patch, i = patch_node % patch - 1, j = patch_node / patch - 1;
    const int dx = i < 0 ? -1 : i >= AB_TILE ? 1 : 0, dy = j < 0 ? -1 : j >= AB_TILE ? 1 : 0;
    return (uint32_t)tile->around[(dy + 1) * 3 + dx + 1] * AB_TILE_NODES + (uint32_t)((j - dy * AB_TILE) * AB_TILE + i - dx * AB_TILE);
}
