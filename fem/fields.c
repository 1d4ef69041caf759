/* fields.c: what a finite-element body can show, at its nodes in the order of the mesh.
 *
 * Stress is extrapolated in each element from its Gauss points, by the bilinear function that fits them best (constant where there is one point), and averaged over
 * the elements of a node by their volumes. Deformation gradient and states of the material are averaged without extrapolation, so that they stay in the bounds
 * that the material keeps them in. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/body_fields.h"
#include "fem/domain.h"

ab_status fem_fields_create(fem_body *body, ab_report *report) {
    return ab_body_fields(&body->material->loaded->class_, body->domain.spec->name, body->element->axisymmetric, true,
                          body->rows.gradient >= 0, &body->fields, &body->field_count, report);
}

const ab_field *fem_fields(const ab_domain *domain, size_t *count) {
    const fem_body *body = (const fem_body *)domain;
    *count = body->field_count;
    return body->fields;
}

size_t fem_count(const ab_domain *domain) { return ((const fem_body *)domain)->nodes; }

void fem_cells(const ab_domain *domain, ab_cells *cells) {
    const fem_body *body = (const fem_body *)domain;
    *cells = (ab_cells){.count = body->elements, .nodes = body->element->nodes, .connectivity = body->mesh->connectivity};
}

/* weight[a][q]: what Gauss point q gives the value at node a. The fit of 1, xi, eta, xi eta is orthogonal, as the points are symmetric. */
static void extrapolation(const fem_element *element, bool extrapolate, double weight[FEM_NODES][FEM_GAUSS]) {
    static const double NODE[FEM_NODES][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}};
    double place[FEM_GAUSS][2], share[FEM_GAUSS], square = 0.0;
    for (int q = 0; q < element->gauss; ++q) {
        fem_gauss(element, q, place[q], &share[q]);
        share[q] *= 0.25;
        square += share[q] * place[q][0] * place[q][0];
    }
    const double slope = extrapolate && square > 0.0 ? 1.0 / square : 0.0;
    for (int a = 0; a < element->nodes; ++a)
        for (int q = 0; q < element->gauss; ++q)
            weight[a][q] = share[q] * (1.0 + slope * NODE[a][0] * place[q][0]) * (1.0 + slope * NODE[a][1] * place[q][1]);
}

/* Values at nodes from rows of the Gauss points. */
static ab_status from_gauss(const fem_body *body, int row, int components, bool extrapolate, double *values, ab_report *report) {
    const fem_element *element = body->element;
    double weight[FEM_NODES][FEM_GAUSS], *volume = calloc(body->nodes, sizeof *volume);
    if (!volume) return ab_report_failure(report, "no memory to read a field of body '%s'", body->domain.spec->name);
    extrapolation(element, extrapolate, weight);
    memset(values, 0, body->nodes * (size_t)components * sizeof *values);
    for (size_t e = 0; e < body->elements; ++e) {
        double x[2 * FEM_NODES][8] __attribute__((aligned(64))), share[FEM_NODES][8] __attribute__((aligned(64)));
        const size_t lane = e % 8, block = e / 8;
        fem_gather(body, block, body->x, x);
        element->mass(x, 1.0, share);
        double whole = 0.0;
        for (int a = 0; a < element->nodes; ++a) whole += share[a][lane];
        const uint32_t *node = body->mesh->connectivity + e * (size_t)element->nodes;
        for (int a = 0; a < element->nodes; ++a) {
            volume[node[a]] += whole;
            for (int q = 0; q < element->gauss; ++q)
                for (int c = 0; c < components; ++c)
                    values[node[a] * (size_t)components + (size_t)c] +=
                        whole * weight[a][q] * fem_gauss_rows(body, block, q)[8 * (row + c) + (int)lane];
        }
    }
    for (size_t i = 0; i < body->nodes; ++i)
        for (int c = 0; c < components; ++c) values[i * (size_t)components + (size_t)c] /= volume[i];
    free(volume);
    return AB_OK;
}

static void volumes(const fem_body *body, double *values) {
    const int nodes = body->element->nodes;
    memset(values, 0, body->nodes * sizeof *values);
    for (size_t b = 0; b < body->blocks; ++b) {
        double x[2 * FEM_NODES][8] __attribute__((aligned(64))), share[FEM_NODES][8] __attribute__((aligned(64)));
        fem_gather(body, b, body->x, x);
        body->element->mass(x, 1.0, share);
        for (int l = 0; l < fem_lanes(body, b); ++l)
            for (int a = 0; a < nodes; ++a) values[body->connectivity[(b * (size_t)nodes + (size_t)a) * 8 + (size_t)l]] += share[a][l];
    }
}

ab_status fem_read(const ab_domain *domain, const char *field, double *values, ab_report *report) {
    const fem_body *body = (const fem_body *)domain;
    const size_t n = body->nodes;
    if (!strcmp(field, "id")) {
        for (size_t i = 0; i < n; ++i) values[i] = (double)i;
    } else if (!strcmp(field, "position")) {
        for (size_t k = 0; k < 2 * n; ++k) values[k] = body->x[k] + body->origin[k % 2];
    } else if (!strcmp(field, "displacement")) {
        for (size_t k = 0; k < 2 * n; ++k)
            values[k] = body->x[k] - ((body->datum ? body->datum[k] : body->mesh->x[k]) - body->origin[k % 2]);
    } else if (!strcmp(field, "velocity")) {
        memcpy(values, body->velocity, 2 * n * sizeof *values);
    } else if (!strcmp(field, "mass")) {
        memcpy(values, body->mass, n * sizeof *values);
    } else if (!strcmp(field, "volume")) {
        volumes(body, values);
    } else if (!strcmp(field, "stress")) {
        return from_gauss(body, FEM_ROW_STRESS, 4, true, values, report);
    } else if (!strcmp(field, "deformation-gradient") && body->rows.gradient >= 0) {
        return from_gauss(body, body->rows.gradient, 4, false, values, report);
    } else {
        const ab_class *class_ = &body->material->loaded->class_;
        int row = body->rows.state;
        for (uint32_t s = 0; s < class_->nstate; ++s) {
            const int components = ab_state_components(class_->state[s].shape);
            if (!strcmp(field, class_->state[s].name)) return from_gauss(body, row, components, false, values, report);
            row += components;
        }
        return ab_report_failure(report, "body '%s' has no field '%s'", domain->spec->name, field);
    }
    return AB_OK;
}
