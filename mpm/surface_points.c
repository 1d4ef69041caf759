/* surface_points.c: points on a body's own outline that touch other bodies in place of its material points' domains (surface: points): the vertices of its outline.
 *
 * A vertex is a fixed combination of the material points around it, x = sum a_p x_p with sum a_p = 1 and x as drawn at the start: moving least squares with a linear
 * basis (Lancaster and Salkauskas 1981). So it goes with every affine motion of the body exactly, never creeps, and its nodes and weights, w_i = sum a_p N_ip, are those
 * by which these points move: what hardly moves a point (a node that carries next to no mass) hardly moves the surface, and a push on the vertex has
 * the force and the moment of one there. (Weights of the vertex' own place in its cell do not have that: light nodes behind the surface are left with
 * accelerations that no point feels, and pressures grow to stop what they seem to move.)
 * What they do have is a fault of gimp: a node above the surface by nearly a cell, which the uppermost points hardly weigh at (s^2 where their stress acts on it as s, s the height
 * of the surface over the line below), gets so much less of a push, and they are left with a part of the pressure. cpdi weighs by corners that stand on the surface: s.
 *
 * A vertex on a side of the grid where points may only slide (roller) stands in a plane of symmetry: half of the points around it are behind the plane, the images of
 * those before it. Theirs and the images' places along the normal of the side cancel, and it stays in the plane. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "mpm/outline.h"

static const double RADIUS = 2.2; /* of the distance between points: of the neighbourhood that a vertex hangs on */
static const double WIDER = 1.5;  /* times that, where its points stand in one line */
static const double FLAT = 0.03;  /* of the distance squared: second moment across a neighbourhood in one line (two lines: 0.1) */
enum { TRIES = 3, WINDOW = 10, MOST_NODES = WINDOW * WINDOW, POINT_NODES = 16 };

typedef struct anchor { /* a material point that vertices hang on, in this step */
    uint32_t id;
    double x[2];
    int32_t node[2]; /* first of its stencil */
    bool here;       /* it has not left */
} anchor;

struct mpm_touching {
    size_t vertices, anchors, room;
    size_t *first; /* vertices + 1: what a vertex hangs on */
    uint32_t *hangs_on;
    double *share;
    uint8_t *plane; /* per vertex, bit s: it stands in side s of the grid, a plane of symmetry */
    anchor *anchor;
    double *value; /* POINT_NODES per anchor */
    uint32_t *node;
    /* vertices in the region asked for */
    size_t room_points, room_stencil;
    double *position, *extent, *area;
    uint64_t *key;
    size_t *start;
    uint32_t *dof, *vertex;
    double *weight;
};

void mpm_touching_destroy(struct mpm_touching *t) {
    if (!t) return;
    free(t->first), free(t->hangs_on), free(t->share), free(t->plane), free(t->anchor), free(t->value), free(t->node);
    free(t->position), free(t->extent), free(t->area), free(t->key), free(t->start), free(t->dof), free(t->vertex), free(t->weight);
    free(t);
}

size_t mpm_touching_bytes(const struct mpm_touching *t) {
    if (!t) return 0;
    return sizeof *t + t->vertices * (sizeof *t->first + sizeof *t->plane) + t->room * (sizeof *t->hangs_on + sizeof *t->share) +
           t->anchors * (sizeof *t->anchor + POINT_NODES * (sizeof *t->value + sizeof *t->node)) +
           t->room_points * (6 * sizeof(double) + sizeof *t->key + sizeof *t->start + sizeof *t->vertex) +
           t->room_stencil * (sizeof *t->dof + sizeof *t->weight);
}

/* ---- what vertices hang on ------------------------------------------------------------------------------------------------------------- */

/* The fill's points by squares of a lattice. */
typedef struct bins {
    double low[2], size;
    int32_t count[2];
    uint32_t *first, *point; /* squares + 1; in their order */
} bins;

static int32_t bin_of(const bins *b, double x, int c) {
    const double at = (x - b->low[c]) / b->size;
    return at < 0.0 ? 0 : at >= b->count[c] ? b->count[c] - 1 : (int32_t)at;
}

