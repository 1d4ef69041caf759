/* test_mesh.c: boxes, patches and their outer faces: places, areas, orientation, chains, sets of places. */
#include "mesh_checks.h"

static size_t node_at(const fem_mesh *mesh, double x, double y) {
    for (size_t i = 0; i < mesh->node_count; i++)
        if (mesh->x[2 * i] == x && mesh->x[2 * i + 1] == y) return i;
    return SIZE_MAX;
}

static void test_a_box_has_its_nodes_in_rows_at_round_places(void **state) {
    (void)state;
    ab_body_spec spec = box_body(AB_ELEMENT_Q8, 0, 0, 3.75, 0.5, 15, 2);
    fem_mesh *mesh = mesh_of(&spec);
    assert_int_equal(mesh->nodes, 8);
    assert_int_equal(mesh->element_count, 30);
    assert_int_equal(mesh->node_count, 16 * 3 + 15 * 3 + 16 * 2);
    assert_true(node_at(mesh, 3.75, 0.25) != SIZE_MAX);
    assert_true(node_at(mesh, 3.75, 0.5) != SIZE_MAX);
    for (size_t i = 1; i < mesh->node_count; i++) /* by rows */
        assert_true(mesh->x[2 * i + 1] > mesh->x[2 * i - 1] ||
                    (mesh->x[2 * i + 1] == mesh->x[2 * i - 1] && mesh->x[2 * i] > mesh->x[2 * i - 2]));
    for (size_t e = 0; e < mesh->element_count; e++) {
        const uint32_t *n = mesh->connectivity + 8 * e;
        for (int s = 0; s < 4; s++)
            for (int d = 0; d < 2; d++)
                assert_float_equal(mesh->x[2 * (size_t)n[4 + s] + (size_t)d],
                                   0.5 * (mesh->x[2 * (size_t)n[s] + (size_t)d] + mesh->x[2 * (size_t)n[(s + 1) % 4] + (size_t)d]), 1e-15);
    }
    assert_float_equal(area_of(mesh), 3.75 * 0.5, 1e-14);
    fem_faces *faces = faces_of(mesh);
    assert_int_equal(faces->count, 2 * 15 + 2 * 2);
    assert_int_equal(faces->node_count, 2 * faces->count);
    assert_int_equal(check_faces(mesh, faces), 1);
    fem_faces_destroy(faces);
    fem_mesh_destroy(mesh);
    spec.mesh.type = AB_ELEMENT_Q4;
    mesh = mesh_of(&spec);
    assert_int_equal(mesh->node_count, 16 * 3);
    assert_true(node_at(mesh, 3.75, 0.25) != SIZE_MAX);
    faces = faces_of(mesh);
    assert_int_equal(check_faces(mesh, faces), 1);
    fem_faces_destroy(faces);
    fem_mesh_destroy(mesh);
}

static void test_grading_is_geometric_from_the_first_to_the_last(void **state) {
    (void)state;
    ab_body_spec spec = box_body(AB_ELEMENT_Q4, 1, -2, 5, 7, 6, 3);
    spec.mesh.grading[0] = 32;
    spec.mesh.grading[1] = 0.25;
    fem_mesh *mesh = mesh_of(&spec);
    for (size_t i = 0; i + 2 <= 6; i++) { /* six sizes, 1 to 32: each twice the one before */
        const double here = mesh->x[2 * (i + 1)] - mesh->x[2 * i];
        if (i < 5) assert_float_equal((mesh->x[2 * (i + 2)] - mesh->x[2 * (i + 1)]) / here, 2, 1e-12);
    }
    const double first = mesh->x[2 * 7 + 1] - mesh->x[1], last = mesh->x[2 * 21 + 1] - mesh->x[2 * 14 + 1];
    assert_float_equal(last / first, 0.25, 1e-12);
    assert_true(mesh->x[2 * 27] == 5 && mesh->x[2 * 27 + 1] == 7);
    fem_mesh_destroy(mesh);
}

