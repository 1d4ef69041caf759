/* inside.c: points inside the elements, through which the grid sees a body: the reference square of each element is cut into so many equal pieces that their middles
 * are nowhere further apart than half a cell at the start. A point carries the mass of its piece and moves with the nodes of its element.
 *
 * Only a layer of elements along the outer faces has points (inside_layer.c); in the first step all have, so that bodies drawn one inside the other are seen. */
#include <math.h>
#include <string.h>

#include "core/checkpoint.h"
#include "core/memory.h"
#include "fem/inside.h"

/* Elements that are cut alike share the values of their basis. Rows go over an element's points, four at a time; the last four are filled up with zeros. */
typedef struct cutting {
    size_t pieces[2], count, ld;
    double *value;    /* nodes rows */
    double *along[2]; /* nodes rows each: derivatives times the half size of a piece */
} cutting;

struct fem_inside {
    size_t bytes; /* of the block of memory that this is the head of */
    size_t elements, cuttings;
    uint32_t *element;
    uint32_t *first; /* elements + 1: its points */
    uint32_t *cut;   /* of each element */
    cutting *cutting;
    bool some;    /* not all elements have points */
    bool settled; /* the layer has been chosen, or all elements keep their points */
    double depth; /* cells */
};

enum { FULL = 70 }; /* per cent of the elements; from there on a layer saves nothing */
static const double DEPTH = 3.0;

/* Pieces of an element along xi and eta: by the longer of its two sides in that direction, as drawn. */
static void pieces_of(const fem_body *body, size_t element, size_t pieces[2]) {
    static const int SIDE[2][2][2] = {{{0, 1}, {3, 2}}, {{1, 2}, {0, 3}}}, MIDDLE[2][2] = {{4, 6}, {5, 7}};
    const uint32_t *node = body->mesh->connectivity + element * (size_t)body->element->nodes;
    const double *x = body->mesh->x;
    for (int c = 0; c < 2; ++c) {
        double longest = 0.0;
        for (int s = 0; s < 2; ++s) {
            const double *from = x + 2 * (size_t)node[SIDE[c][s][0]], *to = x + 2 * (size_t)node[SIDE[c][s][1]];
            double length = hypot(to[0] - from[0], to[1] - from[1]);
            if (body->element->nodes == 8) { /* by way of its middle */
                const double *m = x + 2 * (size_t)node[MIDDLE[c][s]];
                length = hypot(m[0] - from[0], m[1] - from[1]) + hypot(to[0] - m[0], to[1] - m[1]);
            }
            longest = fmax(longest, length);
        }
        pieces[c] = (size_t)fmax(1.0, ceil(longest / (0.5 * body->scene->grid_cell) - 1e-9));
    }
}

/* ---- where points are ------------------------------------------------------------------------------------------------------- */

static inline __attribute__((always_inline)) void follow_element(const fem_body *body, size_t k, int nodes) {
    const struct fem_inside *in = body->inside;
    const fem_inner *inner = &body->inner;
    const uint32_t *node = body->mesh->connectivity + (size_t)in->element[k] * (size_t)nodes;
    const cutting *cut = in->cutting + in->cut[k];
    double x[2 * FEM_NODES];
    for (int a = 0; a < nodes; ++a) memcpy(x + 2 * a, body->x + 2 * (size_t)node[a], 2 * sizeof *x);
    for (size_t j = 0; j < cut->count; j += 4) {
        v4 place[2] = {{0}}, xi[2] = {{0}}, eta[2] = {{0}};
        for (int a = 0; a < nodes; ++a) {
            const size_t at = (size_t)a * cut->ld + j;
            const v4 n = v4_load(cut->value + at), n0 = v4_load(cut->along[0] + at), n1 = v4_load(cut->along[1] + at);
            for (int c = 0; c < 2; ++c) {
                const v4 here = v4_set(x[2 * a + c]);
                place[c] += n * here;
                xi[c] += n0 * here;
                eta[c] += n1 * here;
            }
        }
        const v4 row[6] = {place[0],
                           place[1],
                           v4_set(4.0) * (xi[0] * eta[1] - xi[1] * eta[0]),
                           xi[0] * xi[0] + eta[0] * eta[0],
                           xi[1] * xi[1] + eta[1] * eta[1],
                           xi[0] * xi[1] + eta[0] * eta[1]};
        const size_t q = in->first[k] + j, ld = inner->ld;
        double *const to[6] = {inner->position + q, inner->position + ld + q, inner->volume + q,
                               inner->extent + q,   inner->extent + ld + q,   inner->extent + 2 * ld + q};
        const size_t left = cut->count - j;
        for (int r = 0; r < 6; ++r) {
            if (left >= 4)
                v4_store(to[r], row[r]);
            else
                for (size_t l = 0; l < left; ++l) to[r][l] = row[r][l];
        }
    }
}

