/* test_scene_mesh.c: scenes with finite-element and rigid bodies: what is read, what a grid is needed for, and every mistake said at its place. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fake_registry.h"
#include "scene_text.h"

static const char base[] = "abut: 1\n"
                           "constants: {v: 0.5}\n"
                           "time: {end: 1, dt: 1e-3}\n"
                           "materials:\n"
                           "  steel: {model: linear-elastic, E: 15 MPa, nu: 0.0, density: 6000}\n"
                           "bodies:\n"
                           "  beam:\n"
                           "    method: finite-elements\n"
                           "    material: steel\n"
                           "    mesh: {box: [[0, 0], [3.75, 0.5]], elements: [15, 2], type: q8r}\n"
                           "    fix: [{where: {x: 0}, velocity: [0, null]}, {where: {side: right}, velocity: [~, \"-v*t\"]}]\n"
                           "  punch:\n"
                           "    method: rigid\n"
                           "    shape: {disc: {center: [2, 1], radius: 0.5}}\n"
                           "    motion: {velocity: [0, \"-0.1*min(t, 1)\"], spin: \"30 deg/s\", center: [2, 1]}\n"
                           "contact:\n"
                           "  - {bodies: [punch, beam], algorithm: faces}\n"
                           "loads:\n"
                           "  - {body: beam, at: [3.75, 0.25], force: [0, \"-2*t kN\"]}\n"
                           "  - {body: beam, where: {side: top}, traction: [0, -1e3]}\n"
                           "monitors:\n"
                           "  - {name: tip, body: beam, at: [3.75, 0.25], value: displacement.y}\n";

/* The base with the first `from` replaced by `to`, once or twice. */
static outcome read_with(const char *from, const char *to, const char *from2, const char *to2) {
    char *text = malloc(20000), *next = malloc(20000);
    strcpy(text, base);
    const char *pairs[2][2] = {{from, to}, {from2, to2}};
    for (int k = 0; k < 2; k++) {
        if (pairs[k][0] == NULL) continue;
        const char *at = strstr(text, pairs[k][0]);
        if (at == NULL) abort();
        sprintf(next, "%.*s%s%s", (int)(at - text), text, pairs[k][1], at + strlen(pairs[k][0]));
        strcpy(text, next);
    }
    outcome o = read_bytes(text, strlen(text), NULL, 0);
    free(text);
    free(next);
    return o;
}

static double at_time(const ab_number *number, double t) { return ab_number_at(number, t, 0, 0, 0); }

static void test_a_beam_and_a_punch_are_read_without_a_grid(void **state) {
    (void)state;
    outcome o = read_with(NULL, NULL, NULL, NULL);
    assert_int_equal(o.status, AB_OK);
    assert_int_equal(ab_report_warnings(o.report), 0);
    const ab_scene *s = o.scene;
    assert_float_equal(s->grid_cell, 0, 0);
    assert_float_equal(s->grid_from[0], 0, 0);
    const ab_body_spec *beam = &s->bodies[0], *punch = &s->bodies[1];
    assert_int_equal(beam->mesh.kind, AB_MESH_BOX);
    assert_int_equal(beam->mesh.type, AB_ELEMENT_Q8R);
    assert_int_equal(beam->mesh.elements[0], 15);
    assert_int_equal(beam->mesh.elements[1], 2);
    assert_float_equal(beam->mesh.high[0], 3.75, 0);
    assert_float_equal(beam->mesh.grading[1], 1, 0);
    assert_float_equal(beam->mesh.hourglass, 1, 0);
    assert_false(beam->has_shape);
    assert_int_equal(beam->fix_count, 2);
    assert_true(beam->fix[0].has[0] && !beam->fix[0].has[1] && !beam->fix[1].has[0] && beam->fix[1].has[1]);
    assert_float_equal(at_time(&beam->fix[0].velocity[0], 3), 0, 0);
    assert_float_equal(at_time(&beam->fix[1].velocity[1], 3), -1.5, 1e-15);
    assert_true(beam->fix[0].where.has[0]);
    assert_int_equal(beam->fix[1].where.side, AB_RIGHT);
    assert_true(punch->has_shape);
    assert_true(punch->material == SIZE_MAX);
    assert_true(punch->motion.has[0] && punch->motion.has[1] && punch->motion.has_spin && punch->motion.has_center);
    assert_false(punch->motion.has_mass || punch->motion.has_inertia);
    assert_float_equal(at_time(&punch->motion.velocity[1], 0.5), -0.05, 1e-15);
    assert_float_equal(at_time(&punch->motion.spin, 0), acos(-1.0) / 6, 1e-14);
    assert_int_equal(s->load_count, 2);
    assert_true(s->loads[0].point && !s->loads[1].point);
    assert_float_equal(s->loads[0].at[0], 3.75, 0);
    assert_float_equal(at_time(&s->loads[0].force[1], 2), -4000, 1e-9);
    assert_float_equal(at_time(&s->loads[1].traction[1], 0), -1000, 0);
    assert_false(s->loads[1].press);
    forget(&o);
}

