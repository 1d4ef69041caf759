/* test_node_normals.c: normals of a shared node, each on clouds of points laid out by hand; slopes of the density; the nearest faces of a body. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/density.h"
#include "fake_surface.h"
#include "plugins/contact/node_normals.h"

#define near(x, y, tolerance) assert_true(fabs((x) - (y)) <= (tolerance))

enum { MOST = 400 };

typedef struct cloud { /* points of one body near one node at (0, 0), cell 1 */
    double position[2], mass_gradient[2], area_vector[2], density_gradient[2], near_position[2 * MOST], near_extent[3 * MOST];
    size_t near_start[2], count;
    ab_trace trace;
} cloud;

static cloud *lay(void) {
    cloud *c = calloc(1, sizeof *c);
    c->trace = (ab_trace){.struct_size = sizeof c->trace,
                          .dimension = 2,
                          .cell = 1,
                          .count = 1,
                          .ld = 1,
                          .position = c->position,
                          .mass_gradient = c->mass_gradient,
                          .area_vector = c->area_vector,
                          .density_gradient = c->density_gradient,
                          .near_start = c->near_start,
                          .near_ld = MOST,
                          .near_position = c->near_position,
                          .near_extent = c->near_extent};
    return c;
}

static void put(cloud *c, double x, double y, double half) {
    const size_t k = c->count++;
    c->near_position[k] = x;
    c->near_position[MOST + k] = y;
    c->near_extent[k] = c->near_extent[MOST + k] = half * half;
    c->near_start[1] = c->count;
}

/* Points a quarter of a cell apart within 1.25 cells of the node, turned by `angle`, where inside(s, n) says so; s along, n across. */
static cloud *fill(double angle, int (*inside)(double s, double n)) {
    cloud *c = lay();
    for (int j = -6; j < 6; ++j)
        for (int i = -6; i < 6; ++i) {
            const double s = 0.25 * (i + 0.5), n = 0.25 * (j + 0.5), x = s * cos(angle) - n * sin(angle),
                         y = s * sin(angle) + n * cos(angle);
            if (inside(s, n) && fabs(x) < 1.25 && fabs(y) < 1.25) put(c, x, y, 0.125);
        }
    return c;
}

static int below(double s, double n) { return (void)s, n < 0; }
static int above(double s, double n) { return (void)s, n > 0; }
static int outside_corner(double s, double n) { return s < 0 || n < 0; }
static int inside_corner(double s, double n) { return s > 0 && n > 0; }

static double angle_between(const double n[3], double angle) {
    return fabs(atan2(n[1] * cos(angle) - n[0] * sin(angle), n[0] * cos(angle) + n[1] * sin(angle)));
}

static void test_cells_that_hold_points_give_axes_and_diagonals(void **state) {
    (void)state;
    static const struct {
        double a[3][2], b[3][2]; /* points; (9, 9): none */
        int answer;
        double angle;
    } cases[] = {
        {{{-0.5, -0.5}, {0.5, -0.5}, {9, 9}}, {{-0.5, 0.5}, {0.5, 0.5}, {9, 9}}, 1, M_PI / 2},
        {{{-0.5, -0.5}, {9, 9}, {9, 9}}, {{0.5, 0.5}, {9, 9}, {9, 9}}, 1, M_PI / 4},
        {{{-0.5, -0.5}, {9, 9}, {9, 9}}, {{0.5, 0.5}, {-0.5, 0.5}, {0.5, -0.5}}, 1, M_PI / 4},
        {{{-0.5, -0.5}, {0.5, 0.5}, {9, 9}}, {{0.5, -0.5}, {-0.5, 0.5}, {9, 9}}, 0, 0},
        {{{0.5, 0.5}, {0.5, -0.5}, {9, 9}}, {{-0.5, -0.5}, {-0.5, 0.5}, {-1.2, 0.5}}, 1, M_PI},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        cloud *a = lay(), *b = lay();
        for (int p = 0; p < 3; ++p) {
            if (cases[k].a[p][0] < 9) put(a, cases[k].a[p][0], cases[k].a[p][1], 0.1);
            if (cases[k].b[p][0] < 9) put(b, cases[k].b[p][0], cases[k].b[p][1], 0.1);
        }
        double n[3];
        assert_int_equal(geometric_normal(&a->trace, &b->trace, 0, n), cases[k].answer);
        if (cases[k].answer) near(angle_between(n, cases[k].angle), 0, 1e-12);
        free(a), free(b);
    }
}