static void follow(const fem_body *body) {
    const size_t elements = body->inside->elements;
#pragma omp parallel for schedule(static) num_threads(body->threads) if (elements > 2000)
    for (size_t k = 0; k < elements; ++k) {
        if (body->element->nodes == 4)
            follow_element(body, k, 4);
        else
            follow_element(body, k, 8);
    }
}

/* ---- making ----------------------------------------------------------------------------------------------------------------- */

/* Arrays one behind the other, each at a cache line. Without a start they only add up. */
typedef struct carver {
    char *start;
    size_t used;
} carver;

static void *carve(carver *c, size_t count, size_t size) {
    char *at = c->start ? c->start + c->used : NULL;
    c->used += (count * size + 63) / 64 * 64;
    return at;
}

static void carve_cutting(carver *c, cutting *cut, size_t nodes) {
    cut->value = carve(c, nodes * cut->ld, sizeof(double));
    for (int d = 0; d < 2; ++d) cut->along[d] = carve(c, nodes * cut->ld, sizeof(double));
}

static void carve_points(carver *c, struct fem_inside *in, fem_inner *inner, size_t nodes) {
    in->element = carve(c, in->elements, sizeof *in->element);
    in->first = carve(c, in->elements + 1, sizeof *in->first);
    in->cut = carve(c, in->elements, sizeof *in->cut);
    inner->position = carve(c, 2 * inner->ld, sizeof(double));
    inner->mass = carve(c, inner->ld, sizeof(double));
    inner->volume = carve(c, inner->ld, sizeof(double));
    inner->extent = carve(c, 3 * inner->ld, sizeof(double));
    inner->start = carve(c, inner->count + 1, sizeof *inner->start);
    inner->dof = carve(c, inner->count * nodes, sizeof *inner->dof);
    inner->weight = carve(c, inner->count * nodes, sizeof(double));
    inner->inmost = in->some ? carve(c, inner->count, 1) : NULL;
}

/* The number of the elements' cutting in the list; one more where it is new. */
static size_t find_cutting(const cutting *list, size_t count, const size_t pieces[2]) {
    size_t k = count; /* neighbours are cut alike: from the last one back */
    while (k > 0 && (list[k - 1].pieces[0] != pieces[0] || list[k - 1].pieces[1] != pieces[1])) --k;
    return k > 0 ? k - 1 : count;
}

static void fill_cutting(cutting *cut, int nodes) {
    const double half[2] = {1.0 / (double)cut->pieces[0], 1.0 / (double)cut->pieces[1]};
    for (size_t q = 0; q < cut->count; ++q) {
        const double xi = (double)(2 * (q % cut->pieces[0]) + 1) * half[0] - 1.0,
                     eta = (double)(2 * (q / cut->pieces[0]) + 1) * half[1] - 1.0;
        double n[FEM_NODES], dn[FEM_NODES][2];
        fem_shape(nodes, xi, eta, n);
        fem_shape_derivatives(nodes, xi, eta, dn);
        for (int a = 0; a < nodes; ++a) {
            const size_t at = (size_t)a * cut->ld + q;
            cut->value[at] = n[a];
            cut->along[0][at] = dn[a][0] * half[0];
            cut->along[1][at] = dn[a][1] * half[1];
        }
    }
}

