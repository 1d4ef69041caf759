/* check_bench.h: items of a material on their way through small strains, for check_material*.c. */
#ifndef AB_CHECK_BENCH_H
#define AB_CHECK_BENCH_H

#include "core/check.h"

enum { BENCH_ITEMS = 48, BENCH_LD = 64, BENCH_ROWS = 9, BENCH_STATES = 576 /* 64 states of 9 numbers */, BENCH_SLACK = 4096 };

typedef struct bench { /* arrays of ld BENCH_LD with room behind them */
    uint32_t dimension;
    int components, states, gradients; /* rows: of stress, of states, of F */
    double strain[BENCH_ROWS * BENCH_LD + BENCH_SLACK], F[BENCH_ROWS * BENCH_LD + BENCH_SLACK], L[BENCH_ROWS * BENCH_LD + BENCH_SLACK];
    double stress0[BENCH_ROWS * BENCH_LD + BENCH_SLACK], stress1[BENCH_ROWS * BENCH_LD + BENCH_SLACK];
    double state0[BENCH_STATES * BENCH_LD + BENCH_SLACK], state1[BENCH_STATES * BENCH_LD + BENCH_SLACK];
    double density[BENCH_LD + BENCH_SLACK], dissipation[BENCH_LD + BENCH_SLACK], speed[BENCH_LD + BENCH_SLACK];
    double amplitude[BENCH_LD]; /* of the strains of an item */
    uint8_t flag[BENCH_LD + BENCH_SLACK];
    ab_batch batch;
} bench;

/* Everything that a batch may have, whether the class asks for it or not: one that reads what it did not ask for is found by the promise of that name. */
void bench_batch(bench *, const ab_check_instance *, size_t count, double dt);
int bench_update(bench *, const ab_check_instance *);
/* Before the first step; then `steps` of random strains, smaller ones where the material gives up. */
void bench_start(ab_check *, bench *, const ab_check_instance *, uint32_t dimension);
void bench_drive(ab_check *, bench *, const ab_check_instance *, int steps);
/* The next increments, of the items' amplitudes: strain, F, L and density from the velocity gradient's symmetric part and a spin. */
void bench_increment(ab_check *, bench *, double dt);
/* What came out becomes what goes in. */
void bench_accept(bench *);
/* Settings, strain and stress of an item, in words. */
const char *bench_words(const ab_check *, const bench *, const ab_value *settings, size_t item, char *text, size_t size);
/* 2, 3: the dimensions that the class is for; 0 ends. */
void bench_dimensions(const ab_class *, uint32_t dimension[3]);

#endif
