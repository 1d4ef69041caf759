/* test_elements_static.c: elements against statics with a known answer: patches of constant strain, a cantilever, Cook's membrane. */
#include "static_solver.h"

static const ab_element_type TYPES[] = {AB_ELEMENT_Q4, AB_ELEMENT_Q4R, AB_ELEMENT_Q6, AB_ELEMENT_Q8, AB_ELEMENT_Q8R};
enum { TYPE_COUNT = 5 };

/* ---- patch test ----------------------------------------------------------------------------------------------------- */

/* Five distorted elements in a rectangle (MacNeal and Harder 1985); sides stay straight, nodes in the middle of a side sit there. */
static static_model *patch(ab_element_type type, fem_elastic elastic) {
    static const double corner[8][2] = {{0, 0}, {0.24, 0}, {0.24, 0.12}, {0, 0.12}, {0.04, 0.02}, {0.18, 0.03}, {0.16, 0.08}, {0.08, 0.08}};
    static const uint32_t quad[5][4] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}};
    const bool eight = fem_element_of(type)->nodes == 8;
    static_model *m = model_create(type, elastic, eight ? 20 : 8, 5);
    memcpy(m->x, corner, sizeof corner);
    size_t count = 8;
    uint32_t middle[8][8] = {{0}};
    for (size_t e = 0; e < 5; e++)
        for (int a = 0; a < 4; a++) {
            const uint32_t p = quad[e][a], q = quad[e][(a + 1) % 4];
            m->connectivity[e * (size_t)m->element->nodes + (size_t)a] = p;
            if (!eight) continue;
            if (!middle[p][q]) {
                for (int c = 0; c < 2; c++) m->x[count][c] = (corner[p][c] + corner[q][c]) / 2;
                middle[p][q] = middle[q][p] = (uint32_t)count++;
            }
            m->connectivity[e * 8 + 4 + (size_t)a] = middle[p][q];
        }
    assert_int_equal(count, m->nodes);
    for (size_t i = 0; i < m->nodes; i++)
        m->held[i][0] = m->held[i][1] = m->x[i][0] == 0 || m->x[i][0] == 0.24 || m->x[i][1] == 0 || m->x[i][1] == 0.12;
    return m;
}

/* The outline is moved by x + H x with H large: inner nodes must follow, all stresses be the same, at rest after a few corrections. */
static void check_patch(ab_element_type type, bool f_bar, double nu) {
    static const double gradient[2][2] = {{0.010, 0.025}, {-0.015, 0.020}};
    static_model *m = patch(type, elastic_of(1e6, nu, 1));
    m->f_bar = f_bar;
    model_factor(m);
    for (size_t i = 0; i < m->nodes; i++)
        for (int c = 0; c < 2; c++)
            if (m->held[i][c]) m->u[i][c] = gradient[c][0] * m->x[i][0] + gradient[c][1] * m->x[i][1];
    double(*force)[2] = calloc(m->nodes, sizeof *force);
    for (int correction = 0; correction < 40; correction++) {
        model_forces(m, force);
        for (size_t i = 0; i < m->nodes; i++)
            for (int c = 0; c < 2; c++) force[i][c] = -force[i][c];
        model_correct(m, force);
    }
    double worst = 0, worst_stress = 0, reference[4] = {0}, x[MOST_DOFS][8], u[MOST_DOFS][8];
    for (size_t i = 0; i < m->nodes; i++)
        for (int c = 0; c < 2; c++)
            worst = fmax(worst, fabs(m->u[i][c] - (gradient[c][0] * m->x[i][0] + gradient[c][1] * m->x[i][1])) / (0.025 * 0.24));
    fem_block block;
    model_gather(m, 0, (const double(*)[2])m->x, x);
    model_gather(m, 0, (const double(*)[2])m->u, u);
    elastic_step(m, (const double(*)[8])x, (const double(*)[8])u, false, &block);
    const double pressure = m->elastic.lambda * 0.03;
    reference[0] = pressure + 2 * m->elastic.mu * 0.010;
    reference[1] = pressure + 2 * m->elastic.mu * 0.020;
    reference[2] = pressure;
    reference[3] = m->elastic.mu * 0.010;
    for (int q = 0; q < m->element->gauss; q++)
        for (int c = 0; c < 4; c++)
            for (int l = 0; l < 5; l++) worst_stress = fmax(worst_stress, fabs(block.stress[q][c][l] - reference[c]) / reference[0]);
    for (int l = 0; l < 5 && m->element->extra; l++)
        worst_stress = fmax(worst_stress, fmax(fabs(block.extra[0][l]), fabs(block.extra[1][l])) / (reference[0] * 0.24));
    print_message("patch %-4s%s nu %.4f: displacement %.1e, stress %.1e\n", m->element->name, f_bar ? " mean dilatation" : "", nu, worst,
                  worst_stress);
    assert_true(worst <= 1e-12);
    assert_true(worst_stress <= 1e-12 / (1 - 2 * nu));
    free(force);
    model_destroy(m);
}

