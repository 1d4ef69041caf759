/* test_fem_body.c: what a finite-element body shows of itself: its surface, the points inside it, its dofs, its fields, and its messages. */
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

static const char *const TYPES[] = {"q4", "q4r", "q6", "q8", "q8r"};
enum { TYPE_COUNT = 5 };

typedef struct one {
    ab_report *report;
    ab_registry *registry;
    ab_scene *scene;
    fem_body *body;
    ab_domain *domain;
    ab_step step;
} one;

/* A skew patch of 6 x 4 elements beside a block of points, with a contact on shared nodes. */
static ab_status attempt(one *o, const char *type, const char *material, const char *more, const char *sections) {
    char text[4000];
    snprintf(text, sizeof text,
             "abut: 1\nspace: plane-strain\ntime: {end: 1e4, dt: 0.001}\ngrid: {from: [-3, -2], to: [9, 8], cell: 0.4}\n"
             "materials: {m: {%s, density: 2}}\n"
             "bodies:\n"
             "  b: {method: finite-elements, material: m, mesh: {patch: {bottom: [[0, 0], [3, 0.5]], right: [[3, 0.5], [2.5, 2.5]], top: "
             "[[0.5, 2], [2.5, 2.5]], "
             "left: [[0, 0], [0.5, 2]]}, elements: [6, 4], type: %s}%s}\n"
             "  p: {method: material-points, material: m, shape: {box: [[5, 0], [6, 1]]}}\n"
             "contact: [{bodies: [b, p], algorithm: multi-velocity, response: frictionless}]\n%s",
             material, type, more, sections);
    o->report = ab_report_create();
    ab_status status = whole_scene_read(text, &o->registry, &o->scene, o->report);
    if (status == AB_OK) status = fem_create(o->scene, 0, 1, &o->domain, o->report);
    o->body = (fem_body *)o->domain;
    o->step = (ab_step){.dt = 1e-3};
    return status;
}

static one *create_with(const char *type, const char *material, const char *more, const char *sections) {
    one *o = calloc(1, sizeof *o);
    const ab_status status = attempt(o, type, material, more, sections);
    for (size_t i = 0; status != AB_OK && ab_report_text(o->report, i); i++) print_error("%s\n", ab_report_text(o->report, i));
    assert_int_equal(status, AB_OK);
    return o;
}

static one *create(const char *type, const char *material, const char *more) { return create_with(type, material, more, ""); }

static void destroy(one *o) {
    if (o->domain) o->domain->ops->destroy(o->domain);
    ab_scene_destroy(o->scene);
    ab_registry_destroy(o->registry);
    ab_report_destroy(o->report);
    free(o);
}

static ab_status step(one *o) {
    const ab_domain_ops *ops = o->domain->ops;
    AB_TRY(ops->begin(o->domain, &o->step, o->report));
    AB_TRY(ops->trial(o->domain, &o->step, o->report));
    AB_TRY(ops->finish(o->domain, &o->step, o->report));
    AB_TRY(ops->stress(o->domain, &o->step, o->report));
    o->step.time += o->step.dt;
    o->step.number++;
    return AB_OK;
}

static const char ELASTIC[] = "model: linear-elastic, E: 1000, nu: 0.3";
static const double AREA = 5, AROUND = 3.0413812651491097 + 2.0615528128088303 + 2.0615528128088303 + 2.0615528128088303;

static double area_of_patch(void) { /* shoelace of its corners */
    static const double c[4][2] = {{0, 0}, {3, 0.5}, {2.5, 2.5}, {0.5, 2}};
    double sum = 0;
    for (int k = 0; k < 4; k++) sum += 0.5 * (c[k][0] * c[(k + 1) % 4][1] - c[(k + 1) % 4][0] * c[k][1]);
    return sum;
}