static void test_tractions_and_pressures_know_time_and_place(void **state) {
    (void)state;
    outcome o = read_with("traction: [0, -1e3]", "traction: [\"2*t\", \"-x*y*t kPa\"]", NULL, NULL);
    assert_int_equal(o.status, AB_OK);
    const ab_load_spec *load = &o.scene->loads[1];
    assert_float_equal(ab_number_at(&load->traction[1], 2, 3, 4, 0), -24e3, 1e-9);
    assert_int_equal(ab_number_variables(&load->traction[0]), AB_VARIABLE_T);
    assert_int_equal(ab_number_variables(&load->traction[1]), AB_VARIABLES_TXY);
    forget(&o);
    o = read_with("traction: [0, -1e3]", "pressure: \"min(t,1)*y\"", NULL, NULL);
    assert_int_equal(o.status, AB_OK);
    load = &o.scene->loads[1];
    assert_true(load->press && !load->point);
    assert_int_equal(load->where.side, AB_TOP);
    assert_float_equal(ab_number_at(&load->pressure, 0.5, 7, 4, 0), 2, 1e-15);
    assert_int_equal(ab_number_variables(&load->pressure), AB_VARIABLE_T | AB_VARIABLE_Y);
    forget(&o);
    o = read_with("traction: [0, -1e3]", "pressure: 20 kPa", NULL, NULL);
    assert_int_equal(o.status, AB_OK);
    assert_float_equal(at_time(&o.scene->loads[1].pressure, 0), 20e3, 0);
    assert_int_equal(ab_number_variables(&o.scene->loads[1].pressure), AB_NO_VARIABLE);
    forget(&o);
}

static void test_meshes_in_their_other_forms(void **state) {
    (void)state;
    outcome o = read_with(
        "{box: [[0, 0], [3.75, 0.5]], elements: [15, 2], type: q8r}",
        "{patch: {bottom: [[1, 0], [1.5, 0], [2, 0]], right: {arc: {from: [2, 0], to: [0, 2], center: [0, 0]}}, top: [[0, 1], [0, 2]],\n"
        "      left: {arc: {from: [1, 0], to: [0, 1], center: [0, 0]}}}, elements: [4, 8], grading: [2, 0.5], type: q4, f_bar: true}",
        NULL, NULL);
    assert_int_equal(o.status, AB_OK);
    const ab_mesh_spec *mesh = &o.scene->bodies[0].mesh;
    assert_int_equal(mesh->kind, AB_MESH_PATCH);
    assert_int_equal(mesh->edge[0].count, 3);
    assert_false(mesh->edge[0].arc);
    assert_true(mesh->edge[1].arc && mesh->edge[3].arc);
    assert_float_equal(mesh->edge[1].points[1][1], 2, 0);
    assert_float_equal(mesh->grading[0], 2, 0);
    assert_true(mesh->f_bar);
    forget(&o);
    o = read_with("{box: [[0, 0], [3.75, 0.5]], elements: [15, 2], type: q8r}", "{file: meshes/beam.msh}", NULL, NULL);
    assert_int_equal(o.status, AB_OK);
    assert_int_equal(o.scene->bodies[0].mesh.kind, AB_MESH_FILE);
    assert_int_equal(o.scene->bodies[0].mesh.type, AB_ELEMENT_Q8);
    assert_string_equal(o.scene->bodies[0].mesh.file, "meshes/beam.msh");
    forget(&o);
    o = read_with("type: q8r", "type: q4r, hourglass: 0.5", NULL, NULL);
    assert_int_equal(o.status, AB_OK);
    assert_float_equal(o.scene->bodies[0].mesh.hourglass, 0.5, 0);
    forget(&o);
}

