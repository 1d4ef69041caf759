/* point_to_segment.c: finds contact points between the surface points of one body and the faces of the other: the closest place of a face by projection (in closed
 * form on straight faces, by Newton's method on quadratic ones), its normal, the gap, and both sides' stencils. First the points of a on the faces of b, then the
 * points of b on the faces of a; the normal always goes out of a into b.
 *
 * Which places count, for one point:
 *   - outside the body, every place of a face or a convex vertex it looks at, the nearest of those that face the same way (within 30 degrees): in a concave
 *     corner that is one on each side;
 *   - inside, the nearest place of the surface alone, and in a concave corner that of the other face too;
 *   - a point that is a vertex of its own body knows its outside: only places whose normal it can meet count (within 60 degrees of the cone of its own normals). So a
 *     node that was pressed into a thin body still belongs to the side it came from, and two equal corners meet face to face;
 *   - the middle node of a bent face stands for the place of that face which reaches furthest. */
#include "abut_plugin.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "facing_length.h"
#include "segment_stencils.h"

enum { CLOSED, NEWTON };
enum { BOTH, FIRST, SECOND };
enum { AUTO, CENTRE, OUTLINE };
enum { MOST_SLOTS = 4 };
static const double NEAR = 0.03; /* of a cell: given out although the bodies do not meet in this step */
static const double BENT = 1e-4; /* bow of a face over its length: more is a round body, less what a flat one is bent by */

static const ab_param PARAMS[] = {
    {"half_size", "1", "part of a material point's half size that belongs to the body: 1 its whole domain, 0 its centre alone", NULL,
     AB_REAL, 0, 1.0, 0.0, 1.0},
    {"passes", "1", "points of the first body on faces of the second, of the second on faces of the first, or both where there are both",
     "both|first|second", AB_CHOICE, 0, BOTH, 0, 0},
    {"projection", "1", "onto straight faces: closed, or the iteration that quadratic faces need (the same answer)", "closed|newton",
     AB_CHOICE, 0, CLOSED, 0, 0},
    {"touching", "1",
     "what of a material point is stopped and pushed: its centre, or the outline of its own body where it touches (both passes against "
     "vertices, as of surface: points, always take the outline); auto: the outline where the response lets nothing slip, else the centre. Between two bodies of points",
     "auto|centre|outline", AB_CHOICE, 0, AUTO, 0, 0},
};

typedef struct remembered { /* a contact point of the last step */
    uint64_t key;
    double normal[2];
    uint32_t face; /* where on the other body it touched */
    uint32_t own;  /* and on which face of its own; UINT32_MAX: on none */
    double xi, gap;
} remembered;

typedef struct placed { /* where a contact point of this step lies, for its area */
    uint32_t pass, face, vertex, own;
    double xi;
    size_t point;
} placed;

typedef struct segments {
    const ab_host *host;
    double half_size;
    int passes, projection, touching;
    remembered *before;
    size_t before_count, before_bytes;
    placed *placed;
    size_t placed_bytes;
    uint32_t *around[2]; /* per vertex of a and of b: the face that ends there, the face that begins, UINT32_MAX: none */
    uint8_t *met[2];     /* per vertex of a and of b: it is a contact point itself */
    uint8_t *taken[2];   /* per face of a and of b: whose part of it is carried by another vertex */
    size_t around_bytes[2], met_bytes[2], taken_bytes[2];
} segments;

static int create(const ab_host *host, const ab_value *settings, void **self) {
    segments *s = host->allocate(host->context, sizeof *s);
    if (!s) return -1;
    s->host = host;
    s->half_size = settings[0].real;
    s->passes = (int)settings[1].integer;
    s->projection = (int)settings[2].integer;
    s->touching = (int)settings[3].integer;
    *self = s;
    return 0;
}

