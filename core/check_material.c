/* check_material.c: promises of a material about how it is called: batches, threads, memory, what is handed in. */
#include <math.h>
#include <pthread.h>
#include <string.h>

#include "core/check_bench.h"

static bench one, two; /* large; every promise has a process of its own */

typedef void (*each)(ab_check *, const ab_value *settings, const ab_check_instance *, uint32_t dimension);

/* Calls it for every set of settings and every dimension. */
static void for_all(ab_check *check, size_t most, each what) {
    uint32_t dimension[3];
    bench_dimensions(&check->loaded->class_, dimension);
    for (size_t v = 0; v < check->shared->variants && v < most; v++)
        for (int d = 0; dimension[d]; d++) {
            ab_check_instance instance;
            check->random = 17 + v;
            if (!ab_check_open(check, &instance, check->shared->settings[v], NULL))
                ab_check_fail(check, "create refuses settings that it took before");
            what(check, check->shared->settings[v], &instance, dimension[d]);
            ab_check_close(&instance);
        }
}

typedef struct output {
    const char *name;
    const double *array;
    int rows;
} output;

static void outputs(const bench *b, output list[4]) {
    list[0] = (output){"stress1", b->stress1, b->components};
    list[1] = (output){"state1", b->state1, b->states};
    list[2] = (output){"dissipation", b->dissipation, b->batch.dissipation ? 1 : 0};
    list[3] = (output){"wave_speed", b->speed, b->batch.wave_speed ? 1 : 0};
}

/* Item `i` of a, with an ld of its own, against item `j` of b. */
static void same_bits(ab_check *check, const ab_value *settings, const bench *b, size_t j, const bench *a, size_t i, size_t ld,
                      const char *what) {
    output first[4], second[4];
    char words[500];
    outputs(a, first), outputs(b, second);
    for (int k = 0; k < 4; k++)
        for (int r = 0; r < second[k].rows; r++) {
            const double *x = first[k].array + (size_t)r * ld + i, *y = second[k].array + (size_t)r * BENCH_LD + j;
            if (!memcmp(x, y, sizeof *x)) continue;
            ab_check_fail(check, "row %d of %s is %.17g %s, and %.17g before: %s", r, first[k].name, *x, what, *y,
                          bench_words(check, b, settings, j, words, sizeof words));
        }
}

/* ---- again ------------------------------------------------------------------------------------------------------------------------ */

static void again(ab_check *check, const ab_value *settings, const ab_check_instance *instance, uint32_t dimension) {
    bench_start(check, &one, instance, dimension);
    bench_drive(check, &one, instance, 4);
    bench_increment(check, &one, 1e-4);
    if (bench_update(&one, instance) != 0) return;
    two = one;
    for (int round = 0; round < 3; round++) {
        if (round == 1) { /* something else between */
            bench_increment(check, &two, 1e-4);
            bench_update(&two, instance);
            two = one;
        }
        ab_check_instance other;
        if (round == 2 && !ab_check_open(check, &other, settings, NULL))
            ab_check_fail(check, "create refuses settings that it took before");
        bench_batch(&two, instance, BENCH_ITEMS, 1e-4);
        bench_update(&two, round == 2 ? &other : instance);
        for (size_t i = 0; i < BENCH_ITEMS; i++)
            same_bits(check, settings, &one, i, &two, i, BENCH_LD,
                      round == 0   ? "when asked again"
                      : round == 1 ? "when asked again after other input"
                                   : "from an instance made anew");
        if (round == 2) ab_check_close(&other);
    }
}

static void keep_again(ab_check *check) { for_all(check, 8, again); }

/* ---- batches ---------------------------------------------------------------------------------------------------------------------- */

static void move_rows(double *to, size_t ld, const double *from, size_t first, size_t count, int rows) {
    for (int r = 0; r < rows; r++) memcpy(to + (size_t)r * ld, from + (size_t)r * BENCH_LD + first, count * sizeof *to);
}

