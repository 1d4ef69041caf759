/* Norms of a series against numbers worked out by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "core/expect.h"

static char name_text[] = "it";

/* y = values at t = 0, 1, 2, ...; the reference is constant. */
static ab_outcome outcome_of(const char *norm, double reference, double level, double scale, double from, double to, const double *y,
                             int count) {
    ab_expect expect;
    ab_expect_spec spec = {.name = name_text,
                           .norm = (char *)(uintptr_t)norm,
                           .reference = {.value = reference},
                           .from = from,
                           .to = to,
                           .level = level,
                           .tolerance = 0.1,
                           .scale = scale};
    ab_report *report = ab_report_create();
    assert_int_equal(ab_expect_begin(&expect, &spec, report), AB_OK);
    for (int k = 0; k < count; k++)
        if (ab_expect_wants(&expect, k, 1)) ab_expect_sample(&expect, k, y[k]);
    if (ab_expect_wants_last(&expect, count - 1)) ab_expect_sample(&expect, count - 1, y[count - 1]);
    ab_report_destroy(report);
    return ab_expect_end(&expect);
}

static const double hill[] = {0, 1, 3, 2, 0, -1, 0};
enum { N = 7 };

static double value_of(const char *norm, double level) { return outcome_of(norm, 1, level, 0, 0, 100, hill, N).value; }

static void test_numbers_drawn_from_a_series(void **state) {
    (void)state;
    assert_float_equal(value_of("final", 0), 0, 0);
    assert_float_equal(value_of("peak", 0), 3, 0);
    assert_float_equal(value_of("min", 0), -1, 0);
    assert_float_equal(value_of("range", 0), 4, 0);
    assert_float_equal(value_of("time-of-peak", 0), 2, 0);
    assert_float_equal(value_of("integral", 0), 5, 1e-15);
    assert_float_equal(value_of("impulse", 0), 5, 1e-15);
    assert_float_equal(value_of("mean", 0), 5.0 / 6, 1e-15);
    assert_float_equal(value_of("first-above", 0.5), 0.5, 1e-15);
    assert_float_equal(value_of("last-above", 0.5), 3.75, 1e-15);
    assert_float_equal(value_of("duration", 0.5), 3.25, 1e-15);
    assert_float_equal(value_of("slope", 0), -0.25, 1e-14); /* sum (t-3) y / sum (t-3)^2 = -7/28 */
}

static void test_a_level_that_is_never_reached(void **state) {
    (void)state;
    const ab_outcome first = outcome_of("first-above", 1, 10, 0, 0, 100, hill, N);
    assert_true(isnan(first.value));
    assert_false(first.pass);
    assert_float_equal(value_of("duration", 10), 0, 0);
}

static void test_norms_of_the_difference(void **state) {
    (void)state;
    const double y[] = {1, 1.1, 0.8};
    const ab_outcome worst = outcome_of("max", 1, 0, 0, 0, 2, y, 3);
    assert_float_equal(worst.value, 0.8, 0);
    assert_float_equal(worst.error, 0.2, 1e-15);
    assert_false(worst.pass);
    assert_true(outcome_of("max", 1, 0, 4, 0, 2, y, 3).pass); /* relative to a scale of 4 */
    const ab_outcome square = outcome_of("l2", 1, 0, 0, 0, 2, y, 3);
    assert_float_equal(square.error, sqrt((0.5 * 0.01 + 0.5 * (0.01 + 0.04)) / 2), 1e-15);
}

static void test_a_reference_of_zero_is_absolute(void **state) {
    (void)state;
    const double y[] = {5, 0.05};
    const ab_outcome outcome = outcome_of("final", 0, 0, 0, 0, 1, y, 2);
    assert_float_equal(outcome.error, 0.05, 0);
    assert_true(outcome.pass);
}

static void test_window(void **state) {
    (void)state;
    assert_float_equal(outcome_of("peak", 1, 0, 0, 3, 5, hill, N).value, 2, 0);
    assert_float_equal(outcome_of("final", 1, 0, 0, 0, 3, hill, N).value, 2, 0);
    const ab_outcome none = outcome_of("peak", 1, 0, 0, 50, 60, hill, N);
    assert_false(none.pass);
    assert_true(isnan(none.error));
}

static void test_no_number_anywhere_is_a_miss(void **state) {
    (void)state;
    const double y[] = {1, (double)NAN, 1};
    static const char *const norms[] = {"max", "l2", "mean", "peak", "min", "integral", "slope", "duration"};
    for (size_t k = 0; k < sizeof norms / sizeof *norms; k++) assert_false(outcome_of(norms[k], 1, 0, 1e9, 0, 2, y, 3).pass);
    assert_false(outcome_of("final", (double)NAN, 0, 0, 0, 2, hill, 3).pass);
}

static void test_final_leaves_early_samples_out(void **state) {
    (void)state;
    ab_expect expect;
    char norm[] = "final";
    const ab_expect_spec spec = {.name = name_text, .norm = norm, .to = 100, .tolerance = 1};
    assert_int_equal(ab_expect_begin(&expect, &spec, NULL), AB_OK);
    assert_false(ab_expect_wants(&expect, 50, 1));
    assert_true(ab_expect_wants(&expect, 99, 1));
    assert_true(ab_expect_wants_last(&expect, 50)); /* a run that stopped there */
}

static void test_an_unknown_norm_is_refused(void **state) {
    (void)state;
    ab_expect expect;
    char norm[] = "finel";
    const ab_expect_spec spec = {.name = name_text, .norm = norm};
    ab_report *report = ab_report_create();
    assert_int_equal(ab_expect_begin(&expect, &spec, report), AB_BAD_INPUT);
    ab_report_destroy(report);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers_drawn_from_a_series),
        cmocka_unit_test(test_a_level_that_is_never_reached),
        cmocka_unit_test(test_norms_of_the_difference),
        cmocka_unit_test(test_a_reference_of_zero_is_absolute),
        cmocka_unit_test(test_window),
        cmocka_unit_test(test_no_number_anywhere_is_a_miss),
        cmocka_unit_test(test_final_leaves_early_samples_out),
        cmocka_unit_test(test_an_unknown_norm_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
