/* test_axisymmetric.c: rings about an axis: v_r = a r strains by a in both directions exactly, wherever points stand; a uniform pressure has no force on nodes inside;
 * volumes add up to those of the solid. */
#include "one_body.h"

static const double RATE = 0.3, AXIAL = -0.2, PRESSURE[4] = {-2, -2, -2, 0};
static const char *const BASES[] = {"linear", "gimp", "bspline2", "bspline3", "cpdi"};

static one_body *body_of(const char *basis, const char *fill, double from, double low, double high) {
    char text[2000];
    snprintf(text, sizeof text,
             "abut: 1\nspace: axisymmetric\ntime: {end: 100, dt: 1e-3}\ngrid: {from: [%g, -1], to: [9, 9], cell: 0.5}\n"
             "materials: {m: {model: neo-hookean, E: 10, nu: 0.3, density: 2}}\n"
             "bodies: {b: {method: material-points, material: m, shape: {box: [[%g, 0.13], [%g, 4.3]]}, basis: %s, fill: %s}}\n",
             from, low, high, basis, fill);
    return one_body_create(text, 1);
}

/* The nodes move as the solid that grows by RATE across the axis and by AXIAL along it. */
static void grow(one_body *one, void *data) {
    (void)data;
    const mpm_body *body = one->mpm;
    for (size_t k = 0; k < body->tile_count; k++)
        for (int n = 0; n < AB_TILE_NODES; n++) {
            double x[2], *own = node_record(body, k, n);
            node_place(body, k, n, x);
            own[OWN_VELOCITY] = RATE * (x[0] + body->origin[0]);
            own[OWN_VELOCITY + 1] = AXIAL * x[1];
        }
}

static void test_uniform_growth_strains_alike_in_both_directions(void **state) {
    (void)state;
    for (int b = 0; b < 5; b++)
        for (int hollow = 0; hollow < 2; hollow++) {
            one_body *one = body_of(BASES[b], "{rule: regular, per_cell: 4}", hollow ? 0.25 : 0, hollow ? 0.91 : 0, 2.77);
            const mpm_body *body = one->mpm;
            const int steps = 20;
            double *start = calloc(body->born, sizeof *start);
            for (size_t slot = 0; slot < body->block_count * 8; slot++)
                if (is_point(body, slot)) start[body->ids[slot]] = *point_row(body, slot, ROW_VOLUME);
            for (int s = 0; s < steps; s++) one_body_step(one, grow, NULL);
            const double across = pow(1 + RATE * one->step.dt, steps), along = pow(1 + AXIAL * one->step.dt, steps);
            for (size_t slot = 0; slot < body->block_count * 8; slot++) {
                if (!is_point(body, slot)) continue;
                assert_true(fabs(*point_row(body, slot, body->rows.gradient) / across - 1) < 1e-12);
                assert_true(fabs(*point_row(body, slot, body->rows.gradient + 3) / along - 1) < 1e-12);
                assert_true(fabs(*point_row(body, slot, body->rows.gradient + 4) / across - 1) < 1e-12);
                assert_true(fabs(*point_row(body, slot, ROW_VOLUME) / start[body->ids[slot]] / (across * across * along) - 1) < 1e-12);
                assert_true(fabs(*point_row(body, slot, ROW_STRESS) - *point_row(body, slot, ROW_STRESS + 2)) < 1e-10);
            }
            free(start);
            one_body_destroy(one);
        }
}

/* Each circle moves along the axis as a whole: domains lean. */
static void shear(one_body *one, void *data) {
    const mpm_body *body = one->mpm;
    for (size_t k = 0; k < body->tile_count; k++)
        for (int n = 0; n < AB_TILE_NODES; n++) {
            double x[2], *own = node_record(body, k, n);
            node_place(body, k, n, x);
            own[OWN_VELOCITY] = 0;
            own[OWN_VELOCITY + 1] = *(const double *)data * (x[0] + body->origin[0]);
        }
}

