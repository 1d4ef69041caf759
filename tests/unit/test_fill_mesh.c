/* test_fill_mesh.c: points at the Gauss points of a mesh: exact masses and first moments, the lattice's points where the mesh is one, an outline that closes. */
#include "fem/mesh.h"
#include "fill_checks.h"

static fem_mesh *mesh_of(const ab_mesh_spec *spec) {
    ab_report *report = ab_report_create();
    const ab_body_spec body = {.name = (char *)(uintptr_t) "body", .mesh = *spec};
    fem_mesh *mesh = NULL;
    const ab_status status = fem_mesh_create(&body, ".", &mesh, report);
    if (status != AB_OK) ab_report_print(report, stderr);
    assert_int_equal(status, AB_OK);
    ab_report_destroy(report);
    return mesh;
}

static ab_fill *points_in(const fem_mesh *mesh, int per_element) {
    ab_report *report = ab_report_create();
    const ab_shape_spec shape = {.kind = AB_SHAPE_MESH};
    const ab_fill_request request = {.rule = AB_FILL_GAUSS, .per_cell = per_element, .cell = 10, .mesh = mesh};
    ab_fill *fill = NULL;
    const ab_status status = ab_fill_make(&shape, &request, "body", &fill, report);
    if (status != AB_OK) ab_report_print(report, stderr);
    assert_int_equal(status, AB_OK);
    assert_int_equal(fill->count, mesh->element_count * (size_t)per_element);
    ab_report_destroy(report);
    return fill;
}

static void test_a_box_has_the_points_of_its_gauss_fill(void **state) {
    (void)state;
    const ab_shape_spec shape = box(-1, 2, 2, 4);
    const double none[4] = {1, 0, 0, 1};
    for (int type = AB_ELEMENT_Q4; type <= AB_ELEMENT_Q8; type += AB_ELEMENT_Q8)
        for (int n = 1; n <= 5; n++) {
            const ab_mesh_spec spec = {
                .kind = AB_MESH_BOX, .type = (ab_element_type)type, .low = {-1, 2}, .high = {2, 4}, .elements = {6, 4}, .grading = {1, 1}};
            fem_mesh *mesh = mesh_of(&spec);
            ab_fill *a = points_in(mesh, n * n), *b = fill_of(&shape, AB_FILL_GAUSS, n * n, 0.5);
            check_sane(a);
            check_same_points(a, none, b);
            near(surface_error(a), 0, 1e-12);
            near(length_of(a), 10, 1e-12);
            ab_fill_destroy(a), ab_fill_destroy(b), fem_mesh_destroy(mesh);
        }
}

/* Straight sides, no two elements alike, five of them round one node: areas are exact with any number of points, first moments from four on. */
static void test_unstructured_quadrilaterals_are_exact(void **state) {
    (void)state;
    enum { STAR = 5 };
    double x[1 + 2 * STAR][2] = {{0.13, -0.21}}, outline[2 * STAR][2];
    uint32_t node[STAR][4];
    for (int k = 0; k < 2 * STAR; k++)
        for (int c = 0; c < 2; c++)
            outline[k][c] = x[1 + k][c] =
                (k % 2 ? 2.2 + 0.1 * k : 1.7 - 0.05 * k) * (c ? sin(PI / STAR * k + 0.3) : cos(PI / STAR * k + 0.3));
    for (uint32_t e = 0; e < STAR; e++)
        memcpy(node[e], (uint32_t[4]){0, 1 + 2 * e, 2 + 2 * e, 1 + (2 * e + 2) % (2 * STAR)}, sizeof node[e]);
    const fem_mesh mesh = {.nodes = 4,
                           .node_count = 1 + 2 * STAR,
                           .element_count = STAR,
                           .x = &x[0][0],
                           .connectivity = &node[0][0],
                           .low = {-4, -4},
                           .high = {4, 4}};
    double moment = 0; /* of x, by triangles from the origin */
    for (int k = 0; k < 2 * STAR; k++) {
        const double *p = outline[k], *q = outline[(k + 1) % (2 * STAR)];
        moment += (p[0] * q[1] - p[1] * q[0]) * (p[0] + q[0]) / 6;
    }
    for (int n = 1; n <= 4; n++) {
        ab_fill *f = points_in(&mesh, n * n);
        const double area = shoelace(outline, 2 * STAR);
        check_sane(f);
        near(volume_of(f), area, 1e-12 * area);
        near(length_of(f), perimeter(outline, 2 * STAR), 1e-12 * length_of(f));
        for (size_t p = 0; p < f->count; p++) near(outside(outline, 2 * STAR, f->x[p], f->y[p]), 0, 0);
        if (n > 1) near(moment_of(f, f->x), moment, 1e-12 * area);
        ab_fill_destroy(f);
    }
}

