/* test_fill_cvt.c: centroidal Voronoi fills: exact masses, points inside at the centroids of their cells, the same for any number of threads and wherever the body stands. */
#include "effort.h"
#include "fill_checks.h"

static double ell[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, star[10][2], frame[4][2] = {{0, 0}, {3, 0}, {3, 2}, {0, 2}},
              window[2][4][2] = {{{0.5, 0.5}, {1.25, 0.5}, {1.25, 1.5}, {0.5, 1.5}}, {{2.5, 0.4}, {2.75, 1.5}, {2, 1.6}, {1.75, 0.9}}},
              slit[8][2] = {{0, 0}, {1, 0}, {1, 1}, {0.51, 1}, {0.505, 0.2}, {0.495, 0.2}, {0.49, 1}, {0, 1}},
              hook[8][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 1.02}, {3, 1.02}, {3, 2}, {0, 2}};
static ab_shape_spec holes[2], members[3];

static ab_fill *cvt(const ab_shape_spec *shape, size_t points, uint64_t seed, double tolerance, int threads) {
    ab_report *report = ab_report_create();
    const ab_fill_request request = {.rule = AB_FILL_CVT,
                                     .per_cell = 4,
                                     .cell = 1e3,
                                     .points = points,
                                     .seed = seed,
                                     .tolerance = tolerance,
                                     .iterations = points > 20 ? 1000 : 100,
                                     .threads = threads};
    ab_fill *fill = NULL;
    const ab_status status = ab_fill_make(shape, &request, "body", &fill, report);
    if (status != AB_OK) ab_report_print(report, stderr);
    assert_int_equal(status, AB_OK);
    if (points > 20)
        assert_int_equal(ab_report_warnings(report), 0); /* it has converged; a handful in a bent body need not, see mpm/fill_voronoi.c */
    ab_report_destroy(report);
    if (points > 0) assert_int_equal(fill->count, points);
    return fill;
}

typedef struct sample {
    const char *name;
    ab_shape_spec shape;
    double area, length;
    bool round; /* normals of arcs do not close to rounding */
} sample;

enum { SAMPLES = 9 };

static const sample *samples(void) {
    static sample list[SAMPLES];
    for (int k = 0; k < 10; k++) star[k][0] = (k % 2 ? 0.4 : 1) * cos(PI / 5 * k), star[k][1] = (k % 2 ? 0.4 : 1) * sin(PI / 5 * k);
    for (int k = 0; k < 2; k++) holes[k] = polygon(window[k], 4);
    members[0] = box(0, 0, 2, 1), members[1] = box(2, 0.25, 3, 0.75), members[2] = box(2.5, 0.5, 4, 1.5); /* touching, overlapping */
    ab_shape_spec pierced = polygon(frame, 4);
    pierced.holes = holes;
    pierced.hole_count = 2;
    list[0] = (sample){"box", box(-1, 2, 1.5, 3), 2.5, 7, false};
    list[1] = (sample){"disc", ring(3, -2, 1.5, 0), 2.25 * PI, 3 * PI, true};
    list[2] = (sample){"ring", ring(0, 0, 1, 0.6), 0.64 * PI, 3.2 * PI, true};
    list[3] = (sample){"ell", polygon(ell, 6), shoelace(ell, 6), perimeter(ell, 6), false};
    list[4] = (sample){"star", polygon(star, 10), shoelace(star, 10), perimeter(star, 10), false};
    list[5] = (sample){"window", pierced, 6 - shoelace(window[0], 4) - shoelace(window[1], 4),
                       10 + perimeter(window[0], 4) + perimeter(window[1], 4), false};
    list[6] = (sample){"slit", polygon(slit, 8), shoelace(slit, 8), perimeter(slit, 8), false};
    list[7] = (sample){"hook", polygon(hook, 8), shoelace(hook, 8), perimeter(hook, 8), false};
    list[8] = (sample){"union", {.kind = AB_SHAPE_UNION, .members = members, .count = 3}, 2 + 0.5 + 1.5 - 0.125, 5.5 + 1.75 + 4.25, false};
    return list;
}

