/* test_elements.c: what one element promises: basis, objectivity, balance of forces, work, masses, inverted elements; its stiffness and modes are in
 * test_elements_modes.c, whole bodies in test_elements_static.c. */
#include "element_samples.h"

#include <time.h>

/* ---- basis ---------------------------------------------------------------------------------------------------------- */

static void test_basis_sums_to_one_and_reproduces_linear_fields(void **state) {
    (void)state;
    static const double place[8][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}};
    for (int nodes = 4; nodes <= 8; nodes += 4) {
        for (int trial = 0; trial < 100; trial++) {
            const double xi = number(), eta = number();
            double n[8], dn[8][2], sum[9] = {0}, up[8], down[8];
            fem_shape(nodes, xi, eta, n);
            fem_shape_derivatives(nodes, xi, eta, dn);
            for (int a = 0; a < nodes; a++) {
                const double own[3] = {1, place[a][0], place[a][1]};
                for (int k = 0; k < 3; k++) sum[k] += n[a] * own[k], sum[3 + k] += dn[a][0] * own[k], sum[6 + k] += dn[a][1] * own[k];
            }
            const double expected[9] = {1, xi, eta, 0, 1, 0, 0, 0, 1};
            for (int k = 0; k < 9; k++) assert_true(fabs(sum[k] - expected[k]) < 1e-15 * 8);
            for (int c = 0; c < 2; c++) {
                const double step = 1e-6;
                fem_shape(nodes, xi + (c == 0 ? step : 0), eta + (c == 1 ? step : 0), up);
                fem_shape(nodes, xi - (c == 0 ? step : 0), eta - (c == 1 ? step : 0), down);
                for (int a = 0; a < nodes; a++) assert_true(fabs((up[a] - down[a]) / (2 * step) - dn[a][c]) < 1e-9);
            }
        }
        for (int a = 0; a < nodes; a++) {
            double n[8];
            fem_shape(nodes, place[a][0], place[a][1], n);
            for (int b = 0; b < nodes; b++) assert_true(n[b] == (a == b));
        }
    }
}

/* Gauss points: weights, gradients and volumes that the kernels use are those of the basis. */
static void test_gradients_and_volumes_are_those_of_the_basis(void **state) {
    (void)state;
    for (int t = 0; t < TYPE_COUNT; t++) {
        const fem_element *element = fem_element_of(TYPES[t]);
        const fem_elastic elastic = elastic_of(1e3, 0.3, 1);
        fem_block block = {.start = {{0}}};
        draw(element, 2, 1.5, 0.05, block.start);
        for (int k = 0; k < 2 * element->nodes; k++)
            for (int l = 0; l < 8; l++) block.end[k][l] = block.start[k][l] + 0.02 * number();
        element->strain(&block, &elastic, false, 1);
        double total = 0;
        for (int q = 0; q < element->gauss; q++) {
            double place[2], weight, dn[8][2];
            fem_gauss(element, q, place, &weight);
            fem_shape_derivatives(element->nodes, place[0], place[1], dn);
            total += weight;
            for (int l = 0; l < 8; l++) {
                double j0[2][2] = {{0}}, j1[2][2] = {{0}};
                for (int a = 0; a < element->nodes; a++)
                    for (int c = 0; c < 2; c++)
                        for (int d = 0; d < 2; d++)
                            j0[c][d] += block.start[2 * a + c][l] * dn[a][d], j1[c][d] += block.end[2 * a + c][l] * dn[a][d];
                const double v0 = weight * (j0[0][0] * j0[1][1] - j0[0][1] * j0[1][0]),
                             v1 = weight * (j1[0][0] * j1[1][1] - j1[0][1] * j1[1][0]);
                assert_true(fabs(block.volume0[q][l] / v0 - 1) < 1e-13);
                assert_true(fabs(block.volume[q][l] / v1 - 1) < 1e-13);
                if (TYPES[t] == AB_ELEMENT_Q6) continue; /* has modes besides */
                for (int c = 0; c < 2; c++)              /* (I + H) J0 = J1 */
                    for (int d = 0; d < 2; d++) {
                        const double end = j0[c][d] + block.h[q][2 * c][l] * j0[0][d] + block.h[q][2 * c + 1][l] * j0[1][d];
                        assert_true(fabs(end - j1[c][d]) < 1e-14);
                    }
            }
        }
        assert_true(fabs(total - 4) < 1e-14);
    }
}

