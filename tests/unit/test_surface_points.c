/* test_surface_points.c: points on a body's own outline that touch other bodies: they stand on the outline as drawn, their lengths add up to it, their weights have the
 * place of the point as their centre, and they go with the body exactly. */
#include "one_body.h"

static const char *scene(const char *more, const char *shape, const char *velocity, double dt) {
    static char text[4000];
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1e4, dt: %g}\n"
             "grid: {from: [-5, -3], to: [15, 17], cell: 0.5}\n"
             "materials: {m: {model: linear-elastic, E: 1000, nu: 0.3, density: 1}}\n"
             "bodies: {b: {method: material-points, material: m, %s, velocity: %s, %s},\n"
             "         other: {method: rigid, shape: {box: [[13, 14], [14, 15]]}, motion: {velocity: [0, 0], spin: 0}}}\n"
             "contact: [{bodies: [b, other], algorithm: point-to-segment, response: coulomb}]\n",
             dt, more, velocity, shape);
    return text;
}

static void step(one_body *one) { one_body_step(one, NULL, NULL); }

/* All surface points of the body: the region is everywhere. */
static ab_surface look(one_body *one) {
    enum { TILES = 64 };
    static uint64_t key[TILES * TILES], cells[TILES * TILES];
    for (int j = 0; j < TILES; j++)
        for (int i = 0; i < TILES; i++) key[j * TILES + i] = ab_tile_key(i - TILES / 2, j - TILES / 2), cells[j * TILES + i] = UINT64_MAX;
    const ab_region all = {one->mpm->h, TILES * TILES, key, cells};
    ab_surface s = {.struct_size = sizeof s, .dimension = 2};
    must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
    must(one, one->domain->ops->faces(one->domain, &s, one->report));
    must(one, one->domain->ops->surface_points(one->domain, &all, &s, one->report));
    return s;
}

/* Sum of weights 1, their centre the point; every node has mass. */
static void check_weights(const one_body *one, const ab_surface *s) {
    for (size_t k = 0; k < s->point_count; k++) {
        double sum = 0, centre[2] = {0, 0};
        for (size_t e = s->point_start[k]; e < s->point_start[k + 1]; e++) {
            const uint32_t dof = s->point_dof[e];
            double x[2];
            assert_true(dof < one->mpm->tile_count * AB_TILE_NODES);
            assert_true(one->mpm->own[(size_t)dof * OWN_RECORD + OWN_MASS] > 0);
            node_place(one->mpm, dof / AB_TILE_NODES, (int)(dof % AB_TILE_NODES), x);
            sum += s->point_weight[e];
            for (int c = 0; c < 2; c++) centre[c] += s->point_weight[e] * x[c];
        }
        assert_true(fabs(sum - 1) < 1e-13);
        for (size_t c = 0; c < 2; c++) {
            if (!(fabs(centre[c] - s->point_position[c * s->point_ld + k]) < 1e-11 * one->mpm->h))
                fail_msg("point %zu: centre of its weights is off by %g", k, centre[c] - s->point_position[c * s->point_ld + k]);
        }
    }
}

static double length_of(const ab_surface *s) {
    double sum = 0;
    for (size_t k = 0; k < s->point_count; k++) sum += s->point_area[k];
    return sum;
}

static void test_points_stand_on_the_outline(void **state) {
    (void)state;
    static const char *const BASES[] = {"basis: gimp", "basis: linear", "basis: bspline2", "basis: bspline3"};
    for (int b = 0; b < 4; b++)
        for (int per_cell = 4; per_cell <= 16; per_cell += 5) {
            char more[200];
            snprintf(more, sizeof more, "%s, surface: points, fill: {per_cell: %d}", BASES[b], per_cell);
            one_body *one = one_body_create(scene(more, "shape: {box: [[2.1, 4.53], [6.07, 7.5]]}", "[0, 0]", 1e-3), 1);
            const ab_surface s = look(one);
            int corners = 0;
            assert_true(fabs(length_of(&s) - 2 * (3.97 + 2.97)) < 1e-12);
            for (size_t k = 0; k < s.point_count; k++) {
                const double x = s.point_position[k] - 5, y = s.point_position[s.point_ld + k] - 3;
                const int on_x = fabs(x - 2.1) < 1e-12 || fabs(x - 6.07) < 1e-12, on_y = fabs(y - 4.53) < 1e-12 || fabs(y - 7.5) < 1e-12;
                assert_true(on_x || on_y);
                corners += on_x && on_y;
                assert_true(s.point_extent[k] == 0 && s.point_vertex[k] == k);
            }
            assert_int_equal(corners, 4);
            check_weights(one, &s);
            one_body_destroy(one);
        }
}