/* Largest force on nodes whose functions end inside the body, over pressure times the circle's length times h; of the body as drawn, or leaning. */
static double worst_leaning(const char *basis, int per_cell, double low, double high, double lean) {
    char fill[80];
    snprintf(fill, sizeof fill, "{rule: regular, per_cell: %d}", per_cell);
    one_body *one = body_of(basis, fill, 0, low, high);
    mpm_body *body = one->mpm;
    const double rate = lean / (20 * one->step.dt);
    for (int s = 0; s < 20 && lean > 0; s++) one_body_step(one, shear, (void *)&rate);
    for (size_t slot = 0; slot < body->block_count * 8; slot++)
        for (int c = 0; c < 4; c++) *point_row(body, slot, ROW_STRESS + c) = PRESSURE[c];
    body->scattered = false; /* the last step has scattered its own stress */
    must(one, one->domain->ops->begin(one->domain, &one->step, one->report));
    double worst = 0;
    size_t inner = 0;
    for (size_t k = 0; k < body->tile_count; k++)
        for (int n = 0; n < AB_TILE_NODES; n++) {
            double x[2], *own = node_record(body, k, n);
            node_place(body, k, n, x);
            const double reach = strncmp(basis, "bspline", 7) ? 1 : body->kernel->reach, y = x[1] + body->origin[1];
            if (!(x[0] > 0) || x[0] - low < (low > 0 ? reach * body->h : -1) || high - x[0] < reach * body->h ||
                y - 0.13 - lean * high < reach * body->h || 4.3 - y < reach * body->h)
                continue;
            inner++;
            for (int d = 0; d < 2; d++)
                worst = fmax(worst,
                             own[OWN_MASS] * fabs(own[OWN_VELOCITY + d] - own[OWN_OLD + d]) / one->step.dt / (2 * 6.2832 * x[0] * body->h));
        }
    assert_true(inner > 5);
    one_body_destroy(one);
    return worst;
}

static double worst_force(const char *basis, int per_cell, double low, double high) { return worst_leaning(basis, per_cell, low, high, 0); }

static void test_domains_bear_a_uniform_pressure_exactly(void **state) {
    (void)state;
    for (int per_cell = 2; per_cell < 10; per_cell++) {
        assert_true(worst_force("gimp", per_cell, 0.0, 3.1) < 1e-12);
        assert_true(worst_force("gimp", per_cell, 0.83, 4.27) < 1e-12);
        assert_true(worst_force("cpdi", per_cell, 0.0, 3.1) < 1e-12);
        assert_true(worst_force("cpdi", per_cell, 0.83, 4.27) < 1e-12);
        assert_true(worst_leaning("cpdi", per_cell, 0.0, 3.1, 0.4) < 1e-12);
    }
    for (int b = 0; b < 5; b++)
        print_message("%-9s force of a uniform pressure inside: %.1e (solid), %.1e (hollow), %.1e (leaning)\n", BASES[b],
                      worst_force(BASES[b], 4, 0, 3.1), worst_force(BASES[b], 4, 0.83, 4.27), worst_leaning(BASES[b], 4, 0, 3.1, 0.4));
}

static void test_volumes_add_up_to_the_solid(void **state) {
    (void)state;
    static const char *const FILLS[] = {"{rule: regular, per_cell: 4}", "{rule: regular, per_cell: 7}", "{rule: gauss, per_cell: 1}",
                                        "{rule: gauss, per_cell: 9}"};
    for (int f = 0; f < 4; f++) {
        one_body *one = body_of("gimp", FILLS[f], 0, 0.37, 2.9);
        ab_energy energy;
        ab_motion motion;
        one->domain->ops->ledger(one->domain, &energy, &motion);
        const double exact = 2 * 3.14159265358979323846 * (2.9 * 2.9 - 0.37 * 0.37) * (4.3 - 0.13);
        assert_true(fabs(motion.mass / exact - 1) < 1e-12);
        one_body_destroy(one);
    }
    one_body one = {0};
    const char *polygon =
        "abut: 1\nspace: axisymmetric\ntime: {end: 1, dt: 1}\ngrid: {from: [0, 0], to: [9, 9], cell: 0.5}\n"
        "materials: {m: {model: linear-elastic, E: 10, nu: 0.3, density: 3}}\n"
        "bodies: {b: {method: material-points, material: m, shape: {polygon: [[0, 1], [2.3, 1], [0, 4.1]]}}}\n"; /* a cone */
    must(&one, one_body_attempt(&one, polygon, 1));
    assert_true(fabs(one.mpm->motion.mass / (3.14159265358979323846 * 2.3 * 2.3 * 3.1) - 1) < 1e-12);
    one.domain->ops->destroy(one.domain);
    ab_scene_destroy(one.scene), ab_registry_destroy(one.registry), ab_report_destroy(one.report);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_uniform_growth_strains_alike_in_both_directions),
        cmocka_unit_test(test_domains_bear_a_uniform_pressure_exactly),
        cmocka_unit_test(test_volumes_add_up_to_the_solid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