static void batches(ab_check *check, const ab_value *settings, const ab_check_instance *instance, uint32_t dimension) {
    static const size_t COUNT[] = {1, 2, 3, 5, 7, 8, 9, 16, 17, 33};
    bench_start(check, &one, instance, dimension);
    bench_drive(check, &one, instance, 4);
    bench_increment(check, &one, 1e-4);
    if (bench_update(&one, instance) != 0) return;
    memset(&two, 0, sizeof two);
    two.dimension = dimension, two.components = one.components, two.gradients = one.gradients, two.states = one.states;
    for (size_t k = 0; k < sizeof COUNT / sizeof *COUNT; k++)
        for (size_t first = 0; first + COUNT[k] <= BENCH_ITEMS; first += COUNT[k] < 4 ? 5 : COUNT[k]) {
            const size_t count = COUNT[k], lds[3] = {count, (count + 7) / 8 * 8, BENCH_LD};
            for (int l = 0; l < 3; l++) {
                const size_t ld = lds[l];
                bench_batch(&two, instance, count, 1e-4);
                two.batch.ld = ld;
                move_rows(two.strain, ld, one.strain, first, count, one.components);
                move_rows(two.F, ld, one.F, first, count, one.gradients);
                move_rows(two.L, ld, one.L, first, count, dimension == 2 ? 4 : 9);
                move_rows(two.stress0, ld, one.stress0, first, count, one.components);
                move_rows(two.state0, ld, one.state0, first, count, one.states);
                move_rows(two.density, ld, one.density, first, count, 1);
                char what[100];
                snprintf(what, sizeof what, "in a batch of %zu with ld %zu", count, ld);
                ab_check_trying(check, "update %s", what);
                if (bench_update(&two, instance) != 0)
                    ab_check_fail(check, "%s it gives up on items that it took in a batch of %d", what, BENCH_ITEMS);
                for (size_t i = 0; i < count; i++) same_bits(check, settings, &one, first + i, &two, i, ld, what);
            }
        }
}

static void keep_batches(ab_check *check) { for_all(check, 8, batches); }

/* ---- threads ---------------------------------------------------------------------------------------------------------------------- */

enum { THREADS = 4, ROUNDS = 60 };

typedef struct worker {
    pthread_t thread;
    const ab_check_instance *instance;
    bench mine, wanted;
    bool differs;
    size_t item;
    pthread_barrier_t *barrier;
} worker;

static void *work(void *data) {
    worker *w = data;
    for (int round = 0; round < ROUNDS; round++) {
        pthread_barrier_wait(w->barrier);
        for (int twice = 0; twice < 4; twice++) {
            bench_update(&w->mine, w->instance);
            output got[4], wanted[4];
            outputs(&w->mine, got), outputs(&w->wanted, wanted);
            for (int k = 0; k < 4; k++)
                for (int r = 0; r < wanted[k].rows; r++)
                    if (!w->differs && memcmp(got[k].array + r * BENCH_LD, wanted[k].array + r * BENCH_LD, BENCH_ITEMS * sizeof(double)))
                        w->differs = true;
        }
    }
    return NULL;
}

static void threads(ab_check *check, const ab_value *settings, const ab_check_instance *instance, uint32_t dimension) {
    static worker workers[THREADS];
    pthread_barrier_t barrier;
    if (pthread_barrier_init(&barrier, NULL, THREADS) != 0) ab_check_skip(check, "no threads could be started");
    for (int t = 0; t < THREADS; t++) {
        worker *w = workers + t;
        *w = (worker){.instance = instance, .barrier = &barrier};
        bench_start(check, &w->mine, instance, dimension);
        bench_drive(check, &w->mine, instance, 2 + t);
        bench_increment(check, &w->mine, 1e-4);
        bench_update(&w->mine, instance);
        w->wanted = w->mine;
        bench_batch(&w->mine, instance, BENCH_ITEMS, 1e-4); /* pointers into this copy */
    }
    ab_check_trying(check, "update from %d threads at once", THREADS);
    for (int t = 0; t < THREADS; t++)
        if (pthread_create(&workers[t].thread, NULL, work, workers + t) != 0) ab_check_skip(check, "no threads could be started");
    for (int t = 0; t < THREADS; t++) pthread_join(workers[t].thread, NULL);
    char words[400];
    for (int t = 0; t < THREADS; t++)
        if (workers[t].differs)
            ab_check_fail(
                check,
                "other bits when %d threads call update at once with batches of their own (something is kept outside of the states?): %s",
                THREADS, ab_check_words(check, settings, words, sizeof words));
    pthread_barrier_destroy(&barrier);
}

static void keep_threads(ab_check *check) { for_all(check, 2, threads); }

/* ---- what is not asked for --------------------------------------------------------------------------------------------------------- */