static void test_any_shape_and_fill(void **state) {
    (void)state;
    static const struct {
        const char *text;
        double length, part; /* of it that chords may lose */
    } SHAPES[] = {
        {"shape: {disc: {center: [4, 6], radius: 1.9}}, fill: {per_cell: 4}", 2 * 3.14159265358979 * 1.9, 4e-3},
        {"shape: {ring: {center: [4, 6], radius: 3, inner: 1.5}}, fill: {per_cell: 9}", 2 * 3.14159265358979 * 4.5, 6e-3},
        {"shape: {disc: {center: [4, 6], radius: 1.9}}, fill: {rule: gauss, per_cell: 4}", 2 * 3.14159265358979 * 1.9, 4e-3},
        {"shape: {polygon: [[1, 1], [5, 1], [3, 4]]}, fill: {per_cell: 4}", 4 + 2 * 3.605551275463989, 1e-13},
        {"shape: {union: [{box: [[0, 0], [4, 2]]}, {box: [[1, 2], [2, 4]]}]}, fill: {per_cell: 4}", 16, 1e-13},
    };
    for (size_t k = 0; k < sizeof SHAPES / sizeof *SHAPES; k++)
        for (double spacing = 0.25; spacing < 3; spacing *= 2) {
            char more[200];
            snprintf(more, sizeof more, "surface: {points: %g}", spacing);
            one_body *one = one_body_create(scene(more, SHAPES[k].text, "[0, 0]", 1e-3), 1);
            const ab_surface s = look(one);
            const double length = length_of(&s);
            assert_true(length <= SHAPES[k].length * (1 + 1e-13));
            assert_true(length > SHAPES[k].length * (1 - SHAPES[k].part * fmax(spacing * spacing, 1) * 4));
            check_weights(one, &s);
            one_body_destroy(one);
        }
}

/* Turned by its own spin, a box keeps its surface points where its material points say they are. */
static void test_a_turning_box_takes_them_along(void **state) {
    (void)state;
    static const char *const UPDATES[] = {"usf", "usl", "musl", "usavg"};
    for (int which = 0; which < 4; which++) {
        char more[200];
        snprintf(more, sizeof more, "update: %s, surface: points, fill: {per_cell: 4}", UPDATES[which]);
        one_body *one =
            one_body_create(scene(more, "shape: {box: [[2, 4.5], [6, 7.5]]}", "[\"-0.2*(y-6) + 0.3\", \"0.2*(x-4) - 0.1\"]", 2e-3), 1);
        const ab_surface at_start = look(one);
        const size_t count = at_start.point_count;
        double *start = calloc(2 * count, sizeof *start), centre[2] = {0, 0}, mass = 0, dot = 0, cross = 0;
        double *birth = calloc(2 * one->mpm->born, sizeof *birth);
        for (size_t k = 0; k < 2 * count; k++) start[k] = at_start.point_position[k / count * at_start.point_ld + k % count];
        for (size_t slot = 0; slot < one->mpm->block_count * 8; slot++)
            for (int c = 0; is_point(one->mpm, slot) && c < 2; c++)
                birth[2 * one->mpm->ids[slot] + (size_t)c] = *point_row(one->mpm, slot, ROW_X + c);
        for (int k = 0; k < 4000; k++) step(one);
        const ab_surface s = look(one);
        check_weights(one, &s);
        for (int pass = 0; pass < 2; pass++)
            for (size_t slot = 0; slot < one->mpm->block_count * 8; slot++) {
                if (!is_point(one->mpm, slot)) continue;
                const double *old = birth + 2 * one->mpm->ids[slot], x = *point_row(one->mpm, slot, ROW_X),
                             y = *point_row(one->mpm, slot, ROW_X + 1), u = x - centre[0] / fmax(mass, 1),
                             v = y - centre[1] / fmax(mass, 1);
                if (pass == 0)
                    centre[0] += x, centre[1] += y, mass += 1;
                else
                    dot += (old[0] - 9) * u + (old[1] - 9) * v, cross += (old[0] - 9) * v - (old[1] - 9) * u;
            }
        const double angle = atan2(cross, dot); /* usf loses some of its spin */
        double worst = 0;
        for (size_t k = 0; k < count; k++) {
            const double x = start[k] - 9, y = start[count + k] - 9;
            worst = fmax(worst, hypot(s.point_position[k] - centre[0] / mass - cos(angle) * x + sin(angle) * y,
                                      s.point_position[s.point_ld + k] - centre[1] / mass - sin(angle) * x - cos(angle) * y));
        }
        print_message("%s: turned by %.2f, surface points are off by %.4f of a cell\n", UPDATES[which], angle, worst / 0.5);
        assert_true(angle > 1 && worst < 0.03 * 0.5);
        free(start), free(birth);
        one_body_destroy(one);
    }
}