static void test_rigid_bodies_in_their_other_forms(void **state) {
    (void)state;
    static const char shape[] = "    shape: {disc: {center: [2, 1], radius: 0.5}}\n",
                      motion[] = "    motion: {velocity: [0, \"-0.1*min(t, 1)\"], spin: \"30 deg/s\", center: [2, 1]}\n";
    static const struct {
        const char *shape, *motion;
    } good[] = {
        {"    material: steel\n    shape: {ring: {center: [2, 1], radius: 0.5, inner: 0.2}}\n", ""},
        {"    material: steel\n    mesh: {box: [[1, 0.5], [2, 1]], elements: [2, 1], type: q4}\n", ""},
        {shape, "    motion: {mass: 3 kg}\n"},
        {shape, "    motion: {velocity: [0, null], spin: null, mass: 3, inertia: 0.1}\n"},
        {shape, "    motion: {velocity: [0, 0], inertia: 0.1}\n"},
        {"    material: steel\n    velocity: [1, 0]\n    gravity: false\n    shape: {polygon: [[1, 0.5], [2, 0.5], [2, 1]]}\n",
         "    motion: {spin: 0}\n"},
    };
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        outcome o = read_with(shape, good[k].shape, motion, good[k].motion);
        if (o.status != AB_OK) ab_report_print(o.report, stderr);
        assert_int_equal(o.status, AB_OK);
        forget(&o);
    }
    outcome o = read_with(shape, good[3].shape, motion, good[3].motion);
    const ab_motion_spec *m = &o.scene->bodies[1].motion;
    assert_true(m->has[0] && !m->has[1] && !m->has_spin && m->has_mass && m->has_inertia);
    assert_float_equal(m->inertia, 0.1, 0);
    forget(&o);
}

typedef struct mistake {
    const char *from, *to, *said;
} mistake;

#define MESH "mesh: {box: [[0, 0], [3.75, 0.5]], elements: [15, 2], type: q8r}"
#define FIX "fix: [{where: {x: 0}, velocity: [0, null]}, {where: {side: right}, velocity: [~, \"-v*t\"]}]"
#define SHAPE "shape: {disc: {center: [2, 1], radius: 0.5}}"
#define MOTION "motion: {velocity: [0, \"-0.1*min(t, 1)\"], spin: \"30 deg/s\", center: [2, 1]}"
#define PATCH(bottom, right, top, left)                                                                                                    \
    "mesh: {patch: {bottom: " bottom ", right: " right ", top: " top ", left: " left "}, elements: [2, 2]}"