/* Quarter of a ring of radii 1 and 2, by two arcs. */
static ab_body_spec quarter_ring(ab_element_type type, long n, double (*points)[2], ab_edge_spec *edge) {
    const double corner[4][2] = {{1, 0}, {2, 0}, {0, 2}, {0, 1}};
    memcpy(points[0], corner[0], 16), memcpy(points[1], corner[1], 16); /* bottom */
    memcpy(points[2], corner[1], 16), memcpy(points[3], corner[2], 16); /* right: outer arc */
    memcpy(points[4], corner[3], 16), memcpy(points[5], corner[2], 16); /* top */
    memcpy(points[6], corner[0], 16), memcpy(points[7], corner[3], 16); /* left: inner arc */
    for (int k = 0; k < 4; k++) edge[k] = (ab_edge_spec){.points = points + 2 * k, .count = 2, .arc = k % 2 == 1};
    ab_body_spec spec = box_body(type, 0, 0, 1, 1, n, 2 * n);
    spec.mesh.kind = AB_MESH_PATCH;
    memcpy(spec.mesh.edge, edge, sizeof spec.mesh.edge);
    return spec;
}

static void test_a_quarter_ring_has_the_area_of_its_polygon_or_parabolas(void **state) {
    (void)state;
    double points[8][2], error[2];
    ab_edge_spec edge[4];
    const double exact = 0.75 * acos(-1.0);
    for (int quadratic = 0; quadratic < 2; quadratic++)
        for (int k = 0; k < 2; k++) {
            const long n = 4 << k;
            const ab_body_spec spec = quarter_ring(quadratic ? AB_ELEMENT_Q8 : AB_ELEMENT_Q4, n, points, edge);
            fem_mesh *mesh = mesh_of(&spec);
            fem_faces *faces = faces_of(mesh);
            assert_int_equal(check_faces(mesh, faces), 1);
            /* chords of angle a: (R^2 - r^2)/2 sin a each; a parabola adds 2/3 chord x height */
            const double a = acos(-1.0) / (4.0 * (double)n), cap = 2.0 / 3 * 2 * sin(a / 2) * (1 - cos(a / 2));
            const double here = 2.0 * (double)n * 3 * (0.5 * sin(a) + (quadratic ? cap : 0));
            assert_float_equal(area_of(mesh), here, 1e-13);
            error[k] = fabs(area_of(mesh) - exact);
            for (size_t i = 0; i < mesh->node_count; i++) { /* transfinite interpolation of a ring is the ring's own polar mesh */
                const double r = hypot(mesh->x[2 * i], mesh->x[2 * i + 1]);
                assert_true(r > 1 - 1e-14 && r < 2 + 1e-14);
            }
            for (size_t i = 0; i < faces->node_count; i++) {
                const double *x = mesh->x + 2 * (size_t)faces->node[i], r = hypot(x[0], x[1]);
                assert_true(fabs(r - 1) < 1e-14 || fabs(r - 2) < 1e-14 || x[0] < 1e-14 || x[1] < 1e-14); /* middles on the circle, too */
            }
            fem_faces_destroy(faces);
            fem_mesh_destroy(mesh);
            if (k == 1) assert_float_equal(log2(error[0] / error[1]), quadratic ? 4 : 2, 0.05);
        }
}

static void test_a_patch_follows_points_by_length(void **state) {
    (void)state;
    double bottom[3][2] = {{0, 0}, {1, 0}, {4, 0}}, right[2][2] = {{4, 0}, {4, 2}}, top[2][2] = {{0, 2}, {4, 2}},
           left[2][2] = {{0, 0}, {0, 2}};
    ab_body_spec spec = box_body(AB_ELEMENT_Q8, 0, 0, 1, 1, 4, 2);
    spec.mesh.kind = AB_MESH_PATCH;
    const ab_edge_spec edge[4] = {{bottom, 3, false, {0}}, {right, 2, false, {0}}, {top, 2, false, {0}}, {left, 2, false, {0}}};
    memcpy(spec.mesh.edge, edge, sizeof edge);
    fem_mesh *patch = mesh_of(&spec);
    const ab_body_spec box = box_body(AB_ELEMENT_Q8, 0, 0, 4, 2, 4, 2);
    fem_mesh *same = mesh_of(&box);
    assert_int_equal(patch->node_count, same->node_count);
    assert_memory_equal(patch->connectivity, same->connectivity, 8 * 8 * sizeof(uint32_t));
    for (size_t i = 0; i < 2 * same->node_count; i++) assert_float_equal(patch->x[i], same->x[i], 1e-14);
    fem_mesh_destroy(same);
    fem_mesh_destroy(patch);
}