static void test_mass_and_volume_are_those_of_the_shape(void **state) {
    (void)state;
    assert_true(fabs(area_of_patch() - AREA) < 1e-14);
    for (int t = 0; t < TYPE_COUNT; t++) {
        one *o = create(TYPES[t], ELASTIC, "");
        double *mass = calloc(o->body->nodes, sizeof *mass), *volume = calloc(o->body->nodes, sizeof *volume), m = 0, v = 0;
        assert_int_equal(o->domain->ops->read(o->domain, "mass", mass, o->report), AB_OK);
        assert_int_equal(o->domain->ops->read(o->domain, "volume", volume, o->report), AB_OK);
        for (size_t i = 0; i < o->body->nodes; i++) m += mass[i], v += volume[i];
        assert_true(fabs(m - 2 * AREA) < 1e-13 * m && fabs(v - AREA) < 1e-13 * v);
        free(mass), free(volume);
        destroy(o);
    }
}

static void test_points_inside_carry_the_mass_and_are_close(void **state) {
    (void)state;
    for (int t = 0; t < TYPE_COUNT; t++) {
        one *o = create(TYPES[t], ELASTIC, "");
        const fem_inner *in = &o->body->inner;
        double mass = 0, volume = 0, on_grid = 0;
        for (size_t q = 0; q < in->count; q++) {
            double sum = 0, place[2] = {0, 0};
            mass += in->mass[q];
            volume += in->volume[q];
            for (size_t s = in->start[q]; s < in->start[q + 1]; s++) {
                sum += in->weight[s];
                for (int c = 0; c < 2; c++) place[c] += in->weight[s] * o->body->x[2 * in->dof[s] + (size_t)c];
            }
            assert_true(fabs(sum - 1) < 1e-14);
            assert_true(hypot(place[0] - in->position[q], place[1] - in->position[in->ld + q]) < 1e-14);
            /* pieces are no longer than half a cell: half an edge squared is at most 0.1^2, two of them add up */
            assert_true(in->extent[q] <= 0.02 * 1.0001 && in->extent[in->ld + q] <= 0.02 * 1.0001);
        }
        assert_true(fabs(mass - 2 * AREA) < 1e-13 * mass && fabs(volume - AREA) < 1e-3 * AREA);
        ab_node_tiles tiles;
        o->domain->ops->node_tiles(o->domain, &tiles);
        for (size_t k = 0; k < tiles.count * AB_TILE_NODES; k++) on_grid += tiles.mass[k * tiles.stride];
        assert_true(fabs(on_grid - 2 * AREA) < 1e-12 * mass);
        destroy(o);
    }
}

