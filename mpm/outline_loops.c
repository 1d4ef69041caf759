/* outline_loops.c: from the pieces of outline that a fill leaves to closed loops of vertices: each piece is followed by the one that begins where it ends; what
 * lies between two corners is then divided evenly. */
#include "core/memory.h"
#include "mpm/outline.h"

#include <math.h>
#include <stdlib.h>

static const double CORNER = 0.6;       /* rad; a sharper turn is a corner however short the pieces */
static const double EDGE_CORNER = 0.05; /* rad; between straight stretches of some length */
static const double CLOSED =
    1e-9; /* of a piece's length: ends nearer than that are one place, and the outline straight between its corners */

/* Candidates for vertices: the junction of a piece with the next, and its middle; in order along the loops. */
typedef struct track {
    size_t count;
    double (*x)[2];
    bool *corner;
    uint32_t (*point)[2]; /* under it, before and after */
} track;

typedef struct end {
    double x[2];
    uint32_t piece;
} end;

static int by_x(const void *a, const void *b) {
    const end *p = a, *q = b;
    if (p->x[0] != q->x[0]) return p->x[0] < q->x[0] ? -1 : 1;
    if (p->x[1] != q->x[1]) return p->x[1] < q->x[1] ? -1 : 1;
    return (p->piece > q->piece) - (p->piece < q->piece);
}

static void ends_of(const ab_outline_piece *s, double from[2], double to[2]) {
    const double t[2] = {-s->normal[1], s->normal[0]};
    for (int c = 0; c < 2; ++c) {
        from[c] = s->position[c] - 0.5 * s->length * t[c];
        to[c] = s->position[c] + 0.5 * s->length * t[c];
    }
}

/* Angle from the direction of one piece to that of another, rad; positive to the left. */
static double turn_between(const ab_outline_piece *p, const ab_outline_piece *q) {
    return atan2(p->normal[0] * q->normal[1] - p->normal[1] * q->normal[0], p->normal[0] * q->normal[0] + p->normal[1] * q->normal[1]);
}

/* following[k]: the piece that begins nearest to where piece k ends; of several at one place the one most to the left, so that parts of the body that only share a
 * corner stay apart. False where they are no permutation. */
static bool chain(const ab_fill *fill, const end *starts, uint32_t *following, bool *taken) {
    const size_t n = fill->surface_count;
    const double size = fmax(fill->high[0] - fill->low[0], fill->high[1] - fill->low[1]);
    for (size_t k = 0; k < n; ++k) taken[k] = false;
    for (size_t k = 0; k < n; ++k) {
        const ab_outline_piece *s = fill->surface + k;
        double from[2], to[2], best = INFINITY, best_turn = -INFINITY;
        ends_of(s, from, to);
        const double same = 1e-10 * size, reach = 0.5 * s->length + same;
        uint32_t found = UINT32_MAX;
        size_t low = 0, high = n;
        while (low < high) {
            const size_t middle = (low + high) / 2;
            if (starts[middle].x[0] < to[0] - reach)
                low = middle + 1;
            else
                high = middle;
        }
        for (; low < n && starts[low].x[0] <= to[0] + reach; ++low) {
            if (starts[low].piece == k) continue;
            const double far = hypot(starts[low].x[0] - to[0], starts[low].x[1] - to[1]);
            const double turn = turn_between(s, fill->surface + starts[low].piece);
            if (far > reach || far > best + same || (far > best - same && turn <= best_turn)) continue;
            best = fmin(far, best);
            best_turn = turn;
            found = starts[low].piece;
        }
        if (found == UINT32_MAX || taken[found]) return false;
        following[k] = found;
        taken[found] = true;
    }
    return true;
}

/* Where piece p ends and q begins: of pieces that meet, there; of those that only touch a circle, between them on it. */
static void junction(const ab_outline_piece *p, const ab_outline_piece *q, double x[2], bool *smooth) {
    double from[2], to[2], skip[2];
    ends_of(p, skip, to);
    ends_of(q, from, skip);
    const double apart = hypot(from[0] - to[0], from[1] - to[1]), turn = turn_between(p, q);
    *smooth = apart > CLOSED * fmin(p->length, q->length) && fabs(turn) < 2.0;
    for (int c = 0; c < 2; ++c) x[c] = 0.5 * (from[c] + to[c]);
    if (!*smooth) return;
    double n[2] = {p->normal[0] + q->normal[0], p->normal[1] + q->normal[1]};
    const double length = hypot(n[0], n[1]),
                 rise = 0.5 * hypot(q->position[0] - p->position[0], q->position[1] - p->position[1]) * tan(0.25 * turn);
    for (int c = 0; c < 2; ++c) x[c] = 0.5 * (p->position[c] + q->position[c]) + rise * n[c] / length;
}