/* A quarter of a ring in curved elements: the area that eight nodes make of it, the same for any number of points, an outline that closes; near the true one. */
static void test_curved_elements_keep_their_area(void **state) {
    (void)state;
    double bottom[2][2] = {{1, 0}, {2, 0}}, top[2][2] = {{0, 1}, {0, 2}}, inner[2][2] = {{1, 0}, {0, 1}}, outer[2][2] = {{2, 0}, {0, 2}};
    const ab_mesh_spec spec = {.kind = AB_MESH_PATCH,
                               .type = AB_ELEMENT_Q8,
                               .elements = {3, 8},
                               .grading = {1, 1},
                               .edge = {{.points = bottom, .count = 2},
                                        {.points = outer, .count = 2, .arc = true},
                                        {.points = top, .count = 2},
                                        {.points = inner, .count = 2, .arc = true}}};
    fem_mesh *mesh = mesh_of(&spec);
    ab_fill *many = points_in(mesh, 25);
    near(volume_of(many), 0.75 * PI, 1e-5);
    for (int n = 1; n <= 4; n++) {
        ab_fill *f = points_in(mesh, n * n);
        check_sane(f);
        near(volume_of(f), volume_of(many), 1e-12);
        near(length_of(f), 2 + 1.5 * PI, 0.01 / (n * n));
        assert_true(surface_error(f) < 0.05 / n);
        ab_fill_destroy(f);
    }
    ab_fill_destroy(many);
    fem_mesh_destroy(mesh);
}

static void test_what_a_mesh_cannot_be_filled_with_is_refused(void **state) {
    (void)state;
    const ab_mesh_spec spec = {
        .kind = AB_MESH_BOX, .type = AB_ELEMENT_Q4, .low = {0, 0}, .high = {1, 1}, .elements = {2, 2}, .grading = {1, 1}};
    fem_mesh *mesh = mesh_of(&spec);
    const ab_shape_spec shape = {.kind = AB_SHAPE_MESH};
    const ab_fill_request wrong[] = {{.rule = AB_FILL_GAUSS, .per_cell = 6, .cell = 1, .mesh = mesh},
                                     {.rule = AB_FILL_CVT, .per_cell = 4, .cell = 1, .mesh = mesh},
                                     {.rule = AB_FILL_GAUSS, .per_cell = 4, .cell = 1}};
    for (size_t k = 0; k < 3; k++) {
        ab_report *report = ab_report_create();
        ab_fill *f = NULL;
        assert_int_equal(ab_fill_make(&shape, &wrong[k], "body", &f, report), AB_BAD_INPUT);
        assert_null(f);
        ab_report_destroy(report);
    }
    fem_mesh_destroy(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_box_has_the_points_of_its_gauss_fill),
        cmocka_unit_test(test_unstructured_quadrilaterals_are_exact),
        cmocka_unit_test(test_curved_elements_keep_their_area),
        cmocka_unit_test(test_what_a_mesh_cannot_be_filled_with_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
