/* test_responses.c: what the responses promise, asked through the interface of plugins with contact points made by hand: answers that stand still when they
 * are asked for again, impulses that never pull and stay inside the friction cone, springs with the period and the stability of springs, work that is
 * never given back over a cycle. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/plugin_host.h"

enum { MOST = 16, ROWS = 4, STATES = 6 }; /* of penalty: elastic_slip, slips, stored, stiffness_across */

typedef struct bench { /* one response and room for contact points */
    ab_report *report;
    ab_registry *registry;
    const ab_loaded_class *loaded;
    ab_service service;
    void *self;
    double position[ROWS * MOST], normal[ROWS * MOST], gap[MOST], area[MOST], velocity[ROWS * MOST], normal_mass[MOST],
        tangential_mass[MOST];
    double impulse[ROWS * MOST], state0[STATES * MOST], state1[STATES * MOST], distance[MOST], stiffness[MOST], velocity_old[ROWS * MOST];
    size_t start[MOST + 1];
    ab_points points;
} bench;

static char built_in[4096];
static uint64_t random_state = 1;

static double uniform(double low, double high) {
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(random_state >> 11) * 0x1p-53;
}

/* Settings by name, then values; the others as declared. */
typedef struct setting {
    const char *name;
    double value;
} setting;

static int create(bench *b, const setting *settings, size_t count) {
    const ab_class *class_ = &b->loaded->class_;
    ab_value values[16] = {{0}};
    for (uint32_t k = 0; k < class_->nparam; k++)
        values[k].real = class_->param[k].initial, values[k].integer = isfinite(values[k].real) ? (int64_t)values[k].real : 0;
    for (size_t s = 0; s < count; s++) {
        bool found = false;
        for (uint32_t k = 0; k < class_->nparam; k++)
            if (!strcmp(class_->param[k].name, settings[s].name)) {
                values[k].real = settings[s].value, values[k].integer = (int64_t)settings[s].value;
                values[k].given = 1;
                found = true;
            }
        assert_true(found);
    }
    return class_->create(&b->service.host, values, &b->self);
}

static bench *open_bench(const char *name) {
    bench *b = calloc(1, sizeof *b);
    b->report = ab_report_create();
    assert_int_equal(ab_registry_create(built_in, &b->registry, b->report), AB_OK);
    b->loaded = ab_registry_find(b->registry, AB_CONTACT, name, AB_NOWHERE, b->report);
    assert_non_null(b->loaded);
    ab_service_init(&b->service, name);
    for (size_t i = 0; i <= MOST; i++) b->start[i] = i; /* every point is a node */
    b->points = (ab_points){.struct_size = sizeof(ab_points),
                            .dimension = 2,
                            .dt = 1e-3,
                            .cell = 1,
                            .count = MOST,
                            .capacity = MOST,
                            .ld = MOST,
                            .a_start = b->start,
                            .b_start = b->start,
                            .position = b->position,
                            .normal = b->normal,
                            .gap = b->gap,
                            .area = b->area,
                            .relative_velocity = b->velocity,
                            .normal_mass = b->normal_mass,
                            .tangential_mass = b->tangential_mass,
                            .impulse = b->impulse,
                            .state0 = b->state0,
                            .state1 = b->state1,
                            .distance = b->distance,
                            .stiffness = b->stiffness,
                            .modulus = 1e3,
                            .relative_velocity_old = b->velocity_old};
    return b;
}

static void close_bench(bench *b) {
    if (b->self) b->loaded->class_.destroy(b->self);
    ab_registry_destroy(b->registry);
    ab_report_destroy(b->report);
    free(b);
}

static void respond(bench *b) { assert_int_equal(b->loaded->contact.respond(b->self, &b->points, 0, b->points.count), 0); }

/* Applies what the impulses have become to the relative velocities. */
static void apply(bench *b, double before[ROWS * MOST]) {
    const size_t ld = b->points.ld, d = b->points.dimension;
    for (size_t i = 0; i < b->points.count; i++) {
        double along = 0;
        for (size_t c = 0; c < d; c++) along += (b->impulse[c * ld + i] - before[c * ld + i]) * b->normal[c * ld + i];
        for (size_t c = 0; c < d; c++) {
            const double n = along * b->normal[c * ld + i], t = b->impulse[c * ld + i] - before[c * ld + i] - n;
            b->velocity[c * ld + i] -= n / b->normal_mass[i] + t / b->tangential_mass[i];
        }
    }
    memcpy(before, b->impulse, sizeof b->impulse);
}

/* What the spring of point i holds, J/m. */
static double *stored(double *state, const bench *b, size_t i) { return state + (b->points.dimension + 1) * MOST + i; }

static double along(const bench *b, const double *rows, size_t i) {
    double sum = 0;
    for (size_t c = 0; c < b->points.dimension; c++) sum += rows[c * MOST + i] * b->normal[c * MOST + i];
    return sum;
}

