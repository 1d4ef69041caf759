/* test_fem_edges.c: the edges of finite elements under boundary plugins: all around a body their area vectors have neither sum nor moment, however it is bent; they add
 * up to its surface; corners have an edge for each side and bends have one; densities follow the elements; nodes on the axis of rings have nothing to show. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fem/body.h"
#include "fem/domain.h"
#include "whole_scene.h"

static const double ROUNDING = 1e-13, QUARTER = 0.7853981633974483; /* pi/4 */

typedef struct one {
    ab_report *report;
    ab_registry *registry;
    ab_scene *scene;
    ab_domain *domain;
    fem_body *body;
    ab_edge_list list;
} one;

static one create(const char *space, const char *mesh, const char *where) {
    char text[2000];
    one o = {.report = ab_report_create()};
    snprintf(text, sizeof text,
             "abut: 1\nspace: %s\ntime: {end: 1, dt: 0.001}\n"
             "materials: {m: {model: linear-elastic, E: 1000, nu: 0.25, density: 2}}\n"
             "bodies:\n  b: {method: finite-elements, material: m, mesh: {%s}}\n"
             "boundaries: [{on: b, where: {%s}, boundary: viscous}]\n",
             space, mesh, where);
    const ab_status read = whole_scene_read(text, &o.registry, &o.scene, o.report);
    for (size_t i = 0; ab_report_text(o.report, i); i++) print_error("%s\n", ab_report_text(o.report, i));
    assert_int_equal(read, AB_OK);
    assert_int_equal(fem_create(o.scene, 0, 1, &o.domain, o.report), AB_OK);
    o.body = (fem_body *)o.domain;
    return o;
}

static void destroy(one *o) {
    o->domain->ops->destroy(o->domain);
    ab_scene_destroy(o->scene);
    ab_registry_destroy(o->registry);
    ab_report_destroy(o->report);
}

static void look(one *o) {
    const ab_step step = {.dt = 1e-3};
    assert_int_equal(o->domain->ops->edges(o->domain, 0, &step, &o->list, o->report), AB_OK);
}

static void normals_are_units(const one *o) {
    const ab_edge_list *l = &o->list;
    assert_int_equal(l->ld, (l->count + 7) / 8 * 8); /* the host hands these rows on beside its own */
    for (size_t e = 0; e < l->count; ++e) {
        assert_float_equal(hypot(l->normal[e], l->normal[l->ld + e]), 1.0, ROUNDING);
        for (size_t c = 0; c < 2; ++c) assert_float_equal(l->position[c * l->ld + e], o->body->x[2 * (size_t)l->dof[e] + c], 0.0);
        assert_int_equal(l->start[e + 1] - l->start[e], 1);
        assert_float_equal(l->weight[e], 1.0, 0.0);
    }
}

/* A pressure all around neither pushes nor turns. */
static void closed(const one *o) {
    const ab_edge_list *l = &o->list;
    double sum[2] = {0, 0}, moment = 0;
    for (size_t e = 0; e < l->count; ++e) {
        const double f[2] = {l->area[e] * l->normal[e], l->area[e] * l->normal[l->ld + e]};
        sum[0] += f[0], sum[1] += f[1];
        moment += l->position[e] * f[1] - l->position[l->ld + e] * f[0];
    }
    assert_float_equal(sum[0], 0.0, ROUNDING);
    assert_float_equal(sum[1], 0.0, ROUNDING);
    assert_float_equal(moment, 0.0, ROUNDING);
}

static double area_of(const one *o) {
    double sum = 0;
    for (size_t e = 0; e < o->list.count; ++e) sum += o->list.area[e];
    return sum;
}

static void bend(one *o) { /* any map that is not affine */
    for (size_t i = 0; i < o->body->nodes; ++i) {
        double *x = o->body->x + 2 * i;
        const double u = 0.2 * x[1] * x[1] + 0.05 * x[0], v = 0.1 * sin(2.0 * x[0]) - 0.05 * x[0] * x[1];
        x[0] += u, x[1] += v;
    }
}

