/* my_law.c: the boundary my-law, as `abut plugins new boundary my-law` wrote it: dashpots that take waves away (Lysmer and Kuhlemeyer 1969), and say how much energy. Make it yours.
 *
 * Build it with CMake (CMakeLists.txt beside it; CMAKE_PREFIX_PATH is where abut is installed):
 *     cmake -S . -B build -DCMAKE_PREFIX_PATH=PREFIX && cmake --build build
 * or with a compiler alone:
 *     mkdir -p build && cc -std=c11 -O3 -march=native -shared -fPIC $(pkg-config --cflags abut) my_law.c -o build/my_law.so -lm
 * or put it into plugins/boundary/ of abut's own source: it is built with the rest.
 * Then
 *     abut plugins check build/my_law.so
 *     abut run my_law.yaml --strict --plugin-path build
 *
 * abut_plugin.h says all that there is to know: units, signs, order of components, threads, ownership. */
#include <math.h>

#include "abut_plugin.h"

typedef struct law {
    const ab_host *host;
    double a, b;
} law;

static int create(const ab_host *host, const ab_value *settings, void **self) {
    law *l = host->allocate(host->context, sizeof *l);
    if (!l) return -1;
    *l = (law){host, settings[0].real, settings[1].real};
    *self = l;
    return 0;
}

static void destroy(void *self) {
    law *l = self;
    l->host->release(l->host->context, l);
}

/* Tractions at the velocity of the start of the step. As the class gives damping, the host takes them at the mean velocity of the step, which is stable however light the edge. */
static int apply(void *self, ab_edges *e) {
    const law *l = self;
    const size_t n = e->ld; /* component c of edge i is a[c*n + i] */
    for (size_t i = 0; i < e->count; i++) {
        const double along = l->a * e->density[i] * e->p_wave_speed[i], across = l->b * e->density[i] * e->s_wave_speed[i]; /* Pa s/m */
        double speed = 0, power = 0; /* of the edge along its normal, out of the body; taken per area */
        for (size_t c = 0; c < e->dimension; c++) speed += e->velocity[c * n + i] * e->normal[c * n + i];
        for (size_t c = 0; c < e->dimension; c++) {
            const double normal = speed * e->normal[c * n + i], slip = e->velocity[c * n + i] - normal;
            e->traction[c * n + i] = -along * normal - across * slip;
            power += along * normal * normal + across * slip * slip;
        }
        e->damping[i] = along;
        e->damping[n + i] = across;
        e->state1[i] = e->state0[i] + e->dt * e->area[i] * power; /* old state is never written */
    }
    return 0;
}

/* name, unit, help, words of a choice, type, flags, default, range */
static const ab_param params[] = {
    {"a", "1", "part of rho c_p along the normal", NULL, AB_REAL, 0, 1, 0, INFINITY},
    {"b", "1", "part of rho c_s across the normal", NULL, AB_REAL, 0, 1, 0, INFINITY},
};
static const ab_state states[] = {{"taken", "J", "energy that the edge took so far", AB_SCALAR, AB_SUM, 0}};
static const ab_boundary_ops ops = {sizeof ops, apply};
static const ab_class my_law = {
    .struct_size = sizeof my_law,
    .kind = AB_BOUNDARY,
    .spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D,
    .gives = AB_GIVE_TRACTION | AB_GIVE_DAMPING,
    .nparam = sizeof params / sizeof *params,
    .nstate = sizeof states / sizeof *states,
    .name = "my-law",
    .help = "say in one line what it is",
    .reference = "",
    .param = params,
    .state = states,
    .create = create,
    .destroy = destroy,
    .ops = &ops,
};
static const ab_class *const classes[] = {&my_law};
AB_EXPORT const ab_plugin abut_plugin_v1 = {AB_PLUGIN_HEAD(1), "my-law", "0.1", "your licence", classes};