/* Points of any kind: apart, deep, meeting, leaving. */
static void scramble(bench *b, uint32_t dimension) {
    b->points.dimension = dimension;
    memset(b->impulse, 0, sizeof b->impulse);
    for (size_t i = 0; i < MOST; i++) {
        double length = 0;
        for (size_t c = 0; c < dimension; c++) b->normal[c * MOST + i] = uniform(-1, 1);
        for (size_t c = 0; c < dimension; c++) length += b->normal[c * MOST + i] * b->normal[c * MOST + i];
        for (size_t c = 0; c < dimension; c++) {
            b->normal[c * MOST + i] /= sqrt(length);
            b->velocity[c * MOST + i] = uniform(-2, 2);
            b->velocity_old[c * MOST + i] = uniform(-2, 2);
            b->state0[c * MOST + i] = uniform(-1e-4, 1e-4);
        }
        b->gap[i] = uniform(-2e-3, 1e-3);
        b->area[i] = uniform(0.1, 1);
        b->normal_mass[i] = b->tangential_mass[i] = uniform(0.1, 3);
        b->distance[i] = uniform(0, 1.2);
        *stored(b->state0, b, i) = uniform(-1, 1); /* half of the springs hold nothing */
        if (*stored(b->state0, b, i) < 0) *stored(b->state0, b, i) = 0;
        b->state0[(dimension + 2) * MOST + i] = uniform(0, 1e6);
    }
}

static const setting penalty_mass[] = {{"stiffness", 0.5}, {"damping", 0.3}, {"friction", 0.4}};
static const setting penalty_modulus[] = {{"stiffness_of", 1}, {"stiffness", 20}, {"damping", 0.3}, {"friction", 0.4}, {"tangential", 0.5}};
static const setting fading[] = {{"friction", 0.4}};
static const struct law {
    const char *name;
    const setting *settings;
    size_t count;
} LAWS[] = {{"penalty", penalty_mass, 3}, {"penalty", penalty_modulus, 5}, {"penalty", NULL, 0}, {"distance-power", fading, 1}};
enum { LAW_COUNT = sizeof LAWS / sizeof *LAWS };

/* ---- every law ----------------------------------------------------------------------------------------------------------------------- */

static void test_the_answer_stands_still_when_it_is_asked_for_again(void **state) {
    (void)state;
    for (int l = 0; l < LAW_COUNT; l++) {
        bench *b = open_bench(LAWS[l].name);
        assert_int_equal(create(b, LAWS[l].settings, LAWS[l].count), 0);
        for (int round = 0; round < 100; round++) {
            scramble(b, 2 + (uint32_t)round % 2);
            double before[ROWS * MOST] = {0}, first[ROWS * MOST], state1[STATES * MOST], largest = 0;
            respond(b);
            memcpy(first, b->impulse, sizeof first);
            memcpy(state1, b->state1, sizeof state1);
            apply(b, before);
            for (int again = 0; again < 5; again++) {
                respond(b);
                apply(b, before);
            }
            for (size_t k = 0; k < ROWS * MOST; k++) largest = fmax(largest, fabs(first[k]));
            for (size_t k = 0; k < ROWS * MOST; k++) assert_true(fabs(b->impulse[k] - first[k]) <= 1e-13 * largest);
            for (size_t k = 0; k < STATES * MOST; k++) /* slips to 1e-16 m, what is stored to 1e-13 J/m */
                assert_true(fabs(b->state1[k] - state1[k]) <= (k < b->points.dimension * MOST ? 1e-16 : 1e-13 * fmax(1, fabs(state1[k]))));
        }
        close_bench(b);
    }
}

static void test_impulses_never_pull_and_stay_in_the_friction_cone(void **state) {
    (void)state;
    for (int l = 0; l < LAW_COUNT; l++) {
        bench *b = open_bench(LAWS[l].name);
        assert_int_equal(create(b, LAWS[l].settings, LAWS[l].count), 0);
        const double mu = LAWS[l].settings ? 0.4 : 0;
        int pushed = 0;
        for (int round = 0; round < 200; round++) {
            scramble(b, 2 + (uint32_t)round % 2);
            double v0[ROWS * MOST], before[ROWS * MOST] = {0};
            memcpy(v0, b->velocity, sizeof v0);
            respond(b);
            apply(b, before);
            for (size_t i = 0; i < MOST; i++) {
                const double n = along(b, b->impulse, i);
                double across = 0, slip = 0;
                assert_true(n >= 0);
                pushed += n > 0;
                for (size_t c = 0; c < b->points.dimension; c++) {
                    const double t = b->impulse[c * MOST + i] - n * b->normal[c * MOST + i];
                    across += t * t;
                    slip += t * b->velocity[c * MOST + i];
                }
                if (!(sqrt(across) <= mu * n + 1e-13 * fmax(n, 1)))
                    fail_msg("%s: %.17g across, %.17g allowed", LAWS[l].name, sqrt(across), mu * n);
                if (strcmp(LAWS[l].name,
                           "penalty")) { /* what has no memory meets the slip that is left; a spring may push back for a while */
                    assert_true(slip >= -1e-13);
                    double energy = 0; /* of the two masses, before and after: never more */
                    for (size_t c = 0; c < b->points.dimension; c++)
                        energy += b->normal_mass[i] * (pow(b->velocity[c * MOST + i], 2) - pow(v0[c * MOST + i], 2));
                    assert_true(energy <= 1e-13);
                } else if (b->gap[i] >= 0)
                    assert_true(n == 0 && across == 0);
            }
        }
        assert_true(pushed > 100);
        close_bench(b);
    }
}