static void test_a_corner_that_no_element_meets_is_warned_of(void **state) {
    (void)state;
    double bottom[3][2] = {{0, 0}, {2, -1}, {4, 0}}, right[2][2] = {{4, 0}, {4, 2}}, top[2][2] = {{0, 2}, {4, 2}},
           left[2][2] = {{0, 0}, {0, 2}};
    const ab_edge_spec edge[4] = {{bottom, 3, false, {0}}, {right, 2, false, {0}}, {top, 2, false, {0}}, {left, 2, false, {0}}};
    for (long n = 4; n < 6; n++) {
        ab_body_spec spec = box_body(AB_ELEMENT_Q8, 0, 0, 1, 1, n, 2);
        spec.mesh.kind = AB_MESH_PATCH;
        memcpy(spec.mesh.edge, edge, sizeof edge);
        ab_report *report = ab_report_create();
        fem_mesh *mesh = NULL;
        assert_int_equal(fem_mesh_create(&spec, ".", &mesh, report), AB_OK);
        assert_int_equal(ab_report_warnings(report), n == 5);
        if (n == 5) assert_non_null(strstr(ab_report_text(report, 0), "the corner at [2, -1] of the patch's bottom edge"));
        if (n == 4) assert_float_equal(area_of(mesh), 10, 1e-13);
        fem_mesh_destroy(mesh);
        ab_report_destroy(report);
    }
}

static void test_a_folded_patch_is_refused(void **state) {
    (void)state;
    double bottom[3][2] = {{0, 0}, {2, 3}, {4, 0}}, right[2][2] = {{4, 0}, {4, 2}}, top[2][2] = {{0, 2}, {4, 2}},
           left[2][2] = {{0, 0}, {0, 2}};
    ab_body_spec spec = box_body(AB_ELEMENT_Q4, 0, 0, 1, 1, 4, 2);
    spec.mesh.kind = AB_MESH_PATCH;
    const ab_edge_spec edge[4] = {{bottom, 3, false, {0}}, {right, 2, false, {0}}, {top, 2, false, {0}}, {left, 2, false, {0}}};
    memcpy(spec.mesh.edge, edge, sizeof edge);
    ab_report *report = ab_report_create();
    fem_mesh *mesh = NULL;
    assert_int_equal(fem_mesh_create(&spec, ".", &mesh, report), AB_BAD_INPUT);
    assert_null(mesh);
    assert_non_null(strstr(ab_report_text(report, 0), "is folded or has an angle of 180 degrees"));
    ab_report_destroy(report);
}

/* Elements of a 5 x 4 box, '#' kept, rows from the top. */
static fem_mesh *drawn(ab_element_type type, const char *rows) {
    const ab_body_spec spec = box_body(type, 0, 0, 5, 4, 5, 4);
    fem_mesh *box = mesh_of(&spec);
    bool keep[20];
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 5; i++) keep[5 * (3 - j) + i] = rows[5 * j + i] == '#';
    fem_mesh *part = part_of(box, keep);
    fem_mesh_destroy(box);
    return part;
}