static double out_of(const sample *s, double x, double y) {
    const ab_shape_spec *h = &s->shape;
    if (h->kind == AB_SHAPE_BOX) return fmax(fmax(h->low[0] - x, x - h->high[0]), fmax(h->low[1] - y, y - h->high[1])) > 0;
    if (h->kind == AB_SHAPE_DISC || h->kind == AB_SHAPE_RING) {
        const double r = hypot(x - h->center[0], y - h->center[1]);
        return r > h->radius || r < h->inner;
    }
    if (h->kind == AB_SHAPE_UNION) {
        for (size_t k = 0; k < h->count; k++)
            if (x > h->members[k].low[0] && x < h->members[k].high[0] && y > h->members[k].low[1] && y < h->members[k].high[1]) return 0;
        return 1;
    }
    for (size_t k = 0; k < h->hole_count; k++)
        if (outside(h->holes[k].vertices, h->holes[k].count, x, y) == 0) return 1;
    return outside(h->vertices, h->count, x, y) > 0;
}

static void test_any_shape_and_number_is_exact_and_inside(void **state) {
    (void)state;
    const size_t numbers[] = {1, 2, 3, 5, 10, 57, 110};
    const sample *list = samples();
    for (int s = 0; s < SAMPLES; s += EFFORT(1, 3))
        for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++) {
            ab_fill *f = cvt(&list[s].shape, numbers[n], 7, numbers[n] > 20 ? 1e-2 : 0, 1);
            near(volume_of(f), list[s].area, 1e-12 * list[s].area);
            near(length_of(f), list[s].length, 1e-12 * list[s].length);
            double closed[2] = {0, 0};
            for (size_t k = 0; k < f->surface_count; k++)
                for (int c = 0; c < 2; c++) closed[c] += f->surface[k].normal[c] * f->surface[k].length;
            if (!list[s].round) near(hypot(closed[0], closed[1]), 0, 1e-12 * list[s].length);
            for (size_t p = 0; p < f->count; p++) {
                const double *a = &f->extent[3 * p];
                assert_true(f->volume[p] > 0 && a[0] > 0 && a[1] > 0 && a[0] * a[1] > a[2] * a[2]);
                if (out_of(&list[s], f->x[p], f->y[p]) != 0)
                    fail_msg("%s, %zu points: (%g, %g) is outside", list[s].name, numbers[n], f->x[p], f->y[p]);
            }
            ab_fill_destroy(f);
        }
}

/* The first moment of a body is that of its points, where no cell is cut apart. */
static void test_centre_of_mass_is_that_of_the_shape(void **state) {
    (void)state;
    const sample *list = samples();
    const double centre[4][2] = {{0.25, 2.5}, {3, -2}, {0, 0}, {5.0 / 6, 5.0 / 6}};
    for (int s = 0; s < 4; s++) {
        ab_fill *f = cvt(&list[s].shape, EFFORT(300, 80), 1, 0, 1);
        near(moment_of(f, f->x), list[s].area * centre[s][0], 1e-12);
        near(moment_of(f, f->y), list[s].area * centre[s][1], 1e-12);
        ab_fill_destroy(f);
    }
}

/* Against cells made another way: samples of a fine lattice, each given to the nearest point. */
static void test_points_stand_at_the_centroids_of_their_cells(void **state) {
    (void)state;
    const sample *list = samples();
    enum { FINE = 700, POINTS = 40 };
    for (int s = 3; s <= EFFORT(5, 3); s += 2) { /* a corner that looks inwards, holes */
        ab_fill *f = cvt(&list[s].shape, POINTS, 3, 1e-6, 1);
        double m[POINTS][6] = {{0}}, step[2];
        for (int k = 0; k < 2; k++) step[k] = (f->high[k] - f->low[k]) / FINE;
        for (int j = 0; j < FINE; j++)
            for (int i = 0; i < FINE; i++) {
                const double x = f->low[0] + (i + 0.5) * step[0], y = f->low[1] + (j + 0.5) * step[1];
                if (out_of(&list[s], x, y) != 0) continue;
                size_t best = 0;
                double nearest = INFINITY;
                for (size_t p = 0; p < POINTS; p++) {
                    const double d = (x - f->x[p]) * (x - f->x[p]) + (y - f->y[p]) * (y - f->y[p]);
                    if (d < nearest) nearest = d, best = p;
                }
                const double add[6] = {1, x, y, x * x, y * y, x * y};
                for (int k = 0; k < 6; k++) m[best][k] += add[k];
            }
        const double spacing = sqrt(list[s].area / POINTS);
        for (size_t p = 0; p < POINTS; p++) {
            const double x = m[p][1] / m[p][0], y = m[p][2] / m[p][0];
            near(f->x[p], x, 4e-3 * spacing);
            near(f->y[p], y, 4e-3 * spacing);
            near(f->volume[p], m[p][0] * step[0] * step[1], 1e-2 * f->volume[p]);
        }
        ab_fill_destroy(f);
    }
}

