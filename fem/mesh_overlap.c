/* mesh_overlap.c: elements that lie on each other without sharing sides: pieces drawn twice, one inside another, a mesh folded over itself. No connectivity shows
 * that. Where the sides are joined (fem_sides_join) and no element is folded, the number of elements over a place changes only across outer sides; so when any
 * place is covered twice, some element with an outer side lies on another one: only those are searched, against all. The areas of loops would not do: an element
 * inside another brings an outline of its own. */
#include <math.h>
#include <stdlib.h>

#include "fem/mesh_parts.h"

static const double IGNORED = 1e-6; /* of the smaller element's area: rounding */
static const double REFUSED = 0.1;  /* more is no matter of chords along a curve that two pieces divide differently */

typedef struct box {
    double low[2], high[2];
} box;

typedef struct tree { /* boxes over the elements in Morton's order: node i holds 2i and 2i + 1, leaves are count .. 2 count - 1 */
    size_t count;
    box *node;
    uint32_t *element;
} tree;

typedef struct leaf {
    uint64_t code;
    uint32_t element;
} leaf;

static int by_code(const void *a, const void *b) {
    const leaf *p = a, *q = b;
    if (p->code != q->code) return p->code < q->code ? -1 : 1;
    return p->element < q->element ? -1 : p->element > q->element;
}

static uint64_t spread(uint64_t n) { /* the bits of a 32-bit number to every second place */
    n = (n | n << 16) & 0x0000ffff0000ffffu;
    n = (n | n << 8) & 0x00ff00ff00ff00ffu;
    n = (n | n << 4) & 0x0f0f0f0f0f0f0f0fu;
    n = (n | n << 2) & 0x3333333333333333u;
    return (n | n << 1) & 0x5555555555555555u;
}

static const double *corner_of(const fem_mesh *mesh, size_t e, size_t a) {
    return mesh->x + 2 * (size_t)mesh->connectivity[e * (size_t)mesh->nodes + a];
}

static box box_of(const fem_mesh *mesh, size_t e) {
    box b = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (size_t a = 0; a < 4; a++)
        for (int d = 0; d < 2; d++) {
            b.low[d] = fmin(b.low[d], corner_of(mesh, e, a)[d]);
            b.high[d] = fmax(b.high[d], corner_of(mesh, e, a)[d]);
        }
    return b;
}

static bool boxes_meet(const box *a, const box *b) {
    return a->low[0] < b->high[0] && b->low[0] < a->high[0] && a->low[1] < b->high[1] && b->low[1] < a->high[1];
}

static bool plant(const fem_mesh *mesh, tree *t) {
    const size_t n = mesh->element_count;
    leaf *leaves = malloc((n + 1) * sizeof *leaves);
    *t = (tree){n, malloc((2 * n + 2) * sizeof(box)), malloc((n + 1) * sizeof(uint32_t))};
    if (leaves == NULL || t->node == NULL || t->element == NULL) {
        free(leaves);
        return false;
    }
    const double size = fmax(mesh->high[0] - mesh->low[0], mesh->high[1] - mesh->low[1]);
    for (size_t e = 0; e < n; e++) {
        const box b = box_of(mesh, e);
        uint64_t place[2];
        for (int d = 0; d < 2; d++) place[d] = (uint64_t)(4e9 * fmin(fmax((0.5 * (b.low[d] + b.high[d]) - mesh->low[d]) / size, 0.0), 1.0));
        leaves[e] = (leaf){spread(place[0]) | spread(place[1]) << 1, (uint32_t)e};
    }
    qsort(leaves, n, sizeof *leaves, by_code);
    for (size_t k = 0; k < n; k++) {
        t->element[k] = leaves[k].element;
        t->node[n + k] = box_of(mesh, leaves[k].element);
    }
    free(leaves);
    for (size_t i = n; i-- > 1;)
        for (int d = 0; d < 2; d++) {
            t->node[i].low[d] = fmin(t->node[2 * i].low[d], t->node[2 * i + 1].low[d]);
            t->node[i].high[d] = fmax(t->node[2 * i].high[d], t->node[2 * i + 1].high[d]);
        }
    return true;
}

static double twice(const double a[2], const double b[2], const double c[2]) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
}

/* The corners as two triangles, cut so that both have a positive area: a corner of more than 180 degrees between curved sides is on the cut. */
static void triangles_of(const fem_mesh *mesh, size_t e, const double *corner[2][3]) {
    const double *x[4];
    for (size_t a = 0; a < 4; a++) x[a] = corner_of(mesh, e, a);
    const int shift = twice(x[0], x[1], x[2]) > 0 && twice(x[0], x[2], x[3]) > 0 ? 0 : 1;
    for (int k = 0; k < 2; k++)
        for (int a = 0; a < 3; a++) corner[k][a] = x[(shift + (a == 0 ? 0 : a + k)) % 4];
}

static double area_of(const fem_mesh *mesh, size_t e) {
    const double *corner[2][3];
    triangles_of(mesh, e, corner);
    return 0.5 * (twice(corner[0][0], corner[0][1], corner[0][2]) + twice(corner[1][0], corner[1][1], corner[1][2]));
}

