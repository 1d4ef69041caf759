/* rigid_layer.c: points along the outline of a rigid body, for its trace on the grid. Only a layer is needed: nodes deeper inside meet no other body. Their volumes
 * and centroids are exact; the outermost reach to the outline and no further (half size = distance).
 *
 * A lattice along the longest straight face is laid over the body; cells that the outline cuts become the part of them inside it. Circles have rings of
 * sectors; the outermost are thin, and their ellipses have the circle's own curvature and overlap, so that together they reach as far as the circle. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "fem/rigid.h"

static const double PI = 3.14159265358979323846;

void rigid_layer_clear(rigid_layer *l) {
    free(l->place), free(l->volume), free(l->extent);
    *l = (rigid_layer){0};
}

/* place: from the body's centre. */
static bool add(rigid_layer *l, double x, double y, double volume, const double extent[3]) {
    if (l->count == l->capacity) {
        size_t capacity[3] = {l->capacity, l->capacity, l->capacity};
        if (!ab_memory_append(&l->place, capacity, l->count + 64, sizeof *l->place) ||
            !ab_memory_append(&l->volume, capacity + 1, l->count + 64, sizeof *l->volume) ||
            !ab_memory_append(&l->extent, capacity + 2, l->count + 64, sizeof *l->extent))
            return false;
        l->capacity = capacity[0];
    }
    l->place[l->count][0] = x;
    l->place[l->count][1] = y;
    l->volume[l->count] = volume;
    memcpy(l->extent[l->count++], extent, sizeof *l->extent);
    return true;
}

/* ---- circles -------------------------------------------------------------------------------------------------------------- */

/* Sectors between two radii. outwards: > 0: they reach to the outer circle, as ellipses with its curvature there, < 0: to the inner one, 0: between others. */
static bool add_ring(rigid_layer *l, double from, double to, double width, int outwards) {
    const int count = (int)fmax(ceil(2.0 * PI * to / width), 6.0);
    const double beta = PI / count, area = beta * (to * to - from * from);
    const double centroid = 2.0 / 3.0 * (to * to * to - from * from * from) / (to * to - from * from) * sin(beta) / beta;
    const double along = outwards > 0 ? to - centroid : outwards < 0 ? centroid - from : 0.5 * (to - from);
    const double across = outwards > 0 ? sqrt(along * to) : 0.25 * area / along;
    for (int k = 0; k < count; ++k) {
        const double c = cos(2.0 * beta * k), s = sin(2.0 * beta * k), a2 = along * along, t2 = across * across;
        const double extent[3] = {a2 * c * c + t2 * s * s, a2 * s * s + t2 * c * c, (a2 - t2) * c * s};
        if (!add(l, centroid * c, centroid * s, area, extent)) return false;
    }
    return true;
}

/* Rings from radius `from` to `to`, no thicker than `spacing`. */
static bool add_rings(rigid_layer *l, double from, double to, double spacing, int outwards) {
    const int count = (int)fmax(ceil((to - from) / spacing * (1.0 - 1e-12)), 1.0);
    for (int k = 0; k < count; ++k) {
        const double a = from + (to - from) * k / count, b = from + (to - from) * (k + 1) / count;
        if (!add_ring(l, a, b, spacing, outwards < 0 && k == 0 ? -1 : outwards > 0 && k == count - 1 ? 1 : 0)) return false;
    }
    return true;
}

/* A skin, then rings. Ellipses three times as wide as their sectors (half widths a = 3 w/2 and a^2/R) leave the circle by 2e-4 h^2/R, h = 4 w being a cell. */
static bool add_circles(rigid_layer *l, double outer, double inner, double spacing, double depth) {
    const double width = fmin(0.5 * spacing, outer), thick = fmin(4.5 * width * width / outer, 0.25 * (outer - inner));
    const double under = outer - thick;
    if (!add_ring(l, under, outer, width, 1)) return false;
    if (under - inner <= 2.0 * depth || (inner == 0.0 && under <= depth)) return add_rings(l, inner, under, spacing, inner > 0.0 ? -1 : 0);
    if (!add_rings(l, under - depth, under, spacing, 0)) return false;
    return inner == 0.0 || add_rings(l, inner, inner + depth, spacing, -1);
}