/* In a large body nearly all cells are hexagons: their moment about the point, by area squared, is 5 sqrt(3)/54 = 0.1604 (a square has 1/6), and the extents say so. */
static void test_cells_are_close_to_hexagons(void **state) {
    (void)state;
    const ab_shape_spec shape = box(0, 0, 1, 1);
    ab_fill *f = cvt(&shape, 1500, 1, 1e-2, 1);
    double sum = 0;
    for (size_t p = 0; p < f->count; p++) sum += (f->extent[3 * p] + f->extent[3 * p + 1]) / 3 / f->volume[p];
    sum /= (double)f->count;
    assert_true(sum > 0.1604);
    near(sum, 0.1604, 0.0025);
    ab_fill_destroy(f);
}

static void test_two_points_halve_a_box(void **state) {
    (void)state;
    const ab_shape_spec shape = box(0, 0, 2, 1);
    ab_fill *f = cvt(&shape, 2, 5, 1e-9, 1);
    const int left = f->x[0] < f->x[1] ? 0 : 1;
    near(f->x[left], 0.5, 1e-8);
    near(f->x[1 - left], 1.5, 1e-8);
    for (int p = 0; p < 2; p++) {
        near(f->y[p], 0.5, 1e-8);
        near(f->volume[p], 1, 1e-8);
        near(f->extent[3 * p], 0.25, 1e-8); /* square cells: half their side, squared */
        near(f->extent[3 * p + 1], 0.25, 1e-8);
        near(f->extent[3 * p + 2], 0, 1e-8);
    }
    ab_fill_destroy(f);
}

static void same(const ab_fill *a, const ab_fill *b, double scale, double x, double y, double tolerance) {
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->surface_count, b->surface_count);
    for (size_t p = 0; p < a->count; p++) {
        near(b->x[p], scale * a->x[p] + x, tolerance);
        near(b->y[p], scale * a->y[p] + y, tolerance);
        near(b->volume[p], scale * scale * a->volume[p], tolerance);
        for (int c = 0; c < 3; c++) near(b->extent[3 * p + (size_t)c], scale * scale * a->extent[3 * p + (size_t)c], tolerance);
    }
}

static void test_same_for_any_threads_and_another_for_another_seed(void **state) {
    (void)state;
    const sample *list = samples();
    for (int s = 1; s < EFFORT(6, 4); s += 2) {
        ab_fill *a = cvt(&list[s].shape, EFFORT(1200, 120), 11, 5e-2, 1), *b = cvt(&list[s].shape, EFFORT(1200, 120), 11, 5e-2, 3),
                *c = cvt(&list[s].shape, EFFORT(1200, 120), 12, 5e-2, 1);
        assert_memory_equal(a->x, b->x, a->count * sizeof *a->x);
        assert_memory_equal(a->y, b->y, a->count * sizeof *a->y);
        assert_memory_equal(a->volume, b->volume, a->count * sizeof *a->volume);
        assert_memory_equal(a->extent, b->extent, 3 * a->count * sizeof *a->extent);
        assert_memory_not_equal(a->x, c->x, a->count * sizeof *a->x);
        ab_fill_destroy(a), ab_fill_destroy(b), ab_fill_destroy(c);
    }
}

static void test_moved_and_scaled_bodies_have_moved_and_scaled_points(void **state) {
    (void)state;
    double there[6][2];
    const ab_shape_spec here = polygon(ell, 6);
    ab_fill *a = cvt(&here, 200, 4, 1e-3, 1);
    const double moves[3][3] = {{4, 8, -16}, {0.001, 0.3, 0.7}, {1, 1e5, -3e5}};
    for (int m = 0; m < 3; m++) {
        for (int k = 0; k < 6; k++)
            for (int c = 0; c < 2; c++) there[k][c] = moves[m][0] * ell[k][c] + moves[m][1 + c];
        const ab_shape_spec shape = polygon(there, 6);
        ab_fill *b = cvt(&shape, 200, 4, 1e-3, 1);
        same(a, b, moves[m][0], moves[m][1], moves[m][2], m == 0 ? 1e-12 : m == 1 ? 1e-10 : 1e-6);
        ab_fill_destroy(b);
    }
    ab_fill_destroy(a);
}

