/* surface_hits.h: the places of a surface that a point looks at, and which of them count. For finders in this folder. */
#ifndef SURFACE_HITS_H
#define SURFACE_HITS_H

#include "face_curve.h"

enum { MOST_HITS = 32 };
static const double EDGE = 1e-9;                                   /* of a face's length: nearer than this is on its end */
static const double SAME_WAY = 0.8660254037844386, CAN_MEET = 0.5; /* cosines of 30 and 60 degrees */

typedef struct hit {
    uint32_t face;
    double xi, x[2], normal[2]; /* place, unit normal outwards */
    double signed_distance;     /* n.(t - r), negative inside */
    double distance;
    int extended; /* on the straight continuation of a face beyond a concave corner */
    int corner;   /* at a corner: it counts beside a nearer one */
    int end;      /* on the end of its face to rounding: 1 the first, 2 the last; else 0 */
    int vertex;   /* the point itself is at that vertex to rounding */
    int second;   /* the other face of its corner is nearer */
    int best;     /* nearest of all */
} hit;

typedef struct hits {
    size_t count;
    hit of[MOST_HITS];
    size_t failures;
} hits;

/* The next face that has a length beyond an end (0: before the first vertex, 1: after the last); UINT32_MAX: none. */
static uint32_t beside(const ab_surface *s, uint32_t face, int end, curve *c) {
    uint32_t next = s->face_beside[2 * (size_t)face + (size_t)end];
    for (int hops = 0; hops < 8 && next != UINT32_MAX && next != face; ++hops) {
        if (curve_of(s, next, c)) return next;
        next = s->face_beside[2 * (size_t)next + (size_t)end];
    }
    return UINT32_MAX;
}

/* By how much the point at from + q lies beyond an end, along the face there, m. */
static double beyond(const curve *c, const double q[2], int end) {
    double slope[2], r[2];
    slope_at(c, end ? 1.0 : -1.0, slope);
    from_place(c, q, end ? 1.0 : -1.0, r);
    return (end ? 1.0 : -1.0) * dot(slope, r) / sqrt(dot(slope, slope));
}

static void add_hit(hits *all, const hit *h) {
    if (!isfinite(h->signed_distance + h->distance + h->normal[0] + h->normal[1])) {
        ++all->failures;
        return;
    }
    if (all->count < MOST_HITS) {
        all->of[all->count++] = *h;
        return;
    }
    size_t furthest = 0; /* more faces than anyone looks at: the furthest is left out */
    for (size_t k = 1; k < all->count; ++k)
        if (all->of[k].distance > all->of[furthest].distance) furthest = k;
    if (h->distance < all->of[furthest].distance) all->of[furthest] = *h;
}

/* What the point t sees of a face beyond whose end it lies. */
static void look_at_end(const ab_surface *s, const curve *c, hit h, const double t[2], int end, hits *all) {
    double here[2], there[2], slope[2], next_slope[2], r[2] = {t[0] - h.x[0], t[1] - h.x[1]};
    curve next;
    const uint32_t neighbour = beside(s, h.face, end, &next);
    normal_at(c, h.xi, here);
    h.distance = sqrt(dot(r, r));
    if (neighbour == UINT32_MAX) { /* the end of an open surface: a vertex with one face */
        h.signed_distance = copysign(h.distance, dot(here, r));
        for (int d = 0; d < 2; ++d) h.normal[d] = r[d] / h.signed_distance;
        add_hit(all, &h);
        return;
    }
    const double q[2] = {t[0] - next.from[0], t[1] - next.from[1]}, next_xi = end ? -1.0 : 1.0;
    normal_at(&next, next_xi, there);
    slope_at(c, h.xi, slope);
    slope_at(&next, next_xi, next_slope);
    const int convex = (end ? cross(slope, next_slope) : cross(next_slope, slope)) >= 0.0, sharp = dot(here, there) < SAME_WAY;
    const int both = beyond(&next, q, 1 - end) > EDGE * next.length;
    if (!convex && sharp) {
        if (!both && dot(there, r) > 0.0) return;
        memcpy(h.normal, here, sizeof h.normal);
        h.signed_distance = dot(here, r);
        h.extended = h.corner = 1;
        h.second = !both;
        h.end = end + 1;
        add_hit(all, &h);
        return;
    }
    if (!both || end == 0) return; /* it is on the other face; or the other face says it */
    const double middle[2] = {here[0] + there[0], here[1] + there[1]};
    h.signed_distance = copysign(h.distance, convex ? larger(dot(middle, r), 0.0) : dot(middle, r));
    for (int d = 0; d < 2; ++d) h.normal[d] = r[d] / h.signed_distance;
    add_hit(all, &h);
}

/* What the point t sees of a face. */
static void look_at_face(const ab_surface *s, uint32_t face, const double t[2], int closed, hits *all) {
    curve c;
    if (!curve_of(s, face, &c)) {
        ++all->failures;
        return;
    }
    const double q[2] = {t[0] - c.from[0], t[1] - c.from[1]};
    hit h = {.face = face};
    double r[2];
    if (!project(&c, q, closed, &h.xi)) ++all->failures; /* it stands where the iteration was left */
    from_place(&c, q, h.xi, r);
    for (int d = 0; d < 2; ++d) h.x[d] = t[d] - r[d];
    const int end = h.xi >= 1.0;
    if ((end || h.xi <= -1.0) && beyond(&c, q, end) > EDGE * c.length) {
        look_at_end(s, &c, h, t, end, all);
        return;
    }
    if (!normal_at(&c, h.xi, h.normal)) {
        ++all->failures;
        return;
    }
    h.signed_distance = dot(h.normal, r);
    h.distance = sqrt(dot(r, r));
    h.end = h.xi >= 1.0 - 4.0 * EDGE ? 2 : h.xi <= -1.0 + 4.0 * EDGE ? 1 : 0;
    h.vertex = h.end && h.distance <= 2.0 * EDGE * c.length;
    if (h.vertex) {
        curve next;
        double there[2];
        h.corner = beside(s, face, h.end - 1, &next) != UINT32_MAX && normal_at(&next, h.end == 2 ? -1.0 : 1.0, there) &&
                   (h.end == 2 ? cross(h.normal, there) : cross(there, h.normal)) < 0.0;
    }
    add_hit(all, &h);
}

