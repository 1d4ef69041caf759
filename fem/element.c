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

#define RINGS 0
#include "fem/element_mass.inc"

void fem_gauss(const fem_element *element, int point, double place[2], double *weight) {
    gauss(element->gauss == 9 ? 3 : element->gauss == 4 ? 2 : 1, point, place, weight);
}

const fem_element *fem_element_of(ab_element_type type) {
    static const fem_element elements[] = {
        [AB_ELEMENT_Q4] = {"q4", 4, 4, 0, false, fem_q4_strain, fem_q4_force, row_sum},
        [AB_ELEMENT_Q4R] = {"q4r", 4, 1, 2, false, fem_q4r_strain, fem_q4r_force, row_sum},
        [AB_ELEMENT_Q6] = {"q6", 4, 4, 0, false, fem_q6_strain, fem_q6_force, row_sum},
        [AB_ELEMENT_Q8] = {"q8", 8, 9, 0, false, fem_q8_strain, fem_q8_force, diagonal_scaling},
        [AB_ELEMENT_Q8R] = {"q8r", 8, 4, 0, false, fem_q8r_strain, fem_q8r_force, diagonal_scaling},
    };
    return &elements[type];
}