/* Half size against distance of the outline, in distances between points: by length, and the worst piece (where a corner looks inwards, or is narrow). */
static void test_surface_stands_near_the_outline(void **state) {
    (void)state;
    const sample *list = samples();
    const double mean[SAMPLES] = {1e-12, 1e-12, 1e-12, 0.04, 0.04, 0.04, 0.05, 0.05, 0.05},
                 worst[SAMPLES] = {1e-12, 1e-12, 1e-12, 1, 1, 1, 1, 1, 1};
    for (int s = 0; s < SAMPLES; s += EFFORT(1, 3)) {
        double sum = 0, length = 0, most = 0;
        for (uint64_t seed = 1; seed <= 2; seed++) {
            ab_fill *f = cvt(&list[s].shape, 400, seed, 2e-2, 1);
            const double spacing = sqrt(list[s].area / 400);
            for (size_t k = 0; k < f->surface_count; k++) {
                const ab_outline_piece *q = &f->surface[k];
                const double *a = &f->extent[3 * (size_t)q->point], *n = q->normal;
                const double half = sqrt(n[0] * n[0] * a[0] + n[1] * n[1] * a[1] + 2 * n[0] * n[1] * a[2]);
                const double away = n[0] * (q->position[0] - f->x[q->point]) + n[1] * (q->position[1] - f->y[q->point]);
                sum += q->length * (half - away) * (half - away) / (spacing * spacing);
                length += q->length;
                most = fmax(most, fabs(half - away) / spacing);
            }
            ab_fill_destroy(f);
        }
        if (getenv("SHOW"))
            print_message("%-8s rms %.2g  max %.2g of the distance between points\n", list[s].name, sqrt(sum / length), most);
        assert_true(sqrt(sum / length) < mean[s]);
        assert_true(most < worst[s]); /* a point at an inner corner faces sides that one tensor cannot all meet */
    }
}

/* ---- what cannot be filled ---------------------------------------------------------------------------------------------- */

static void refused(const ab_shape_spec *shape, const ab_fill_request *request, const char *why) {
    ab_report *report = ab_report_create();
    ab_fill *fill = NULL;
    assert_int_equal(ab_fill_make(shape, request, "body", &fill, report), AB_BAD_INPUT);
    assert_null(fill);
    const char *text = ab_report_first_error(report);
    if (!text || !strstr(text, why)) fail_msg("'%s' does not say '%s'", text ? text : "", why);
    ab_report_destroy(report);
}

static void test_hostile_shapes_are_refused_by_name(void **state) {
    (void)state;
    const ab_fill_request ten = {.rule = AB_FILL_CVT, .per_cell = 4, .cell = 1, .points = 10},
                          many = {.rule = AB_FILL_CVT, .per_cell = 4, .cell = 1, .points = 1000001},
                          fine = {.rule = AB_FILL_CVT, .per_cell = 4, .cell = 1e-6};
    double flat[3][2] = {{0, 0}, {1, 1}, {2, 2}}, bow[4][2] = {{0, 0}, {1, 1}, {1, 0}, {0, 1}}, nan[3][2] = {{0, 0}, {1, NAN}, {1, 0}};
    double far[3][2] = {{5, 5}, {6, 5}, {6, 6}}, across[3][2] = {{1, 1}, {4, 1}, {4, 1.5}}, small[3][2] = {{0.8, 0.8}, {1, 0.8}, {1, 1}};
    const ab_shape_spec unit = box(0, 0, 1, 1), line = polygon(flat, 3), crossed = polygon(bow, 4), wrong = polygon(nan, 3);
    refused(&unit, &many, "more than the 1000000");
    refused(&unit, &fine, "more than the 1000000");
    refused(&line, &ten, "its polygon");
    refused(&crossed, &ten, "meets edge");
    refused(&wrong, &ten, "vertex 2");
    ab_shape_spec pierced = polygon(frame, 4), hole[2] = {polygon(far, 3), polygon(window[0], 4)};
    pierced.holes = hole;
    pierced.hole_count = 1;
    refused(&pierced, &ten, "outside of the polygon");
    hole[0] = polygon(across, 3);
    refused(&pierced, &ten, "meets edge");
    hole[0] = polygon(small, 3);
    pierced.hole_count = 2;
    refused(&pierced, &ten, "inside of another hole");
    const ab_shape_spec none = {.kind = AB_SHAPE_UNION};
    refused(&none, &ten, "at least one");
}