/* A turned scene gives the turned answer. */
static void test_turned_points_give_turned_answers(void **state) {
    (void)state;
    for (int l = 0; l < LAW_COUNT; l++) {
        bench *b = open_bench(LAWS[l].name);
        assert_int_equal(create(b, LAWS[l].settings, LAWS[l].count), 0);
        scramble(b, 2);
        respond(b);
        double straight[ROWS * MOST], slip[ROWS * MOST];
        memcpy(straight, b->impulse, sizeof straight);
        memcpy(slip, b->state1, sizeof slip);
        const double c = cos(0.7), s = sin(0.7);
        double *const vectors[4] = {b->normal, b->velocity, b->velocity_old, b->state0};
        for (int k = 0; k < 4; k++)
            for (size_t i = 0; i < MOST; i++) {
                const double x = vectors[k][i], y = vectors[k][MOST + i];
                vectors[k][i] = c * x - s * y, vectors[k][MOST + i] = s * x + c * y;
            }
        memset(b->impulse, 0, sizeof b->impulse);
        respond(b);
        const bool remembers = b->loaded->class_.nstate > 0;
        for (size_t i = 0; i < MOST; i++) {
            assert_true(fabs(b->impulse[i] - (c * straight[i] - s * straight[MOST + i])) < 1e-13);
            assert_true(fabs(b->impulse[MOST + i] - (s * straight[i] + c * straight[MOST + i])) < 1e-13);
            if (remembers) assert_true(fabs(b->state1[i] - (c * slip[i] - s * slip[MOST + i])) < 1e-16);
        }
        close_bench(b);
    }
}

/* ---- coulomb ----------------------------------------------------------------------------------------------------------------------- */

/* An overlap is taken back within `recovery` steps where it is slight, by 2e-4 of a cell a step where it is deep: a corner that reaches a new node is not thrown. */
static void test_coulomb_takes_an_overlap_back_slowly(void **state) {
    (void)state;
    static const setting four[] = {{"recovery", 4}};
    bench *b = open_bench("coulomb");
    assert_int_equal(create(b, four, 1), 0);
    static const double deep[] = {1e-6, 1e-4, 1e-3, 0.4}; /* cells */
    for (size_t k = 0; k < sizeof deep / sizeof *deep; k++) {
        scramble(b, 2);
        b->points.count = 1;
        b->gap[0] = -deep[k] * b->points.cell;
        b->velocity[0] = b->velocity[MOST] = 0;
        respond(b);
        const double way = fmin(deep[k] / 4, 2e-4) * b->points.cell;
        assert_true(fabs(along(b, b->impulse, 0) / (b->normal_mass[0] * way / b->points.dt) - 1) < 1e-12);
    }
    b->points.count = MOST;
    close_bench(b);
}

/* In tension a point holds on to what it touches and does not shut what is open between them. */
static void test_coulomb_pulls_no_further_than_to_a_stop(void **state) {
    (void)state;
    static const setting glue[] = {{"adhesion", 1e9}, {"tensile_strength", 1e9}};
    bench *b = open_bench("coulomb");
    assert_int_equal(create(b, glue, 2), 0);
    for (int round = 0; round < 100; round++) {
        scramble(b, 2);
        for (size_t i = 0; i < MOST; i++) b->gap[i] = uniform(0, 9e-4) * b->points.cell;
        double before[ROWS * MOST] = {0}, approach[MOST];
        for (size_t i = 0; i < MOST; i++) approach[i] = along(b, b->velocity, i);
        respond(b);
        apply(b, before);
        for (size_t i = 0; i < b->points.count; i++) {
            const double end = along(b, b->velocity, i), closes = b->gap[i] / b->points.dt;
            if (approach[i] < 0)
                assert_true(fabs(end) < 1e-9 * fabs(approach[i])); /* it has stopped */
            else
                assert_true(fabs(end - fmin(approach[i], closes)) < 1e-9 * (1 + closes)); /* it goes on until it touches */
        }
    }
    close_bench(b);
}

/* ---- penalty -------------------------------------------------------------------------------------------------------------------------- */

/* One mass pressed onto a loaded spring by a steady force, at rest in the middle but for a small kick. Returns the largest of |x - middle| in the last fifth of the
 * steps over that in the first; *period: of the crossings, s. */
