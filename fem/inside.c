/* inside.c: points inside the elements, through which the grid sees a body: the reference square of each element is cut into so many equal pieces that their middles
 * are nowhere further apart than half a cell at the start. A point carries the mass of its piece and moves with the nodes of its element. */
#include <math.h>
#include <string.h>

#include "fem/domain.h"

/* Pieces of an element along xi and eta: by the longer of its two sides in that direction. */
static void pieces_of(const fem_body *body, size_t element, size_t pieces[2]) {
    static const int SIDE[2][2][2] = {{{0, 1}, {3, 2}}, {{1, 2}, {0, 3}}};
    const uint32_t *node = body->mesh->connectivity + element * (size_t)body->element->nodes;
    for (int c = 0; c < 2; ++c) {
        double longest = 0.0;
        for (int s = 0; s < 2; ++s) {
            const uint32_t from = node[SIDE[c][s][0]], to = node[SIDE[c][s][1]];
            double length =
                hypot(body->x[2 * (size_t)to] - body->x[2 * (size_t)from], body->x[2 * (size_t)to + 1] - body->x[2 * (size_t)from + 1]);
            if (body->element->nodes == 8) { /* by way of its middle */
                static const int MIDDLE[2][2] = {{4, 6}, {5, 7}};
                const uint32_t m = node[MIDDLE[c][s]];
                length =
                    hypot(body->x[2 * (size_t)m] - body->x[2 * (size_t)from], body->x[2 * (size_t)m + 1] - body->x[2 * (size_t)from + 1]) +
                    hypot(body->x[2 * (size_t)to] - body->x[2 * (size_t)m], body->x[2 * (size_t)to + 1] - body->x[2 * (size_t)m + 1]);
            }
            longest = fmax(longest, length);
        }
        pieces[c] = (size_t)fmax(1.0, ceil(longest / (0.5 * body->scene->grid_cell) - 1e-9));
    }
}

/* Place, half edges and det J of a point's piece as it is now. */
static double place_point(const fem_body *body, size_t element, const double xi[2], double place[2], double edge[2][2]) {
    const int nodes = body->element->nodes;
    const uint32_t *node = body->mesh->connectivity + element * (size_t)nodes;
    double n[FEM_NODES], dn[FEM_NODES][2];
    fem_shape(nodes, xi[0], xi[1], n);
    fem_shape_derivatives(nodes, xi[0], xi[1], dn);
    memset(place, 0, 2 * sizeof *place);
    memset(edge, 0, 4 * sizeof(double));
    for (int a = 0; a < nodes; ++a)
        for (size_t c = 0; c < 2; ++c) {
            const double x = body->x[2 * (size_t)node[a] + c];
            place[c] += n[a] * x;
            edge[0][c] += dn[a][0] * x;
            edge[1][c] += dn[a][1] * x;
        }
    return edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0];
}

static void follow(fem_body *body) {
    fem_inner *in = &body->inner;
#pragma omp parallel for schedule(static) num_threads(body->threads)
    for (size_t q = 0; q < in->count; ++q) {
        double place[2], edge[2][2];
        const double *half = body->inner_half + 2 * q;
        const double det = place_point(body, body->inner_element[q], body->inner_place + 2 * q, place, edge);
        for (int c = 0; c < 2; ++c)
            for (int d = 0; d < 2; ++d) edge[d][c] *= half[d];
        in->position[q] = place[0];
        in->position[in->ld + q] = place[1];
        in->volume[q] = 4.0 * half[0] * half[1] * det;
        in->extent[q] = edge[0][0] * edge[0][0] + edge[1][0] * edge[1][0];
        in->extent[in->ld + q] = edge[0][1] * edge[0][1] + edge[1][1] * edge[1][1];
        in->extent[2 * in->ld + q] = edge[0][0] * edge[0][1] + edge[1][0] * edge[1][1];
    }
}

/* Points of one element; its mass is spread by their volumes, so that the grid sees all of it. */
static void fill(fem_body *body, size_t element, const size_t pieces[2], size_t first) {
    fem_inner *in = &body->inner;
    const int nodes = body->element->nodes;
    const double half[2] = {1.0 / (double)pieces[0], 1.0 / (double)pieces[1]};
    double volume = 0.0, mass = 0.0;
    size_t q = first;
    for (size_t j = 0; j < pieces[1]; ++j)
        for (size_t i = 0; i < pieces[0]; ++i, ++q) {
            const double xi[2] = {((double)(2 * i + 1)) * half[0] - 1.0, ((double)(2 * j + 1)) * half[1] - 1.0};
            double place[2], edge[2][2];
            body->inner_element[q] = (uint32_t)element;
            memcpy(body->inner_place + 2 * q, xi, sizeof xi);
            memcpy(body->inner_half + 2 * q, half, sizeof half);
            in->mass[q] = place_point(body, element, xi, place, edge);
            volume += in->mass[q];
            in->start[q + 1] = (q + 1) * (size_t)nodes;
            fem_shape(nodes, xi[0], xi[1], in->weight + q * (size_t)nodes);
            memcpy(in->dof + q * (size_t)nodes, body->mesh->connectivity + element * (size_t)nodes, (size_t)nodes * sizeof *in->dof);
        }
    for (int g = 0; g < body->element->gauss; ++g) mass += fem_gauss_rows(body, element / 8, g)[8 * FEM_ROW_MASS + element % 8];
    for (q = first; q < first + pieces[0] * pieces[1]; ++q) in->mass[q] *= mass / volume;
}

ab_status fem_inner_create(fem_body *body, ab_report *report) {
    fem_inner *in = &body->inner;
    size_t count = 0, pieces[2];
    for (size_t e = 0; e < body->elements; ++e) {
        pieces_of(body, e, pieces);
        count += pieces[0] * pieces[1];
    }
    const size_t nodes = (size_t)body->element->nodes;
    in->count = count;
    in->ld = (count + 7) / 8 * 8;
    in->position = fem_take(body, 2 * in->ld, sizeof(double));
    in->mass = fem_take(body, in->ld, sizeof(double));
    in->volume = fem_take(body, in->ld, sizeof(double));
    in->extent = fem_take(body, 3 * in->ld, sizeof(double));
    in->start = fem_take(body, count + 1, sizeof *in->start);
    in->dof = fem_take(body, count * nodes, sizeof *in->dof);
    in->weight = fem_take(body, count * nodes, sizeof(double));
    body->inner_element = fem_take(body, count, sizeof *body->inner_element);
    body->inner_place = fem_take(body, 2 * count, sizeof(double));
    body->inner_half = fem_take(body, 2 * count, sizeof(double));
    if (!in->position || !in->mass || !in->volume || !in->extent || !in->start || !in->dof || !in->weight || !body->inner_element ||
        !body->inner_place || !body->inner_half)
        return ab_report_failure(report, "body '%s': no memory for %zu points inside its elements; use larger cells or fewer elements",
                                 body->domain.spec->name, count);
    size_t first = 0;
    for (size_t e = 0; e < body->elements; ++e) {
        pieces_of(body, e, pieces);
        fill(body, e, pieces, first);
        first += pieces[0] * pieces[1];
    }
    AB_TRY(fem_trace_create(body->scene, body->domain.spec->name, body->elastic.lambda + 2.0 * body->elastic.mu, &body->trace, report));
    return fem_inner_follow(body, report);
}

void fem_inner_destroy(fem_body *body) {
    if (body->trace) fem_trace_destroy(body->trace);
    body->trace = NULL;
}

ab_status fem_inner_follow(fem_body *body, ab_report *report) {
    follow(body);
    return fem_trace_update(body->trace, &body->inner, report);
}
