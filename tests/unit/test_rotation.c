/* test_rotation.c: nodes that turn as a rigid body, 7.5 degrees a step, a hundred times round: the stress turns with the material, nothing else does. */
#include "effort.h"
#include "one_body.h"

enum { STEPS_PER_TURN = 48, TURNS = EFFORT(100, 10) };
static const double PI = 3.14159265358979323846;

static const char *scene(const char *basis, const char *update, const char *material) {
    static char text[2000];
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1e4, dt: 1}\ngrid: {from: [-5, -3], to: [15, 17], cell: 0.5}\n"
             "materials: {m: {%s, density: 1}}\n"
             "bodies: {b: {method: material-points, material: m, shape: {box: [[4, 6.5], [7, 8]]}, basis: %s, update: %s}}\n",
             material, basis, update);
    return text;
}

/* Every node's velocity such that x + v dt is x turned about (5, 7). */
static void turn(one_body *one, void *data) {
    const mpm_body *body = one->mpm;
    /* usavg strains first by the motion that has brought the points to where they are */
    const double sign = body->update == MPM_USAVG && (*(int *)data)++ % 3 == 0 ? -1 : 1;
    const double angle = sign * 2 * PI / STEPS_PER_TURN, cosine = cos(angle), sine = sin(angle), dt = sign * one->step.dt;
    for (size_t k = 0; k < body->tile_count; k++)
        for (int n = 0; n < AB_TILE_NODES; n++) {
            double x[2], *own = node_record(body, k, n);
            node_place(body, k, n, x);
            const double rx = x[0] + body->origin[0] - 5, ry = x[1] + body->origin[1] - 7;
            own[OWN_VELOCITY] = ((cosine - 1) * rx - sine * ry) / dt;
            own[OWN_VELOCITY + 1] = (sine * rx + (cosine - 1) * ry) / dt;
        }
}

static void check(const char *basis, const char *update, const char *material, double modulus, const double start[4]) {
    one_body *one = one_body_create(scene(basis, update, material), 1);
    const mpm_body *body = one->mpm;
    double worst_stress = 0, worst_volume = 0, worst_place = 0, worst_gradient = 0, worst_energy = 0;
    double(*x0)[2] = calloc(body->born, sizeof *x0), *v0 = calloc(body->born, sizeof *v0);
    double total_volume = 0;
    for (size_t slot = 0; slot < body->block_count * 8; slot++) {
        for (int c = 0; c < 4; c++) *point_row(body, slot, ROW_STRESS + c) = start[c];
        if (body->rows.mean_stress >= 0) *point_row(body, slot, body->rows.mean_stress) = 0.5 * (start[0] + start[1]);
        if (!is_point(body, slot)) continue;
        for (int c = 0; c < 2; c++) x0[body->ids[slot]][c] = *point_row(body, slot, ROW_X + c);
        v0[body->ids[slot]] = *point_row(body, slot, ROW_VOLUME);
        total_volume += *point_row(body, slot, ROW_VOLUME);
    }
    int calls = 0;
    for (int s = 1; s <= STEPS_PER_TURN * TURNS; s++) {
        one_body_step(one, turn, &calls);
        if (s % 7 && s % STEPS_PER_TURN) continue; /* look at all angles, and after every turn */
        const double angle = 2 * PI * (s % STEPS_PER_TURN) / STEPS_PER_TURN, c = cos(angle), n = sin(angle);
        const double expected[4] = {c * c * start[0] + n * n * start[1] - 2 * c * n * start[3],
                                    n * n * start[0] + c * c * start[1] + 2 * c * n * start[3], start[2],
                                    c * n * (start[0] - start[1]) + (c * c - n * n) * start[3]};
        size_t seen = 0;
        for (size_t slot = 0; slot < body->block_count * 8; slot++) {
            if (!is_point(body, slot)) continue;
            seen++;
            const uint64_t id = body->ids[slot];
            for (int k = 0; k < 4; k++) worst_stress = fmax(worst_stress, fabs(*point_row(body, slot, ROW_STRESS + k) - expected[k]));
            worst_volume = fmax(worst_volume, fabs(*point_row(body, slot, ROW_VOLUME) / v0[id] - 1));
            const double rx = x0[id][0] + body->origin[0] - 5, ry = x0[id][1] + body->origin[1] - 7;
            const double x = 5 - body->origin[0] + c * rx - n * ry, y = 7 - body->origin[1] + n * rx + c * ry;
            worst_place = fmax(worst_place, hypot(*point_row(body, slot, ROW_X) - x, *point_row(body, slot, ROW_X + 1) - y));
            if (body->rows.gradient >= 0) {
                const double turned[4] = {c, -n, n, c};
                for (int k = 0; k < 4; k++)
                    worst_gradient = fmax(worst_gradient, fabs(*point_row(body, slot, body->rows.gradient + k) - turned[k]));
            }
        }
        assert_int_equal(seen, body->born);
    }
    worst_energy = fabs(body->energy.strain) / total_volume;
    print_message("%-8s %-4s %-14.14s stress %.1e of E, J %.1e, place %.1e m, F %.1e, strain energy %.1e of E\n", basis, update,
                  material + 7, worst_stress / modulus, worst_volume, worst_place, worst_gradient, worst_energy / modulus);
    /* each half of usavg's step turns and stretches, and strain is of second order where both go together: here by 7.5 degrees a step */
    assert_true(worst_stress <= (body->update == MPM_USAVG ? 1e-3 : 1e-10) * modulus);
    assert_true(worst_volume <= 1e-10);
    assert_true(worst_place <= 1e-10);
    assert_true(worst_gradient <= 1e-10);
    assert_true(worst_energy <= 1e-10 * modulus);
    free(x0), free(v0);
    one_body_destroy(one);
}

static void test_stress_turns_with_the_material(void **state) {
    (void)state;
    static const char *const basis[] = {"gimp", "linear", "bspline2", "bspline3", "cpdi"}, *const update[] = {"musl", "usf", "usl",
                                                                                                              "usavg"};
    const double stress[4] = {3, -2, 1, 0.7}, zero[4] = {0};
    for (int b = 0; b < 5; b++)
        for (int u = 0; u < 4; u++) {
            check(basis[b], update[u], "model: linear-elastic, E: 10, nu: 0.3", 10, stress);
            check(basis[b], update[u], "model: neo-hookean, E: 10, nu: 0.3", 10, zero);
            check(basis[b], update[u], "model: von-mises, E: 10, nu: 0.3, yield: 6", 10, stress);
        }
}

static void test_stress_turns_where_pressures_are_averaged(void **state) {
    (void)state;
    const double stress[4] = {3, -2, 1, 0.7}, zero[4] = {0};
    check("gimp, f_bar: patch", "musl", "model: linear-elastic, E: 10, nu: 0.499", 10, stress);
    check("linear, f_bar: cell", "usl", "model: neo-hookean, E: 10, nu: 0.499", 10, zero);
    check("bspline2, f_bar: patch", "usf", "model: neo-hookean, E: 10, nu: 0.499", 10, zero);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_stress_turns_with_the_material),
                                       cmocka_unit_test(test_stress_turns_where_pressures_are_averaged)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