static double swing(bench *b, double dt, int steps, double m, double k, double *period) {
    b->points.count = 1;
    b->points.dt = dt;
    b->normal[0] = 1, b->normal[MOST] = 0;
    b->area[0] = 0.5;
    b->normal_mass[0] = b->tangential_mass[0] = m;
    const double middle = 1e-2, force = k * middle;
    double x = middle, v = 1e-6 * sqrt(k / m), first = 0, last = 0, crossed = -1;
    int crossings = 0;
    memset(b->state0, 0, sizeof b->state0);
    *stored(b->state0, b, 0) = k * middle * middle / 2;
    for (int n = 0; n < steps; n++) {
        const double old = x;
        b->velocity_old[0] = v, b->velocity_old[MOST] = 0;
        v += force * dt / m;
        b->gap[0] = -x;
        b->velocity[0] = v, b->velocity[MOST] = 0;
        b->impulse[0] = b->impulse[MOST] = 0;
        b->stiffness[0] = 0;
        respond(b);
        v -= b->impulse[0] / m;
        x += dt * v;
        memcpy(b->state0, b->state1, sizeof b->state0);
        if (n < steps / 5) first = fmax(first, fabs(x - middle));
        if (n >= steps - steps / 5) last = fmax(last, fabs(x - middle));
        if (old < middle && x >= middle) {
            const double at = (n + (middle - old) / (x - old)) * dt;
            if (crossed >= 0) ++crossings;
            if (crossings == 0) crossed = at;
            if (crossings) *period = (at - crossed) / crossings;
        }
    }
    return last / first;
}

static void test_a_mass_on_the_spring_swings_with_its_period(void **state) {
    (void)state;
    bench *b = open_bench("penalty");
    const setting settings[] = {{"stiffness_of", 1}, {"stiffness", 20}, {"damping", 0}};
    assert_int_equal(create(b, settings, 3), 0);
    const double k = 20 * 1e3 / 1 * 0.5, m = 1.2, period = 2 * 3.14159265358979324 * sqrt(m / k); /* E/h times area */
    double seen = 0;
    assert_true(fabs(swing(b, period / 100, 2000, m, k, &seen) - 1) < 1e-2);
    print_message("period %.9g s, of sqrt(m/k): %.9g s\n", seen, period);
    assert_true(fabs(seen / period - 1) < 2e-4); /* asin(w dt/2)/(w dt/2): 1.6e-4 */
    assert_true(b->stiffness[0] == k);
    close_bench(b);
}

static void test_a_spring_is_stable_below_and_unstable_above_its_step(void **state) {
    (void)state;
    bench *b = open_bench("penalty");
    const setting settings[] = {{"stiffness_of", 1}, {"stiffness", 20}, {"damping", 0}};
    assert_int_equal(create(b, settings, 3), 0);
    const double k = 20 * 1e3 / 1 * 0.5, m = 1.2, limit = 2 * sqrt(m / k);
    double period;
    assert_true(swing(b, 0.995 * limit, 20000, m, k, &period) < 1.01);
    assert_true(swing(b, 1.005 * limit, 50, m, k, &period) > 50);
    close_bench(b);

    b = open_bench("penalty"); /* of mass: for any dt */
    const setting most[] = {{"stiffness", 1}, {"damping", 0}};
    assert_int_equal(create(b, most, 2), 0);
    for (double dt = 1e-6; dt < 10; dt *= 10) assert_true(swing(b, dt, 1000, m, m / (dt * dt), &period) < 1.01);
    assert_true(b->stiffness[0] == 0); /* so that the host does not chase its own dt */
    close_bench(b);
}

static void test_damping_leaves_what_a_damped_spring_leaves(void **state) {
    (void)state;
    bench *b = open_bench("penalty");
    const setting settings[] = {{"stiffness_of", 1}, {"stiffness", 20}, {"damping", 0.05}};
    assert_int_equal(create(b, settings, 3), 0);
    const double k = 20 * 1e3 / 1 * 0.5, m = 1.2, w = sqrt(k / m), period = 2 * 3.14159265358979324 / w;
    double seen;
    const double left = swing(b, period / 2000, 10000, m, k, &seen); /* of the first period, in the fifth */
    print_message("left after four periods: %.5f, of exp(-zeta w t): %.5f\n", left, exp(-0.05 * w * 4 * period));
    assert_true(fabs(left / exp(-0.05 * w * 4 * period) - 1) < 0.01);
    close_bench(b);
}

/* A mass thrown onto the spring comes back with the speed it had, to what a step of that length can tell; with damping slower, and it is never pulled. */
static void test_a_bounce_keeps_energy_and_damping_takes_some(void **state) {
    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        bench *b = open_bench("penalty");
        const setting settings[] = {{"stiffness_of", 1}, {"stiffness", 20}, {"damping", damped ? 0.2 : 0}};
        assert_int_equal(create(b, settings, 3), 0);
        b->points.count = 1;
        b->normal[0] = 1;
        b->area[0] = 0.5;
        const double m = b->normal_mass[0] = b->tangential_mass[0] = 1.2, w = sqrt(1e4 / m), dt = b->points.dt = 0.1 / w;
        for (int start = 0; start < 20; start++) {
            double x = -dt * start / 20.0, v = 1;
            memset(b->state0, 0, sizeof b->state0);
            do {
                b->gap[0] = -x;
                b->velocity[0] = b->velocity_old[0] = v;
                b->impulse[0] = 0;
                respond(b);
                assert_true(b->impulse[0] >= 0);
                v -= b->impulse[0] / m;
                x += dt * v;
                memcpy(b->state0, b->state1, sizeof b->state0);
            } while (x > 0 || v > 0);
            if (damped)
                assert_true(v < 0 && v > -0.7);
            else
                assert_true(v * v <= 1 + 1e-12 &&
                            v * v >= 1 - 0.25 * 0.1 * 0.1 * 1.01); /* (w dt)^2/4: where between two steps it met and left the spring */
        }
        close_bench(b);
    }
}