static void test_a_closed_surface_has_no_sum_and_no_moment(void **state) {
    (void)state;
    static const char *const types[] = {"q4", "q6", "q4r", "q8", "q8r"};
    for (size_t t = 0; t < sizeof types / sizeof *types; ++t) {
        char mesh[200];
        snprintf(mesh, sizeof mesh, "box: [[0, 0], [2, 1]], elements: [4, 3], type: %s", types[t]);
        one o = create("plane-strain", mesh, "all: true");
        look(&o);
        normals_are_units(&o);
        closed(&o);
        assert_float_equal(area_of(&o), 6.0, ROUNDING);
        assert_int_equal(o.list.count, (t < 3 ? 14 : 28) + 4); /* a node each, and a second edge at the four corners */
        bend(&o);
        look(&o);
        normals_are_units(&o);
        closed(&o);
        assert_true(fabs(area_of(&o) - 6.0) > 0.1);
        destroy(&o);
    }
}

static void test_an_arc_has_one_edge_a_node(void **state) {
    (void)state;
    one o = create("plane-strain",
                   "patch: {bottom: [[1, 0], [2, 0]], right: {arc: {from: [2, 0], to: [0, 2], center: [0, 0]}}, top: [[0, 1], [0, 2]], "
                   "left: {arc: {from: [1, 0], to: [0, 1], center: [0, 0]}}}, elements: [2, 8], type: q8",
                   "x: [0, 1], y: [0, 1]");
    look(&o);
    normals_are_units(&o);
    assert_int_equal(o.list.count, 17);
    assert_float_equal(area_of(&o), 2 * QUARTER, 2e-3); /* the edges at nodes where it turns are chords of their faces */
    for (size_t e = 0; e < o.list.count; ++e) {         /* into the hole */
        const double r = hypot(o.list.position[e], o.list.position[o.list.ld + e]);
        assert_true(o.list.normal[e] * o.list.position[e] + o.list.normal[o.list.ld + e] * o.list.position[o.list.ld + e] < -0.99 * r);
    }
    destroy(&o);
}

static void test_density_and_wave_speeds(void **state) {
    (void)state;
    one o = create("plane-strain", "box: [[0, 0], [2, 1]], elements: [4, 2], type: q4", "side: right");
    look(&o);
    assert_int_equal(o.list.count, 3);
    for (size_t i = 0; i < o.body->nodes; ++i) o.body->x[2 * i] *= 0.8;
    look(&o);
    for (size_t e = 0; e < 3; ++e) {
        assert_float_equal(o.list.density[e], 2.0 / 0.8, 1e-12);
        assert_float_equal(o.list.p_wave_speed[e], sqrt(1200.0 / 2.5), 1e-5 * 24); /* lambda = mu = 400 Pa */
        assert_float_equal(o.list.s_wave_speed[e], sqrt(400.0 / 2.5), 1e-5 * 14);
    }
    destroy(&o);
}

static void test_rings(void **state) {
    (void)state;
    one o = create("axisymmetric", "box: [[0, 0], [3, 1]], elements: [6, 2], type: q8", "side: top");
    look(&o);
    assert_float_equal(area_of(&o), 4 * QUARTER * 9.0, 1e-12 * 30);
    for (size_t e = 0; e < o.list.count; ++e) assert_true(o.list.area[e] >= -1e-15 && isfinite(o.list.normal[e]));
    destroy(&o);
    o = create("axisymmetric", "box: [[1, 0], [3, 2]], elements: [4, 4], type: q4", "side: left");
    look(&o);
    normals_are_units(&o);
    assert_float_equal(area_of(&o), 8 * QUARTER * 2.0, 1e-12 * 13);
    destroy(&o);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_closed_surface_has_no_sum_and_no_moment),
        cmocka_unit_test(test_an_arc_has_one_edge_a_node),
        cmocka_unit_test(test_density_and_wave_speeds),
        cmocka_unit_test(test_rings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
