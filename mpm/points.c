/* points.c: points in blocks: which rows a scene needs, how they are laid out at the start, how they are kept sorted by tile and cell. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "mpm/share.h"

void mpm_rows_plan(mpm_body *body) {
    const ab_class *class_ = &body->material->loaded->class_;
    mpm_rows rows = {.count = ROW_OTHERS,
                     .extent = -1,
                     .half = -1,
                     .inverse_half = -1,
                     .corners = -1,
                     .gradient = -1,
                     .mean_stress = -1,
                     .affine = -1,
                     .state = -1};
    bool gap = false; /* a finder that looks at points near nodes or faces needs the size of a point in every direction */
    for (size_t k = 0; k < body->scene->contact_count; ++k) {
        const ab_contact_spec *contact = body->scene->contacts + k;
        const bool mine = contact->body[0] == body->domain.index || contact->body[1] == body->domain.index;
        if (mine && (contact->finder->class_.needs & (AB_NEED_NEAR_POINTS | AB_NEED_SURFACE))) gap = true;
    }
    const bool domains = body->kernel->domains;
    if (gap || (domains && body->contiguous)) rows.extent = rows.count, rows.count += 3;
    if (body->kernel->convected) rows.corners = rows.count, rows.count += 4;
    if (domains) rows.half = rows.count, rows.inverse_half = rows.count + 2, rows.count += 4;
    if (class_->needs & AB_NEED_DEFORMATION_GRADIENT) rows.gradient = rows.count, rows.count += body->axisymmetric ? 5 : 4;
    if (body->f_bar) rows.mean_stress = rows.count, rows.count += 1;
    if (body->finish == MPM_FINISH_AFFINE) rows.affine = rows.count, rows.count += 4;
    rows.states = ab_state_count(class_);
    rows.turns = ab_state_turns(class_);
    if (rows.states) rows.state = rows.count, rows.count += rows.states;
    body->rows = rows;
}

static int32_t tile_of(int32_t node) { return node >= 0 ? node / AB_TILE : -((AB_TILE - 1 - node) / AB_TILE); }

typedef struct place {
    uint64_t key;
    uint32_t cell, index;
} place;

static int compare_places(const void *a, const void *b) {
    const place *x = a, *y = b;
    if (x->key != y->key) return x->key < y->key ? -1 : 1;
    if (x->cell != y->cell) return x->cell < y->cell ? -1 : 1;
    return (x->index > y->index) - (x->index < y->index);
}

static ab_status no_memory(const mpm_body *body, size_t points, ab_report *report) {
    return ab_report_failure(report, "body '%s': no memory for %zu points of %d bytes; use fewer points per cell or larger cells",
                             body->domain.spec->name, points, body->rows.count * 8);
}

static ab_status reserve_blocks(mpm_body *body, size_t blocks, ab_report *report) {
    size_t ids = body->block_capacity;
    if (!ab_memory_grow((void **)&body->ids, &ids, blocks, 8 * sizeof *body->ids)) return no_memory(body, blocks * 8, report);
    if (!ab_memory_grow((void **)&body->blocks, &body->block_capacity, blocks, 64 * (size_t)body->rows.count))
        return no_memory(body, blocks * 8, report);
    return AB_OK;
}

/* Copies lane `from` of a block into another block's lane; every row. */
static void copy_point(double *to, int to_lane, const double *from, int from_lane, int rows) {
    for (int r = 0; r < rows; ++r) to[8 * r + to_lane] = from[8 * r + from_lane];
}

/* Fills the last block of a tile with massless copies of its last point, so that every lane holds numbers a material can live with. */
static void pad_block(const mpm_body *body, double *block, uint64_t *ids, int used) {
    for (int l = used; l < 8; ++l) {
        copy_point(block, l, block, used - 1, body->rows.count);
        block[8 * ROW_MASS + l] = 0.0;
        block[8 * ROW_VOLUME + l] = 0.0;
        ids[l] = UINT64_MAX;
    }
}