/* A block under a steady load rubbed to and fro: each cycle takes 4 mu N (S - mu N/k), S the amplitude and mu N/k the spring's stretch at the limit. */
static void test_rubbing_takes_the_work_of_the_hysteresis_loop(void **state) {
    (void)state;
    bench *b = open_bench("penalty");
    const setting settings[] = {{"stiffness_of", 1}, {"stiffness", 20}, {"friction", 0.3}, {"tangential", 0.5}, {"damping", 0}};
    assert_int_equal(create(b, settings, 5), 0);
    const double k = 1e4, depth = 1e-3, n = k * depth, stretch = 0.3 * n / (0.5 * k), S = 5e-3, m = 1e9;
    const int steps = 20000;
    b->points.count = 1;
    b->area[0] = 0.5;
    b->gap[0] = -depth;
    b->normal_mass[0] = b->tangential_mass[0] = m; /* the motion is given */
    double work = 0, least = 0, u = 0;
    memset(b->state0, 0, sizeof b->state0);
    *stored(b->state0, b, 0) = k * depth * depth / 2;
    for (int step = 0; step < 3 * steps; step++) {
        const double dt = b->points.dt = 1.0 / steps, next = S * sin(2 * 3.14159265358979324 * (step + 1) * dt), v = (next - u) / dt;
        const double angle = 2 * 3.14159265358979324 * step * dt; /* while the pair of bodies turns as a whole */
        b->normal[0] = cos(angle), b->normal[MOST] = sin(angle);
        b->velocity[0] = -v * sin(angle), b->velocity[MOST] = v * cos(angle);
        b->impulse[0] = b->impulse[MOST] = 0;
        respond(b);
        const double t = b->impulse[MOST] * cos(angle) - b->impulse[0] * sin(angle);
        assert_true(fabs(b->impulse[0] * cos(angle) + b->impulse[MOST] * sin(angle) - n * dt) < 1e-12);
        if (step >= steps) work += t * v; /* the first cycle loads the spring */
        least = fmin(least, work);
        u = next;
        memcpy(b->state0, b->state1, sizeof b->state0);
    }
    const double expected = 2 * 4 * 0.3 * n * (S - stretch);
    print_message("two cycles take %.6g J, of the loop %.6g J\n", work, expected);
    assert_true(fabs(work / expected - 1) < 2e-3);
    close_bench(b);
}

/* Bodies that fly together obliquely, rub and part: never more energy than before. */
static void test_oblique_bounces_lose_energy(void **state) {
    (void)state;
    bench *b = open_bench("penalty");
    const setting settings[] = {{"stiffness", 0.05}, {"friction", 0.5}, {"damping", 0}};
    assert_int_equal(create(b, settings, 3), 0);
    b->points.count = 1;
    b->normal[0] = 1, b->normal[MOST] = 0;
    const double m = b->normal_mass[0] = b->tangential_mass[0] = 1.2, dt = b->points.dt;
    double kept = 0;
    for (int angle = 0; angle < 80; angle++) {
        double x[2] = {-0.3 * dt, 0}, v[2] = {cos(angle * 0.0175), sin(angle * 0.0175)};
        memset(b->state0, 0, sizeof b->state0);
        for (int step = 0; x[0] > 0 || v[0] > 0; step++) {
            b->gap[0] = -x[0];
            for (int c = 0; c < 2; c++) b->velocity[c * MOST] = b->velocity_old[c * MOST] = v[c], b->impulse[c * MOST] = 0;
            respond(b);
            for (int c = 0; c < 2; c++) v[c] -= b->impulse[c * MOST] / m, x[c] += dt * v[c];
            memcpy(b->state0, b->state1, sizeof b->state0);
            assert_true(step < 1000);
        }
        kept = fmax(kept, v[0] * v[0] + v[1] * v[1]);
    }
    print_message("at most %.4f of the energy is kept\n", kept);
    assert_true(kept <= 1 + 0.25 * 0.05);
    close_bench(b);
}

