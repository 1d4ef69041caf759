/* element.c: the table of element types, their basis functions, Gauss points and masses. */
#include "fem/element_inner.h"

static const double CORNER[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
static const double MIDDLE[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};

void fem_shape(int nodes, double xi, double eta, double *n) {
    for (int a = 0; a < 4; a++) {
        const double s = xi * CORNER[a][0], t = eta * CORNER[a][1];
        n[a] = 0.25 * (1 + s) * (1 + t);
        if (nodes == 8) n[a] *= s + t - 1;
    }
    for (int a = 4; a < nodes; a++) {
        const double *m = MIDDLE[a - 4];
        n[a] = m[0] == 0 ? 0.5 * (1 - xi * xi) * (1 + eta * m[1]) : 0.5 * (1 - eta * eta) * (1 + xi * m[0]);
    }
}

void fem_shape_derivatives(int nodes, double xi, double eta, double (*dn)[2]) {
    for (int a = 0; a < 4; a++) {
        const double *k = CORNER[a], s = xi * k[0], t = eta * k[1];
        dn[a][0] = 0.25 * k[0] * (1 + t) * (nodes == 8 ? 2 * s + t : 1);
        dn[a][1] = 0.25 * k[1] * (1 + s) * (nodes == 8 ? 2 * t + s : 1);
    }
    for (int a = 4; a < nodes; a++) {
        const double *m = MIDDLE[a - 4];
        dn[a][0] = m[0] == 0 ? -xi * (1 + eta * m[1]) : 0.5 * m[0] * (1 - eta * eta);
        dn[a][1] = m[0] == 0 ? 0.5 * m[1] * (1 - xi * xi) : -eta * (1 + xi * m[0]);
    }
}

static void gauss(int side, int point, double place[2], double *weight) {
    static const double PLACE[3][3] = {{0}, {-FEM_GAUSS_2, FEM_GAUSS_2}, {-FEM_GAUSS_3, 0, FEM_GAUSS_3}};
    static const double WEIGHT[3][3] = {{2}, {1, 1}, {5.0 / 9, 8.0 / 9, 5.0 / 9}};
    const int column = point % side, row = point / side;
    place[0] = PLACE[side - 1][column];
    place[1] = PLACE[side - 1][row];
    *weight = WEIGHT[side - 1][column] * WEIGHT[side - 1][row];
}

void fem_gauss(const fem_element *element, int point, double place[2], double *weight) {
    gauss(element->gauss == 9 ? 3 : element->gauss == 4 ? 2 : 1, point, place, weight);
}

static lanes det_at(int nodes, const double (*x)[8], double xi, double eta, int first) {
    double dn[FEM_NODES][2];
    fem_shape_derivatives(nodes, xi, eta, dn);
    fem_jacobian j = {.xx = {0}};
    for (int a = 0; a < nodes; a++) {
        const lanes px = lanes_load(x[2 * a] + first), py = lanes_load(x[2 * a + 1] + first);
        j.xx += dn[a][0] * px;
        j.xy += dn[a][1] * px;
        j.yx += dn[a][0] * py;
        j.yy += dn[a][1] * py;
    }
    return fem_det(j);
}

/* Row sum of the consistent mass matrix: the integral of each basis function. */
static void row_sum_of(const double (*x)[8], double density, double (*mass)[8], int first) {
    lanes sum[4] = {{0}};
    for (int q = 0; q < 4; q++) {
        double place[2], weight, n[FEM_NODES];
        gauss(2, q, place, &weight);
        fem_shape(4, place[0], place[1], n);
        const lanes volume = density * det_at(4, x, place[0], place[1], first);
        for (int a = 0; a < 4; a++) sum[a] += n[a] * volume;
    }
    for (int a = 0; a < 4; a++) lanes_store(mass[a] + first, sum[a]);
}

/* The diagonal of the consistent mass matrix (3 x 3 points), scaled to the element's mass. Row sums of eight nodes would be negative at
 * the corners. */
static void diagonal_scaling_of(const double (*x)[8], double density, double (*mass)[8], int first) {
    lanes diagonal[8] = {{0}}, volume = {0}, sum = {0};
    for (int q = 0; q < 9; q++) {
        double place[2], weight, n[FEM_NODES];
        gauss(3, q, place, &weight);
        fem_shape(8, place[0], place[1], n);
        const lanes v = weight * det_at(8, x, place[0], place[1], first);
        volume += v;
        for (int a = 0; a < 8; a++) diagonal[a] += n[a] * n[a] * v;
    }
    for (int a = 0; a < 8; a++) sum += diagonal[a];
    const lanes scale = density * volume / sum;
    for (int a = 0; a < 8; a++) lanes_store(mass[a] + first, scale * diagonal[a]);
}

static void row_sum(const double (*x)[8], double density, double (*mass)[8]) {
    for (int first = 0; first < 8; first += LANES) row_sum_of(x, density, mass, first);
}
static void diagonal_scaling(const double (*x)[8], double density, double (*mass)[8]) {
    for (int first = 0; first < 8; first += LANES) diagonal_scaling_of(x, density, mass, first);
}

const fem_element *fem_element_of(ab_element_type type) {
    static const fem_element elements[] = {
        [AB_ELEMENT_Q4] = {"q4", 4, 4, 0, fem_q4_strain, fem_q4_force, row_sum},
        [AB_ELEMENT_Q4R] = {"q4r", 4, 1, 2, fem_q4r_strain, fem_q4r_force, row_sum},
        [AB_ELEMENT_Q6] = {"q6", 4, 4, 0, fem_q6_strain, fem_q6_force, row_sum},
        [AB_ELEMENT_Q8] = {"q8", 8, 9, 0, fem_q8_strain, fem_q8_force, diagonal_scaling},
        [AB_ELEMENT_Q8R] = {"q8r", 8, 4, 0, fem_q8r_strain, fem_q8r_force, diagonal_scaling},
    };
    return &elements[type];
}