static void test_surface_is_the_outline(void **state) {
    (void)state;
    for (int t = 0; t < TYPE_COUNT; t++) {
        one *o = create(TYPES[t], ELASTIC, "");
        ab_surface surface = {.struct_size = sizeof surface};
        uint64_t keys[64], cells[64];
        size_t count = 0;
        for (int32_t j = 0; j < 4; j++)
            for (int32_t i = 0; i < 4; i++) keys[count] = ab_tile_key(i, j), cells[count++] = UINT64_MAX;
        const ab_region all = {.cell = 0.4, .count = count, .key = keys, .cells = cells};
        assert_int_equal(o->domain->ops->faces(o->domain, &surface, o->report), AB_OK);
        assert_int_equal(o->domain->ops->surface_points(o->domain, &all, &surface, o->report), AB_OK);
        const size_t nodes = o->body->element->nodes == 8 ? 40 : 20;
        assert_int_equal(surface.face_count, 20);
        assert_int_equal(surface.vertex_count, nodes);
        assert_int_equal(surface.point_count, nodes);
        double around = 0, inside = 0, area = 0;
        for (size_t f = 0; f < surface.face_count; f++) { /* the body on the left: the shoelace of the faces is its area */
            const uint32_t a = surface.face_vertex[3 * f], b = surface.face_vertex[3 * f + 1];
            const double *x = surface.vertex_position, *y = x + surface.vertex_ld;
            around += hypot(x[b] - x[a], y[b] - y[a]);
            inside += 0.5 * (x[a] * y[b] - x[b] * y[a]);
            assert_int_equal(surface.face_vertex[3 * surface.face_beside[2 * f] + 1], a);
            assert_int_equal(surface.face_vertex[3 * surface.face_beside[2 * f + 1]], b);
        }
        for (size_t k = 0; k < surface.point_count; k++) {
            area += surface.point_area[k];
            assert_true(surface.point_key[k] == (uint64_t)surface.point_dof[k] + 1 && surface.point_weight[k] == 1.0);
            assert_true(surface.point_position[k] == o->body->x[2 * (size_t)surface.point_dof[k]]);
        }
        assert_true(fabs(around - AROUND) < 1e-12 && fabs(area - AROUND) < 1e-12 && fabs(inside - AREA) < 1e-12);
        /* one cell: that of the corner at (0, 0), 3 m and 2 m from the grid's corner: cell (7, 4) or its neighbours by rounding */
        const uint64_t one_key = ab_tile_key(0, 0), one_cell = (uint64_t)1 << (5 * AB_TILE + 7);
        const ab_region small = {.cell = 0.4, .count = 1, .key = &one_key, .cells = &one_cell};
        assert_int_equal(o->domain->ops->surface_points(o->domain, &small, &surface, o->report), AB_OK);
        for (size_t k = 0; k < surface.point_count; k++) {
            const double x = surface.point_position[k], y = surface.point_position[surface.point_ld + k];
            assert_true(x >= 2.8 && x < 3.2 && y >= 2.0 && y < 2.4);
        }
        assert_true(surface.point_count >= 1 && surface.point_count <= 6);
        destroy(o);
    }
}

static void says(const one *o, const char *text) {
    bool found = false;
    for (size_t i = 0; ab_report_text(o->report, i); i++) found = found || strstr(ab_report_text(o->report, i), text);
    for (size_t i = 0; !found && ab_report_text(o->report, i); i++) print_error("not '%s': %s\n", text, ab_report_text(o->report, i));
    assert_true(found);
}

static void test_contact_sees_free_dofs_only_between_trial_and_finish(void **state) {
    (void)state;
    one *o = create("q4", ELASTIC, ", fix: [{where: {side: left}, velocity: [null, 0.5]}]");
    const ab_domain_ops *ops = o->domain->ops;
    ab_dofs d;
    const size_t corner = 0; /* on the left */
    for (int pass = 0; pass < 2; pass++) {
        ops->dofs(o->domain, &d);
        for (size_t k = 0; k < 2 * o->body->nodes; k++) assert_true(d.inverse_mass[k] == 0);
        assert_null(d.impulse);
        assert_int_equal(ops->begin(o->domain, &o->step, o->report), AB_OK);
        ops->dofs(o->domain, &d);
        assert_true(d.inverse_mass[1] == 0 && d.velocity[2 * corner + 1] == 0.5); /* from the start */
        assert_int_equal(ops->trial(o->domain, &o->step, o->report), AB_OK);
        ops->dofs(o->domain, &d);
        assert_true(d.inverse_mass[2 * corner] > 0 && d.inverse_mass[2 * corner + 1] == 0 && d.impulse != NULL);
        d.impulse[2 * corner + 1] = -0.25; /* a contact presses on the support, and the support holds it */
        assert_int_equal(ops->finish(o->domain, &o->step, o->report), AB_OK);
        double reaction[3];
        ops->reaction(o->domain, reaction);
        if (pass == 0) assert_true(fabs(reaction[1] - 0.25 / o->step.dt) < 1e-9 && reaction[0] == 0);
        assert_int_equal(ops->stress(o->domain, &o->step, o->report), AB_OK);
        o->step.number++;
    }
    destroy(o);
}

