/* fill_cvt_cells.c: from settled generators to what a fill holds: each point at the centroid of its cell with the cell's area and second moments, and the pieces of
 * outline that the cells end at.
 *
 * A cell that a notch or a gap cuts in two belongs to its generator only where that stands; the rest goes to the neighbour that it shares the longest side with. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "mpm/fill_cvt.h"

static const double SHORTEST = 1e-6; /* distances between points: shorter pieces of outline are left to those beside them */

typedef struct stretch { /* of an edge, in a cell */
    uint32_t edge, owner;
    double from, to; /* parts of the edge; on a circle counted on from edge to edge */
} stretch;

typedef struct gift { /* a part of a cell that another generator takes */
    uint32_t giver, taker;
    ab_moments moments; /* from the giver */
} gift;

typedef struct level { /* an edge along x */
    double y, low, high;
    uint32_t edge;
    bool bottom; /* the body is above it */
} level;

typedef struct gathering {
    ab_cvt *cvt;
    ab_moments *cell; /* of each generator, from it */
    double (*place)[2];
    stretch *stretch;
    size_t count, capacity;
    gift *gift;
    size_t gift_count, gift_capacity;
    level *level;
    size_t level_count;
    uint32_t *owner; /* of the pieces of one cell */
    size_t owner_capacity;
} gathering;

static int by_level(const void *a, const void *b) {
    const level *p = a, *q = b;
    if (p->y != q->y) return p->y < q->y ? -1 : 1;
    return (p->edge > q->edge) - (p->edge < q->edge);
}

static bool list_levels(gathering *g) {
    const ab_interior *in = &g->cvt->interior;
    g->level = malloc((in->edge_count + 1) * sizeof *g->level);
    if (!g->level) return false;
    for (size_t e = 0; e < in->edge_count; e++) {
        const ab_edge *d = &in->edge[e];
        if (d->from[1] != d->to[1]) continue;
        g->level[g->level_count++] =
            (level){d->from[1], fmin(d->from[0], d->to[0]), fmax(d->from[0], d->to[0]), (uint32_t)e, d->to[0] > d->from[0]};
    }
    qsort(g->level, g->level_count, sizeof *g->level, by_level);
    return true;
}

/* ---- pieces of outline in a cell -------------------------------------------------------------------------------------------- */

