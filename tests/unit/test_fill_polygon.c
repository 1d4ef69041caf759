/* test_fill_polygon.c: polygons: exact whatever the lattice cuts, points inside, a surface close to the outline, mirrored and turned shapes alike. */
#include "effort.h"
#include "fill_checks.h"

static void test_turned_rectangle_is_the_box_turned(void **state) {
    (void)state;
    const double angles[] = {0, 30, 45, 90, 137, -60};
    for (int rule = AB_FILL_REGULAR; rule <= AB_FILL_GAUSS; rule++)
        for (int per_cell = 1; per_cell <= 16; per_cell += EFFORT(1, 5))
            for (size_t a = 0; a < sizeof angles / sizeof *angles; a++) {
                const double c = cos(angles[a] * PI / 180), s = sin(angles[a] * PI / 180), m[4] = {c, -s, s, c};
                double flat[4][2] = {{-0.8, 0.3}, {1.4, 0.3}, {1.4, 1.25}, {-0.8, 1.25}}, v[4][2];
                move_vertices(flat, 4, m, v);
                const ab_shape_spec upright = box(-0.8, 0.3, 1.4, 1.25), turned = polygon(v, 4);
                ab_fill *b = fill_of(&upright, rule, per_cell, 0.25), *p = fill_of(&turned, rule, per_cell, 0.25);
                check_sane(p);
                check_same_points(b, m, p);
                near(surface_error(p), 0, 1e-13);
                near(length_of(p), 2 * (2.2 + 0.95), 1e-12);
                ab_fill_destroy(b);
                ab_fill_destroy(p);
            }
}

static void test_right_angled_polygons_fit_the_lattice(void **state) {
    (void)state;
    double shapes[][8][2] = {
        {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}},                                 /* commensurate */
        {{0, 0}, {3, 0}, {3, 1.234567}, {0.987654, 1.234567}, {0.987654, 2.2}, {0, 2.2}}, /* not */
        {{0, 0}, {4, 0}, {4, 1}, {2.5, 1}, {2.5, 0.5}, {1.5, 0.5}, {1.5, 1}, {0, 1}},
    };
    const size_t count[] = {6, 6, 8};
    for (int rule = AB_FILL_REGULAR; rule <= AB_FILL_GAUSS; rule++)
        for (int per_cell = 1; per_cell <= 16; per_cell += EFFORT(1, 5))
            for (size_t s = 0; s < 3; s++)
                for (int turned = 0; turned < 2; turned++) {
                    const double m[4] = {cos(0.5 * turned), -sin(0.5 * turned), sin(0.5 * turned), cos(0.5 * turned)};
                    double v[8][2];
                    move_vertices(shapes[s], count[s], m, v);
                    near(check_polygon(v, count[s], rule, per_cell, 0.3), 0, 1e-12);
                }
    const ab_shape_spec shape = polygon(shapes[0], 6);
    ab_fill *f = fill_of(&shape, AB_FILL_REGULAR, 4, 0.5);
    assert_int_equal(f->count, 5 * 16);
    ab_fill_destroy(f);
    f = fill_of(&shape, AB_FILL_GAUSS, 4, 0.5);
    assert_int_equal(f->count, 5 * 16);
    assert_int_equal(f->surface_count, 12 * 4);
    ab_fill_destroy(f);
}

/* Shapes with slopes, notches and points, fine and coarse against their features. */
static void test_sloped_polygons_are_exact_and_keep_points_inside(void **state) {
    (void)state;
    double arrow[][2] = {{0, 0}, {3, 1}, {0, 2}, {1, 1}}, needle[][2] = {{0, 0}, {10, 0.05}, {10, 0.1}}, gear[40][2], saw[42][2];
    for (int k = 0; k < 40; k++) gear[k][0] = (k % 2 ? 2 : 1.3) * cos(PI / 20 * k), gear[k][1] = (k % 2 ? 2 : 1.3) * sin(PI / 20 * k);
    for (int k = 0; k < 40; k++) saw[k][0] = 4 - 0.1 * k, saw[k][1] = k % 2 ? 1 : 0.12; /* teeth thinner than a cell */
    saw[40][0] = 0.1, saw[40][1] = 0, saw[41][0] = 4, saw[41][1] = 0;
    const struct {
        double (*v)[2];
        size_t n;
    } shapes[] = {{arrow, 4}, {needle, 3}, {gear, 40}, {saw, 42}};
    const int per_cell[] = {1, 4, 7};
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++)
        for (int rule = AB_FILL_REGULAR; rule <= AB_FILL_GAUSS; rule++)
            for (size_t n = 0; n < 3; n++)
                for (double cell = 0.1; cell < 2; cell *= 1.61) check_polygon(shapes[s].v, shapes[s].n, rule, per_cell[n], cell);
}

