/* test_guard.c: a fault in a plugin's call comes back as one, also from a loop that the plugin shares out among threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <omp.h>
#include <signal.h>
#include <string.h>

#include "core/guard.h"

static int fault_somewhere(void *data) {
    const int *iteration = data;
    int sum = 0;
#pragma omp parallel for schedule(static, 1) reduction(+ : sum)
    for (int i = 0; i < 8; ++i) {
        if (i == *iteration) raise(SIGSEGV);
        sum += i;
    }
    return sum;
}

static void test_a_fault_comes_back_from_any_iteration(void **state) {
    (void)state;
    omp_set_num_threads(4);
    for (int k = 0; k < 8; k++) { /* the first not on this thread, were there others */
        int i = (k + 1) % 8;
        ab_fault fault = {0};
        int code = 0;
        assert_false(ab_guard_call(NULL, fault_somewhere, &i, &code, &fault));
        assert_non_null(strstr(fault.text, "SIGSEGV"));
    }
    int never = -1, code = 0;
    ab_fault fault;
    assert_true(ab_guard_call(NULL, fault_somewhere, &never, &code, &fault));
    assert_int_equal(code, 28);
    assert_int_equal(omp_get_max_threads(), 4); /* as it was */
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_a_fault_comes_back_from_any_iteration)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