/* ---- which of them count ---------------------------------------------------------------------------------------------------------- */

/* Cosine of the angle between direction w and the cone of outward normals that vertex v of its own body has; 1 inside. */
static double cosine_to_cone(const ab_surface *own, const uint32_t around[2], uint32_t v, const double w[2]) {
    double n[2][2];
    int known[2] = {0, 0};
    for (int k = 0; k < 2; ++k) {
        curve c;
        if (around[k] == UINT32_MAX || !curve_of(own, around[k], &c)) continue;
        const uint32_t *of = own->face_vertex + 3 * (size_t)around[k];
        known[k] = normal_at(&c, v == of[2] ? 0.0 : k == 0 ? 1.0 : -1.0, n[k]);
    }
    if (!known[0] && !known[1]) return 1.0;
    if (!known[0]) return dot(n[1], w);
    if (!known[1]) return dot(n[0], w);
    if (cross(n[0], n[1]) >= 0.0 && cross(n[0], w) >= 0.0 && cross(w, n[1]) >= 0.0 && dot(w, n[0]) + dot(w, n[1]) > 0.0) return 1.0;
    return larger(dot(n[0], w), dot(n[1], w));
}

/* Hits of one convex vertex, each through one of its faces, when the point is at the vertex to rounding: their average. */
static void merge_at_vertex(const ab_surface *s, hits *all) {
    for (size_t i = 0; i < all->count; ++i) {
        hit *h = all->of + i;
        if (!h->vertex || h->end != 2) continue;
        curve next;
        const uint32_t neighbour = beside(s, h->face, 1, &next);
        for (size_t k = 0; neighbour != UINT32_MAX && k < all->count; ++k) {
            hit *other = all->of + k;
            if (other->face != neighbour || !other->vertex || other->end != 1 || cross(h->normal, other->normal) < 0.0) continue;
            const double sum[2] = {h->normal[0] + other->normal[0], h->normal[1] + other->normal[1]}, size = sqrt(dot(sum, sum));
            if (!(size > EDGE)) continue; /* a fold */
            h->normal[0] = sum[0] / size;
            h->normal[1] = sum[1] / size;
            h->signed_distance = 0.5 * (h->signed_distance + other->signed_distance);
            h->corner = 1;
            *other = all->of[--all->count];
            break;
        }
    }
}

static int nearer(const hit *a, const hit *b) { return a->second != b->second ? b->second : a->distance < b->distance; }

/* An extended hit counts when the nearest place is on the other face of its corner, or the corner itself. */
static int goes_with(const ab_surface *s, const hit *extended, const hit *nearest) {
    curve next;
    if (extended->best) return 1;
    if (beside(s, extended->face, extended->end - 1, &next) != nearest->face) return 0;
    if (!nearest->extended) return extended->signed_distance >= nearest->signed_distance;
    return beside(s, nearest->face, nearest->end - 1, &next) == extended->face;
}

/* Keeps the hits that count. own: the surface of the point's body when the point is its vertex `vertex`, or NULL. */
static void choose(const ab_surface *s, const ab_surface *own, const uint32_t *around, uint32_t vertex, hits *all) {
    if (!all->count) return;
    size_t best = 0;
    for (size_t k = 1; k < all->count; ++k)
        if (nearer(all->of + k, all->of + best)) best = k;
    const hit nearest_of_all = all->of[best];
    const int inside = nearest_of_all.extended || nearest_of_all.signed_distance < 0.0;
    all->of[best].best = 1;
    int met = 0; /* the nearest place is one that the point can meet */
    size_t kept = 0;
    for (size_t k = 0; k < all->count; ++k) {
        const hit h = all->of[k];
        const double w[2] = {-h.normal[0], -h.normal[1]};
        if (own && cosine_to_cone(own, around, vertex, w) < CAN_MEET) continue;
        met = met || h.best;
        all->of[kept++] = h;
    }
    all->count = kept;
    merge_at_vertex(s, all);
    /* Of those behind a face only the nearest place that the point can meet counts, and what continues a face beyond a concave corner. A point outside is behind
     * none; but where it lies on the edge of a face to rounding, on the wrong side of it (beside a body of the same width), the nearest place is one that it
     * cannot meet, and that face counts. */
    size_t nearest = MOST_HITS;
    for (size_t k = 0; k < all->count; ++k)
        if (nearest == MOST_HITS || nearer(all->of + k, all->of + nearest)) nearest = k;
    if (nearest != MOST_HITS && !inside) {
        const hit *h = all->of + nearest;
        curve c, next;
        const int edge = !met && h->end && !h->extended && curve_of(s, nearest_of_all.face, &c) &&
                         nearest_of_all.distance <= EDGE * c.length && beside(s, h->face, h->end - 1, &next) == nearest_of_all.face;
        if (!edge) nearest = MOST_HITS;
    }
    kept = 0;
    for (size_t k = 0; k < all->count; ++k) {
        const hit h = all->of[k];
        const int counts = h.extended ? inside && goes_with(s, &h, &nearest_of_all) : h.corner || h.signed_distance >= 0.0;
        if (k == nearest || counts) all->of[kept++] = h;
    }
    all->count = kept;
}

#endif
