/* fill_outline.c: outlines of straight edges: the checks of a polygon and the directions of its lattice. */
#include <math.h>
#include <stdlib.h>

#include "mpm/fill_outline.h"

void ab_outline_clear(ab_outline *outline) {
    free(outline->edge);
    *outline = (ab_outline){0};
}

static double cross(const double a[2], const double b[2], const double c[2]) /* twice the area of the triangle */
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* An edge and its number, sorted along one axis to find pairs that may meet. */
typedef struct span {
    double low, high, side_low, side_high;
    size_t edge;
} span;

static int by_low(const void *a, const void *b) {
    const span *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    return p->edge < q->edge ? -1 : p->edge > q->edge;
}

/* Whether two edges that share no vertex have a place in common (nearer than `slack` across). */
static bool meet(const ab_edge *p, const ab_edge *q, double slack) {
    const double lp = hypot(p->to[0] - p->from[0], p->to[1] - p->from[1]), lq = hypot(q->to[0] - q->from[0], q->to[1] - q->from[1]);
    const double p1 = cross(q->from, q->to, p->from) / lq, p2 = cross(q->from, q->to, p->to) / lq;
    const double q1 = cross(p->from, p->to, q->from) / lp, q2 = cross(p->from, p->to, q->to) / lp;
    if (fmin(p1, p2) > slack || fmax(p1, p2) < -slack || fmin(q1, q2) > slack || fmax(q1, q2) < -slack) return false;
    for (int k = 0; k < 2; k++)
        if (fmin(p->from[k], p->to[k]) > fmax(q->from[k], q->to[k]) + slack ||
            fmin(q->from[k], q->to[k]) > fmax(p->from[k], p->to[k]) + slack)
            return false;
    return true;
}

/* Reports edges that touch or cross: sweeps along the axis on which the edges overlap least. */
static ab_status check_crossings(const ab_outline *outline, const size_t *number, double size, ab_mark mark, const char *body,
                                 ab_report *report) {
    const size_t n = outline->count;
    span *spans = malloc(n * sizeof *spans);
    if (!spans) return ab_report_failure(report, "body '%s': no memory for a polygon of %zu vertices", body, n);
    double length[2] = {0, 0};
    for (size_t e = 0; e < n; e++)
        for (int k = 0; k < 2; k++) length[k] += fabs(outline->edge[e].to[k] - outline->edge[e].from[k]);
    const int axis = length[1] < length[0];
    for (size_t e = 0; e < n; e++) {
        const ab_edge *g = &outline->edge[e];
        spans[e] = (span){fmin(g->from[axis], g->to[axis]), fmax(g->from[axis], g->to[axis]), fmin(g->from[!axis], g->to[!axis]),
                          fmax(g->from[!axis], g->to[!axis]), e};
    }
    qsort(spans, n, sizeof *spans, by_low);
    const double slack = 1e-13 * size;
    int found = 0;
    for (size_t a = 0; a < n && found < 5; a++)
        for (size_t b = a + 1; b < n && spans[b].low <= spans[a].high + slack && found < 5; b++) {
            if (spans[b].side_low > spans[a].side_high + slack || spans[a].side_low > spans[b].side_high + slack) continue;
            size_t e = spans[a].edge, f = spans[b].edge;
            if (e > f) {
                const size_t swap = e;
                e = f;
                f = swap;
            }
            const ab_edge *p = &outline->edge[e], *q = &outline->edge[f];
            bool wrong;
            if (f == e + 1 ||
                (e == 0 && f == n - 1)) { /* neighbours share a vertex; wrong only where the second runs back along the first */
                const ab_edge *first = f == e + 1 ? p : q, *second = f == e + 1 ? q : p;
                const double along = (first->to[0] - first->from[0]) * (second->to[0] - second->from[0]) +
                                     (first->to[1] - first->from[1]) * (second->to[1] - second->from[1]);
                const double across = cross(first->from, first->to, second->to);
                wrong = along < 0 && fabs(across) < 1e-12 * fabs(along);
            } else {
                wrong = meet(p, q, slack);
            }
            if (!wrong) continue;
            found++;
            size_t low = number[e], high = number[f];
            if (low > high) {
                const size_t swap = low;
                low = high;
                high = swap;
                const ab_edge *other = p;
                p = q;
                q = other;
            }
            ab_report_error(report, mark,
                            "body '%s': edge %zu of its polygon, (%g, %g) to (%g, %g), meets edge %zu, (%g, %g) to (%g, %g); edges may "
                            "only share their ends, one after the other",
                            body, low, p->from[0], p->from[1], p->to[0], p->to[1], high, q->from[0], q->from[1], q->to[0], q->to[1]);
        }
    free(spans);
    return found ? AB_BAD_INPUT : AB_OK;
}

