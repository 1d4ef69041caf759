/* test_ground_record.c: records of how the ground moves: integrated exactly, baselines that take off what they say, rest before and after, directions, refusals. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "boundary/ground_record.h"

enum { ROWS = 7 };

static const double times[ROWS] = {0.5, 0.6, 0.75, 1.0, 1.1, 1.6, 2.0};
static const double values[ROWS] = {0.3, -1.2, 2.5, 0.7, -3.1, 1.9, 0.4};

static char said[1000], told[1000];

static void *allocate(void *context, size_t bytes) { return (void)context, calloc(1, bytes); }
static void release(void *context, void *pointer) { (void)context, free(pointer); }
static void message(void *context, const char *text) { (void)context, snprintf(said, sizeof said, "%s", text); }
static void tell_user(void *context, const char *text) { (void)context, snprintf(told, sizeof told, "%s", text); }
static const ab_host host = {.struct_size = sizeof host, .allocate = allocate, .release = release, .message = message, .log = tell_user};

/* Settings at their defaults with a record of `columns` - 1 values a row. */
static void set(ab_value s[RECORD_SETTINGS], int which, const double *table, size_t rows, size_t columns) {
    static const ab_param params[] = {RECORD_PARAMS};
    assert_int_equal(sizeof params / sizeof *params, RECORD_SETTINGS);
    for (int k = 0; k < RECORD_SETTINGS; k++)
        s[k] = (ab_value){.real = params[k].initial, .integer = isfinite(params[k].initial) ? (int64_t)params[k].initial : 0};
    s[which] = (ab_value){.table = table, .rows = rows, .columns = columns, .given = 1};
}

static void word(ab_value *setting, int number) { *setting = (ab_value){.real = number, .integer = number, .given = 1}; }

static ground_record *open_pairs(int which, const double *value, int baseline, int after) {
    static double table[2 * ROWS];
    ab_value s[RECORD_SETTINGS];
    for (size_t k = 0; k < ROWS; k++) table[2 * k] = times[k], table[2 * k + 1] = value[k];
    set(s, which, table, ROWS, 2);
    word(&s[AT_BASELINE], baseline);
    word(&s[AT_AFTER], after);
    ground_record *r = record_open(&host, s, 1);
    assert_non_null(r);
    return r;
}

static void test_acceleration_is_integrated_exactly_between_its_rows(void **state) {
    (void)state;
    ground_record *r = open_pairs(AT_ACCELERATION, values, NONE, HOLD);
    for (size_t n = 0; n <= 300; n++) {
        const double t = 0.5 + 0.005 * (double)n;
        double wanted = 0;
        for (size_t k = 0; k + 1 < ROWS && times[k] < t; k++) { /* straight lines: the mean of both ends */
            const double end = fmin(t, times[k + 1]), slope = (values[k + 1] - values[k]) / (times[k + 1] - times[k]);
            wanted += (end - times[k]) * (values[k] + 0.5 * slope * (end - times[k]));
        }
        assert_true(fabs(record_velocity(r, 0, t) - wanted) < 1e-15);
    }
    release(NULL, r);
    r = open_pairs(AT_VELOCITY, values, NONE, REST);
    assert_true(fabs(record_velocity(r, 0, 0.675) - 0.65) < 1e-14); /* a record of velocity is straight */
    release(NULL, r);
}

static void test_it_rests_before_and_rests_or_is_held_after(void **state) {
    (void)state;
    for (int after = REST; after <= HOLD; after++) {
        ground_record *r = open_pairs(AT_VELOCITY, values, NONE, after);
        assert_true(record_velocity(r, 0, 0.5 - 1e-12) == 0);
        assert_true(record_velocity(r, 0, 0.5) == 0.3);
        assert_true(record_velocity(r, 0, 2.0) == 0.4);
        assert_true(record_velocity(r, 0, 2.0 + 1e-12) == (after == HOLD ? 0.4 : 0));
        assert_non_null(strstr(told, after == HOLD ? "keeps that velocity" : "is at rest then"));
        assert_non_null(
            strstr(told, "velocity of 7 rows, 0.5 to 2 s; baseline none: subtracted nothing; largest velocity 3.1 m/s; ends at 0.4 m/s"));
        release(NULL, r);
    }
}

/* A record with c0 + c1 s added is corrected to the same one. */
static void is_taken_off(int which, int baseline, double c0, double c1) {
    double drifted[ROWS];
    for (size_t k = 0; k < ROWS; k++) drifted[k] = values[k] + c0 + c1 * (times[k] - times[0]) / (times[ROWS - 1] - times[0]);
    ground_record *plain = open_pairs(which, values, baseline, REST), *other = open_pairs(which, drifted, baseline, REST);
    for (double t = 0.5; t < 2.0; t += 0.01) assert_true(fabs(record_velocity(plain, 0, t) - record_velocity(other, 0, t)) < 1e-13);
    release(NULL, plain), release(NULL, other);
}

