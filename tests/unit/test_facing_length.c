/* test_facing_length.c: sizes and areas of the contact points that point-to-segment finds. */
#include "finder_bench.h"

/* ---- sizes and areas ------------------------------------------------------------------------------------------------------------ */

static void test_half_size(void **state) {
    (void)state;
    for (int k = 0; k <= 2; k++) {
        finder f;
        finder_open(&f, "half_size", 0.5 * k);
        surface_body *b = box("box", 0, 0, 1, 1);
        const double place[1][2] = {{0.5, 1.05}};
        surface_body *a = cloud(place, 1, 0.05);
        a->extent[1] = 0.03 * 0.03; /* half width 0.05, half height 0.03 */
        a->area[0] = sqrt(4 * 0.05 * 0.03);
        assert_int_equal(look(&f, a, b, 0.1), 1);
        near(gap(&f, 0), 0.05 - 0.5 * k * 0.03, 1e-15);
        near(f.points.view.area[0], 0.1, 1e-15); /* its width along the face */
        surface_body_destroy(a), surface_body_destroy(b);
        finder_close(&f);
    }
}

/* A strip of `count` faces from (0, y) to (1, y), body above (up) or below. */
static surface_body *strip(size_t count, double y, bool up, bool quadratic) {
    const size_t nodes = quadratic ? 2 * count + 1 : count + 1;
    double corner[128][2];
    for (size_t k = 0; k < nodes; k++) {
        corner[k][0] = up ? (double)k / (double)(nodes - 1) : 1 - (double)k / (double)(nodes - 1);
        corner[k][1] = y;
    }
    size_t n = nodes;
    const double far = up ? y + 1 : y - 1;
    if (quadratic) {
        const double rest[5][2] = {{0, 0.5 * (y + far)}, {0, far}, {0.5, far}, {1, far}, {1, 0.5 * (y + far)}};
        for (int k = 0; k < 5; k++, n++) {
            corner[n][0] = up ? 1 - rest[k][0] : rest[k][0];
            corner[n][1] = rest[k][1];
        }
    } else {
        corner[n][0] = up, corner[n++][1] = far;
        corner[n][0] = !up, corner[n++][1] = far;
    }
    return surface_polygon(up ? "upper" : "lower", (const double(*)[2])corner, n, quadratic, up ? 0 : 1);
}

/* The corners' nodes stand for part of the sides, too, and that does not count. */
static void test_areas_add_up_to_the_length(void **state) {
    (void)state;
    static const size_t counts[][2] = {{1, 1}, {4, 4}, {3, 5}, {7, 2}, {1, 9}};
    for (int passes = 0; passes < 3; passes++)
        for (int quadratic = 0; quadratic < 2; quadratic++)
            for (int k = 0; k < 5; k++) {
                finder f;
                finder_open(&f, "passes", passes);
                surface_body *a = strip(counts[k][0], 1, true, quadratic), *b = strip(counts[k][1], 1, false, quadratic);
                const size_t count = look(&f, a, b, 0.01);
                double area = 0;
                for (size_t i = 0; i < count; i++) {
                    area += f.points.view.area[i];
                    near(ny(&f, i), -1, 1e-12);
                }
                near(area, 1, 1e-13);
                surface_body_destroy(a), surface_body_destroy(b);
                finder_close(&f);
            }
    /* a small block on a long plane whose vertices are far away: nobody shares */
    finder f;
    finder_open(&f, NULL, 0);
    surface_body *a = strip(4, 0, true, false), *b = box("plane", -50, -1, 50, 0);
    const size_t count = look(&f, a, b, 0.01);
    assert_int_equal(count, 5);
    double area = 0;
    for (size_t i = 0; i < count; i++) area += f.points.view.area[i];
    near(area, 1, 1e-13);
    surface_body_destroy(a), surface_body_destroy(b);
    finder_close(&f);
}

