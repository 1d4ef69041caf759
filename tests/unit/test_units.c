/* test_units.c: conversion to SI, and dimensions that do not fit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "core/units.h"

typedef struct conversion {
    const char *unit, *wanted;
    double factor;
    const char *said; /* NULL: converted */
} conversion;

static void test_units_are_converted_or_refused_by_name(void **state) {
    (void)state;
    static const conversion conversions[] = {
        {"MPa", "Pa", 1e6, NULL},
        {"mm", "m", 1e-3, NULL},
        {"ms", "s", 1e-3, NULL},
        {"kN m-2", "Pa", 1e3, NULL},
        {"kN/m2", "Pa", 1e3, NULL},
        {"g/cm3", "kg m-3", 1e3, NULL},
        {"deg", "rad", 0.017453292519943295, NULL},
        {"degree", "rad", 0.017453292519943295, NULL},
        {"km/h", "m s-1", 1 / 3.6, NULL},
        {"%", "1", 0.01, NULL},
        {"kPa", NULL, 1e3, NULL},
        {"t", NULL, 1e3, NULL},
        {"mm", "Pa", 0, "the unit 'mm' does not have the dimension of 'Pa'"},
        {"deg", "1", 0, "a pure number"},
        {"%", "rad", 0, "does not have the dimension of 'rad'"},
        {"m", "1", 0, "a pure number"},
        {"blorg", "Pa", 0, "unknown unit 'blorg'"},
        {"degC", "K", 0, "not a plain multiple"},
        {"m @ 3", "m", 0, "unknown unit"},
        {"seconds since 1970-01-01", "s", 0, "unknown unit"},
        {"", "m", 0, "unknown unit"},
        {"((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((m", "m", 0, "unknown unit"},
    };
    ab_units *units = ab_units_create();
    for (size_t i = 0; i < sizeof conversions / sizeof conversions[0]; i++) {
        const conversion *c = &conversions[i];
        double factor = 0;
        char why[400] = "";
        const ab_status status = ab_units_factor(units, c->unit, c->wanted, &factor, why, sizeof why);
        if (c->said == NULL) {
            if (status != AB_OK) fprintf(stderr, "%s: %s\n", c->unit, why);
            assert_int_equal(status, AB_OK);
            assert_true(fabs(factor - c->factor) <= 1e-12 * c->factor);
        } else {
            if (strstr(why, c->said) == NULL) fprintf(stderr, "%s: %s\n", c->unit, why);
            assert_int_equal(status, AB_BAD_INPUT);
            assert_non_null(strstr(why, c->said));
        }
    }
    assert_true(ab_units_known(units, "MPa"));
    assert_false(ab_units_known(units, "blorg"));
    ab_units_destroy(units);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_units_are_converted_or_refused_by_name)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