/* A plane between two clouds that mirror each other is theirs, at any angle and from a guess that is off by a radian. */
static void test_regression_finds_the_plane_between_clouds(void **state) {
    (void)state;
    for (int turn = 0; turn < 12; ++turn) {
        const double angle = 0.53 * turn;
        cloud *a = fill(angle, below), *b = fill(angle, above);
        for (int lean = -1; lean <= 1; ++lean) {
            const double guess[3] = {cos(angle + M_PI / 2 + lean), sin(angle + M_PI / 2 + lean), 0};
            double n[3];
            assert_true(regression_normal(&a->trace, &b->trace, 0, guess, n));
            near(angle_between(n, angle + M_PI / 2), 0, 0.02);
        }
        free(a), free(b);
    }
    cloud *a = lay(), *b = fill(0, above); /* no points: no answer */
    double n[3];
    assert_false(regression_normal(&a->trace, &b->trace, 0, (const double[3]){0, 1, 0}, n));
    free(a), free(b);
}

static void test_a_concave_body_takes_the_normal_of_the_other(void **state) {
    (void)state;
    for (int turn = 0; turn < 8; ++turn) {
        const double angle = 0.4 + 0.7 * turn, diagonal = angle + M_PI / 4;
        const double along[3] = {cos(diagonal), sin(diagonal), 0};
        cloud *a = fill(angle, outside_corner), *b = fill(angle, inside_corner);
        assert_true(bulge(&a->trace, 0, along) < -0.2);
        assert_true(bulge(&b->trace, 0, (const double[3]){-along[0], -along[1], 0}) > 0.2);
        const double na[3] = {cos(diagonal + 0.3), sin(diagonal + 0.3), 0}, nb[3] = {-cos(diagonal - 0.2), -sin(diagonal - 0.2), 0};
        double n[3];
        assert_true(convex_normal(&a->trace, &b->trace, 0, along, na, nb, 0.866, n));
        near(angle_between(n, diagonal - 0.2), 0, 1e-12); /* that of b, into it */
        const double back[3] = {-along[0], -along[1], 0};
        assert_true(convex_normal(&b->trace, &a->trace, 0, back, nb, na, 0.866, n) && n[0] == nb[0] && n[1] == nb[1]);
        assert_false(
            convex_normal(&a->trace, &b->trace, 0, along, na, (const double[3]){along[1], -along[0], 0}, 0.866, n)); /* leans too far */
        free(a), free(b);
        a = fill(angle, below), b = fill(angle, above); /* flats */
        const double up[3] = {-sin(angle), cos(angle), 0}, down[3] = {sin(angle), -cos(angle), 0};
        near(bulge(&a->trace, 0, up), 0, 1e-9);
        assert_false(convex_normal(&a->trace, &b->trace, 0, up, up, down, 0.866, n));
        free(a), free(b);
    }
}

