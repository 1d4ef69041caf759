/* point_to_segment.c: finds contact points between the surface points of one body and the faces of the other: the closest place of a face by projection (in closed
 * form on straight faces, by Newton's method on quadratic ones), its normal, the gap, and both sides' stencils. First the points of a on the faces of b, then the
 * points of b on the faces of a; the normal always goes out of a into b.
 *
 * Which places count, for one point:
 *   - outside the body, every place of a face or a convex vertex it looks at, the nearest of those that face the same way (within 30 degrees): in a concave
 *     corner that is one on each side;
 *   - inside, the nearest place of the surface alone, and in a concave corner that of the other face too;
 *   - a point that is a vertex of its own body knows its outside: only places whose normal it can meet count (within 60 degrees of the cone of its own normals). So a
 *     node that was pressed into a thin body still belongs to the side it came from, and two equal corners meet face to face. */
#include "abut_plugin.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "face_curve.h"

/* As fmax and fmin, a NaN being ignored, but inline: calls of the library's cost ten times as much. */
static inline double larger(double a, double b) { return b > a || a != a ? b : a; }
static inline double smaller(double a, double b) { return b < a || a != a ? b : a; }

enum { CLOSED, NEWTON };
enum { BOTH, FIRST, SECOND };
enum { MOST_HITS = 32, MOST_SLOTS = 4 };
static const double EDGE = 1e-9;                                   /* of a face's length: nearer than this is on its end */
static const double NEAR = 0.03;                                   /* of a cell: given out although the bodies do not meet in this step */
static const double SAME_WAY = 0.8660254037844386, CAN_MEET = 0.5; /* cosines of 30 and 60 degrees */

static const ab_param PARAMS[] = {
    {"half_size", "1", "part of a material point's half size that belongs to the body: 1 its whole domain, 0 its centre alone", NULL,
     AB_REAL, 0, 1.0, 0.0, 1.0},
    {"passes", "1", "points of the first body on faces of the second, of the second on faces of the first, or both where there are both",
     "both|first|second", AB_CHOICE, 0, BOTH, 0, 0},
    {"projection", "1", "onto straight faces: closed, or the iteration that quadratic faces need (the same answer)", "closed|newton",
     AB_CHOICE, 0, CLOSED, 0, 0},
};

typedef struct remembered { /* a contact point of the last step */
    uint64_t key;
    double normal[2];
} remembered;

typedef struct placed { /* where a contact point of this step lies, for its area */
    uint32_t pass, face, vertex;
    double xi;
} placed;

typedef struct segments {
    const ab_host *host;
    double half_size;
    int passes, projection;
    remembered *before;
    size_t before_count, before_bytes;
    placed *placed;
    size_t placed_bytes;
    uint32_t *around[2]; /* per vertex of a and of b: the face that ends there, the face that begins, UINT32_MAX: none */
    uint8_t *met[2];     /* per vertex of a and of b: it is a contact point itself */
    size_t around_bytes[2], met_bytes[2];
} segments;

static int create(const ab_host *host, const ab_value *settings, void **self) {
    segments *s = host->allocate(host->context, sizeof *s);
    if (!s) return -1;
    s->host = host;
    s->half_size = settings[0].real;
    s->passes = (int)settings[1].integer;
    s->projection = (int)settings[2].integer;
    *self = s;
    return 0;
}

static void destroy(void *self) {
    segments *s = self;
    const ab_host *host = s->host;
    void *all[] = {s->before, s->placed, s->around[0], s->around[1], s->met[0], s->met[1], s};
    for (size_t k = 0; k < sizeof all / sizeof *all; ++k)
        if (all[k]) host->release(host->context, all[k]);
}

/* Room for `bytes`, keeping what is there. */
static int room(const ab_host *host, void *pointer, size_t *have, size_t bytes) {
    if (bytes <= *have) return 1;
    void **p = pointer, *more = host->allocate(host->context, 2 * bytes);
    if (!more) return 0;
    if (*p) {
        memcpy(more, *p, *have);
        host->release(host->context, *p);
    }
    *p = more;
    *have = 2 * bytes;
    return 1;
}

/* ---- hits: places of the surface that a point looks at -------------------------------------------------------------------------- */

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