static void test_a_given_velocity_may_be_a_field(void **state) {
    (void)state;
    one *o =
        create("q8", ELASTIC,
               ", fix: [{where: {side: left}, velocity: [\"-3*Y*t\", \"2*X\"]},\n   {where: {side: bottom}, velocity: [null, \"2*X\"]}]");
    assert_int_equal(ab_report_warnings(o->report), 0); /* both say the same of the corner */
    assert_int_equal(step(o), AB_OK);
    assert_int_equal(step(o), AB_OK);
    assert_true(o->body->held_count > 4);
    for (size_t k = 0; k < o->body->held_count; k++) {
        const fem_held *held = o->body->held + k;
        const double *x = o->body->mesh->x + 2 * (size_t)held->node, t = o->step.time - 0.5 * o->step.dt;
        const double given = held->component ? 2 * x[0] : -3 * x[1] * t,
                     found = o->body->velocity[2 * (size_t)held->node + held->component];
        assert_true(fabs(found - given) < 1e-12);
    }
    destroy(o);
    o = create("q4", ELASTIC, ", fix: [{where: {side: left}, velocity: [0, X]}, {where: {side: bottom}, velocity: [0, 0.5*X + Y + 1]}]");
    says(o, "warning: bodies.b.fix[1] gives 1 node another velocity along y than fix[0]");
    destroy(o);
}

static void test_uniform_strain_gives_uniform_fields(void **state) {
    (void)state;
    for (int t = 0; t < TYPE_COUNT; t++) {
        one *o = create(TYPES[t], "model: neo-hookean, E: 1000, nu: 0.3", ", velocity: [\"0.1*x+0.05*y\", \"-0.2*y\"]");
        const ab_domain_ops *ops = o->domain->ops;
        const size_t n = o->body->nodes;
        double *stress = calloc(4 * n, sizeof *stress), *f = calloc(4 * n, sizeof *f);
        assert_int_equal(step(o), AB_OK);
        assert_int_equal(ops->read(o->domain, "stress", stress, o->report), AB_OK);
        assert_int_equal(ops->read(o->domain, "deformation-gradient", f, o->report), AB_OK);
        static const double expected[4] = {1 + 1e-4, 5e-5, 0, 1 - 2e-4};
        for (size_t i = 0; i < n; i++)
            for (size_t c = 0; c < 4; c++) {
                assert_true(fabs(f[4 * i + c] - expected[c]) < 1e-13);
                assert_true(fabs(stress[4 * i + c] - stress[c]) < 1e-9 && stress[0] != 0);
            }
        free(stress), free(f);
        destroy(o);
    }
}

static void test_an_inverted_element_is_named(void **state) {
    (void)state;
    one *o = create("q4", ELASTIC, ", velocity: [\"x > 2.4 && y > 2.4 ? -600 : 0\", 0]");
    assert_int_equal(step(o), AB_FAILED);
    const char *text = ab_report_text(o->report, 0);
    assert_non_null(strstr(text, "body 'b': element 23 near"));
    assert_non_null(strstr(text, "is turned inside out at t = 0.001 s"));
    assert_non_null(strstr(text, "use a smaller dt"));
    destroy(o);
}

