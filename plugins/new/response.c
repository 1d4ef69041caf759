/* my_law.c: the contact response my-law, as `abut plugins new response my-law` wrote it: no approach, Coulomb friction. Make it yours.
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
    double friction;
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

/* An impulse j changes the relative velocity by -j/m. The answer has to be a fixed point: given the velocity that its own impulse has left, it asks for
 * the same impulse again. impulse + m v does not change with it, so what follows from that alone is one. */
static int respond(void *self, ab_points *p, size_t first, size_t count) {
    const law *l = self;
    const size_t n = p->ld;
    for (size_t i = first; i < first + count; i++) {
        double approach = 0, pressed = 0; /* along the normal: speed of a towards b, and impulse on b so far */
        for (size_t c = 0; c < p->dimension; c++) {
            approach += p->relative_velocity[c * n + i] * p->normal[c * n + i];
            pressed += p->impulse[c * n + i] * p->normal[c * n + i];
        }
        const double push = fmax(0, pressed + p->normal_mass[i] * (approach - fmax(p->gap[i], 0) / p->dt));
        double across[3] = {0}, size = 0; /* what would end the slip */
        for (size_t c = 0; c < p->dimension; c++) {
            const double normal = p->normal[c * n + i], slip = p->relative_velocity[c * n + i] - approach * normal;
            across[c] = p->impulse[c * n + i] - pressed * normal + p->tangential_mass[i] * slip;
            size += across[c] * across[c];
        }
        size = sqrt(size);
        const double limit = l->friction * push, part = size > limit ? limit / size : 1;
        for (size_t c = 0; c < p->dimension; c++) p->impulse[c * n + i] = push * p->normal[c * n + i] + part * across[c];
    }
    return 0;
}

/* name, unit, help, words of a choice, type, flags, default, range */
static const ab_param params[] = {{"friction", "1", "coefficient of friction", NULL, AB_REAL, 0, 0, 0, INFINITY}};
static const ab_contact_ops ops = {sizeof ops, NULL, respond};
static const ab_class my_law = {
    .struct_size = sizeof my_law,
    .kind = AB_CONTACT,
    .spaces = AB_PLANE_STRAIN | AB_SPACE_3D,
    .gives = AB_GIVE_IMPULSE,
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
