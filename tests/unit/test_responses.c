/* test_responses.c: what every response promises, asked through the interface of plugins with contact points made by hand: answers that stand still when they are asked for
 * again, impulses that never pull and stay inside the friction cone, answers that turn with the points; besides, coulomb and distance-power. Springs: test_penalty.c. */
#include "response_bench.h"

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
    bench_find_plugins();
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_the_answer_stands_still_when_it_is_asked_for_again),
                                       cmocka_unit_test(test_impulses_never_pull_and_stay_in_the_friction_cone),
                                       cmocka_unit_test(test_turned_points_give_turned_answers),
                                       cmocka_unit_test(test_coulomb_takes_an_overlap_back_slowly),
                                       cmocka_unit_test(test_coulomb_pulls_no_further_than_to_a_stop),
                                       cmocka_unit_test(test_the_answer_fades_with_the_distance)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
