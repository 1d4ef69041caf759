/* test_fem_layer.c: a finite-element body is seen on the grid by a layer of elements along its outer faces: every node that another body can share sees what it would
 * of all elements, and a layer that has become too thin is made anew, deeper. */
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

static const double SHARED = 1.5, WIDE = 24, HIGH = 20; /* cells of 1 m */

typedef struct one {
    ab_report *report;
    ab_registry *registry;
    ab_scene *scene;
    ab_domain *domain;
    ab_step step;
} one;

static one create(const char *type, int columns, int rows) {
    char text[2000];
    one o = {.report = ab_report_create(), .step = {.dt = 1e-3}};
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1, dt: 0.001}\ngrid: {from: [-8, -8], to: [40, 40], cell: 1}\n"
             "materials: {m: {model: linear-elastic, E: 1000, nu: 0.3, density: 2}}\n"
             "bodies:\n"
             "  b: {method: finite-elements, material: m, mesh: {box: [[0, 0], [24, 20]], elements: [%d, %d], type: %s}}\n"
             "  p: {method: material-points, material: m, shape: {box: [[0, 20], [4, 22]]}}\n"
             "contact: [{bodies: [b, p], algorithm: multi-velocity, response: frictionless}]\n",
             columns, rows, type);
    assert_int_equal(whole_scene_read(text, &o.registry, &o.scene, o.report), AB_OK);
    assert_int_equal(fem_create(o.scene, 0, 1, &o.domain, o.report), AB_OK);
    return o;
}

static void destroy(one *o) {
    o->domain->ops->destroy(o->domain);
    ab_scene_destroy(o->scene);
    ab_registry_destroy(o->registry);
    ab_report_destroy(o->report);
}

static void begin(one *o) {
    assert_int_equal(o->domain->ops->begin(o->domain, &o->step, o->report), AB_OK);
    o->step.number++;
}

static size_t inner_points(const one *o) { return ((const fem_body *)o->domain)->inner.count; }

/* Cells from a node of the grid inside the body to its outline; places from the grid's corner, 8 m below and beside the body. */
static double depth(int i, int j) { return fmin(fmin(i - 8, 8 + WIDE - i), fmin(j - 8, 8 + HIGH - j)); }

typedef struct seen { /* at the nodes between two depths: node (i, j) at j*64 + i */
    double mass[64 * 64], area[64 * 64][2], weights[64 * 64];
} seen;

static size_t look(one *o, double from, double to, seen *s) {
    memset(s, 0, sizeof *s);
    ab_node_tiles tiles;
    o->domain->ops->node_tiles(o->domain, &tiles);
    uint32_t *nodes = calloc(tiles.count * AB_TILE_NODES + 1, sizeof *nodes), *at = calloc(tiles.count * AB_TILE_NODES + 1, sizeof *at);
    size_t count = 0;
    for (size_t k = 0; k < tiles.count; k++)
        for (int n = 0; n < AB_TILE_NODES; n++) {
            const int i = ab_tile_x(tiles.key[k]) * AB_TILE + n % AB_TILE, j = ab_tile_y(tiles.key[k]) * AB_TILE + n / AB_TILE;
            const double mass = tiles.mass[(k * AB_TILE_NODES + (size_t)n) * tiles.stride], d = depth(i, j);
            if (!(mass > 0 && d >= from && d <= to)) continue;
            at[count] = (uint32_t)(j * 64 + i);
            s->mass[at[count]] = mass;
            nodes[count++] = (uint32_t)(k * AB_TILE_NODES + (size_t)n);
        }
    ab_trace trace;
    assert_int_equal(o->domain->ops->trace(o->domain, nodes, count, AB_NEED_AREA_VECTOR | AB_NEED_NEAR_POINTS, &trace, o->report), AB_OK);
    for (size_t k = 0; k < count; k++) {
        for (size_t c = 0; c < 2; c++) s->area[at[k]][c] = trace.area_vector[c * trace.ld + k];
        for (size_t e = trace.stencil_start[k]; e < trace.stencil_start[k + 1]; e++) s->weights[at[k]] += trace.stencil_weight[e];
    }
    free(nodes), free(at);
    return count;
}

static void test_shared_nodes_see_what_they_would_of_all_elements(void **state) {
    (void)state;
    static const int ELEMENTS[5][2] = {{96, 80}, {48, 40}, {24, 20}, {17, 13}, {4, 3}};
    static seen all, layer;
    for (int t = 0; t < 2; t++)
        for (int k = 0; k < 5; k++) {
            one o = create(t ? "q8" : "q4", ELEMENTS[k][0], ELEMENTS[k][1]);
            begin(&o);
            const size_t points = inner_points(&o), count = look(&o, -2, SHARED, &all);
            begin(&o);
            assert_int_equal(look(&o, -2, SHARED, &layer), count);
            print_message("%s, %d x %d: %zu points of %zu, %zu nodes\n", t ? "q8" : "q4", ELEMENTS[k][0], ELEMENTS[k][1], inner_points(&o),
                          points, count);
            assert_true(k < 2 ? inner_points(&o) < 0.7 * (double)points : k < 4 || inner_points(&o) == points);
            for (size_t n = 0; n < 64 * 64; n++) {
                assert_true(layer.mass[n] == all.mass[n]);
                for (int c = 0; c < 2; c++) assert_true(layer.area[n][c] == all.area[n][c]);
                assert_true(layer.mass[n] == 0 || fabs(layer.weights[n] - 1) < 1e-14);
            }
            const size_t settled = inner_points(&o);
            begin(&o);
            assert_int_equal(inner_points(&o), settled);
            destroy(&o);
        }
}

/* A node in contact that sees the inmost elements: the next step has a deeper layer. In the first step, when bodies are drawn in each other: all elements. */
static void test_a_thin_layer_is_made_deeper(void **state) {
    (void)state;
    static seen s;
    for (int first = 0; first < 2; first++) {
        one o = create("q4", 48, 40);
        begin(&o);
        const size_t all = inner_points(&o);
        if (first)
            look(&o, 6, 8, &s);
        else
            begin(&o);
        const size_t before = inner_points(&o);
        if (!first) assert_true(look(&o, 4, 20, &s) > 0);
        begin(&o);
        assert_true(first ? inner_points(&o) == all : inner_points(&o) > before);
        destroy(&o);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shared_nodes_see_what_they_would_of_all_elements),
        cmocka_unit_test(test_a_thin_layer_is_made_deeper),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
