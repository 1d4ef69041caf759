/* keep.c: what a body of material points is between two steps. Blocks are kept as they lie in memory, as sums go over points in that order; what nodes hold is made
 * anew from the points, by the same passes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/checkpoint.h"
#include "core/memory.h"
#include "mpm/outline.h"

/* The tiles with points, and which blocks are theirs. Loading: all tiles are made anew, with `blocks` blocks to be filled. False: refused. */
static bool keep_tiles(mpm_body *body, ab_checkpoint *c, size_t blocks) {
    const bool loads = ab_checkpoint_loads(c);
    size_t count = body->patch_count;
    if (!ab_keep_count(c, "tiles", &count, sizeof(uint64_t))) return false;
    uint64_t *keys = malloc((count + 1) * sizeof *keys);
    uint32_t *points = malloc((count + 1) * sizeof *points);
    bool good = keys && points;
    if (!good) ab_checkpoint_refuse(c, "no memory for %zu tiles", count);
    for (size_t k = 0, n = 0; good && !loads && k < body->tile_count; ++k)
        if (body->tiles[k].patch >= 0) keys[n] = body->keys[k], points[n++] = body->tiles[k].points;
    good = good && ab_keep_u64(c, "tile_keys", keys, count) && ab_keep_u32(c, "tile_points", points, count);
    size_t first = 0;
    if (good && loads) {
        for (size_t k = 0; k < count && good; ++k) {
            const int32_t far = 1 << 26, x = ab_tile_x(keys[k]), y = ab_tile_y(keys[k]); /* numbers of nodes are 32 bits */
            good = points[k] > 0 && (k == 0 || keys[k] > keys[k - 1]) && x > -far && x < far && y > -far && y < far;
            first += ((size_t)points[k] + 7) / 8;
        }
        if (!good || first != blocks)
            good = ab_checkpoint_refuse(c, "the tiles of body '%s' do not fit its points", body->domain.spec->name);
        good = good && mpm_tiles_build(body, keys, count, ab_checkpoint_report(c)) == AB_OK;
        if (!good) ab_checkpoint_refuse(c, "the tiles of body '%s' cannot be made", body->domain.spec->name);
    }
    first = 0;
    for (size_t k = 0, n = 0; good && loads && k < body->tile_count; ++k) {
        mpm_tile *tile = body->tiles + k;
        if (tile->patch < 0) continue;
        tile->first = (uint32_t)first;
        tile->points = points[n++];
        tile->blocks = (tile->points + 7) / 8;
        first += tile->blocks;
    }
    free(keys), free(points);
    return good;
}

/* Ids are those of the fill, each once, and lanes without one stand where a tile's last block is filled up. */
static bool check_ids(const mpm_body *body, ab_checkpoint *c) {
    uint8_t *met = calloc(body->born + 1, 1);
    bool good = met != NULL;
    size_t points = 0;
    for (size_t k = 0; good && k < body->tile_count; ++k) {
        const mpm_tile *tile = body->tiles + k;
        for (size_t l = 0; good && tile->patch >= 0 && l < 8 * (size_t)tile->blocks; ++l) {
            const uint64_t id = body->ids[8 * (size_t)tile->first + l];
            good = l < tile->points ? id < body->born && !met[id] : id == UINT64_MAX;
            if (good && l < tile->points) met[id] = 1, ++points;
        }
    }
    free(met);
    return good && points == body->points ? true : ab_checkpoint_refuse(c, "the points of body '%s' are damaged", body->domain.spec->name);
}

/* Points are in their tiles, or so near that the next sort finds them: every pass counts on that. */
static bool check_places(const mpm_body *body, ab_checkpoint *c) {
    const int32_t far = body->sort_due ? AB_TILE : 1;
    bool good = true;
    for (size_t k = 0; good && k < body->tile_count; ++k) {
        const mpm_tile *tile = body->tiles + k;
        for (uint32_t b = 0; good && tile->patch >= 0 && b < tile->blocks; ++b) {
            int32_t node[2][8];
            const double *block = mpm_block(body, tile->first + b);
            for (size_t l = 0; good && l < 16; ++l) good = fabs(block[8 * ROW_X + l]) < 1e9 * body->h;
            if (!good) break;
            body->kernel->first(body, block, ROW_X, node);
            for (int l = 0; l < 8; ++l)
                for (int d = 0; d < 2; ++d) {
                    const int32_t at = node[d][l] - (d ? tile->ty : tile->tx) * AB_TILE;
                    good = good && at >= -far && at < AB_TILE + far;
                }
        }
    }
    return good || ab_checkpoint_refuse(c, "points of body '%s' are not where they can be", body->domain.spec->name);
}

