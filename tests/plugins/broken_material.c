/* broken_material.c: the material that `abut plugins new` writes, made to break one promise: which one, FAULT says (a macro, from CMakeLists.txt). */
#include <math.h>
#include <sched.h>
#include <stdint.h>
#include <unistd.h>

#include "abut_plugin.h"

static int update(void *self, ab_batch *b);
static int create(const ab_host *host, const ab_value *settings, void **self);
/* where they are defined, not where they are named */
#define update(...) honest_update(__VA_ARGS__)
#define create(...) honest_create(__VA_ARGS__)
#define AB_GIVE_STRESS (AB_GIVE_STRESS | AB_GIVE_DISSIPATION)
#include "new/material.c"
#undef update
#undef create

enum {
    TABLE_WITHOUT_BOUNDS = 1,
    NO_REASON,
    COUNTS_CALLS,
    OTHER_IN_EIGHTS,
    SHARED_SCRATCH,
    STIFFER_ALONG_X,
    SLOW_WAVES,
    WRITES_OLD,
    WRITES_BEHIND,
    WRITES_BEFORE,
    TAKES_UNASKED,
    NOT_FINITE,
    NOT_WRITTEN,
    LOOPS,
    CRASHES,
    EXITS,
    MAKES_ENERGY
};

extern double broken_sink;
double broken_sink;

static int create(const ab_host *host, const ab_value *settings, void **self) {
    const uintptr_t far = (uintptr_t)&broken_sink ^ ((uintptr_t)1 << 44); /* as a table read far behind its end */
    if (FAULT == TABLE_WITHOUT_BOUNDS && !(settings[1].real < 0.5))       /* the host lets none through; but who knows */
        broken_sink = *(volatile double *)far;
    if (FAULT == NO_REASON && settings[1].real > 0.3 && settings[1].given) return -1;
    return honest_create(host, settings, self);
}

static int update(void *self, ab_batch *b) {
    static double calls;
    static volatile double scratch;
    const law *l = self;
    const size_t n = b->ld;
    double largest = 0;
    for (size_t i = 0; i < b->count; i++) largest = fmax(largest, fabs(b->strain_increment[i]));
    if (FAULT == LOOPS && largest > 0.05)
        for (volatile int forever = 1; forever;) {}
    if (FAULT == CRASHES && largest > 0.05) broken_sink = *(volatile double *)((uintptr_t)&broken_sink ^ ((uintptr_t)1 << 44));
    if (FAULT == EXITS && largest > 0.05) _exit(0);
    if (FAULT == TAKES_UNASKED) broken_sink = ((const volatile double *)b->deformation_gradient)[0];
    if (FAULT == WRITES_OLD) ((volatile double *)(uintptr_t)b->stress0)[0] = b->stress0[0]; /* as it was, by a cast */
    const int code = honest_update(self, b);
    if (FAULT == SHARED_SCRATCH) {
        scratch = b->stress1[0];
        sched_yield();
        for (volatile int wait = 0; wait < 2000; wait++) {}
        b->stress1[0] = scratch;
    }
    if (FAULT == WRITES_BEHIND) b->stress1[b->components * n] = 0;
    if (FAULT == WRITES_BEFORE) b->stress1[-1] = 0;
    calls += 1;
    for (size_t i = 0; i < b->count; i++) {
        if (FAULT == COUNTS_CALLS) b->stress1[i] += 1e-6 * calls;
        if (FAULT == OTHER_IN_EIGHTS && b->count % 8 == 0) b->stress1[i] *= 1 + 0x1p-51;
        if (FAULT == STIFFER_ALONG_X) b->stress1[i] += 0.2 * l->mu * b->strain_increment[i];
        if (FAULT == STIFFER_ALONG_X && b->wave_speed) b->wave_speed[i] *= 1.2;
        if (FAULT == SLOW_WAVES && b->wave_speed) b->wave_speed[i] *= 0.5;
        if (FAULT == NOT_FINITE && largest > 0.05) b->stress1[n + i] = log(-largest);
        if (FAULT == NOT_WRITTEN && largest == 0) {
            const uint64_t nothing = 0x7ff8dead0badf00du; /* what the check puts there: as if it had not been touched */
            for (size_t k = 0; k < sizeof nothing; k++) ((unsigned char *)&b->stress1[i])[k] = ((const unsigned char *)&nothing)[k];
        }
        if (b->dissipation) b->dissipation[i] = FAULT == MAKES_ENERGY ? -1e-3 * l->mu * b->strain_increment[i] * b->strain_increment[i] : 0;
    }
    return code;
}
