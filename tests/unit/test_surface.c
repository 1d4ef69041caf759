/* test_surface.c: what a surface finder sees of a material-point body: every point of the cells asked for, once, and no other; nodes that give
 * its place and its velocity. */
#include "one_body.h"

static const char *scene(const char *basis, const char *shape, const char *velocity) {
    static char text[2000];
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1e4, dt: 0.002}\n"
             "grid: {from: [-5, -3], to: [15, 17], cell: 0.5}\n"
             "materials: {m: {model: linear-elastic, E: 1000, nu: 0.3, density: 1}}\n"
             "bodies: {b: {method: material-points, material: m, basis: %s, velocity: %s, %s, fill: {per_cell: 9}},\n"
             "         other: {method: material-points, material: m, shape: {box: [[10, 12], [11, 13]]}, fill: {per_cell: 4}}}\n"
             "contact: [{bodies: [b, other], algorithm: multi-velocity}]\n",
             basis, velocity, shape);
    return text;
}

static bool in_region(const ab_region *region, double x, double y) {
    const int i = (int)floor(x / region->cell), j = (int)floor(y / region->cell);
    for (size_t k = 0; k < region->count; k++) {
        const int a = i - ab_tile_x(region->key[k]) * AB_TILE, b = j - ab_tile_y(region->key[k]) * AB_TILE;
        if (a >= 0 && b >= 0 && a < AB_TILE && b < AB_TILE) return region->cells[k] >> (b * AB_TILE + a) & 1;
    }
    return false;
}

/* The body's points by what ops->surface_points says against all there are, for regions that cover `share` of the grid's cells. */
static size_t compare(one_body *one, double share) {
    mpm_body *body = one->mpm;
    uint64_t key[36], cells[36];
    ab_region region = {body->h, 0, key, cells};
    for (int ty = 0; ty < 6; ty++)
        for (int tx = 0; tx < 6; tx++) {
            uint64_t bits = 0;
            for (int n = 0; n < 64; n++) bits |= (uint64_t)(random_between(0, 1) < share) << n;
            if (random_between(0, 1) < 0.3) continue;
            key[region.count] = ab_tile_key(tx, ty);
            cells[region.count++] = bits;
        }
    for (size_t a = 1; a < region.count; a++) assert_true(key[a - 1] < key[a]);
    ab_surface s = {.struct_size = sizeof s, .dimension = 2};
    must(one, one->domain->ops->surface_points(one->domain, &region, &s, one->report));
    size_t expected = 0;
    for (size_t slot = 0; slot < body->block_count * 8; slot++)
        if (is_point(body, slot)) expected += in_region(&region, *point_row(body, slot, ROW_X), *point_row(body, slot, ROW_X + 1));
    assert_int_equal(s.point_count, expected);
    bool *seen = calloc(body->born + 1, sizeof *seen);
    uint32_t *slots = calloc(body->born + 1, sizeof *slots);
    for (size_t slot = 0; slot < body->block_count * 8; slot++)
        if (is_point(body, slot)) slots[body->ids[slot]] = (uint32_t)slot;
    for (size_t k = 0; k < s.point_count; k++) {
        const double *x = s.point_position + k;
        assert_true(in_region(&region, x[0], x[s.point_ld]));
        assert_true(s.point_key[k] >= 1 && s.point_key[k] <= body->born && !seen[s.point_key[k]]);
        seen[s.point_key[k]] = true;
        const size_t slot = slots[s.point_key[k] - 1];
        for (int c = 0; c < 2; c++) assert_true(x[(size_t)c * s.point_ld] == *point_row(body, slot, ROW_X + c));
        for (int c = 0; c < 3; c++)
            assert_true(s.point_extent[(size_t)c * s.point_ld + k] == *point_row(body, slot, body->rows.extent + c));
        assert_true(fabs(s.point_area[k] - sqrt(*point_row(body, slot, ROW_VOLUME))) < 1e-15);
        double sum = 0, place[2] = {0}, inverse = 0;
        for (size_t n = s.point_start[k]; n < s.point_start[k + 1]; n++) {
            double at[2];
            assert_true(s.point_weight[n] > 0 && s.point_dof[n] < body->tile_count * AB_TILE_NODES);
            node_place(body, s.point_dof[n] / AB_TILE_NODES, (int)(s.point_dof[n] % AB_TILE_NODES), at);
            const double mass = node_record(body, 0, (int)s.point_dof[n])[OWN_MASS];
            assert_true(mass > 0);
            sum += s.point_weight[n];
            inverse += s.point_weight[n] * s.point_weight[n] / mass;
            for (int c = 0; c < 2; c++) place[c] += s.point_weight[n] * at[c];
        }
        assert_true(fabs(sum - 1) < 1e-14);
        for (int c = 0; c < 2; c++)
            assert_true(fabs(place[c] - x[(size_t)c * s.point_ld]) <
                        (one->step.number ? 1e-5 : 1e-13));                   /* half sizes follow by Newton steps */
        assert_true(inverse * *point_row(body, slot, ROW_MASS) <= 1 + 1e-12); /* never lighter than itself */
    }
    free(seen), free(slots);
    return expected;
}