/* Mean dilatation in a large step: every point changes its volume in the ratio of the whole element, and keeps its own shape. */
static void test_mean_dilatation_is_that_of_the_element(void **state) {
    (void)state;
    const fem_element *element = fem_element_of(AB_ELEMENT_Q4);
    const fem_elastic elastic = elastic_of(1, 0.3, 1);
    fem_block plain, block;
    memset(&block, 0, sizeof block);
    draw(element, 1, 0.7, 0.1, block.start);
    draw(element, 1.2, 0.6, 0.1, block.end);
    plain = block;
    element->strain(&plain, &elastic, false, 1);
    element->strain(&block, &elastic, true, 1);
    for (int l = 0; l < 8; l++) {
        double volume = 0, volume0 = 0;
        for (int q = 0; q < 4; q++) volume += block.volume[q][l], volume0 += block.volume0[q][l];
        for (int q = 0; q < 4; q++) {
            const double xx = 1 + block.h[q][0][l], xy = block.h[q][1][l], yx = block.h[q][2][l], yy = 1 + block.h[q][3][l];
            const double scale = sqrt(volume / volume0 / (block.volume[q][l] / block.volume0[q][l]));
            assert_true(fabs((xx * yy - xy * yx) / (volume / volume0) - 1) < 1e-14);
            assert_true(fabs(scale - 1) > 1e-6);
            assert_true(fabs(xx - scale * (1 + plain.h[q][0][l])) < 1e-14 && fabs(xy - scale * plain.h[q][1][l]) < 1e-14);
            assert_true(fabs(yy - scale * (1 + plain.h[q][3][l])) < 1e-14 && fabs(yx - scale * plain.h[q][2][l]) < 1e-14);
        }
    }
}

/* ---- objectivity and balance ------------------------------------------------------------------------------------------ */

static void test_rotation_makes_no_strain_and_turns_the_forces(void **state) {
    (void)state;
    for (int t = 0; t < TYPE_COUNT; t++)
        for (int f_bar = 0; f_bar <= (TYPES[t] == AB_ELEMENT_Q4); f_bar++) {
            const fem_element *element = fem_element_of(TYPES[t]);
            const fem_elastic elastic = elastic_of(1, 0.3, 1);
            const double angle = 140 * PI / 180;
            fem_block before, after;
            memset(&before, 0, sizeof before);
            draw(element, 1, 0.7, 0.1, before.start);
            memcpy(before.end, before.start, sizeof before.end);
            fill_stress(element, 1, &before);
            if (TYPES[t] == AB_ELEMENT_Q6) /* one stress everywhere: the modes have nothing to bring back */
                for (int q = 1; q < 4; q++) memcpy(before.stress[q], before.stress[0], sizeof before.stress[q]);
            after = before;
            turn(element->nodes, angle, (const double(*)[8])before.start, after.end);
            element->strain(&after, &elastic, f_bar, 1);
            double worst = 0, worst_volume = 0, worst_force = 0, turned[MOST_DOFS][8];
            for (int l = 0; l < 8; l++) {
                for (int q = 0; q < element->gauss; q++) {
                    double strain[3], spin;
                    middle_rule((const double(*)[8])after.h[q], l, strain, &spin);
                    for (int c = 0; c < 3; c++) worst = fmax(worst, fabs(strain[c]));
                    worst = fmax(worst, fabs(spin - angle));
                    worst_volume = fmax(worst_volume, fabs(after.volume[q][l] / after.volume0[q][l] - 1));
                }
                assert_true(fabs(after.control_work[l]) < 1e-13);
            }
            for (int q = 0; q < element->gauss; q++) turn_stress(angle, (const double(*)[8])before.stress[q], after.stress[q]);
            element->force(&before, f_bar);
            element->force(&after, f_bar);
            turn(element->nodes, angle, (const double(*)[8])before.force, turned);
            for (int i = 0; i < 2 * element->nodes; i++)
                for (int l = 0; l < 8; l++) worst_force = fmax(worst_force, fabs(turned[i][l] - after.force[i][l]));
            print_message("turned by 140 degrees %-4s%s: strain %.1e, volume %.1e, force %.1e\n", element->name,
                          f_bar ? " mean dilatation" : "", worst, worst_volume, worst_force);
            assert_true(worst < 1e-13 && worst_volume < 1e-13 && worst_force < 1e-13);
        }
}

