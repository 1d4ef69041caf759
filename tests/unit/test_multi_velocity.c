/* test_multi_velocity.c: what the finder on shared nodes says of a node between two bodies made by hand: gap, normal, and how far it is from the material of the
 * stiffer one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/plugin_host.h"

enum { NODES = 4, POINTS = 12, MOST = 8 };
static const double CELL = 0.5, HALF = 0.125;

/* A body above (b) or below (a) a face that is turned by `angle`: rows of square points along it, seen by nodes at heights h over the face. */
typedef struct side {
    double position[2 * NODES], mass[NODES], mass_gradient[2 * NODES], area_vector[2 * NODES], weight[NODES],
        near_position[2 * POINTS * NODES], near_extent[3 * POINTS * NODES];
    size_t stencil_start[NODES + 1], near_start[NODES + 1];
    uint32_t dof[NODES];
    uint64_t key[NODES];
    ab_trace trace;
} side;

static void lay(side *s, double angle, double from_face, double sign, const double height[NODES], double stiffness) {
    const double t[2] = {cos(angle), sin(angle)}, n[2] = {-sin(angle), cos(angle)};
    for (size_t i = 0; i < NODES; i++) {
        for (size_t c = 0; c < 2; c++) {
            s->position[c * NODES + i] = 3 + height[i] * n[c];
            s->area_vector[c * NODES + i] = s->mass_gradient[c * NODES + i] = -sign * n[c] * CELL; /* out of the body */
        }
        s->mass[i] = 1;
        s->weight[i] = 1;
        s->dof[i] = (uint32_t)i;
        s->key[i] = i + 1;
        s->stencil_start[i] = i;
        s->near_start[i] = i * POINTS;
        for (size_t k = 0; k < POINTS; k++) { /* two rows of six, no point straight under the node */
            const double along = (2.0 * (double)(k % 6) - 5) * HALF, across = sign * (from_face + (2.0 * (double)(k / 6) + 1) * HALF);
            for (size_t c = 0; c < 2; c++) s->near_position[c * POINTS * NODES + i * POINTS + k] = 3 + along * t[c] + across * n[c];
            s->near_extent[i * POINTS + k] = s->near_extent[POINTS * NODES + i * POINTS + k] = HALF * HALF;
        }
    }
    s->stencil_start[NODES] = NODES;
    s->near_start[NODES] = NODES * POINTS;
    s->trace = (ab_trace){.struct_size = sizeof s->trace,
                          .dimension = 2,
                          .body = "body",
                          .stiffness = stiffness,
                          .cell = CELL,
                          .count = NODES,
                          .ld = NODES,
                          .position = s->position,
                          .stencil_start = s->stencil_start,
                          .stencil_dof = s->dof,
                          .stencil_weight = s->weight,
                          .key = s->key,
                          .mass = s->mass,
                          .mass_gradient = s->mass_gradient,
                          .area_vector = s->area_vector,
                          .near_start = s->near_start,
                          .near_ld = POINTS * NODES,
                          .near_position = s->near_position,
                          .near_extent = s->near_extent};
}

static void test_distance_is_that_to_the_face_of_the_stiffer_body(void **state) {
    (void)state;
    char built_in[4096];
    const char *build = getenv("ABUT_BUILD");
    snprintf(built_in, sizeof built_in, "%s/plugins", build ? build : "../..");
    ab_report *report = ab_report_create();
    ab_registry *registry;
    assert_int_equal(ab_registry_create(built_in, &registry, report), AB_OK);
    const ab_loaded_class *loaded = ab_registry_find(registry, AB_CONTACT, "multi-velocity", AB_NOWHERE, report);
    assert_non_null(loaded);
    ab_service service;
    ab_service_init(&service, "test");
    ab_value values[8] = {{0}};
    for (uint32_t k = 0; k < loaded->class_.nparam; k++)
        values[k].real = loaded->class_.param[k].initial, values[k].integer = (int64_t)values[k].real;
    void *self = NULL;
    assert_int_equal(loaded->class_.create(&service.host, values, &self), 0);

    const double height[NODES] = {0.0, 0.05, 0.2, -0.3}, gap = 0.02;
    for (int turn = 0; turn < 8; turn++)
        for (int stiffer = 0; stiffer < 2; stiffer++) { /* a lies below its face at 0, b above one at `gap` */
            const double angle = 0.8 * turn;
            side a, b;
            lay(&a, angle, 0.0, -1.0, height, stiffer ? 1e6 : 2e6);
            lay(&b, angle, gap, 1.0, height, stiffer ? 2e6 : 1e6);
            uint64_t key[MOST];
            size_t a_start[MOST + 1], b_start[MOST + 1];
            uint32_t a_dof[MOST], b_dof[MOST];
            double a_weight[MOST], b_weight[MOST], position[2 * MOST], normal[2 * MOST], gaps[MOST], area[MOST], distance[MOST];
            ab_points out = {.struct_size = sizeof out,
                             .dimension = 2,
                             .dt = 1,
                             .cell = CELL,
                             .capacity = MOST,
                             .ld = MOST,
                             .key = key,
                             .a_start = a_start,
                             .b_start = b_start,
                             .a_dof = a_dof,
                             .b_dof = b_dof,
                             .a_weight = a_weight,
                             .b_weight = b_weight,
                             .position = position,
                             .normal = normal,
                             .gap = gaps,
                             .area = area,
                             .distance = distance};
            assert_int_equal(loaded->contact.find(self, &a.trace, &b.trace, &out), 0);
            assert_int_equal(out.count, NODES);
            for (size_t i = 0; i < NODES; i++) {
                assert_true(fabs(normal[i] + sin(angle)) < 1e-9 && fabs(normal[MOST + i] - cos(angle)) < 1e-9);
                assert_true(fabs(gaps[i] - gap) < 1e-9);
                const double expected = stiffer ? fmax(0.0, gap - height[i]) : fmax(0.0, height[i]);
                if (!(fabs(distance[i] - expected) < 1e-9))
                    fail_msg("turned by %g, node at %g: %g, expected %g", angle, height[i], distance[i], expected);
            }
            out.distance = NULL; /* nobody asks */
            assert_int_equal(loaded->contact.find(self, &a.trace, &b.trace, &out), 0);
        }
    loaded->class_.destroy(self);
    ab_registry_destroy(registry);
    ab_report_destroy(report);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_distance_is_that_to_the_face_of_the_stiffer_body)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
