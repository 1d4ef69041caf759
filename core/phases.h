/* phases.h: wall time by the phases of a step, for scheduler.c and run.c only. */
#ifndef AB_PHASES_H
#define AB_PHASES_H

#include <time.h>

enum { PHASE_BEGIN, PHASE_CONTACT, PHASE_FINISH, PHASE_REMAP, PHASE_STRESS, PHASE_RESULTS, PHASE_BOUNDARY, PHASES };

static inline double ab_seconds(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Times every call of a phase. */
#define TIMED(phase, statement)                                                                                                            \
    do {                                                                                                                                   \
        const double begin_ = ab_seconds(CLOCK_MONOTONIC);                                                                                 \
        statement;                                                                                                                         \
        s->phase_seconds[phase] += ab_seconds(CLOCK_MONOTONIC) - begin_;                                                                   \
    } while (0)

#endif
