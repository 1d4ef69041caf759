/* test_axisymmetric_elements.c: elements as rings about an axis, of all types, in any shape: linear fields strain exactly (u_r = a r + b z: hoops by a + b z/r); uniform stress
 * does the work of its strain and has no force on a node inside; moving along the axis is free to rounding; the highest frequency is that of the stiffness found by differences. */
#include "element_samples.h"

/* Away from the axis by more than half of their width. */
static void draw_ring(const fem_element *element, double distortion, double (*x)[8]) {
    draw(element, 1, 0.7, distortion, x);
    for (int a = 0; a < element->nodes; a++)
        for (int l = 0; l < 8; l++) x[2 * a][l] += 0.2 + 0.3 * l;
}

static void move(const fem_element *element, const double (*x)[8], const double g[4], double lift, double (*y)[8]) {
    for (int a = 0; a < element->nodes; a++)
        for (int l = 0; l < 8; l++) {
            y[2 * a][l] = x[2 * a][l] + g[0] * x[2 * a][l] + g[1] * x[2 * a + 1][l];
            y[2 * a + 1][l] = x[2 * a + 1][l] + g[2] * x[2 * a][l] + g[3] * x[2 * a + 1][l] + lift;
        }
}

static void test_linear_fields_strain_exactly(void **state) {
    (void)state;
    const double gradient[4] = {0.03, 0, 0.02, -0.04};
    for (int t = 0; t < TYPE_COUNT; t++) {
        const fem_element *element = fem_element_axisymmetric_of(TYPES[t]);
        const fem_elastic elastic = elastic_of(1, 0.3, 1);
        fem_block block;
        double worst = 0;
        memset(&block, 0, sizeof block);
        draw_ring(element, 0.08, block.start);
        for (int free = 0; free < 2; free++) {
            const double g[4] = {free ? 0 : gradient[0], 0, free ? 0 : gradient[2], free ? 0 : gradient[3]};
            move(element, (const double(*)[8])block.start, g, 0.7, block.end);
            element->strain(&block, &elastic, false, 1);
            for (int l = 0; l < 8; l++)
                for (int q = 0; q < element->gauss; q++) {
                    for (int c = 0; c < 4; c++) worst = fmax(worst, fabs(block.h[q][c][l] - g[c]));
                    worst = fmax(worst, fabs(block.hoop[q][l] - g[0]));
                }
            for (int k = 0; k < element->extra; k++)
                for (int l = 0; l < 8; l++) worst = fmax(worst, fabs(block.extra[k][l]));
        }
        print_message("%-4s ring: linear fields, and a move along the axis, within %.1e\n", element->name, worst);
        assert_true(worst < 1e-13);
    }
}

/* s_rr = s_tt, s_zz, s_rz = 0 everywhere is in equilibrium about the axis; four elements about a node, drawn at random. */
static void test_uniform_stress_has_no_force_inside(void **state) {
    (void)state;
    static const int CORNER[4] = {2, 3, 0, 1}; /* of the element below left, below right, above right, above left: the node in the middle */
    for (int t = 0; t < TYPE_COUNT; t++) {
        const fem_element *element = fem_element_axisymmetric_of(TYPES[t]);
        if (element->nodes == 8) continue; /* middles would have to be shared, too; the tube shows them */
        fem_block block;
        double at[9][2], force[2] = {0, 0};
        memset(&block, 0, sizeof block);
        for (int n = 0; n < 9; n++) at[n][0] = 0.2 + n % 3 * 0.5 + 0.1 * number(), at[n][1] = n / 3 * 0.4 + 0.1 * number();
        for (int e = 0; e < 4; e++) {
            const int i = e == 1 || e == 2, j = e > 1, node[4] = {3 * j + i, 3 * j + i + 1, 3 * j + i + 4, 3 * j + i + 3};
            for (int a = 0; a < 4; a++)
                for (int c = 0; c < 2; c++)
                    for (int l = e; l < 8; l += 4) block.end[2 * a + c][l] = block.start[2 * a + c][l] = at[node[a]][c];
        }
        for (int q = 0; q < element->gauss; q++)
            for (int l = 0; l < 8; l++) block.stress[q][0][l] = block.stress[q][2][l] = 1.3, block.stress[q][1][l] = -0.4;
        element->force(&block, false);
        for (int e = 0; e < 4; e++)
            for (int c = 0; c < 2; c++) force[c] += block.force[2 * CORNER[e] + c][e];
        print_message("%-4s ring: uniform stress, force inside %.1e %.1e\n", element->name, force[0], force[1]);
        assert_true(hypot(force[0], force[1]) < 1e-13);
    }
}

