/* share.c: sums that a response keeps at contact points on shared nodes, such as the energy of a spring, while the bodies slide on: nodes come and go, what was
 * stored between the bodies stays there. In every step each point shares its sum with the points in the cells around it, so that in the end neighbours have it in
 * proportion to area x overlap^2, which is what springs at these places hold; the total is kept. What nobody near could hold, as the bodies part, is let go. */
#include <math.h>
#include <stdlib.h>

#include "contact/contact.h"
#include "core/vector.h"

typedef struct contact_cell { /* a contact point, by the cell of its place */
    uint64_t key;
    uint32_t point;
} contact_cell;

static int compare_cells(const void *a, const void *b) {
    const contact_cell *x = a, *y = b;
    if (x->key != y->key) return x->key > y->key ? 1 : -1;
    return (x->point > y->point) - (x->point < y->point);
}

static void cell_of(double x, double y, double cell, int32_t at[2]) {
    at[0] = (int32_t)fmax(-1e9, fmin(1e9, rint(x / cell)));
    at[1] = (int32_t)fmax(-1e9, fmin(1e9, rint(y / cell)));
}

/* Points in a cell and the eight around it: three runs of the sorted list. */
static void runs_around(const contact_sums *sums, size_t count, const int32_t at[2], size_t begin[3], size_t end[3]) {
    for (int row = 0; row < 3; ++row) {
        const uint64_t from = ab_tile_key(at[0] - 1, at[1] + row - 1), to = ab_tile_key(at[0] + 1, at[1] + row - 1);
        size_t low = 0, high = count;
        while (low < high) {
            const size_t middle = (low + high) / 2;
            if (sums->cell[middle].key < from)
                low = middle + 1;
            else
                high = middle;
        }
        begin[row] = low;
        while (low < count && sums->cell[low].key <= to) ++low;
        end[row] = low;
    }
}

static double weight_around(const contact_sums *sums, size_t count, const int32_t at[2]) {
    size_t begin[3], end[3];
    runs_around(sums, count, at, begin, end);
    double sum = 0.0;
    for (int row = 0; row < 3; ++row)
        for (size_t k = begin[row]; k < end[row]; ++k) sum += sums->weight[sums->cell[k].point];
    return sum;
}

static bool reserve(contact_sums *sums, size_t points, size_t old) {
    const size_t wanted = points > old ? points : old;
    if (wanted <= sums->capacity && sums->cell) return true;
    const size_t n = 2 * wanted + 64;
    free(sums->cell), free(sums->weight), free(sums->around);
    sums->cell = malloc(n * sizeof *sums->cell);
    sums->weight = malloc(n * sizeof *sums->weight);
    sums->around = malloc(n * sizeof *sums->around);
    sums->capacity = n;
    return sums->cell && sums->weight && sums->around;
}

void contact_sums_destroy(contact_sums *sums) {
    free(sums->cell), free(sums->weight), free(sums->around), free(sums->old_place), free(sums->now);
}

/* Hands the sum of one point of the last step on. at: its cell; self: which point it is now, UINT32_MAX where it is none that could hold a part. Between points that
 * stay the exchange is mutual, w_i w_j over the larger of the weights around either: what comes back is as much when the sums are in proportion to the weights. */
static void hand_on(const contact_sums *sums, size_t count, const int32_t at[2], uint32_t self, double sum, double *out) {
    const double all = self == UINT32_MAX ? weight_around(sums, count, at) : sums->around[self];
    if (!(all > 0.0)) return;
    size_t begin[3], end[3];
    runs_around(sums, count, at, begin, end);
    double left = 1.0;
    for (int row = 0; row < 3; ++row)
        for (size_t k = begin[row]; k < end[row]; ++k) {
            const uint32_t i = sums->cell[k].point;
            if (i == self) continue;
            const double part = sums->weight[i] / (self == UINT32_MAX ? all : ab_larger(all, sums->around[i]));
            out[i] += part * sum;
            left -= part;
        }
    if (self != UINT32_MAX) out[self] += ab_larger(0.0, left) * sum;
}

bool contact_share_sums(contact_points *points) {
    contact_sums *sums = &points->sums;
    ab_points *v = &points->view;
    if (!sums->rows || !points->old_count) return true;
    if (!reserve(sums, v->count, points->old_count)) return false;
    for (size_t i = 0; i < v->count; ++i) {
        int32_t at[2];
        cell_of(v->position[i], v->position[v->ld + i], v->cell, at);
        sums->cell[i] = (contact_cell){ab_tile_key(at[0], at[1]), (uint32_t)i};
        sums->weight[i] = v->gap[i] < 0.0 ? v->area[i] * v->gap[i] * v->gap[i] : 0.0;
    }
    qsort(sums->cell, v->count, sizeof *sums->cell, compare_cells);
    for (size_t k = 0; k < v->count; ++k)
        sums->around[sums->cell[k].point] =
            weight_around(sums, v->count, (const int32_t[2]){ab_tile_x(sums->cell[k].key), ab_tile_y(sums->cell[k].key)});
    for (size_t row = 0; row < points->states; ++row) {
        if (!(sums->rows >> row & 1)) continue;
        double *out = (double *)(uintptr_t)v->state0 + row * v->ld;
        for (size_t i = 0; i < v->count; ++i) out[i] = 0.0;
        for (size_t j = 0; j < points->old_count; ++j) {
            const double sum = points->old_state[row * points->old_capacity + j];
            if (sum == 0.0) continue;
            const uint32_t now = sums->now[j], self = now != UINT32_MAX && sums->weight[now] > 0.0 ? now : UINT32_MAX;
            int32_t at[2];
            cell_of(sums->old_place[2 * j], sums->old_place[2 * j + 1], v->cell, at);
            if (self != UINT32_MAX) cell_of(v->position[self], v->position[v->ld + self], v->cell, at);
            hand_on(sums, v->count, at, self, sum, out);
        }
    }
    return true;
}
