/* trace.c: a body's inner points on the background grid: which tiles they reach, how much mass they give each node, and what a contact finder sees of them at
 * the nodes it asks for.
 *
 * Points are kept in the order of the cells they stand in (counting sort by tile and cell, anew only when a point has changed its cell), so that a node finds
 * those that reach it in the four cells around it. Each tile scatters into a patch of its own, one node larger than the tile; then each tile adds up its nodes from
 * its own patch and those to the left and below, in one fixed order: no sum depends on the number of threads. */
#include "fem/trace_inside.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/density.h"
#include "core/vector.h"

enum {
    PATCH = AB_TILE + 1,
    PATCH_NODES = PATCH * PATCH,
    PARALLEL_FROM = 8000, /* points; fewer are done before threads have woken up */
    FARTHEST = 1 << 29    /* cells from the grid's corner */
};

/* Points are seen by as many nodes as those of the bodies of material points they may touch: a node that such a body has and this one has not is not shared, and
 * its part of the contact force would be missing in the other body. */
static int width_of(const ab_scene *scene, const char *body) {
    int width = 2;
    for (size_t k = 0; k < scene->contact_count; ++k)
        for (int side = 0; side < 2; ++side) {
            const ab_body_spec *own = scene->bodies + scene->contacts[k].body[side],
                               *other = scene->bodies + scene->contacts[k].body[!side];
            if (strcmp(own->name, body) || !other->basis) continue;
            if (!strcmp(other->basis, "bspline2") && width < 3) width = 3;
            if (!strcmp(other->basis, "bspline3")) width = 4;
        }
    return width;
}

double fem_trace_reach(const fem_trace *t) { return 0.5 * t->width; }

ab_status fem_trace_create(const ab_scene *scene, const char *body, double modulus, fem_trace **trace, ab_report *report) {
    *trace = NULL;
    if (!(scene->grid_cell > 0.0))
        return ab_report_failure(report, "body '%s': a contact that looks at shared nodes needs a grid; write grid: {from, to, cell}",
                                 body);
    fem_trace *t = calloc(1, sizeof *t);
    if (!t) return ab_report_failure(report, "body '%s': no memory for its trace on the grid", body);
    t->body = body;
    t->h = scene->grid_cell;
    t->axisymmetric = scene->space == AB_SPACE_AXISYMMETRIC;
    t->inverse_h = 1.0 / t->h;
    t->modulus = modulus;
    t->width = width_of(scene, body);
    *trace = t;
    return AB_OK;
}

void fem_trace_destroy(fem_trace *t) {
    if (!t) return;
    free(t->key), free(t->wanted), free(t->tiles), free(t->mass), free(t->patch), free(t->cell_start);
    free(t->cell), free(t->slot), free(t->order);
    ab_node_list_clear(&t->list);
    free(t->place), free(t);
}

/* ---- tiles ---------------------------------------------------------------------------------------------------------------- */