/* ---- outlines of faces ----------------------------------------------------------------------------------------------------- */

typedef struct edge {
    double from[2], to[2];
} edge;

typedef struct cut { /* an edge runs through a cell */
    uint64_t cell;
    uint32_t edge;
} cut;

typedef struct lattice {
    double cosine, sine, low[2], size[2]; /* directions; corner and cell in them */
    edge *edges;                          /* in them */
    uint32_t *loop;                       /* number of the outline each edge belongs to; edges of one stand together in order */
    size_t edge_count, edge_capacity, loop_capacity;
    uint64_t *cell; /* cells near the outline */
    size_t cell_count, cell_capacity;
    cut *cuts;
    size_t cut_count, cut_capacity;
    double (*piece)[2], (*spare)[2]; /* a loop while it is clipped */
    size_t piece_capacity, spare_capacity;
} lattice;

static uint64_t cell_key(long i, long j) { return (uint64_t)(uint32_t)(j + (1 << 30)) << 32 | (uint32_t)(i + (1 << 30)); }
static long cell_i(uint64_t key) { return (long)(uint32_t)key - (1 << 30); }
static long cell_j(uint64_t key) { return (long)(uint32_t)(key >> 32) - (1 << 30); }

static bool add_edge(lattice *t, const double from[2], const double to[2], uint32_t loop) {
    if (!ab_memory_append(&t->edges, &t->edge_capacity, t->edge_count + 1, sizeof *t->edges) ||
        !ab_memory_append(&t->loop, &t->loop_capacity, t->edge_count + 1, sizeof *t->loop))
        return false;
    edge *e = t->edges + t->edge_count;
    e->from[0] = t->cosine * from[0] + t->sine * from[1];
    e->from[1] = t->cosine * from[1] - t->sine * from[0];
    e->to[0] = t->cosine * to[0] + t->sine * to[1];
    e->to[1] = t->cosine * to[1] - t->sine * to[0];
    t->loop[t->edge_count++] = loop;
    return true;
}

/* Outlines as closed chains of straight edges, places from the centre; a curved face becomes chords that leave it by less than a hundredth of `spacing`. */
static bool add_edges(lattice *t, const rigid_outline *o, double spacing) {
    uint8_t *seen = calloc(o->face_count + 1, 1);
    if (!seen) return false;
    bool good = true;
    uint32_t loop = 0;
    for (size_t first = 0; first < o->face_count && good; ++first) {
        if (seen[first]) continue;
        for (size_t f = first; !seen[f] && good; f = o->beside[2 * f + 1]) {
            seen[f] = 1;
            const uint32_t *v = o->face + 3 * f;
            double a[2], b[2], bow[2] = {0.0};
            for (int c = 0; c < 2; ++c) {
                a[c] = o->vertex[v[0]][c] - o->centre[c];
                b[c] = o->vertex[v[1]][c] - o->centre[c];
                if (v[2] != FEM_NONE) bow[c] = o->vertex[v[2]][c] - o->centre[c] - 0.5 * (a[c] + b[c]);
            }
            const int parts = (int)fmin(ceil(sqrt(hypot(bow[0], bow[1]) / (0.01 * spacing)) + 1e-9), 1000.0);
            double from[2] = {a[0], a[1]};
            for (int k = 1; k <= parts && good; ++k) {
                const double xi = 2.0 * k / parts - 1.0;
                double to[2];
                for (int c = 0; c < 2; ++c)
                    to[c] = k == parts ? b[c] : 0.5 * (a[c] + b[c]) + 0.5 * (b[c] - a[c]) * xi + bow[c] * (1.0 - xi * xi);
                good = add_edge(t, from, to, loop);
                memcpy(from, to, sizeof from);
            }
        }
        ++loop;
    }
    free(seen);
    return good;
}

