/* test_expression.c: numbers, formulas, and either with a unit behind it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/quantity.h"

typedef struct reading {
    const char *text, *unit;
    unsigned variables;
    double value;     /* at t = 2, x = 3, y = 5 */
    const char *said; /* NULL: read */
} reading;

static const reading readings[] = {
    {"1", "m", 0, 1, NULL},
    {"-1.5e-3", "m", 0, -1.5e-3, NULL},
    {"1e4", "1", 0, 1e4, NULL},
    {"5e-4", "1", 0, 5e-4, NULL},
    {".5", "1", 0, 0.5, NULL},
    {"+2.", "1", 0, 2, NULL},
    {" 3.25 ", "1", 0, 3.25, NULL},
    {"0", "1", 0, 0, NULL},
    {"0.5", "1", 0, 0.5, NULL},
    {"1e-400", "1", 0, 0, NULL},
    {"2*mu", "1", 0, 0.5, NULL},
    {"mu > 0.2 ? 7 : 8", "1", 0, 7, NULL},
    {"2^3 + sin(pi/2) + ln(e)", "1", 0, 10, NULL},
    {"min(1, 2) + max(3, 4)", "1", 0, 5, NULL},
    {"t^2", "m", AB_VARIABLE_T, 4, NULL},
    {"x + 10*y", "m", AB_VARIABLES_XY, 53, NULL},
    {"-10e3*exp(-((t-2)/0.021)^2)", "Pa", AB_VARIABLE_T, -10e3, NULL},
    {"20 MPa", "Pa", 0, 20e6, NULL},
    {"-5 mm", "m", 0, -5e-3, NULL},
    {"1.8 g/cm3", "kg m-3", 0, 1800, NULL},
    {"2*mu MPa", "Pa", 0, 0.5e6, NULL},
    {"2 * mu MPa", "Pa", 0, 0.5e6, NULL},
    {"(1 + t) kN m-2", "Pa", AB_VARIABLE_T, 3000, NULL},
    {"", "1", 0, 0, "the value is empty"},
    {"  ", "1", 0, 0, "the value is empty"},
    {"inf", "1", 0, 0, "not a finite number"},
    {"-.Inf", "1", 0, 0, "not a finite number"},
    {"NaN", "1", 0, 0, "not a finite number"},
    {"1e400", "1", 0, 0, "overflow"},
    {"1e400 m", "m", 0, 0, "overflow"},
    {"1e308 Gm", "m", 0, 0, "too large once it is converted"},
    {"1/0", "1", 0, 0, "is infinite"},
    {"0/0", "1", 0, 0, "is nan"},
    {"sqrt(-1)", "1", 0, 0, "is nan"},
    {"0x10", "1", 0, 0, "not decimal"},
    {"1_000", "1", 0, 0, "'_' between its digits"},
    {"010", "1", 0, 0, "octal"},
    {"20MPa", "Pa", 0, 0, "leave a blank"},
    {"20 mm", "Pa", 0, 0, "the unit 'mm' does not have the dimension of 'Pa'"},
    {"20 blorg", "Pa", 0, 0, "unknown unit 'blorg'"},
    {"2*nu", "1", 0, 0, "unknown name 'nu'; did you mean 'mu'?"},
    {"t", "1", 0, 0, "'t' cannot be used in this value; only constants are known here"},
    {"x", "1", AB_VARIABLE_T, 0, "only t (time, s) and constants"},
    {"z", "1", AB_VARIABLES_XY, 0, "'z' cannot be used"},
    {"x + 10*y + 100*X + 1000*Y", "m", AB_VARIABLES_MOTION, 53, NULL}, /* ab_number_at knows no start */
    {"X", "1", AB_VARIABLES_TXY, 0, "'X' cannot be used in this value; only t, x, y and constants"},
    {"x", "1", AB_VARIABLES_T_START, 0, "'x' cannot be used in this value; only t, X, Y (m, the place at the start)"},
    {"1, 2", "1", 0, 0, "gives 2 numbers where one is needed"},
    {"1,5", "1", 0, 0, "gives 2 numbers where one is needed"},
    {"t = 5", "1", AB_VARIABLE_T, 0, "'=' and quotes have no place"},
    {"\"a\"", "1", 0, 0, "'=' and quotes have no place"},
    {"(1 + 2", "1", 0, 0, "not a formula"},
    {"sin", "1", 0, 0, "not a formula"},
    {"sin()", "1", 0, 0, "not a formula"},
    {"foo(1)", "1", 0, 0, "unknown name 'foo'"},
    {"1 +", "1", 0, 0, "not a formula"},
    {"?:", "1", 0, 0, "not a formula"},
    {"1 ? 2", "1", 0, 0, "not a formula"},
    {"t t", "1", AB_VARIABLE_T, 0, "the unit 't' has a dimension"},
};