/* Place, size and shape of a point of the fill in a lane of a block. */
static void place_point(const mpm_body *body, const ab_fill *fill, size_t i, double *b, size_t l) {
    const mpm_rows rows = body->rows;
    const double x[2] = {fill->x[i] - body->origin[0], fill->y[i] - body->origin[1]}, *a = fill->extent + 3 * i;
    for (int c = 0; c < 2; ++c) b[8 * (ROW_X + c) + l] = b[8 * (ROW_NEXT + c) + l] = x[c];
    b[8 * ROW_VOLUME + l] = fill->volume[i] * (body->axisymmetric ? ab_circumference(fill->x[i]) : 1.0);
    if (rows.extent >= 0)
        for (int c = 0; c < 3; ++c) b[8 * (rows.extent + c) + l] = a[c];
    if (rows.half >= 0)
        for (int c = 0; c < 2; ++c) {
            const double half = fmin(sqrt(a[c]), 0.5 * body->h);
            b[8 * (rows.half + c) + l] = half;
            b[8 * (rows.inverse_half + c) + l] = 1.0 / half;
        }
    if (rows.corners >= 0)
        for (int c = 0; c < 2; ++c) b[8 * (rows.corners + 3 * c) + l] = sqrt(a[c]);
    if (rows.gradient >= 0) b[8 * rows.gradient + l] = b[8 * (rows.gradient + 3) + l] = 1.0;
    if (rows.gradient >= 0 && body->axisymmetric) b[8 * (rows.gradient + 4) + l] = 1.0;
}

/* Where the points of the fill stand: tile, cell, number. False: no memory. */
static bool find_places(const mpm_body *body, const ab_fill *fill, place *places) {
    double *block = aligned_alloc(64, 64 * (size_t)body->rows.count);
    if (!block) return false;
    memset(block, 0, 64 * (size_t)body->rows.count);
    for (size_t p = 0; p < fill->count; p += 8) {
        int32_t node[2][8];
        for (size_t l = 0; l < 8; ++l) place_point(body, fill, p + l < fill->count ? p + l : fill->count - 1, block, l);
        body->kernel->first(body, block, ROW_X, node);
        for (size_t l = 0; l < 8 && p + l < fill->count; ++l) {
            const int32_t tx = tile_of(node[0][l]), ty = tile_of(node[1][l]);
            places[p + l] = (place){ab_tile_key(tx, ty), (uint32_t)((node[1][l] - ty * AB_TILE) * AB_TILE + node[0][l] - tx * AB_TILE),
                                    (uint32_t)(p + l)};
        }
    }
    free(block);
    return true;
}

ab_status mpm_points_insert(mpm_body *body, const ab_fill *fill, ab_report *report) {
    const size_t count = fill->count;
    place *places = malloc((count + 1) * sizeof *places);
    uint64_t *filled = malloc((count + 1) * sizeof *filled);
    if (!places || !filled || !find_places(body, fill, places)) {
        free(places), free(filled);
        return no_memory(body, count, report);
    }
    qsort(places, count, sizeof *places, compare_places);
    size_t tiles = 0, blocks = 0;
    for (size_t p = 0; p < count;) {
        size_t q = p;
        while (q < count && places[q].key == places[p].key) ++q;
        filled[tiles++] = places[p].key;
        blocks += (q - p + 7) / 8;
        p = q;
    }
    ab_status status = reserve_blocks(body, blocks, report);
    if (status == AB_OK) status = mpm_tiles_build(body, filled, tiles, report);
    free(filled);
    if (status != AB_OK) {
        free(places);
        return status;
    }
    const double density = body->material->density;
    size_t block = 0;
    for (size_t p = 0; p < count;) {
        size_t q = p;
        while (q < count && places[q].key == places[p].key) ++q;
        mpm_tile *tile = body->tiles + mpm_tile_find(body->keys, body->tile_count, places[p].key);
        tile->first = (uint32_t)block;
        tile->points = (uint32_t)(q - p);
        tile->blocks = (uint32_t)((q - p + 7) / 8);
        for (size_t k = p; k < q; ++k) {
            const size_t slot = block * 8 + (k - p), i = places[k].index;
            double *b = mpm_block(body, slot / 8);
            const size_t l = slot % 8;
            place_point(body, fill, i, b, l);
            const double volume = b[8 * ROW_VOLUME + l];
            body->area += fill->volume[i];
            for (int c = 0; c < 2; ++c) {
                const ab_body_spec *spec = body->domain.spec;
                const double at[2] = {fill->x[i], fill->y[i]}, v = ab_number_at(spec->velocity + c, 0.0, at[0], at[1], 0.0);
                if (status == AB_OK)
                    status = ab_number_finite(spec->velocity + c, v, 0.0, at, report, "bodies.%s.velocity[%d]", spec->name, c);
                b[8 * (ROW_V + c) + l] = v;
            }
            b[8 * ROW_MASS + l] = density * volume;
            if (density * volume > body->point_mass) body->point_mass = density * volume;
            body->ids[slot] = i;
        }
        const size_t used = (q - p) % 8;
        block += tile->blocks;
        if (used) pad_block(body, mpm_block(body, block - 1), body->ids + (block - 1) * 8, (int)used);
        p = q;
    }
    free(places);
    body->block_count = block;
    body->points = body->born = count;
    return status;
}

