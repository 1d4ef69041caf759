/* check_response_bench.h: contact points that are not coupled with each other, for the promises of a response: a small host that steps them. */
#ifndef AB_CHECK_RESPONSE_BENCH_H
#define AB_CHECK_RESPONSE_BENCH_H

#include "core/check.h"

enum { AB_BENCH_POINTS = 24, AB_BENCH_LD = 32, AB_BENCH_SLACK = 512, AB_BENCH_STATES = 64 * 9, AB_BENCH_STENCIL = 2 };

typedef struct ab_contact_bench {
    ab_points points;
    size_t states;
    uint64_t key[AB_BENCH_LD];
    size_t a_start[AB_BENCH_LD + 1], b_start[AB_BENCH_LD + 1];
    uint32_t a_dof[AB_BENCH_STENCIL * AB_BENCH_LD], b_dof[AB_BENCH_STENCIL * AB_BENCH_LD];
    double a_weight[AB_BENCH_STENCIL * AB_BENCH_LD], b_weight[AB_BENCH_STENCIL * AB_BENCH_LD];
    double position[3 * AB_BENCH_LD + AB_BENCH_SLACK], normal[3 * AB_BENCH_LD + AB_BENCH_SLACK], gap[AB_BENCH_LD + AB_BENCH_SLACK],
        area[AB_BENCH_LD + AB_BENCH_SLACK], distance[AB_BENCH_LD + AB_BENCH_SLACK], stiffness[AB_BENCH_LD + AB_BENCH_SLACK];
    double velocity[3 * AB_BENCH_LD + AB_BENCH_SLACK], velocity_old[3 * AB_BENCH_LD + AB_BENCH_SLACK],
        normal_mass[AB_BENCH_LD + AB_BENCH_SLACK], tangential_mass[AB_BENCH_LD + AB_BENCH_SLACK], impulse[3 * AB_BENCH_LD + AB_BENCH_SLACK];
    double state0[AB_BENCH_STATES * AB_BENCH_LD + AB_BENCH_SLACK], state1[AB_BENCH_STATES * AB_BENCH_LD + AB_BENCH_SLACK];
} ab_contact_bench;

/* Pointers of a bench into its own arrays, after a copy. */
void ab_contact_bench_point(ab_contact_bench *);
/* Points with random normals, places, velocities, gaps and masses. */
void ab_contact_bench_begin(ab_check *, ab_contact_bench *, uint32_t dimension);
int ab_contact_bench_respond(ab_contact_bench *, const ab_check_instance *, size_t first, size_t count);
/* Settings and what point i is given, for a message. */
const char *ab_contact_bench_words(const ab_check *, const ab_contact_bench *, const ab_value *settings, size_t i, char *text, size_t size);
/* One step of the host: rounds until the impulses stand still. False: the response gave up. */
bool ab_contact_bench_step(ab_check *, ab_contact_bench *, const ab_check_instance *, const ab_value *settings);
/* The next step: states, gaps, and what other forces do to the velocities. */
void ab_contact_bench_move_on(ab_check *, ab_contact_bench *, double kick);
/* Points after a few steps, ready to be asked about the next one. */
void ab_contact_bench_prepare(ab_check *, ab_contact_bench *, const ab_check_instance *, const ab_value *settings, uint32_t dimension);
/* Point j of `wanted` and point i of `got`, of rows of `ld`, have the same bits; else the promise is broken. */
void ab_contact_bench_same(ab_check *, const ab_value *settings, const ab_contact_bench *wanted, size_t j, const ab_contact_bench *got,
                           size_t i, size_t ld, const char *what);

typedef void (*ab_contact_bench_each)(ab_check *, const ab_value *, ab_check_instance *, uint32_t dimension);
/* `what` for the first `most` settings, in every space that the class knows. */
void ab_contact_bench_for_all(ab_check *, size_t most, ab_contact_bench_each what);

#endif