/* A formula without a value: named at the start, at its line, and in the step where it loses it; dt is not to blame. */
static void test_formulas_without_a_value_are_named(void **state) {
    (void)state;
    static const struct {
        const char *more, *sections, *text;
        bool start;
    } wrong[] = {
        {", velocity: [1/(x-3), 0]", "", "error: bodies.b.velocity[0] is inf at t = 0 s at (3, 0.5) m, which is no finite number", true},
        {", fix: [{where: {side: left}, velocity: [0, 1/t]}]", "", "error: bodies.b.fix[0].velocity[1] is inf at t = 0 s, which", true},
        {", fix: [{where: {side: left}, velocity: [0, 1/(X-X)]}]", "", "error: bodies.b.fix[0].velocity[1] is ", true},
        {", fix: [{where: {side: left}, velocity: [0, sqrt(0.0012-t)]}]", "", "bodies.b.fix[0].velocity[1] is ", false},
        {"", "loads: [{body: b, where: {side: right}, traction: [sqrt(0.0012-t), 0]}]\n", "loads[0].traction[0] is ", false},
        {"", "loads: [{body: b, where: {side: right}, traction: [0, x*sqrt(0.0012-t)]}]\n", "loads[0].traction[1] is ", false},
        {"", "loads: [{body: b, where: {side: right}, pressure: sqrt(0.0012-t)}]\n", "loads[0].pressure is ", false},
        {"", "loads: [{body: b, at: [3, 0.5], force: [0, sqrt(0.0012-t)]}]\n", "loads[0].force[1] is ", false},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        one *o = wrong[k].start ? calloc(1, sizeof *o) : create_with("q4", ELASTIC, wrong[k].more, wrong[k].sections);
        if (wrong[k].start) {
            assert_int_equal(attempt(o, "q4", ELASTIC, wrong[k].more, wrong[k].sections), AB_BAD_INPUT);
        } else {
            assert_int_equal(step(o), AB_OK);
            assert_int_equal(step(o), AB_FAILED);
            says(o, " is nan at t = 0.0015 s");
        }
        says(o, wrong[k].text);
        destroy(o);
    }
}

static void test_doubtful_places_are_warned_of(void **state) {
    (void)state;
    one *o = create_with("q4", ELASTIC, "", "loads: [{body: b, at: [50, 50], force: [0, 1]}, {body: b, at: [1.4, 1.1], force: [0, 1]}]\n");
    says(
        o,
        ":10:9: warning: loads[0].at: (50, 50) m is 67.18 m from the nearest node of 'b', more than the size of an element; the force acts "
        "on that node, at (2.5, 2.5) m");
    assert_int_equal(ab_report_warnings(o->report), 1);
    destroy(o);
    o = create("q4", ELASTIC,
               ", fix: [{where: {side: left}, velocity: [0, 0]},\n   {where: {side: bottom}, velocity: [1, t]}, {where: {side: top}, "
               "velocity: [0, null]}]");
    says(o, ":8:");
    says(
        o,
        "warning: bodies.b.fix[1] gives 1 node another velocity along x than fix[0] (line 7), the first at (0, 0) m; the last entry holds, "
        "fix[1]");
    assert_int_equal(ab_report_warnings(o->report), 1); /* the third says what the first does */
    assert_true(o->body->velocity[0] == 1);
    destroy(o);
}

/* Pressed flat by a quarter: the critical step is another one, and the one found anew. */
static void test_the_critical_step_follows_the_shape(void **state) {
    (void)state;
    one *o = create("q4", ELASTIC, ", velocity: [0, \"-100*y\"]");
    const char *limit;
    const double start = o->domain->ops->critical_dt(o->domain, &limit);
    assert_non_null(strstr(limit, "element "));
    assert_non_null(strstr(limit, " of 'b', "));
    for (int k = 0; k < 3; k++) assert_int_equal(step(o), AB_OK);
    const double now = o->domain->ops->critical_dt(o->domain, &limit);
    assert_true(fabs(now / start - 1) > 0.03);
    fem_critical(o->body, true);
    assert_true(fabs(o->domain->ops->critical_dt(o->domain, &limit) / now - 1) < 0.02);
    destroy(o);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mass_and_volume_are_those_of_the_shape),
        cmocka_unit_test(test_points_inside_carry_the_mass_and_are_close),
        cmocka_unit_test(test_surface_is_the_outline),
        cmocka_unit_test(test_contact_sees_free_dofs_only_between_trial_and_finish),
        cmocka_unit_test(test_a_given_velocity_may_be_a_field),
        cmocka_unit_test(test_uniform_strain_gives_uniform_fields),
        cmocka_unit_test(test_an_inverted_element_is_named),
        cmocka_unit_test(test_formulas_without_a_value_are_named),
        cmocka_unit_test(test_doubtful_places_are_warned_of),
        cmocka_unit_test(test_the_critical_step_follows_the_shape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