static double share_of(const ab_edge *e, const double x[2]) {
    const double d[2] = {e->to[0] - e->from[0], e->to[1] - e->from[1]};
    return fmin(fmax(((x[0] - e->from[0]) * d[0] + (x[1] - e->from[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]), 0), 1);
}

static bool add_stretch(gathering *g, uint32_t edge, uint32_t owner, const double a[2], const double b[2]) {
    const ab_edge *e = &g->cvt->interior.edge[edge];
    const double s = share_of(e, a), t = share_of(e, b);
    if (s == t) return true;
    if (!ab_memory_append(&g->stretch, &g->capacity, g->count + 1, sizeof *g->stretch)) return false;
    g->stretch[g->count++] = (stretch){edge, owner, fmin(s, t), fmax(s, t)};
    return true;
}

/* The bottom or top of a piece: as far as it lies on level edges. */
static bool add_level(gathering *g, const ab_trapezoid *t, bool bottom, uint32_t owner, const double a[2], const double b[2]) {
    const double y = bottom ? t->low : t->high, low = fmin(a[0], b[0]), high = fmax(a[0], b[0]);
    size_t first = 0, end = g->level_count;
    while (first < end) {
        const size_t middle = (first + end) / 2;
        if (g->level[middle].y < y)
            first = middle + 1;
        else
            end = middle;
    }
    for (; first < g->level_count && g->level[first].y == y; first++) {
        const level *l = &g->level[first];
        const double from = fmax(l->low, low), to = fmin(l->high, high);
        if (l->bottom != bottom || from >= to) continue;
        if (!add_stretch(g, l->edge, owner, (const double[2]){from, y}, (const double[2]){to, y})) return false;
    }
    return true;
}

static bool add_sides(gathering *g, const ab_cell_piece *piece, const double at[2], uint32_t owner) {
    const ab_convex *c = &piece->shape;
    for (size_t k = 0; k < c->count; k++) {
        const double *p = c->x[k], *q = c->x[(k + 1) % c->count], a[2] = {at[0] + p[0], at[1] + p[1]}, b[2] = {at[0] + q[0], at[1] + q[1]};
        const ab_trapezoid *t = &g->cvt->interior.part[piece->part];
        bool good = true;
        if (c->side[k] <= AB_SIDE_EDGE)
            good = add_stretch(g, (uint32_t)(AB_SIDE_EDGE - c->side[k]), owner, a, b);
        else if (c->side[k] == AB_SIDE_LOW || c->side[k] == AB_SIDE_HIGH)
            good = add_level(g, t, c->side[k] == AB_SIDE_LOW, owner, a, b);
        if (!good) return false;
    }
    return true;
}

/* ---- parts of cells that belong to others ----------------------------------------------------------------------------------- */

/* The generator across the longest sides of a component; its own where it has none. */
static uint32_t neighbour_of(const ab_cell_work *w, uint32_t root, uint32_t own) {
    uint32_t best = own;
    double longest = 0;
    for (size_t k = 0; k < w->count; k++)
        for (size_t s = 0; w->piece[k].root == root && s < w->piece[k].shape.count; s++) {
            const int32_t side = w->piece[k].shape.side[s];
            if (side < 0) continue;
            double length = 0; /* in all pieces */
            for (size_t m = 0; m < w->count; m++)
                for (size_t n = 0; w->piece[m].root == root && n < w->piece[m].shape.count; n++) {
                    const ab_convex *c = &w->piece[m].shape;
                    const double *a = c->x[n], *b = c->x[(n + 1) % c->count];
                    if (c->side[n] == side) length += hypot(b[0] - a[0], b[1] - a[1]);
                }
            if (length <= longest) continue;
            longest = length;
            best = (uint32_t)side;
        }
    return best;
}

static void add_moments(ab_moments *to, const ab_moments *m, const double shift[2]) {
    const double dx = shift[0], dy = shift[1];
    to->uu += m->uu + 2 * dx * m->u + dx * dx * m->area;
    to->vv += m->vv + 2 * dy * m->v + dy * dy * m->area;
    to->uv += m->uv + dx * m->v + dy * m->u + dx * dy * m->area;
    to->u += m->u + dx * m->area;
    to->v += m->v + dy * m->area;
    to->area += m->area;
}

static bool gather_cell(gathering *g, uint32_t i) {
    ab_cvt *cvt = g->cvt;
    ab_cell_work *w = &cvt->work[0];
    ab_voronoi_cell(&cvt->voronoi, i, w);
    if (w->no_memory) return false;
    g->cell[i] = w->moments;
    ab_voronoi_centroid(&cvt->voronoi, i, w, g->place[i]);
    if (!ab_memory_append(&g->owner, &g->owner_capacity, w->count, sizeof *g->owner)) return false;
    for (uint32_t k = 0; k < w->count; k++) {
        const ab_cell_piece *p = &w->piece[k];
        if (p->root == k) g->owner[k] = k == w->home ? i : neighbour_of(w, k, i);
        const uint32_t owner = g->owner[p->root];
        if (p->root != w->home) {
            if (!ab_memory_append(&g->gift, &g->gift_capacity, g->gift_count + 1, sizeof *g->gift)) return false;
            g->gift[g->gift_count++] = (gift){i, owner, p->moments};
        }
        if (!add_sides(g, p, cvt->x[i], owner)) return false;
    }
    return true;
}

/* A cell that was given something has its point at the centroid of both, where that lies in the body. */
static void take_gifts(gathering *g) {
    const ab_cvt *cvt = g->cvt;
    for (size_t k = 0; k < g->gift_count; k++) {
        const gift *t = &g->gift[k];
        const double *from = cvt->x[t->giver], *to = cvt->x[t->taker], shift[2] = {from[0] - to[0], from[1] - to[1]};
        add_moments(&g->cell[t->taker], &t->moments, shift);
    }
    for (size_t k = 0; k < g->gift_count; k++) {
        const uint32_t i = g->gift[k].taker;
        const ab_moments *m = &g->cell[i];
        const double x[2] = {cvt->x[i][0] + m->u / m->area, cvt->x[i][1] + m->v / m->area};
        if (g->gift[k].giver != i && ab_interior_holds(&cvt->interior, x)) memcpy(g->place[i], x, sizeof x);
    }
}

/* ---- points ----------------------------------------------------------------------------------------------------------------- */

static void add_points(const gathering *g) {
    const ab_cvt *cvt = g->cvt;
    const double s = cvt->spacing;
    double sum = 0;
    for (size_t i = 0; i < cvt->count; i++) sum += g->cell[i].area;
    for (size_t i = 0; i < cvt->count; i++) {
        const ab_moments *m = &g->cell[i];
        const double u = m->u / m->area, v = m->v / m->area, scale = 3 * s * s; /* a square of half side a has a^2/3 of second moment */
        double a[3] = {m->uu / m->area - u * u, m->vv / m->area - v * v, m->uv / m->area - u * v};
        const double least = 1e-8 * (a[0] + a[1]) + 1e-12; /* a sliver keeps some width */
        if (!(a[0] * a[1] - a[2] * a[2] > least * (a[0] + a[1]))) a[0] += least, a[1] += least;
        ab_filler_point(cvt->filler, cvt->middle[0] + s * g->place[i][0], cvt->middle[1] + s * g->place[i][1],
                        m->area / sum * cvt->outline.area, scale * a[0], scale * a[1], scale * a[2]);
    }
}

/* ---- the outline ------------------------------------------------------------------------------------------------------------ */

static int by_edge(const void *a, const void *b) {
    const stretch *p = a, *q = b;
    if (p->edge != q->edge) return p->edge < q->edge ? -1 : 1;
    if (p->from != q->from) return p->from < q->from ? -1 : 1;
    return (p->owner > q->owner) - (p->owner < q->owner);
}

/* Makes `list` close: joins stretches of one owner, drops those too short, and lets each begin where the one before it ends. length: of the whole. */
static size_t close_up(stretch *list, size_t count, double length, double end) {
    size_t kept = 0;
    for (size_t k = 0; k < count; k++) {
        if ((list[k].to - list[k].from) * length < SHORTEST * end && count > 1 && (kept > 0 || k + 1 < count)) continue;
        if (kept > 0 && list[kept - 1].owner == list[k].owner)
            list[kept - 1].to = fmax(list[kept - 1].to, list[k].to);
        else
            list[kept++] = list[k];
    }
    for (size_t k = 0; k + 1 < kept; k++) list[k].to = list[k + 1].from = 0.5 * (list[k].to + list[k + 1].from);
    if (kept > 0) list[0].from = 0, list[kept - 1].to = end;
    return kept;
}

static ab_status add_straight(const gathering *g, const ab_edge *e, const stretch *list, size_t count) {
    const double dx = e->to[0] - e->from[0], dy = e->to[1] - e->from[1], length = hypot(dx, dy);
    AB_TRY(ab_filler_reserve(g->cvt->filler, g->cvt->mark, 0, (double)count));
    for (size_t k = 0; k < count; k++) {
        const double middle = 0.5 * (list[k].from + list[k].to);
        ab_filler_piece(g->cvt->filler, list[k].owner, e->from[0] + middle * dx, e->from[1] + middle * dy, dy / length, -dx / length,
                        (list[k].to - list[k].from) * length);
    }
    return AB_OK;
}

/* Stretches of a circle, counted in edges of it; none is longer than a quarter. */
static ab_status add_arcs(const gathering *g, const ab_round *r, stretch *list, size_t count) {
    const double turn = (r->hole ? -2 : 2) * AB_PI / (double)r->count, way = r->hole ? -1 : 1;
    if (count > 1 && list[0].owner == list[count - 1].owner) { /* one stretch across the beginning */
        list[0].from = list[count - 1].from - (double)r->count;
        count--;
    }
    for (size_t k = 0; k < count; k++) {
        const double parts = ceil((list[k].to - list[k].from) * fabs(turn) / (0.5 * AB_PI) - 1e-9),
                     size = (list[k].to - list[k].from) / parts;
        AB_TRY(ab_filler_reserve(g->cvt->filler, g->cvt->mark, 0, parts));
        for (double part = 0; part < parts; part++) {
            const double angle = turn * (list[k].from + (part + 0.5) * size), n[2] = {cos(angle), sin(angle)};
            ab_filler_piece(g->cvt->filler, list[k].owner, r->center[0] + r->radius * n[0], r->center[1] + r->radius * n[1], way * n[0],
                            way * n[1], size * fabs(turn) * r->radius);
        }
    }
    return AB_OK;
}

static ab_status add_outline(gathering *g) {
    const ab_cvt *cvt = g->cvt;
    qsort(g->stretch, g->count, sizeof *g->stretch, by_edge);
    size_t at = 0;
    for (size_t r = 0; r < cvt->round_count; r++) {
        const ab_round *round = &cvt->round[r];
        const size_t first = at;
        for (; at < g->count && g->stretch[at].edge < round->first + round->count; at++) {
            const double before = (double)(g->stretch[at].edge - round->first);
            g->stretch[at].from += before;
            g->stretch[at].to += before;
        }
        const double side = 2 * AB_PI * round->radius / cvt->spacing / (double)round->count;
        const size_t kept = close_up(g->stretch + first, at - first, side * (double)round->count, (double)round->count);
        AB_TRY(add_arcs(g, round, g->stretch + first, kept));
    }
    if (cvt->round_count > 0) return AB_OK;
    uint32_t last = g->count > 0 ? g->stretch[0].owner : 0;
    for (uint32_t e = 0; e < cvt->outline.count; e++) {
        const size_t first = at;
        const ab_edge *own = &cvt->interior.edge[e];
        while (at < g->count && g->stretch[at].edge == e) at++;
        size_t kept = close_up(g->stretch + first, at - first, hypot(own->to[0] - own->from[0], own->to[1] - own->from[1]), 1);
        stretch alone = {e, last, 0, 1}; /* an edge so short that no cell has a side on it */
        AB_TRY(add_straight(g, &cvt->outline.edge[e], kept > 0 ? g->stretch + first : &alone, kept > 0 ? kept : 1));
        if (kept > 0) last = g->stretch[first + kept - 1].owner;
    }
    return AB_OK;
}

/* ---- the whole ---------------------------------------------------------------------------------------------------------------- */

static ab_status finish(gathering *g) {
    ab_cvt *cvt = g->cvt;
    const ab_status no_memory = AB_FAILED;
    g->cell = malloc(cvt->count * sizeof *g->cell);
    g->place = malloc(cvt->count * sizeof *g->place);
    if (!g->cell || !g->place || !list_levels(g)) return no_memory;
    for (uint32_t i = 0; i < cvt->count; i++)
        if (!gather_cell(g, i)) return no_memory;
    take_gifts(g);
    AB_TRY(ab_filler_reserve(cvt->filler, cvt->mark, (double)cvt->count, 0));
    add_points(g);
    const size_t first_piece = cvt->filler->fill->surface_count;
    AB_TRY(add_outline(g));
    return ab_fill_fit_extents(cvt->filler, first_piece);
}

ab_status ab_cvt_finish(ab_cvt *cvt) {
    gathering g = {.cvt = cvt};
    const size_t errors = ab_report_errors(cvt->filler->report);
    ab_status status = finish(&g);
    if (status == AB_FAILED && ab_report_errors(cvt->filler->report) == errors)
        status =
            ab_report_failure(cvt->filler->report, "body '%s': no memory for the cells of its %zu points", cvt->filler->body, cvt->count);
    free(g.cell);
    free(g.place);
    free(g.stretch);
    free(g.gift);
    free(g.level);
    free(g.owner);
    return status;
}
