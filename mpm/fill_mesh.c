/* fill_mesh.c: Gauss points in the elements of a mesh of quadrilaterals, n x n in each, with volumes w det J (exact for straight sides; each element's are made to add up
 * to its area for curved ones with a single point). A point's domain is the image of its share of the element: A = J diag(h^2) J^T, h the half sizes of the share in
 * the element's own coordinates. Outer sides are cut into the shares of the points beside them; a curved one becomes as many straight pieces. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/mesh.h"
#include "mpm/fill_outline.h"

static const double corner_of[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

/* Place and Jacobian (d x_c / d xi_d) in an element, by the shape functions of 4 or 8 nodes (Zienkiewicz and Taylor, The Finite Element Method, vol. 1). */
static void map_element(const ab_mesh *mesh, size_t element, const double xi[2], double x[2], double j[2][2]) {
    const uint32_t *node = mesh->connectivity + element * (size_t)mesh->nodes;
    memset(x, 0, 2 * sizeof *x);
    memset(j, 0, sizeof(double[2][2]));
    for (int a = 0; a < mesh->nodes; a++) {
        double n, d[2];
        if (a < 4) {
            const double *c = corner_of[a], p = 1 + c[0] * xi[0], q = 1 + c[1] * xi[1], r = c[0] * xi[0] + c[1] * xi[1] - 1;
            const bool linear = mesh->nodes == 4;
            n = 0.25 * p * q * (linear ? 1 : r);
            d[0] = 0.25 * c[0] * q * (linear ? 1 : r + p);
            d[1] = 0.25 * c[1] * p * (linear ? 1 : r + q);
        } else { /* in the middle of a side across direction k */
            const int k = a % 2 == 0 ? 1 : 0;
            const double c = a == 4 || a == 7 ? -1 : 1, bubble = 1 - xi[!k] * xi[!k], q = 1 + c * xi[k];
            n = 0.5 * bubble * q;
            d[!k] = -xi[!k] * q;
            d[k] = 0.5 * bubble * c;
        }
        for (int c = 0; c < 2; c++) {
            const double at = mesh->x[2 * (size_t)node[a] + (size_t)c];
            x[c] += n * at;
            for (int k = 0; k < 2; k++) j[c][k] += d[k] * at;
        }
    }
}

static double area_of(const ab_mesh *mesh, size_t element) {
    const double place[3] = {-0.77459666924148337704, 0, 0.77459666924148337704}, weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
    double sum = 0;
    for (int k = 0; k < 9; k++) { /* det J is of third degree in each direction at most */
        double x[2], j[2][2];
        map_element(mesh, element, (const double[2]){place[k % 3], place[k / 3]}, x, j);
        sum += weight[k % 3] * weight[k / 3] * (j[0][0] * j[1][1] - j[0][1] * j[1][0]);
    }
    return sum;
}

/* ---- points ----------------------------------------------------------------------------------------------------------------- */

static void add_element(ab_filler *filler, const ab_mesh *mesh, size_t element, const ab_gauss *rule) {
    ab_fill *fill = filler->fill;
    const size_t first = fill->count;
    double sum = 0;
    for (int r = 0; r < rule->count; r++)
        for (int q = 0; q < rule->count; q++) {
            double x[2], j[2][2];
            map_element(mesh, element, (const double[2]){2 * rule->place[q] - 1, 2 * rule->place[r] - 1}, x, j);
            const double volume = 4 * rule->weight[q] * rule->weight[r] * (j[0][0] * j[1][1] - j[0][1] * j[1][0]);
            const double hh[2] = {4 * rule->half[q] * rule->half[q], 4 * rule->half[r] * rule->half[r]};
            ab_filler_point(filler, x[0], x[1], volume, hh[0] * j[0][0] * j[0][0] + hh[1] * j[0][1] * j[0][1],
                            hh[0] * j[1][0] * j[1][0] + hh[1] * j[1][1] * j[1][1], hh[0] * j[0][0] * j[1][0] + hh[1] * j[0][1] * j[1][1]);
            sum += volume;
        }
    const double exact = area_of(mesh, element);
    for (size_t p = first; p < fill->count; p++) fill->volume[p] *= exact / sum;
}

/* ---- outer sides -------------------------------------------------------------------------------------------------------------- */

typedef struct side {
    uint32_t low, high; /* its corners */
    uint64_t number;    /* 4 element + side */
} side;

static int by_corners(const void *a, const void *b) {
    const side *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return (p->number > q->number) - (p->number < q->number);
}