static int compare_keys(const void *a, const void *b) {
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

static int32_t find_tile(const fem_trace *t, uint64_t key) {
    size_t low = 0, high = t->tile_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (t->key[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < t->tile_count && t->key[low] == key ? (int32_t)low : -1;
}

/* The tile that owns a node, and the node's place in it. Rounds down for negative numbers too. */
static uint64_t home_of(int32_t i, int32_t j, uint32_t *place) {
    const int32_t tx = (i >= 0 ? i : i - (AB_TILE - 1)) / AB_TILE, ty = (j >= 0 ? j : j - (AB_TILE - 1)) / AB_TILE;
    *place = (uint32_t)((j - ty * AB_TILE) * AB_TILE + i - tx * AB_TILE);
    return ab_tile_key(tx, ty);
}

/* Cell of each point. *moved: some point has changed its cell. */
static ab_status find_cells(fem_trace *t, const fem_inner *inner, bool *moved, ab_report *report) {
    const double *x = inner->position, *y = x + inner->ld;
    int changed = 0, lost = 0;
#pragma omp parallel for schedule(static) reduction(| : changed, lost) if (inner->count >= PARALLEL_FROM)
    for (size_t q = 0; q < inner->count; ++q) {
        const double u = floor(x[q] * t->inverse_h), v = floor(y[q] * t->inverse_h);
        if (!(fabs(u) < FARTHEST && fabs(v) < FARTHEST)) {
            lost = 1;
            continue;
        }
        const uint64_t cell = ab_tile_key((int32_t)u, (int32_t)v);
        changed |= cell != t->cell[q];
        t->cell[q] = cell;
    }
    *moved = changed != 0;
    if (lost)
        return ab_report_failure(
            report,
            "body '%s' has places that are no finite numbers, or lie more than %d cells from the grid: the run has blown "
            "up; use a smaller dt",
            t->body, (int)FARTHEST);
    return AB_OK;
}

static bool want(fem_trace *t, uint64_t key, uint64_t *last) {
    if (key == *last) return true;
    *last = key;
    if (t->wanted_count == t->key_capacity) {
        const size_t more = 2 * t->key_capacity + 256;
        if (!ab_memory_resize(&t->wanted, more, sizeof *t->wanted)) return false;
        t->key_capacity = more;
    }
    t->wanted[t->wanted_count++] = key;
    return true;
}

/* Tiles around its own, from low to high per direction, that hold nodes of a point in this cell of its tile. */
static void spread_of(const fem_trace *t, uint32_t place, int low[2], int high[2]) {
    const int at[2] = {(int)place % AB_TILE, (int)place / AB_TILE}, before = t->width > 2 ? 1 : 0, behind = t->width > 2 ? 2 : 1;
    for (int c = 0; c < 2; ++c) low[c] = at[c] < before ? -1 : 0, high[c] = at[c] + behind >= AB_TILE ? 1 : 0;
}

/* The tiles of all nodes that some point reaches. False: no memory. */
static bool list_tiles(fem_trace *t) {
    uint64_t last[9];
    for (int s = 0; s < 9; ++s) last[s] = UINT64_MAX;
    t->wanted_count = 0;
    for (size_t q = 0; q < t->point_count; ++q) {
        uint32_t place;
        const uint64_t home = home_of(ab_tile_x(t->cell[q]), ab_tile_y(t->cell[q]), &place);
        int low[2], high[2];
        spread_of(t, place, low, high);
        for (int dy = low[1]; dy <= high[1]; ++dy)
            for (int dx = low[0]; dx <= high[0]; ++dx)
                if (!want(t, ab_tile_key(ab_tile_x(home) + dx, ab_tile_y(home) + dy), last + (dy + 1) * 3 + dx + 1)) return false;
    }
    if (t->wanted_count) qsort(t->wanted, t->wanted_count, sizeof *t->wanted, compare_keys);
    size_t unique = 0;
    for (size_t k = 0; k < t->wanted_count; ++k)
        if (unique == 0 || t->wanted[k] != t->wanted[unique - 1]) t->wanted[unique++] = t->wanted[k];
    if (unique > t->tile_capacity || !t->cell_start) {
        const size_t n = unique + unique / 2 + 16;
        if (!ab_memory_resize(&t->key, n, sizeof *t->key) || !ab_memory_resize(&t->tiles, n, sizeof *t->tiles) ||
            !ab_memory_resize(&t->mass, n * AB_TILE_NODES, sizeof *t->mass) ||
            !ab_memory_resize(&t->patch, n * PATCH_NODES, sizeof *t->patch) ||
            !ab_memory_resize(&t->cell_start, n * AB_TILE_NODES + 1, sizeof *t->cell_start))
            return false;
        t->tile_capacity = n;
    }
    if (unique) memcpy(t->key, t->wanted, unique * sizeof *t->key);
    t->tile_count = unique;
    for (size_t k = 0; k < unique; ++k)
        for (int s = 0; s < 9; ++s)
            t->tiles[k].around[s] = find_tile(t, ab_tile_key(ab_tile_x(t->key[k]) + s % 3 - 1, ab_tile_y(t->key[k]) + s / 3 - 1));
    ++t->version;
    return true;
}

/* Tile and cell of each point in the list as it is; false where a point reaches a tile that is not listed. */
static bool place_points(fem_trace *t) {
    uint64_t last = UINT64_MAX;
    int32_t number = -1;
    for (size_t q = 0; q < t->point_count; ++q) {
        uint32_t place;
        const uint64_t home = home_of(ab_tile_x(t->cell[q]), ab_tile_y(t->cell[q]), &place);
        if (home != last) {
            last = home;
            number = find_tile(t, home);
            if (number < 0) return false;
        }
        const int32_t *around = t->tiles[number].around;
        int low[2], high[2];
        spread_of(t, place, low, high);
        for (int dy = low[1]; dy <= high[1]; ++dy)
            for (int dx = low[0]; dx <= high[0]; ++dx)
                if (around[(dy + 1) * 3 + dx + 1] < 0) return false;
        t->slot[q] = (uint32_t)number * AB_TILE_NODES + place;
    }
    return true;
}

/* Points by tile, cell and number. */
static void sort_points(fem_trace *t) {
    const size_t cells = t->tile_count * AB_TILE_NODES;
    uint32_t *start = t->cell_start;
    memset(start, 0, (cells + 1) * sizeof *start);
    for (size_t q = 0; q < t->point_count; ++q) ++start[t->slot[q] + 1];
    for (size_t k = 0; k < cells; ++k) start[k + 1] += start[k];
    for (size_t q = 0; q < t->point_count; ++q) t->order[start[t->slot[q]]++] = (uint32_t)q;
    for (size_t k = cells; k > 0; --k) start[k] = start[k - 1];
    start[0] = 0;
}

int fem_trace_cells_around(const fem_trace *t, uint32_t node, uint32_t first[16], uint32_t last[16]) {
    const uint32_t home = node / AB_TILE_NODES;
    const int i = (int)(node % AB_TILE), j = (int)(node % AB_TILE_NODES) / AB_TILE, side = t->width > 2 ? 4 : 2;
    for (int c = 0; c < side * side; ++c) {
        const int ci = i - side / 2 + c % side, cj = j - side / 2 + c / side, dx = ci < 0 ? -1 : ci / AB_TILE,
                  dy = cj < 0 ? -1 : cj / AB_TILE;
        const int32_t k = dx || dy ? t->tiles[home].around[(dy + 1) * 3 + dx + 1] : (int32_t)home;
        first[c] = last[c] = 0;
        if (k < 0) continue;
        const uint32_t *start = t->cell_start + (size_t)k * AB_TILE_NODES + (cj - dy * AB_TILE) * AB_TILE + ci - dx * AB_TILE;
        first[c] = start[0];
        last[c] = start[1];
    }
    return side * side;
}

/* Values of the hat functions of the two nodes of a cell in one direction, at s cells from the grid's corner; i: the first node. */
static inline void hats(double s, int32_t i, double n[2]) {
    n[1] = ab_smaller(ab_larger(s - i, 0.0), 1.0);
    n[0] = 1.0 - n[1];
}

static void scatter(fem_trace *t, const fem_inner *inner, size_t k) {
    double *patch = t->patch + k * PATCH_NODES;
    memset(patch, 0, PATCH_NODES * sizeof *patch);
    const uint32_t *start = t->cell_start + k * AB_TILE_NODES;
    const double *x = inner->position, *y = x + inner->ld;
    const int32_t i0 = ab_tile_x(t->key[k]) * AB_TILE, j0 = ab_tile_y(t->key[k]) * AB_TILE;
    for (int c = 0; c < AB_TILE_NODES; ++c) {
        const int i = c % AB_TILE, j = c / AB_TILE;
        double sum[4] = {0.0};
        for (uint32_t s = start[c]; s < start[c + 1]; ++s) {
            const uint32_t q = t->order[s];
            double nx[2], ny[2];
            hats(x[q] * t->inverse_h, i0 + i, nx);
            hats(y[q] * t->inverse_h, j0 + j, ny);
            const double m = inner->mass[q];
            sum[0] += nx[0] * ny[0] * m;
            sum[1] += nx[1] * ny[0] * m;
            sum[2] += nx[0] * ny[1] * m;
            sum[3] += nx[1] * ny[1] * m;
        }
        for (int n = 0; n < 4; ++n) patch[(j + n / 2) * PATCH + i + n % 2] += sum[n];
    }
}

static void assemble(fem_trace *t, size_t k) {
    double *mass = t->mass + k * AB_TILE_NODES;
    const double *own = t->patch + k * PATCH_NODES;
    const int32_t *around = t->tiles[k].around;
    for (int j = 0; j < AB_TILE; ++j)
        for (int i = 0; i < AB_TILE; ++i) mass[j * AB_TILE + i] = own[j * PATCH + i];
    const double *left = around[3] >= 0 ? t->patch + (size_t)around[3] * PATCH_NODES : NULL,
                 *below = around[1] >= 0 ? t->patch + (size_t)around[1] * PATCH_NODES : NULL,
                 *corner = around[0] >= 0 ? t->patch + (size_t)around[0] * PATCH_NODES : NULL;
    for (int n = 0; n < AB_TILE; ++n) {
        if (left) mass[n * AB_TILE] += left[n * PATCH + AB_TILE];
        if (below) mass[n] += below[AB_TILE * PATCH + n];
    }
    if (corner) mass[0] += corner[AB_TILE * PATCH + AB_TILE];
}

/* Masses of a tile's nodes from the points around each. */
static void gather(fem_trace *t, const fem_inner *inner, size_t k) {
    const double *x = inner->position, *y = x + inner->ld;
    for (uint32_t n = 0; n < AB_TILE_NODES; ++n) {
        const double at[2] = {ab_tile_x(t->key[k]) * AB_TILE + (int)n % AB_TILE, ab_tile_y(t->key[k]) * AB_TILE + (int)n / AB_TILE};
        uint32_t first[16], last[16];
        double mass = 0.0;
        const int cells = fem_trace_cells_around(t, (uint32_t)k * AB_TILE_NODES + n, first, last);
        for (int c = 0; c < cells; ++c)
            for (uint32_t s = first[c]; s < last[c]; ++s) {
                const uint32_t q = t->order[s];
                double nx, ny, slope;
                fem_trace_weigh(t, x[q] * t->inverse_h - at[0], &nx, &slope);
                fem_trace_weigh(t, y[q] * t->inverse_h - at[1], &ny, &slope);
                mass += nx * ny * inner->mass[q];
            }
        t->mass[k * AB_TILE_NODES + n] = mass;
    }
}

ab_status fem_trace_update(fem_trace *t, const fem_inner *inner, ab_report *report) {
    const size_t count = inner->count;
    t->saw_inmost = false;
    bool moved = t->version == 0 || count != t->point_count;
    if (moved) {
        if (count > t->point_capacity || !t->cell) {
            const size_t n = count + 16;
            if (!ab_memory_resize(&t->cell, n, sizeof *t->cell) || !ab_memory_resize(&t->slot, n, sizeof *t->slot) ||
                !ab_memory_resize(&t->order, n, sizeof *t->order))
                goto no_memory;
            t->point_capacity = n;
        }
        t->point_count = count;
        memset(t->cell, 0xff, count * sizeof *t->cell);
        bool all;
        AB_TRY(find_cells(t, inner, &all, report));
        if (!list_tiles(t)) goto no_memory;
    } else {
        AB_TRY(find_cells(t, inner, &moved, report));
    }
    if (moved) {
        if (!place_points(t) && (!list_tiles(t) || !place_points(t))) goto no_memory;
        sort_points(t);
    }
    if (t->width > 2) {
#pragma omp parallel for schedule(static) if (count >= PARALLEL_FROM)
        for (size_t k = 0; k < t->tile_count; ++k) gather(t, inner, k);
        return AB_OK;
    }
#pragma omp parallel for schedule(static) if (count >= PARALLEL_FROM)
    for (size_t k = 0; k < t->tile_count; ++k) scatter(t, inner, k);
#pragma omp parallel for schedule(static) if (count >= PARALLEL_FROM)
    for (size_t k = 0; k < t->tile_count; ++k) assemble(t, k);
    return AB_OK;
no_memory:
    return ab_report_failure(report, "body '%s': no memory for the trace of %zu points on the grid", t->body, count);
}

void fem_trace_tiles(const fem_trace *t, ab_node_tiles *tiles) {
    *tiles = (ab_node_tiles){.count = t->tile_count, .key = t->key, .mass = t->mass, .stride = 1, .version = t->version};
}

bool fem_trace_saw_inmost(const fem_trace *t) { return t->saw_inmost; }
void fem_trace_note_inmost(fem_trace *t, bool saw) { t->saw_inmost = saw; }