static const mistake mistakes[] = {
    {"method: finite-elements", "method: finite", "bodies.beam.method: unknown word 'finite'"},
    {MESH, MESH "\n    basis: linear",
     ":11:12: error: bodies.beam.basis belongs to method material-points; leave it out of a body of method finite-elements"},
    {MESH, MESH "\n    fill: {per_cell: 4}", "bodies.beam.fill belongs to method material-points"},
    {MESH, MESH "\n    transfer: flip", "bodies.beam.transfer belongs to method material-points"},
    {MESH, MESH "\n    update: usl", "bodies.beam.update belongs to method material-points"},
    {MESH, MESH "\n    shape: {box: [[0, 0], [1, 1]]}", "bodies.beam.shape belongs to method material-points and rigid"},
    {MESH, MESH "\n    motion: {spin: 0}", "bodies.beam.motion belongs to method rigid"},
    {SHAPE, SHAPE "\n    fix: []", "bodies.punch.fix belongs to method finite-elements"},
    {"    " MESH "\n", "", "key 'mesh' is missing in bodies.beam: method finite-elements needs it, {box:"},
    {"    material: steel\n", "", "key 'material' is missing in bodies.beam: method finite-elements needs it"},
    {MESH, "mesh: {elements: [1, 1]}", "bodies.beam.mesh needs one of box, patch and file"},
    {MESH, "mesh: {box: [[0, 0], [1, 1]], file: a.msh, elements: [1, 1]}",
     "bodies.beam.mesh needs one of box, patch and file, not several"},
    {MESH, "mesh: {box: [[0, 0], [1, 1]]}", "key 'elements' is missing in bodies.beam.mesh"},
    {"[[0, 0], [3.75, 0.5]]", "[[0, 0], [3.75, 0]]",
     ":10:17: error: bodies.beam.mesh.box: the second corner must lie above and to the right"},
    {"[[0, 0], [3.75, 0.5]]", "[0, 0, 1, 1]", "bodies.beam.mesh.box must be two corners [[x, y], [x, y]]"},
    {"[15, 2]", "[15, 0]", "bodies.beam.mesh.elements must be two whole numbers [nx, ny], 1 or more; 0 is not"},
    {"[15, 2]", "[1.5, 2]", "1.5 is not"},
    {"[15, 2]", "[100000, 100000]", "100000 x 100000 are 1e+10 elements, more than 4000000"},
    {"[15, 2]", "[1e300, 1e300]", "more than 4000000"},
    {"[15, 2]", "15", "bodies.beam.mesh.elements must be two numbers [x, y]"},
    {"[15, 2]", "[15, 2], grading: [1, 0]", "bodies.beam.mesh.grading is 0 along y but must be between 1e-06 and 1e+06"},
    {"type: q8r", "type: q9", "bodies.beam.mesh.type: unknown word 'q9'"},
    {"type: q8r", "type: q8r, f_bar: true", ":10:77: error: bodies.beam.mesh.f_bar belongs to type q4; leave it out of type q8r"},
    {"type: q8r", "f_bar: true", "f_bar belongs to type q4; leave it out of type q8, or take type q8r"},
    {"type: q8r", "type: q4, hourglass: 1", "bodies.beam.mesh.hourglass belongs to type q4r; leave it out of type q4"},
    {"type: q8r", "type: q4r, hourglass: 0", "hourglass is 0 but must be greater than 0"},
    {"type: q8r", "typ: q8r", "unknown key 'typ' in bodies.beam.mesh; did you mean 'type'?"},
    {MESH, "mesh: {file: a.msh, elements: [1, 1]}", "bodies.beam.mesh.elements belongs to box and patch"},
    {MESH, "mesh: {file: a.msh, grading: [1, 1]}", "bodies.beam.mesh.grading belongs to box and patch"},
    {MESH, "mesh: {file: \"\"}", "bodies.beam.mesh.file is empty"},
    {MESH, "mesh: {file: \"a\\0b\"}", "error"},
    {MESH, PATCH("[[0, 0], [1, 0]]", "[[1, 0.1], [1, 1]]", "[[0, 1], [1, 1]]", "[[0, 0], [0, 1]]"),
     "bodies.beam.mesh.patch: bottom ends at [1, 0] and right begins at [1, 0.1]; they must meet there"},
    {MESH, PATCH("[[0, 0], [1, 0]]", "[[1, 0], [1, 1]]", "[[1, 1], [0, 1]]", "[[0, 0], [0, 1]]"),
     "top ends at [0, 1] and right ends at [1, 1]"},
    {MESH, PATCH("[[0, 0], [0, 1]]", "[[0, 1], [1, 1]]", "[[1, 0], [1, 1]]", "[[0, 0], [1, 0]]"), "go round clockwise, or enclose nothing"},
    {MESH, PATCH("[[0, 0], [1, 0]]", "[[1, 0], [2, 0]]", "[[1, 0], [2, 0]]", "[[0, 0], [1, 0]]"), "go round clockwise, or enclose nothing"},
    {MESH, PATCH("[[0, 0]]", "[[1, 0], [1, 1]]", "[[0, 1], [1, 1]]", "[[0, 0], [0, 1]]"),
     "bodies.beam.mesh.patch.bottom must be a list of two points or more"},
    {MESH, PATCH("[[0, 0], [0, 0], [1, 0]]", "[[1, 0], [1, 1]]", "[[0, 1], [1, 1]]", "[[0, 0], [0, 1]]"),
     "bottom: point 1 is where point 0 is; leave one out"},
    {MESH, PATCH("[[0, 0], [1]]", "[[1, 0], [1, 1]]", "[[0, 1], [1, 1]]", "[[0, 0], [0, 1]]"),
     "bodies.beam.mesh.patch.bottom.point 1 needs two numbers"},
    {MESH, PATCH("{arc: {from: [0, 0], to: [1, 0], center: [0.5, 0]}}", "[[1, 0], [1, 1]]", "[[0, 1], [1, 1]]", "[[0, 0], [0, 1]]"),
     "half a circle has no shorter way round"},
    {MESH, PATCH("{arc: {from: [0, 0], to: [1, 0], center: [0.6, 0.5]}}", "[[1, 0], [1, 1]]", "[[0, 1], [1, 1]]", "[[0, 0], [0, 1]]"),
     "on a circle both are the same"},
    {MESH, PATCH("{arc: {from: [1, 0], to: [1, 0], center: [0.6, 0.5]}}", "[[1, 0], [1, 1]]", "[[0, 1], [1, 1]]", "[[0, 0], [0, 1]]"),
     "an edge needs a length"},
    {MESH, PATCH("{arc: {from: [0, 0], to: [1, 0]}}", "[[1, 0], [1, 1]]", "[[0, 1], [1, 1]]", "[[0, 0], [0, 1]]"),
     "key 'center' is missing in bodies.beam.mesh.patch.bottom.arc"},
    {MESH, "mesh: {patch: {bottom: [[0, 0], [1, 0]]}, elements: [1, 1]}", "key 'left' is missing in bodies.beam.mesh.patch"},
    {FIX, "fix: {where: {x: 0}}", "bodies.beam.fix must be a list of entries"},
    {FIX, "fix: [{where: {x: 0}}]", "key 'velocity' is missing in bodies.beam.fix[0]"},
    {FIX, "fix: [{velocity: [0, 0]}]", "key 'where' is missing in bodies.beam.fix[0]"},
    {FIX, "fix: [{where: {x: 0}, velocity: [null, ~]}]", ":11:37: error: bodies.beam.fix[0].velocity leaves both directions free"},
    {FIX, "fix: [{where: {x: 0}, velocity: 0}]", "bodies.beam.fix[0].velocity must be [vx, vy], null in place of a number"},
    {FIX, "fix: [{where: {x: 0}, velocity: [0, 3 m]}]", "the unit 'm' does not have the dimension of 'm s-1'"},
    {FIX, "fix: [{where: {x: 0}, velocity: [0, \"x\"]}]", "bodies.beam.fix[0].velocity: 'x' cannot be used in this value; only t"},
    {FIX, "fix: [{where: {z: 0}, velocity: [0, 0]}]", "unknown key 'z' in bodies.beam.fix[0].where"},
    {SHAPE, "gravity: false", "bodies.punch needs one of shape and mesh: {box"},
    {SHAPE, SHAPE "\n    mesh: {box: [[1, 1], [2, 2]], elements: [1, 1]}", "bodies.punch needs one of shape and mesh, not both"},
    {MOTION, "gravity: true", "bodies.punch: its motion is not given and follows from forces, but its mass is not known; name a material"},
    {MOTION, "motion: {velocity: [0, null], spin: 0}", "bodies.punch: its velocity is not given"},
    {MOTION, "motion: {velocity: [0, 0]}", "bodies.punch: its spin is not given"},
    {MOTION, "motion: {velocity: [0, 0], spin: 1 m}", "the unit 'm' does not have the dimension of 's-1'"},
    {MOTION, "motion: {mass: 0}", "bodies.punch.motion.mass is 0 but must be greater than 0 kg"},
    {MOTION, "motion: {mass: 1, inertia: -1}", "bodies.punch.motion.inertia is -1 but must be greater than 0 kg m2"},
    {MOTION, "motion: [0, 0]", "bodies.punch.motion must be a mapping"},
    {MOTION, "motion: {mass: 1, centre: [0, 0]}", "unknown key 'centre' in bodies.punch.motion; did you mean 'center'?"},
    {"at: [3.75, 0.25], force", "at: [3.75, 0.25], traction",
     "loads[0] needs where and traction (or pressure), or at and force, not of both"},
    {"at: [3.75, 0.25], force: [0, \"-2*t kN\"]", "at: [3.75, 0.25], pressure: 1",
     "loads[0] needs where and traction (or pressure), or at and force, not of both"},
    {", force: [0, \"-2*t kN\"]", "", "key 'force' is missing in loads[0]"},
    {", traction: [0, -1e3]", "", "key 'traction' or 'pressure' is missing in loads[1]"},
    {", traction: [0, -1e3]", ", traction: [0, -1e3], pressure: 5",
     ":20:69: error: loads[1] has a traction and a pressure; write one entry for each"},
    {", traction: [0, -1e3]", ", pressure: [0, -1e3]", "loads[1].pressure"},
    {", traction: [0, -1e3]", ", pressure: 2 N", "loads[1].pressure: the unit 'N' does not have the dimension of 'Pa'"},
    {", traction: [0, -1e3]", ", pressure: \"z*t\"",
     "loads[1].pressure: 'z' cannot be used in this value; only t, x, y and constants are known here"},
    {"where: {side: top}, traction: [0, -1e3]", "pressure: 5", "key 'where' is missing in loads[1]"},
    {"where: {side: top}, traction", "traction", "key 'where' is missing in loads[1]"},
    {"at: [3.75, 0.25], force: [0, \"-2*t kN\"]", "mark: 1", "loads[0] needs where and traction (or pressure), or at and force"},
    {"\"-2*t kN\"", "2 Pa", "loads[0].force: the unit 'Pa' does not have the dimension of 'N'"},
    {"{body: beam, where", "{body: punch, where", ":20:49: error: loads[1]: 'punch' is rigid, so only the sum of a traction would count"},
    {"{body: beam, where: {side: top}, traction: [0, -1e3]", "{body: punch, where: {side: top}, pressure: 1 kPa",
     ":20:49: error: loads[1]: 'punch' is rigid, so only the sum of a pressure would count; write that sum: at: [x, y]"},
    {"algorithm: faces", "algorithm: multi-velocity",
     "key 'grid' is missing in the scene: contact of 'punch' and 'beam' by multi-velocity looks at the nodes of the grid; write grid: "
     "{from: [x, y]"},
    {"value: displacement.y}", "value: displacement.y}\n  - {name: s, body: punch, value: plastic_strain}",
     "monitors[1].value: unknown value 'plastic_strain' of a body"},
};