static bool keep_points(mpm_body *body, ab_checkpoint *c) {
    size_t blocks = body->block_count, rows = (size_t)body->rows.count, born = body->born, capacity = body->block_capacity;
    const size_t own_rows = rows, own_born = born;
    if (!ab_keep_count(c, "blocks", &blocks, 64) || !ab_keep_size(c, "rows", &rows) || !ab_keep_size(c, "born", &born)) return false;
    if (rows != own_rows || born != own_born)
        return ab_checkpoint_refuse(c, "body '%s' has %zu points of %zu numbers there, and %zu of %zu here", body->domain.spec->name, born,
                                    rows, own_born, own_rows);
    if (!ab_keep_size(c, "points", &body->points) || !keep_tiles(body, c, blocks)) return false;
    if (ab_checkpoint_loads(c)) {
        if (!ab_memory_grow((void **)&body->ids, &capacity, blocks, 8 * sizeof *body->ids) ||
            !ab_memory_grow((void **)&body->blocks, &body->block_capacity, blocks, 64 * rows))
            return ab_checkpoint_refuse(c, "no memory for %zu points", 8 * blocks);
        body->block_count = blocks;
    }
    if (!ab_keep_u64(c, "ids", body->ids, 8 * blocks) || !ab_keep_doubles(c, "blocks_of_points", body->blocks, 8 * rows * blocks))
        return false;
    if (!ab_checkpoint_loads(c)) return true;
    if (!check_ids(body, c)) return false;
    if (body->slot) { /* made anew */
        free(body->slot);
        body->slot = NULL;
        if (!mpm_points_index(body)) return ab_checkpoint_refuse(c, "no memory for %zu points", 8 * blocks);
    }
    return true;
}

/* Pieces of outline under loads stretch and turn with their points. */
static bool keep_loads(mpm_body *body, ab_checkpoint *c) {
    double *shape = malloc((4 * body->load_count + 1) * sizeof *shape);
    if (!shape) return ab_checkpoint_refuse(c, "no memory for %zu loads", body->load_count);
    for (size_t k = 0; k < body->load_count; ++k)
        memcpy(shape + 4 * k, body->loads[k].arm, 2 * sizeof *shape), memcpy(shape + 4 * k + 2, body->loads[k].half, 2 * sizeof *shape);
    const bool good = ab_keep_doubles(c, "loads", shape, 4 * body->load_count);
    for (size_t k = 0; good && k < body->load_count; ++k)
        memcpy(body->loads[k].arm, shape + 4 * k, 2 * sizeof *shape), memcpy(body->loads[k].half, shape + 4 * k + 2, 2 * sizeof *shape);
    free(shape);
    return good;
}

/* Faces are joined and divided on the way, so there may be more or fewer of them than at the start. Vertices that touch (surface: points) are where the points are. */
static bool keep_outline(mpm_body *body, ab_checkpoint *c) {
    if (!body->outline || body->outline->touching) return true;
    mpm_loops *loops = &body->outline->loops;
    size_t count = loops->count;
    if (!ab_keep_count(c, "vertices", &count, 81)) return false;
    if (ab_checkpoint_loads(c)) {
        if (!mpm_loops_reserve(loops, count)) return ab_checkpoint_refuse(c, "no memory for %zu vertices", count);
        loops->count = count;
    }
    const bool good = ab_keep_doubles(c, "vertex_x", loops->x, 2 * count) && ab_keep_u32(c, "vertex_next", loops->next, count) &&
                      ab_keep_u32(c, "vertex_prior", loops->prior, count) && ab_keep_flags(c, "vertex_corner", loops->corner, count) &&
                      ab_keep_u32(c, "vertex_point", loops->point, 2 * count) && ab_keep_doubles(c, "vertex_arm", loops->arm, 4 * count) &&
                      ab_keep_doubles(c, "vertex_slip", loops->slip, 2 * count);
    if (!good || !ab_checkpoint_loads(c)) return good;
    for (size_t k = 0; k < count; ++k)
        if (loops->next[k] >= count || loops->prior[loops->next[k]] != k || loops->point[2 * k] >= body->born ||
            loops->point[2 * k + 1] >= body->born)
            return ab_checkpoint_refuse(c, "the outline of body '%s' is damaged", body->domain.spec->name);
    return true;
}

/* Where displacements are counted from, where a stage has set it. */
static bool keep_datum(mpm_body *body, ab_checkpoint *c) {
    if (!body->birth || body->scene->stage_count == 0) return true;
    bool set = body->datum != NULL;
    if (!ab_keep_flags(c, "datum_set", &set, 1)) return false;
    if (set && !body->datum) body->datum = malloc(2 * body->born * sizeof *body->datum);
    if (set && !body->datum) return ab_checkpoint_refuse(c, "no memory for %zu points", body->born);
    return !set || ab_keep_doubles(c, "datum", body->datum, 2 * body->born);
}

void mpm_keep(ab_domain *domain, ab_checkpoint *c) {
    mpm_body *body = (mpm_body *)domain;
    const bool good =
        keep_points(body, c) && keep_datum(body, c) && keep_loads(body, c) && mpm_edges_keep(body, c) && keep_outline(body, c) &&
        ab_keep_flags(c, "sort_due", &body->sort_due, 1) && ab_keep_doubles(c, "wave_speed", &body->wave_speed, 1) &&
        ab_keep_doubles(c, "largest_speed", &body->largest_speed, 1) && ab_keep_doubles(c, "last_strain", &body->last_strain, 1) &&
        ab_keep_struct(c, "energy", &body->energy) && ab_keep_struct(c, "motion", &body->motion) &&
        ab_keep_plugin(c, "material", &body->material->loaded->class_, body->self);
    if (good && ab_checkpoint_loads(c)) check_places(body, c), body->scattered = false;
}