/* Force of a small displacement from rest, of an elastic material. */
static void force_of(const fem_element *element, const fem_elastic *elastic, const double (*x)[8], const double *u, double (*force)[8]) {
    fem_block block;
    memset(&block, 0, sizeof block);
    memcpy(block.start, x, sizeof block.start);
    memcpy(block.end, x, sizeof block.end);
    for (int i = 0; i < 2 * element->nodes; i++)
        for (int l = 0; l < 8; l++) block.end[i][l] += u[i];
    element->strain(&block, elastic, false, 1);
    for (int q = 0; q < element->gauss; q++)
        for (int l = 0; l < 8; l++) {
            const double xx = block.h[q][0][l], yy = block.h[q][3][l], zz = block.hoop[q][l], p = elastic->lambda * (xx + yy + zz);
            block.stress[q][0][l] = p + 2 * elastic->mu * xx;
            block.stress[q][1][l] = p + 2 * elastic->mu * yy;
            block.stress[q][2][l] = p + 2 * elastic->mu * zz;
            block.stress[q][3][l] = elastic->mu * (block.h[q][1][l] + block.h[q][2][l]);
        }
    memcpy(block.end, block.start, sizeof block.end);
    element->force(&block, false);
    memcpy(force, block.force, sizeof block.force);
}

static void test_frequency_is_that_of_the_stiffness(void **state) {
    (void)state;
    static const double nu[3] = {0, 0.3, 0.4999};
    for (int t = 0; t < TYPE_COUNT; t++) {
        const fem_element *element = fem_element_axisymmetric_of(TYPES[t]);
        const int n = 2 * element->nodes;
        double lowest = 0, highest = 0, uneven = 0;
        for (int k = 0; k < 3; k++) {
            const fem_elastic elastic = elastic_of(1, nu[k], 1);
            double x[2 * FEM_NODES][8], mass[FEM_NODES][8], square[8], stiff[2 * FEM_NODES][2 * FEM_NODES][8];
            memset(x, 0, sizeof x);
            draw_ring(element, k ? 0.08 : 0, x);
            element->mass((const double(*)[8])x, 1, mass);
            fem_element_frequency(element, (const double(*)[8])x, &elastic, false, 1, square);
            for (int i = 0; i < n; i++) {
                double u[2 * FEM_NODES] = {0}, force[2 * FEM_NODES][8];
                u[i] = 1e-7;
                force_of(element, &elastic, (const double(*)[8])x, u, force);
                for (int j = 0; j < n; j++)
                    for (int l = 0; l < 8; l++) stiff[i][j][l] = force[j][l] / 1e-7;
            }
            for (int l = 0; l < 8; l++) {
                double v[2 * FEM_NODES], w[2 * FEM_NODES], value = 0, largest = 0, odd = 0;
                for (int i = 0; i < n; i++)
                    for (int j = 0; j < n; j++)
                        largest = fmax(largest, fabs(stiff[i][j][l])), odd = fmax(odd, fabs(stiff[i][j][l] - stiff[j][i][l]));
                uneven = fmax(uneven, odd / largest);
                for (int i = 0; i < n; i++) v[i] = number();
                for (int round = 0; round < 2000; round++) { /* v = M^-1/2 K M^-1/2 v */
                    double size = 0;
                    for (int i = 0; i < n; i++) {
                        w[i] = 0;
                        for (int j = 0; j < n; j++)
                            w[i] += 0.5 * (stiff[i][j][l] + stiff[j][i][l]) * v[j] / sqrt(mass[i / 2][l] * mass[j / 2][l]);
                        size += w[i] * w[i];
                    }
                    value = sqrt(size);
                    for (int i = 0; i < n; i++) v[i] = w[i] / value;
                }
                lowest = fmin(lowest, square[l] / value - 1);
                highest = fmax(highest, square[l] / value - 1);
            }
        }
        print_message("%-4s ring: highest frequency squared between %+.1e and %+.1e of the eigenvalue; stiffness uneven by %.1e\n",
                      element->name, lowest, highest, uneven);
        assert_true(lowest > -2e-3 && highest < 2e-3 && uneven < 1e-5);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear_fields_strain_exactly),
        cmocka_unit_test(test_uniform_stress_has_no_force_inside),
        cmocka_unit_test(test_frequency_is_that_of_the_stiffness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