/* Whatever affine motion the material points make, the surface points make it to rounding. */
static void test_affine_motion_is_exact(void **state) {
    (void)state;
    one_body *one =
        one_body_create(scene("surface: points", "shape: {disc: {center: [4, 6], radius: 2}}, fill: {per_cell: 4}", "[0, 0]", 1e-3), 1);
    const ab_surface before = look(one);
    const size_t count = before.point_count;
    double *start = calloc(2 * count, sizeof *start);
    for (size_t k = 0; k < 2 * count; k++) start[k] = before.point_position[k / count * before.point_ld + k % count];
    for (size_t slot = 0; slot < one->mpm->block_count * 8; slot++) {
        const double x = *point_row(one->mpm, slot, ROW_X), y = *point_row(one->mpm, slot, ROW_X + 1);
        *point_row(one->mpm, slot, ROW_X) = 1.02 * x + 0.01 * y - 0.2;
        *point_row(one->mpm, slot, ROW_X + 1) = 0.98 * y - 0.03 * x + 0.3;
    }
    ab_surface s = {.struct_size = sizeof s, .dimension = 2};
    must(one, one->domain->ops->faces(one->domain, &s, one->report));
    for (size_t k = 0; k < count; k++) {
        const double x = start[k], y = start[count + k];
        assert_true(fabs(s.vertex_position[k] - (1.02 * x + 0.01 * y - 0.2)) < 1e-12);
        assert_true(fabs(s.vertex_position[s.vertex_ld + k] - (0.98 * y - 0.03 * x + 0.3)) < 1e-12);
    }
    free(start);
    one_body_destroy(one);
}

/* A body of two halves that mirror each other, or one half of it at a side of the grid that is a plane of symmetry. */
static one_body *symmetric(const char *basis, bool half, double *plane) {
    char more[200], text[4000];
    snprintf(more, sizeof more, "%s, surface: points, fill: {per_cell: 9}", basis);
    const char *all = scene(more, half ? "shape: {box: [[-5, 4.6], [-1, 7.5]]}" : "shape: {box: [[1, 4.6], [9, 7.5]]}", "[0, 0]", 1e-3);
    const char *rest = strstr(all, "0.5}") + 3;
    snprintf(text, sizeof text, "%.*s%s%s", (int)(rest - all), all, half ? ", sides: {left: roller}" : "", rest);
    *plane = half ? 0 : 10;
    one_body *one = one_body_create(text, 1);
    for (size_t slot = 0; slot < one->mpm->block_count * 8; slot++) {
        const double x = *point_row(one->mpm, slot, ROW_X) - *plane, y = *point_row(one->mpm, slot, ROW_X + 1);
        *point_row(one->mpm, slot, ROW_X) = *plane + 1.01 * x;
        *point_row(one->mpm, slot, ROW_X + 1) = 0.99 * y + 0.01 * x * x;
    }
    return one;
}

/* Surface points in a plane of symmetry stand where those in the middle of the whole body do and move nodes as they do. */
static void test_half_a_body_at_a_side_is_as_the_whole(void **state) {
    (void)state;
    static const char *const BASES[] = {"basis: gimp", "basis: linear", "basis: cpdi"};
    for (int b = 0; b < 3; b++) {
        double place[2][2] = {{0}}, weighed[2][2] = {{0}}; /* whole or half; top, bottom */
        for (int half = 0; half < 2; half++) {
            double plane;
            one_body *one = symmetric(BASES[b], half, &plane);
            const ab_surface s = look(one);
            int found = 0;
            for (size_t k = 0; k < s.point_count; k++) {
                const double y = s.point_position[s.point_ld + k];
                const int top = y > 9;
                if (fabs(s.point_position[k] - plane) > 1e-9 || (y > 7.7 && y < 10.3)) continue; /* the half has more along the side */
                found++;
                assert_true(fabs(s.point_position[k] - plane) < 1e-12);
                place[half][top] = y;
                for (size_t e = s.point_start[k]; e < s.point_start[k + 1]; e++) {
                    double x[2];
                    node_place(one->mpm, s.point_dof[e] / AB_TILE_NODES, (int)(s.point_dof[e] % AB_TILE_NODES), x);
                    weighed[half][top] += s.point_weight[e] * cos(x[0] - plane) * exp(x[1] - 9);
                }
            }
            assert_int_equal(found, 2);
            one_body_destroy(one);
        }
        for (int top = 0; top < 2; top++) {
            assert_true(fabs(place[0][top] - place[1][top]) < 1e-11);
            assert_true(fabs(weighed[0][top] - weighed[1][top]) < 1e-11 * weighed[0][top]);
        }
    }
}

static void refused(const char *text, const char *why) {
    one_body *one = calloc(1, sizeof *one);
    assert_int_not_equal(one_body_attempt(one, text, 1), AB_OK);
    bool said = false;
    for (size_t i = 0; ab_report_text(one->report, i); i++) said = said || strstr(ab_report_text(one->report, i), why);
    if (!said) say_all(one->report);
    assert_true(said);
    one->domain = NULL;
    one_body_destroy(one);
}