/* Bodies deep in each other that nothing has pressed there: what approaches is stopped, what rests or leaves is left alone. */
static void test_a_spring_that_nothing_loaded_stops_and_throws_nothing(void **state) {
    (void)state;
    bench *b = open_bench("penalty");
    const setting settings[] = {{"stiffness", 1}};
    assert_int_equal(create(b, settings, 1), 0);
    b->points.count = 3;
    const double v[3] = {0.7, 0, -0.3}, m = 1.2;
    for (size_t i = 0; i < 3; i++) {
        b->normal[i] = 1;
        b->gap[i] = -0.1; /* a push of 120 m/s */
        b->area[i] = 0.5;
        b->normal_mass[i] = b->tangential_mass[i] = m;
        b->velocity[i] = b->velocity_old[i] = v[i];
    }
    respond(b);
    for (size_t i = 0; i < 3; i++) assert_true(fabs(b->impulse[i] - m * fmax(0, v[i])) < 1e-15);
    assert_true(fabs(*stored(b->state1, b, 0) - m * v[0] * v[0] / 2) < 1e-15); /* and what was taken can come back */
    memcpy(b->state0, b->state1, sizeof b->state0);
    for (size_t i = 0; i < 3; i++) b->velocity[i] = b->velocity_old[i] = 0, b->impulse[i] = 0;
    respond(b);
    assert_true(fabs(b->impulse[0] - m * v[0]) < 1e-14 && b->impulse[1] == 0 && b->impulse[2] == 0);
    assert_true(fabs(*stored(b->state1, b, 0)) < 1e-15);
    close_bench(b);
}

/* Whatever gaps, masses, faces and steps do (nodes of a grid come and go), and whatever forces act: the work that a spring has taken is never below zero. */
static void test_no_spring_gives_back_more_than_it_took(void **state) {
    (void)state;
    for (int l = 0; l < 3; l++) {
        bench *b = open_bench("penalty");
        assert_int_equal(create(b, LAWS[l].settings, LAWS[l].count), 0);
        random_state = 11;
        double work[MOST] = {0}, most = 0;
        scramble(b, 2);
        memset(b->state0, 0, sizeof b->state0);
        for (int step = 0; step < 3000; step++) {
            b->points.dt = uniform(0.5e-3, 2e-3);
            memset(b->impulse, 0, sizeof b->impulse);
            for (size_t i = 0; i < MOST; i++) {
                b->gap[i] = fmin(2e-4, fmax(-2e-3, b->gap[i] - b->points.dt * along(b, b->velocity, i) + uniform(-2e-4, 2e-4)));
                b->normal_mass[i] = b->tangential_mass[i] = fmax(0.01, b->normal_mass[i] * uniform(0.8, 1.24));
                b->area[i] = fmax(0.01, b->area[i] * uniform(0.8, 1.24));
                for (size_t c = 0; c < 2; c++) {
                    const size_t k = c * MOST + i;
                    b->velocity_old[k] = b->velocity[k];
                    b->velocity[k] = 0.9 * b->velocity[k] + uniform(-0.3, 0.3);
                }
            }
            double before[ROWS * MOST] = {0};
            respond(b);
            apply(b, before);
            for (size_t i = 0; i < MOST; i++) {
                work[i] += along(b, b->impulse, i) * (along(b, b->velocity, i) + along(b, b->velocity_old, i)) / 2;
                most = fmax(most, work[i]);
                assert_true(work[i] >= -1e-12 && work[i] >= *stored(b->state1, b, i) - 1e-9 * most);
                assert_true(*stored(b->state1, b, i) >= 0 && (b->gap[i] < 0 || *stored(b->state1, b, i) == 0));
            }
            memcpy(b->state0, b->state1, sizeof b->state0);
        }
        close_bench(b);
    }
}

/* The host's rounds need it: an approach that is faster by dv is answered by an impulse that is larger, by at most m dv. */
static void test_the_answer_rises_with_the_approach_and_not_too_steeply(void **state) {
    (void)state;
    for (int l = 0; l < 3; l++) {
        bench *b = open_bench("penalty");
        assert_int_equal(create(b, LAWS[l].settings, LAWS[l].count), 0);
        for (int round = 0; round < 300; round++) {
            scramble(b, 2);
            double last[MOST];
            const double dv = 1e-2;
            for (int k = -200; k <= 200; k++) {
                memset(b->impulse, 0, sizeof b->impulse);
                for (size_t i = 0; i < MOST; i++)
                    for (size_t c = 0; c < 2; c++) b->velocity[c * MOST + i] = k * dv * b->normal[c * MOST + i];
                respond(b);
                for (size_t i = 0; i < MOST; i++) {
                    const double now = along(b, b->impulse, i), rise = now - last[i];
                    if (k > -200) assert_true(rise >= -1e-13 && rise <= b->normal_mass[i] * dv * (1 + 1e-9) + 1e-13);
                    last[i] = now;
                }
            }
        }
        close_bench(b);
    }
}

