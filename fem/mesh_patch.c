/* mesh_patch.c: a patch between four edges: nodes lie on the edges by length, and inside by transfinite interpolation (Gordon and Hall 1973, eq. 11). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/mesh_parts.h"

enum { BOTTOM, RIGHT, TOP, LEFT };

typedef struct edge {
    const ab_edge_spec *spec;
    double *length; /* straight pieces: from the beginning to each point, over the whole; NULL: an arc */
    double angle, turn, radius;
} edge;

typedef struct patch {
    edge edges[4];
} patch;

static bool edge_prepare(const ab_edge_spec *spec, edge *e) {
    *e = (edge){.spec = spec};
    if (spec->arc) {
        double arm[2][2];
        for (int i = 0; i < 2; i++)
            for (int d = 0; d < 2; d++) arm[i][d] = spec->points[i][d] - spec->center[d];
        e->angle = atan2(arm[0][1], arm[0][0]);
        e->turn = atan2(arm[0][0] * arm[1][1] - arm[0][1] * arm[1][0], arm[0][0] * arm[1][0] + arm[0][1] * arm[1][1]); /* the short way */
        e->radius = hypot(arm[0][0], arm[0][1]);
        return true;
    }
    e->length = malloc(spec->count * sizeof *e->length);
    if (e->length == NULL) return false;
    e->length[0] = 0;
    for (size_t i = 1; i < spec->count; i++)
        e->length[i] = e->length[i - 1] + hypot(spec->points[i][0] - spec->points[i - 1][0], spec->points[i][1] - spec->points[i - 1][1]);
    const double whole = e->length[spec->count - 1];
    for (size_t i = 1; i < spec->count; i++) e->length[i] /= whole;
    return true;
}

/* The place at part s of the edge's length; both ends to the last bit. */
static void edge_place(const edge *e, double s, double x[2]) {
    const ab_edge_spec *spec = e->spec;
    const double *first = spec->points[0], *last = spec->points[spec->count - 1];
    if (s <= 0 || s >= 1) {
        memcpy(x, s <= 0 ? first : last, 2 * sizeof *x);
    } else if (spec->arc) {
        x[0] = spec->center[0] + e->radius * cos(e->angle + s * e->turn);
        x[1] = spec->center[1] + e->radius * sin(e->angle + s * e->turn);
    } else {
        size_t low = 0, high = spec->count - 1; /* length[low] <= s < length[high] */
        while (high - low > 1) {
            const size_t middle = low + (high - low) / 2;
            *(e->length[middle] <= s ? &low : &high) = middle;
        }
        const double part = (s - e->length[low]) / (e->length[high] - e->length[low]);
        for (int d = 0; d < 2; d++) x[d] = spec->points[low][d] + part * (spec->points[high][d] - spec->points[low][d]);
    }
}

static void patch_place(const void *context, double s, double t, double x[2]) {
    const patch *p = context;
    if (t <= 0 || t >= 1) {
        edge_place(&p->edges[t <= 0 ? BOTTOM : TOP], s, x);
        return;
    }
    if (s <= 0 || s >= 1) {
        edge_place(&p->edges[s <= 0 ? LEFT : RIGHT], t, x);
        return;
    }
    double side[4][2], corner[2][2][2]; /* [top][right] */
    for (int k = 0; k < 4; k++) edge_place(&p->edges[k], k == BOTTOM || k == TOP ? s : t, side[k]);
    for (int k = 0; k < 4; k++) edge_place(&p->edges[k / 2 == 0 ? BOTTOM : TOP], k % 2, corner[k / 2][k % 2]);
    for (int d = 0; d < 2; d++)
        x[d] = (1 - t) * side[BOTTOM][d] + t * side[TOP][d] + (1 - s) * side[LEFT][d] + s * side[RIGHT][d] -
               (1 - s) * ((1 - t) * corner[0][0][d] + t * corner[1][0][d]) - s * ((1 - t) * corner[0][1][d] + t * corner[1][1][d]);
}

/* A sharp corner of an edge (more than 10 degrees) that no corner of an element meets is cut off by the mesh: said once an edge. */
static void warn_of_kinks(const ab_body_spec *spec, int side, const edge *e, ab_report *report) {
    static const char *const names[] = {"bottom", "right", "top", "left"};
    const int way = side == BOTTOM || side == TOP ? 0 : 1;
    const long n = spec->mesh.elements[way];
    double *s = malloc(((size_t)n + 1) * sizeof *s);
    if (s == NULL || e->spec->arc) {
        free(s);
        return;
    }
    fem_mesh_divide(n, spec->mesh.grading[way], s);
    for (size_t i = 1; i + 1 < e->spec->count; i++) {
        const double *a = e->spec->points[i - 1], *b = e->spec->points[i], *c = e->spec->points[i + 1];
        const double in[2] = {b[0] - a[0], b[1] - a[1]}, out[2] = {c[0] - b[0], c[1] - b[1]};
        if (fabs(atan2(in[0] * out[1] - in[1] * out[0], in[0] * out[0] + in[1] * out[1])) < 0.1745) continue;
        double nearest = 1;
        for (long k = 0; k <= n; k++) nearest = fmin(nearest, fabs(s[k] - e->length[i]));
        if (nearest < 1e-9) continue;
        ab_report_warning(
            report, spec->mesh.mark,
            "body '%s': the corner at [%.10g, %.10g] of the patch's %s edge lies between two corners of elements and is cut off; it "
            "stands at %.6g of the edge's length: choose elements and grading so that one ends there",
            spec->name, b[0], b[1], names[side], e->length[i]);
        break;
    }
    free(s);
}

ab_status fem_mesh_patch(const ab_body_spec *spec, fem_mesh **mesh, ab_report *report) {
    patch p = {0};
    bool good = true;
    for (int k = 0; k < 4; k++) good = edge_prepare(&spec->mesh.edge[k], &p.edges[k]) && good;
    for (int k = 0; good && k < 4; k++) warn_of_kinks(spec, k, &p.edges[k], report);
    const ab_status status = good ? fem_mesh_lattice(spec, patch_place, &p, mesh, report)
                                  : ab_report_failure(report, "no memory for the mesh of body '%s'", spec->name);
    for (int k = 0; k < 4; k++) free(p.edges[k].length);
    return status;
}
