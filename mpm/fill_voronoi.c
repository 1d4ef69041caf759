/* fill_voronoi.c: cells of a Voronoi diagram, each made alone: a square around the generator is cut by the lines half way to its neighbours, from near to far, until
 * none can be near enough to matter (Rycroft 2009, "Voro++", does the same). So cells can be made on many threads with one answer, points on a lattice or a
 * circle are no special case, and no diagram needs to be kept. A cell that may reach the outline is then cut by the trapezoids of the inside. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mpm/fill_interior.h"

static const double REACH = 3; /* half the side of the first square; enough for all but the first rounds */

/* ---- the generators ------------------------------------------------------------------------------------------------------- */

ab_status ab_voronoi_create(const ab_interior *interior, size_t count, ab_voronoi *v, const char *body, ab_report *report) {
    const size_t buckets = (size_t)interior->buckets.count[0] * interior->buckets.count[1];
    *v = (ab_voronoi){.interior = interior, .count = count};
    v->start = malloc((buckets + 1) * sizeof *v->start);
    v->list = malloc((count + 1) * sizeof *v->list);
    if (v->start && v->list) return AB_OK;
    ab_voronoi_clear(v);
    return ab_report_failure(report, "body '%s': no memory for %zu points", body, count);
}

void ab_voronoi_clear(ab_voronoi *v) {
    free(v->start);
    free(v->list);
    *v = (ab_voronoi){0};
}

static size_t bucket_of(const ab_buckets *b, const double x[2]) {
    return ab_bucket_at(b, ab_bucket_of(b, 0, x[0]), ab_bucket_of(b, 1, x[1]));
}

void ab_voronoi_sort(ab_voronoi *v, const double (*x)[2]) {
    const ab_buckets *b = &v->interior->buckets;
    const size_t buckets = (size_t)b->count[0] * b->count[1];
    v->x = x;
    memset(v->start, 0, (buckets + 1) * sizeof *v->start);
    for (size_t i = 0; i < v->count; i++) v->start[bucket_of(b, x[i])]++;
    size_t sum = 0;
    for (size_t k = 0; k <= buckets; k++) {
        sum += v->start[k];
        v->start[k] = sum;
    }
    for (size_t i = v->count; i-- > 0;) v->list[--v->start[bucket_of(b, x[i])]] = (uint32_t)i;
}

/* ---- convex polygons ------------------------------------------------------------------------------------------------------ */

static bool reserve(ab_convex *c, size_t count) {
    if (count <= c->capacity) return true;
    const size_t capacity = 2 * count + 16;
    double(*x)[2] = realloc(c->x, capacity * sizeof *x);
    if (x) c->x = x;
    int32_t *side = realloc(c->side, capacity * sizeof *side);
    if (side) c->side = side;
    if (!x || !side) return false;
    c->capacity = capacity;
    return true;
}

static void clear(ab_convex *c) {
    free(c->x);
    free(c->side);
    *c = (ab_convex){0};
}

static bool copy(ab_convex *to, const ab_convex *from) {
    if (!reserve(to, from->count)) return false;
    to->count = from->count;
    memcpy(to->x, from->x, from->count * sizeof *from->x);
    memcpy(to->side, from->side, from->count * sizeof *from->side);
    return true;
}

/* Keeps n.x <= d; the new side is `side`. spare is overwritten. False: no memory. */
static bool cut(ab_convex *c, ab_convex *spare, const double n[2], double d, int32_t side) {
    size_t beyond = 0;
    for (size_t k = 0; k < c->count; k++) beyond += n[0] * c->x[k][0] + n[1] * c->x[k][1] > d;
    if (beyond == 0) return true;
    if (beyond == c->count) {
        c->count = 0;
        return true;
    }
    if (!reserve(spare, c->count + 2)) return false;
    size_t count = 0;
    for (size_t k = 0; k < c->count; k++) {
        const double *a = c->x[k], *b = c->x[k + 1 < c->count ? k + 1 : 0];
        const double fa = n[0] * a[0] + n[1] * a[1] - d, fb = n[0] * b[0] + n[1] * b[1] - d;
        if (fa <= 0) {
            memcpy(spare->x[count], a, sizeof spare->x[count]);
            spare->side[count++] = c->side[k];
        }
        if ((fa <= 0) == (fb <= 0)) continue;
        const double share = fa / (fa - fb);
        for (int q = 0; q < 2; q++) spare->x[count][q] = a[q] + share * (b[q] - a[q]);
        spare->side[count++] = fa <= 0 ? side : c->side[k];
    }
    spare->count = count;
    const ab_convex swapped = *c;
    *c = *spare;
    *spare = swapped;
    return true;
}