/* Direction of the longest straight face; along the axes where there is none. */
static void turn_lattice(lattice *t, const rigid_outline *o) {
    double longest = 0.0;
    t->cosine = 1.0;
    t->sine = 0.0;
    for (size_t f = 0; f < o->face_count; ++f) {
        if (o->face[3 * f + 2] != FEM_NONE) continue;
        const double *a = o->vertex[o->face[3 * f]], *b = o->vertex[o->face[3 * f + 1]];
        const double length = hypot(b[0] - a[0], b[1] - a[1]);
        if (length <= longest * (1.0 + 1e-9)) continue;
        longest = length;
        t->cosine = (b[0] - a[0]) / length;
        t->sine = (b[1] - a[1]) / length;
    }
}

static int compare_cells(const void *a, const void *b) {
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}
static int compare_cuts(const void *a, const void *b) {
    const cut *x = a, *y = b;
    if (x->cell != y->cell) return x->cell < y->cell ? -1 : 1;
    return (x->edge > y->edge) - (x->edge < y->edge);
}

/* Cells of the box round a piece of an edge, `margin` m wider on each side. */
static bool mark(lattice *t, const double from[2], const double to[2], double margin, uint32_t number, bool cuts) {
    long first[2], last[2];
    for (int c = 0; c < 2; ++c) {
        first[c] = (long)floor((fmin(from[c], to[c]) - margin - t->low[c]) / t->size[c]);
        last[c] = (long)floor((fmax(from[c], to[c]) + margin - t->low[c]) / t->size[c]);
    }
    for (long j = first[1]; j <= last[1]; ++j)
        for (long i = first[0]; i <= last[0]; ++i) {
            if (cuts) {
                if (!ab_memory_append(&t->cuts, &t->cut_capacity, t->cut_count + 1, sizeof *t->cuts)) return false;
                t->cuts[t->cut_count++] = (cut){cell_key(i, j), number};
            } else {
                if (!ab_memory_append(&t->cell, &t->cell_capacity, t->cell_count + 1, sizeof *t->cell)) return false;
                t->cell[t->cell_count++] = cell_key(i, j);
            }
        }
    return true;
}

/* Both lists, edge by edge in pieces, so that slanted ones do not fill their box. */
static bool mark_all(lattice *t, double depth) {
    const double small = fmin(t->size[0], t->size[1]);
    for (int pass = 0; pass < 2; ++pass) {
        const double step = pass ? small : depth, margin = pass ? 1e-9 * small : depth;
        for (size_t e = 0; e < t->edge_count; ++e) {
            const edge *g = t->edges + e;
            const int parts = (int)ceil(hypot(g->to[0] - g->from[0], g->to[1] - g->from[1]) / step + 1e-9);
            for (int k = 0; k < parts; ++k) {
                double a[2], b[2];
                for (int c = 0; c < 2; ++c) {
                    a[c] = g->from[c] + (g->to[c] - g->from[c]) * k / parts;
                    b[c] = g->from[c] + (g->to[c] - g->from[c]) * (k + 1) / parts;
                }
                if (!mark(t, a, b, margin, (uint32_t)e, pass)) return false;
            }
        }
    }
    qsort(t->cell, t->cell_count, sizeof *t->cell, compare_cells);
    qsort(t->cuts, t->cut_count, sizeof *t->cuts, compare_cuts);
    size_t n = 0;
    for (size_t k = 0; k < t->cell_count; ++k)
        if (!n || t->cell[k] != t->cell[n - 1]) t->cell[n++] = t->cell[k];
    t->cell_count = n;
    n = 0;
    for (size_t k = 0; k < t->cut_count; ++k)
        if (!n || compare_cuts(t->cuts + k, t->cuts + n - 1)) t->cuts[n++] = t->cuts[k];
    t->cut_count = n;
    return true;
}

