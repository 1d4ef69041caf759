/* test_fill.c: boxes, discs and rings: exact volumes, a surface where it was drawn; and what no fill accepts. */
#include "fill_checks.h"

/* ---- boxes ----------------------------------------------------------------------------------------------------------------- */

static void test_box_volume_surface_and_centroid_are_exact(void **state) {
    (void)state;
    const int per_cell[] = {1, 2, 3, 4, 5, 6, 7, 9, 12, 16};
    const double sides[][2] = {{3, 2}, {1, 1}, {2.37, 0.41}, {0.5, 7.77}, {0.26, 0.26}};
    for (int rule = AB_FILL_REGULAR; rule <= AB_FILL_GAUSS; rule++)
        for (size_t n = 0; n < sizeof per_cell / sizeof *per_cell; n++)
            for (size_t s = 0; s < sizeof sides / sizeof *sides; s++) {
                const double w = sides[s][0], h = sides[s][1];
                const ab_shape_spec shape = box(-0.3, 1.1, -0.3 + w, 1.1 + h);
                ab_fill *f = fill_of(&shape, rule, per_cell[n], 0.25);
                check_sane(f);
                near(volume_of(f), w * h, 1e-12 * w * h);
                near(length_of(f), 2 * (w + h), 1e-12 * (w + h));
                near(surface_error(f), 0, 1e-14);
                near(moment_of(f, f->x), w * h * (-0.3 + w / 2), 1e-12 * w * h);
                near(moment_of(f, f->y), w * h * (1.1 + h / 2), 1e-12 * w * h);
                near((double)f->count * 0.0625 / per_cell[n] / (w * h), 1, w * h > 2 && fmin(w, h) > 1 ? 0.1 : 1.2);
                ab_fill_destroy(f);
            }
}

static void test_box_lattice_divides_the_sides(void **state) {
    (void)state;
    const ab_shape_spec shape = box(2.75, 0.5, 3.75, 1.25);
    ab_fill *f = fill_of(&shape, AB_FILL_REGULAR, 16, 0.25);
    assert_int_equal(f->count, 16 * 12);
    assert_int_equal(f->surface_count, 2 * (16 + 12));
    near(f->x[0], 2.75 + 1. / 32, 1e-15);
    near(f->y[0], 0.5 + 1. / 32, 1e-15);
    near(f->extent[0], 1. / 1024, 1e-18);
    assert_true(f->low[0] == 2.75 && f->high[1] == 1.25);
    ab_fill_destroy(f);
    f = fill_of(&shape, AB_FILL_GAUSS, 16, 0.25); /* 4 x 3 cells of 4 x 4 Gauss points */
    assert_int_equal(f->count, 12 * 16);
    near(f->x[0], 2.75 + 0.25 * 0.5 * (1 - 0.86113631159405258), 1e-15);
    near(f->volume[0], 0.0625 * 0.25 * 0.34785484513745386 * 0.34785484513745386, 1e-17);
    ab_fill_destroy(f);
}

static void test_where_finds_the_sides(void **state) {
    (void)state;
    const ab_shape_spec shapes[] = {box(1e6, -2, 1e6 + 3, -1), box(0, 0, 1.7, 0.9), ring(0.5, 0.5, 1, 0)};
    for (size_t s = 0; s < 3; s++)
        for (int rule = AB_FILL_REGULAR; rule <= AB_FILL_GAUSS; rule++) {
            ab_fill *f = fill_of(&shapes[s], rule, 6, 0.2);
            double length[AB_SIDES] = {0}, x_low = 0, all = 0;
            for (size_t k = 0; k < f->surface_count; k++) {
                int sides = 0;
                for (int side = 0; side < AB_SIDES; side++) {
                    const ab_where where = {.side = side};
                    if (!ab_where_holds(&where, f, &f->surface[k])) continue;
                    sides++;
                    length[side] += f->surface[k].length;
                }
                assert_int_equal(sides, 1);
                const ab_where low = {.side = -1, .has = {true, false}, .range = {{f->low[0], f->low[0]}}}, every = {.all = true},
                               none = {.side = -1};
                if (ab_where_holds(&low, f, &f->surface[k])) x_low += f->surface[k].length;
                if (ab_where_holds(&every, f, &f->surface[k])) all += f->surface[k].length;
                assert_false(ab_where_holds(&none, f, &f->surface[k]));
            }
            const double w = f->high[0] - f->low[0], h = f->high[1] - f->low[1], tolerance = 1e-12 * (w + h);
            near(all, s < 2 ? 2 * (w + h) : 2 * PI, tolerance);
            for (int side = 0; side < AB_SIDES; side++)
                near(length[side], s < 2 ? (side == AB_LEFT || side == AB_RIGHT ? h : w) : PI / 2, tolerance + (s == 2) * 0.2);
            if (s < 2) near(x_low, h, tolerance);
            ab_fill_destroy(f);
        }
    const ab_shape_spec shape = box(0, 0, 2, 1);
    ab_fill *f = fill_of(&shape, AB_FILL_REGULAR, 4, 0.5);
    const ab_where part = {.side = AB_TOP, .has = {true, false}, .range = {{0.5, 1.5}}};
    double length = 0;
    for (size_t k = 0; k < f->surface_count; k++)
        if (ab_where_holds(&part, f, &f->surface[k])) length += f->surface[k].length;
    near(length, 1, 1e-14);
    ab_fill_destroy(f);
}

