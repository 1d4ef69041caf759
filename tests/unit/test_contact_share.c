/* test_contact_share.c: sums that a response keeps at contact points on shared nodes, while bodies slide on and nodes come and go: the total stays, neighbours have it
 * in proportion to area x overlap^2, and nothing goes to where nobody is near. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/contact.h"

enum { STATES = 2, SUM_ROW = 1, MOST = 64 };

typedef struct bench {
    contact_points points;
    contact_side side[2];
} bench;

static bench *open_bench(double cell) {
    bench *b = calloc(1, sizeof *b);
    b->points.states = STATES + HISTORY;
    b->points.sums.rows = 1u << SUM_ROW;
    b->points.view.dimension = 2;
    b->points.view.cell = cell;
    assert_true(contact_points_reserve(&b->points, MOST, MOST));
    return b;
}

static void close_bench(bench *b) {
    contact_points_destroy(&b->points);
    free(b);
}

/* One step: contact points at these nodes (key, cells), all deep by `depth` where it is not 0. */
static void step(bench *b, const int (*node)[2], const double *depth, size_t count) {
    ab_points *v = &b->points.view;
    v->count = count;
    for (size_t i = 0; i < count; i++) {
        v->key[i] = (uint64_t)(1000 + node[i][0]) * 10000 + (uint64_t)(1000 + node[i][1]);
        v->position[i] = node[i][0] * v->cell, v->position[v->ld + i] = node[i][1] * v->cell;
        v->gap[i] = -depth[i];
        v->area[i] = 0.3;
    }
    b->side[0] = (contact_side){.points = v, .start = v->a_start, .sign = 1},
    b->side[1] = (contact_side){.points = v, .start = v->b_start, .sign = -1};
    assert_true(contact_points_prepare(&b->points, b->side, AB_STAGE_DYNAMIC));
    memcpy(v->state1, v->state0, (STATES + HISTORY) * v->ld * sizeof(double));
}

static double *sum_of(bench *b, size_t i) { return b->points.view.state1 + SUM_ROW * b->points.view.ld + i; }

static double total(bench *b) {
    double all = 0;
    for (size_t i = 0; i < b->points.view.count; i++) all += *sum_of(b, i);
    return all;
}

static void test_what_slides_on_keeps_its_sum(void **state) {
    (void)state;
    for (int down = 0; down < 2; down++) {
        bench *b = open_bench(0.25);
        enum { LONG = 9 };
        int node[LONG][2];
        double depth[LONG];
        for (int n = 0; n < LONG; n++) depth[n] = 0.01;
        for (int begin = -30; begin < 30; begin++) { /* nine nodes under a body that moves by a cell every forty steps */
            for (int n = 0; n < LONG; n++) node[n][down] = begin + n, node[n][1 - down] = 3;
            for (int k = 0; k < 40; k++) {
                step(b, node, depth, LONG);
                if (begin == -30 && k == 0)
                    for (size_t n = 0; n < LONG; n++) *sum_of(b, n) = n < 5 ? 2 : 0; /* one half is loaded */
                if (!(fabs(total(b) - 10) < 1e-10)) fail_msg("step %d %d: %.17g", begin, k, total(b));
                contact_points_remember(&b->points);
            }
        }
        for (size_t n = 0; n < LONG; n++)
            assert_true(*sum_of(b, n) > 0.5 && *sum_of(b, n) < 2); /* behind at the front, ahead at the rear: it flows */
        for (int k = 0; k < 1500; k++) step(b, node, depth, LONG), contact_points_remember(&b->points);
        for (size_t n = 0; n < LONG; n++) assert_true(fabs(*sum_of(b, n) - 10.0 / LONG) < 1e-9);
        close_bench(b);
    }
}

static void test_sums_in_proportion_stand_still(void **state) {
    (void)state;
    bench *b = open_bench(0.1);
    static const int node[7][2] = {{0, 0}, {1, 0}, {2, 1}, {3, 1}, {2, 0}, {4, 2}, {5, 2}};
    static const double depth[7] = {0.01, 0.03, 0.002, 0.02, 0.01, 0.05, 0.004};
    step(b, node, depth, 7);
    double expected[7];
    for (size_t i = 0; i < 7; i++) *sum_of(b, i) = expected[i] = 1e4 * depth[i] * depth[i], b->points.view.state1[i] = 0.1 * (double)i;
    for (int k = 0; k < 100; k++) {
        contact_points_remember(&b->points);
        step(b, node, depth, 7);
    }
    for (size_t i = 0; i < 7; i++) {
        assert_true(fabs(*sum_of(b, i) - expected[i]) < 1e-13);
        assert_true(b->points.view.state1[i] == 0.1 * (double)i); /* a row that is no sum */
    }
    close_bench(b);
}

static void test_nothing_goes_to_where_nobody_is_near(void **state) {
    (void)state;
    bench *b = open_bench(0.1);
    static const int node[4][2] = {{0, 0}, {1, 0}, {3, 0}, {4, 0}}; /* two groups, two cells apart */
    static const double depth[4] = {0.01, 0.01, 0.5, 0.5}, apart[4] = {0, 0, 0.5, 0.5};
    step(b, node, depth, 4);
    *sum_of(b, 0) = 3, *sum_of(b, 1) = 1;
    contact_points_remember(&b->points);
    for (int k = 0; k < 50; k++) step(b, node, depth, 4), contact_points_remember(&b->points);
    assert_true(fabs(*sum_of(b, 0) - 2) < 1e-12 && fabs(*sum_of(b, 1) - 2) < 1e-12 && *sum_of(b, 2) == 0 && *sum_of(b, 3) == 0);
    step(b, node, apart, 4); /* the first group parts: nobody near could hold it */
    assert_true(total(b) == 0);
    contact_points_remember(&b->points);
    step(b, node + 3, depth + 3, 1);
    assert_true(total(b) == 0);
    close_bench(b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_slides_on_keeps_its_sum),
        cmocka_unit_test(test_sums_in_proportion_stand_still),
        cmocka_unit_test(test_nothing_goes_to_where_nobody_is_near),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