static bool inside(const lattice *t, const double x[2]) {
    bool in = false;
    for (size_t e = 0; e < t->edge_count; ++e) {
        const double *a = t->edges[e].from, *b = t->edges[e].to;
        if ((a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + (b[0] - a[0]) * (x[1] - a[1]) / (b[1] - a[1])) in = !in;
    }
    return in;
}

/* Cuts a polygon off where sign*x[c] > limit (Sutherland, Hodgman 1974). Where it falls apart, edges along the limit join the parts and add nothing to moments. */
static bool clip(lattice *t, size_t *count, int c, double sign, double limit) {
    if (!ab_memory_append(&t->spare, &t->spare_capacity, 2 * *count + 2, sizeof *t->spare)) return false;
    size_t n = 0;
    for (size_t k = 0; k < *count; ++k) {
        const double *a = t->piece[k], *b = t->piece[(k + 1) % *count];
        const double da = sign * a[c] - limit, db = sign * b[c] - limit;
        if (da <= 0.0) memcpy(t->spare[n++], a, sizeof *t->spare);
        if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
            const double s = da / (da - db);
            t->spare[n][c] = sign * limit;
            t->spare[n][!c] = a[!c] + s * (b[!c] - a[!c]);
            ++n;
        }
    }
    double(*swap)[2] = t->piece;
    t->piece = t->spare;
    t->spare = swap;
    const size_t capacity = t->piece_capacity;
    t->piece_capacity = t->spare_capacity;
    t->spare_capacity = capacity;
    *count = n;
    return true;
}

typedef struct moments {
    double area, u, v, uu, uv, vv;
} moments;

/* Of the part of a cell inside the outline, about the cell's middle. */
static bool cell_moments(lattice *t, const double middle[2], moments *m) {
    *m = (moments){0};
    for (size_t first = 0; first < t->edge_count;) {
        size_t count = 0, e = first;
        for (; e < t->edge_count && t->loop[e] == t->loop[first]; ++e, ++count) {
            if (!ab_memory_append(&t->piece, &t->piece_capacity, count + 1, sizeof *t->piece)) return false;
            for (int c = 0; c < 2; ++c) t->piece[count][c] = t->edges[e].from[c] - middle[c];
        }
        first = e;
        for (int side = 0; side < 4 && count; ++side)
            if (!clip(t, &count, side / 2, side % 2 ? 1.0 : -1.0, 0.5 * t->size[side / 2])) return false;
        for (size_t k = 0; k < count; ++k) {
            const double *a = t->piece[k], *b = t->piece[(k + 1) % count], w = a[0] * b[1] - a[1] * b[0];
            m->area += w / 2.0;
            m->u += w * (a[0] + b[0]) / 6.0;
            m->v += w * (a[1] + b[1]) / 6.0;
            m->uu += w * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) / 12.0;
            m->vv += w * (a[1] * a[1] + a[1] * b[1] + b[1] * b[1]) / 12.0;
            m->uv += w * (2.0 * a[0] * a[1] + a[0] * b[1] + b[0] * a[1] + 2.0 * b[0] * b[1]) / 24.0;
        }
    }
    return true;
}

/* Length of the part of an edge inside a cell; its outward normal and distance from a place. */
static double length_in_cell(const lattice *t, const edge *e, const double middle[2], const double place[2], double n[2],
                             double *distance) {
    double from = 0.0, to = 1.0; /* of the edge, the part in the cell */
    for (int c = 0; c < 2; ++c) {
        const double d = e->to[c] - e->from[c], low = middle[c] - 0.5 * t->size[c] - e->from[c], high = low + t->size[c];
        if (d == 0.0) {
            if (low > 0.0 || high < 0.0) return 0.0;
            continue;
        }
        from = fmax(from, fmin(low / d, high / d));
        to = fmin(to, fmax(low / d, high / d));
    }
    const double dx = e->to[0] - e->from[0], dy = e->to[1] - e->from[1], whole = hypot(dx, dy);
    n[0] = dy / whole;
    n[1] = -dx / whole;
    *distance = n[0] * (e->from[0] - place[0]) + n[1] * (e->from[1] - place[1]);
    return fmax(to - from, 0.0) * whole;
}

/* Makes the half size along the normals of the longest edge in the cell, and of the longest that leans by more than 20 degrees against it, the distance to
 * them. With both of them given, what is left is how the two directions lean together, which stays; with one, what lies across it. */