static void test_distorted_patch_carries_constant_strain(void **state) {
    (void)state;
    for (int t = 0; t < TYPE_COUNT; t++) check_patch(TYPES[t], false, 0.25);
    check_patch(AB_ELEMENT_Q4, true, 0.25);
    check_patch(AB_ELEMENT_Q4, true, 0.499);
}

/* ---- cantilever ----------------------------------------------------------------------------------------------------- */

/* Consistent loads of a traction t(y) on the side x = place, over whole elements. */
static void load_right(static_model *m, double place, double (*traction)(double y)) {
    const bool eight = m->element->nodes == 8;
    for (size_t e = 0; e < m->elements; e++) {
        const size_t n[3] = {model_node(m, e, 1), model_node(m, e, 2), eight ? model_node(m, e, 5) : 0};
        if (fabs(m->x[n[0]][0] - place) > 1e-9 || fabs(m->x[n[1]][0] - place) > 1e-9) continue;
        const double y0 = m->x[n[0]][1], y1 = m->x[n[1]][1];
        static const double xi[3] = {-0.77459666924148337704, 0, 0.77459666924148337704}, w[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
        for (int q = 0; q < 3; q++) {
            const double s = xi[q], force = w[q] * traction(0.5 * (y0 + y1) + 0.5 * s * (y1 - y0)) * 0.5 * (y1 - y0);
            m->load[n[0]][1] += force * (eight ? 0.5 * s * (s - 1) : 0.5 * (1 - s));
            m->load[n[1]][1] += force * (eight ? 0.5 * s * (s + 1) : 0.5 * (1 + s));
            if (eight) m->load[n[2]][1] += force * (1 - s * s);
        }
    }
}

static const double LENGTH = 48, DEPTH = 12, MODULUS = 3e4, NU = 0.3, PUSH = 1000;
static double parabola(double y) { return PUSH / (2 * DEPTH * DEPTH * DEPTH / 12) * (DEPTH * DEPTH / 4 - y * y); }

/* Timoshenko and Goodier, Theory of Elasticity, 3rd edition, section 21; in plane strain with E/(1-nu^2), nu/(1-nu). */
static void cantilever_exact(double x, double y, double u[2]) {
    const double e = MODULUS / (1 - NU * NU), n = NU / (1 - NU), k = PUSH / (6 * e * DEPTH * DEPTH * DEPTH / 12);
    u[0] = -k * y * ((6 * LENGTH - 3 * x) * x + (2 + n) * (y * y - DEPTH * DEPTH / 4));
    u[1] = k * (3 * n * y * y * (LENGTH - x) + (4 + 5 * n) * DEPTH * DEPTH * x / 4 + (3 * LENGTH - x) * x * x);
}

/* Deflection of the middle of the loaded end over the exact one, 8.138. */
static double cantilever(ab_element_type type, size_t nx, size_t ny) {
    const double corner[4][2] = {{0, -DEPTH / 2}, {LENGTH, -DEPTH / 2}, {LENGTH, DEPTH / 2}, {0, DEPTH / 2}};
    static_model *m = model_quadrilateral(type, elastic_of(MODULUS, NU, 1), nx, ny, corner);
    load_right(m, LENGTH, parabola);
    size_t tip = 0;
    for (size_t i = 0; i < m->nodes; i++) {
        if (fabs(m->x[i][0] - LENGTH) < 1e-9 && fabs(m->x[i][1]) < 1e-9) tip = i;
        if (m->x[i][0] > 1e-9) continue;
        m->held[i][0] = m->held[i][1] = true;
        cantilever_exact(0, m->x[i][1], m->u[i]);
    }
    double exact[2];
    cantilever_exact(LENGTH, 0, exact);
    assert_true(fabs(exact[1] - 8.138) < 5e-4);
    model_solve(m);
    const double ratio = m->u[tip][1] / exact[1];
    print_message("cantilever %-4s %3zu x %2zu: tip %.4f (8.1380), error %+.3f %%\n", m->element->name, nx, ny, m->u[tip][1],
                  100 * (ratio - 1));
    model_destroy(m);
    return ratio - 1;
}

static void test_cantilever_bends_as_timoshenko_and_goodier_say(void **state) {
    (void)state;
    assert_true(fabs(cantilever(AB_ELEMENT_Q8, 8, 2)) < 1e-3);
    assert_true(fabs(cantilever(AB_ELEMENT_Q8, 16, 4)) < 2e-4);
    assert_true(fabs(cantilever(AB_ELEMENT_Q8R, 8, 2)) < 1e-3);
    assert_true(fabs(cantilever(AB_ELEMENT_Q6, 8, 2)) < 2e-2);
    assert_true(fabs(cantilever(AB_ELEMENT_Q6, 32, 8)) < 2e-3);
    assert_true(fabs(cantilever(AB_ELEMENT_Q4R, 8, 2)) < 2e-2);
    assert_true(fabs(cantilever(AB_ELEMENT_Q4R, 32, 8)) < 2e-3);
    const double coarse = cantilever(AB_ELEMENT_Q4, 16, 4), fine = cantilever(AB_ELEMENT_Q4, 32, 8);
    assert_true(coarse < -0.02 && fine < -0.005 && fabs(coarse / fine - 4) < 0.5); /* too stiff in bending, second order */
}

/* ---- Cook's membrane ------------------------------------------------------------------------------------------------ */

static double sixteenth(double y) { return (void)y, 1.0 / 16; }

static double cook(ab_element_type type, bool f_bar, double nu, size_t n) {
    static const double corner[4][2] = {{0, 0}, {48, 44}, {48, 60}, {0, 44}};
    static_model *m = model_quadrilateral(type, elastic_of(1, nu, 1), n, n, corner);
    m->f_bar = f_bar;
    load_right(m, 48, sixteenth);
    size_t tip = 0;
    for (size_t i = 0; i < m->nodes; i++) {
        if (fabs(m->x[i][0] - 48) < 1e-9 && fabs(m->x[i][1] - 52) < 1e-9) tip = i;
        m->held[i][0] = m->held[i][1] = m->x[i][0] < 1e-9;
    }
    model_solve(m);
    const double deflection = m->u[tip][1];
    model_destroy(m);
    return deflection;
}

static void check_cook(ab_element_type type, bool f_bar, double nu, double exact, size_t finest, double tolerance) {
    double last = 0;
    print_message("Cook %-4s%s nu %.4f (%.4f):", fem_element_of(type)->name, f_bar ? " mean dilatation" : "", nu, exact);
    for (size_t n = finest / 8; n <= finest; n *= 2) {
        last = cook(type, f_bar, nu, n);
        print_message("  %zu: %.4f", n, last);
    }
    print_message("  error %+.3f %%\n", 100 * (last / exact - 1));
    assert_true(fabs(last / exact - 1) < tolerance);
}

static void test_cooks_membrane(void **state) {
    (void)state;
    check_cook(AB_ELEMENT_Q4, false, 1.0 / 3, 21.5246, 64, 5e-3);
    check_cook(AB_ELEMENT_Q4R, false, 1.0 / 3, 21.5246, 64, 3e-3);
    check_cook(AB_ELEMENT_Q6, false, 1.0 / 3, 21.5246, 64, 3e-3);
    check_cook(AB_ELEMENT_Q8, false, 1.0 / 3, 21.5246, 32, 2e-3);
    check_cook(AB_ELEMENT_Q8R, false, 1.0 / 3, 21.5246, 32, 2e-3);
    check_cook(AB_ELEMENT_Q4, true, 0.4999, 18.512, 64, 1e-2);
    check_cook(AB_ELEMENT_Q4R, false, 0.4999, 18.512, 64, 1e-2);
    check_cook(AB_ELEMENT_Q6, false, 0.4999, 18.512, 64, 1e-2);
    const double locked = cook(AB_ELEMENT_Q4, false, 0.4999, 32);
    print_message("Cook q4 without mean dilatation nu 0.4999, 32 x 32: %.4f: locks\n", locked);
    assert_true(locked < 0.9 * 18.512);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_distorted_patch_carries_constant_strain),
        cmocka_unit_test(test_cantilever_bends_as_timoshenko_and_goodier_say),
        cmocka_unit_test(test_cooks_membrane),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
