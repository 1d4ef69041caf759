/* test_penalty.c: the response penalty against swings, bounces and hysteresis in closed form, its account of energy, and friction that falls where a point slips, of
 * penalty and of coulomb. */
#include "response_bench.h"

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

int main(void) {
    bench_find_plugins();
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_a_mass_on_the_spring_swings_with_its_period),
                                       cmocka_unit_test(test_a_spring_is_stable_below_and_unstable_above_its_step),
                                       cmocka_unit_test(test_damping_leaves_what_a_damped_spring_leaves),
                                       cmocka_unit_test(test_a_bounce_keeps_energy_and_damping_takes_some),
                                       cmocka_unit_test(test_rubbing_takes_the_work_of_the_hysteresis_loop),
                                       cmocka_unit_test(test_oblique_bounces_lose_energy),
                                       cmocka_unit_test(test_a_spring_that_nothing_loaded_stops_and_throws_nothing),
                                       cmocka_unit_test(test_no_spring_gives_back_more_than_it_took),
                                       cmocka_unit_test(test_the_answer_rises_with_the_approach_and_not_too_steeply),
                                       cmocka_unit_test(test_a_spring_across_that_becomes_stiffer_keeps_its_energy),
                                       cmocka_unit_test(test_penalty_refuses_what_makes_no_sense),
                                       cmocka_unit_test(test_friction_falls_where_a_point_slips_until_it_is_held),
                                       cmocka_unit_test(test_a_dragged_spring_breaks_at_the_static_limit),
                                       cmocka_unit_test(test_equal_coefficients_are_one)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
