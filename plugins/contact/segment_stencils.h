/* segment_stencils.h: what places on a surface hang on: the dofs and weights of a place on a face, and the place of its own outline that a material point touches with. For
 * finders in this folder. */
#ifndef SEGMENT_STENCILS_H
#define SEGMENT_STENCILS_H

#include "surface_hits.h"

/* Adds weight on a dof to a stencil that begins at `begin` and ends before *end. */
static void add_weight(uint32_t *dofs, double *weights, size_t begin, size_t *end, uint32_t dof, double weight) {
    for (size_t k = begin; k < *end; ++k)
        if (dofs[k] == dof) {
            weights[k] += weight;
            return;
        }
    dofs[*end] = dof;
    weights[(*end)++] = weight;
}

/* Weights of the face's vertices at xi. */
static void shape(int bent, double xi, double phi[3]) {
    phi[0] = bent ? 0.5 * xi * (xi - 1.0) : 0.5 * (1.0 - xi);
    phi[1] = bent ? 0.5 * xi * (xi + 1.0) : 0.5 * (1.0 + xi);
    phi[2] = bent ? (1.0 - xi) * (1.0 + xi) : 0.0;
}

/* Adds the stencil of a place on a face. */
static void add_place(const ab_surface *s, uint32_t face, double xi, uint32_t *dofs, double *weights, size_t begin, size_t *end) {
    const uint32_t *v = s->face_vertex + 3 * (size_t)face;
    const int vertices = v[2] == UINT32_MAX ? 2 : 3;
    double phi[3];
    shape(vertices == 3, xi, phi);
    for (int k = 0; k < vertices; ++k)
        for (size_t e = s->vertex_start[v[k]]; phi[k] != 0.0 && e < s->vertex_start[v[k] + 1]; ++e)
            add_weight(dofs, weights, begin, end, s->vertex_dof[e], phi[k] * s->vertex_weight[e]);
}

static size_t stencil_of_face(const ab_surface *s, uint32_t face) {
    const uint32_t *v = s->face_vertex + 3 * (size_t)face;
    size_t size = 0;
    for (int k = 0; k < (v[2] == UINT32_MAX ? 2 : 3); ++k) size += s->vertex_start[v[k] + 1] - s->vertex_start[v[k]];
    return size;
}

/* Square of the distance of x from a straight face, and where on it. */
static double square_to_face(const ab_surface *s, uint32_t face, const double x[2], double *xi) {
    const uint32_t *v = s->face_vertex + 3 * (size_t)face;
    const double from[2] = {s->vertex_position[v[0]], s->vertex_position[s->vertex_ld + v[0]]};
    const double along[2] = {s->vertex_position[v[1]] - from[0], s->vertex_position[s->vertex_ld + v[1]] - from[1]};
    const double q[2] = {x[0] - from[0], x[1] - from[1]}, square = dot(along, along);
    const double part = square > 0.0 ? smaller(1.0, larger(0.0, dot(along, q) / square)) : 0.0;
    const double r[2] = {q[0] - part * along[0], q[1] - part * along[1]};
    *xi = 2.0 * part - 1.0;
    return dot(r, r);
}

/* The place of a body's own outline that is closest to x: its face, and where on it. Begins at face `from`, goes along the outline as long as it comes closer, and looks at all
 * faces where that ends further than `near` from x; UINT32_MAX: nowhere to begin. */
static uint32_t own_place(const ab_surface *s, const double x[2], double near, uint32_t from, double *xi) {
    uint32_t face = from < s->face_count ? from : UINT32_MAX;
    if (face != UINT32_MAX) {
        double least = square_to_face(s, face, x, xi);
        for (int end = 0; end < 2; ++end)
            for (uint32_t next; (next = s->face_beside[2 * (size_t)face + (size_t)end]) != UINT32_MAX;) {
                double there;
                const double square = square_to_face(s, next, x, &there);
                if (!(square < least)) break;
                least = square, face = next, *xi = there;
            }
        if (least <= near * near) return face;
    }
    double least = INFINITY;
    for (uint32_t f = 0; f < s->face_count; ++f) {
        double there;
        const double square = square_to_face(s, f, x, &there);
        if (square < least) least = square, face = f, *xi = there;
    }
    return face;
}

#endif