static void unasked(ab_check *check, const ab_value *settings, const ab_check_instance *instance, uint32_t dimension) {
    const uint32_t needs = check->loaded->class_.needs;
    bench_start(check, &one, instance, dimension);
    bench_drive(check, &one, instance, 3);
    bench_increment(check, &one, 1e-4);
    if (bench_update(&one, instance) != 0) return;
    two = one;
    for (int speed = 1; speed >= 0; speed--) {
        bench_batch(&two, instance, BENCH_ITEMS, 1e-4);
        if (!(needs & AB_NEED_DEFORMATION_GRADIENT)) two.batch.deformation_gradient = NULL;
        if (!(needs & AB_NEED_VELOCITY_GRADIENT)) two.batch.velocity_gradient = NULL;
        if (!speed) two.batch.wave_speed = NULL;
        if (!speed && !(needs & AB_NEED_DENSITY)) two.batch.density = NULL;
        ab_check_trying(check, "update with NULL for %s%s%s%s", speed ? "" : "wave_speed ", two.batch.density ? "" : "density ",
                        two.batch.deformation_gradient ? "" : "deformation_gradient ",
                        two.batch.velocity_gradient ? "" : "velocity_gradient");
        if (bench_update(&two, instance) != 0)
            ab_check_fail(check, "it gives up without what it did not ask for: %s", instance->service.message);
        for (size_t i = 0; i < BENCH_ITEMS; i++) {
            if (!speed) two.speed[i] = one.speed[i];
            two.batch.wave_speed = NULL;
            same_bits(check, settings, &one, i, &two, i, BENCH_LD, "without what it did not ask for");
        }
    }
}

static void keep_unasked(ab_check *check) { for_all(check, 8, unasked); }

/* ---- memory: under guard ---------------------------------------------------------------------------------------------------------- */

static void guarded(ab_check *check, ab_promise promise) {
    static const size_t COUNT[] = {48, 1, 3, 7, 8, 9, 16, 33};
    uint32_t dimension[3];
    bench_dimensions(&check->loaded->class_, dimension);
    for (size_t v = 0; v < check->shared->variants && v < 4; v++)
        for (int d = 0; dimension[d]; d++) {
            ab_check_instance plain, instance;
            ab_loaded_class guard;
            const ab_value *settings = check->shared->settings[v];
            if (!ab_check_open(check, &plain, settings, NULL) || !ab_check_open(check, &instance, settings, &guard))
                ab_check_fail(check, "create refuses settings that it took before");
            bench_start(check, &one, &plain, dimension[d]);
            bench_drive(check, &one, &plain, 3);
            bench_increment(check, &one, 1e-4);
            for (size_t k = 0; k < sizeof COUNT / sizeof *COUNT; k++)
                for (int tight = 0; tight < 2; tight++) {
                    const size_t count = COUNT[k], ld = tight ? count : (count + 7) / 8 * 8;
                    two = one;
                    bench_batch(&two, &instance, count, 1e-4);
                    two.batch.ld = ld;
                    ab_check_trying(check, "update with a batch of %zu, ld %zu", count, ld);
                    if (bench_update(&two, &instance) != 0 && ab_guard_broken(instance.self) == promise)
                        ab_check_fail(check, "%s", instance.service.message);
                }
            ab_check_close(&instance);
            ab_check_close(&plain);
        }
}

static void keep_old(ab_check *check) { guarded(check, AB_PROMISE_OLD); }
static void keep_arrays(ab_check *check) { guarded(check, AB_PROMISE_ARRAYS); }

/* check_physics.c */
void ab_check_frame(ab_check *);
void ab_check_speed(ab_check *);
void ab_check_finite(ab_check *);
void ab_check_dissipation(ab_check *);

const ab_check_promise ab_check_material[] = {
    {"again", "the same input gives the same bits: asked again, and from an instance made anew", keep_again, true},
    {"batch", "an item has the same bits in a batch of one and in a batch of many, for any ld", keep_batches, false},
    {"threads", "the same bits when several threads call at once", keep_threads, false},
    {"frame", "turned input gives turned output", ab_check_frame, false},
    {"wave-speed", "not slower than its stiffness by differences says", ab_check_speed, false},
    {"old-state", "stress0, state0 and all else that is handed in is not written", keep_old, false},
    {"arrays", "nothing outside of the items is read or written", keep_arrays, false},
    {"unasked", "what it did not ask for may be NULL", keep_unasked, false},
    {"finite", "finite numbers in, finite numbers out, or an error with a reason; every item written", ab_check_finite, false},
    {"dissipation", "what it says is lost is not negative", ab_check_dissipation, false},
    {.name = NULL},
};
