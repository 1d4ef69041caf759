/* test_fill_union.c: unions: no outline where members touch, one outline where they overlap. */
#include "fill_checks.h"

static double union_of(ab_shape_spec *members, size_t count, ab_fill_rule rule, int per_cell, double cell, double *length, double *error) {
    const ab_shape_spec shape = {.kind = AB_SHAPE_UNION, .members = members, .count = count};
    ab_fill *f = fill_of(&shape, rule, per_cell, cell);
    check_sane(f);
    const double volume = volume_of(f);
    *length = length_of(f);
    *error = surface_error(f);
    ab_fill_destroy(f);
    return volume;
}

static void test_touching_members_have_no_outline_between_them(void **state) {
    (void)state;
#ifndef ABUT_WITH_GEOS
    skip();
#endif
    double length, error;
    ab_shape_spec ell[] = {box(0, 0, 3, 1), box(0, 1, 1, 3)};
    near(union_of(ell, 2, AB_FILL_REGULAR, 4, 0.31, &length, &error), 5, 5e-12);
    near(length, 12, 1e-11);
    near(error, 0, 1e-14);
    ab_shape_spec tee[] = {box(0, 0, 3.3, 1), box(1.013, 1, 1.977, 2)}; /* leaves parts of pieces on both sides */
    near(union_of(tee, 2, AB_FILL_GAUSS, 9, 0.5, &length, &error), 3.3 + 0.964, 5e-12);
    near(length, 2 * 4.3 + 2, 1e-11);
    near(error, 0, 1e-14);
    ab_shape_spec target[] = {ring(0, 0, 1, 0), ring(0, 0, 2, 1)};
    near(union_of(target, 2, AB_FILL_REGULAR, 4, 0.3, &length, &error), 4 * PI, 1e-11);
    near(length, 4 * PI, 1e-11);
    ab_shape_spec on_plane[] = {ring(0, 1, 1, 0), box(-2, -1, 2, 0), ring(3, -0.5, 1, 0)};
    near(union_of(on_plane, 3, AB_FILL_REGULAR, 4, 0.3, &length, &error), 2 * PI + 4, 1e-11);
    near(length, 4 * PI + 10, 1e-11);
    double triangle[][2] = {{1, 0}, {0, 1}, {0, 0}}, other[][2] = {{1, 0}, {1, 1}, {0, 1}};
    ab_shape_spec square[] = {polygon(triangle, 3), polygon(other, 3)};
    near(union_of(square, 2, AB_FILL_REGULAR, 4, 0.1, &length, &error), 1, 1e-12);
    near(length, 4, 1e-11);
    ab_shape_spec corner[] = {box(0, 0, 1, 1), box(1, 1, 2, 2)};
    near(union_of(corner, 2, AB_FILL_REGULAR, 4, 0.1, &length, &error), 2, 1e-12);
    near(length, 8, 1e-11);
}

static void test_overlapping_members_are_joined(void **state) {
    (void)state;
#ifndef ABUT_WITH_GEOS
    skip();
#endif
    double length, error;
    ab_shape_spec cross[] = {box(-2, -0.5, 2, 0.5), box(-0.5, -2, 0.5, 2)};
    near(union_of(cross, 2, AB_FILL_REGULAR, 4, 0.25, &length, &error), 7, 7e-12);
    near(length, 16, 1e-11);
    near(error, 0, 1e-13);
    near(union_of(cross, 2, AB_FILL_GAUSS, 9, 0.31, &length, &error), 7, 7e-12);
    near(length, 16, 1e-11);
    near(error, 0, 1e-13);
    ab_shape_spec same[] = {box(0, 0, 1, 1), box(0, 0, 1, 1), box(0.2, 0.2, 0.4, 0.4)};
    near(union_of(same, 3, AB_FILL_REGULAR, 4, 0.25, &length, &error), 1, 1e-12);
    near(length, 4, 1e-11);
    ab_shape_spec frame[] = {box(0, 0, 4, 1), box(0, 3, 4, 4), box(0, 0.5, 1, 3.5), box(3, 0.5, 4, 3.5)}; /* leaves a hole */
    near(union_of(frame, 4, AB_FILL_REGULAR, 5, 0.3, &length, &error), 12, 12e-12);
    near(length, 24, 1e-10);
    near(error, 0, 1e-12);
    ab_shape_spec capsule[] = {box(0, -1, 3, 1), ring(0, 0, 1, 0), ring(3, 0, 1, 0)};
    near(union_of(capsule, 3, AB_FILL_REGULAR, 4, 0.2, &length, &error), 6 + PI, 1e-3); /* discs become polygons */
    near(length, 6 + 2 * PI, 2e-2);
    ab_shape_spec inner[] = {cross[0], cross[1]};
    ab_shape_spec nested[] = {{.kind = AB_SHAPE_UNION, .members = inner, .count = 2}, box(2, -0.5, 3, 0.5)};
    near(union_of(nested, 2, AB_FILL_REGULAR, 4, 0.25, &length, &error), 8, 8e-12);
    near(length, 18, 1e-11);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_touching_members_have_no_outline_between_them),
        cmocka_unit_test(test_overlapping_members_are_joined),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