static bool bins_create(const ab_fill *fill, double size, bins *b) {
    *b = (bins){.size = size};
    for (int c = 0; c < 2; ++c) {
        b->low[c] = fill->low[c];
        b->count[c] = 1 + (int32_t)((fill->high[c] - fill->low[c]) / size);
    }
    const size_t squares = (size_t)b->count[0] * (size_t)b->count[1];
    b->first = calloc(squares + 2, sizeof *b->first);
    b->point = malloc((fill->count + 1) * sizeof *b->point);
    if (!b->first || !b->point) return false;
    for (int pass = 0; pass < 2; ++pass) {
        for (size_t p = 0; p < fill->count; ++p) {
            const size_t square = (size_t)bin_of(b, fill->y[p], 1) * (size_t)b->count[0] + (size_t)bin_of(b, fill->x[p], 0);
            if (pass == 0)
                ++b->first[square + 2];
            else
                b->point[b->first[square + 1]++] = (uint32_t)p;
        }
        for (size_t k = 2; pass == 0 && k < squares + 2; ++k) b->first[k] += b->first[k - 1];
    }
    return true;
}

/* Points within the radius of x, with their weights. False: no memory. */
static bool neighbours(struct mpm_touching *t, const ab_fill *fill, const bins *b, const double x[2], double radius, size_t from,
                       size_t *end) {
    int32_t low[2], high[2];
    for (int c = 0; c < 2; ++c) low[c] = bin_of(b, x[c] - radius, c), high[c] = bin_of(b, x[c] + radius, c);
    *end = from;
    for (int32_t j = low[1]; j <= high[1]; ++j)
        for (int32_t i = low[0]; i <= high[0]; ++i) {
            const size_t square = (size_t)j * (size_t)b->count[0] + (size_t)i;
            for (uint32_t k = b->first[square]; k < b->first[square + 1]; ++k) {
                const uint32_t p = b->point[k];
                const double dx = fill->x[p] - x[0], dy = fill->y[p] - x[1], rest = 1.0 - (dx * dx + dy * dy) / (radius * radius);
                if (!(rest > 0.0)) continue;
                if (*end == t->room) {
                    const size_t more = 2 * t->room + 256;
                    if (!ab_memory_resize(&t->hangs_on, more, sizeof *t->hangs_on) || !ab_memory_resize(&t->share, more, sizeof *t->share))
                        return false;
                    t->room = more;
                }
                t->hangs_on[*end] = p;
                t->share[(*end)++] = rest * rest;
            }
        }
    return true;
}

/* Sides of the grid that are planes of symmetry and in which a vertex stands, a bit each. */
static uint8_t planes_of(const mpm_body *body, const double x[2]) {
    static const double THERE = 1e-9; /* of a cell */
    uint8_t plane = 0;
    for (int s = 0; s < AB_SIDES; ++s) {
        const double side = s % 2 ? body->span[s / 2] : 0.0;
        if (body->side[s] == AB_SIDE_ROLLER && fabs(x[s / 2] - side) <= THERE * body->h) plane |= (uint8_t)(1u << s);
    }
    return plane;
}

static bool mirrored(uint8_t plane, int c) { return plane >> (2 * c) & 3; }

