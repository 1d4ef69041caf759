/* test_outline.c: the faces of material-point bodies: loops that close, run the right way round, stand on the outline and enclose its area; and that go with the
 * body. */
#include "effort.h"
#include "mpm/outline.h"
#include "one_body.h"

static const double PI = 3.14159265358979324;

typedef struct drawn {
    ab_report *report;
    ab_fill *fill;
    mpm_loops loops;
} drawn;

static drawn *draw(const ab_shape_spec *shape, ab_fill_rule rule, int per_cell, double cell) {
    drawn *d = calloc(1, sizeof *d);
    const double origin[2] = {0, 0};
    d->report = ab_report_create();
    must(d, ab_fill_create(shape, rule, per_cell, cell, origin, "b", &d->fill, d->report));
    must(d, mpm_loops_create(d->fill, 0.5 * cell, true, "b", &d->loops, d->report));
    return d;
}

static void erase(drawn *d) {
    mpm_loops_clear(&d->loops);
    ab_fill_destroy(d->fill);
    ab_report_destroy(d->report);
    free(d);
}

/* Area enclosed (shoelace), number of loops, shortest and longest face. */
typedef struct measure {
    double area, shortest, longest;
    size_t loops, corners;
} measure;

static measure measure_loops(const mpm_loops *l) {
    measure m = {.shortest = INFINITY};
    bool *seen = calloc(l->count + 1, sizeof *seen);
    for (size_t k = 0; k < l->count; k++) {
        const double *a = l->x + 2 * k, *b = l->x + 2 * l->next[k], length = hypot(b[0] - a[0], b[1] - a[1]);
        assert_true(l->next[k] < l->count && l->prior[l->next[k]] == k);
        m.area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
        m.shortest = fmin(m.shortest, length);
        m.longest = fmax(m.longest, length);
        m.corners += l->corner[k];
        if (seen[k]) continue;
        m.loops++;
        for (size_t at = k; !seen[at]; at = l->next[at]) seen[at] = true;
    }
    free(seen);
    return m;
}

static double volume_of(const ab_fill *fill) {
    double sum = 0;
    for (size_t p = 0; p < fill->count; p++) sum += fill->volume[p];
    return sum;
}

static void test_a_box_has_its_corners_and_its_area(void **state) {
    (void)state;
    const ab_shape_spec box = {.kind = AB_SHAPE_BOX, .low = {0.3, -1}, .high = {2.55, 0.07}};
    for (int rule = 0; rule < 2; rule++)
        for (int per_cell = 1; per_cell <= 16; per_cell *= 2) {
            drawn *d = draw(&box, (ab_fill_rule)rule, per_cell, 0.5);
            const measure m = measure_loops(&d->loops);
            assert_true(m.loops == 1 && m.corners == 4);
            assert_true(fabs(m.area - 2.25 * 1.07) < 1e-12);
            assert_true(m.shortest > 0.16 && m.longest < 0.38);
            erase(d);
        }
}