/* ---- discs and rings ------------------------------------------------------------------------------------------------------- */

static void test_disc_and_ring_are_exact_and_symmetric(void **state) {
    (void)state;
    const int per_cell[] = {1, 2, 3, 4, 5, 7, 9, 16};
    const double radii[][2] = {{1, 0}, {0.2, 0}, {1.25, 0.75}, {3, 2.9}, {0.11, 0}, {0.05, 0}};
    const double turn[4] = {0, -1, 1, 0}, mirror[4] = {-1, 0, 0, 1}, diagonal[4] = {0, 1, 1, 0};
    for (int rule = AB_FILL_REGULAR; rule <= AB_FILL_GAUSS; rule++)
        for (size_t n = 0; n < sizeof per_cell / sizeof *per_cell; n++)
            for (size_t s = 0; s < sizeof radii / sizeof *radii; s++) {
                const double r = radii[s][0], inner = radii[s][1], area = PI * (r * r - inner * inner);
                const ab_shape_spec shape = ring(0.7, -0.4, r, inner), centred = ring(0, 0, r, inner);
                ab_fill *f = fill_of(&shape, rule, per_cell[n], 0.1);
                check_sane(f);
                near(volume_of(f), area, 1e-12 * area);
                near(length_of(f), 2 * PI * (r + inner), 1e-12 * r);
                near(surface_error(f), 0, 1e-14);
                near(moment_of(f, f->x), 0.7 * area, 1e-12 * area);
                near(moment_of(f, f->y), -0.4 * area, 1e-12 * area);
                for (size_t p = 0; p < f->count; p++) {
                    const double from_centre = hypot(f->x[p] - 0.7, f->y[p] + 0.4);
                    assert_true(from_centre < r && (inner == 0 || from_centre > inner));
                }
                if (area > 1) near((double)f->count * 0.01 / per_cell[n] / area, 1, 0.15);
                ab_fill_destroy(f);
                f = fill_of(&centred, rule, per_cell[n], 0.1);
                check_same_points(f, turn, f);
                check_same_points(f, mirror, f);
                if (rule == AB_FILL_REGULAR && f->count > 1) check_same_points(f, diagonal, f);
                ab_fill_destroy(f);
            }
}

/* ---- what is refused ------------------------------------------------------------------------------------------------------- */

static void check_refused(const ab_shape_spec *shape, int per_cell, double cell, const char *text) {
    ab_report *report = ab_report_create();
    ab_fill *fill = NULL;
    assert_int_equal(ab_fill_create(shape, AB_FILL_REGULAR, per_cell, cell, zero, "block", &fill, report), AB_BAD_INPUT);
    assert_null(fill);
    const char *line = ab_report_text(report, 0);
    assert_non_null(line);
    if (!strstr(line, text) || !strstr(line, "'block'") || !strstr(line, "scene.yaml:7:9")) fail_msg("'%s' does not say '%s'", line, text);
    ab_report_destroy(report);
}

