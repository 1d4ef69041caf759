/* initial.c: the stress at Gauss points that the scene begins with. */
#include "core/initial.h"

#include <math.h>
#include <stdlib.h>

#include "fem/domain.h"

enum { CHORDS = 16 }; /* of a face that is bent */

ab_status fem_initial_open(const fem_body *body, const fem_faces *faces, ab_initial **initial, ab_report *report) {
    *initial = NULL;
    if (body->domain.spec->initial.kind == AB_INITIAL_NONE) return AB_OK;
    double(*edges)[4] = malloc((CHORDS * faces->count + 1) * sizeof *edges);
    if (!edges) return ab_report_failure(report, "body '%s': no memory for its initial stress", body->domain.spec->name);
    size_t count = 0;
    for (size_t f = 0; f < faces->count; ++f) {
        const uint32_t *node = faces->vertex + 3 * f;
        const double *x = body->mesh->x, *a = x + 2 * (size_t)node[0], *b = x + 2 * (size_t)node[1];
        const double *m = node[2] == FEM_NONE ? NULL : x + 2 * (size_t)node[2];
        bool bent = false;
        for (int c = 0; c < 2 && m; ++c) bent = bent || fabs(m[c] - 0.5 * (a[c] + b[c])) > 1e-12 * (fabs(b[0] - a[0]) + fabs(b[1] - a[1]));
        const int chords = bent ? CHORDS : 1;
        for (int k = 0; k < chords; ++k, ++count)
            for (int end = 0; end < 2; ++end) {
                const double t = (double)(k + end) / chords, s = 2.0 * t - 1.0;
                for (int c = 0; c < 2; ++c)
                    edges[count][2 * end + c] = bent       ? 0.5 * s * (s - 1.0) * a[c] + 0.5 * s * (s + 1.0) * b[c] + (1.0 - s * s) * m[c]
                                                : end == 0 ? a[c]
                                                           : b[c];
            }
    }
    const ab_status status = ab_initial_open(body->scene, body->domain.index, (const double(*)[4])edges, count, initial, report);
    free(edges);
    return status;
}

ab_status fem_initial_point(fem_body *body, const ab_initial *initial, size_t block, int point, ab_material_start *start,
                            ab_report *report) {
    const size_t nodes = (size_t)body->element->nodes;
    double at[2], weight, n[FEM_NODES], place[2][8] = {{0.0}};
    fem_gauss(body->element, point, at, &weight);
    fem_shape(body->element->nodes, at[0], at[1], n);
    for (size_t l = 0; l < 8; ++l)
        for (size_t a = 0; a < nodes; ++a)
            for (size_t c = 0; c < 2; ++c)
                place[c][l] += n[a] * body->mesh->x[2 * (size_t)body->connectivity[block * 8 * nodes + 8 * a + l] + c];
    AB_TRY(ab_initial_eight(initial, body->material, &body->service, body->self, (const double(*)[8])place, start, report));
    if (start->wave_speed > body->start.wave_speed) body->start = *start; /* limits of the step go by the stiffest place */
    return AB_OK;
}