static void test_internal_forces_have_no_resultant(void **state) {
    (void)state;
    for (int t = 0; t < TYPE_COUNT; t++)
        for (int f_bar = 0; f_bar <= (TYPES[t] == AB_ELEMENT_Q4); f_bar++) {
            const fem_element *element = fem_element_of(TYPES[t]);
            fem_block block;
            memset(&block, 0, sizeof block);
            draw(element, 1, 0.7, 0.12, block.end);
            fill_stress(element, 1, &block);
            element->force(&block, f_bar);
            for (int l = 0; l < 8; l++) {
                double sum[3] = {0}, size = 0;
                for (int a = 0; a < element->nodes; a++) {
                    const double fx = block.force[2 * a][l], fy = block.force[2 * a + 1][l];
                    sum[0] += fx, sum[1] += fy;
                    sum[2] += block.end[2 * a][l] * fy - block.end[2 * a + 1][l] * fx;
                    size += fabs(fx) + fabs(fy);
                }
                assert_true(size > 0.1);
                for (int c = 0; c < 3; c++) assert_true(fabs(sum[c]) < 1e-15 * size * 4);
            }
        }
}

/* A small step from a stressed state: the nodal forces do the work of the stresses and of the hourglass forces. */
static void test_forces_do_the_work_of_the_stresses(void **state) {
    (void)state;
    for (int t = 0; t < TYPE_COUNT; t++)
        for (int f_bar = 0; f_bar <= (TYPES[t] == AB_ELEMENT_Q4); f_bar++) {
            const fem_element *element = fem_element_of(TYPES[t]);
            const fem_elastic none = {1e-9, 1e-9, 1};
            const double small = 1e-7;
            fem_block block;
            memset(&block, 0, sizeof block);
            draw(element, 1, 0.7, 0.1, block.start);
            fill_stress(element, 1, &block);
            if (TYPES[t] == AB_ELEMENT_Q6)
                for (int q = 1; q < 4; q++) memcpy(block.stress[q], block.stress[0], sizeof block.stress[q]);
            for (int i = 0; i < 2 * element->nodes; i++)
                for (int l = 0; l < 8; l++) block.end[i][l] = block.start[i][l] + small * number();
            element->strain(&block, &none, f_bar, 1);
            element->force(&block, f_bar);
            for (int l = 0; l < 8; l++) {
                double inner = block.control_work[l], outer = 0, strain[3], spin;
                for (int q = 0; q < element->gauss; q++) {
                    middle_rule((const double(*)[8])block.h[q], l, strain, &spin);
                    inner += block.volume[q][l] *
                             (block.stress[q][0][l] * strain[0] + block.stress[q][1][l] * strain[1] + block.stress[q][3][l] * strain[2]);
                }
                for (int i = 0; i < 2 * element->nodes; i++) outer += block.force[i][l] * (block.end[i][l] - block.start[i][l]);
                assert_true(fabs(inner - outer) < 20 * small * small);
            }
        }
}

/* ---- masses ------------------------------------------------------------------------------------------------------------- */

static void test_masses_are_positive_and_add_up(void **state) {
    (void)state;
    for (int t = 0; t < TYPE_COUNT; t++) {
        const fem_element *element = fem_element_of(TYPES[t]);
        for (int shape = 0; shape < 4; shape++) {
            double x[MOST_DOFS][8], mass[FEM_NODES][8];
            draw(element, 3, 2, 0.05 * shape, x);
            element->mass((const double(*)[8])x, 7.5, mass);
            for (int l = 0; l < 8; l++) {
                double sum = 0,
                       area = 0; /* of the outline: a polygon, or parabolas through the middles (chord triangles and 2/3 of the bows) */
                for (int a = 0; a < 4; a++) {
                    const int b = (a + 1) % 4, m = 4 + a;
                    area += 0.5 * (x[2 * a][l] * x[2 * b + 1][l] - x[2 * b][l] * x[2 * a + 1][l]);
                    if (element->nodes == 8)
                        area -= 2.0 / 3 *
                                ((x[2 * b][l] - x[2 * a][l]) * (x[2 * m + 1][l] - x[2 * a + 1][l]) -
                                 (x[2 * b + 1][l] - x[2 * a + 1][l]) * (x[2 * m][l] - x[2 * a][l]));
                }
                for (int a = 0; a < element->nodes; a++) {
                    assert_true(mass[a][l] > 0);
                    sum += mass[a][l];
                }
                assert_true(fabs(sum / (7.5 * area) - 1) < 1e-14);
                if (shape == 0 && element->nodes == 8) { /* a rectangle: 3/76 and 16/76 (Hinton, Rock, Zienkiewicz 1976) */
                    assert_true(fabs(mass[0][l] / sum - 3.0 / 76) < 1e-15);
                    assert_true(fabs(mass[4][l] / sum - 16.0 / 76) < 1e-15);
                }
            }
        }
    }
}

