/* broken_boundary.c: the boundary that `abut plugins new` writes, made to break one promise: which one, FAULT says (a macro, from CMakeLists.txt). */
#include <math.h>
#include <stdint.h>

#include "abut_plugin.h"

enum {
    COUNTS_CALLS = 1,
    REMEMBERS,
    ASKS_NEIGHBOUR,
    HARDER_ALONG_X,
    SAYS_LESS,
    NEGATIVE_DAMPING,
    PUSHES,
    WRITES_NORMAL,
    WRITES_BEHIND,
    WRITES_BEFORE,
    TAKES_UNASKED,
    DIVIDES_BY_SPEED,
    NOT_WRITTEN,
    FORGETS_TO_SAVE
};

static int create(const ab_host *host, const ab_value *settings, void **self);
static int apply(void *self, ab_edges *e);
static int save(void *self, const ab_stream *stream);
static int load(void *self, const ab_stream *stream);
/* where they are defined, not where they are named */
#define create(...) honest_create(__VA_ARGS__)
#define apply(...) honest_apply(__VA_ARGS__)
#define reference save = save, .load = load, .reference /* of the class */
#include "new/boundary.c"
#undef create
#undef apply
#undef reference

extern volatile double broken_sink;
volatile double broken_sink;

/* What a plugin must not keep outside of its instance. */
enum { INSTANCES = 256 };
static double calls, instances;
static struct {
    void *self;
    double steps, last;
} memory[INSTANCES];

static size_t place_of(const void *self) {
    size_t k = 0;
    while (k + 1 < INSTANCES && memory[k].self && memory[k].self != self) k++;
    return k;
}

static int create(const ab_host *host, const ab_value *settings, void **self) {
    const int code = honest_create(host, settings, self);
    if (code != 0) return code;
    const size_t k = place_of(*self);
    memory[k].self = *self, memory[k].steps = 0, memory[k].last = -1;
    instances++;
    return 0;
}

static int save(void *self, const ab_stream *stream) { return (void)self, (void)stream, 0; }
static int load(void *self, const ab_stream *stream) { return (void)self, (void)stream, 0; }

static int apply(void *self, ab_edges *e) {
    const size_t n = e->ld, k = place_of(self);
    if (FAULT == TAKES_UNASKED) broken_sink = ((const volatile double *)e->stiffness)[0];
    if (FAULT == WRITES_NORMAL) ((volatile double *)(uintptr_t)e->normal)[0] = e->normal[0];
    const double kept = e->state1[0];
    const int code = honest_apply(self, e);
    if (FAULT == WRITES_BEHIND) e->traction[e->dimension * n] = 0;
    if (FAULT == WRITES_BEFORE) e->traction[-1] = 0;
    if (e->time != memory[k].last) memory[k].last = e->time, memory[k].steps++;
    calls++;
    for (size_t i = 0; i < e->count; i++) {
        double *t = e->traction + i, speed = 0;
        for (size_t c = 0; c < e->dimension; c++) speed += e->velocity[c * n + i] * e->velocity[c * n + i];
        if (FAULT == COUNTS_CALLS) t[0] *= 1 + 1e-12 * calls;
        if (FAULT == REMEMBERS) t[0] *= 1 + 1e-12 * instances;
        if (FAULT == FORGETS_TO_SAVE) t[0] *= 1 + 1e-12 * memory[k].steps;
        if (FAULT == ASKS_NEIGHBOUR && i > 0) t[0] *= 1 + 0x1p-51;
        if (FAULT == HARDER_ALONG_X) t[0] -= 100 * e->normal[i] * e->normal[i];
        if (FAULT == SAYS_LESS) e->damping[i] *= 0.99;
        if (FAULT == NEGATIVE_DAMPING && e->area[i] > 0.1) e->damping[n + i] = -1;
        for (size_t c = 0; FAULT == PUSHES && speed > 9 && c < e->dimension; c++) t[c * n] *= -1;
        if (FAULT == DIVIDES_BY_SPEED) t[0] *= speed / speed;
        if (FAULT == NOT_WRITTEN && i == 0 && e->time < 0) e->state1[0] = kept;
    }
    return code;
}
