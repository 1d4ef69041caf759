/* axis.c: faces on the axis of an axisymmetric scene are none: the body goes on beyond. */
#include <stdlib.h>

#include "fem/mesh.h"

size_t fem_faces_off_axis(const double *radius, size_t stride, double size, size_t count, uint32_t *face, uint32_t *beside) {
    uint32_t *now = malloc((count + 1) * sizeof *now);
    if (!now) return SIZE_MAX;
    const double tiny = 1e-9 * size;
    size_t kept = 0;
    for (size_t f = 0; f < count; ++f) {
        const bool axis = radius[stride * face[3 * f]] <= tiny && radius[stride * face[3 * f + 1]] <= tiny;
        now[f] = axis ? FEM_NONE : (uint32_t)kept++;
    }
    for (size_t f = 0; f < count; ++f) {
        if (now[f] == FEM_NONE) continue;
        const size_t to = now[f];
        for (size_t k = 0; k < 3; ++k) face[3 * to + k] = face[3 * f + k];
        for (size_t k = 0; k < 2; ++k) beside[2 * to + k] = beside[2 * f + k] == FEM_NONE ? FEM_NONE : now[beside[2 * f + k]];
    }
    free(now);
    return kept;
}