static void test_each_text_is_read_or_refused_with_its_cause(void **state) {
    (void)state;
    ab_formulas *formulas = ab_formulas_create();
    ab_units *units = ab_units_create();
    assert_int_equal(ab_formulas_define(formulas, "mu", 0.25), AB_OK);
    for (size_t i = 0; i < sizeof readings / sizeof readings[0]; i++) {
        const reading *r = &readings[i];
        ab_number number = {0, NULL, AB_NOWHERE};
        char why[1200] = "";
        const ab_status status = ab_quantity_read(formulas, units, r->text, r->unit, r->variables, &number, why, sizeof why);
        const double value = status == AB_OK ? ab_number_at(&number, 2, 3, 5, 0) : 0;
        const bool good = r->said == NULL ? status == AB_OK && fabs(value - r->value) <= 1e-12 * fabs(r->value) : status == AB_BAD_INPUT && strstr(why, r->said) != NULL;
        if (!good) fprintf(stderr, "'%s': status %d, value %.17g, said: %s\n", r->text, status, value, why);
        assert_true(good);
    }
    ab_units_destroy(units);
    ab_formulas_destroy(formulas);
}

static void test_formulas_keep_apart(void **state) {
    (void)state;
    ab_formulas *formulas = ab_formulas_create();
    ab_number a, b;
    char why[400];
    assert_int_equal(ab_formulas_compile(formulas, "2*t", AB_VARIABLE_T, &a, why, sizeof why), AB_OK);
    assert_int_equal(ab_formulas_compile(formulas, "x - y", AB_VARIABLES_XY, &b, why, sizeof why), AB_OK);
    assert_false(ab_number_is_constant(&a));
    assert_float_equal(ab_number_at(&a, 3, 0, 0, 0), 6, 0);
    assert_float_equal(ab_number_at(&b, 3, 7, 2, 0), 5, 0);
    assert_float_equal(ab_number_at(&a, 4, 0, 0, 0), 8, 0);
    assert_int_equal(ab_formulas_compile(formulas, "0*t + 1/t", AB_VARIABLE_T, &a, why, sizeof why), AB_OK);
    assert_false(isfinite(ab_number_at(&a, 0, 0, 0, 0)));
    ab_formulas_destroy(formulas);
}

static void test_names_of_constants_that_mean_something_are_refused(void **state) {
    (void)state;
    static const char *const bad[] = {"t", "x", "y", "z", "pi", "e", "sin", "max", "true", "inf", "_pi", "1a", "a b", "a-b", "", "\xc3\xa9"};
    ab_formulas *formulas = ab_formulas_create();
    char why[200];
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) assert_false(ab_formulas_name_ok(formulas, bad[i], why, sizeof why));
    assert_true(ab_formulas_name_ok(formulas, "E0", why, sizeof why));
    assert_true(ab_formulas_name_ok(formulas, "tt", why, sizeof why));
    ab_formulas_destroy(formulas);
}

static void test_limits_hold(void **state) {
    (void)state;
    ab_formulas *formulas = ab_formulas_create();
    ab_number number;
    char why[400], *text = malloc(100001);
    memset(text, '(', 100000);
    text[100000] = '\0';
    assert_int_equal(ab_formulas_compile(formulas, text, 0, &number, why, sizeof why), AB_BAD_INPUT);
    assert_non_null(strstr(why, "the longest allowed is 2000"));
    text[1999] = '\0';
    assert_int_equal(ab_formulas_compile(formulas, text, 0, &number, why, sizeof why), AB_BAD_INPUT);
    memset(text, '-', 1998);
    text[1998] = '1';
    (void)ab_formulas_compile(formulas, text, 0, &number, why, sizeof why); /* either answer, no crash */
    for (int i = 0; i < 600; i++) memcpy(text + 3 * i, "1^1", 3), text[3 * i + 2] = i < 599 ? '^' : '1';
    text[1800] = '\0';
    (void)ab_formulas_compile(formulas, text, 0, &number, why, sizeof why);
    free(text);
    for (int i = 0; i < AB_FORMULA_COUNT; i++) assert_int_equal(ab_formulas_compile(formulas, "t", AB_VARIABLE_T, &number, why, sizeof why), AB_OK);
    assert_int_equal(ab_formulas_compile(formulas, "t", AB_VARIABLE_T, &number, why, sizeof why), AB_BAD_INPUT);
    ab_formulas_destroy(formulas);
}

static void test_work_on_formulas_is_bounded(void **state) {
    (void)state;
    ab_formulas *formulas = ab_formulas_create();
    ab_number number;
    char why[400];
    int count = 0;
    while (ab_formulas_compile(formulas, "1+1", 0, &number, why, sizeof why) == AB_OK && count < 1000000) count++;
    assert_true(count > 20000 && count < 1000000);
    assert_true(ab_formulas_exhausted(formulas));
    assert_non_null(strstr(why, "too many formulas"));
    ab_formulas_destroy(formulas);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_text_is_read_or_refused_with_its_cause),
        cmocka_unit_test(test_formulas_keep_apart),
        cmocka_unit_test(test_names_of_constants_that_mean_something_are_refused),
        cmocka_unit_test(test_limits_hold),
        cmocka_unit_test(test_work_on_formulas_is_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