/* The pieces of a side, from its first corner to its last; the body is on the left. */
static void add_side(ab_filler *filler, const ab_mesh *mesh, size_t element, int number, const ab_gauss *rule, size_t first_point) {
    const int n = rule->count;
    const double *a = corner_of[number], *b = corner_of[(number + 1) % 4];
    double from[2], j[2][2];
    map_element(mesh, element, a, from, j);
    for (int k = 0; k < n; k++) {
        const double share = rule->share[k + 1], xi[2] = {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
        double to[2];
        map_element(mesh, element, xi, to, j);
        const int column = number == 0 ? k : number == 1 ? n - 1 : number == 2 ? n - 1 - k : 0;
        const int row = number == 0 ? 0 : number == 1 ? k : number == 2 ? n - 1 : n - 1 - k;
        const double dx = to[0] - from[0], dy = to[1] - from[1], length = hypot(dx, dy);
        ab_filler_piece(filler, (uint32_t)(first_point + (size_t)(row * n + column)), 0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]),
                        dy / length, -dx / length, length);
        memcpy(from, to, sizeof from);
    }
}

static ab_status add_outline(ab_filler *filler, ab_mark mark, const ab_mesh *mesh, const ab_gauss *rule) {
    const size_t count = 4 * mesh->element_count;
    side *sides = malloc((count + 1) * sizeof *sides);
    if (!sides)
        return ab_report_failure(filler->report, "body '%s': no memory for the sides of %zu elements", filler->body, mesh->element_count);
    for (size_t k = 0; k < count; k++) {
        const uint32_t *node = mesh->connectivity + k / 4 * (size_t)mesh->nodes, p = node[k % 4], q = node[(k + 1) % 4];
        sides[k] = (side){p < q ? p : q, p < q ? q : p, k};
    }
    qsort(sides, count, sizeof *sides, by_corners);
    ab_status status = AB_OK;
    for (size_t k = 0; k < count && status == AB_OK; k++) {
        const bool shared = (k > 0 && sides[k - 1].low == sides[k].low && sides[k - 1].high == sides[k].high) ||
                            (k + 1 < count && sides[k + 1].low == sides[k].low && sides[k + 1].high == sides[k].high);
        if (shared) continue;
        const size_t element = (size_t)(sides[k].number / 4);
        status = ab_filler_reserve(filler, mark, 0, rule->count);
        if (status == AB_OK)
            add_side(filler, mesh, element, (int)(sides[k].number % 4), rule, element * (size_t)(rule->count * rule->count));
    }
    free(sides);
    return status;
}

/* ---- the whole ---------------------------------------------------------------------------------------------------------------- */

ab_status ab_fill_mesh(ab_filler *filler, ab_mark mark, const ab_mesh *mesh) {
    const int n = (int)(sqrt(filler->per_cell) + 0.5);
    if (filler->rule != AB_FILL_GAUSS)
        return ab_report_error(filler->report, mark,
                               "body '%s': a mesh is filled by the Gauss points of its elements; write fill: {rule: gauss}", filler->body);
    if (n * n != filler->per_cell || n > AB_GAUSS_MOST)
        return ab_report_error(filler->report, mark,
                               "body '%s': %d Gauss points in each element of its mesh; write 1, 4, 9, 16 or another square up to %d",
                               filler->body, filler->per_cell, AB_GAUSS_MOST * AB_GAUSS_MOST);
    ab_gauss rule;
    ab_gauss_rule(n, &rule);
    AB_TRY(ab_filler_reserve(filler, mark, (double)mesh->element_count * n * n, 0));
    for (int end = 0; end < 2; end++) {
        const double *at = end ? mesh->high : mesh->low;
        ab_filler_bound(filler, at[0], at[1]);
    }
    double widest = 0;
    for (size_t e = 0; e < mesh->element_count; e++) {
        const size_t first = filler->fill->count;
        add_element(filler, mesh, e, &rule);
        for (size_t p = first; p < filler->fill->count; p++)
            widest = fmax(widest, fmax(filler->fill->extent[3 * p], filler->fill->extent[3 * p + 1]));
    }
    if (2 * sqrt(widest) > 1.5 * filler->cell)
        ab_report_warning(filler->report, mark,
                          "body '%s': a Gauss point of its mesh stands for %.3g m of body, more than a cell of %g m: cells between points "
                          "may be empty; use "
                          "more per_cell (points in each element), smaller elements or a larger cell",
                          filler->body, 2 * sqrt(widest), filler->cell);
    AB_TRY(add_outline(filler, mark, mesh, &rule));
    return ab_fill_fit_extents(filler, 0);
}
