/* broken_response.c: the response that `abut plugins new` writes, made to break one promise: which one, FAULT says (a macro, from CMakeLists.txt). */
#include <math.h>
#include <stdint.h>

#include "abut_plugin.h"

static int respond(void *self, ab_points *p, size_t first, size_t count);
/* where it is defined, not where it is named */
#define respond(...) honest_respond(__VA_ARGS__)
#include "new/response.c"
#undef respond

enum {
    COUNTS_CALLS = 1,
    ASKS_NEIGHBOUR,
    FASTER_ALONG_X,
    FORGETS_ITSELF,
    WRITES_NORMAL,
    WRITES_BEHIND,
    TAKES_UNASKED,
    DIVIDES_BY_MASS,
    THROWS
};

extern double broken_sink;
double broken_sink;

static int respond(void *self, ab_points *p, size_t first, size_t count) {
    static double calls;
    const size_t n = p->ld;
    if (FAULT == TAKES_UNASKED) broken_sink = ((const volatile double *)p->distance)[first];
    if (FAULT == WRITES_NORMAL) ((volatile double *)p->normal)[first] = p->normal[first];
    if (FAULT == FORGETS_ITSELF)
        for (size_t i = first; i < first + count; i++)
            for (size_t c = 0; c < p->dimension; c++) p->impulse[c * n + i] = 0;
    const int code = honest_respond(self, p, first, count);
    if (FAULT == WRITES_BEHIND) p->stiffness[p->count] = 0;
    calls += 1;
    for (size_t i = first; i < first + count; i++) {
        double pressed = 0;
        for (size_t c = 0; c < p->dimension; c++) pressed += p->impulse[c * n + i] * p->normal[c * n + i];
        for (size_t c = 0; c < p->dimension; c++) {
            double *j = p->impulse + c * n + i;
            if (FAULT == COUNTS_CALLS) *j *= 1 + 1e-12 * calls;
            if (FAULT == ASKS_NEIGHBOUR && i > first) *j *= 1 + 0x1p-51;
            if (FAULT == FASTER_ALONG_X)
                *j -= 0.3 * fabs(p->normal[i]) * pressed * p->normal[c * n + i]; /* softer where it looks along x */
            if (FAULT == DIVIDES_BY_MASS) *j *= p->tangential_mass[i] / p->tangential_mass[i];
            if (FAULT == THROWS) *j += 3 * pressed * p->normal[c * n + i]; /* by far: what closes a gap first takes part of it */
        }
    }
    return code;
}