/* A plane of density has its own slope; a heavy body has no more say than a light one. */
static void test_density_gradient(void **state) {
    (void)state;
    double slope[2] = {0, 0};
    const double g[2] = {0.3, -0.7}, step = 1.0 / 64;
    for (double x = -2 + step / 2; x < 2; x += step)
        for (double y = -2 + step / 2; y < 2; y += step) {
            double difference[2], mean[2];
            ab_density_pair(x, &difference[0], &mean[0]);
            ab_density_pair(y, &difference[1], &mean[1]);
            const double mass = (5 + g[0] * x + g[1] * y) * step * step;
            slope[0] += mass * difference[0] * mean[1];
            slope[1] += mass * mean[0] * difference[1];
        }
    near(slope[0], g[0], 1e-3);
    near(slope[1], g[1], 1e-3);
    cloud *a = lay(), *b = lay();
    a->mass_gradient[0] = 2000, a->area_vector[0] = 1, b->mass_gradient[1] = 10, b->area_vector[1] = 1;
    a->density_gradient[0] = -2000, b->density_gradient[1] = -10;
    double n[3];
    assert_true(density_normal(&a->trace, &b->trace, 0, n));
    near(n[0], sqrt(0.5), 1e-12);
    near(n[1], -sqrt(0.5), 1e-12);
    free(a), free(b);
}

/* Nodes around a square: the side, the corner, which way is out, and how far. */
static void test_nearest_faces(void **state) {
    (void)state;
    static const double corner[4][2] = {{2.5, 2.5}, {5.5, 2.5}, {5.5, 5.5}, {2.5, 5.5}};
    surface_body *square = surface_polygon("square", corner, 4, false, 0), *other = surface_body_create("points", 1, 0, 1);
    enum { NODES = 5 };
    static const int32_t at[NODES][2] = {{4, 2}, {6, 6}, {3, 4}, {2, 2}, {4, 9}};
    double position[2 * NODES];
    uint64_t key[NODES];
    for (size_t k = 0; k < NODES; ++k) {
        position[k] = at[k][0];
        position[NODES + k] = at[k][1];
        key[k] = ab_tile_key(at[k][0], at[k][1]);
    }
    contact_pair pair = {.a = &square->domain, .b = &other->domain};
    ab_trace a = {.struct_size = sizeof a, .dimension = 2, .cell = 1, .count = NODES, .ld = NODES, .position = position, .key = key}, b = a;
    ab_report *report = ab_report_create();
    assert_int_equal(contact_nearest_faces(&pair, &a, &b, report), AB_OK);
    assert_null(b.face_normal); /* it has none */
    static const double expected[NODES][4] = {{0, -1, 0.5, 0},
                                              {0.70710678118654752, 0.70710678118654752, 0.70710678118654752, M_PI / 2},
                                              {-1, 0, -0.5, 0},
                                              {-0.70710678118654752, -0.70710678118654752, 0.70710678118654752, M_PI / 2},
                                              {0, 0, INFINITY, 0}};
    for (size_t k = 0; k < NODES; ++k) {
        near(a.face_normal[k], expected[k][0], 1e-12);
        near(a.face_normal[NODES + k], expected[k][1], 1e-12);
        assert_true(a.face_distance[k] == expected[k][2] || fabs(a.face_distance[k] - expected[k][2]) < 1e-12);
        near(a.face_turn[k], expected[k][3], 1e-12);
    }
    double n[3];
    assert_true(face_normal(&a, &b, 0, n) && n[0] == 0 && n[1] == -1);
    assert_true(face_normal(&b, &a, 0, n) && n[0] == 0 && n[1] == 1); /* into the square */
    assert_false(face_normal(&a, &b, 1, n));                          /* a corner */
    assert_false(face_normal(&a, &b, 4, n));
    contact_faces_destroy(pair.faces);
    ab_report_destroy(report);
    surface_body_destroy(square), surface_body_destroy(other);
}

int main(void) {
    (void)closest_approach, (void)mend_chance; /* theirs are other tests */
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cells_that_hold_points_give_axes_and_diagonals),
        cmocka_unit_test(test_regression_finds_the_plane_between_clouds),
        cmocka_unit_test(test_a_concave_body_takes_the_normal_of_the_other),
        cmocka_unit_test(test_density_gradient),
        cmocka_unit_test(test_nearest_faces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