static void test_each_mistake_is_said_at_its_place_with_its_remedy(void **state) {
    (void)state;
    size_t unsaid = 0;
    for (size_t i = 0; i < sizeof mistakes / sizeof mistakes[0]; i++) {
        outcome o = read_with(mistakes[i].from, mistakes[i].to, NULL, NULL);
        unsaid += !said(&o, mistakes[i].said);
        assert_int_equal(o.status, AB_BAD_INPUT);
        assert_null(o.scene);
        forget(&o);
    }
    assert_int_equal(unsaid, 0);
}

#define GRID "grid: {from: [-1, -1], to: [4, 2], cell: 0.5}\ntime: {"

static void test_a_grid_is_asked_for_only_where_something_looks_at_it(void **state) {
    (void)state;
    outcome o = read_with("time: {", "grid: {from: [10, 10], to: [11, 11], cell: 0.5}\ntime: {", NULL, NULL);
    assert_int_equal(o.status, AB_OK); /* nobody looks at it */
    forget(&o);
    o = read_with("time: {", GRID, "algorithm: faces", "algorithm: multi-velocity");
    assert_int_equal(o.status, AB_OK);
    forget(&o);
    o = read_with("time: {", "grid: {from: [-1, -1], to: [3, 2], cell: 0.5}\ntime: {", "algorithm: faces", "algorithm: multi-velocity");
    assert_int_equal(o.status, AB_BAD_INPUT);
    assert_true(
        said(&o, ":11:11: error: body 'beam' lies partly outside the grid: it reaches from [0, 0] to [3.75, 0.5] m, the grid from [-1, -1] "
                 "to [3, 2] m, and "
                 "contact of 'punch' and 'beam' by multi-velocity looks at the nodes of the grid; make the grid larger or move the body"));
    assert_int_equal(ab_report_errors(o.report), 1); /* the punch lies inside */
    forget(&o);
    o = read_with("  punch:\n", "  soil: {method: material-points, material: steel, shape: {box: [[0, -1], [3, 0]]}}\n  punch:\n", NULL,
                  NULL);
    assert_int_equal(o.status, AB_BAD_INPUT);
    assert_true(said(&o, "key 'grid' is missing in the scene: body 'soil' is of material points"));
    forget(&o);
    o = read_with("  punch:\n", "  soil: {method: material-points, material: steel, shape: {box: [[0, -3], [3, 0]]}}\n  punch:\n",
                  "time: {", GRID);
    assert_int_equal(o.status, AB_BAD_INPUT);
    assert_true(said(&o, "body 'soil' lies partly outside the grid: it reaches from [0, -3] to [3, 0] m, the grid from [-1, -1] to [4, 2] "
                         "m; make the grid"));
    forget(&o);
}