static void test_baselines_take_off_what_they_say(void **state) {
    (void)state;
    ground_record *r = open_pairs(AT_ACCELERATION, values, MEAN, HOLD);
    assert_true(fabs(record_velocity(r, 0, 2.0)) < 1e-14); /* no mean acceleration: the base ends at rest */
    release(NULL, r);
    is_taken_off(AT_ACCELERATION, MEAN, 0.7, 0), is_taken_off(AT_VELOCITY, MEAN, 0.7, 0);
    is_taken_off(AT_ACCELERATION, LINEAR, 0.7, -2.0), is_taken_off(AT_VELOCITY, LINEAR, 0.7, -2.0);
    is_taken_off(AT_ACCELERATION, QUADRATIC, 0.7, -2.0);
}

/* Integral of the square of the velocity with p s + q s^2 added. */
static double size_with(const ground_record *r, double p, double q) {
    double sum = 0;
    for (int n = 0; n < 3000; n++) {
        const double s = (n + 0.5) / 3000, v = record_velocity(r, 0, 0.5 + 1.5 * s) + p * s + q * s * s;
        sum += v * v / 3000;
    }
    return sum;
}

static void test_the_quadratic_baseline_leaves_the_smallest_velocity(void **state) {
    (void)state;
    ground_record *r = open_pairs(AT_ACCELERATION, values, QUADRATIC, HOLD);
    const double least = size_with(r, 0, 0);
    for (int k = 0; k < 8; k++) assert_true(size_with(r, 1e-2 * cos(k * 0.7853981634), 1e-2 * sin(k * 0.7853981634)) > least);
    release(NULL, r);
    r = open_pairs(AT_ACCELERATION, values, NONE, HOLD);
    assert_true(least < 0.9 * size_with(r, 0, 0));
    release(NULL, r);
}

static void test_records_have_directions_factor_and_start(void **state) {
    (void)state;
    static const double three[] = {0, 1, -2, 1, 3, -4};
    ab_value s[RECORD_SETTINGS];
    double v[MOST];
    set(s, AT_VELOCITY, three, 2, 3);
    s[AT_FACTOR] = (ab_value){.real = 2, .given = 1};
    s[AT_START] = (ab_value){.real = 10, .given = 1};
    ground_record *r = record_open(&host, s, 0);
    assert_non_null(r);
    record_motion(r, 10.5, v);
    assert_true(v[0] == 4 && v[1] == -6 && v[2] == 0);
    record_motion(r, 0.5, v);
    assert_true(v[0] == 0 && v[1] == 0);
    release(NULL, r);
    static const double pairs[] = {0, 1, 1, 1}, slanted[] = {0.6, 0.8, 0};
    set(s, AT_VELOCITY, pairs, 2, 2);
    s[AT_DIRECTION] = (ab_value){.integer = -1, .real = -1, .table = slanted, .rows = 1, .columns = 3, .given = 1};
    r = record_open(&host, s, 0);
    record_motion(r, 0.5, v);
    assert_true(v[0] == 0.6 && v[1] == 0.8);
    release(NULL, r);
}

static void refused(const ab_value s[RECORD_SETTINGS], const char *why) {
    said[0] = '\0';
    assert_null(record_open(&host, s, 1));
    if (!strstr(said, why)) fail_msg("wanted '%s', got '%s'", why, said);
}

static void test_what_makes_no_sense_is_refused(void **state) {
    (void)state;
    static const double pairs[] = {0, 1, 1, 2}, back[] = {0, 1, 0, 2}, wide[] = {0, 1, 2, 1, 2, 3}, none[] = {0, 1, 1, NAN};
    ab_value s[RECORD_SETTINGS];
    set(s, AT_VELOCITY, pairs, 2, 2), s[AT_VELOCITY].given = 0;
    refused(s, "a record is missing");
    set(s, AT_VELOCITY, pairs, 2, 2), s[AT_ACCELERATION] = s[AT_VELOCITY];
    refused(s, "both given");
    set(s, AT_VELOCITY, pairs, 1, 2);
    refused(s, "two rows");
    set(s, AT_VELOCITY, pairs, 4, 1);
    refused(s, "rows [t, value]");
    set(s, AT_VELOCITY, back, 2, 2);
    refused(s, "grow from row to row");
    set(s, AT_VELOCITY, none, 2, 2);
    refused(s, "not finite");
    set(s, AT_VELOCITY, wide, 2, 3), s[AT_DIRECTION].given = 1;
    refused(s, "one value a row");
    set(s, AT_VELOCITY, pairs, 2, 2), word(&s[AT_BASELINE], QUADRATIC);
    refused(s, "quadratic is of records of acceleration");
    set(s, AT_VELOCITY, pairs, 2, 2), s[AT_DENSITY] = (ab_value){.real = 2000, .given = 1};
    refused(s, "belong to base: compliant");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_acceleration_is_integrated_exactly_between_its_rows),
        cmocka_unit_test(test_it_rests_before_and_rests_or_is_held_after),
        cmocka_unit_test(test_baselines_take_off_what_they_say),
        cmocka_unit_test(test_the_quadratic_baseline_leaves_the_smallest_velocity),
        cmocka_unit_test(test_records_have_directions_factor_and_start),
        cmocka_unit_test(test_what_makes_no_sense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
