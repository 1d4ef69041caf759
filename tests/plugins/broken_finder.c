/* broken_finder.c: the finder that `abut plugins new` writes, made to break one promise: which one, FAULT says (a macro, from CMakeLists.txt). */
#include <math.h>

#include "abut_plugin.h"

static int find(void *self, const ab_trace *a, const ab_trace *b, ab_points *out);
/* where it is defined, not where it is named */
#define find(...) honest_find(__VA_ARGS__)
#include "new/finder.c"
#undef find

enum { FINDS_NOTHING = 1, COUNTS_CALLS, LEANS_TO_X, WRITES_MASS, WRITES_BEHIND, NOT_FINITE, HEAVY_WEIGHTS, REMEMBERS };

static int find(void *self, const ab_trace *a, const ab_trace *b, ab_points *out) {
    static double calls;
    static void *first; /* stands for the instance: what it has and one made later has not */
    if (!first) first = self;
    if (FAULT == WRITES_MASS && a->count) ((volatile double *)a->mass)[0] = a->mass[0];
    const int code = honest_find(self, a, b, out);
    calls += 1;
    if (FAULT == FINDS_NOTHING) out->count = 0;
    if (FAULT == WRITES_BEHIND) out->gap[out->capacity] = 0;
    for (size_t i = 0; i < out->count; i++) {
        if (FAULT == COUNTS_CALLS) out->gap[i] += 1e-12 * calls;
        if (FAULT == REMEMBERS && self == first) out->gap[i] += 1e-9;
        if (FAULT == LEANS_TO_X) out->gap[i] += 1e-4 * out->normal[i];
        if (FAULT == NOT_FINITE) out->area[i] = sqrt(-1 - out->area[i]);
        if (FAULT == HEAVY_WEIGHTS)
            for (size_t s = out->a_start[i]; s < out->a_start[i + 1]; s++) out->a_weight[s] *= 1.01;
    }
    return code;
}