static void add_moments(const ab_convex *c, ab_moments *m) {
    for (size_t k = 0; k < c->count; k++) {
        const double *p = c->x[k], *q = c->x[k + 1 < c->count ? k + 1 : 0], w = p[0] * q[1] - p[1] * q[0];
        m->area += w / 2;
        m->u += w * (p[0] + q[0]) / 6;
        m->v += w * (p[1] + q[1]) / 6;
        m->uu += w * (p[0] * p[0] + p[0] * q[0] + q[0] * q[0]) / 12;
        m->vv += w * (p[1] * p[1] + p[1] * q[1] + q[1] * q[1]) / 12;
        m->uv += w * (p[0] * q[1] + 2 * p[0] * p[1] + 2 * q[0] * q[1] + q[0] * p[1]) / 24;
    }
}

/* ---- one cell ------------------------------------------------------------------------------------------------------------- */

void ab_cell_work_clear(ab_cell_work *work) {
    clear(&work->cell);
    clear(&work->spare);
    for (size_t k = 0; k < work->capacity; k++) clear(&work->piece[k].shape);
    free(work->piece);
    *work = (ab_cell_work){0};
}

static double farthest2(const ab_convex *c) {
    double far = 0;
    for (size_t k = 0; k < c->count; k++) far = fmax(far, c->x[k][0] * c->x[k][0] + c->x[k][1] * c->x[k][1]);
    return far;
}

/* Cuts the cell by the neighbours in a bucket. Of two generators at one place the first has the cell. */
static bool cut_by_bucket(const ab_voronoi *v, size_t i, size_t bucket, ab_cell_work *w, double *far2) {
    for (size_t k = v->start[bucket]; k < v->start[bucket + 1]; k++) {
        const size_t j = v->list[k];
        const double d[2] = {v->x[j][0] - v->x[i][0], v->x[j][1] - v->x[i][1]}, dd = d[0] * d[0] + d[1] * d[1];
        if (j == i || dd >= 4 * *far2) continue;
        if (dd == 0) {
            if (j < i) w->cell.count = 0;
        } else {
            if (!cut(&w->cell, &w->spare, d, 0.5 * dd, (int32_t)j)) return false;
            *far2 = farthest2(&w->cell);
        }
        if (w->cell.count == 0) return true;
    }
    return true;
}

/* The cell within a square of half side `reach`. */
static bool make_cell(const ab_voronoi *v, size_t i, double reach, ab_cell_work *w) {
    ab_convex *c = &w->cell;
    if (!reserve(c, 4)) return false;
    c->count = 4;
    for (int k = 0; k < 4; k++) {
        c->x[k][0] = k == 1 || k == 2 ? reach : -reach;
        c->x[k][1] = k >= 2 ? reach : -reach;
        c->side[k] = AB_SIDE_BOX;
    }
    const ab_buckets *b = &v->interior->buckets;
    const long columns = b->count[0], rows = b->count[1], bi = ab_bucket_of(b, 0, v->x[i][0]), bj = ab_bucket_of(b, 1, v->x[i][1]);
    const long most = columns > rows ? columns : rows;
    double far2 = 2 * reach * reach;
    for (long ring = 0; ring <= most; ring++) {
        const double near = (double)(ring - 1) * b->size; /* nothing in this ring is nearer */
        if (ring > 1 && near * near >= 4 * far2) break;
        for (long j = bj - ring; j <= bj + ring; j++) {
            if (j < 0 || j >= rows) continue;
            const long step = j == bj - ring || j == bj + ring || ring == 0 ? 1 : 2 * ring;
            for (long k = bi - ring; k <= bi + ring; k += step) {
                if (k < 0 || k >= columns) continue;
                if (!cut_by_bucket(v, i, ab_bucket_at(b, (uint32_t)k, (uint32_t)j), w, &far2)) return false;
                if (c->count == 0) return true;
            }
        }
    }
    return true;
}

static bool has_box_side(const ab_convex *c) {
    for (size_t k = 0; k < c->count; k++)
        if (c->side[k] == AB_SIDE_BOX) return true;
    return false;
}

static void range_of(const ab_voronoi *v, size_t i, const ab_convex *c, uint32_t from[2], uint32_t to[2]) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t k = 0; k < c->count; k++)
        for (int q = 0; q < 2; q++) {
            low[q] = fmin(low[q], c->x[k][q]);
            high[q] = fmax(high[q], c->x[k][q]);
        }
    for (int q = 0; q < 2; q++) {
        from[q] = ab_bucket_of(&v->interior->buckets, q, v->x[i][q] + low[q]);
        to[q] = ab_bucket_of(&v->interior->buckets, q, v->x[i][q] + high[q]);
    }
}

static bool all_whole(const ab_interior *in, const uint32_t from[2], const uint32_t to[2]) {
    for (uint32_t j = from[1]; j <= to[1]; j++)
        for (uint32_t k = from[0]; k <= to[0]; k++)
            if (!in->whole[ab_bucket_at(&in->buckets, k, j)]) return false;
    return true;
}