static void test_extreme_sizes_and_numbers_work(void **state) {
    (void)state;
    const ab_shape_spec tiny = ring(1, 1, 1e-9, 0), thin = ring(0, 0, 1, 0.9999), strip = box(0, 0, 1000, 1e-3),
                        huge = box(-1e12, 0, 1e12, 1e12);
    double needle[3][2] = {{0, 0}, {10, 10.05}, {10, 10.1}}, comb[102][2];
    for (int k = 0; k < 100; k++) comb[k][0] = 4 - 0.04 * k, comb[k][1] = k % 2 ? 1 + 1e-9 * k : 0.12;
    comb[100][0] = 0.04, comb[100][1] = 0, comb[101][0] = 4, comb[101][1] = 0;
    const ab_shape_spec sharp = polygon(needle, 3), teeth = polygon(comb, 102);
    const struct {
        const ab_shape_spec *shape;
        double area;
    } list[] = {{&tiny, PI * 1e-18}, {&thin, PI * (1 - 0.9999 * 0.9999)}, {&strip, 1},
                {&huge, 2e24},       {&sharp, shoelace(needle, 3)},       {&teeth, shoelace(comb, 102)}};
    for (size_t k = 0; k < sizeof list / sizeof *list; k++)
        for (size_t n = 1; n <= EFFORT(60, 20); n = 3 * n + 2) {
            ab_report *report = ab_report_create();
            const ab_fill_request request = {
                .rule = AB_FILL_CVT, .per_cell = 4, .cell = 1e20, .points = n, .tolerance = 0.05, .iterations = 40};
            ab_fill *f = NULL;
            assert_int_equal(ab_fill_make(list[k].shape, &request, "body", &f, report), AB_OK);
            assert_int_equal(f->count, n);
            near(volume_of(f), list[k].area, (k == 1 ? 1e-11 : 1e-12) * list[k].area);
            for (size_t p = 0; p < n; p++) assert_true(isfinite(f->x[p]) && isfinite(f->y[p]) && f->volume[p] > 0);
            ab_fill_destroy(f);
            ab_report_destroy(report);
        }
}

static void test_rounds_that_do_not_do_are_warned_of(void **state) {
    (void)state;
    ab_report *report = ab_report_create();
    const ab_shape_spec shape = box(0, 0, 1, 1);
    const ab_fill_request request = {.rule = AB_FILL_CVT, .per_cell = 4, .cell = 1, .points = 100, .tolerance = 1e-8, .iterations = 3};
    ab_fill *f = NULL;
    assert_int_equal(ab_fill_make(&shape, &request, "body", &f, report), AB_OK);
    assert_int_equal(ab_report_warnings(report), 1);
    assert_non_null(strstr(ab_report_text(report, 0), "after 3 rounds"));
    near(volume_of(f), 1, 1e-12);
    ab_fill_destroy(f);
    ab_report_destroy(report);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_shape_and_number_is_exact_and_inside),
        cmocka_unit_test(test_centre_of_mass_is_that_of_the_shape),
        cmocka_unit_test(test_points_stand_at_the_centroids_of_their_cells),
        cmocka_unit_test(test_cells_are_close_to_hexagons),
        cmocka_unit_test(test_two_points_halve_a_box),
        cmocka_unit_test(test_same_for_any_threads_and_another_for_another_seed),
        cmocka_unit_test(test_moved_and_scaled_bodies_have_moved_and_scaled_points),
        cmocka_unit_test(test_surface_stands_near_the_outline),
        cmocka_unit_test(test_hostile_shapes_are_refused_by_name),
        cmocka_unit_test(test_extreme_sizes_and_numbers_work),
        cmocka_unit_test(test_rounds_that_do_not_do_are_warned_of),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