static void test_a_patch_reaches_as_far_as_its_arcs(void **state) {
    (void)state;
    /* bottom bulges downwards to y = 1 - sqrt(2), beyond its ends at y = 0 */
    static const char patch[] = "{patch: {bottom: {arc: {from: [0, 0], to: [2, 0], center: [1, 1]}}, right: [[2, 0], [2, 1]], top: [[0, "
                                "1], [2, 1]], left: [[0, 0], [0, 1]]}, elements: [4, 4]}";
    static const char soil[] = "  soil: {method: material-points, material: steel, shape: {box: [[0, -1], [2, %g]]}}\n  punch:\n";
    for (int k = 0; k < 2; k++) {
        char text[200], all[sizeof base + 1000];
        snprintf(text, sizeof text, soil, k == 0 ? 1 - sqrt(2.0) + 1e-3 : 1 - sqrt(2.0) - 1e-3);
        const char *mesh = strstr(base, "{box: [[0, 0]"), *rest = strchr(mesh, '\n'), *punch = strstr(base, "  punch:\n"),
                   *time = strstr(base, "time: {");
        snprintf(all, sizeof all, "%.*s" GRID "%.*s%s%.*s%s%s", (int)(time - base), base, (int)(mesh - time - 7), time + 7, patch,
                 (int)(punch - rest), rest, text, punch + 9);
        outcome o = read_bytes(all, strlen(all), NULL, 0);
        assert_int_equal(o.status, AB_OK);
        bool touch = false;
        for (size_t i = 0; ab_report_text(o.report, i) != NULL; i++)
            touch = touch || strstr(ab_report_text(o.report, i), "bodies 'beam' and 'soil' touch or overlap") != NULL;
        assert_int_equal(touch, k == 0);
        forget(&o);
    }
}