ab_status ab_outline_create(const ab_shape_spec *shape, ab_outline *outline, const char *body, ab_report *report) {
    *outline = (ab_outline){0};
    const size_t n = shape->count;
    double(*const vertex)[2] = shape->vertices;
    if (n < 3) return ab_report_error(report, shape->mark, "body '%s': a polygon of %zu vertices; it needs at least 3", body, n);
    double size = 0;
    for (size_t k = 0; k < n; k++) {
        if (!isfinite(vertex[k][0]) || !isfinite(vertex[k][1]))
            return ab_report_error(report, shape->mark, "body '%s': vertex %zu of its polygon is (%g, %g)", body, k + 1, vertex[k][0],
                                   vertex[k][1]);
        size = fmax(size, fmax(fabs(vertex[k][0] - vertex[0][0]), fabs(vertex[k][1] - vertex[0][1])));
    }
    ab_status status = AB_OK;
    double area = 0;
    for (size_t k = 0; k < n; k++) {
        const size_t next = (k + 1) % n;
        if (fmax(fabs(vertex[k][0] - vertex[next][0]), fabs(vertex[k][1] - vertex[next][1])) <= 1e-13 * size)
            status =
                ab_report_error(report, shape->mark, "body '%s': vertices %zu and %zu of its polygon are both (%g, %g); leave one out%s",
                                body, k + 1, next + 1, vertex[k][0], vertex[k][1], next == 0 ? " (a polygon closes by itself)" : "");
        area += 0.5 * cross(vertex[0], vertex[k], vertex[next]);
    }
    AB_TRY(status);
    outline->edge = malloc(n * sizeof *outline->edge);
    size_t *number = malloc(n * sizeof *number);
    if (!outline->edge || !number) {
        free(number);
        ab_outline_clear(outline);
        return ab_report_failure(report, "body '%s': no memory for a polygon of %zu vertices", body, n);
    }
    outline->count = n;
    outline->area = fabs(area);
    for (size_t k = 0; k < n; k++) { /* the body on the left: a clockwise polygon is walked backwards */
        const size_t from = area >= 0 ? k : n - 1 - k, to = area >= 0 ? (k + 1) % n : (2 * n - 2 - k) % n;
        for (int c = 0; c < 2; c++) {
            outline->edge[k].from[c] = vertex[from][c];
            outline->edge[k].to[c] = vertex[to][c];
        }
        number[k] = 1 + (area >= 0 ? from : to); /* edge m goes from vertex m to the next, as written */
    }
    outline->convex = true;
    for (size_t k = 0; k < n; k++)
        if (cross(outline->edge[k].from, outline->edge[k].to, outline->edge[(k + 1) % n].to) < 0) outline->convex = false;
    status = check_crossings(outline, number, size, shape->mark, body, report);
    free(number);
    if (status == AB_OK && !(outline->area > 1e-13 * size * size))
        status = ab_report_error(report, shape->mark, "body '%s': its polygon has no area", body);
    if (status != AB_OK) ab_outline_clear(outline);
    return status;
}

/* The edge's direction as one within 45 degrees of the x axis that gives the same lattice. */
static double lattice_angle_sine(const ab_edge *edge, double length) {
    double x = (edge->to[0] - edge->from[0]) / length, y = (edge->to[1] - edge->from[1]) / length;
    if (fabs(y) > fabs(x)) {
        const double old = x;
        x = y;
        y = -old;
    }
    if (x < 0) {
        x = -x;
        y = -y;
    }
    return x + y < 1e-9 ? -y : y; /* -45 degrees is +45 */
}

ab_frame ab_outline_frame(const ab_outline *outline) {
    double longest = 0, low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t e = 0; e < outline->count; e++) {
        const ab_edge *g = &outline->edge[e];
        longest = fmax(longest, hypot(g->to[0] - g->from[0], g->to[1] - g->from[1]));
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], g->from[k]);
            high[k] = fmax(high[k], g->from[k]);
        }
    }
    double best = INFINITY;
    bool mirrored = false;
    for (size_t e = 0; e < outline->count; e++) {
        const ab_edge *g = &outline->edge[e];
        const double length = hypot(g->to[0] - g->from[0], g->to[1] - g->from[1]);
        if (length < longest * (1 - 1e-9)) continue;
        const double sine = lattice_angle_sine(g, length);
        if (fabs(sine) < fabs(best) - 1e-9) {
            best = sine;
            mirrored = false;
        } else if (fabs(fabs(sine) - fabs(best)) <= 1e-9 && fabs(sine - best) > 2e-9) {
            mirrored = true;
        }
    }
    if (mirrored) best = 0;
    return (ab_frame){{0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])}, sqrt((1 - best) * (1 + best)), best};
}
