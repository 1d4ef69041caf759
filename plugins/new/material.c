/* my_law.c: the material my-law, as `abut plugins new material my-law` wrote it: linear elasticity that keeps the work done on it. Make it yours.
 *
 * Build it with CMake (CMakeLists.txt beside it; CMAKE_PREFIX_PATH is where abut is installed):
 *     cmake -S . -B build -DCMAKE_PREFIX_PATH=PREFIX && cmake --build build
 * or with a compiler alone:
 *     mkdir -p build && cc -std=c11 -O3 -march=native -shared -fPIC $(pkg-config --cflags abut) my_law.c -o build/my_law.so -lm
 * or put it into plugins/material/ of abut's own source: it is built with the rest.
 * Then
 *     abut plugins check build/my_law.so
 *     abut run my_law.yaml --strict --plugin-path build
 *
 * abut_plugin.h says all that there is to know: units, signs, order of components, threads, ownership. */
#include <math.h>

#include "abut_plugin.h"

typedef struct law { /* constants, from the settings; never written after create */
    const ab_host *host;
    double lambda, mu; /* Pa */
} law;

static int create(const ab_host *host, const ab_value *settings, void **self) {
    const double E = settings[0].real, nu = settings[1].real;
    law *l = host->allocate(host->context, sizeof *l);
    if (!l) return -1;
    *l = (law){host, E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))};
    *self = l;
    return 0;
}

static void destroy(void *self) {
    law *l = self;
    l->host->release(l->host->context, l);
}

static int update(void *self, ab_batch *b) { /* several threads at once: everything that changes is in the states */
    const law *l = self;
    const size_t n = b->ld; /* component c of item i is a[c*n + i] */
    for (size_t i = 0; i < b->count; i++) {
        const double *strain = b->strain_increment + i, *old = b->stress0 + i;
        const double volume = strain[0] + strain[n] + strain[2 * n];
        double *stress = b->stress1 + i, work = 0;
        for (size_t c = 0; c < b->components; c++) { /* three normal ones, then shear with gamma = 2 eps */
            const double change = c < 3 ? l->lambda * volume + 2 * l->mu * strain[c * n] : l->mu * strain[c * n];
            stress[c * n] = old[c * n] + change;
            work += (old[c * n] + 0.5 * change) * strain[c * n];
        }
        b->state1[i] = b->state0[i] + work; /* old state is never written */
        if (b->wave_speed) b->wave_speed[i] = sqrt((l->lambda + 2 * l->mu) / b->density[i]);
    }
    return 0;
}

/* name, unit, help, words of a choice, type, flags, default, range */
static const ab_param params[] = {
    {"E", "Pa", "Young's modulus", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
    {"nu", "1", "Poisson's ratio", NULL, AB_REAL, AB_MIN_OPEN | AB_MAX_OPEN, 0.3, -1, 0.5},
};
static const ab_state states[] = {{"work", "J m-3", "work done on the material so far", AB_SCALAR, AB_AVERAGE, 0}};
static const ab_material_ops ops = {sizeof ops, NULL, update};
static const ab_class my_law = {
    .struct_size = sizeof my_law,
    .kind = AB_MATERIAL,
    .spaces = AB_PLANE_STRAIN | AB_SPACE_3D,
    .gives = AB_GIVE_STRESS | AB_GIVE_WAVE_SPEED,
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
