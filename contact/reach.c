/* reach.c: cells and buckets along the faces of one body. A face is followed cell by cell, so that a long oblique one marks a strip, not its bounding box. Cost is
 * in proportion to the faces (and the logarithm of a sort) when they are made, and to points and the faces near them in a step. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/broad_phase.h"
#include "core/vector.h"

static const double MARGIN = 0.25;   /* of a typical face: how far a vertex may move before regions are made anew */
static const double HEADROOM = 1.25; /* reach made over reach needed, so that it serves while points swell and speed up */
static const double WASTE = 3.0;     /* a reach larger than this times what would be made is given up */
static const double FURTHEST = 5e8;  /* cells from the origin: places further away have no number */

typedef struct contact_mark { /* a tile with some cells, or a bucket with a face */
    uint64_t key, what;
} contact_mark;

void contact_reach_destroy(contact_reach *r) {
    free(r->vertex), free(r->tile_key), free(r->tile_cells), free(r->bucket_key), free(r->bucket_start), free(r->bucket_face);
    free(r->near_start), free(r->near_face), free(r->marks);
}

static bool room(void *pointer, size_t *capacity, size_t wanted, size_t size) {
    if (wanted <= *capacity) return true;
    void **p = pointer, *more = realloc(*p, 2 * wanted * size);
    if (!more) return false;
    *p = more;
    *capacity = 2 * wanted;
    return true;
}

/* Two arrays of the same capacity. */
static bool room2(void *first, void *second, size_t *capacity, size_t wanted, size_t size) {
    size_t once = *capacity;
    return room(first, &once, wanted, size) && room(second, capacity, wanted, size);
}

bool contact_reach_reserve(contact_reach *r, size_t vertices, size_t tiles, size_t buckets, size_t faces) {
    return room(&r->vertex, &r->vertex_capacity, 2 * vertices + 1, sizeof *r->vertex) &&
           room2(&r->tile_key, &r->tile_cells, &r->tile_capacity, tiles + 1, sizeof *r->tile_key) &&
           room2(&r->bucket_key, &r->bucket_start, &r->bucket_capacity, buckets + 2, sizeof *r->bucket_key) &&
           room(&r->bucket_face, &r->bucket_face_capacity, faces + 1, sizeof *r->bucket_face);
}

/* ---- faces ----------------------------------------------------------------------------------------------------------------- */

/* The chord of a face, and how far the face leaves it: a quadratic one runs at (1 - xi^2) times the offset of its middle. */
typedef struct chord {
    double from[2], to[2], bulge;
    bool bent;
} chord;

static inline chord chord_of(const ab_surface *s, size_t face) {
    const uint32_t *v = s->face_vertex + 3 * face;
    chord c = {.bulge = 0.0, .bent = v[2] != UINT32_MAX};
    double offset[2] = {0.0, 0.0};
    for (size_t d = 0; d < 2; ++d) {
        const double *x = s->vertex_position + d * s->vertex_ld;
        c.from[d] = x[v[0]];
        c.to[d] = x[v[1]];
        if (v[2] != UINT32_MAX) offset[d] = x[v[2]] - 0.5 * (c.from[d] + c.to[d]);
    }
    if (c.bent) c.bulge = sqrt(offset[0] * offset[0] + offset[1] * offset[1]);
    return c;
}

/* The part of a chord inside a box; false: none (or the face is not finite). */
static bool clip(chord *c, const double low[2], const double high[2]) {
    double first = 0.0, last = 1.0;
    for (int d = 0; d < 2; ++d) {
        const double along = c->to[d] - c->from[d];
        double enter = (low[d] - c->from[d]) / along, leave = (high[d] - c->from[d]) / along;
        if (along == 0.0) {
            if (!(c->from[d] >= low[d] && c->from[d] <= high[d])) return false;
            continue;
        }
        if (enter > leave) {
            const double swap = enter;
            enter = leave;
            leave = swap;
        }
        first = ab_larger(first, enter);
        last = ab_smaller(last, leave);
    }
    if (!(first <= last) || !isfinite(c->from[0] + c->from[1] + c->to[0] + c->to[1])) return false;
    const chord whole = *c;
    for (int d = 0; d < 2; ++d) {
        const double along = whole.to[d] - whole.from[d];
        if (first > 0.0) c->from[d] = whole.from[d] + first * along;
        if (last < 1.0) c->to[d] = whole.from[d] + last * along;
    }
    return true;
}

