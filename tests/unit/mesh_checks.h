/* mesh_checks.h: meshes for tests, written by hand or by a scene's words, and what must hold of any of them. */
#ifndef AB_MESH_CHECKS_H
#define AB_MESH_CHECKS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fem/element.h"
#include "fem/mesh.h"

static inline ab_body_spec box_body(ab_element_type type, double x0, double y0, double x1, double y1, long nx, long ny) {
    return (ab_body_spec){
        .name = "beam",
        .method = "finite-elements",
        .mesh = {
            .kind = AB_MESH_BOX, .type = type, .low = {x0, y0}, .high = {x1, y1}, .elements = {nx, ny}, .grading = {1, 1}, .hourglass = 1}};
}

static inline fem_mesh *mesh_of(const ab_body_spec *spec) {
    ab_report *report = ab_report_create();
    fem_mesh *mesh = NULL;
    if (fem_mesh_create(spec, ".", &mesh, report) != AB_OK) ab_report_print(report, stderr);
    ab_report_destroy(report);
    assert_non_null(mesh);
    return mesh;
}

static inline fem_faces *faces_of(const fem_mesh *mesh) {
    ab_report *report = ab_report_create();
    fem_faces *faces = NULL;
    if (fem_faces_create(mesh, "beam", &faces, report) != AB_OK) ab_report_print(report, stderr);
    ab_report_destroy(report);
    assert_non_null(faces);
    return faces;
}

/* The elements of `mesh` for which keep is true, as a mesh of their own with all the nodes. */
static inline fem_mesh *part_of(const fem_mesh *mesh, const bool *keep) {
    fem_mesh *part = calloc(1, sizeof *part);
    *part = (fem_mesh){.nodes = mesh->nodes, .node_count = mesh->node_count};
    memcpy(part->low, mesh->low, sizeof part->low);
    memcpy(part->high, mesh->high, sizeof part->high);
    part->x = malloc(2 * mesh->node_count * sizeof *part->x);
    part->connectivity = malloc((size_t)mesh->nodes * mesh->element_count * sizeof *part->connectivity);
    memcpy(part->x, mesh->x, 2 * mesh->node_count * sizeof *part->x);
    for (size_t e = 0; e < mesh->element_count; e++)
        if (keep[e])
            memcpy(part->connectivity + (size_t)mesh->nodes * part->element_count++, mesh->connectivity + (size_t)mesh->nodes * e,
                   (size_t)mesh->nodes * sizeof *part->connectivity);
    return part;
}

/* Area by 3 x 3 Gauss points, exact for straight and for quadratic sides. */
static inline double area_of(const fem_mesh *mesh) {
    const fem_element *q8 = fem_element_of(AB_ELEMENT_Q8);
    double area = 0;
    for (size_t e = 0; e < mesh->element_count; e++)
        for (int q = 0; q < q8->gauss; q++) {
            double place[2], weight, dn[FEM_NODES][2], j[2][2] = {{0}};
            fem_gauss(q8, q, place, &weight);
            fem_shape_derivatives(mesh->nodes, place[0], place[1], dn);
            for (int a = 0; a < mesh->nodes; a++)
                for (int c = 0; c < 2; c++)
                    for (int d = 0; d < 2; d++)
                        j[c][d] += mesh->x[2 * (size_t)mesh->connectivity[e * (size_t)mesh->nodes + (size_t)a] + (size_t)c] * dn[a][d];
            area += weight * (j[0][0] * j[1][1] - j[0][1] * j[1][0]);
        }
    return area;
}

/* The same by the divergence theorem over the outer faces: right only if all are there, once, with the body on their left. */
static inline double area_inside(const fem_mesh *mesh, const fem_faces *faces) {
    double area = 0;
    for (size_t f = 0; f < faces->count; f++) {
        const uint32_t *v = faces->vertex + 3 * f;
        const double *a = mesh->x + 2 * (size_t)v[0], *b = mesh->x + 2 * (size_t)v[1];
        area += 0.5 * (a[0] * b[1] - b[0] * a[1]);
        if (v[2] == FEM_NONE) continue;
        const double *m = mesh->x + 2 * (size_t)v[2]; /* parabola over the chord: 2/3 of chord x height */
        area += 2.0 / 3 * ((m[0] - a[0]) * (b[1] - a[1]) - (m[1] - a[1]) * (b[0] - a[0]));
    }
    return area;
}

/* What every list of faces promises. Gives the number of closed chains. */
static inline size_t check_faces(const fem_mesh *mesh, const fem_faces *faces) {
    assert_float_equal(area_inside(mesh, faces), area_of(mesh), 1e-12 * area_of(mesh));
    for (size_t f = 0; f < faces->count; f++) {
        const uint32_t before = faces->beside[2 * f], after = faces->beside[2 * f + 1];
        assert_true(before < faces->count && after < faces->count);
        assert_int_equal(faces->beside[2 * (size_t)before + 1], f);
        assert_int_equal(faces->beside[2 * (size_t)after], f);
        assert_int_equal(faces->vertex[3 * (size_t)before + 1], faces->vertex[3 * f]);
        assert_int_equal(faces->vertex[3 * (size_t)after], faces->vertex[3 * f + 1]);
        const uint32_t *node = mesh->connectivity + faces->element[f] * (size_t)mesh->nodes;
        const int s = faces->side[f];
        assert_int_equal(faces->vertex[3 * f], node[s]);
        assert_int_equal(faces->vertex[3 * f + 1], node[(s + 1) % 4]);
        assert_int_equal(faces->vertex[3 * f + 2], mesh->nodes == 8 ? node[4 + s] : FEM_NONE);
        if (f > 0) assert_true(4 * faces->element[f] + faces->side[f] > 4 * faces->element[f - 1] + faces->side[f - 1]);
    }
    size_t chains = 0;
    bool *seen = calloc(faces->count + 1, sizeof *seen);
    for (size_t f = 0; f < faces->count; f++) {
        if (seen[f]) continue;
        chains++;
        for (size_t k = f; !seen[k]; k = faces->beside[2 * k + 1]) seen[k] = true;
    }
    free(seen);
    size_t listed = 0, expected = 0;
    for (size_t k = 0; k < 3 * faces->count; k++) expected += faces->vertex[k] != FEM_NONE;
    for (size_t n = 0; n < faces->node_count; n++) {
        if (n > 0) assert_true(faces->node[n] > faces->node[n - 1]);
        for (uint32_t k = faces->start[n]; k < faces->start[n + 1]; k++, listed++) {
            const uint32_t *v = faces->vertex + 3 * (size_t)faces->face[k];
            assert_true(v[0] == faces->node[n] || v[1] == faces->node[n] || v[2] == faces->node[n]);
        }
    }
    assert_int_equal(listed, expected);
    return chains;
}

#endif
