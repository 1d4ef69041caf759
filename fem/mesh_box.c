/* mesh_box.c: meshes in rows and columns, and the simplest of them, a box. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fem/mesh_parts.h"

void fem_mesh_divide(long n, double grading, double *s) {
    const double step = n > 1 ? log(grading) / (double)(n - 1) : 0; /* of the logarithm of sizes */
    for (long i = 0; i <= n; i++)
        s[i] = fabs(step * (double)n) < 1e-9 ? (double)i / (double)n : expm1(step * (double)i) / expm1(step * (double)n);
    s[0] = 0;
    s[n] = 1;
}

/* Number of the node at half steps (i, j) from the lower left corner of the lattice. */
static uint32_t number(bool quadratic, long nx, long i, long j) {
    if (!quadratic) return (uint32_t)((j / 2) * (nx + 1) + i / 2);
    const long pair = 3 * nx + 2; /* a row of corners and the row of middles above it */
    return (uint32_t)((j / 2) * pair + (j % 2 == 0 ? i : 2 * nx + 1 + i / 2));
}

/* With linear elements only even half steps are nodes, with quadratic ones all but those that are odd both ways. */
static void place_nodes(bool quadratic, long nx, long ny, const double *s, const double *t, fem_mesh_place place, const void *context,
                        double *x) {
    const long step = quadratic ? 1 : 2;
    for (long j = 0; j <= 2 * ny; j += step)
        for (long i = 0; i <= 2 * nx; i += step) {
            if (i % 2 == 1 && j % 2 == 1) continue;
            place(context, i % 2 == 0 ? s[i / 2] : 0.5 * (s[i / 2] + s[i / 2 + 1]), j % 2 == 0 ? t[j / 2] : 0.5 * (t[j / 2] + t[j / 2 + 1]),
                  x + 2 * (size_t)number(quadratic, nx, i, j));
        }
}

ab_status fem_mesh_lattice(const ab_body_spec *spec, fem_mesh_place place, const void *context, fem_mesh **result, ab_report *report) {
    /* corners counter-clockwise, then middles of sides, in half steps from the corner of the element */
    static const int offset[8][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}};
    const long nx = spec->mesh.elements[0], ny = spec->mesh.elements[1];
    const bool quadratic = spec->mesh.type >= AB_ELEMENT_Q8;
    const size_t corners = (size_t)(nx + 1) * (size_t)(ny + 1), middles = (size_t)nx * (size_t)(ny + 1) + (size_t)(nx + 1) * (size_t)ny;
    fem_mesh *mesh = NULL;
    AB_TRY(fem_mesh_allocate(quadratic ? 8 : 4, corners + (quadratic ? middles : 0), (size_t)nx * (size_t)ny, spec->name, &mesh, report));
    double *s = malloc((size_t)(nx + ny + 2) * sizeof *s), *t = s + nx + 1;
    if (s == NULL) {
        fem_mesh_destroy(mesh);
        return ab_report_failure(report, "no memory for the mesh of body '%s'", spec->name);
    }
    fem_mesh_divide(nx, spec->mesh.grading[0], s);
    fem_mesh_divide(ny, spec->mesh.grading[1], t);
    place_nodes(quadratic, nx, ny, s, t, place, context, mesh->x);
    free(s);
    uint32_t *node = mesh->connectivity;
    for (long j = 0; j < ny; j++)
        for (long i = 0; i < nx; i++)
            for (int a = 0; a < mesh->nodes; a++) *node++ = number(quadratic, nx, 2 * i + offset[a][0], 2 * j + offset[a][1]);
    *result = mesh;
    return AB_OK;
}

static void box_place(const void *context, double s, double t, double x[2]) {
    const ab_mesh_spec *mesh = context;
    const double at[2] = {s, t};
    for (int d = 0; d < 2; d++) /* both corners are met to the last bit */
        x[d] = at[d] < 1 ? mesh->low[d] + at[d] * (mesh->high[d] - mesh->low[d]) : mesh->high[d];
}

ab_status fem_mesh_box(const ab_body_spec *spec, fem_mesh **mesh, ab_report *report) {
    return fem_mesh_lattice(spec, box_place, &spec->mesh, mesh, report);
}
