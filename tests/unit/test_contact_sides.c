/* test_contact_sides.c: the mass that an impulse at a contact point meets: exact for any share of nodes, and none where all that moves there is held, rounding or not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "contact/contact.h"

/* One contact point between a face from node 0 to node 1 of a, at `share` of the way, and node 0 of b. */
typedef struct place {
    double inverse_mass_a[4], inverse_mass_b[2], weight_a[2], weight_b[1];
    uint32_t dof[2];
    size_t start_a[2], start_b[2];
    contact_side side[2];
} place;

static contact_side *at(place *p, double share, const double a0[2], const double a1[2], const double b0[2]) {
    *p = (place){.inverse_mass_a = {a0[0], a0[1], a1[0], a1[1]},
                 .inverse_mass_b = {b0[0], b0[1]},
                 .weight_a = {1.0 - share, share},
                 .weight_b = {1.0},
                 .dof = {0, 1},
                 .start_a = {0, 2},
                 .start_b = {0, 1}};
    p->side[0] = (contact_side){.dofs = {.inverse_mass = p->inverse_mass_a, .mass_stride = 2},
                                .start = p->start_a,
                                .dof = p->dof,
                                .weight = p->weight_a,
                                .sign = 1.0};
    p->side[1] = (contact_side){.dofs = {.inverse_mass = p->inverse_mass_b, .mass_stride = 2},
                                .start = p->start_b,
                                .dof = p->dof,
                                .weight = p->weight_b,
                                .sign = -1.0};
    return p->side;
}

static const double X[2] = {1.0, 0.0}, Y[2] = {0.0, 1.0}, FREE[2] = {2.0, 2.0}, ROLLER[2] = {2.0, 0.0}, FIXED[2] = {0.0, 0.0};

static void test_a_share_of_each_node(void **state) {
    (void)state;
    place p;
    bool held = false;
    for (double share = 0.0; share <= 1.0; share += 0.125) {
        const contact_side *side = at(&p, share, FREE, FREE, FREE);
        const double exact = 2.0 * ((1.0 - share) * (1.0 - share) + share * share) + 2.0;
        assert_true(fabs(contact_inverse_mass(side, 0, X, &held) - exact) < 1e-14 &&
                    fabs(contact_inverse_mass(side, 0, Y, &held) - exact) < 1e-14);
        assert_false(held);
        side = at(&p, share, ROLLER, FREE, ROLLER);
        assert_true(fabs(contact_inverse_mass(side, 0, Y, &held) - 2.0 * share * share) < 1e-14);
        assert_true(held);
        held = false;
    }
    /* a node with next to no mass hides nobody else's */
    const contact_side *side = at(&p, 1e-8, FREE, (const double[2]){1e20, 1e20}, FREE);
    assert_true(fabs(contact_inverse_mass(side, 0, X, &held) - (1e4 + 4.0)) < 1e-6);
}

/* Corners of two bodies on a roller, face to face: the foot of one on the other's face is the corner but for rounding. */
static void test_what_is_held_has_no_mass(void **state) {
    (void)state;
    place p;
    bool held = false;
    for (double rounding = 0.0; rounding<1e-8; rounding = rounding> 0.0 ? 10.0 * rounding : 1e-22) {
        const contact_side *side = at(&p, rounding, ROLLER, FREE, ROLLER);
        assert_true(contact_inverse_mass(side, 0, Y, &held) == 0.0);
        assert_true(fabs(contact_inverse_mass(side, 0, X, &held) - 4.0) < 1e-7);
        side = at(&p, rounding, FIXED, FREE, FIXED);
        assert_true(contact_inverse_mass(side, 0, X, &held) == 0.0 && contact_inverse_mass(side, 0, Y, &held) == 0.0);
        const double nearly[2] = {1.0, 1e-17 + rounding};
        side = at(&p, 0.0, (const double[2]){0.0, 2.0}, FREE, FIXED);
        assert_true(contact_inverse_mass(side, 0, nearly, &held) == 0.0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_a_share_of_each_node), cmocka_unit_test(test_what_is_held_has_no_mass)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