/* Lengths of the straight stretches that end with piece k, and that begin with the one after it, up to `enough`. */
static bool long_edges(const ab_fill *fill, const uint32_t *following, const uint32_t *leading, uint32_t k, double enough) {
    for (int side = 0; side < 2; ++side) {
        const uint32_t *step = side ? following : leading;
        uint32_t at = side ? following[k] : k;
        double length = fill->surface[at].length;
        while (length < enough && step[at] != (side ? following[k] : k) &&
               fabs(turn_between(fill->surface + at, fill->surface + step[at])) < 1e-6)
            at = step[at], length += fill->surface[at].length;
        if (length < enough) return false;
    }
    return true;
}

static void track_loop(const ab_fill *fill, const uint32_t *following, const uint32_t *leading, uint32_t first, double spacing, track *t) {
    uint32_t k = first;
    t->count = 0;
    do {
        const ab_outline_piece *p = fill->surface + k, *q = fill->surface + following[k];
        for (int c = 0; c < 2; ++c) t->x[t->count][c] = p->position[c];
        t->point[t->count][0] = t->point[t->count][1] = t->point[t->count + 1][0] = p->point;
        t->point[t->count + 1][1] = q->point;
        t->corner[t->count++] = false;
        bool smooth;
        junction(p, q, t->x[t->count], &smooth);
        const double turn = fabs(turn_between(p, q));
        t->corner[t->count++] = turn > CORNER || (!smooth && turn > EDGE_CORNER && long_edges(fill, following, leading, k, 0.5 * spacing));
        k = following[k];
    } while (k != first);
}

bool mpm_loops_reserve(mpm_loops *loops, size_t count) {
    if (count <= loops->capacity) return true;
    const size_t n = count + count / 2 + 16;
    if (!ab_memory_resize(&loops->x, 2 * n, sizeof(double)) || !ab_memory_resize(&loops->next, n, sizeof *loops->next) ||
        !ab_memory_resize(&loops->prior, n, sizeof *loops->prior) || !ab_memory_resize(&loops->corner, n, sizeof *loops->corner) ||
        !ab_memory_resize(&loops->point, 2 * n, sizeof *loops->point) || !ab_memory_resize(&loops->arm, 4 * n, sizeof(double)) ||
        !ab_memory_resize(&loops->slip, 2 * n, sizeof(double)))
        return false;
    loops->capacity = n;
    return true;
}

/* arm: of both points, or NULL where they are set when all vertices are in their places. */
static bool add_vertex(mpm_loops *loops, const double x[2], bool corner, const uint32_t point[2], const double arm[4]) {
    if (!mpm_loops_reserve(loops, loops->count + 1)) return false;
    const size_t k = loops->count++;
    for (size_t c = 0; c < 2; ++c) loops->x[2 * k + c] = x[c], loops->point[2 * k + c] = point[c], loops->slip[2 * k + c] = 0.0;
    for (size_t c = 0; c < 4; ++c) loops->arm[4 * k + c] = arm ? arm[c] : 0.0;
    loops->corner[k] = corner;
    return true;
}

/* Makes a loop of the vertices from `first` on. */
static void close_loop(mpm_loops *loops, size_t first) {
    for (size_t k = first; k < loops->count; ++k) {
        loops->next[k] = (uint32_t)(k + 1 < loops->count ? k + 1 : first);
        loops->prior[k] = (uint32_t)(k > first ? k - 1 : loops->count - 1);
    }
}