static void fit(const lattice *t, const double middle[2], const double place[2], const cut *cuts, size_t count, double extent[3]) {
    double n[2] = {0.0}, m[2] = {0.0}, distance[2] = {0.0}, length[2] = {0.0};
    for (int pass = 0; pass < 2; ++pass)
        for (size_t k = 0; k < count; ++k) {
            double normal[2], far = 0.0;
            const double in = length_in_cell(t, t->edges + cuts[k].edge, middle, place, normal, &far);
            if (!(in > length[pass]) || !(far > 0.0) || (pass && fabs(n[0] * normal[1] - n[1] * normal[0]) < 0.34)) continue;
            memcpy(pass ? m : n, normal, sizeof normal);
            length[pass] = in;
            distance[pass] = far;
        }
    if (length[0] == 0.0) return;
    const double ax = extent[0] * n[0] + extent[2] * n[1], ay = extent[2] * n[0] + extent[1] * n[1], now = n[0] * ax + n[1] * ay;
    if (length[1] == 0.0) {
        const double beta = (distance[0] * distance[0] - now) / (now * now);
        extent[0] += beta * ax * ax;
        extent[1] += beta * ay * ay;
        extent[2] += beta * ax * ay;
        return;
    }
    const double bx = extent[0] * m[0] + extent[2] * m[1], by = extent[2] * m[0] + extent[1] * m[1];
    const double lean = (m[0] * ax + m[1] * ay) / sqrt(now * (m[0] * bx + m[1] * by)), det = n[0] * m[1] - n[1] * m[0];
    const double p[2] = {m[1] / det * distance[0], -m[0] / det * distance[0]}, q[2] = {-n[1] / det * distance[1], n[0] / det * distance[1]};
    extent[0] = p[0] * p[0] + q[0] * q[0] + 2.0 * lean * p[0] * q[0];
    extent[1] = p[1] * p[1] + q[1] * q[1] + 2.0 * lean * p[1] * q[1];
    extent[2] = p[0] * p[1] + q[0] * q[1] + lean * (p[0] * q[1] + p[1] * q[0]);
}

/* One point: place and extent in the lattice's directions. */
static bool add_turned(const lattice *t, rigid_layer *l, const double at[2], double volume, const double e[3]) {
    const double c = t->cosine, s = t->sine;
    const double turned[3] = {c * c * e[0] + s * s * e[1] - 2.0 * c * s * e[2], s * s * e[0] + c * c * e[1] + 2.0 * c * s * e[2],
                              c * s * (e[0] - e[1]) + (c * c - s * s) * e[2]};
    return add(l, c * at[0] - s * at[1], s * at[0] + c * at[1], volume, turned);
}

static bool add_cells(lattice *t, rigid_layer *l) {
    const double whole = t->size[0] * t->size[1];
    const double full[3] = {0.25 * t->size[0] * t->size[0], 0.25 * t->size[1] * t->size[1], 0.0};
    size_t at = 0;
    bool in = false;
    uint64_t last = UINT64_MAX;
    for (size_t k = 0; k < t->cell_count; ++k) {
        const uint64_t key = t->cell[k];
        const double middle[2] = {t->low[0] + (cell_i(key) + 0.5) * t->size[0], t->low[1] + (cell_j(key) + 0.5) * t->size[1]};
        while (at < t->cut_count && t->cuts[at].cell < key) ++at;
        size_t end = at;
        while (end < t->cut_count && t->cuts[end].cell == key) ++end;
        if (end == at) {
            if (last == UINT64_MAX || key != last + 1) in = inside(t, middle); /* else as the cell to its left, which no edge cuts either */
            last = key;
            if (in && !add_turned(t, l, middle, whole, full)) return false;
            continue;
        }
        last = UINT64_MAX;
        moments m;
        if (!cell_moments(t, middle, &m)) return false;
        if (m.area <= 1e-9 * whole) continue;
        const double u = m.u / m.area, v = m.v / m.area, place[2] = {middle[0] + u, middle[1] + v};
        double extent[3] = {3.0 * (m.uu / m.area - u * u), 3.0 * (m.vv / m.area - v * v), 3.0 * (m.uv / m.area - u * v)};
        if (m.area >= (1.0 - 1e-9) * whole)
            memcpy(extent, full, sizeof extent);
        else if (extent[0] > 0.0 && extent[1] > 0.0 && extent[0] * extent[1] > extent[2] * extent[2])
            fit(t, middle, place, t->cuts + at, end - at, extent);
        else
            extent[0] = fmax(extent[0], 0.0), extent[1] = fmax(extent[1], 0.0), extent[2] = 0.0;
        if (!add_turned(t, l, place, m.area, extent)) return false;
    }
    return true;
}