/* The area that two triangles share: one is cut along the sides of the other (Sutherland & Hodgman, Comm. ACM 17, 1974). */
static double shared_by(const double *const a[3], const double *const b[3]) {
    double p[2][8][2];
    int n = 3, now = 0;
    for (int k = 0; k < 3; k++)
        for (int d = 0; d < 2; d++) p[0][k][d] = a[k][d];
    for (int s = 0; s < 3 && n > 0; s++, now = 1 - now) {
        int kept = 0;
        for (int k = 0; k < n; k++) {
            const double *from = p[now][k], *to = p[now][(k + 1) % n];
            const double here = twice(b[s], b[(s + 1) % 3], from), there = twice(b[s], b[(s + 1) % 3], to);
            if (here >= 0) {
                p[1 - now][kept][0] = from[0];
                p[1 - now][kept++][1] = from[1];
            }
            if ((here < 0) == (there < 0)) continue;
            for (int d = 0; d < 2; d++) p[1 - now][kept][d] = from[d] + here / (here - there) * (to[d] - from[d]);
            kept++;
        }
        n = kept;
    }
    double area = 0;
    for (int k = 1; k + 1 < n; k++) area += 0.5 * twice(p[now][0], p[now][k], p[now][k + 1]);
    return fmax(area, 0.0);
}

static double shared(const fem_mesh *mesh, size_t e, size_t other) {
    const double *a[2][3], *b[2][3];
    double area = 0;
    triangles_of(mesh, e, a);
    triangles_of(mesh, other, b);
    for (int k = 0; k < 4; k++) area += shared_by(a[k / 2], b[k % 2]);
    return area;
}

typedef struct found {
    size_t pairs, worst[2];
    double area, part; /* m2 in all; the largest part of an element that lies on another */
} found;

/* All pairs, or those with an element at the outside only. Each pair once, in the order of elements. */
static found search(const fem_mesh *mesh, const tree *t, const bool *outside) {
    found f = {0};
    for (size_t e = 0; e < t->count; e++) {
        if (outside != NULL && !outside[e]) continue;
        const box own = box_of(mesh, e);
        const double own_area = area_of(mesh, e);
        size_t stack[140], depth = 0;
        stack[depth++] = 1;
        while (depth > 0) {
            const size_t i = stack[--depth];
            if (!boxes_meet(&own, &t->node[i])) continue;
            if (i < t->count) {
                stack[depth++] = 2 * i + 1;
                stack[depth++] = 2 * i;
                continue;
            }
            const size_t other = t->element[i - t->count];
            if (other == e || (other < e && (outside == NULL || outside[other]))) continue;
            const double area = shared(mesh, e, other), part = area / fmin(own_area, area_of(mesh, other));
            if (!(part > IGNORED)) continue;
            if (part > f.part) {
                f.part = part;
                f.worst[0] = e;
                f.worst[1] = other;
            }
            f.area += area;
            f.pairs++;
        }
    }
    return f;
}

ab_status fem_mesh_overlaps(const fem_mesh *mesh, const char *body, ab_mark mark, const char *file, ab_report *report) {
    if (mesh->element_count < 2) return AB_OK;
    tree t = {0};
    uint32_t *mate = NULL;
    bool *outside = calloc(mesh->element_count, sizeof *outside);
    ab_status status = outside != NULL && plant(mesh, &t) ? fem_sides_join(mesh, body, mark, &mate, report)
                                                          : ab_report_failure(report, "no memory for the mesh of body '%s'", body);
    if (status == AB_OK) {
        for (size_t s = 0; s < 4 * mesh->element_count; s++)
            if (mate[s] == FEM_NONE) outside[s / 4] = true;
        found f = search(mesh, &t, outside);
        if (f.pairs > 0) f = search(mesh, &t, NULL);
        const unsigned long long a = fem_element_id(mesh, f.worst[0]), b = fem_element_id(mesh, f.worst[1]);
        if (f.part > REFUSED)
            status =
                ab_report_error(report, mark,
                                "body '%s': elements of '%s' overlap in %zu pair%s, by %.6g m2 together: %llu and %llu, say, share %.3g %% "
                                "of the smaller; their mass would count twice; remove the elements drawn twice in Gmsh and save anew",
                                body, file, f.pairs, f.pairs == 1 ? "" : "s", f.area, a, b, 100 * f.part);
        else if (f.pairs > 0)
            ab_report_warning(
                report, mark,
                "body '%s': elements of '%s' overlap in %zu pair%s, by %.6g m2 together: %llu and %llu, say, share %.3g %% of the "
                "smaller; their mass counts twice there; in Gmsh, join the pieces (BooleanFragments) and mesh anew",
                body, file, f.pairs, f.pairs == 1 ? "" : "s", f.area, a, b, 100 * f.part);
    }
    free(mate);
    free(outside);
    free(t.node);
    free(t.element);
    return status;
}