/* Cells of size `cell` in column i that touch the strip of half width `wide` (in the largest-component norm) along a chord: rows *first to *last. False: none. */
static bool rows_of_column(const chord *c, int axis, double cell, double wide, long i, long *first, long *last) {
    const int other = 1 - axis;
    const double low = (double)i * cell - wide, high = (double)(i + 1) * cell + wide;
    double t0 = 0.0, t1 = 1.0;
    const double along = c->to[axis] - c->from[axis];
    if (along != 0.0) {
        const double a = (low - c->from[axis]) / along, b = (high - c->from[axis]) / along;
        t0 = ab_larger(0.0, ab_smaller(a, b));
        t1 = ab_smaller(1.0, ab_larger(a, b));
        if (!(t0 <= t1)) return false;
    }
    const double y0 = c->from[other] + t0 * (c->to[other] - c->from[other]), y1 = c->from[other] + t1 * (c->to[other] - c->from[other]);
    *first = (long)floor((ab_smaller(y0, y1) - wide) / cell);
    *last = (long)floor((ab_larger(y0, y1) + wide) / cell);
    return true;
}

static bool mark(contact_reach *r, uint64_t key, uint64_t what) {
    if (!room(&r->marks, &r->mark_capacity, r->mark_count + 1, sizeof *r->marks)) return false;
    r->marks[r->mark_count++] = (contact_mark){key, what};
    return true;
}