/* Turns weights into shares: times 1 + b.d, so that their centre is x. False where the points stand in one line. */
static bool centre(struct mpm_touching *t, const ab_fill *fill, const double x[2], uint8_t plane, double flat, size_t from, size_t end) {
    double m[6] = {0}; /* moments 1, x, y, xx, xy, yy */
    for (size_t k = from; k < end; ++k) {
        const double w = t->share[k], dx = fill->x[t->hangs_on[k]] - x[0], dy = fill->y[t->hangs_on[k]] - x[1];
        m[0] += w, m[1] += w * dx, m[2] += w * dy, m[3] += w * dx * dx, m[4] += w * dx * dy, m[5] += w * dy * dy;
    }
    if (!(m[0] > 0.0)) return false;
    const double mx = m[1] / m[0], my = m[2] / m[0], xx = m[3] / m[0] - mx * mx, xy = m[4] / m[0] - mx * my, yy = m[5] / m[0] - my * my,
                 det = xx * yy - xy * xy;
    double b[2] = {0.0, 0.0};
    if (!plane) {
        if (!(det > flat * (xx + yy))) return false; /* the smaller principal moment is about det/(xx + yy) */
        b[0] = (my * xy - mx * yy) / det, b[1] = (mx * xy - my * xx) / det;
    } else { /* with the images the centre is in the plane, and only the direction along it is left */
        if (!(mirrored(plane, 0) || xx > flat) || !(mirrored(plane, 1) || yy > flat)) return false;
        if (!mirrored(plane, 0)) b[0] = -mx / xx;
        if (!mirrored(plane, 1)) b[1] = -my / yy;
    }
    double sum = 0.0;
    for (size_t k = from; k < end; ++k) {
        t->share[k] *= 1.0 + b[0] * (fill->x[t->hangs_on[k]] - x[0] - mx) + b[1] * (fill->y[t->hangs_on[k]] - x[1] - my);
        sum += t->share[k];
    }
    for (size_t k = from; k < end; ++k) t->share[k] /= sum;
    return true;
}