/* Points of one element; its mass is spread by their volumes as drawn, so that the grid sees all of it. */
static void fill_element(fem_body *body, size_t k, bool inmost) {
    const struct fem_inside *in = body->inside;
    fem_inner *inner = &body->inner;
    const size_t nodes = (size_t)body->element->nodes, e = in->element[k], first = in->first[k], last = in->first[k + 1];
    const cutting *cut = in->cutting + in->cut[k];
    const uint32_t *node = body->mesh->connectivity + e * nodes;
    double volume = 0.0, mass = 0.0;
    for (size_t q = first; q < last; ++q) {
        double edge[2][2] = {{0.0}}, radius = 0.0;
        for (size_t a = 0; a < nodes; ++a) {
            const size_t at = a * cut->ld + q - first;
            for (size_t d = 0; d < 2; ++d)
                for (size_t c = 0; c < 2; ++c) edge[d][c] += cut->along[d][at] * body->mesh->x[2 * (size_t)node[a] + c];
            inner->weight[q * nodes + a] = cut->value[at];
            radius += cut->value[at] * body->mesh->x[2 * (size_t)node[a]];
            inner->dof[q * nodes + a] = node[a];
        }
        inner->start[q + 1] = (q + 1) * nodes;
        inner->mass[q] = edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0];
        if (body->element->axisymmetric) inner->mass[q] *= radius;
        volume += inner->mass[q];
        if (inner->inmost) inner->inmost[q] = inmost;
    }
    for (int g = 0; g < body->element->gauss; ++g) mass += fem_gauss_rows(body, e / 8, g)[8 * FEM_ROW_MASS + e % 8];
    for (size_t q = first; q < last; ++q) inner->mass[q] *= mass / volume;
}

/* Points in the elements whose mark is FEM_RIM or FEM_LAYER, with `all` in all of them, in place of those there were. marks NULL: all, and none is inmost. */
static ab_status make_points(fem_body *body, const uint8_t *marks, bool all, double depth, ab_report *report) {
    const size_t nodes = (size_t)body->element->nodes;
    struct fem_inside size = {.some = marks != NULL, .depth = depth, .settled = !all};
    fem_inner inner = {0};
    cutting *list = NULL;
    size_t capacity = 0;
    bool enough = true;
    for (size_t e = 0; enough && e < body->elements; ++e) {
        if (!all && marks && marks[e] == FEM_DEEP) continue;
        size_t pieces[2];
        pieces_of(body, e, pieces);
        ++size.elements;
        inner.count += pieces[0] * pieces[1];
        if (find_cutting(list, size.cuttings, pieces) < size.cuttings) continue;
        enough = ab_memory_grow((void **)&list, &capacity, size.cuttings + 1, sizeof *list);
        if (!enough) break;
        const size_t count = pieces[0] * pieces[1];
        list[size.cuttings++] = (cutting){.pieces = {pieces[0], pieces[1]}, .count = count, .ld = (count + 3) / 4 * 4};
    }
    inner.ld = (inner.count + 7) / 8 * 8;
    enough = enough && inner.count < UINT32_MAX;
    struct fem_inside *in = NULL;
    for (int round = 0; enough && round < 2; ++round) { /* how much; then where */
        carver c = {.start = (char *)in};
        carve(&c, 1, sizeof *in);
        struct fem_inside *head = in ? in : &size;
        head->cutting = carve(&c, size.cuttings, sizeof *list);
        carve_points(&c, head, &inner, nodes);
        for (size_t k = 0; k < size.cuttings; ++k) carve_cutting(&c, list + k, nodes);
        if (in) break;
        in = ab_memory_take(c.used);
        enough = in != NULL;
        if (in) *in = size, in->bytes = c.used;
    }
    if (enough) {
        for (size_t k = 0; k < size.cuttings; ++k) fill_cutting(list + k, (int)nodes);
        memcpy(in->cutting, list, size.cuttings * sizeof *list);
        if (body->inside) {
            body->bytes -= body->inside->bytes;
            ab_memory_give(body->inside, body->inside->bytes);
        }
        body->inside = in;
        body->inner = inner;
        body->bytes += in->bytes;
        size_t k = 0;
        for (size_t e = 0; e < body->elements; ++e) {
            if (!all && marks && marks[e] == FEM_DEEP) continue;
            size_t pieces[2];
            pieces_of(body, e, pieces);
            in->element[k] = (uint32_t)e;
            in->cut[k] = (uint32_t)find_cutting(in->cutting, in->cuttings, pieces);
            in->first[k + 1] = in->first[k] + (uint32_t)(pieces[0] * pieces[1]);
            fill_element(body, k++, marks && marks[e] != FEM_LAYER);
        }
    }
    ab_memory_give(list, capacity * sizeof *list);
    if (enough) return AB_OK;
    return ab_report_failure(report, "body '%s': no memory for %zu points inside its elements; use larger cells or fewer elements",
                             body->domain.spec->name, inner.count);
}