static long floor_div(long a, long b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

/* Marks the cells of a strip along a chord: in tiles with a bit per cell (face UINT32_MAX), or as buckets with the face in them. */
static bool follow(contact_reach *r, chord c, double cell, double wide, uint32_t face) {
    wide += c.bulge + (c.bent ? 2.0 * r->margin : 0.0); /* by which its bulge may grow while no vertex moves further than the margin */
    const double low[2] = {r->window.low[0] - wide, r->window.low[1] - wide},
                 high[2] = {r->window.high[0] + wide, r->window.high[1] + wide};
    if (!clip(&c, low, high)) return true;
    for (int d = 0; d < 2; ++d)
        if (ab_larger(fabs(c.from[d]), fabs(c.to[d])) + wide > FURTHEST * cell) return true;
    const int axis = fabs(c.to[0] - c.from[0]) >= fabs(c.to[1] - c.from[1]) ? 0 : 1;
    long bound[2][2]; /* no point is beyond the window */
    for (int d = 0; d < 2; ++d) {
        bound[d][0] = (long)floor(ab_larger(r->window.low[d] / cell, -FURTHEST));
        bound[d][1] = (long)floor(ab_smaller(r->window.high[d] / cell, FURTHEST));
    }
    long begin = (long)floor((ab_smaller(c.from[axis], c.to[axis]) - wide) / cell),
         end = (long)floor((ab_larger(c.from[axis], c.to[axis]) + wide) / cell);
    if (begin < bound[axis][0]) begin = bound[axis][0];
    if (end > bound[axis][1]) end = bound[axis][1];
    for (long i = begin; i <= end; ++i) {
        long first, last;
        if (!rows_of_column(&c, axis, cell, wide, i, &first, &last)) continue;
        if (first < bound[1 - axis][0]) first = bound[1 - axis][0];
        if (last > bound[1 - axis][1]) last = bound[1 - axis][1];
        for (long j = first; j <= last; ++j) {
            const long x = axis == 0 ? i : j, y = axis == 0 ? j : i;
            bool kept;
            if (face != UINT32_MAX) {
                kept = mark(r, ab_tile_key((int32_t)x, (int32_t)y), face);
            } else {
                const long tx = floor_div(x, AB_TILE), ty = floor_div(y, AB_TILE);
                const uint64_t key = ab_tile_key((int32_t)tx, (int32_t)ty),
                               bit = (uint64_t)1 << ((y - ty * AB_TILE) * AB_TILE + x - tx * AB_TILE);
                if (r->mark_count && r->marks[r->mark_count - 1].key == key) {
                    r->marks[r->mark_count - 1].what |= bit;
                    kept = true;
                } else {
                    kept = mark(r, key, bit);
                }
            }
            if (!kept) return false;
        }
    }
    return true;
}

static int compare_marks(const void *a, const void *b) {
    const contact_mark *x = a, *y = b;
    if (x->key != y->key) return x->key > y->key ? 1 : -1;
    return (x->what > y->what) - (x->what < y->what);
}

/* ---- making ------------------------------------------------------------------------------------------------------------------ */

static bool make_region(contact_reach *r, const ab_surface *s, double cell, double wide) {
    r->mark_count = 0;
    for (size_t f = 0; f < s->face_count; ++f)
        if (!follow(r, chord_of(s, f), cell, wide, UINT32_MAX)) return false;
    if (r->mark_count) qsort(r->marks, r->mark_count, sizeof *r->marks, compare_marks);
    r->tile_count = 0;
    for (size_t k = 0; k < r->mark_count; ++k) {
        if (r->tile_count && r->tile_key[r->tile_count - 1] == r->marks[k].key) {
            r->tile_cells[r->tile_count - 1] |= r->marks[k].what;
            continue;
        }
        if (!room2(&r->tile_key, &r->tile_cells, &r->tile_capacity, r->tile_count + 1, sizeof *r->tile_key)) return false;
        r->tile_key[r->tile_count] = r->marks[k].key;
        r->tile_cells[r->tile_count++] = r->marks[k].what;
    }
    return true;
}

static bool make_buckets(contact_reach *r, const ab_surface *s) {
    r->mark_count = 0;
    for (size_t f = 0; f < s->face_count; ++f)
        if (!follow(r, chord_of(s, f), r->bucket, r->reach + r->margin, (uint32_t)f)) return false;
    if (r->mark_count) qsort(r->marks, r->mark_count, sizeof *r->marks, compare_marks);
    if (!room(&r->bucket_face, &r->bucket_face_capacity, r->mark_count + 1, sizeof *r->bucket_face)) return false;
    r->bucket_count = 0;
    for (size_t k = 0; k < r->mark_count; ++k) {
        if (!room2(&r->bucket_key, &r->bucket_start, &r->bucket_capacity, r->bucket_count + 2, sizeof *r->bucket_key)) return false;
        if (!k || r->marks[k].key != r->marks[k - 1].key) {
            r->bucket_key[r->bucket_count] = r->marks[k].key;
            r->bucket_start[r->bucket_count++] = k;
        }
        r->bucket_face[k] = (uint32_t)r->marks[k].what;
    }
    if (r->bucket_count) r->bucket_start[r->bucket_count] = r->mark_count;
    return true;
}

/* True where a vertex has moved by more than the margin (or to nowhere) since the region was made. */
static bool has_moved(const contact_reach *r, const ab_surface *s) {
    const double most = r->margin * r->margin;
    for (size_t v = 0; v < s->vertex_count; ++v) {
        const double dx = s->vertex_position[v] - r->vertex[v], dy = s->vertex_position[s->vertex_ld + v] - r->vertex[s->vertex_count + v];
        if (!(dx * dx + dy * dy <= most)) return true;
    }
    return false;
}

static bool holds(const contact_box *outer, const contact_box *inner) {
    for (int d = 0; d < 2; ++d)
        if (!(inner->low[d] >= outer->low[d] && inner->high[d] <= outer->high[d])) return false;
    return true;
}

bool contact_reach_update(contact_reach *r, const ab_surface *s, double cell, double length, double needed, const contact_box *other) {
    const double wanted = HEADROOM * needed;
    if (r->builds && s->vertex_count == r->vertex_count && s->face_count == r->face_count && needed <= r->reach &&
        r->reach <= WASTE * wanted && holds(&r->window, other) && !has_moved(r, s))
        return true;
    if (!room(&r->vertex, &r->vertex_capacity, 2 * s->vertex_count + 1, sizeof *r->vertex)) return false;
    for (size_t d = 0; d < 2; ++d)
        memcpy(r->vertex + d * s->vertex_count, s->vertex_position + d * s->vertex_ld, s->vertex_count * sizeof *r->vertex);
    r->vertex_count = s->vertex_count;
    r->face_count = s->face_count;
    r->margin = MARGIN * length;
    r->reach = wanted;
    r->bucket = ab_larger(r->reach + r->margin, length);
    r->window = *other;
    for (int d = 0; d < 2; ++d) {
        r->window.low[d] -= cell;
        r->window.high[d] += cell;
    }
    ++r->builds;
    return make_region(r, s, cell, ab_larger(cell, r->reach) + r->margin) && make_buckets(r, s);
}

/* ---- near faces -------------------------------------------------------------------------------------------------------------- */

/* False where a place is further from the box around a chord than `far` in some direction. */
static inline bool may_reach(const chord *c, const double x[2], double far) {
    for (int d = 0; d < 2; ++d)
        if (x[d] < ab_smaller(c->from[d], c->to[d]) - far || x[d] > ab_larger(c->from[d], c->to[d]) + far) return false;
    return true;
}

static inline double distance2(const chord *c, const double x[2]) {
    const double along[2] = {c->to[0] - c->from[0], c->to[1] - c->from[1]}, from[2] = {x[0] - c->from[0], x[1] - c->from[1]};
    const double square = along[0] * along[0] + along[1] * along[1];
    const double t = square > 0.0 ? ab_smaller(1.0, ab_larger(0.0, (from[0] * along[0] + from[1] * along[1]) / square)) : 0.0;
    const double dx = from[0] - t * along[0], dy = from[1] - t * along[1];
    return dx * dx + dy * dy;
}

/* Place of the bucket in the list; SIZE_MAX: no face is near there. */
static size_t find_bucket(const contact_reach *r, const double x[2]) {
    if (r->bucket_count == 0) return SIZE_MAX;
    for (int d = 0; d < 2; ++d)
        if (!(fabs(x[d]) <= FURTHEST * r->bucket)) return SIZE_MAX;
    const uint64_t key = ab_tile_key((int32_t)floor(x[0] / r->bucket), (int32_t)floor(x[1] / r->bucket));
    size_t low = 0, high = r->bucket_count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (r->bucket_key[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < r->bucket_count && r->bucket_key[low] == key ? low : SIZE_MAX;
}

bool contact_reach_list(contact_reach *r, const ab_surface *faces, ab_surface *points, double distance) {
    r->visits = 0;
    if (!room(&r->near_start, &r->point_capacity, points->point_count + 1, sizeof *r->near_start)) return false;
    size_t count = 0;
    r->near_start[0] = 0;
    for (size_t i = 0; i < points->point_count; ++i) {
        const size_t ld = points->point_ld;
        const double x[2] = {points->point_position[i], points->point_position[ld + i]};
        const size_t at = find_bucket(r, x);
        if (at != SIZE_MAX) {
            const size_t begin = r->bucket_start[at], end = r->bucket_start[at + 1];
            if (!room(&r->near_face, &r->near_capacity, count + end - begin, sizeof *r->near_face)) return false;
            const double half = sqrt(ab_larger(0.0, points->point_extent[i] + points->point_extent[ld + i])), far = half + distance;
            for (size_t k = begin; k < end; ++k) {
                const chord c = chord_of(faces, r->bucket_face[k]);
                const double reach = far + c.bulge;
                if (may_reach(&c, x, reach) && distance2(&c, x) <= reach * reach) r->near_face[count++] = r->bucket_face[k];
            }
            r->visits += end - begin;
        }
        r->near_start[i + 1] = count;
    }
    if (!room(&r->near_face, &r->near_capacity, 1, sizeof *r->near_face)) return false;
    points->near_start = r->near_start;
    points->near_face = r->near_face;
    return true;
}