static void index_points(mpm_body *body) {
    memset(body->slot, 0xff, body->born * sizeof *body->slot);
    for (size_t slot = 0; slot < body->block_count * 8; ++slot)
        if (body->ids[slot] != UINT64_MAX) body->slot[body->ids[slot]] = (uint32_t)slot;
}

bool mpm_points_index(mpm_body *body) {
    if (body->slot) return true;
    body->slot = malloc((body->born + 1) * sizeof *body->slot);
    if (body->slot) index_points(body);
    return body->slot != NULL;
}

/* ---- sorting ------------------------------------------------------------------------------------------------------------ */

/* For each point of an old tile: which of the nine tiles around it now holds it, and in which cell. */
static void find_moves(const mpm_body *body, const mpm_tile *tile, uint16_t *moves, uint32_t counts[9]) {
    memset(counts, 0, 9 * sizeof *counts);
    for (uint32_t b = 0; b < tile->blocks; ++b) {
        const double *block = mpm_block(body, tile->first + b);
        int32_t node[2][8];
        body->kernel->first(body, block, ROW_X, node);
        for (int l = 0; l < 8; ++l) {
            const size_t slot = (size_t)(tile->first + b) * 8 + (size_t)l;
            if (body->ids[slot] == UINT64_MAX) {
                moves[slot] = UINT16_MAX;
                continue;
            }
            const double x = block[8 * ROW_X + l], y = block[8 * (ROW_X + 1) + l];
            if (x < 0.0 || y < 0.0 || x > body->span[0] ||
                y > body->span[1]) { /* left through an outflow side; finish has stopped every other */
                moves[slot] = UINT16_MAX;
                continue;
            }
            const int32_t i = node[0][l] - tile->tx * AB_TILE, j = node[1][l] - tile->ty * AB_TILE;
            const int dx = i < 0 ? -1 : i >= AB_TILE ? 1 : 0, dy = j < 0 ? -1 : j >= AB_TILE ? 1 : 0;
            const int code = (dy + 1) * 3 + dx + 1, cell = (j - dy * AB_TILE) * AB_TILE + i - dx * AB_TILE;
            moves[slot] = (uint16_t)(code * AB_TILE_NODES + cell);
            ++counts[code];
        }
    }
}

/* Copies into a new tile the points that now belong to it, from the nine old tiles around its place, sorted by cell. */
static void collect(const mpm_body *body, const mpm_tile *target, const mpm_tile *old_tiles, const long sources[9],
                    const uint32_t (*counts)[9], const uint16_t *moves, double *blocks, uint64_t *ids) {
    uint32_t start[AB_TILE_NODES + 1] = {0};
    for (int s = 0; s < 9; ++s) { /* the tile at offset s from us holds points that went the opposite way */
        const int code = 8 - s;
        if (sources[s] < 0 || counts[sources[s]][code] == 0) continue;
        const mpm_tile *from = old_tiles + sources[s];
        for (size_t slot = (size_t)from->first * 8; slot < (size_t)(from->first + from->blocks) * 8; ++slot)
            if (moves[slot] != UINT16_MAX && moves[slot] / AB_TILE_NODES == code) ++start[moves[slot] % AB_TILE_NODES + 1];
    }
    for (int c = 0; c < AB_TILE_NODES; ++c) start[c + 1] += start[c];
    const int rows = body->rows.count;
    for (int s = 0; s < 9; ++s) {
        const int code = 8 - s;
        if (sources[s] < 0 || counts[sources[s]][code] == 0) continue;
        const mpm_tile *from = old_tiles + sources[s];
        for (size_t slot = (size_t)from->first * 8; slot < (size_t)(from->first + from->blocks) * 8; ++slot) {
            if (moves[slot] == UINT16_MAX || moves[slot] / AB_TILE_NODES != code) continue;
            const size_t to = (size_t)target->first * 8 + start[moves[slot] % AB_TILE_NODES]++;
            copy_point(blocks + (to / 8) * 8 * (size_t)rows, (int)(to % 8), mpm_block(body, slot / 8), (int)(slot % 8), rows);
            ids[to] = body->ids[slot];
        }
    }
    const int used = (int)(target->points % 8);
    const size_t last = target->first + target->blocks - 1;
    if (used) pad_block(body, blocks + last * 8 * (size_t)rows, ids + last * 8, used);
}