/* Curved faces that bulge outwards get a skin of points without volume: overlapping ellipses with the face's curvature, as circles have. */
static bool add_skin(const rigid_outline *o, double spacing, rigid_layer *l) {
    for (size_t f = 0; f < o->face_count; ++f) {
        const uint32_t *v = o->face + 3 * f;
        if (v[2] == FEM_NONE) continue;
        double middle[2], half[2], bow[2]; /* r = middle + half xi + bow (1 - xi^2), from the centre */
        for (int c = 0; c < 2; ++c) {
            middle[c] = 0.5 * (o->vertex[v[0]][c] + o->vertex[v[1]][c]) - o->centre[c];
            half[c] = 0.5 * (o->vertex[v[1]][c] - o->vertex[v[0]][c]);
            bow[c] = o->vertex[v[2]][c] - o->centre[c] - middle[c];
        }
        const int parts = (int)ceil(2.0 * hypot(half[0], half[1]) / (0.5 * spacing));
        for (int k = 0; k < parts; ++k) {
            const double xi = (2.0 * k + 1.0) / parts - 1.0, slope[2] = {half[0] - 2.0 * bow[0] * xi, half[1] - 2.0 * bow[1] * xi};
            const double length = hypot(slope[0], slope[1]), turn = 2.0 * (slope[1] * bow[0] - slope[0] * bow[1]);
            if (!(turn > 0.0)) continue;
            const double radius = length * length * length / turn, across = fmin(3.0 * length / parts, 0.7 * radius),
                         along = across * across / radius;
            const double t[2] = {slope[0] / length, slope[1] / length}, n[2] = {t[1], -t[0]}, a2 = across * across, b2 = along * along;
            const double extent[3] = {a2 * t[0] * t[0] + b2 * n[0] * n[0], a2 * t[1] * t[1] + b2 * n[1] * n[1],
                                      a2 * t[0] * t[1] + b2 * n[0] * n[1]};
            double x[2];
            for (int c = 0; c < 2; ++c) x[c] = middle[c] + half[c] * xi + bow[c] * (1.0 - xi * xi) - along * n[c];
            if (!add(l, x[0], x[1], 0.0, extent)) return false;
        }
    }
    return true;
}

bool rigid_layer_create(const rigid_outline *o, double spacing, double depth, rigid_layer *l) {
    *l = (rigid_layer){0};
    if (o->radius > 0.0) return add_circles(l, o->radius, o->inner, spacing, depth);
    lattice t = {0};
    turn_lattice(&t, o);
    bool good = add_edges(&t, o, spacing);
    double high[2] = {-INFINITY, -INFINITY};
    t.low[0] = t.low[1] = INFINITY;
    for (size_t e = 0; e < t.edge_count; ++e)
        for (int c = 0; c < 2; ++c) {
            t.low[c] = fmin(t.low[c], t.edges[e].from[c]);
            high[c] = fmax(high[c], t.edges[e].from[c]);
        }
    for (int c = 0; c < 2; ++c) t.size[c] = (high[c] - t.low[c]) / fmax(ceil((high[c] - t.low[c]) / spacing * (1.0 - 1e-12)), 1.0);
    good = good && mark_all(&t, depth) && add_cells(&t, l) && add_skin(o, spacing, l);
    free(t.edges), free(t.loop), free(t.cell), free(t.cuts), free(t.piece), free(t.spare);
    return good;
}