static void test_what_cannot_be_is_refused(void **state) {
    (void)state;
    refused(scene("surface: points", "shape: {box: [[2, 4], [6, 4.4]]}, fill: {per_cell: 1}", "[0, 0]", 1e-3), "only one point thick");
}

/* A finder that looks at nodes is shown the outline: over all nodes, how far it reaches along any direction is that of the shape as drawn, to the corner; the pieces near a
 * node are short, lie within the reach of its basis, and between them on the outline there is nothing left out. */
static void test_nodes_see_the_outline(void **state) {
    (void)state;
    static const double POLYGON[4][2] = {{2.13, 4.2}, {6.4, 5.1}, {5.2, 8.77}, {2.9, 7.9}};
    static const char *const BASES[] = {"basis: gimp", "basis: linear", "basis: bspline2", "basis: cpdi"};
    for (int b = 0; b < 4; b++) {
        char more[100], text[4000], *algorithm;
        snprintf(more, sizeof more, "%s, surface: points", BASES[b]);
        snprintf(text, sizeof text, "%s",
                 scene(more, "shape: {polygon: [[2.13, 4.2], [6.4, 5.1], [5.2, 8.77], [2.9, 7.9]]}, fill: {per_cell: 4}", "[0, 0]", 1e-3));
        assert_non_null(algorithm = strstr(text, "point-to-segment"));
        memcpy(algorithm, "multi-velocity  ", 16);
        one_body *one = one_body_create(text, 1);
        must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
        const size_t most = one->mpm->tile_count * AB_TILE_NODES;
        uint32_t *nodes = malloc(most * sizeof *nodes);
        size_t count = 0;
        for (size_t k = 0; k < most; k++)
            if (one->mpm->own[k * OWN_RECORD + OWN_MASS] > 0) nodes[count++] = (uint32_t)k;
        ab_trace t = {0};
        must(one, one->domain->ops->trace(one->domain, nodes, count, AB_NEED_NEAR_POINTS, &t, one->report));
        assert_int_equal(t.count, count);
        const double h = one->mpm->h, reach = one->mpm->kernel->reach * h;
        size_t pieces = 0;
        for (size_t i = 0; i < count; i++)
            for (size_t k = t.near_start[i]; k < t.near_start[i + 1]; k++) {
                const double half = sqrt(t.near_extent[k] + t.near_extent[t.near_ld + k]);
                assert_true(half <= 0.125 * h * (1 + 1e-9));
                for (size_t c = 0; c < 2; c++)
                    assert_true(fabs(t.near_position[c * t.near_ld + k] - t.position[c * t.ld + i]) <= reach + half + 1e-12);
                pieces += half > 0;
            }
        assert_true(pieces > 0);
        for (double angle = 0.05; angle < 6.3; angle += 0.1) {
            const double n[2] = {cos(angle), sin(angle)};
            double exact = -INFINITY, seen = -INFINITY;
            for (int v = 0; v < 4; v++) exact = fmax(exact, n[0] * (POLYGON[v][0] + 5) + n[1] * (POLYGON[v][1] + 3));
            for (size_t k = 0; k < t.near_start[count]; k++) {
                const double *x = t.near_position + k, *e = t.near_extent + k;
                const double square = n[0] * n[0] * e[0] + n[1] * n[1] * e[t.near_ld] + 2 * n[0] * n[1] * e[2 * t.near_ld];
                seen = fmax(seen, n[0] * x[0] + n[1] * x[t.near_ld] + sqrt(fmax(square, 0)));
            }
            assert_true(fabs(seen - exact) < 1e-8);
        }
        free(nodes);
        one_body_destroy(one);
    }
}

static void test_nothing_is_made_without_contact(void **state) {
    (void)state;
    char text[4000], *contact;
    snprintf(text, sizeof text, "%s", scene("surface: points", "shape: {box: [[2, 4], [6, 6]]}, fill: {per_cell: 4}", "[0, 0]", 1e-3));
    assert_non_null(contact = strstr(text, "contact:"));
    *contact = '\0';
    one_body *one = one_body_create(text, 1);
    assert_null(one->mpm->outline);
    one_body_destroy(one);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_points_stand_on_the_outline),
        cmocka_unit_test(test_any_shape_and_fill),
        cmocka_unit_test(test_a_turning_box_takes_them_along),
        cmocka_unit_test(test_affine_motion_is_exact),
        cmocka_unit_test(test_nodes_see_the_outline),
        cmocka_unit_test(test_what_cannot_be_is_refused),
        cmocka_unit_test(test_half_a_body_at_a_side_is_as_the_whole),
        cmocka_unit_test(test_nothing_is_made_without_contact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