static void destroy(void *self) {
    segments *s = self;
    const ab_host *host = s->host;
    void *all[] = {s->before, s->placed, s->around[0], s->around[1], s->met[0], s->met[1], s->taken[0], s->taken[1], s};
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

/* Where a body is round it touches between its vertices. The middle vertex of a bent face stands for the place of that face which reaches furthest towards the
 * other body, where the slope has no part along the normal: r'.n = 0. It moves along the face, and at its end the next face's takes over with the same gap, so that
 * a round body rolls as one and not from vertex to vertex. (Not where a response holds the bodies together: a hold that moved along them under load would make energy.) Looks again from there; *own_xi: where it is on its own face. */
static int look_from_round_face(const pass *p, size_t i, uint32_t vertex, hit *h, double *own_xi) {
    enum { TIMES = 4 };
    const uint32_t *around = p->around + 2 * (size_t)vertex;
    curve own;
    if (around[0] == UINT32_MAX || p->points->face_vertex[3 * (size_t)around[0] + 2] != vertex || !curve_of(p->points, around[0], &own))
        return 0;
    if (!(dot(own.bow, own.bow) > BENT * BENT * own.length * own.length)) return 0;
    int moved = 0;
    for (int k = 0; k < TIMES; ++k) {
        const double bow = dot(own.bow, h->normal), xi = dot(own.along, h->normal) / (4.0 * bow);
        if (!(bow < 0.0 && fabs(xi) < 1.0)) return moved;
        double t[2];
        place_of(&own, xi, t);
        hits seen = {0};
        for (size_t e = p->points->near_start[i]; e < p->points->near_start[i + 1]; ++e)
            look_at_face(p->faces, p->points->near_face[e], t, p->self->projection == CLOSED, &seen);
        choose(p->faces, p->points, around, vertex, &seen);
        size_t least = MOST_HITS;
        for (size_t e = 0; e < seen.count; ++e)
            if (dot(seen.of[e].normal, h->normal) > SAME_WAY &&
                (least == MOST_HITS || seen.of[e].signed_distance < seen.of[least].signed_distance))
                least = e;
        if (least == MOST_HITS || !(seen.of[least].signed_distance <= h->signed_distance)) return moved;
        const double turned = cross(h->normal, seen.of[least].normal);
        *h = seen.of[least];
        *own_xi = xi;
        moved = 1;
        if (fabs(turned) <= EDGE) return 1; /* at once where the other face is straight */
    }
    return moved;
}

/* own_face: the face of its own body that the place is on, at own_xi; UINT32_MAX: it is point i itself. */
static int emit(const pass *p, size_t i, const hit *h, uint32_t own_face, double own_xi, double gap, double area, uint64_t key) {
    segments *self = p->self;
    ab_points *out = p->out;
    const ab_surface *s = p->faces;
    const size_t own = own_face == UINT32_MAX ? p->points->point_start[i + 1] - p->points->point_start[i]
                                              : stencil_of_face(p->points, own_face),
                 other = stencil_of_face(s, h->face), n = out->count;
    if (self->host->reserve(self->host->context, out, 1, own > other ? own : other) != 0) return 0;
    if (!room(self->host, &self->placed, &self->placed_bytes, (n + 1) * sizeof *self->placed)) return 0;
    uint32_t *dof[2] = {out->a_dof, out->b_dof};
    double *weight[2] = {out->a_weight, out->b_weight};
    size_t *start[2] = {out->a_start, out->b_start};
    const uint32_t mine = p->number, its = 1 - p->number;
    size_t end = start[mine][n];
    if (own_face != UINT32_MAX)
        add_place(p->points, own_face, own_xi, dof[mine], weight[mine], start[mine][n], &end);
    else
        for (size_t e = p->points->point_start[i]; e < p->points->point_start[i + 1]; ++e)
            add_weight(dof[mine], weight[mine], start[mine][n], &end, p->points->point_dof[e], p->points->point_weight[e]);
    start[mine][n + 1] = end;
    end = start[its][n];
    add_place(s, h->face, h->xi, dof[its], weight[its], start[its][n], &end);
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
    self->placed[n] = (placed){p->number, h->face, p->points->point_vertex ? p->points->point_vertex[i] : UINT32_MAX, own_face, h->xi, i};
    out->count = n + 1;
    return 1;
}

/* Half size of point i in direction n. */
static double half_size(const ab_surface *s, size_t i, const double n[2]) {
    const double *e = s->point_extent + i;
    const size_t ld = s->point_ld;
    return sqrt(larger(0.0, n[0] * n[0] * e[0] + n[1] * n[1] * e[ld] + 2.0 * n[0] * n[1] * e[2 * ld]));
}

static const double HOLDS = 0.012, /* of a cell: bodies that a response holds together (tied, from 0.01 on) are no further apart */
    AWAY = 0.5;                    /* of a face: where a place is not the same any more, as when an outline was drawn anew */

/* The place that it held on to in the last step instead of the closest one: a hold that follows the closest place, as that moves along the
 * faces of bodies that bend and turn, does work on them. */
static void hold_place(const pass *p, size_t i, uint64_t key, hit *h) {
    const remembered *was = recall(p->self, key);
    if (!was || !(was->gap <= HOLDS * p->out->cell) || was->face >= p->faces->face_count) return;
    hit held = {.face = was->face, .xi = was->xi};
    curve c;
    if (!curve_of(p->faces, was->face, &c) || !normal_at(&c, was->xi, held.normal)) return;
    place_of(&c, was->xi, held.x);
    const double *t = p->points->point_position + i, from_closest[2] = {held.x[0] - h->x[0], held.x[1] - h->x[1]},
                 r[2] = {t[0] - held.x[0], t[p->points->point_ld] - held.x[1]};
    if (dot(from_closest, from_closest) > AWAY * AWAY * c.length * c.length || dot(held.normal, h->normal) < SAME_WAY) return;
    held.signed_distance = dot(held.normal, r);
    held.distance = sqrt(dot(r, r));
    *h = held;
}

static const double BY_THE_FACE = 0.25; /* of a cell: no point that stands on its outline is further from it */

/* By its outline, the face of its own body that a material point touches with, half its size from its centre: that moves as the outline does there. With its centre's
 * velocity in place of it the two passes ask for two things, that the centres of a go with the faces of b and those of b with the faces of a: held both, as a tie has
 * to, nothing within half a point of the face can be strained, and contact points pull although a uniform pressure goes through. (But blocks that may slip creep at
 * rest, off lines of the grid: docs/extremes_hold.md.) Where the other body's own pass is one of vertices, which touch with its outline (surface: points), so that only these points could
 * disagree, the centre is no choice: forces along were off by half, displacements by more. UINT32_MAX: its centre. */
static uint32_t own_face_of(const pass *p, size_t i, uint64_t base, const double normal[2], double half, double *xi) {
    const ab_surface *s = p->points;
    if (s->point_vertex || !s->face_count || !(half > 0.0)) return UINT32_MAX;
    const int meets_vertices = p->self->passes == BOTH && p->faces->point_vertex;
    const int outline = p->self->touching == OUTLINE || (p->self->touching == AUTO && p->out->holds);
    if (!outline && !meets_vertices) return UINT32_MAX;
    const double x[2] = {s->point_position[i] - half * normal[0], s->point_position[s->point_ld + i] - half * normal[1]};
    uint32_t from = UINT32_MAX;
    for (uint32_t k = 0; k < MOST_SLOTS && from == UINT32_MAX; ++k) {
        const remembered *was = recall(p->self, base | k);
        if (was) from = was->own;
    }
    return own_place(s, x, BY_THE_FACE * p->out->cell, from, xi);
}

static int contact_of_point(const pass *p, size_t i, hits *all) {
    const ab_surface *s = p->points;
    const double t[2] = {s->point_position[i], s->point_position[s->point_ld + i]};
    all->count = 0;
    for (size_t k = s->near_start[i]; k < s->near_start[i + 1]; ++k)
        look_at_face(p->faces, s->near_face[k], t, p->self->projection == CLOSED, all);
    const uint32_t vertex = p->around ? s->point_vertex[i] : UINT32_MAX;
    choose(p->faces, vertex == UINT32_MAX ? NULL : s, vertex == UINT32_MAX ? NULL : p->around + 2 * (size_t)vertex, vertex, all);
    double gap[MOST_HITS], own_xi[MOST_HITS];
    int round_[MOST_HITS] = {0};
    for (size_t k = 0; vertex != UINT32_MAX && !p->out->fixed_places && k < all->count; ++k)
        round_[k] = look_from_round_face(p, i, vertex, all->of + k, own_xi + k);
    for (size_t k = 0; k < all->count; ++k) gap[k] = all->of[k].signed_distance - p->self->half_size * half_size(s, i, all->of[k].normal);
    const uint64_t base = s->point_key[i] << 3 | (uint64_t)p->number << 2;
    unsigned taken = 0;
    for (int slots = 0; slots < MOST_SLOTS; ++slots) {
        size_t least = MOST_HITS;
        for (size_t k = 0; k < all->count; ++k)
            if (gap[k] <= p->reach && (least == MOST_HITS || gap[k] < gap[least])) least = k;
        if (least == MOST_HITS) break;
        hit h = all->of[least];
        if (p->out->fixed_places) hold_place(p, i, base, &h);
        const double half = half_size(s, i, h.normal), width = s->point_area[i],
                     area = half > 0.0 ? width * width / (2.0 * half) : width; /* wherever it lies: share_area */
        const uint32_t own_face =
            round_[least] ? p->around[2 * (size_t)vertex] : own_face_of(p, i, base, h.normal, p->self->half_size * half, own_xi + least);
        const double open = p->out->fixed_places ? h.signed_distance - p->self->half_size * half : gap[least];
        if (!emit(p, i, &h, own_face, own_xi[least], open, area, base | take_slot(p->self, base, h.normal, &taken))) return 0;
        for (size_t k = 0; k < all->count; ++k)
            if (dot(all->of[k].normal, h.normal) > SAME_WAY) gap[k] = INFINITY;
    }
    return 1;
}

/* Which faces meet at each vertex of a surface. */
static int faces_around(segments *self, int side, const ab_surface *s) {
    if (!room(self->host, &self->around[side], &self->around_bytes[side], (2 * s->vertex_count + 1) * sizeof **self->around) ||
        !room(self->host, &self->met[side], &self->met_bytes[side], s->vertex_count + 1) ||
        !room(self->host, &self->taken[side], &self->taken_bytes[side], s->face_count + 1))
        return 0;
    for (size_t k = 0; k < 2 * s->vertex_count; ++k) self->around[side][k] = UINT32_MAX;
    memset(self->met[side], 0, s->vertex_count);
    memset(self->taken[side], 0, s->face_count);
    for (size_t f = 0; f < s->face_count; ++f) {
        const uint32_t *v = s->face_vertex + 3 * f;
        curve c;
        if (!curve_of(s, (uint32_t)f, &c)) continue;
        self->around[side][2 * (size_t)v[0] + 1] = self->around[side][2 * (size_t)v[1]] = (uint32_t)f;
        if (v[2] != UINT32_MAX) self->around[side][2 * (size_t)v[2]] = self->around[side][2 * (size_t)v[2] + 1] = (uint32_t)f;
    }
    return 1;
}

/* The area of a contact point is what its body's surface it stands for has over the other body. Where both passes see the same piece of surface, each carries
 * half of it. Points that are no vertices (material points) stand for their own width, and where their body has faces all along these. */
static void share_area(segments *self, const ab_surface *const surface[2], double reach, ab_points *out) {
    facing side[2];
    for (int k = 0; k < 2; ++k) side[k] = (facing){surface[k], self->around[k], self->met[k], self->taken[k], 0};
    for (size_t n = 0; n < out->count; ++n)
        if (self->placed[n].vertex != UINT32_MAX)
            self->met[self->placed[n].pass][self->placed[n].vertex] = 1;
        else
            side[self->placed[n].pass].along = 1;
    for (int round_ = 0; round_ < 2; ++round_) /* who carries what, then how much */
        for (size_t n = 0; n < out->count; ++n) {
            const placed *p = self->placed + n;
            const facing *own = side + p->pass, *other = side + 1 - p->pass;
            const double sign = p->pass == 0 ? -1.0 : 1.0, normal[2] = {sign * out->normal[n], sign * out->normal[out->ld + n]};
            const frame f = {{out->position[n], out->position[out->ld + n]}, {normal[0], normal[1]}, {normal[1], -normal[0]}};
            if (round_ == 0) {
                if (p->vertex != UINT32_MAX) take_over(own, other, &f, p->vertex, p->face, reach);
                continue;
            }
            const double width = out->area[n], *x = own->surface->point_position + p->point, at[2] = {x[0], x[own->surface->point_ld]},
                         middle = along_frame(&f, at);
            double low = middle - 0.5 * width, high = middle + 0.5 * width, all = width;
            if (p->vertex != UINT32_MAX) own_length(own, &f, p->vertex, &low, &high, &all);
            const double area = all > 0.0 ? width * (facing_length(other, &f, p->face, low, high) / all) : width;
            out->area[n] = larger(LEAST_PART * width, area);
        }
}

static int remember(segments *self, const ab_points *out) {
    if (!room(self->host, &self->before, &self->before_bytes, (out->count + 1) * sizeof *self->before)) return 0;
    for (size_t n = 0; n < out->count; ++n) {
        const double sign = self->placed[n].pass == 0 ? -1.0 : 1.0;
        self->before[n] = (remembered){out->key[n],          {sign * out->normal[n], sign * out->normal[out->ld + n]},
                                       self->placed[n].face, self->placed[n].own,
                                       self->placed[n].xi,   out->gap[n]};
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
    const double reach = 2.0 * out->dt * out->speed + NEAR * out->cell;
    for (uint32_t k = 0; k < 2; ++k) {
        if (!wanted[k]) continue;
        const pass p = {self, surface[k], surface[1 - k], k, surface[k]->point_vertex ? self->around[k] : NULL, reach, out};
        for (size_t i = 0; i < surface[k]->point_count; ++i)
            if (surface[k]->near_start[i] < surface[k]->near_start[i + 1] && !contact_of_point(&p, i, &all)) return -1;
    }
    out->failures += all.failures;
    share_area(self, surface, reach, out);
    return remember(self, out) ? 0 : -1;
}

static int save(void *itself, const ab_stream *stream) {
    segments *self = itself;
    const int status = stream->write(stream->context, &self->before_count, sizeof self->before_count);
    return status != 0 ? status : stream->write(stream->context, self->before, self->before_count * sizeof *self->before);
}

static int load(void *itself, const ab_stream *stream) {
    segments *self = itself;
    size_t count = 0;
    if (stream->read(stream->context, &count, sizeof count) != 0 || count > UINT32_MAX) return -1;
    if (!room(self->host, &self->before, &self->before_bytes, (count + 1) * sizeof *self->before)) return -1;
    self->before_count = 0;
    if (stream->read(stream->context, self->before, count * sizeof *self->before) != 0) return -1;
    self->before_count = count;
    return 0;
}

static const ab_contact_ops OPS = {sizeof OPS, find, NULL};
static const ab_class CLASS = {
    .struct_size = sizeof CLASS,
    .kind = AB_CONTACT,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC,
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
    .save = save,
    .load = load,
};
static const ab_class *const CLASSES[] = {&CLASS};
const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "point-to-segment", "1.0", "MIT", CLASSES};
