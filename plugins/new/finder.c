/* my_law.c: the contact finder my-law, as `abut plugins new finder my-law` wrote it: a contact point on each grid node that both bodies reach, its normal
 * between their two, its gap that between the material points nearest to each other. Make it yours.
 *
 * Build it with CMake (CMakeLists.txt beside it; CMAKE_PREFIX_PATH is where abut is installed):
 *     cmake -S . -B build -DCMAKE_PREFIX_PATH=PREFIX && cmake --build build
 * or with a compiler alone:
 *     mkdir -p build && cc -std=c11 -O3 -march=native -shared -fPIC $(pkg-config --cflags abut) my_law.c -o build/my_law.so -lm
 * or put it into plugins/contact/ of abut's own source: it is built with the rest.
 * Then
 *     abut plugins check build/my_law.so
 *     abut run my_law.yaml --strict --plugin-path build
 *
 * abut_plugin.h says all that there is to know: units, signs, order of components, threads, ownership. */
#include <math.h>

#include "abut_plugin.h"

typedef struct law {
    const ab_host *host;
    double least_area; /* of a cell's face */
} law;

static int create(const ab_host *host, const ab_value *settings, void **self) {
    law *l = host->allocate(host->context, sizeof *l);
    if (!l) return -1;
    *l = (law){host, settings[0].real};
    *self = l;
    return 0;
}

static void destroy(void *self) {
    law *l = self;
    l->host->release(l->host->context, l);
}

/* How far the body's points near node i reach along sign * n, from the node, m. The half size of a point along n is sqrt(n.A.n), A its extent. */
static double reach(const ab_trace *t, size_t i, const double *n, double sign) {
    double far = -INFINITY;
    for (size_t k = t->near_start[i]; k < t->near_start[i + 1]; k++) {
        const double *A = t->near_extent + k;
        const size_t m = t->near_ld;
        double along = 0, square = t->dimension == 2 ? 2 * A[2 * m] * n[0] * n[1]
                                                     : 2 * (A[3 * m] * n[0] * n[1] + A[4 * m] * n[1] * n[2] + A[5 * m] * n[2] * n[0]);
        for (size_t c = 0; c < t->dimension; c++) {
            along += sign * n[c] * (t->near_position[c * m + k] - t->position[c * t->ld + i]);
            square += A[c * m] * n[c] * n[c];
        }
        far = fmax(far, along + sqrt(fmax(square, 0)));
    }
    return far;
}

/* Item i of side a and item i of side b are the same node. */
static int find(void *self, const ab_trace *a, const ab_trace *b, ab_points *out) {
    const law *l = self;
    const size_t stencil = a->stencil_start[a->count] + b->stencil_start[b->count];
    if (l->host->reserve(l->host->context, out, a->count, stencil) != 0) return -1;
    size_t made = 0;
    out->a_start[0] = out->b_start[0] = 0;
    for (size_t i = 0; i < a->count; i++) {
        double normal[3] = {0}, length = 0, size_a = 0, size_b = 0;
        for (size_t c = 0; c < a->dimension; c++) {
            size_a += a->area_vector[c * a->ld + i] * a->area_vector[c * a->ld + i];
            size_b += b->area_vector[c * b->ld + i] * b->area_vector[c * b->ld + i];
        }
        const double face = a->dimension == 2 ? a->cell : a->cell * a->cell;
        if (!(fmin(size_a, size_b) > l->least_area * l->least_area * face * face)) continue; /* inside one of them: no face here */
        for (size_t c = 0; c < a->dimension; c++) {
            normal[c] = a->area_vector[c * a->ld + i] / sqrt(size_a) - b->area_vector[c * b->ld + i] / sqrt(size_b);
            length += normal[c] * normal[c];
        }
        if (!(length > 0)) continue;
        double area = 0;
        for (size_t c = 0; c < a->dimension; c++) {
            normal[c] /= sqrt(length);
            area += 0.5 * normal[c] * (a->area_vector[c * a->ld + i] - b->area_vector[c * b->ld + i]);
            out->normal[c * out->ld + made] = normal[c]; /* out of a, into b */
            out->position[c * out->ld + made] = a->position[c * a->ld + i];
        }
        out->gap[made] = -reach(a, i, normal, 1) - reach(b, i, normal, -1);
        out->area[made] = area;
        out->key[made] = a->key[i]; /* the node has it in the next step, too */
        if (out->distance) out->distance[made] = fmax(0, out->gap[made]);
        size_t end_a = out->a_start[made], end_b = out->b_start[made]; /* what the impulse moves: all that makes the velocity here */
        for (size_t s = a->stencil_start[i]; s < a->stencil_start[i + 1]; s++, end_a++)
            out->a_dof[end_a] = a->stencil_dof[s], out->a_weight[end_a] = a->stencil_weight[s];
        for (size_t s = b->stencil_start[i]; s < b->stencil_start[i + 1]; s++, end_b++)
            out->b_dof[end_b] = b->stencil_dof[s], out->b_weight[end_b] = b->stencil_weight[s];
        made++;
        out->a_start[made] = end_a;
        out->b_start[made] = end_b;
    }
    out->count = made;
    return 0;
}

/* name, unit, help, words of a choice, type, flags, default, range */
static const ab_param params[] = {{"least_area", "1", "nodes with less of a cell's face than this have no contact point", NULL, AB_REAL,
                                   AB_MAX_OPEN, 1e-3, 0, 1}};
static const ab_contact_ops ops = {sizeof ops, find, NULL};
static const ab_class my_law = {
    .struct_size = sizeof my_law,
    .kind = AB_CONTACT,
    .spaces = AB_PLANE_STRAIN | AB_SPACE_3D,
    .needs = AB_NEED_SHARED_NODES | AB_NEED_AREA_VECTOR | AB_NEED_NEAR_POINTS,
    .gives = AB_GIVE_POINTS,
    .nparam = sizeof params / sizeof *params,
    .name = "my-law",
    .help = "say in one line what it is",
    .reference = "",
    .param = params,
    .create = create,
    .destroy = destroy,
    .ops = &ops,
};
static const ab_class *const classes[] = {&my_law};
AB_EXPORT const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "my-law", "0.1", "your licence", classes};
