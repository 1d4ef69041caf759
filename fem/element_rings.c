/* element_rings.c: the table of axisymmetric elements and their masses. */
#include "fem/element_inner.h"

#define RINGS 1
#include "fem/element_mass.inc"

const fem_element *fem_element_axisymmetric_of(ab_element_type type) {
    static const fem_element elements[] = {
        [AB_ELEMENT_Q4] = {"q4", 4, 4, 0, true, fem_q4_strain_rings, fem_q4_force_rings, row_sum},
        [AB_ELEMENT_Q4R] = {"q4r", 4, 1, 2, true, fem_q4r_strain_rings, fem_q4r_force_rings, row_sum},
        [AB_ELEMENT_Q6] = {"q6", 4, 4, 0, true, fem_q6_strain_rings, fem_q6_force_rings, row_sum},
        [AB_ELEMENT_Q8] = {"q8", 8, 9, 0, true, fem_q8_strain_rings, fem_q8_force_rings, diagonal_scaling},
        [AB_ELEMENT_Q8R] = {"q8r", 8, 4, 0, true, fem_q8r_strain_rings, fem_q8r_force_rings, diagonal_scaling},
    };
    return &elements[type];
}