static void test_discs_and_rings_enclose_their_area(void **state) {
    (void)state;
    for (int per_cell = 1; per_cell <= 16; per_cell *= 2)
        for (double radius = 0.1; radius < 8; radius *= 1.7)
            for (int hole = 0; hole < 2; hole++) {
                const ab_shape_spec round = {
                    .kind = hole ? AB_SHAPE_RING : AB_SHAPE_DISC, .center = {1, 2}, .radius = radius, .inner = 0.4 * radius};
                drawn *d = draw(&round, AB_FILL_REGULAR, per_cell, 0.5);
                const measure m = measure_loops(&d->loops);
                const double area = PI * radius * radius * (hole ? 0.84 : 1), h = 0.25 / radius;
                assert_int_equal(m.loops, 1 + hole);
                if (radius > 1) { /* inscribed it would be 1/6 h^2 too small, for any number of points */
                    if (!hole) assert_int_equal(m.corners, 0);
                    assert_true(m.shortest > 0.16 && m.longest < 0.38);
                    assert_true(fabs(m.area / area - 1) < 0.4 * h * h / per_cell);
                } else
                    assert_true(fabs(m.area / area - 1) < 0.4);
                const double outer = m.area > 0 ? 1 : -1;
                assert_true(outer > 0);
                for (size_t k = 0; k < d->loops.count; k++) {
                    const double r = hypot(d->loops.x[2 * k] - 1, d->loops.x[2 * k + 1] - 2), on = r > 0.7 * radius ? radius : 0.4 * radius;
                    if (on > 1) assert_true(fabs(r - on) < 0.5 * 0.3 * 0.3 / on);
                }
                for (size_t k = 0; k < d->loops.count; k++) /* mirrored in both axes, as the points are */
                    for (int mirror = 0; mirror < 2; mirror++) {
                        const double x = mirror ? 2 - d->loops.x[2 * k] : d->loops.x[2 * k],
                                     y = mirror ? d->loops.x[2 * k + 1] : 4 - d->loops.x[2 * k + 1];
                        double nearest = INFINITY;
                        for (size_t j = 0; j < d->loops.count; j++)
                            nearest = fmin(nearest, hypot(d->loops.x[2 * j] - x, d->loops.x[2 * j + 1] - y));
                        if (!(nearest < 1e-12 * radius))
                            fail_msg("%d per cell, radius %g: (%g, %g) has no mirror image: %g", per_cell, radius, x, y, nearest);
                    }
                erase(d);
            }
}

static void test_polygons_of_any_angles(void **state) {
    (void)state;
    double star[10][2], many[40][2];
    for (int k = 0; k < 10; k++) { /* written clockwise */
        const double r = k % 2 ? 0.8 : 2.0, angle = -0.2 * PI * k + 0.3;
        star[k][0] = 3 + r * cos(angle), star[k][1] = 1 + r * sin(angle);
    }
    double area = 0;
    for (int k = 0; k < 10; k++)
        area -= 0.5 * ((star[k][0] - 3) * (star[(k + 1) % 10][1] - 1) - (star[k][1] - 1) * (star[(k + 1) % 10][0] - 3));
    const ab_shape_spec polygon = {.kind = AB_SHAPE_POLYGON, .vertices = star, .count = 10};
    drawn *d = draw(&polygon, AB_FILL_REGULAR, 4, 0.2);
    measure m = measure_loops(&d->loops);
    assert_true(m.loops == 1 && m.corners == 10 && fabs(m.area - area) < 1e-12);
    assert_true(m.shortest > 0.06 && m.longest < 0.16);
    erase(d);
    for (int k = 0; k < 40; k++) many[k][0] = 3 * cos(PI * k / 20), many[k][1] = 3 * sin(PI * k / 20);
    const ab_shape_spec round = {.kind = AB_SHAPE_POLYGON, .vertices = many, .count = 40};
    d = draw(&round, AB_FILL_REGULAR, 4, 0.2); /* edges of two cells: all corners are kept */
    m = measure_loops(&d->loops);
    assert_true(m.loops == 1 && m.corners == 40 && fabs(m.area - volume_of(d->fill)) < 1e-11);
    erase(d);
    d = draw(&round, AB_FILL_REGULAR, 4, 2); /* edges of a quarter of a cell: a curve */
    m = measure_loops(&d->loops);
    assert_true(m.loops == 1 && m.corners == 0 && m.longest > 0.8);
    assert_true(fabs(m.area / volume_of(d->fill) - 1) < 4e-3);
    erase(d);
}