/* Dragged across at a light node, which then becomes heavy: the spring gives back what it took and no more, however stiff it has become. */
static void test_a_spring_across_that_becomes_stiffer_keeps_its_energy(void **state) {
    (void)state;
    bench *b = open_bench("penalty");
    const setting settings[] = {{"stiffness", 0.01}, {"friction", 1e3}, {"damping", 0}};
    assert_int_equal(create(b, settings, 3), 0);
    b->points.count = 1;
    b->normal[0] = 1, b->normal[MOST] = 0;
    b->gap[0] = -1;
    *stored(b->state0, b, 0) = 1e9;
    double work = 0, loaded = 0, least = INFINITY, v = 0;
    for (int step = 0; step < 400; step++) {
        const double m = b->normal_mass[0] = b->tangential_mass[0] = step < 100 ? 1 : 50;
        b->velocity_old[MOST] = v;
        if (step < 100) v = 0.1; /* dragged; then let go */
        if (step == 100) v = 0, loaded = work;
        b->velocity[MOST] = v;
        b->impulse[0] = b->impulse[MOST] = 0;
        respond(b);
        v -= b->impulse[MOST] / m;
        work += b->impulse[MOST] * (v + b->velocity_old[MOST] * (step != 100)) / 2;
        memcpy(b->state0, b->state1, sizeof b->state0);
        if (step >= 100) least = fmin(least, work);
    }
    print_message("dragged by %.4g J, it keeps %.2g J when it is slack\n", loaded, least);
    assert_true(loaded > 0 && fabs(least) < 0.02 * loaded);
    close_bench(b);
}

static void test_penalty_refuses_what_makes_no_sense(void **state) {
    (void)state;
    bench *b = open_bench("penalty");
    const setting stiff[] = {{"stiffness", 1.5}};
    assert_true(create(b, stiff, 1) != 0);
    assert_non_null(strstr(b->service.message, "stiffness_of: modulus"));
    const setting modulus[] = {{"stiffness_of", 1}, {"stiffness", 1.5}};
    assert_int_equal(create(b, modulus, 2), 0);
    b->points.count = 1;
    b->points.modulus = INFINITY;
    assert_true(b->loaded->contact.respond(b->self, &b->points, 0, 1) < 0);
    assert_non_null(strstr(b->service.message, "rigid"));
    close_bench(b);
}

/* ---- kinetic friction ----------------------------------------------------------------------------------------------------------------- */

/* A point under a steady normal impulse of 1, pulled across it with what each step says: what it takes, and whether it slips afterwards. */
static void test_friction_falls_where_a_point_slips_until_it_is_held(void **state) {
    (void)state;
    static const struct {
        double pull, taken;
        int slips;
    } step[] = {{0.49, 0.49, 0}, {0.5, 0.5, 0},   {0.51, 0.5, 1}, {0.49, 0.3, 1},  {-0.31, -0.3, 1},
                {0.3, 0.3, 0},   {0.45, 0.45, 0}, {5, 0.5, 1},    {0.29, 0.29, 0}, {-0.5, -0.5, 0}};
    bench *b = open_bench("coulomb");
    const setting settings[] = {{"friction", 0.5}, {"kinetic_friction", 0.3}};
    assert_int_equal(create(b, settings, 2), 0);
    const double n[2] = {0.6, 0.8}, m = 1.7;
    b->points.count = 1;
    b->normal[0] = n[0], b->normal[MOST] = n[1];
    b->normal_mass[0] = b->tangential_mass[0] = m;
    for (size_t k = 0; k < sizeof step / sizeof *step; k++) {
        b->velocity[0] = (n[0] - step[k].pull * n[1]) / m, b->velocity[MOST] = (n[1] + step[k].pull * n[0]) / m;
        double before[ROWS * MOST] = {0};
        b->impulse[0] = b->impulse[MOST] = 0;
        for (int round = 0; round < 3; round++) { /* asked again it says the same */
            respond(b);
            apply(b, before);
            assert_true(fabs(along(b, b->impulse, 0) - 1) < 1e-14);
            assert_true(fabs(b->impulse[MOST] * n[0] - b->impulse[0] * n[1] - step[k].taken) < 1e-14);
            assert_true(b->state1[0] == step[k].slips);
        }
        b->state0[0] = b->state1[0];
    }
    close_bench(b);
}

/* The tangential spring of a point that is dragged along: it holds up to the static limit, then gives way to the kinetic one; at rest it keeps what it carries and
 * takes the static limit again. */
static void test_a_dragged_spring_breaks_at_the_static_limit(void **state) {
    (void)state;
    bench *b = open_bench("penalty");
    const setting settings[] = {{"stiffness_of", 1}, {"stiffness", 20}, {"friction", 0.5}, {"kinetic_friction", 0.3}, {"damping", 0}};
    assert_int_equal(create(b, settings, 5), 0);
    const double k = 1e4, depth = 1e-3, n = k * depth, m = 1e9, dt = b->points.dt = 1e-3;
    b->points.count = 1;
    b->area[0] = 0.5;
    b->gap[0] = -depth;
    b->normal[0] = 1, b->normal[MOST] = 0;
    b->normal_mass[0] = b->tangential_mass[0] = m;
    *stored(b->state0, b, 0) = k * depth * depth / 2;
    for (int step = 0; step < 3000; step++) {
        const double v = step < 1000 || step >= 2000 ? 1e-3 : 0; /* drag, rest, drag: 0.5 N comes to a step's 0.01 N of stretch */
        b->velocity[0] = 0, b->velocity[MOST] = v;
        b->impulse[0] = b->impulse[MOST] = 0;
        respond(b);
        const double force = b->impulse[MOST] / dt / n, since = step < 2000 ? 0.001 * step : 0.3 + 0.001 * (step - 2000);
        const double expected = step < 1000 || step >= 2000 ? since <= 0.5 + 1e-9 ? since : 0.3 : 0.3;
        const bool breaks = fabs(since - 0.5) < 2.5e-3; /* the step in which it gives way carries the static limit */
        if (!breaks && !(fabs(force - expected) < 1e-6))
            fail_msg("step %d: %.9g of the normal force, expected %.9g", step, force, expected);
        assert_true(force <= 0.5 + 1e-12);
        memcpy(b->state0, b->state1, sizeof b->state0);
    }
    close_bench(b);
}