/* Points for a layer so many cells deep, or in all elements where that is most of them. keep: all have points still, those beyond the layer being inmost. */
static ab_status make_layer(fem_body *body, double depth, bool keep, ab_report *report) {
    uint8_t *marks = ab_memory_take(body->elements);
    size_t beyond = 0;
    if (!marks || !fem_layer_mark(body, depth, marks)) {
        ab_memory_give(marks, body->elements);
        return ab_report_failure(report, "body '%s': no memory to find the elements along its outer faces", body->domain.spec->name);
    }
    for (size_t e = 0; e < body->elements; ++e) beyond += marks[e] == FEM_DEEP;
    const bool layer = 100 * beyond > (100 - FULL) * body->elements;
    const ab_status status = make_points(body, layer ? marks : NULL, keep && layer, depth, report);
    ab_memory_give(marks, body->elements);
    return status;
}

ab_status fem_inner_create(fem_body *body, ab_report *report) {
    AB_TRY(fem_trace_create(body->scene, body->domain.spec->name, body->elastic.lambda + 2.0 * body->elastic.mu, &body->trace, report));
    AB_TRY(
        make_layer(body, DEPTH + 2.0 * (fem_trace_reach(body->trace) - 1.0), true, report)); /* points and nodes reach further on splines */
    return fem_inner_follow(body, 0, report);
}

void fem_inner_destroy(fem_body *body) {
    if (body->trace) fem_trace_destroy(body->trace);
    if (body->inside) ab_memory_give(body->inside, body->inside->bytes);
    body->trace = NULL;
    body->inside = NULL;
}

/* After the first step the points beyond the layer go, unless a node in contact has seen one: then the bodies lie in each other, and all stay. A layer whose inmost
 * elements have come near a node in contact (deep dents, elements that are squeezed) is made anew where the body is now, twice as deep. */
static ab_status fit_layer(fem_body *body, ab_report *report) {
    const struct fem_inside *in = body->inside;
    const bool near = fem_trace_saw_inmost(body->trace);
    if (!in->settled) return near ? make_points(body, NULL, false, in->depth, report) : make_layer(body, in->depth, false, report);
    return near ? make_layer(body, 2.0 * in->depth, false, report) : AB_OK;
}

ab_status fem_inner_follow(fem_body *body, long step, ab_report *report) {
    if (step > 0 && body->inside->some) AB_TRY(fit_layer(body, report));
    follow(body);
    return fem_trace_update(body->trace, &body->inner, report);
}

/* Which elements have points, and which of them are the inmost: made where the body was then, so it cannot be found again. The points themselves follow from that. */
void fem_inner_keep(fem_body *body, ab_checkpoint *c) {
    const bool loads = ab_checkpoint_loads(c);
    const struct fem_inside *in = body->inside;
    bool some = in->some, settled = in->settled, saw = fem_trace_saw_inmost(body->trace);
    double depth = in->depth;
    uint8_t *marks = ab_memory_take(body->elements);
    if (!marks) {
        ab_checkpoint_refuse(c, "no memory for the elements of body '%s'", body->domain.spec->name);
        return;
    }
    if (!in->some) memset(marks, FEM_LAYER, body->elements);
    for (size_t k = 0; in->some && k < in->elements; ++k) marks[in->element[k]] = body->inner.inmost[in->first[k]] ? FEM_RIM : FEM_LAYER;
    bool good = ab_keep_flags(c, "layer", &some, 1) && ab_keep_flags(c, "layer_settled", &settled, 1) &&
                ab_keep_flags(c, "layer_seen", &saw, 1) && ab_keep_doubles(c, "layer_depth", &depth, 1) &&
                ab_keep_bytes(c, "layer_marks", marks, body->elements);
    for (size_t e = 0; good && loads && e < body->elements; ++e) good = marks[e] <= FEM_LAYER && (some || marks[e] == FEM_LAYER);
    if (good && loads) good = make_points(body, some ? marks : NULL, false, depth, ab_checkpoint_report(c)) == AB_OK;
    if (good && loads) {
        body->inside->settled = settled;
        fem_trace_note_inmost(body->trace, saw);
    }
    if (!good) ab_checkpoint_refuse(c, "the points inside the elements of body '%s' cannot be brought back", body->domain.spec->name);
    ab_memory_give(marks, body->elements);
}