/* A stretch of the track, candidates `from` to `to` (counted on round the loop), in parts of equal length: its first vertex and those between. */
static bool divide(mpm_loops *loops, const track *t, size_t from, size_t to, double spacing, size_t least, size_t multiple) {
    double length = 0.0;
    for (size_t k = from; k < to; ++k) {
        const double *a = t->x[k % t->count], *b = t->x[(k + 1) % t->count];
        length += hypot(b[0] - a[0], b[1] - a[1]);
    }
    const size_t parts = multiple * (size_t)fmax((double)least, floor(length / spacing / (double)multiple + 0.5 + 1e-9));
    double done = 0.0;
    size_t at = from;
    for (size_t part = 0; part < parts; ++part) {
        const double wanted = length * (double)part / (double)parts;
        double step = 0.0;
        const double *a, *b;
        for (;; ++at) {
            a = t->x[at % t->count], b = t->x[(at + 1) % t->count];
            step = hypot(b[0] - a[0], b[1] - a[1]);
            if (done + step >= wanted || at + 1 >= to) break;
            done += step;
        }
        const double share = step > 0.0 ? fmin(fmax((wanted - done) / step, 0.0), 1.0) : 0.0;
        const double x[2] = {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
        /* the nearer candidate; of two at one distance the middle of a piece, so that mirrored outlines hang on mirrored points */
        const size_t nearest = (fabs(share - 0.5) < 1e-9 ? at + at % 2 : share < 0.5 ? at : at + 1) % t->count;
        if (!add_vertex(loops, x, part == 0 && t->corner[from % t->count], t->point[nearest], NULL)) return false;
    }
    return true;
}

/* Vertices of a smooth stretch lie on the outline and the faces between them inside of it: by 1/12 of face x turn, in the mean, which the vertices go out. */
static bool lift(mpm_loops *loops, size_t first) {
    const size_t n = loops->count - first;
    double(*by)[2] = calloc(n, sizeof *by);
    if (!by) return false;
    for (size_t k = first; k < loops->count; ++k) {
        if (loops->corner[k]) continue;
        const double *a = loops->x + 2 * loops->prior[k], *x = loops->x + 2 * k, *b = loops->x + 2 * loops->next[k];
        const double p[2] = {x[0] - a[0], x[1] - a[1]}, q[2] = {b[0] - x[0], b[1] - x[1]};
        const double turn = atan2(p[0] * q[1] - p[1] * q[0], p[0] * q[0] + p[1] * q[1]);
        const double length = hypot(b[0] - a[0], b[1] - a[1]), out = turn * 0.5 * length / 12.0;
        if (!(length > 0.0)) continue;
        by[k - first][0] = out * (b[1] - a[1]) / length;
        by[k - first][1] = -out * (b[0] - a[0]) / length;
    }
    for (size_t k = first; k < loops->count; ++k)
        for (size_t c = 0; c < 2; ++c) loops->x[2 * k + c] += by[k - first][c];
    free(by);
    return true;
}

static bool add_loop(mpm_loops *loops, const track *t, double spacing, bool lifted) {
    const size_t first = loops->count;
    size_t start = 0, corners = 0;
    for (size_t k = t->count; k-- > 0;)
        if (t->corner[k]) start = k, ++corners;
    for (size_t k = 0; !corners && k < t->count;
         ++k) /* a circle is divided alike on both sides of either axis, whichever piece comes first */
        if (t->x[k][0] > t->x[start][0]) start = k;
    for (size_t from = start; from < start + t->count;) {
        size_t to = from + 1;
        while (to < start + t->count && !t->corner[to % t->count]) ++to;
        if (!divide(loops, t, from, to, spacing, corners == 1 ? 3 : corners == 2 ? 2 : 1, corners ? 1 : 4)) return false;
        from = to;
    }
    close_loop(loops, first);
    return !lifted || lift(loops, first);
}

ab_status mpm_pieces_chain(const ab_fill *fill, uint32_t *following) {
    const size_t n = fill->surface_count;
    bool *taken = malloc(n + 1);
    end *starts = malloc((n + 1) * sizeof *starts);
    ab_status status = taken && starts ? AB_OK : AB_FAILED;
    for (size_t k = 0; k < n && status == AB_OK; ++k) {
        double to[2];
        ends_of(fill->surface + k, starts[k].x, to);
        starts[k].piece = (uint32_t)k;
    }
    if (status == AB_OK) {
        qsort(starts, n, sizeof *starts, by_x);
        if (n == 0 || !chain(fill, starts, following, taken)) status = AB_BAD_INPUT;
    }
    free(taken), free(starts);
    return status;
}

ab_status mpm_loops_create(const ab_fill *fill, double spacing, bool lifted, const char *body, mpm_loops *loops, ab_report *report) {
    const size_t n = fill->surface_count;
    *loops = (mpm_loops){0};
    uint32_t *following = malloc((n + 1) * sizeof *following), *leading = malloc((n + 1) * sizeof *leading);
    bool *done = malloc(n + 1);
    track t = {0, malloc((2 * n + 1) * sizeof *t.x), malloc(2 * n + 1), malloc((2 * n + 1) * sizeof *t.point)};
    ab_status status = AB_OK;
    const bool room = following && leading && done && t.x && t.corner && t.point;
    const ab_status chained = room ? mpm_pieces_chain(fill, following) : AB_FAILED;
    if (chained == AB_FAILED) {
        status = ab_report_failure(report, "body '%s': no memory for an outline of %zu pieces", body, n);
        goto out;
    }
    if (chained != AB_OK) {
        status =
            ab_report_failure(report,
                              "body '%s': its outline does not close, so that it has no faces to touch; draw it as one polygon, or use "
                              "an algorithm that needs none (multi-velocity)",
                              body);
        goto out;
    }
    for (size_t k = 0; k < n; ++k) leading[following[k]] = (uint32_t)k, done[k] = false;
    for (size_t k = 0; k < n && status == AB_OK; ++k) {
        if (done[k]) continue;
        for (uint32_t at = (uint32_t)k; !done[at]; at = following[at]) done[at] = true;
        track_loop(fill, following, leading, (uint32_t)k, spacing, &t);
        if (!add_loop(loops, &t, spacing, lifted)) status = ab_report_failure(report, "body '%s': no memory for its outline", body);
    }
    for (size_t k = 0; k < 2 * loops->count; ++k) { /* points: two a vertex */
        loops->arm[2 * k] = loops->x[k / 2 * 2] - fill->x[loops->point[k]];
        loops->arm[2 * k + 1] = loops->x[k / 2 * 2 + 1] - fill->y[loops->point[k]];
    }
out:
    free(following), free(leading), free(done), free(t.x), free(t.corner), free(t.point);
    if (status != AB_OK) mpm_loops_clear(loops);
    return status;
}

void mpm_loops_clear(mpm_loops *loops) {
    free(loops->x), free(loops->next), free(loops->prior), free(loops->corner), free(loops->point), free(loops->arm), free(loops->slip);
    *loops = (mpm_loops){0};
}

static double face_length(const mpm_loops *loops, size_t k) {
    const double *a = loops->x + 2 * k, *b = loops->x + 2 * loops->next[k];
    return hypot(b[0] - a[0], b[1] - a[1]);
}

ab_status mpm_loops_even(mpm_loops *loops, double shortest, double longest, const char *body, ab_report *report) {
    bool due = false;
    for (size_t k = 0; k < loops->count && !due; ++k) {
        const double length = face_length(loops, k);
        due = length > longest || (length < shortest && !(loops->corner[k] && loops->corner[loops->next[k]]));
    }
    if (!due) return AB_OK;
    mpm_loops even = {0};
    if (!mpm_loops_reserve(&even, 2 * loops->count)) goto no_memory;
    for (size_t begin = 0; begin < loops->count;) { /* a loop's vertices stand one after the other */
        size_t end_ = begin;
        while (loops->next[end_] != begin) ++end_;
        const size_t first = even.count;
        size_t left = ++end_ - begin;
        for (size_t k = begin; k < end_; ++k) {
            const double *x = loops->x + 2 * k, *b = loops->x + 2 * loops->next[k];
            const bool close = even.count > first && hypot(x[0] - even.x[2 * even.count - 2], x[1] - even.x[2 * even.count - 1]) < shortest;
            if (close && left > 4 && !(loops->corner[k] && even.corner[even.count - 1])) {
                --left;
                if (!loops->corner[k]) continue;
                --even.count;
            }
            const double *arm = loops->arm + 4 * k, *after = loops->arm + 4 * loops->next[k];
            if (!add_vertex(&even, x, loops->corner[k], loops->point + 2 * k, arm)) goto no_memory;
            const double *slip = loops->slip + 2 * k, *its = loops->slip + 2 * loops->next[k];
            for (size_t c = 0; c < 2; ++c) even.slip[2 * even.count - 2 + c] = slip[c];
            if (!(face_length(loops, k) > longest)) continue;
            const double half[2] = {0.5 * (b[0] - x[0]), 0.5 * (b[1] - x[1])}, middle[2] = {x[0] + half[0], x[1] + half[1]};
            const uint32_t points[2] = {loops->point[2 * k + 1], loops->point[2 * loops->next[k]]};
            const double arms[4] = {arm[2] + half[0], arm[3] + half[1], after[0] - half[0], after[1] - half[1]};
            if (!add_vertex(&even, middle, false, points, arms)) goto no_memory;
            for (size_t c = 0; c < 2; ++c) even.slip[2 * even.count - 2 + c] = 0.5 * (slip[c] + its[c]);
        }
        close_loop(&even, first);
        begin = end_;
    }
    mpm_loops_clear(loops);
    *loops = even;
    return AB_OK;
no_memory:
    mpm_loops_clear(&even);
    return ab_report_failure(report, "body '%s': no memory for its outline", body);
}