/* A row of equal faces along the upper (lower body) or lower side (upper body) of a box, turned by an angle about the origin. */
static surface_body *block(size_t faces, double x0, double x1, double height, double angle) {
    double corner[64][2];
    for (size_t k = 0; k <= faces; k++) {
        const double s = (double)k / (double)faces;
        corner[k][0] = height > 0 ? x0 + s * (x1 - x0) : x1 + s * (x0 - x1);
        corner[k][1] = 0;
    }
    corner[faces + 1][0] = corner[faces][0], corner[faces + 2][0] = corner[0][0];
    corner[faces + 1][1] = corner[faces + 2][1] = height;
    for (size_t k = 0; k < faces + 3; k++) {
        const double x = corner[k][0], y = corner[k][1];
        corner[k][0] = x * cos(angle) - y * sin(angle);
        corner[k][1] = x * sin(angle) + y * cos(angle);
    }
    return surface_polygon(height > 0 ? "block" : "bed", (const double(*)[2])corner, faces + 3, false, height > 0 ? 0 : 1);
}

/* Material points along the lower side of a block, squares that fill it. */
static surface_body *row_of_points(size_t count, double x0, double x1, double angle) {
    surface_body *b = surface_body_create("points", count, 0, 0);
    const double width = (x1 - x0) / (double)count;
    for (size_t k = 0; k < count; k++) {
        const double x = x0 + ((double)k + 0.5) * width, y = 0.5 * width;
        surface_body_put(b, k, x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle));
        b->extent[k] = b->extent[count + k] = 0.25 * width * width;
        b->area[k] = width;
    }
    return b;
}

/* A block on a longer bed, and over its end by a third, whatever the sizes of their faces: the points of one pass alone stand for the length over which the bodies
 * face each other, and in both passes each has half of it, where there are nodes on both sides. */
static void test_areas_where_faces_do_not_match(void **state) {
    (void)state;
    enum { CASES = 9 };
    static const size_t counts[CASES][2] = {{1, 48}, {48, 1}, {21, 8}, {7, 24}, {8, 21}, {5, 16}, {7, 1}, {1, 13}, {30, 31}};
    static const double width = 0.7, from[2] = {0.113, 1.7 - 2 * 0.7 / 3}, facing[2] = {0.7, 2 * 0.7 / 3};
    for (int turned = 0; turned < 2; turned++)
        for (int hangs = 0; hangs < 2; hangs++)
            for (int passes = 0; passes < 3; passes++)
                for (int k = 0; k < CASES; k++) {
                    const double angle = turned * 0.5235987755982988;
                    surface_body *b = block(counts[k][1], -0.7, 1.7, -0.2, angle);
                    for (int points = 0; points < 2; points++) {
                        finder f;
                        if (points && (passes == 2 || counts[k][0] < 5)) continue;
                        if (points && hangs && counts[k][0] % 3 == 2)
                            continue; /* the last centre is beyond the end, and no contact point */
                        finder_open(&f, "passes", passes);
                        surface_body *a = points ? row_of_points(counts[k][0], from[hangs], from[hangs] + width, angle)
                                                 : block(counts[k][0], from[hangs], from[hangs] + width, 0.2, angle);
                        const size_t count = look(&f, a, b, 0.0015);
                        double area[2] = {0, 0};
                        for (size_t i = 0; i < count; i++) {
                            assert_true(f.points.view.area[i] > 0);
                            area[f.points.view.key[i] >> 2 & 1] += f.points.view.area[i];
                        }
                        const double all = area[0] + area[1], off = fabs(all / facing[hangs] - 1),
                                     half = fabs(2 * area[0] / facing[hangs] - 1);
                        /* no node of the bed, or of the block, lies over the other body: then that pass has no point */
                        if (count && off > 0.02)
                            print_message("%s, faces %zu on %zu, turned %d, hanging %d, passes %d: %.4f\n", points ? "points" : "nodes",
                                          counts[k][0], counts[k][1], turned, hangs, passes, all / facing[hangs]);
                        if (count) assert_true(off <= 0.02);
                        if (passes == 0) assert_true(count > 0);
                        if (passes == 0 && !points && area[1] > 0 && counts[k][0] > 1) assert_true(half <= 0.02);
                        surface_body_destroy(a);
                        finder_close(&f);
                    }
                    surface_body_destroy(b);
                }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_half_size),
        cmocka_unit_test(test_areas_add_up_to_the_length),
        cmocka_unit_test(test_areas_where_faces_do_not_match),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