/* Equal coefficients are one coefficient, to the last bit; a kinetic one above the static one is refused. */
static void test_equal_coefficients_are_one(void **state) {
    (void)state;
    static const char *const names[] = {"coulomb", "penalty"};
    for (int l = 0; l < 2; l++) {
        bench *b = open_bench(names[l]);
        const setting settings[] = {{"friction", 0.4}, {"kinetic_friction", 0.4}};
        double impulse[2][ROWS * MOST];
        for (int given = 0; given < 2; given++) {
            assert_int_equal(create(b, settings, given ? 2 : 1), 0);
            random_state = 7;
            scramble(b, 2);
            for (size_t i = 0; i < STATES * MOST; i++) b->state0[i] = 1e-4 * fabs(sin((double)i));
            respond(b);
            memcpy(impulse[given], b->impulse, sizeof b->impulse);
            b->loaded->class_.destroy(b->self);
            b->self = NULL;
        }
        assert_memory_equal(impulse[0], impulse[1], sizeof *impulse);
        const setting wrong[] = {{"friction", 0.4}, {"kinetic_friction", 0.5}};
        assert_true(create(b, wrong, 2) != 0);
        assert_non_null(strstr(b->service.message, "kinetic_friction"));
        close_bench(b);
    }
}

/* ---- distance power ------------------------------------------------------------------------------------------------------------------- */

static void test_the_answer_fades_with_the_distance(void **state) {
    (void)state;
    bench *b = open_bench("distance-power");
    const setting settings[] = {{"friction", 0.2}};
    assert_int_equal(create(b, settings, 1), 0);
    b->points.count = 5;
    b->points.cell = 0.5;
    for (size_t i = 0; i < 5; i++) {
        b->normal[i] = 1, b->normal[MOST + i] = 0;
        b->velocity[i] = 2, b->velocity[MOST + i] = -3;
        b->normal_mass[i] = b->tangential_mass[i] = 1.5;
        b->distance[i] = 0.15 * (double)i; /* 0, 0.3, 0.6, 0.9, 1.2 of a cell */
    }
    respond(b);
    for (size_t i = 0; i < 5; i++) {
        const double part = i == 4 ? 0 : 1 - pow(0.3 * (double)i, 6);
        assert_true(fabs(b->impulse[i] - part * 1.5 * 2) < 1e-14);
        assert_true(fabs(b->impulse[MOST + i] + part * 0.2 * 1.5 * 2) < 1e-14);
    }
    b->points.distance = NULL;
    assert_true(b->loaded->contact.respond(b->self, &b->points, 0, 1) < 0);
    assert_non_null(strstr(b->service.message, "multi-velocity"));
    close_bench(b);
}

int main(void) {
    const char *build = getenv("ABUT_BUILD");
    snprintf(built_in, sizeof built_in, "%s/plugins", build ? build : "../..");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_answer_stands_still_when_it_is_asked_for_again),
        cmocka_unit_test(test_impulses_never_pull_and_stay_in_the_friction_cone),
        cmocka_unit_test(test_turned_points_give_turned_answers),
        cmocka_unit_test(test_a_mass_on_the_spring_swings_with_its_period),
        cmocka_unit_test(test_a_spring_is_stable_below_and_unstable_above_its_step),
        cmocka_unit_test(test_damping_leaves_what_a_damped_spring_leaves),
        cmocka_unit_test(test_a_bounce_keeps_energy_and_damping_takes_some),
        cmocka_unit_test(test_rubbing_takes_the_work_of_the_hysteresis_loop),
        cmocka_unit_test(test_oblique_bounces_lose_energy),
        cmocka_unit_test(test_a_spring_that_nothing_loaded_stops_and_throws_nothing),
        cmocka_unit_test(test_no_spring_gives_back_more_than_it_took),
        cmocka_unit_test(test_the_answer_rises_with_the_approach_and_not_too_steeply),
        cmocka_unit_test(test_a_spring_across_that_becomes_stiffer_keeps_its_energy),
        cmocka_unit_test(test_coulomb_takes_an_overlap_back_slowly),
        cmocka_unit_test(test_coulomb_pulls_no_further_than_to_a_stop),
        cmocka_unit_test(test_penalty_refuses_what_makes_no_sense),
        cmocka_unit_test(test_friction_falls_where_a_point_slips_until_it_is_held),
        cmocka_unit_test(test_a_dragged_spring_breaks_at_the_static_limit),
        cmocka_unit_test(test_equal_coefficients_are_one),
        cmocka_unit_test(test_the_answer_fades_with_the_distance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
