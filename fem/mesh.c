/* mesh.c: makes the mesh of a body and checks it. */
#include "fem/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/element.h"
#include "fem/mesh_parts.h"

static const double LEAST_SIZE = 1e-30; /* m, as of shapes: powers of it must be numbers */
static const double LEAST_PART = 1e-12; /* of the coordinates, which round */

static ab_status check(const ab_body_spec *spec, fem_mesh *mesh, ab_report *report);

ab_status fem_mesh_create(const ab_body_spec *spec, const char *folder, fem_mesh **result, ab_report *report) {
    *result = NULL;
    fem_mesh *mesh = NULL;
    switch (spec->mesh.kind) {
    case AB_MESH_BOX: AB_TRY(fem_mesh_box(spec, &mesh, report)); break;
    case AB_MESH_PATCH: AB_TRY(fem_mesh_patch(spec, &mesh, report)); break;
    case AB_MESH_FILE: AB_TRY(fem_mesh_gmsh(spec, folder, &mesh, report)); break;
    default: return ab_report_error(report, spec->mark, "body '%s' has no mesh", spec->name);
    }
    ab_status status = check(spec, mesh, report);
    if (status == AB_OK && spec->mesh.kind == AB_MESH_FILE)
        status = fem_mesh_overlaps(mesh, spec->name, spec->mesh.mark, spec->mesh.file, report);
    if (status != AB_OK) {
        fem_mesh_destroy(mesh);
        return status;
    }
    *result = mesh;
    return AB_OK;
}

ab_status fem_mesh_read(const ab_scene *scene, const ab_body_spec *spec, fem_mesh **mesh, ab_report *report) {
    const char *path = scene->path != NULL ? scene->path : "", *slash = strrchr(path, '/');
    const size_t length = slash != NULL ? (size_t)(slash - path) + (slash == path) : 0; /* "/" stays, all else loses its last slash */
    char *folder = length > 0 ? strndup(path, length) : strdup(".");
    if (folder == NULL) return ab_report_failure(report, "no memory for the mesh of body '%s'", spec->name);
    const ab_status status = fem_mesh_create(spec, folder, mesh, report);
    free(folder);
    return status;
}

void fem_mesh_destroy(fem_mesh *mesh) {
    if (mesh == NULL) return;
    free(mesh->x);
    free(mesh->connectivity);
    free(mesh->node_id);
    free(mesh->element_id);
    free(mesh);
}

ab_status fem_mesh_allocate(int nodes, size_t node_count, size_t element_count, const char *body, fem_mesh **result, ab_report *report) {
    fem_mesh *mesh = calloc(1, sizeof *mesh);
    if (mesh != NULL) {
        *mesh = (fem_mesh){.nodes = nodes, .node_count = node_count, .element_count = element_count};
        mesh->x = calloc(2 * node_count + 1, sizeof *mesh->x);
        mesh->connectivity = calloc((size_t)nodes * element_count + 1, sizeof *mesh->connectivity);
    }
    if (mesh == NULL || mesh->x == NULL || mesh->connectivity == NULL) {
        fem_mesh_destroy(mesh);
        return ab_report_failure(report, "no memory for the mesh of body '%s': %zu elements, %zu nodes", body, element_count, node_count);
    }
    *result = mesh;
    return AB_OK;
}

static double det_at(const fem_mesh *mesh, const uint32_t *node, double xi, double eta) {
    double dn[FEM_NODES][2], j[2][2] = {{0}};
    fem_shape_derivatives(mesh->nodes, xi, eta, dn);
    for (int a = 0; a < mesh->nodes; a++)
        for (int c = 0; c < 2; c++)
            for (int d = 0; d < 2; d++) j[c][d] += mesh->x[2 * (size_t)node[a] + (size_t)c] * dn[a][d];
    return j[0][0] * j[1][1] - j[0][1] * j[1][0];
}

double fem_mesh_jacobian(const fem_mesh *mesh, ab_element_type type, size_t e) {
    const fem_element *element = fem_element_of(type);
    const uint32_t *node = mesh->connectivity + e * (size_t)mesh->nodes;
    double lowest = INFINITY, area = 0;
    for (int q = 0; q < element->gauss; q++) {
        double place[2], weight;
        fem_gauss(element, q, place, &weight);
        const double det = det_at(mesh, node, place[0], place[1]);
        lowest = fmin(lowest, det);
        area += weight * det;
    }
    for (int k = 0; k < 4; k++) lowest = fmin(lowest, det_at(mesh, node, k == 1 || k == 2 ? 1 : -1, k >= 2 ? 1 : -1));
    const double ratio = lowest / (0.25 * fabs(area));
    return ratio > 0 ? ratio : fmin(ratio, 0.0); /* NaN: 0 */
}

static void measure(fem_mesh *mesh) {
    for (int d = 0; d < 2; d++) {
        mesh->low[d] = INFINITY;
        mesh->high[d] = -INFINITY;
        for (size_t i = 0; i < mesh->node_count; i++) {
            mesh->low[d] = fmin(mesh->low[d], mesh->x[2 * i + (size_t)d]);
            mesh->high[d] = fmax(mesh->high[d], mesh->x[2 * i + (size_t)d]);
        }
    }
}

/* Every element must be the image of the square without a fold: what is left of it at Gauss points and corners is stated. */
static ab_status check(const ab_body_spec *spec, fem_mesh *mesh, ab_report *report) {
    measure(mesh);
    for (int d = 0; d < 2; d++) {
        const double size = mesh->high[d] - mesh->low[d],
                     least = fmax(LEAST_SIZE, LEAST_PART * fmax(fabs(mesh->low[d]), fabs(mesh->high[d])));
        if (!(size >= least))
            return ab_report_error(
                report, spec->mesh.mark,
                "body '%s': its mesh is %.3g m wide along %c, too small to compute with; write %.3g m or more there, or check "
                "the unit",
                spec->name, size, d == 0 ? 'x' : 'y', least);
    }
    if (spec->mesh.kind == AB_MESH_BOX) return AB_OK;
    size_t wrong = 0;
    for (size_t e = 0; e < mesh->element_count; e++) {
        const double ratio = fem_mesh_jacobian(mesh, spec->mesh.type, e);
        if (ratio > 1e-6) continue;
        if (wrong++ >= FEM_MOST_SAID) continue;
        double middle[2] = {0};
        for (int a = 0; a < 4; a++)
            for (int d = 0; d < 2; d++)
                middle[d] += 0.25 * mesh->x[2 * (size_t)mesh->connectivity[e * (size_t)mesh->nodes + (size_t)a] + (size_t)d];
        ab_report_error(report, spec->mesh.mark,
                        "body '%s': element %llu near [%.6g, %.6g] is folded or has an angle of 180 degrees (smallest det J %.3g of a "
                        "square's); %s",
                        spec->name, fem_element_id(mesh, e), middle[0], middle[1], ratio,
                        spec->mesh.kind == AB_MESH_FILE ? "mesh that place anew" : "use several patches with edges that turn less");
    }
    if (wrong > FEM_MOST_SAID)
        ab_report_error(report, spec->mesh.mark, "body '%s': %zu further elements are folded", spec->name, wrong - FEM_MOST_SAID);
    return wrong > 0 ? AB_BAD_INPUT : AB_OK;
}