static int compare_numbers(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Each point that some vertex hangs on once, in the order of the fill; hangs_on becomes its place in that list. */
static bool collect(struct mpm_touching *t) {
    const size_t n = t->first[t->vertices];
    uint32_t *id = malloc((n + 1) * sizeof *id);
    if (!id) return false;
    memcpy(id, t->hangs_on, n * sizeof *id);
    qsort(id, n, sizeof *id, compare_numbers);
    for (size_t k = 0; k < n; ++k)
        if (!t->anchors || id[t->anchors - 1] != id[k]) id[t->anchors++] = id[k];
    t->anchor = calloc(t->anchors + 1, sizeof *t->anchor);
    t->value = malloc((t->anchors + 1) * POINT_NODES * sizeof *t->value);
    t->node = malloc((t->anchors + 1) * POINT_NODES * sizeof *t->node);
    const bool room = t->anchor && t->value && t->node;
    for (size_t a = 0; room && a < t->anchors; ++a) t->anchor[a].id = id[a];
    for (size_t k = 0; room && k < n; ++k)
        t->hangs_on[k] = (uint32_t)((uint32_t *)bsearch(t->hangs_on + k, id, t->anchors, sizeof *id, compare_numbers) - id);
    free(id);
    return room;
}

ab_status mpm_touching_create(mpm_body *body, const ab_fill *fill, ab_report *report) {
    const mpm_loops *loops = &body->outline->loops;
    const ab_body_spec *spec = body->domain.spec;
    const double apart = body->h / sqrt((double)spec->per_cell);
    struct mpm_touching *t = calloc(1, sizeof *t);
    body->outline->touching = t;
    bins b = {0};
    bool room = t && (t->first = calloc(loops->count + 1, sizeof *t->first)) && (t->plane = calloc(loops->count + 1, sizeof *t->plane)) &&
                bins_create(fill, fmax(apart, 0.5 * body->h), &b);
    ab_status status = AB_OK;
    for (size_t k = 0; room && status == AB_OK && k < loops->count; ++k) {
        const double x[2] = {loops->x[2 * k] + body->origin[0], loops->x[2 * k + 1] + body->origin[1]};
        double radius = RADIUS * apart;
        t->plane[k] = planes_of(body, loops->x + 2 * k);
        bool found = false;
        for (int attempt = 0; room && !found && attempt < TRIES; ++attempt, radius *= WIDER) {
            room = neighbours(t, fill, &b, x, radius, t->first[k], t->first + k + 1);
            found = room && centre(t, fill, x, t->plane[k], FLAT * apart * apart, t->first[k], t->first[k + 1]);
        }
        if (room && !found)
            status =
                ab_report_error(report, spec->mark,
                                "body '%s' is only one point thick near (%.6g, %.6g) m, and a surface point needs two to hang on; use more "
                                "points (fill.per_cell, %d now) or a finer grid, or leave out surface: points",
                                spec->name, x[0], x[1], spec->per_cell);
    }
    if (room) t->vertices = loops->count;
    room = room && (status != AB_OK || collect(t));
    free(b.first), free(b.point);
    if (!room) return ab_report_failure(report, "body '%s': no memory for its %zu surface points", spec->name, loops->count);
    return status;
}

/* ---- in each step ---------------------------------------------------------------------------------------------------------------------- */

/* Where the anchors are, and their stencils if asked for. */
static void look(mpm_body *body, bool stencils) {
    struct mpm_touching *t = body->outline->touching;
    const int nodes = body->kernel->nodes;
    mpm_stencils w;
    const mpm_tile *tile = NULL;
    uint32_t last = UINT32_MAX; /* block */
    for (size_t a = 0; a < t->anchors; ++a) {
        anchor *at = t->anchor + a;
        const uint32_t slot = body->slot[at->id];
        at->here = slot != UINT32_MAX;
        if (!at->here) continue;
        const double *block = mpm_block(body, slot / 8);
        const int l = (int)(slot % 8);
        for (int c = 0; c < 2; ++c) at->x[c] = block[8 * (ROW_X + c) + l];
        if (!stencils) continue;
        if (slot / 8 != last) {
            last = slot / 8;
            tile = body->tiles + mpm_tile_of_block(body, last);
            body->kernel->stencils(body, tile, block, &w);
        }
        at->node[0] = tile->tx * AB_TILE + w.node[l] % body->kernel->patch - 1;
        at->node[1] = tile->ty * AB_TILE + w.node[l] / body->kernel->patch - 1;
        for (int j = 0; j < nodes; ++j)
            for (int i = 0; i < nodes; ++i) {
                const size_t to = a * POINT_NODES + (size_t)(j * nodes + i);
                t->value[to] = w.value[j * nodes + i][l];
                t->node[to] = t->value[to] > 0.0 ? mpm_dof_of(body, tile, w.node[l] + j * body->kernel->patch + i) : 0;
            }
    }
}

bool mpm_touching_place(mpm_body *body, bool stencils) {
    struct mpm_touching *t = body->outline->touching;
    bool all = true;
    look(body, stencils);
    for (size_t k = 0; k < t->vertices; ++k) {
        double x[2] = {0.0, 0.0}, sum = 0.0;
        for (size_t e = t->first[k]; e < t->first[k + 1]; ++e) {
            const anchor *at = t->anchor + t->hangs_on[e];
            if (!at->here) continue;
            x[0] += t->share[e] * at->x[0], x[1] += t->share[e] * at->x[1];
            sum += t->share[e];
        }
        all = all && sum > 0.0;
        if (!(sum > 0.0)) continue;
        for (int c = 0; c < 2; ++c) /* in a plane of symmetry it stays there */
            if (!mirrored(t->plane[k], c)) body->outline->loops.x[2 * k + (size_t)c] = x[c] / sum;
    }
    return all;
}

size_t mpm_touching_stencil(const mpm_body *body, size_t k, uint32_t *dof, double *weight) {
    const struct mpm_touching *t = body->outline->touching;
    const int nodes = body->kernel->nodes;
    int32_t base[2];
    double window[MOST_NODES] = {0.0}, sum = 0.0;
    uint32_t number[MOST_NODES];
    for (int c = 0; c < 2; ++c) base[c] = (int32_t)floor(body->outline->loops.x[2 * k + (size_t)c] * body->inverse_h) - WINDOW / 2 + 1;
    for (size_t e = t->first[k]; e < t->first[k + 1]; ++e) {
        const anchor *at = t->anchor + t->hangs_on[e];
        const int32_t i0 = at->node[0] - base[0], j0 = at->node[1] - base[1];
        if (!at->here) continue;
        if (i0 < 0 || j0 < 0 || i0 + nodes > WINDOW || j0 + nodes > WINDOW) return 0; /* torn off */
        for (int n = 0; n < nodes * nodes; ++n) {
            const size_t from = t->hangs_on[e] * (size_t)POINT_NODES + (size_t)n, to = (size_t)((j0 + n / nodes) * WINDOW + i0 + n % nodes);
            if (!(t->value[from] > 0.0)) continue;
            window[to] += t->share[e] * t->value[from];
            number[to] = t->node[from];
        }
    }
    size_t count = 0;
    for (size_t n = 0; n < MOST_NODES; ++n) {
        if (window[n] == 0.0 || !(body->own[(size_t)number[n] * OWN_RECORD + OWN_MASS] > 0.0)) continue;
        dof[count] = number[n];
        weight[count++] = window[n];
        sum += window[n];
    }
    for (size_t n = 0; n < count; ++n) weight[n] /= sum;
    return sum > 0.0 ? count : 0;
}

size_t mpm_touching_most_nodes(void) { return MOST_NODES; }

static bool reserve(struct mpm_touching *t, size_t stencil) {
    if (t->vertices > t->room_points) {
        const size_t n = (t->vertices + 8) / 8 * 8;
        if (!ab_memory_resize(&t->position, 2 * n, sizeof(double)) || !ab_memory_resize(&t->extent, 3 * n, sizeof(double)) ||
            !ab_memory_resize(&t->area, n, sizeof(double)) || !ab_memory_resize(&t->key, n, sizeof *t->key) ||
            !ab_memory_resize(&t->start, n + 1, sizeof *t->start) || !ab_memory_resize(&t->vertex, n, sizeof *t->vertex))
            return false;
        for (size_t k = 0; k < 3 * n; ++k) t->extent[k] = 0.0;
        t->room_points = n;
    }
    if (stencil <= t->room_stencil) return true;
    if (!ab_memory_resize(&t->dof, 2 * stencil, sizeof *t->dof) || !ab_memory_resize(&t->weight, 2 * stencil, sizeof *t->weight))
        return false;
    t->room_stencil = 2 * stencil;
    return true;
}

static bool in_region(const ab_region *region, const double x[2]) {
    const int32_t i = (int32_t)floor(x[0] / region->cell), j = (int32_t)floor(x[1] / region->cell), a = i & (AB_TILE - 1),
                  b = j & (AB_TILE - 1);
    const long at = mpm_tile_find(region->key, region->count, ab_tile_key((i - a) / AB_TILE, (j - b) / AB_TILE));
    return at >= 0 && (region->cells[at] >> (b * AB_TILE + a) & 1);
}

ab_status mpm_touching_points(mpm_body *body, const ab_region *region, ab_surface *surface, ab_report *report) {
    struct mpm_outline *o = body->outline;
    struct mpm_touching *t = o->touching;
    const mpm_loops *loops = &o->loops;
    if (!reserve(t, o->start[loops->count]))
        return ab_report_failure(report, "body '%s': no memory for its %zu surface points", body->domain.spec->name, loops->count);
    const size_t ld = t->room_points;
    size_t count = 0;
    t->start[0] = 0;
    for (size_t k = 0; k < loops->count; ++k) {
        const double *x = loops->x + 2 * k, *before = loops->x + 2 * (size_t)loops->prior[k],
                     *after = loops->x + 2 * (size_t)loops->next[k];
        if (!in_region(region, x)) continue;
        t->position[count] = x[0];
        t->position[ld + count] = x[1];
        t->area[count] = 0.5 * (hypot(x[0] - before[0], x[1] - before[1]) + hypot(after[0] - x[0], after[1] - x[1]));
        t->key[count] = (uint64_t)k + 1;
        t->vertex[count] = (uint32_t)k;
        size_t at = t->start[count];
        for (size_t e = o->start[k]; e < o->start[k + 1]; ++e, ++at) t->dof[at] = o->dof[e], t->weight[at] = o->weight[e];
        t->start[++count] = at;
    }
    surface->point_count = count;
    surface->point_ld = ld;
    surface->point_position = t->position;
    surface->point_extent = t->extent;
    surface->point_area = t->area;
    surface->point_key = t->key;
    surface->point_vertex = t->vertex;
    surface->point_start = t->start;
    surface->point_dof = t->dof;
    surface->point_weight = t->weight;
    return AB_OK;
}