static void test_unions_have_one_outline(void **state) {
    (void)state;
    ab_shape_spec two[2] = {{.kind = AB_SHAPE_BOX, .low = {0, 0}, .high = {2, 1}}, {.kind = AB_SHAPE_BOX, .low = {0.5, 1}, .high = {1, 2}}};
    const ab_shape_spec touching = {.kind = AB_SHAPE_UNION, .members = two, .count = 2};
    drawn *d = draw(&touching, AB_FILL_REGULAR, 4, 0.25);
    measure m = measure_loops(&d->loops);
    assert_true(m.loops == 1 && m.corners == 8 && fabs(m.area - 2.5) < 1e-12); /* two of them turn to the right */
    erase(d);

    ab_shape_spec overlapping[2] = {{.kind = AB_SHAPE_BOX, .low = {0, 0}, .high = {2, 1}},
                                    {.kind = AB_SHAPE_DISC, .center = {2, 0.5}, .radius = 0.8}};
    const ab_shape_spec joined = {.kind = AB_SHAPE_UNION, .members = overlapping, .count = 2};
    d = draw(&joined, AB_FILL_REGULAR, 4, 0.1);
    m = measure_loops(&d->loops);
    assert_int_equal(m.loops, 1);
    assert_true(fabs(m.area / volume_of(d->fill) - 1) < 1e-3);
    erase(d);

    ab_shape_spec frame[4] = {{.kind = AB_SHAPE_BOX, .low = {0, 0}, .high = {3, 1}},
                              {.kind = AB_SHAPE_BOX, .low = {0, 2}, .high = {3, 3}},
                              {.kind = AB_SHAPE_BOX, .low = {0, 1}, .high = {1, 2}},
                              {.kind = AB_SHAPE_BOX, .low = {2, 1}, .high = {3, 2}}};
    const ab_shape_spec with_hole = {.kind = AB_SHAPE_UNION, .members = frame, .count = 4};
    d = draw(&with_hole, AB_FILL_REGULAR, 4, 0.25);
    m = measure_loops(&d->loops);
    assert_true(m.loops == 2 && m.corners == 8 && fabs(m.area - 8) < 1e-12);
    erase(d);

    ab_shape_spec corner[2] = {{.kind = AB_SHAPE_BOX, .low = {0, 0}, .high = {1, 1}},
                               {.kind = AB_SHAPE_BOX, .low = {1, 1}, .high = {2, 2}}};
    const ab_shape_spec diagonal = {.kind = AB_SHAPE_UNION, .members = corner, .count = 2};
    d = draw(&diagonal, AB_FILL_REGULAR, 4, 0.25); /* they share a corner and stay apart */
    m = measure_loops(&d->loops);
    assert_true(m.loops == 2 && m.corners == 8 && fabs(m.area - 2) < 1e-12);
    erase(d);
}

static void test_an_outline_that_does_not_close_is_refused(void **state) {
    (void)state;
    const ab_shape_spec box = {.kind = AB_SHAPE_BOX, .low = {0, 0}, .high = {2, 1}};
    drawn *d = draw(&box, AB_FILL_REGULAR, 4, 0.5);
    d->fill->surface_count -= 2;
    mpm_loops loops;
    assert_int_not_equal(mpm_loops_create(d->fill, 0.25, true, "soil", &loops, d->report), AB_OK);
    assert_non_null(strstr(ab_report_text(d->report, 0), "'soil': its outline does not close"));
    erase(d);
}

static void test_long_faces_are_divided_and_short_ones_joined(void **state) {
    (void)state;
    const ab_shape_spec box = {.kind = AB_SHAPE_BOX, .low = {0, 0}, .high = {3, 1}};
    drawn *d = draw(&box, AB_FILL_REGULAR, 4, 0.5);
    for (size_t k = 0; k < d->loops.count; k++) d->loops.x[2 * k] *= 6, d->loops.x[2 * k + 1] /= 6;
    for (int k = 0; k < 3; k++) must(d, mpm_loops_even(&d->loops, 0.0625, 0.5, "b", d->report));
    const measure m = measure_loops(&d->loops);
    assert_true(m.loops == 1 && m.corners == 4 && fabs(m.area - 3) < 1e-12);
    assert_true(m.longest <= 0.5 && m.shortest >= 0.0625);
    erase(d);
}

/* ---- carried ---------------------------------------------------------------------------------------------------------------------- */

static const char *scene(const char *basis, const char *update, const char *shape, const char *velocity, double dt) {
    static char text[3000];
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1e4, dt: %g}\n"
             "grid: {from: [-5, -3], to: [15, 17], cell: 0.5}\n"
             "materials: {m: {model: linear-elastic, E: 1000, nu: 0.3, density: 1}}\n"
             "bodies: {b: {method: material-points, material: m, basis: %s, update: %s, velocity: %s, %s, fill: {per_cell: 4}},\n"
             "         other: {method: material-points, material: m, shape: {box: [[13, 14], [14, 15]]}, fill: {per_cell: 4}}}\n"
             "contact: [{bodies: [b, other], algorithm: multi-velocity}]\n",
             dt, basis, update, velocity, shape);
    return text;
}