/* Keeps the side of an edge on which the body is. */
static bool cut_by_edge(const ab_interior *in, uint32_t e, const double from[2], ab_convex *c, ab_convex *spare) {
    const ab_edge *g = &in->edge[e];
    const double dx = g->to[0] - g->from[0], dy = g->to[1] - g->from[1], length = hypot(dx, dy);
    const double n[2] = {dy / length, -dx / length};
    return cut(c, spare, n, n[0] * (g->from[0] - from[0]) + n[1] * (g->from[1] - from[1]), AB_SIDE_EDGE - (int32_t)e);
}

/* The piece of the cell in a trapezoid, where there is one. */
static bool add_piece(const ab_voronoi *v, size_t i, uint32_t part, ab_cell_work *w) {
    const ab_interior *in = v->interior;
    const ab_trapezoid *t = &in->part[part];
    const double *from = v->x[i];
    if (w->count == w->capacity) {
        const size_t capacity = 2 * w->capacity + 8;
        ab_cell_piece *piece = realloc(w->piece, capacity * sizeof *piece);
        if (!piece) return false;
        memset(piece + w->capacity, 0, (capacity - w->capacity) * sizeof *piece);
        w->piece = piece;
        w->capacity = capacity;
    }
    ab_cell_piece *p = &w->piece[w->count];
    if (!copy(&p->shape, &w->cell)) return false;
    if (!cut(&p->shape, &w->spare, (const double[2]){0, -1}, from[1] - t->low, AB_SIDE_LOW) ||
        (p->shape.count && !cut(&p->shape, &w->spare, (const double[2]){0, 1}, t->high - from[1], AB_SIDE_HIGH)) ||
        (p->shape.count && !cut_by_edge(in, t->left, from, &p->shape, &w->spare)) ||
        (p->shape.count && !cut_by_edge(in, t->right, from, &p->shape, &w->spare)))
        return false;
    if (p->shape.count < 3) return true;
    p->part = part;
    p->root = (uint32_t)w->count;
    p->moments = (ab_moments){0};
    add_moments(&p->shape, &p->moments);
    if (p->moments.area > 0) w->count++;
    return true;
}

/* Ends of the level side of a piece at the bottom or top of its trapezoid. */
static bool level_side(const ab_cell_piece *p, int32_t side, double range[2]) {
    for (size_t k = 0; k < p->shape.count; k++) {
        if (p->shape.side[k] != side) continue;
        const double a = p->shape.x[k][0], b = p->shape.x[(k + 1) % p->shape.count][0];
        range[0] = fmin(a, b);
        range[1] = fmax(a, b);
        return true;
    }
    return false;
}

static uint32_t root_of(const ab_cell_work *w, uint32_t k) {
    while (w->piece[k].root != k) k = w->piece[k].root;
    return k;
}

/* Pieces on both sides of a height that share a stretch of it belong together. */
static void connect(const ab_interior *in, ab_cell_work *w) {
    for (uint32_t a = 0; a < w->count; a++) {
        double top[2], bottom[2];
        if (!level_side(&w->piece[a], AB_SIDE_HIGH, top)) continue;
        for (uint32_t b = 0; b < w->count; b++) {
            if (in->part[w->piece[b].part].low != in->part[w->piece[a].part].high || !level_side(&w->piece[b], AB_SIDE_LOW, bottom))
                continue;
            if (fmin(top[1], bottom[1]) - fmax(top[0], bottom[0]) <= 1e-9) continue;
            const uint32_t p = root_of(w, a), q = root_of(w, b);
            w->piece[p > q ? p : q].root = p > q ? q : p;
        }
    }
    for (uint32_t a = 0; a < w->count; a++) w->piece[a].root = root_of(w, a);
}

/* How far a place (from the generator) is out of a convex polygon; negative inside. */
static double outside(const ab_convex *c, const double x[2]) {
    double worst = -INFINITY;
    for (size_t k = 0; k < c->count; k++) {
        const double *a = c->x[k], *b = c->x[k + 1 < c->count ? k + 1 : 0], dx = b[0] - a[0], dy = b[1] - a[1], length = hypot(dx, dy);
        if (length > 0) worst = fmax(worst, (dy * (x[0] - a[0]) - dx * (x[1] - a[1])) / length);
    }
    return worst;
}