static void test_wrong_shapes_are_refused_with_their_place(void **state) {
    (void)state;
    const ab_mark mark = {"scene.yaml", 7, 9};
    ab_shape_spec flat = box(0, 0, 1, 0), backwards = box(1, 0, 0, 1), nothing = box(0, 0, NAN, 1), point = ring(0, 0, 0, 0),
                  wide = ring(0, 0, 1, 1.5);
    double bow[][2] = {{0, 0}, {1, 1}, {1, 0}, {0, 1}}, twice[][2] = {{0, 0}, {1, 0}, {1, 0}, {0, 1}},
           fold[][2] = {{0, 0}, {2, 0}, {1, 0}, {1, 1}};
    double touching[][2] = {{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}, line[][2] = {{0, 0}, {1, 1}, {2, 2}},
           lost[][2] = {{0, 0}, {1, 0}, {INFINITY, 1}};
    double reversed[][2] = {{0, 0}, {2, 2}, {4, 0}, {4, 3}, {0, 3}, {0, 2}, {1, 2.5}, {3, 0.5}};
    ab_shape_spec bad[] = {flat,
                           backwards,
                           nothing,
                           point,
                           wide,
                           polygon(bow, 4),
                           polygon(twice, 4),
                           polygon(fold, 4),
                           polygon(touching, 5),
                           polygon(line, 3),
                           polygon(lost, 3),
                           polygon(bow, 2),
                           polygon(reversed, 8),
                           {.kind = AB_SHAPE_UNION},
                           {.kind = 77},
                           box(0, 0, 1e9, 1e9),
                           box(0, 0, 1, 1)};
    const char *text[] = {"from 0 to 0 in y",
                          "from 1 to 0 in x",
                          "in x",
                          "radius 0",
                          "inner radius 1.5",
                          "edge 1",
                          "vertices 2 and 3",
                          "edge 1",
                          "edge 1",
                          "meets edge",
                          "vertex 3",
                          "at least 3",
                          "edge 1 of its polygon, (0, 0) to (2, 2), meets edge 7, (1, 2.5)",
                          "no shapes",
                          "kind",
                          "1.6e+19 points",
                          "2.5e+09 points"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        bad[k].mark = mark;
        check_refused(&bad[k], k == 16 ? 25 : 4, k == 16 ? 1e-4 : 0.5, text[k]);
    }
    ab_shape_spec good = box(0, 0, 1, 1);
    good.mark = mark;
    check_refused(&good, 0, 0.5, "at least 1");
    check_refused(&good, 4, 0, "positive");
    ab_shape_spec members[] = {good, bad[3]}, both = {.kind = AB_SHAPE_UNION, .mark = mark, .members = members, .count = 2};
    check_refused(&both, 4, 0.5, "radius 0");
}

static void test_small_shapes_get_a_point_and_a_warning(void **state) {
    (void)state;
    double triangle[][2] = {{0, 0}, {0.1, 0}, {0, 0.1}};
    const ab_shape_spec shapes[] = {box(0, 0, 0.1, 0.1), box(0, 0, 2, 0.1), ring(0, 0, 0.1, 0), ring(0, 0, 1, 0.95), polygon(triangle, 3)};
    const double area[] = {0.01, 0.2, 0.01 * PI, PI * (1 - 0.9025), 0.005},
                 length[] = {0.4, 4.2, 0.2 * PI, 2 * PI * 1.95, 0.2 + 0.1 * sqrt(2)};
    for (size_t k = 0; k < 5; k++)
        for (int rule = AB_FILL_REGULAR; rule <= AB_FILL_GAUSS; rule++) {
            ab_report *report = ab_report_create();
            ab_fill *f = NULL;
            assert_int_equal(ab_fill_create(&shapes[k], rule, 1, 0.5, zero, "body", &f, report), AB_OK);
            assert_true(ab_report_warnings(report) >= 1);
            check_sane(f);
            if (k % 2 == 0) assert_int_equal(f->count, 1);
            near(volume_of(f), area[k], 1e-13);
            near(length_of(f), length[k], 1e-13);
            near(surface_error(f), 0, 1e-14);
            ab_fill_destroy(f);
            ab_report_destroy(report);
        }
    ab_report *report = ab_report_create(); /* gauss of a prime: lopsided is said, hopeless refused */
    const ab_shape_spec shape = box(0, 0, 1, 1);
    ab_fill *f = NULL;
    assert_int_equal(ab_fill_create(&shape, AB_FILL_GAUSS, 7, 0.5, zero, "body", &f, report), AB_OK);
    assert_int_equal(ab_report_warnings(report), 1);
    ab_fill_destroy(f);
    assert_int_equal(ab_fill_create(&shape, AB_FILL_GAUSS, 67, 0.5, zero, "body", &f, report), AB_BAD_INPUT);
    ab_report_destroy(report);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_box_volume_surface_and_centroid_are_exact),
        cmocka_unit_test(test_box_lattice_divides_the_sides),
        cmocka_unit_test(test_where_finds_the_sides),
        cmocka_unit_test(test_disc_and_ring_are_exact_and_symmetric),
        cmocka_unit_test(test_wrong_shapes_are_refused_with_their_place),
        cmocka_unit_test(test_small_shapes_get_a_point_and_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