/* The body of such a scene as if its finder looked at surfaces. */
static one_body *with_faces(const char *text) {
    one_body *one = one_body_create(text, 1);
    one->domain->ops->destroy(one->domain);
    ((ab_loaded_class *)(uintptr_t)one->scene->contacts[0].finder)->class_.needs |= AB_NEED_SURFACE;
    must(one, mpm_create(one->scene, 0, 1, &one->domain, one->report));
    one->mpm = (mpm_body *)one->domain;
    return one;
}

static void step(one_body *one) {
    const ab_domain_ops *ops = one->domain->ops;
    must(one, ops->begin(one->domain, &one->step, one->report));
    if (ops->early) must(one, ops->early(one->domain, &one->step, one->report));
    must(one, ops->finish(one->domain, &one->step, one->report));
    if (ops->remap) must(one, ops->remap(one->domain, &one->step, one->report));
    must(one, ops->stress(one->domain, &one->step, one->report));
    one->step.time += one->step.dt;
    one->step.number++;
}

static ab_surface faces(one_body *one) {
    ab_surface s = {.struct_size = sizeof s, .dimension = 2};
    must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
    must(one, one->domain->ops->faces(one->domain, &s, one->report));
    return s;
}

static void test_stencils_add_up_and_faces_hang_together(void **state) {
    (void)state;
    one_body *one = with_faces(scene("gimp", "musl", "shape: {disc: {center: [4, 6], radius: 1.9}}", "[1, 2]", 1e-3));
    const ab_surface at_start = faces(one);
    double *start = calloc(2 * at_start.vertex_count, sizeof *start);
    for (size_t k = 0; k < at_start.vertex_count; k++)
        for (size_t c = 0; c < 2; c++) start[2 * k + c] = at_start.vertex_position[c * at_start.vertex_ld + k];
    for (int k = 0; k < 1000; k++) step(one);
    const ab_surface s = faces(one);
    assert_true(s.vertex_count == at_start.vertex_count);
    assert_true(s.vertex_count > 40 && s.face_count == s.vertex_count);
    for (size_t k = 0; k < s.vertex_count; k++) {
        double sum = 0;
        for (size_t n = s.vertex_start[k]; n < s.vertex_start[k + 1]; n++) {
            assert_true(s.vertex_dof[n] < one->mpm->tile_count * AB_TILE_NODES && !mpm_light_tie_of(one->mpm, s.vertex_dof[n]));
            sum += s.vertex_weight[n];
        }
        assert_true(fabs(sum - 1) < 1e-14);
        const uint32_t *face = s.face_vertex + 3 * k, *beside = s.face_beside + 2 * k;
        assert_true(face[2] == UINT32_MAX);
        assert_true(s.face_vertex[3 * beside[0] + 1] == face[0] && s.face_vertex[3 * beside[1]] == face[1]);
        for (size_t c = 0; c < 2; c++) /* two cells and four further, to rounding */
            assert_true(fabs(s.vertex_position[c * s.vertex_ld + k] - start[2 * k + c] - (c ? 2 : 1)) < 1e-11);
    }
    free(start);
    one_body_destroy(one);
}

static void test_no_faces_where_nobody_looks_for_them(void **state) {
    (void)state;
    one_body *one = one_body_create(scene("gimp", "musl", "shape: {box: [[4, 6], [5, 7]]}", "[0, 0]", 1e-3), 1);
    const ab_surface s = faces(one);
    assert_true(s.face_count == 0 && s.vertex_count == 0 && one->mpm->outline == NULL);
    one_body_destroy(one);
}

