/* boundary.c: the outer faces of a finite-element body that boundary plugins act on. An edge is the share of the surface that stands at a node: the integral of the
 * node's basis function along its faces, as vectors, so that a pressure on the edges is that of the faces to rounding, however they are bent, stretched and turned. Its
 * velocity is that of the node, which makes the damping of a dashpot a lumped one, as the masses are. */
#include <math.h>
#include <string.h>

#include "fem/domain.h"

/* Cosine: faces that turn by less than 30 degrees at a node share one edge there; at a corner each has its own. */
static const double TOGETHER = 0.866;

typedef struct share { /* of a face in an edge */
    uint32_t node[3];  /* of the face: first, last, middle */
    uint32_t edge, element;
    int at; /* which of them */
} share;

struct fem_edges {
    size_t boundary; /* of the scene */
    bool hold;
    size_t count, ld, share_count;
    share *shares;  /* in the order of faces */
    double *rows;   /* AB_EDGE_ROWS x ld */
    double *vector; /* area vectors, pairs */
    size_t *start;
    uint32_t *dof;
    double *weight;
    double *start_size; /* by share: m2 (m3 of rings), of its element when the body was drawn */
};

/* Integral of the basis function of node `at` of a face along it, times the outward normal, m (of rings over the face, m2). */
static void share_vector(const fem_body *body, const double *pairs, const share *s, double vector[2]) {
    vector[0] = vector[1] = 0.0;
    for (int q = 0; q < FEM_FACE_PLACES; ++q) {
        const fem_face_point p = fem_face_point_on(pairs, s->node, FEM_FACE_PLACE[q]);
        const double w =
            FEM_FACE_WEIGHT[q] * p.n[s->at] * (body->element->axisymmetric ? ab_circumference(p.place[0] + body->origin[0]) : 1.0);
        vector[0] += w * p.run[1]; /* the body is on the left of a face */
        vector[1] -= w * p.run[0];
    }
}

/* Area between the corners of an element, m2; of rings their volume, m3. */
static double size_of(const fem_body *body, const double *pairs, double from, uint32_t element) {
    const uint32_t *node = body->mesh->connectivity + (size_t)element * (size_t)body->element->nodes;
    const double *a = pairs + 2 * (size_t)node[0], *b = pairs + 2 * (size_t)node[1], *c = pairs + 2 * (size_t)node[2],
                 *d = pairs + 2 * (size_t)node[3];
    const double area = 0.5 * ((c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0]));
    return body->element->axisymmetric ? area * ab_circumference(0.25 * (a[0] + b[0] + c[0] + d[0]) + from) : area;
}

static bool same_way(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] >= TOGETHER * hypot(a[0], a[1]) * hypot(b[0], b[1]);
}

/* The edge of a share: one that its node has already and that faces the same way, or a new one. last: of each node, its edge + 1 that was made last. */
static uint32_t edge_of(struct fem_edges *e, uint32_t *last, uint32_t node, const double vector[2]) {
    if (last[node] > 0 && same_way(e->vector + 2 * ((size_t)last[node] - 1), vector)) return last[node] - 1;
    const uint32_t k = (uint32_t)e->count++;
    e->dof[k] = node;
    last[node] = k + 1;
    return k;
}

static ab_status take_arrays(fem_body *body, struct fem_edges *e, size_t faces, ab_report *report) {
    const size_t nodes = body->element->nodes == 8 ? 3 : 2, shares = nodes * faces;
    e->shares = fem_take(body, shares, sizeof *e->shares);
    e->rows = fem_take(body, AB_EDGE_ROWS * ((shares + 7) / 8 * 8), sizeof *e->rows);
    e->vector = fem_take(body, 2 * shares, sizeof *e->vector);
    e->start = fem_take(body, shares + 1, sizeof *e->start);
    e->dof = fem_take(body, shares, sizeof *e->dof);
    e->weight = fem_take(body, shares, sizeof *e->weight);
    e->start_size = fem_take(body, shares, sizeof *e->start_size);
    return e->shares && e->rows && e->vector && e->start && e->dof && e->weight && e->start_size
               ? AB_OK
               : ab_report_failure(report, "body '%s': no memory for %zu edges under boundaries", body->domain.spec->name, shares);
}

