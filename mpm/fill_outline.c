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
static ab_status check_crossings(const ab_outline *outline, const size_t *number, const size_t *loop_of, double size, ab_mark mark,
                                 const char *body, ab_report *report) {
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
            const bool onwards = f == e + 1, round = loop_of[e] == e && (f + 1 == n || loop_of[f + 1] != e);
            if (loop_of[e] == loop_of[f] &&
                (onwards || round)) { /* neighbours share a vertex; wrong only where the second runs back along the first */
                const ab_edge *first = onwards ? p : q, *second = onwards ? q : p;
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

/* Vertices of a polygon or hole: finite, and no two of them in one place. *area: positive where they go round counter-clockwise. */
static ab_status check_vertices(const ab_shape_spec *shape, const char *what, double size, double *area, const char *body,
                                ab_report *report) {
    const size_t n = shape->count;
    double(*const vertex)[2] = shape->vertices;
    ab_status status = AB_OK;
    *area = 0;
    for (size_t k = 0; k < n; k++) {
        const size_t next = (k + 1) % n;
        if (fmax(fabs(vertex[k][0] - vertex[next][0]), fabs(vertex[k][1] - vertex[next][1])) <= 1e-13 * size)
            status = ab_report_error(report, shape->mark, "body '%s': vertices %zu and %zu of %s are both (%g, %g); leave one out%s", body,
                                     k + 1, next + 1, what, vertex[k][0], vertex[k][1], next == 0 ? " (a polygon closes by itself)" : "");
        *area += 0.5 * cross(vertex[0], vertex[k], vertex[next]);
    }
    return status;
}

/* Edges of a loop behind those that are there, the body on the left: the outer loop counter-clockwise, a hole clockwise. */
static void add_loop(ab_outline *outline, size_t *number, const ab_shape_spec *shape, bool forwards) {
    const size_t n = shape->count;
    for (size_t k = 0; k < n; k++) {
        const size_t from = forwards ? k : n - 1 - k, to = forwards ? (k + 1) % n : (2 * n - 2 - k) % n, e = outline->count + k;
        for (int c = 0; c < 2; c++) {
            outline->edge[e].from[c] = shape->vertices[from][c];
            outline->edge[e].to[c] = shape->vertices[to][c];
        }
        number[e] = 1 + outline->count + (forwards ? from : to); /* edge m goes from vertex m to the next, as written; holes count on */
    }
    outline->count += n;
}

/* Each hole inside of the polygon and not inside of another hole, as far as edges that do not cross can tell: by its first vertex. */
static ab_status check_holes(const ab_shape_spec *shape, const char *body, ab_report *report) {
    for (size_t h = 0; h < shape->hole_count; h++)
        for (size_t m = 0; m <= shape->hole_count; m++) {
            const ab_shape_spec *other = m == shape->hole_count ? shape : &shape->holes[m];
            const double *p = shape->holes[h].vertices[0];
            bool inside = false;
            for (size_t k = 0; k < other->count; k++) {
                const double *a = other->vertices[k], *b = other->vertices[(k + 1) % other->count];
                if ((a[1] <= p[1]) != (b[1] <= p[1]) && a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > p[0]) inside = !inside;
            }
            if (m == h || inside == (other == shape)) continue;
            return ab_report_error(report, shape->mark, "body '%s': hole %zu of its polygon lies %s; leave it out", body, h + 1,
                                   inside ? "inside of another hole" : "outside of the polygon");
        }
    return AB_OK;
}

ab_status ab_outline_create(const ab_shape_spec *shape, ab_outline *outline, const char *body, ab_report *report) {
    *outline = (ab_outline){0};
    double(*const first)[2] = shape->vertices;
    double size = 0, area = 0, outer = 0;
    size_t total = 0;
    for (size_t h = 0; h <= shape->hole_count; h++) {
        const ab_shape_spec *loop = h == 0 ? shape : &shape->holes[h - 1];
        char what[64] = "its polygon";
        if (h > 0) snprintf(what, sizeof what, "hole %zu of its polygon", h);
        if (loop->count < 3)
            return ab_report_error(report, shape->mark, "body '%s': %s of %zu vertices; it needs at least 3", body,
                                   h == 0 ? "a polygon" : what, loop->count);
        for (size_t k = 0; k < loop->count; k++) {
            const double *v = loop->vertices[k];
            if (!isfinite(v[0]) || !isfinite(v[1]))
                return ab_report_error(report, shape->mark, "body '%s': vertex %zu of %s is (%g, %g)", body, k + 1, what, v[0], v[1]);
            size = fmax(size, fmax(fabs(v[0] - first[0][0]), fabs(v[1] - first[0][1])));
        }
        total += loop->count;
    }
    outline->edge = malloc(total * sizeof *outline->edge);
    size_t *number = malloc(total * sizeof *number), *loop_of = malloc(total * sizeof *loop_of);
    ab_status status = AB_OK;
    if (!outline->edge || !number || !loop_of)
        status = ab_report_failure(report, "body '%s': no memory for a polygon of %zu vertices", body, total);
    for (size_t h = 0; h <= shape->hole_count && status == AB_OK; h++) {
        const ab_shape_spec *loop = h == 0 ? shape : &shape->holes[h - 1];
        char what[64] = "its polygon";
        if (h > 0) snprintf(what, sizeof what, "hole %zu of its polygon", h);
        double signed_area;
        status = check_vertices(loop, what, size, &signed_area, body, report);
        for (size_t k = 0; k < loop->count; k++) loop_of[outline->count + k] = outline->count; /* its first edge */
        add_loop(outline, number, loop, (signed_area >= 0) == (h == 0));
        if (h == 0) outer = fabs(signed_area);
        area += h == 0 ? fabs(signed_area) : -fabs(signed_area);
    }
    outline->area = area;
    outline->convex = shape->hole_count == 0;
    for (size_t k = 0; k < outline->count && status == AB_OK && outline->convex; k++)
        if (cross(outline->edge[k].from, outline->edge[k].to, outline->edge[(k + 1) % total].to) < 0) outline->convex = false;
    if (status == AB_OK) status = check_crossings(outline, number, loop_of, size, shape->mark, body, report);
    if (status == AB_OK) status = check_holes(shape, body, report);
    free(number);
    free(loop_of);
    if (status == AB_OK && !(outer > 1e-13 * size * size && area > 0))
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
