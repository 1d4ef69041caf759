/* inside_layer.c: the elements along the outer faces of a body, which are all that contact on shared nodes can ever see of it.
 *
 * How deep: a node is shared when the other body has mass there, so some point of it is within 1.5 cells (GIMP; 1 on the linear basis and for inner points), and
 * that point is outside this body. The straight way to it crosses an outer face: the node is no deeper than 1.5 cells, each component taken alone. Inner
 * points give mass to nodes within one cell. So nothing deeper than 2.5 cells gives mass, area or stencil to a shared node; 3 leaves half a cell for points
 * that have come a little too far, and for faces that are looked at in steps of half a cell. Beyond the depth comes one more ring of elements, the rim: when a
 * shared node sees one of its points, the layer has become too thin and is made anew (inside.c), before elements without points come near. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "fem/inside.h"

static const double FURTHEST = 1e9; /* cells from the grid's corner: places further away have no number */

typedef struct cells {
    uint64_t *key; /* ab_tile_key of the cell's lower left node; ascending once sorted */
    size_t count, capacity;
} cells;

static int compare_keys(const void *a, const void *b) {
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

static void sort_unique(cells *c) {
    if (c->count) qsort(c->key, c->count, sizeof *c->key, compare_keys);
    size_t kept = 0;
    for (size_t k = 0; k < c->count; ++k)
        if (kept == 0 || c->key[k] != c->key[kept - 1]) c->key[kept++] = c->key[k];
    c->count = kept;
}

static bool add_cell(cells *c, int32_t i, int32_t j) {
    const uint64_t key = ab_tile_key(i, j);
    if (c->count && c->key[c->count - 1] == key) return true;
    if (!ab_memory_grow((void **)&c->key, &c->capacity, c->count + 1, sizeof *c->key)) return false;
    c->key[c->count++] = key;
    return true;
}

/* Cells along one outer face, in steps of half a cell. */
static bool add_face(const fem_body *body, const uint32_t *vertex, cells *to) {
    const double inverse_h = 1.0 / body->scene->grid_cell, *a = body->x + 2 * (size_t)vertex[0], *b = body->x + 2 * (size_t)vertex[1];
    double bow[2] = {0.0, 0.0};
    if (vertex[2] != FEM_NONE)
        for (size_t c = 0; c < 2; ++c) bow[c] = body->x[2 * (size_t)vertex[2] + c] - 0.5 * (a[c] + b[c]);
    const double length = (hypot(b[0] - a[0], b[1] - a[1]) + 2.0 * hypot(bow[0], bow[1])) * inverse_h;
    if (!(length < FURTHEST)) return true; /* the run has blown up, and others say so */
    const long steps = (long)ceil(2.0 * length) + 1;
    for (long s = 0; s <= steps; ++s) {
        const double xi = 2.0 * (double)s / (double)steps - 1.0;
        double x[2];
        for (int c = 0; c < 2; ++c) x[c] = floor((0.5 * (a[c] + b[c]) + 0.5 * xi * (b[c] - a[c]) + (1.0 - xi * xi) * bow[c]) * inverse_h);
        if (!(fabs(x[0]) < FURTHEST && fabs(x[1]) < FURTHEST)) continue;
        if (!add_cell(to, (int32_t)x[0], (int32_t)x[1])) return false;
    }
    return true;
}

/* All cells no more than `reach` columns (dx 1) or rows (dy 1) away. */
static bool widen(cells *c, int reach, int dx, int dy) {
    cells wide = {0};
    bool good = true;
    for (int s = -reach; s <= reach; ++s) /* each shift by itself is in order */
        for (size_t k = 0; good && k < c->count; ++k) good = add_cell(&wide, ab_tile_x(c->key[k]) + s * dx, ab_tile_y(c->key[k]) + s * dy);
    ab_memory_give(c->key, c->capacity * sizeof *c->key);
    *c = wide;
    if (good) sort_unique(c);
    return good;
}

/* True where one of the cells of a row, from column `first` to `last`, is in the list. */
static bool has_row(const cells *c, int32_t first, int32_t last, int32_t row) {
    const uint64_t from = ab_tile_key(first, row), to = ab_tile_key(last, row);
    size_t low = 0, high = c->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (c->key[middle] < from)
            low = middle + 1;
        else
            high = middle;
    }
    return low < c->count && c->key[low] <= to;
}

/* True where the box around an element touches one of the cells, or is nowhere. */
static bool touches(const fem_body *body, size_t element, const cells *c) {
    const size_t nodes = (size_t)body->element->nodes;
    const uint32_t *node = body->mesh->connectivity + element * nodes;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t a = 0; a < nodes; ++a)
        for (size_t d = 0; d < 2; ++d) {
            const double x = floor(body->x[2 * (size_t)node[a] + d] / body->scene->grid_cell);
            low[d] = fmin(low[d], x);
            high[d] = fmax(high[d], x);
        }
    for (int d = 0; d < 2; ++d)
        if (!(low[d] > -FURTHEST && high[d] < FURTHEST)) return true;
    for (double row = low[1]; row <= high[1]; row += 1.0)
        if (has_row(c, (int32_t)low[0], (int32_t)high[0], (int32_t)row)) return true;
    return false;
}

bool fem_layer_mark(const fem_body *body, double depth, uint8_t *marks) {
    const fem_faces *faces = body->outer->faces;
    const size_t nodes = (size_t)body->element->nodes;
    const int reach = (int)fmin(ceil(depth), 1e6);
    cells near = {0};
    bool good = true;
    for (size_t f = 0; good && f < faces->count; ++f) good = add_face(body, faces->vertex + 3 * f, &near);
    if (good) sort_unique(&near);
    good = good && widen(&near, reach, 1, 0) && widen(&near, reach, 0, 1);
    uint8_t *of_layer = good ? ab_memory_take(body->nodes) : NULL; /* nodes of elements in the layer */
    if (of_layer) {
        for (size_t e = 0; e < body->elements; ++e) {
            marks[e] = touches(body, e, &near) ? FEM_LAYER : FEM_DEEP;
            for (size_t a = 0; a < nodes && marks[e] == FEM_LAYER; ++a) of_layer[body->mesh->connectivity[e * nodes + a]] = 1;
        }
        for (size_t e = 0; e < body->elements; ++e)
            for (size_t a = 0; a < nodes && marks[e] == FEM_DEEP; ++a)
                if (of_layer[body->mesh->connectivity[e * nodes + a]]) marks[e] = FEM_RIM;
    }
    ab_memory_give(near.key, near.capacity * sizeof *near.key);
    good = of_layer != NULL;
    ab_memory_give(of_layer, body->nodes);
    return good;
}