static int compare_keys(const void *a, const void *b) {
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

typedef struct sorting {
    uint16_t *moves;
    uint32_t (*counts)[9];
    const mpm_tile *old_tiles;
    long (*sources)[9];
} sorting;

static void find_tile_moves(mpm_body *body, size_t k, void *context) {
    const sorting *s = context;
    find_moves(body, body->tiles + k, s->moves, s->counts[k]);
}

static void collect_tile(mpm_body *body, size_t k, void *context) {
    const sorting *s = context;
    if (body->tiles[k].patch >= 0)
        collect(body, body->tiles + k, s->old_tiles, s->sources[k], (const uint32_t(*)[9])s->counts, s->moves, body->spare_blocks,
                body->spare_ids);
}

ab_status mpm_points_sort(mpm_body *body, ab_report *report) {
    const size_t old_count = body->tile_count;
    mpm_tile *old_tiles = malloc((old_count + 1) * sizeof *old_tiles);
    uint64_t *old_keys = malloc((old_count + 1) * sizeof *old_keys), *filled = malloc((9 * old_count + 1) * sizeof *filled);
    uint32_t(*counts)[9] = malloc((old_count + 1) * sizeof *counts);
    uint16_t *moves = malloc((body->block_count * 8 + 1) * sizeof *moves);
    long(*sources)[9] = NULL;
    ab_status status = AB_OK;
    if (!old_tiles || !old_keys || !filled || !counts || !moves) {
        status = no_memory(body, body->points, report);
        goto out;
    }
    memcpy(old_tiles, body->tiles, old_count * sizeof *old_tiles);
    memcpy(old_keys, body->keys, old_count * sizeof *old_keys);
    mpm_each_tile(body, find_tile_moves, &(sorting){.moves = moves, .counts = counts});

    size_t n = 0;
    for (size_t k = 0; k < old_count; ++k)
        for (int code = 0; code < 9; ++code)
            if (counts[k][code]) filled[n++] = ab_tile_key(old_tiles[k].tx + code % 3 - 1, old_tiles[k].ty + code / 3 - 1);
    qsort(filled, n, sizeof *filled, compare_keys);
    size_t unique = 0;
    for (size_t k = 0; k < n; ++k)
        if (unique == 0 || filled[k] != filled[unique - 1]) filled[unique++] = filled[k];
    status = mpm_tiles_build(body, filled, unique, report);
    if (status != AB_OK) goto out;

    sources = malloc((body->tile_count + 1) * sizeof *sources);
    if (!sources) {
        status = no_memory(body, body->points, report);
        goto out;
    }
    size_t blocks = 0, points = 0;
    for (size_t k = 0; k < body->tile_count; ++k) {
        mpm_tile *tile = body->tiles + k;
        if (tile->patch < 0) continue;
        tile->first = (uint32_t)blocks;
        for (int s = 0; s < 9; ++s) {
            sources[k][s] = mpm_tile_find(old_keys, old_count, ab_tile_key(tile->tx + s % 3 - 1, tile->ty + s / 3 - 1));
            if (sources[k][s] >= 0) tile->points += counts[sources[k][s]][8 - s];
        }
        tile->blocks = (tile->points + 7) / 8;
        blocks += tile->blocks;
        points += tile->points;
    }
    body->points = points;
    size_t ids_capacity = body->spare_capacity;
    if (!ab_memory_grow((void **)&body->spare_ids, &ids_capacity, blocks, 8 * sizeof *body->ids) ||
        !ab_memory_grow((void **)&body->spare_blocks, &body->spare_capacity, blocks, 64 * (size_t)body->rows.count)) {
        status = no_memory(body, blocks * 8, report);
        goto out;
    }
    mpm_each_tile(body, collect_tile, &(sorting){.moves = moves, .counts = counts, .old_tiles = old_tiles, .sources = sources});

    double *swapped = body->blocks;
    body->blocks = body->spare_blocks;
    body->spare_blocks = swapped;
    uint64_t *swapped_ids = body->ids;
    body->ids = body->spare_ids;
    body->spare_ids = swapped_ids;
    const size_t capacity = body->block_capacity;
    body->block_capacity = body->spare_capacity;
    body->spare_capacity = capacity;
    body->block_count = blocks;
    body->sort_due = false;
    if (body->slot) index_points(body);
out:
    free(old_tiles), free(old_keys), free(filled), free(counts), free(moves), free(sources);
    return status;
}