static void test_forces_at_places_of_material_points_are_refused(void **state) {
    (void)state;
    outcome o = read_with("  punch:\n", "  soil: {method: material-points, material: steel, shape: {box: [[0, -1], [3, 0]]}}\n  punch:\n",
                          "loads:\n  - {body: beam, at", GRID "end: 1}\nloads:\n  - {body: soil, at");
    assert_int_equal(o.status, AB_BAD_INPUT);
    assert_true(said(
        &o,
        "loads[0]: a force at one place of material points makes a hole there, not a load; spread it over part of the outline of 'soil'"));
    forget(&o);
}

static void test_doubtful_choices_are_warned_of(void **state) {
    (void)state;
    outcome o = read_with("at: [3.75, 0.25], value", "at: [4.75, 0.25], value", NULL, NULL);
    assert_int_equal(o.status, AB_OK);
    assert_true(said(&o, "monitors[0].at: [4.75, 0.25] lies outside body 'beam'; its nearest point is taken"));
    forget(&o);
    o = read_with("at: [3.75, 0.25], value", "where: {x: 4.75, y: [0, 0.1]}, value", NULL, NULL);
    assert_int_equal(o.status, AB_OK);
    assert_true(said(&o, "monitors[0].where: x = 4.75 lies outside body 'beam'; its nearest points are taken"));
    forget(&o);
    o = read_with("at: [3.75, 0.25], value", "where: {x: 3.7, y: [0, 0.1]}, value", NULL, NULL);
    assert_int_equal(ab_report_warnings(o.report), 0);
    forget(&o);
    o = read_with("contact:\n  - {bodies: [punch, beam], algorithm: faces}\n", "", NULL, NULL);
    assert_int_equal(o.status, AB_OK);
    assert_true(said(&o, "bodies 'beam' and 'punch' touch or overlap at the start but have no entry in contact"));
    forget(&o);
}

/* --set may try another method: the keys that the file has for the first one are left out. */
static void test_a_method_may_be_set_from_outside(void **state) {
    (void)state;
    const ab_override overrides[] = {{"bodies.block.method", "finite-elements"},
                                     {"bodies.block.mesh", "{box: [[1, 1], [2, 2]], elements: [4, 4]}"}};
    outcome o = read_changed(NULL, NULL, overrides, 2);
    assert_int_equal(o.status, AB_OK);
    assert_true(said(
        &o, "warning: bodies.block.fill belongs to method material-points, not to finite-elements, which --set chose; it is left out"));
    assert_true(said(&o, "warning: bodies.block.shape belongs to"));
    assert_int_equal(o.scene->bodies[1].mesh.elements[0], 4);
    assert_false(o.scene->bodies[1].has_shape);
    forget(&o);
}