/* A box that turns: how far its vertices, and its points, are off from where they stood at the start, turned as the body has turned. */
static double turn(const char *basis, const char *update, double turns, double *points_off) {
    const double spin = 0.2, dt = 2e-3;
    char velocity[100];
    snprintf(velocity, sizeof velocity, "[\"-%g*(y-6)\", \"%g*(x-4)\"]", spin, spin);
    one_body *one = with_faces(scene(basis, update, "shape: {box: [[2, 4.5], [6, 7.5]]}", velocity, dt));
    const ab_surface at_start = faces(one);
    const size_t count = at_start.vertex_count;
    double *start = calloc(2 * count, sizeof *start), *birth = calloc(2 * one->mpm->born, sizeof *birth);
    for (size_t k = 0; k < count; k++)
        start[2 * k] = at_start.vertex_position[k], start[2 * k + 1] = at_start.vertex_position[at_start.vertex_ld + k];
    for (size_t slot = 0; slot < one->mpm->block_count * 8; slot++)
        if (is_point(one->mpm, slot))
            for (int c = 0; c < 2; c++) birth[2 * one->mpm->ids[slot] + (size_t)c] = *point_row(one->mpm, slot, ROW_X + c);
    const int steps = (int)(turns * 2 * PI / spin / dt + 0.5);
    for (int k = 0; k < steps; k++) step(one);
    const ab_surface s = faces(one);
    assert_int_equal(s.vertex_count, count);
    double dot = 0, cross = 0, worst = 0; /* the body's own angle, by least squares over its points */
    for (size_t slot = 0; slot < one->mpm->block_count * 8; slot++) {
        if (!is_point(one->mpm, slot)) continue;
        const double x = birth[2 * one->mpm->ids[slot]] - 9, y = birth[2 * one->mpm->ids[slot] + 1] - 9;
        const double u = *point_row(one->mpm, slot, ROW_X) - 9, v = *point_row(one->mpm, slot, ROW_X + 1) - 9;
        dot += x * u + y * v, cross += x * v - y * u;
    }
    const double angle = atan2(cross, dot);
    *points_off = 0;
    for (size_t k = 0; k < count; k++) {
        const double x = start[2 * k] - 9, y = start[2 * k + 1] - 9,
                     at[2] = {9 + cos(angle) * x - sin(angle) * y, 9 + sin(angle) * x + cos(angle) * y};
        worst = fmax(worst, hypot(s.vertex_position[k] - at[0], s.vertex_position[s.vertex_ld + k] - at[1]));
    }
    for (size_t slot = 0; slot < one->mpm->block_count * 8; slot++) {
        if (!is_point(one->mpm, slot)) continue;
        const double x = birth[2 * one->mpm->ids[slot]] - 9, y = birth[2 * one->mpm->ids[slot] + 1] - 9;
        *points_off = fmax(*points_off, hypot(*point_row(one->mpm, slot, ROW_X) - 9 - cos(angle) * x + sin(angle) * y,
                                              *point_row(one->mpm, slot, ROW_X + 1) - 9 - sin(angle) * x - cos(angle) * y));
    }
    free(start), free(birth);
    one_body_destroy(one);
    return worst;
}

static void test_the_outline_of_a_turning_box_stays_with_it(void **state) {
    (void)state;
    static const char *const BASES[3][2] = {{"gimp", "musl"}, {"gimp", "usl"}, {"linear", "musl"}};
    for (int b = 0; b < 3; b++) {
        double points;
        const double off = turn(BASES[b][0], BASES[b][1], EFFORT(1, 0.25), &points);
        print_message("%s, %s: after a turn vertices are off by %.3f of a cell, points by %.3f\n", BASES[b][0], BASES[b][1], off / 0.5,
                      points / 0.5);
        assert_true(off < 0.07 * 0.5); /* 0.15 to 0.3 were they not drawn to their places */
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_box_has_its_corners_and_its_area),
        cmocka_unit_test(test_discs_and_rings_enclose_their_area),
        cmocka_unit_test(test_polygons_of_any_angles),
        cmocka_unit_test(test_unions_have_one_outline),
        cmocka_unit_test(test_an_outline_that_does_not_close_is_refused),
        cmocka_unit_test(test_long_faces_are_divided_and_short_ones_joined),
        cmocka_unit_test(test_stencils_add_up_and_faces_hang_together),
        cmocka_unit_test(test_no_faces_where_nobody_looks_for_them),
        cmocka_unit_test(test_the_outline_of_a_turning_box_stays_with_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