/* ---- inverted elements --------------------------------------------------------------------------------------------------- */

static void test_inverted_elements_are_seen(void **state) {
    (void)state;
    for (int t = 0; t < TYPE_COUNT; t++) {
        const fem_element *element = fem_element_of(TYPES[t]);
        const fem_elastic elastic = elastic_of(1, 0.3, 1);
        fem_block block;
        memset(&block, 0, sizeof block);
        draw(element, 1, 1, 0, block.start);
        memcpy(block.end, block.start, sizeof block.end);
        for (int a = 0; a < element->nodes; a++) block.end[2 * a][1] *= -1; /* lane 1: mirrored */
        block.end[4][2] = block.end[5][2] = 0.45;                           /* lane 2: a corner pushed past the diagonal */
        block.end[3][3] = NAN;                                              /* lane 3 */
        for (int a = 0; a < element->nodes; a++) block.end[2 * a][4] = 0;   /* lane 4: without area */
        block.end[3][5] = INFINITY;
        for (int i = 0; i < 2 * element->nodes; i++) block.end[i][6] *= 1e-3, block.end[i][7] *= 1e3;
        element->strain(&block, &elastic, false, 1);
        for (int l = 1; l < 6; l++) assert_true(block.jacobian[l] <= 0);
        for (int l = 0; l < 8; l++)
            if (l == 0 || l > 5) assert_true(fabs(block.jacobian[l] - 1) < 1e-14);
        if (element->nodes == 8) { /* a middle node too near a corner: every Gauss point still well */
            memcpy(block.end, block.start, sizeof block.end);
            for (int l = 0; l < 8; l++) block.end[8][l] = l % 2 ? 0.2 : 0.3;
            element->strain(&block, &elastic, false, 1);
            for (int l = 0; l < 8; l++) {
                for (int q = 0; q < element->gauss; q++) assert_true(block.volume[q][l] > 0);
                assert_true(l % 2 ? block.jacobian[l] < 0 : block.jacobian[l] > 0);
            }
        }
    }
}

/* ---- cost ------------------------------------------------------------------------------------------------------------------- */

static double seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Prints what a call for eight elements takes; no bound, other work on the machine would break it. */
static void test_cost(void **state) {
    (void)state;
    for (int t = 0; t < TYPE_COUNT; t++)
        for (int f_bar = 0; f_bar <= (TYPES[t] == AB_ELEMENT_Q4); f_bar++) {
            const fem_element *element = fem_element_of(TYPES[t]);
            const fem_elastic elastic = elastic_of(1, 0.3, 1);
            static fem_block block;
            double best[3] = {1, 1, 1}, square[8];
            memset(&block, 0, sizeof block);
            draw(element, 1, 1, 0.05, block.start);
            memcpy(block.end, block.start, sizeof block.end);
            fill_stress(element, 1e-3, &block);
            for (int trial = 0; trial < 20; trial++) {
                const double begin = seconds();
                for (int k = 0; k < 500; k++) element->strain(&block, &elastic, f_bar, 1);
                const double middle = seconds();
                for (int k = 0; k < 500; k++) element->force(&block, f_bar);
                const double end = seconds();
                for (int k = 0; k < 5; k++) fem_element_frequency(element, (const double(*)[8])block.end, &elastic, f_bar, 1, square);
                best[0] = fmin(best[0], (middle - begin) / 500);
                best[1] = fmin(best[1], (end - middle) / 500);
                best[2] = fmin(best[2], (seconds() - end) / 5);
            }
            print_message("eight %-4s%s: strain %.0f ns, force %.0f ns, frequency %.1f us\n", element->name,
                          f_bar ? " mean dilatation" : "", 1e9 * best[0], 1e9 * best[1], 1e6 * best[2]);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_basis_sums_to_one_and_reproduces_linear_fields),
        cmocka_unit_test(test_gradients_and_volumes_are_those_of_the_basis),
        cmocka_unit_test(test_mean_dilatation_is_that_of_the_element),
        cmocka_unit_test(test_rotation_makes_no_strain_and_turns_the_forces),
        cmocka_unit_test(test_internal_forces_have_no_resultant),
        cmocka_unit_test(test_forces_do_the_work_of_the_stresses),
        cmocka_unit_test(test_masses_are_positive_and_add_up),
        cmocka_unit_test(test_inverted_elements_are_seen),
        cmocka_unit_test(test_cost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