static void look(const char *basis) {
    one_body *one = one_body_create(scene(basis, "shape: {disc: {center: [4, 6], radius: 3.3}}", "[\"3-2*(y-6)\", \"-4+2*(x-4)\"]"), 1);
    one->mpm->light_limit = 0; /* each node on its own: those that go by others are test_light_nodes.c's */
    size_t points = 0;
    for (int step = 0; step < 150; step++) { /* a few cells far, and sorted anew on the way */
        must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
        points += compare(one, (step % 5) / 4.0);
        const ab_domain_ops *ops = one->domain->ops;
        must(one, ops->finish(one->domain, &one->step, one->report));
        must(one, ops->remap(one->domain, &one->step, one->report));
        must(one, ops->stress(one->domain, &one->step, one->report));
        one->step.number++;
    }
    assert_true(points > 10000);
    one_body_destroy(one);
}

static void test_every_point_of_the_cells_and_no_other(void **state) {
    (void)state;
    look("gimp");
    look("linear");
}

static void test_a_region_far_away_has_no_points(void **state) {
    (void)state;
    one_body *one = one_body_create(scene("gimp", "shape: {box: [[1, 1], [3, 3]]}", "[0, 0]"), 1);
    must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
    const uint64_t key[2] = {ab_tile_key(-7, 0), ab_tile_key(100, 100)}, cells[2] = {UINT64_MAX, UINT64_MAX};
    const ab_region region = {one->mpm->h, 2, key, cells};
    ab_surface s = {.struct_size = sizeof s, .dimension = 2, .point_count = 99};
    must(one, one->domain->ops->surface_points(one->domain, &region, &s, one->report));
    assert_int_equal(s.point_count, 0);
    assert_true(fabs(one->domain->ops->modulus(one->domain) - 1000 * 0.7 / (1.3 * 0.4)) < 1e-6);
    one_body_destroy(one);
}

/* A row of points of width w along a face: the rule of ab_surface.point_area gives each its width. */
static void test_area_over_half_size_is_the_width_along_a_face(void **state) {
    (void)state;
    one_body *one = one_body_create(scene("gimp", "shape: {box: [[1, 1], [3, 3.2]]}", "[0, 0]"), 1);
    must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
    uint64_t key[4] = {ab_tile_key(0, 0), ab_tile_key(1, 0), ab_tile_key(0, 1), ab_tile_key(1, 1)}, cells[4];
    for (int k = 0; k < 4; k++) cells[k] = UINT64_MAX;
    const ab_region region = {one->mpm->h, 4, key, cells};
    ab_surface s = {.struct_size = sizeof s, .dimension = 2};
    must(one, one->domain->ops->surface_points(one->domain, &region, &s, one->report));
    double top = -INFINITY, length = 0;
    for (size_t k = 0; k < s.point_count; k++) top = fmax(top, s.point_position[s.point_ld + k]);
    for (size_t k = 0; k < s.point_count; k++)
        if (s.point_position[s.point_ld + k] > top - 1e-9)
            length += s.point_area[k] * s.point_area[k] / (2 * sqrt(s.point_extent[s.point_ld + k]));
    assert_true(fabs(length - 2) < 1e-12);
    one_body_destroy(one);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_point_of_the_cells_and_no_other),
        cmocka_unit_test(test_a_region_far_away_has_no_points),
        cmocka_unit_test(test_area_over_half_size_is_the_width_along_a_face),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