static ab_status create_one(fem_body *body, const fem_faces *faces, size_t boundary, uint32_t *last, ab_report *report) {
    const ab_boundary_spec *spec = body->scene->boundaries + boundary;
    size_t count = 0;
    for (size_t f = 0; f < faces->count; ++f) count += fem_where_face(&spec->where, body->mesh, faces, f);
    if (count == 0)
        return ab_report_error(report, spec->mark,
                               "boundaries[%zu] meets no outer face of '%s'; use side: left|right|top|bottom or a place on its outline",
                               boundary, body->domain.spec->name);
    struct fem_edges *e = body->edges + body->edges_count++;
    e->boundary = boundary;
    e->hold = spec->hold;
    AB_TRY(take_arrays(body, e, count, report));
    memset(last, 0, body->nodes * sizeof *last);
    for (size_t f = 0; f < faces->count; ++f) {
        if (!fem_where_face(&spec->where, body->mesh, faces, f)) continue;
        share s = {.element = faces->element[f]};
        memcpy(s.node, faces->vertex + 3 * f, sizeof s.node);
        for (s.at = 0; s.at < 3 && s.node[s.at] != FEM_NONE; ++s.at) {
            double vector[2];
            share_vector(body, body->x, &s, vector);
            s.edge = edge_of(e, last, s.node[s.at], vector);
            for (size_t c = 0; c < 2; ++c) e->vector[2 * (size_t)s.edge + c] += vector[c];
            e->start_size[e->share_count] = size_of(body, body->x, body->origin[0], s.element);
            e->shares[e->share_count++] = s;
        }
    }
    e->ld = (e->count + 7) / 8 * 8; /* as the rows of the host, which it hands to plugins beside its own */
    for (size_t k = 0; k < e->count; ++k) {
        e->weight[k] = 1.0;
        e->rows[3 * e->ld + k] = -1.0; /* of an edge that never has an area, on the axis */
    }
    return AB_OK;
}

ab_status fem_edges_create(fem_body *body, const fem_faces *faces, ab_report *report) {
    const ab_scene *scene = body->scene;
    size_t count = 0;
    for (size_t k = 0; k < scene->boundary_count; ++k) count += scene->boundaries[k].body == body->domain.index;
    if (count == 0) return AB_OK;
    body->edges = fem_take(body, count, sizeof *body->edges);
    uint32_t *last = fem_take(body, body->nodes, sizeof *last);
    if (!body->edges || !last) return ab_report_failure(report, "body '%s': no memory for its boundaries", body->domain.spec->name);
    for (size_t k = 0; k < scene->boundary_count; ++k)
        if (scene->boundaries[k].body == body->domain.index) AB_TRY(create_one(body, faces, k, last, report));
    return AB_OK;
}

ab_status fem_edges(ab_domain *domain, size_t boundary, const ab_step *step, ab_edge_list *list, ab_report *report) {
    (void)step, (void)report;
    const fem_body *body = (const fem_body *)domain;
    struct fem_edges *e = body->edges;
    while (e->boundary != boundary) ++e;
    const size_t ld = e->ld;
    double *x = e->rows, *normal = x + 2 * ld, *area = x + 4 * ld, *density = x + 5 * ld;
    memset(e->vector, 0, 2 * e->count * sizeof *e->vector);
    memset(area, 0, e->count * sizeof *area);
    memset(density, 0, e->count * sizeof *density);
    for (size_t k = 0; k < e->share_count; ++k) {
        const share *s = e->shares + k;
        double vector[2];
        share_vector(body, body->x, s, vector);
        const double share_area = hypot(vector[0], vector[1]);
        for (size_t c = 0; c < 2; ++c) e->vector[2 * (size_t)s->edge + c] += vector[c];
        area[s->edge] += share_area;
        density[s->edge] += share_area * body->elastic.density * e->start_size[k] / size_of(body, body->x, body->origin[0], s->element);
    }
    for (size_t k = 0; k < e->count; ++k) {
        const double *vector = e->vector + 2 * k, length = hypot(vector[0], vector[1]);
        for (size_t c = 0; c < 2; ++c) x[c * ld + k] = body->x[2 * (size_t)e->dof[k] + c];
        density[k] = area[k] > 0.0 ? density[k] / area[k] : body->elastic.density;
        x[6 * ld + k] = sqrt((body->elastic.lambda + 2.0 * body->elastic.mu) / density[k]);
        x[7 * ld + k] = sqrt(body->elastic.mu / density[k]);
        area[k] = length;
        if (length > 0.0)
            for (size_t c = 0; c < 2; ++c) normal[c * ld + k] = vector[c] / length;
        e->start[k + 1] = k + 1;
    }
    *list = ab_edge_list_of(e->rows, e->count, ld);
    list->start = e->start, list->dof = e->dof, list->weight = e->weight;
    list->own_force = e->hold ? body->force : NULL;
    return AB_OK;
}