/* Convex corners: the largest difference between half size and distance, as a part of the distance between points. */
static void test_surface_of_slopes_stands_close_to_the_outline(void **state) {
    (void)state;
    double triangle[][2] = {{0, 0}, {4, 0}, {4, 2.5}}, slope[][2] = {{0, 0}, {10, 0}, {10, 2}, {6, 2}, {3, 4}, {0, 4}},
           wedge[][2] = {{0, 0}, {2, 0.2}, {0, 0.2}};
    double hexagon[6][2], circle[90][2];
    for (int k = 0; k < 6; k++) hexagon[k][0] = 2 * cos(PI / 3 * k), hexagon[k][1] = 2 * sin(PI / 3 * k);
    for (int k = 0; k < 90; k++) circle[k][0] = 2 * cos(PI / 45 * k), circle[k][1] = 2 * sin(PI / 45 * k);
    const struct {
        const char *name;
        double (*v)[2];
        size_t n;
        double hold;
    } shapes[] = {{"triangle", triangle, 3, 1e-10},
                  {"slope", slope, 6, 1e-10},
                  {"hexagon", hexagon, 6, 1e-10},
                  {"wedge", wedge, 3, 0.01},
                  {"90 edges", circle, 90, 0.1}};
    const int per_cell[] = {1, 3, 4, 5, 16};
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        double worst = 0;
        for (int rule = AB_FILL_REGULAR; rule <= AB_FILL_GAUSS; rule++)
            for (size_t n = 0; n < 5; n++)
                for (double cell = 0.15; cell < 0.5; cell *= 1.41)
                    worst = fmax(worst, check_polygon(shapes[s].v, shapes[s].n, rule, per_cell[n], cell));
        print_message("%-9s half size and distance to the outline differ by %.1e of the distance between points at most\n", shapes[s].name,
                      worst);
        assert_true(worst < shapes[s].hold);
    }
}

static void test_random_polygons(void **state) {
    (void)state;
    uint64_t seed = 12345;
    for (int trial = 0; trial < 60; trial++) {
        double v[60][2], turn = 0, gap[60];
        size_t n = 3 + (size_t)(trial % 58);
        for (size_t k = 0; k < n; k++) { /* a star about the origin: whatever the radii, no edges cross */
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            gap[k] = 0.2 + (double)(seed >> 40) / (1 << 24);
            turn += gap[k];
        }
        double angle = 0;
        for (size_t k = 0; k < n; k++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            const double radius = 0.2 + 2.0 * (double)(seed >> 40) / (1 << 24);
            angle += 2 * PI * gap[k] / turn;
            v[k][0] = radius * cos(angle) + 1e3 * (trial % 3);
            v[k][1] = radius * sin(angle);
        }
        if (trial % 2) { /* clockwise */
            for (size_t k = 0; k < n / 2; k++)
                for (int c = 0; c < 2; c++) {
                    const double swap = v[k][c];
                    v[k][c] = v[n - 1 - k][c];
                    v[n - 1 - k][c] = swap;
                }
        }
        check_polygon(v, n, trial / 2 % 2 ? AB_FILL_REGULAR : AB_FILL_GAUSS, 1 + trial % 9, 0.07 * (1 + trial % 11));
    }
}

static void test_mirrored_and_turned_polygons(void **state) {
    (void)state;
    const double moves[][4] = {{0, -1, 1, 0}, {-1, 0, 0, 1}, {1, 0, 0, -1}, {0, 1, 1, 0}};
    double slope[][2] = {{0.1, 0}, {10, 0}, {10, 2}, {6, 2}, {3.3, 4}, {0.1, 4.2}}, isosceles[][2] = {{-1, 0}, {1, 0}, {0, 3}}, to[6][2];
    for (int rule = AB_FILL_REGULAR; rule <= AB_FILL_GAUSS; rule++)
        for (int per_cell = 1; per_cell <= 9; per_cell += EFFORT(1, 4))
            for (size_t m = 0; m < 4; m++) {
                const ab_shape_spec shape = polygon(slope, 6), tip = polygon(isosceles, 3);
                move_vertices(slope, 6, moves[m], to);
                const ab_shape_spec other = polygon(to, 6);
                ab_fill *a = fill_of(&shape, rule, per_cell, 0.31), *b = fill_of(&other, rule, per_cell, 0.31);
                check_same_points(a, moves[m], b);
                ab_fill_destroy(a);
                ab_fill_destroy(b);
                a = fill_of(&tip, rule, per_cell, 0.31);
                if (m == 1) check_same_points(a, moves[m], a);
                ab_fill_destroy(a);
            }
}

static void test_a_million_points_in_a_polygon(void **state) {
    (void)state;
    double slope[][2] = {{0, 0}, {10, 0}, {10, 2}, {6, 2}, {3, 4}, {0, 4}};
    const ab_shape_spec shape = polygon(slope, 6);
    ab_fill *f = fill_of(&shape, AB_FILL_REGULAR, 16, 4 * sqrt(29e-6));
    near((double)f->count, 1e6, 1e4);
    near(volume_of(f), 29, 29e-12);
    near(length_of(f), 10 + 2 + 4 + hypot(3, 2) + 3 + 4, 1e-11);
    ab_fill_destroy(f);
}

/* A thin bent strip: its bounding box has a thousand times its area. */
static void test_cost_follows_the_material_not_its_box(void **state) {
    (void)state;
    double strip[202][2];
    for (int k = 0; k <= 100; k++) {
        const double angle = PI / 100 * k;
        strip[k][0] = 4000 * cos(angle), strip[k][1] = 4000 * sin(angle);
        strip[201 - k][0] = 3999 * cos(angle), strip[201 - k][1] = 3999 * sin(angle);
    }
    assert_true(check_polygon(strip, 202, AB_FILL_REGULAR, 1, 0.5) < 0.6); /* 25000 points in a lattice of 16000 x 8000 */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_turned_rectangle_is_the_box_turned),
        cmocka_unit_test(test_right_angled_polygons_fit_the_lattice),
        cmocka_unit_test(test_sloped_polygons_are_exact_and_keep_points_inside),
        cmocka_unit_test(test_surface_of_slopes_stands_close_to_the_outline),
        cmocka_unit_test(test_random_polygons),
        cmocka_unit_test(test_mirrored_and_turned_polygons),
        cmocka_unit_test(test_a_million_points_in_a_polygon),
        cmocka_unit_test(test_cost_follows_the_material_not_its_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