static void test_holes_and_bays_have_chains_of_their_own(void **state) {
    (void)state;
    static const struct {
        const char *rows;
        size_t faces, chains;
    } cases[] = {
        {"#####"
         "#...#"
         "#.#.#"
         "#####",
         18 + 12, 2}, /* a peg in the hole grows from its floor */
        {"#####"
         "#.#.#"
         "#####"
         "....#",
         18 + 4 + 4, 3},
        {"#...."
         "#...."
         "##..."
         "#####",
         18, 1},
        {".#..."
         "#.#.."
         ".#..."
         ".....",
         16, 4}, /* four that touch in corners: four bodies, and no chain about the hole */
        {"####."
         "#.##."
         "##.#."
         "####.",
         16 + 4 + 4, 2}, /* two holes that touch in a corner: the chain goes about the material there, so through both */
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        for (int type = AB_ELEMENT_Q4; type <= AB_ELEMENT_Q8; type += AB_ELEMENT_Q8) {
            fem_mesh *mesh = drawn((ab_element_type)type, cases[k].rows);
            fem_faces *faces = faces_of(mesh);
            assert_int_equal(faces->count, cases[k].faces);
            assert_int_equal(check_faces(mesh, faces), cases[k].chains);
            fem_faces_destroy(faces);
            fem_mesh_destroy(mesh);
        }
}

static size_t nodes_where(const fem_mesh *mesh, const fem_faces *faces, ab_where where) {
    size_t count = 0;
    for (uint32_t i = 0; i < mesh->node_count; i++) count += fem_where_node(&where, mesh, faces, i);
    return count;
}

static size_t faces_where(const fem_mesh *mesh, const fem_faces *faces, ab_where where) {
    size_t count = 0;
    for (size_t f = 0; f < faces->count; f++) count += fem_where_face(&where, mesh, faces, f);
    return count;
}

static void test_sets_of_places_hold_the_nodes_and_faces_meant(void **state) {
    (void)state;
    const ab_body_spec spec = box_body(AB_ELEMENT_Q8, 0, 0, 3, 2, 3, 2);
    fem_mesh *mesh = mesh_of(&spec);
    fem_faces *faces = faces_of(mesh);
    const ab_where all = {.all = true, .side = -1}, top = {.side = AB_TOP}, left = {.side = AB_LEFT};
    const ab_where line = {.side = -1, .has = {true}, .range = {{0, 0}}}, range = {.side = AB_BOTTOM, .has = {true}, .range = {{0.9, 2.1}}};
    const ab_where inside = {.side = -1, .has = {true, true}, .range = {{1, 1}, {1, 1}}},
                   third = {.side = -1, .has = {true}, .range = {{0.1 * 3 * 10 / 3 * 3, 3}}};
    assert_int_equal(nodes_where(mesh, faces, all), mesh->node_count);
    assert_int_equal(faces_where(mesh, faces, all), 10);
    assert_int_equal(nodes_where(mesh, faces, top), 7);
    assert_int_equal(faces_where(mesh, faces, top), 3);
    assert_int_equal(nodes_where(mesh, faces, left), 5);
    assert_int_equal(nodes_where(mesh, faces, line), 5);
    assert_int_equal(faces_where(mesh, faces, line), 2);
    assert_int_equal(nodes_where(mesh, faces, range), 3);
    assert_int_equal(faces_where(mesh, faces, range), 1);
    assert_int_equal(nodes_where(mesh, faces, inside), 1);
    assert_int_equal(nodes_where(mesh, faces, third), 5); /* rounding of a formula does not lose the side */
    fem_faces_destroy(faces);
    fem_mesh_destroy(mesh);
    mesh = drawn(AB_ELEMENT_Q4, "##..."
                                "##..."
                                "#####"
                                "#####");
    faces = faces_of(mesh);
    assert_int_equal(faces_where(mesh, faces, top), 5); /* both steps of an L face up */
    assert_int_equal(nodes_where(mesh, faces, top), 7);
    fem_faces_destroy(faces);
    fem_mesh_destroy(mesh);
}

static void test_elements_on_each_other_are_refused(void **state) {
    (void)state;
    const ab_body_spec spec = box_body(AB_ELEMENT_Q4, 0, 0, 2, 1, 2, 1);
    fem_mesh *mesh = mesh_of(&spec);
    memcpy(mesh->connectivity + 4, mesh->connectivity, 4 * sizeof *mesh->connectivity);
    ab_report *report = ab_report_create();
    fem_faces *faces = NULL;
    assert_int_equal(fem_faces_create(mesh, "beam", &faces, report), AB_BAD_INPUT);
    assert_null(faces);
    assert_non_null(strstr(ab_report_text(report, 0), "body 'beam': elements 0 and 1 lie on the same side"));
    ab_report_destroy(report);
    fem_mesh_destroy(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_box_has_its_nodes_in_rows_at_round_places),
        cmocka_unit_test(test_grading_is_geometric_from_the_first_to_the_last),
        cmocka_unit_test(test_a_quarter_ring_has_the_area_of_its_polygon_or_parabolas),
        cmocka_unit_test(test_a_patch_follows_points_by_length),
        cmocka_unit_test(test_a_corner_that_no_element_meets_is_warned_of),
        cmocka_unit_test(test_a_folded_patch_is_refused),
        cmocka_unit_test(test_holes_and_bays_have_chains_of_their_own),
        cmocka_unit_test(test_sets_of_places_hold_the_nodes_and_faces_meant),
        cmocka_unit_test(test_elements_on_each_other_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