/* Part of the surface that vertex v of its own body stands for which lies along a face with normal n: of a corner's two faces one may look elsewhere. */
static double part_along(const ab_surface *own, const uint32_t around[2], uint32_t v, const double n[2]) {
    double along = 0.0, all = 0.0;
    for (int k = 0; k < 2; ++k) {
        curve c;
        double here[2];
        if (around[k] == UINT32_MAX || !curve_of(own, around[k], &c)) continue;
        const uint32_t *of = own->face_vertex + 3 * (size_t)around[k];
        if (!normal_at(&c, v == of[2] ? 0.0 : k == 0 ? 1.0 : -1.0, here)) continue;
        const double share = c.bent ? c.length / 6.0 : c.length / 2.0;
        all += share;
        along += share * larger(0.0, -dot(here, n));
    }
    return all > 0.0 ? along / all : 1.0;
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

/* ---- contact points ------------------------------------------------------------------------------------------------------------------ */

typedef struct pass {
    segments *self;
    const ab_surface *points, *faces;
    uint32_t number;  /* 0: points of a on faces of b */
    uint32_t *around; /* of the points' own vertices, or NULL */
    double reach;     /* m: no larger gap is given out */
    ab_points *out;
} pass;

static int compare_keys(const void *a, const void *b) {
    const remembered *x = a, *y = b;
    return (x->key > y->key) - (x->key < y->key);
}

static const remembered *recall(const segments *self, uint64_t key) {
    const remembered wanted = {.key = key};
    return self->before_count ? bsearch(&wanted, self->before, self->before_count, sizeof wanted, compare_keys) : NULL;
}

/* A point may touch at several places: each keeps the slot whose normal was nearest to its own in the last step, and with it its history. */
static uint32_t take_slot(const segments *self, uint64_t base, const double n[2], unsigned *taken) {
    uint32_t slot = MOST_SLOTS;
    double nearest = 0.5;
    for (uint32_t k = 0; k < MOST_SLOTS; ++k) {
        const remembered *was = *taken >> k & 1 ? NULL : recall(self, base | k);
        if (was && dot(was->normal, n) > nearest) nearest = dot(was->normal, n), slot = k;
    }
    for (uint32_t k = 0; slot == MOST_SLOTS && k < MOST_SLOTS; ++k)
        if (!(*taken >> k & 1) && !recall(self, base | k)) slot = k;
    for (uint32_t k = 0; slot == MOST_SLOTS && k < MOST_SLOTS; ++k)
        if (!(*taken >> k & 1)) slot = k;
    *taken |= 1u << slot;
    return slot;
}

/* Adds weight on a dof to a stencil that begins at `begin` and ends before *end. */
static void add_weight(uint32_t *dofs, double *weights, size_t begin, size_t *end, uint32_t dof, double weight) {
    for (size_t k = begin; k < *end; ++k)
        if (dofs[k] == dof) {
            weights[k] += weight;
            return;
        }
    dofs[*end] = dof;
    weights[(*end)++] = weight;
}

/* Weights of the face's vertices at xi. */
static void shape(int bent, double xi, double phi[3]) {
    phi[0] = bent ? 0.5 * xi * (xi - 1.0) : 0.5 * (1.0 - xi);
    phi[1] = bent ? 0.5 * xi * (xi + 1.0) : 0.5 * (1.0 + xi);
    phi[2] = bent ? (1.0 - xi) * (1.0 + xi) : 0.0;
}

static int emit(const pass *p, size_t i, const hit *h, double gap, double area, uint64_t key) {
    segments *self = p->self;
    ab_points *out = p->out;
    const ab_surface *s = p->faces;
    const uint32_t *v = s->face_vertex + 3 * (size_t)h->face;
    const int vertices = v[2] == UINT32_MAX ? 2 : 3;
    const size_t own = p->points->point_start[i + 1] - p->points->point_start[i];
    size_t other = 0, n = out->count;
    for (int k = 0; k < vertices; ++k) other += s->vertex_start[v[k] + 1] - s->vertex_start[v[k]];
    if (self->host->reserve(self->host->context, out, 1, own > other ? own : other) != 0) return 0;
    if (!room(self->host, &self->placed, &self->placed_bytes, (n + 1) * sizeof *self->placed)) return 0;
    uint32_t *dof[2] = {out->a_dof, out->b_dof};
    double *weight[2] = {out->a_weight, out->b_weight};
    size_t *start[2] = {out->a_start, out->b_start};
    const uint32_t mine = p->number, its = 1 - p->number;
    size_t end = start[mine][n];
    for (size_t e = p->points->point_start[i]; e < p->points->point_start[i + 1]; ++e)
        add_weight(dof[mine], weight[mine], start[mine][n], &end, p->points->point_dof[e], p->points->point_weight[e]);
    start[mine][n + 1] = end;
    double phi[3];
    shape(vertices == 3, h->xi, phi);
    end = start[its][n];
    for (int k = 0; k < vertices; ++k)
        for (size_t e = s->vertex_start[v[k]]; phi[k] != 0.0 && e < s->vertex_start[v[k] + 1]; ++e)
            add_weight(dof[its], weight[its], start[its][n], &end, s->vertex_dof[e], phi[k] * s->vertex_weight[e]);
    start[its][n + 1] = end;
    const double sign = p->number == 0 ? -1.0 : 1.0;
    for (size_t d = 0; d < 2; ++d) {
        out->normal[d * out->ld + n] = sign * h->normal[d];
        out->position[d * out->ld + n] = h->x[d];
    }
    out->gap[n] = gap;
    if (out->distance) out->distance[n] = larger(gap, 0.0);
    out->area[n] = area;
    out->key[n] = key;
    self->placed[n] = (placed){p->number, h->face, p->points->point_vertex ? p->points->point_vertex[i] : UINT32_MAX, h->xi};
    out->count = n + 1;
    return 1;
}

/* Half size of point i in direction n. */
static double half_size(const ab_surface *s, size_t i, const double n[2]) {
    const double *e = s->point_extent + i;
    const size_t ld = s->point_ld;
    return sqrt(larger(0.0, n[0] * n[0] * e[0] + n[1] * n[1] * e[ld] + 2.0 * n[0] * n[1] * e[2 * ld]));
}

static int contact_of_point(const pass *p, size_t i, hits *all) {
    const ab_surface *s = p->points;
    const double t[2] = {s->point_position[i], s->point_position[s->point_ld + i]};
    all->count = 0;
    for (size_t k = s->near_start[i]; k < s->near_start[i + 1]; ++k)
        look_at_face(p->faces, s->near_face[k], t, p->self->projection == CLOSED, all);
    const uint32_t vertex = p->around ? s->point_vertex[i] : UINT32_MAX;
    choose(p->faces, vertex == UINT32_MAX ? NULL : s, vertex == UINT32_MAX ? NULL : p->around + 2 * (size_t)vertex, vertex, all);
    double gap[MOST_HITS];
    for (size_t k = 0; k < all->count; ++k) gap[k] = all->of[k].signed_distance - p->self->half_size * half_size(s, i, all->of[k].normal);
    const uint64_t base = s->point_key[i] << 3 | (uint64_t)p->number << 2;
    unsigned taken = 0;
    for (int slots = 0; slots < MOST_SLOTS; ++slots) {
        size_t least = MOST_HITS;
        for (size_t k = 0; k < all->count; ++k)
            if (gap[k] <= p->reach && (least == MOST_HITS || gap[k] < gap[least])) least = k;
        if (least == MOST_HITS) break;
        const hit h = all->of[least];
        const double half = half_size(s, i, h.normal), width = s->point_area[i],
                     part = vertex == UINT32_MAX ? 1.0 : part_along(s, p->around + 2 * (size_t)vertex, vertex, h.normal),
                     area = half > 0.0 ? width * width / (2.0 * half) : width * part;
        if (!emit(p, i, &h, gap[least], area, base | take_slot(p->self, base, h.normal, &taken))) return 0;
        for (size_t k = 0; k < all->count; ++k)
            if (dot(all->of[k].normal, h.normal) > SAME_WAY) gap[k] = INFINITY;
    }
    return 1;
}

/* Which faces meet at each vertex of a surface. */
static int faces_around(segments *self, int side, const ab_surface *s) {
    if (!room(self->host, &self->around[side], &self->around_bytes[side], (2 * s->vertex_count + 1) * sizeof **self->around) ||
        !room(self->host, &self->met[side], &self->met_bytes[side], s->vertex_count + 1))
        return 0;
    for (size_t k = 0; k < 2 * s->vertex_count; ++k) self->around[side][k] = UINT32_MAX;
    memset(self->met[side], 0, s->vertex_count);
    for (size_t f = 0; f < s->face_count; ++f) {
        const uint32_t *v = s->face_vertex + 3 * f;
        curve c;
        if (!curve_of(s, (uint32_t)f, &c)) continue;
        self->around[side][2 * (size_t)v[0] + 1] = self->around[side][2 * (size_t)v[1]] = (uint32_t)f;
        if (v[2] != UINT32_MAX) self->around[side][2 * (size_t)v[2]] = self->around[side][2 * (size_t)v[2] + 1] = (uint32_t)f;
    }
    return 1;
}

/* Where both passes see the same piece of surface, each carries half of it: a point gives away half of its area in so far as the vertices of the face under it are
 * contact points too. Points that are no vertices (two bodies of material points, each with faces) stand all along their own faces. */
static void share_area(segments *self, const ab_surface *const surface[2], ab_points *out) {
    int along[2] = {0, 0};
    for (size_t n = 0; n < out->count; ++n)
        if (self->placed[n].vertex != UINT32_MAX)
            self->met[self->placed[n].pass][self->placed[n].vertex] = 1;
        else
            along[self->placed[n].pass] = 1;
    for (size_t n = 0; n < out->count; ++n) {
        const placed *p = self->placed + n;
        const uint32_t other = 1 - p->pass, *v = surface[other]->face_vertex + 3 * (size_t)p->face;
        const int vertices = v[2] == UINT32_MAX ? 2 : 3;
        double phi[3], covered = 0.0;
        shape(vertices == 3, p->xi, phi);
        for (int k = 0; k < vertices; ++k)
            if (self->met[other][v[k]] || along[other]) covered += phi[k];
        out->area[n] *= 1.0 - 0.5 * larger(0.0, smaller(1.0, covered));
    }
}

static int remember(segments *self, const ab_points *out) {
    if (!room(self->host, &self->before, &self->before_bytes, (out->count + 1) * sizeof *self->before)) return 0;
    for (size_t n = 0; n < out->count; ++n) {
        const double sign = self->placed[n].pass == 0 ? -1.0 : 1.0;
        self->before[n] = (remembered){out->key[n], {sign * out->normal[n], sign * out->normal[out->ld + n]}};
    }
    self->before_count = out->count;
    qsort(self->before, out->count, sizeof *self->before, compare_keys);
    return 1;
}

static int find(void *itself, const ab_trace *a, const ab_trace *b, ab_points *out) {
    segments *self = itself;
    const ab_surface *const surface[2] = {a->surface, b->surface};
    const char *const body[2] = {a->body, b->body};
    const int wanted[2] = {self->passes != SECOND, self->passes != FIRST};
    out->count = 0;
    if (self->host->reserve(self->host->context, out, 1, 1) != 0) return -1;
    out->a_start[0] = out->b_start[0] = 0;
    for (int k = 0; k < 2; ++k) {
        if (self->passes != BOTH && wanted[k] && !surface[1 - k]->face_count) {
            char text[256];
            snprintf(text, sizeof text, "passes: %s wants faces of '%.100s', which has none; write passes: %s", k ? "second" : "first",
                     body[1 - k], k ? "first" : "second");
            self->host->message(self->host->context, text);
            return -1;
        }
        if (!faces_around(self, k, surface[k])) return -1;
    }
    hits all = {0};
    for (uint32_t k = 0; k < 2; ++k) {
        if (!wanted[k]) continue;
        const pass p = {self,
                        surface[k],
                        surface[1 - k],
                        k,
                        surface[k]->point_vertex ? self->around[k] : NULL,
                        2.0 * out->dt * out->speed + NEAR * out->cell,
                        out};
        for (size_t i = 0; i < surface[k]->point_count; ++i)
            if (surface[k]->near_start[i] < surface[k]->near_start[i + 1] && !contact_of_point(&p, i, &all)) return -1;
    }
    out->failures += all.failures;
    share_area(self, surface, out);
    return remember(self, out) ? 0 : -1;
}

static const ab_contact_ops OPS = {sizeof OPS, find, NULL};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_CONTACT,
    .spaces = AB_PLANE_STRAIN,
    .needs = AB_NEED_SURFACE,
    .gives = AB_GIVE_POINTS,
    .nparam = sizeof PARAMS / sizeof *PARAMS,
    .name = "point-to-segment",
    .help = "contact points where material points or nodes of one body meet faces of the other",
    .reference = "material points against finite-element faces: Chen, Qiu, Zhang, Lian 2015; node to segment in two passes: Taylor and "
                 "Papadopoulos 1991",
    .param = PARAMS,
    .create = create,
    .destroy = destroy,
    .ops = &OPS,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "point-to-segment", "1.0", "MIT", CLASSES};
