/* fill_interior.c: divides the inside of an outline into trapezoids (de Berg et al., Computational Geometry, 2008, ch. 6), between the heights of its vertices, and finds
 * which of them lie near a place. Convex pieces are all that a cell of a Voronoi diagram has to be cut with, whatever the outline. */
#include "mpm/fill_interior.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double BUCKET = 1.5; /* about two points in each */

static int by_value(const void *a, const void *b) {
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

typedef struct rise { /* an edge that is not level, by its lower end */
    double low, high;
    uint32_t edge;
} rise;

static int by_low(const void *a, const void *b) {
    const rise *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    return (p->edge > q->edge) - (p->edge < q->edge);
}

typedef struct crossing { /* of an edge through a slab */
    double x;
    uint32_t edge;
} crossing;

/* The slab from low to high: pairs of edges in order of x; a pair that was there in the slab below goes on. open[e]: the part that edge e bounds on the left. */
static bool add_slab(ab_interior *in, size_t *capacity, const crossing *active, size_t count, double low, double high, size_t *open) {
    for (size_t k = 0; k + 1 < count; k += 2) {
        const uint32_t left = active[k].edge, right = active[k + 1].edge;
        ab_trapezoid *below = open[left] != SIZE_MAX ? &in->part[open[left]] : NULL;
        if (below && below->high == low && below->right == right) {
            below->high = high;
            continue;
        }
        if (in->part_count == *capacity) {
            const size_t more = 2 * *capacity + 64;
            ab_trapezoid *part = realloc(in->part, more * sizeof *part);
            if (!part) return false;
            in->part = part;
            *capacity = more;
        }
        open[left] = in->part_count;
        in->part[in->part_count++] = (ab_trapezoid){low, high, left, right};
    }
    return true;
}

static bool sweep(ab_interior *in, double *height, rise *rising, crossing *active, size_t *open) {
    const ab_edge *edge = in->edge;
    size_t rises = 0, levels = 0, capacity = 0, count = 0, next = 0;
    for (size_t e = 0; e < in->edge_count; e++) {
        height[e] = edge[e].from[1];
        open[e] = SIZE_MAX;
        if (edge[e].from[1] != edge[e].to[1])
            rising[rises++] = (rise){fmin(edge[e].from[1], edge[e].to[1]), fmax(edge[e].from[1], edge[e].to[1]), (uint32_t)e};
    }
    qsort(rising, rises, sizeof *rising, by_low);
    qsort(height, in->edge_count, sizeof *height, by_value);
    for (size_t k = 0; k < in->edge_count; k++)
        if (levels == 0 || height[k] != height[levels - 1]) height[levels++] = height[k];
    for (size_t s = 0; s + 1 < levels; s++) {
        const double low = height[s], high = height[s + 1], middle = 0.5 * (low + high);
        size_t kept = 0;
        for (size_t k = 0; k < count; k++) /* those that end here are done */
            if (fmax(edge[active[k].edge].from[1], edge[active[k].edge].to[1]) > low) active[kept++].edge = active[k].edge;
        for (; next < rises && rising[next].low <= low; next++) active[kept++].edge = rising[next].edge;
        count = kept;
        for (size_t k = 0; k < count; k++) active[k].x = ab_edge_at(&edge[active[k].edge], middle);
        for (size_t k = 1; k < count; k++) { /* nearly in order already */
            const crossing moved = active[k];
            size_t at = k;
            for (; at > 0 && active[at - 1].x > moved.x; at--) active[at] = active[at - 1];
            active[at] = moved;
        }
        if (!add_slab(in, &capacity, active, count, low, high, open)) return false;
    }
    return true;
}

/* Widths at the two heights. */
static void widths(const ab_interior *in, const ab_trapezoid *t, double width[2], double left[2]) {
    for (int k = 0; k < 2; k++) {
        const double y = k ? t->high : t->low;
        left[k] = ab_edge_at(&in->edge[t->left], y);
        width[k] = fmax(0, ab_edge_at(&in->edge[t->right], y) - left[k]);
    }
}

/* ---- buckets -------------------------------------------------------------------------------------------------------------- */

static void part_range(const ab_interior *in, const ab_trapezoid *t, uint32_t from[2], uint32_t to[2]) {
    double width[2], left[2];
    widths(in, t, width, left);
    from[0] = ab_bucket_of(&in->buckets, 0, fmin(left[0], left[1]));
    to[0] = ab_bucket_of(&in->buckets, 0, fmax(left[0] + width[0], left[1] + width[1]));
    from[1] = ab_bucket_of(&in->buckets, 1, t->low);
    to[1] = ab_bucket_of(&in->buckets, 1, t->high);
}

/* Buckets that an edge passes, and those beside them in their rows. */
static void mark_edge(ab_interior *in, const ab_edge *e) {
    const ab_buckets *b = &in->buckets;
    const double low = fmin(e->from[1], e->to[1]), high = fmax(e->from[1], e->to[1]), slack = 1e-9 * b->size;
    const uint32_t from = ab_bucket_of(b, 1, low - slack), to = ab_bucket_of(b, 1, high + slack);
    for (uint32_t j = from; j <= to; j++) {
        const double y[2] = {fmax(low, b->low[1] + b->size * j), fmin(high, b->low[1] + b->size * (j + 1))};
        double x[2] = {e->from[0], e->to[0]};
        if (high - low > 1e-9 * b->size)
            for (int k = 0; k < 2; k++) x[k] = ab_edge_at(e, y[k]);
        const uint32_t first = ab_bucket_of(b, 0, fmin(x[0], x[1]) - slack), last = ab_bucket_of(b, 0, fmax(x[0], x[1]) + slack);
        for (uint32_t i = first; i <= last; i++) in->whole[ab_bucket_at(b, i, j)] = false;
    }
}

static bool fill_buckets(ab_interior *in, double points) {
    ab_buckets *b = &in->buckets;
    double sides[2];
    b->size = BUCKET;
    for (int k = 0; k < 2; k++) {
        sides[k] = in->high[k] - in->low[k];
        b->low[k] = in->low[k];
    }
    const double most = 4 * points + 1e5; /* a thin body in a wide box shall not need more than it has points */
    while (ceil(sides[0] / b->size) * ceil(sides[1] / b->size) > most) b->size *= 1.25;
    for (int k = 0; k < 2; k++) b->count[k] = (uint32_t)fmax(1, ceil(sides[k] / b->size));
    const size_t buckets = (size_t)b->count[0] * b->count[1];
    in->start = calloc(buckets + 1, sizeof *in->start);
    in->whole = malloc(buckets * sizeof *in->whole);
    if (!in->start || !in->whole) return false;
    for (int pass = 0; pass < 2; pass++) { /* count, then write */
        for (size_t p = in->part_count; p-- > 0;) {
            uint32_t from[2], to[2];
            part_range(in, &in->part[p], from, to);
            for (uint32_t j = from[1]; j <= to[1]; j++)
                for (uint32_t i = from[0]; i <= to[0]; i++) {
                    size_t *at = &in->start[ab_bucket_at(b, i, j)];
                    if (pass == 0)
                        ++*at;
                    else
                        in->list[--*at] = (uint32_t)p;
                }
        }
        if (pass == 1) break;
        size_t sum = 0;
        for (size_t k = 0; k < buckets; k++) {
            sum += in->start[k];
            in->start[k] = sum; /* its end; the second pass moves it down to where it begins */
        }
        in->start[buckets] = sum;
        in->list = malloc((sum + 1) * sizeof *in->list);
        if (!in->list) return false;
    }
    memset(in->whole, 1, buckets * sizeof *in->whole);
    for (size_t e = 0; e < in->edge_count; e++) mark_edge(in, &in->edge[e]);
    for (uint32_t j = 0; j < b->count[1]; j++)
        for (uint32_t i = 0; i < b->count[0]; i++) {
            const double middle[2] = {b->low[0] + b->size * (i + 0.5), b->low[1] + b->size * (j + 0.5)};
            bool *whole = &in->whole[ab_bucket_at(b, i, j)];
            *whole = *whole && middle[0] + 0.5 * b->size <= in->high[0] && middle[1] + 0.5 * b->size <= in->high[1] &&
                     ab_interior_holds(in, middle);
        }
    return true;
}

/* ---- the whole -------------------------------------------------------------------------------------------------------------- */

ab_status ab_interior_create(const ab_edge *edge, size_t count, double points, ab_interior *in, const char *body, ab_report *report) {
    *in = (ab_interior){.edge = edge, .edge_count = count, .low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    for (size_t e = 0; e < count; e++)
        for (int k = 0; k < 2; k++) {
            in->low[k] = fmin(in->low[k], edge[e].from[k]);
            in->high[k] = fmax(in->high[k], edge[e].from[k]);
        }
    double *height = malloc((count + 1) * sizeof *height);
    rise *rising = malloc((count + 1) * sizeof *rising);
    crossing *active = malloc((count + 1) * sizeof *active);
    size_t *open = malloc((count + 1) * sizeof *open);
    bool good = height && rising && active && open && sweep(in, height, rising, active, open);
    free(height);
    free(rising);
    free(active);
    free(open);
    in->sum = good ? malloc((in->part_count + 1) * sizeof *in->sum) : NULL;
    good = in->sum && fill_buckets(in, points);
    if (!good) {
        ab_interior_clear(in);
        return ab_report_failure(report, "body '%s': no memory to divide an outline of %zu edges", body, count);
    }
    in->sum[0] = 0;
    for (size_t p = 0; p < in->part_count; p++) {
        double width[2], left[2];
        widths(in, &in->part[p], width, left);
        in->sum[p + 1] = in->sum[p] + 0.5 * (width[0] + width[1]) * (in->part[p].high - in->part[p].low);
    }
    return AB_OK;
}

void ab_interior_clear(ab_interior *in) {
    free(in->part);
    free(in->sum);
    free(in->start);
    free(in->list);
    free(in->whole);
    *in = (ab_interior){0};
}

bool ab_interior_holds(const ab_interior *in, const double x[2]) {
    for (int k = 0; k < 2; k++)
        if (x[k] < in->low[k] || x[k] > in->high[k]) return false;
    const size_t bucket = ab_bucket_at(&in->buckets, ab_bucket_of(&in->buckets, 0, x[0]), ab_bucket_of(&in->buckets, 1, x[1]));
    for (size_t k = in->start[bucket]; k < in->start[bucket + 1]; k++) {
        const ab_trapezoid *t = &in->part[in->list[k]];
        if (x[1] >= t->low && x[1] <= t->high && x[0] > ab_edge_at(&in->edge[t->left], x[1]) &&
            x[0] < ab_edge_at(&in->edge[t->right], x[1]))
            return true;
    }
    return false;
}

void ab_interior_place(const ab_interior *in, const double random[2], double x[2]) {
    const double wanted = random[0] * in->sum[in->part_count];
    size_t a = 0, b = in->part_count; /* the last part whose sum before it is not above */
    while (a + 1 < b) {
        const size_t middle = (a + b) / 2;
        if (in->sum[middle] <= wanted)
            a = middle;
        else
            b = middle;
    }
    const ab_trapezoid *t = &in->part[a];
    double width[2], left[2];
    widths(in, t, width, left);
    const double part = in->sum[a + 1] - in->sum[a], up = part > 0 ? fmin(fmax((wanted - in->sum[a]) / part, 0), 1) : 0.5;
    /* the width grows evenly with the height: solve w0 s + (w1 - w0) s^2/2 = up (w0 + w1)/2, in the form that has no cancellation */
    const double half = 0.5 * up * (width[0] + width[1]), root = sqrt(width[0] * width[0] + 2 * (width[1] - width[0]) * half);
    const double sum = width[0] + root, share = sum > 0 ? fmin(2 * half / sum, 1) : up;
    x[1] = t->low + share * (t->high - t->low);
    const double from = ab_edge_at(&in->edge[t->left], x[1]), to = ab_edge_at(&in->edge[t->right], x[1]);
    x[0] = from + random[1] * (to - from);
}