/* Pieces of the cell by trapezoid, and which of them hang together with the one that holds the generator. */
static bool divide(const ab_voronoi *v, size_t i, const uint32_t from[2], const uint32_t to[2], ab_cell_work *w) {
    const ab_interior *in = v->interior;
    for (uint32_t j = from[1]; j <= to[1]; j++)
        for (uint32_t k = from[0]; k <= to[0]; k++) {
            const size_t bucket = ab_bucket_at(&in->buckets, k, j);
            for (size_t n = in->start[bucket]; n < in->start[bucket + 1]; n++) {
                /* a part of several buckets is met in the first of them only */
                const ab_trapezoid *t = &in->part[in->list[n]];
                const ab_edge *left = &in->edge[t->left];
                const double x = fmin(ab_edge_at(left, t->low), ab_edge_at(left, t->high));
                const uint32_t first[2] = {ab_bucket_of(&in->buckets, 0, x), ab_bucket_of(&in->buckets, 1, t->low)};
                if (k != (first[0] > from[0] ? first[0] : from[0]) || j != (first[1] > from[1] ? first[1] : from[1])) continue;
                if (!add_piece(v, i, in->list[n], w)) return false;
            }
        }
    connect(in, w);
    double nearest = INFINITY;
    const double none[2] = {0, 0};
    for (size_t k = 0; k < w->count; k++) {
        const double away = outside(&w->piece[k].shape, none);
        if (away >= nearest) continue;
        nearest = away;
        w->home = w->piece[k].root;
    }
    return true;
}

void ab_voronoi_cell(const ab_voronoi *v, size_t i, ab_cell_work *w) {
    const ab_interior *in = v->interior;
    const double widest = fmax(in->high[0] - in->low[0], in->high[1] - in->low[1]);
    for (double reach = REACH;; reach *= 2) {
        const bool last = reach > widest;
        w->count = w->home = 0;
        w->moments = (ab_moments){0};
        if (!make_cell(v, i, reach, w)) break;
        if (w->cell.count == 0) return;
        uint32_t from[2], to[2];
        range_of(v, i, &w->cell, from, to);
        const bool box = has_box_side(&w->cell);
        if (all_whole(in, from, to)) {
            if (box && !last) continue;
            add_moments(&w->cell, &w->moments);
            return;
        }
        if (!divide(v, i, from, to, w)) break;
        bool open = false;
        for (size_t k = 0; k < w->count && box; k++) open = open || has_box_side(&w->piece[k].shape);
        if (open && !last) continue; /* the body goes on beyond the square */
        for (size_t k = 0; k < w->count; k++) {
            const ab_moments *m = &w->piece[k].moments;
            if (w->piece[k].root != w->home) continue;
            w->moments.area += m->area;
            w->moments.u += m->u, w->moments.v += m->v;
            w->moments.uu += m->uu, w->moments.uv += m->uv, w->moments.vv += m->vv;
        }
        if (w->count == 0) w->cell.count = 0;
        return;
    }
    w->no_memory = true;
    w->cell.count = 0;
}

/* The place in a convex polygon that is nearest to x. */
static double nearest_in(const ab_convex *c, const double x[2], double at[2]) {
    if (outside(c, x) <= 0) {
        memcpy(at, x, 2 * sizeof *at);
        return 0;
    }
    double best = INFINITY;
    for (size_t k = 0; k < c->count; k++) {
        const double *a = c->x[k], *b = c->x[k + 1 < c->count ? k + 1 : 0], d[2] = {b[0] - a[0], b[1] - a[1]};
        const double dd = d[0] * d[0] + d[1] * d[1], along = (x[0] - a[0]) * d[0] + (x[1] - a[1]) * d[1];
        const double share = dd > 0 ? fmin(fmax(along / dd, 0), 1) : 0, p[2] = {a[0] + share * d[0], a[1] + share * d[1]};
        const double away = hypot(p[0] - x[0], p[1] - x[1]);
        if (away >= best) continue;
        best = away;
        memcpy(at, p, sizeof p);
    }
    return best;
}

void ab_voronoi_centroid(const ab_voronoi *v, size_t i, const ab_cell_work *w, double x[2]) {
    const double *from = v->x[i], c[2] = {w->moments.u / w->moments.area, w->moments.v / w->moments.area};
    double at[2] = {c[0], c[1]}, best = INFINITY, inner[2] = {0, 0};
    for (size_t k = 0; k < w->count && best > 0; k++) {
        const ab_cell_piece *p = &w->piece[k];
        double place[2] = {0, 0};
        if (p->root != w->home) continue;
        const double away = nearest_in(&p->shape, c, place);
        if (away >= best) continue;
        best = away;
        memcpy(at, place, sizeof place);
        inner[0] = p->moments.u / p->moments.area, inner[1] = p->moments.v / p->moments.area;
    }
    if (best > 0 && isfinite(best)) { /* off the outline, towards the middle of the piece */
        const double way = hypot(inner[0] - at[0], inner[1] - at[1]), share = way > 0.2 ? 0.2 / way : 1;
        for (int q = 0; q < 2; q++) at[q] += share * (inner[q] - at[q]);
    }
    for (int q = 0; q < 2; q++) x[q] = from[q] + at[q];
}