/* Any kind of value at any key: an answer, and a scene only where nothing was said against it. */
static void test_values_of_another_kind_are_answered(void **state) {
    (void)state;
    static const char *const paths[] = {"bodies.beam.mesh",
                                        "bodies.beam.mesh.box",
                                        "bodies.beam.mesh.patch",
                                        "bodies.beam.mesh.file",
                                        "bodies.beam.mesh.elements",
                                        "bodies.beam.mesh.grading",
                                        "bodies.beam.mesh.type",
                                        "bodies.beam.mesh.f_bar",
                                        "bodies.beam.mesh.hourglass",
                                        "bodies.beam.fix",
                                        "bodies.beam.fix[0]",
                                        "bodies.beam.fix[0].where",
                                        "bodies.beam.fix[0].where.x",
                                        "bodies.beam.fix[0].velocity",
                                        "bodies.beam.method",
                                        "bodies.punch.method",
                                        "bodies.punch.mesh",
                                        "bodies.punch.shape",
                                        "bodies.punch.material",
                                        "bodies.punch.motion",
                                        "bodies.punch.motion.velocity",
                                        "bodies.punch.motion.spin",
                                        "bodies.punch.motion.center",
                                        "bodies.punch.motion.mass",
                                        "bodies.punch.motion.inertia",
                                        "loads",
                                        "loads[0]",
                                        "loads[0].at",
                                        "loads[0].force",
                                        "loads[1].where",
                                        "loads[1].traction",
                                        "loads[1].pressure",
                                        "grid",
                                        "materials",
                                        "contact[0].algorithm"};
    static const char *const values[] = {
        "{}",
        "[]",
        "~",
        "1",
        "-1",
        "word",
        "rigid",
        "[1, 2]",
        "[[1, 2], [3, 4]]",
        "[a, b]",
        "{a: 1}",
        "1e300",
        "\"1e300 m\"",
        "true",
        "[{}]",
        "[~, ~]",
        "[[], []]",
        "[[0, 0], [1e300, 1e300]]",
        "\"\"",
        "[1e-300, 1e-300]",
        "{patch: {bottom: {arc: {from: [1e300, 0], to: [0, 1e300], center: [0, 0]}}, right: [[0, 0], [0, 0]], top: 1, left: {arc: 1}}}",
        ("{patch: {bottom: {arc: {from: [1e-300, 0], to: [0, 1e-300], center: [0, 0]}}, right: [[0, 1e-300], [0, 1]], top: [[0, 0], [0, "
         "1]], left: [[1e-300, 0], [0, 0]]},elements: [1, 1]}")};
    for (size_t p = 0; p < sizeof paths / sizeof paths[0]; p++)
        for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) {
            /* no units, so that their database need not be read */
            const ab_override change[] = {
                {"materials.steel.E", "1e7"}, {"loads[0].force", "[0, 1]"}, {"bodies.punch.motion.spin", "1"}, {paths[p], values[v]}};
            outcome o = read_bytes(base, strlen(base), change, 4);
            assert_true(o.status == AB_OK || o.status == AB_BAD_INPUT);
            assert_true((o.status == AB_OK) == (ab_report_errors(o.report) == 0));
            assert_true((o.status == AB_OK) == (o.scene != NULL));
            forget(&o);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_beam_and_a_punch_are_read_without_a_grid),
        cmocka_unit_test(test_tractions_and_pressures_know_time_and_place),
        cmocka_unit_test(test_meshes_in_their_other_forms),
        cmocka_unit_test(test_rigid_bodies_in_their_other_forms),
        cmocka_unit_test(test_each_mistake_is_said_at_its_place_with_its_remedy),
        cmocka_unit_test(test_a_grid_is_asked_for_only_where_something_looks_at_it),
        cmocka_unit_test(test_a_patch_reaches_as_far_as_its_arcs),
        cmocka_unit_test(test_forces_at_places_of_material_points_are_refused),
        cmocka_unit_test(test_doubtful_choices_are_warned_of),
        cmocka_unit_test(test_a_method_may_be_set_from_outside),
        cmocka_unit_test(test_values_of_another_kind_are_answered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
