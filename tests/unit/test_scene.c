/* test_scene.c: a scene as the user meant it, and every mistake said at its place with its remedy. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fake_registry.h"
#include "scene_text.h"

static void test_a_good_scene_is_read_in_si(void **state) {
    (void)state;
    outcome o = read_changed(NULL, NULL, NULL, 0);
    assert_int_equal(o.status, AB_OK);
    assert_non_null(o.scene);
    const ab_scene *s = o.scene;
    assert_int_equal(ab_report_warnings(o.report), 0);
    assert_string_equal(s->title, "two blocks");
    assert_float_equal(ab_number_at(&s->gravity[1], 0, 0, 0, 0), -9.81, 0);
    assert_float_equal(s->time_cfl, 0.4, 0);
    assert_float_equal(s->time_dt, 0, 0);
    assert_int_equal(s->grid_cells[0], 16);
    assert_int_equal(s->grid_cells[1], 8);
    assert_int_equal(s->side[AB_BOTTOM], AB_SIDE_FIXED);
    assert_int_equal(s->side[AB_LEFT], AB_SIDE_ROLLER);
    assert_int_equal(s->side[AB_TOP], AB_SIDE_FREE);
    assert_float_equal(s->materials[0].settings[0].real, 2e7, 1e-6);
    assert_int_equal(s->materials[0].settings[3].integer, 1);
    assert_int_equal(s->materials[0].settings[4].integer, 7);
    assert_int_equal(s->body_count, 2);
    assert_string_equal(s->bodies[1].name, "block");
    assert_string_equal(s->bodies[0].update, "musl");
    assert_string_equal(s->bodies[0].basis, "gimp");
    assert_true(s->bodies[0].contiguous);
    assert_true(s->bodies[0].gravity);
    assert_int_equal(s->bodies[0].per_cell, 4);
    assert_int_equal(s->bodies[1].per_cell, 9);
    assert_int_equal(s->bodies[1].fill, AB_FILL_GAUSS);
    assert_float_equal(ab_number_at(&s->bodies[1].velocity[0], 0, 5, 3, 0), 0.3, 1e-15);
    assert_int_equal(s->contact_count, 1);
    assert_int_equal(s->contacts[0].body[0], 1);
    assert_int_equal(s->contacts[0].body[1], 0);
    assert_string_equal(s->contacts[0].responder->class_.name, "coulomb");
    assert_float_equal(s->contacts[0].responder_settings[0].real, 0.25, 0);
    assert_int_equal(s->contacts[0].responder_settings[0].given, 1);
    assert_int_equal(s->contacts[0].finder_settings[0].integer, 2);
    assert_string_equal(s->monitors[0].over, "mass");
    assert_int_equal(s->expects[0].monitor, 0);
    assert_string_equal(s->expects[0].norm, "final");
    assert_float_equal(s->expects[0].to, 1, 0);
    assert_float_equal(ab_number_at(&s->expects[0].reference, 2, 0, 0, 0), 5.5, 1e-15);
    assert_true(s->has_history);
    assert_false(s->has_output);
    forget(&o);
}

typedef struct mistake {
    const char *from, *to, *said;
} mistake;

static const mistake mistakes[] = {
    {"title: two blocks", "title: \"two\\e[2Jblocks\"", ":2:8: error: title: control character 0x1B; remove it"},
    {"title: two blocks", "title: \"two\\nblocks\"", ":2:8: error: title: a line break; write the text in one line"},
    {"title: two blocks", "title: \"two\\u0085blocks\"", "title: control character 0x85; remove it"},
    {"name: slides,", "name: \"a\\rb\",", "expect[0].name: a line break"},
    {"    friction: mu", "    frction: mu", ":27:5: error: unknown key 'frction' in contact[0]; did you mean 'friction'?"},
    {"friction: mu", "friction: um", "27:15: error: contact[0].friction: unknown name 'um'; did you mean 'mu'?"},
    {"friction: mu", "friction: -1", "contact[0].friction is -1 but must be at least 0"},
    {"friction: mu", "friction: mu\n    normal: averge", "contact[0].normal: unknown word 'averge'; did you mean 'average'?"},
    {"friction: mu", "friction: mu\n    normal: [0, 0]", "a direction needs a length greater than 0"},
    {"friction: mu", "friction: 30 deg", "the unit 'deg' has a dimension, but a pure number"},
    {"friction: mu", "friction:", "contact[0].friction has no value"},
    {"friction: mu", "friction: mu\n    friction: 0.1", ":28:5: error: key 'friction' stands twice; it was given in line 27"},
    {"[block, plane]", "[blok, plane]", "contact[0].bodies: there is no body 'blok'; did you mean 'block'?"},
    {"[block, plane]", "[block, block]", "body 'block' cannot be in contact with itself"},
    {"[block, plane]", "block", "contact[0].bodies must be two names [a, b], or all"},
    {"multi-velocity", "multi-velocty", "there is no plugin 'multi-velocty'; did you mean 'multi-velocity'?"},
    {"multi-velocity", "coulomb", "gives impulses but finds no contact points"},
    {"multi-velocity", "multi-velocity\n    response: multi-velocity", "finds contact points but gives no impulses"},
    {"    friction: mu", "    friction: mu\n  - {bodies: [plane, block], algorithm: both}",
     "bodies 'plane' and 'block' meet already in contact[0] (line 25); one entry a pair"},
    {"material: rubber", "material: ruber", "bodies.plane.material: there is no material 'ruber'; did you mean 'rubber'?"},
    {"model: linear-elastic", "model: linear_elastik", "did you mean 'linear-elastic'?"},
    {"model: linear-elastic", "model: only-3d", "does not work in plane strain"},
    {", density: 1000", "", "key 'density' is missing in materials.rubber"},
    {"E: E0, ", "", "key 'E' is missing in materials.rubber: linear-elastic needs it (Young's modulus, Pa)"},
    {"E: E0", "E: 20 mm", "materials.rubber.E: the unit 'mm' does not have the dimension of 'Pa'"},
    {"nu: 0.3", "nu: 0.5", "materials.rubber.nu is 0.5 but must be greater than -1 and less than 0.5"},
    {"nu: 0.3", "nu: [0.3]", "materials.rubber.nu must be a number, not a list"},
    {"nu: 0.3", "nu: 0.3, yield: [[0, 1], [2]]", "row 1 must have 2 numbers, not 1"},
    {"nu: 0.3", "nu: 0.3, steps: 2.5", "2.5 is not a whole number"},
    {"nu: 0.3", "nu: 0.3, checks: yes", "'yes' is not true or false"},
    {"nu: 0.3", "nu: true", "a number is needed, not a flag"},
    {"nu: 0.3", "nu: \"\"", "the value is empty"},
    {"nu: 0.3", "nu: .nan", "is not a finite number"},
    {"nu: 0.3", "nu: 1e999", "too large for a number"},
    {"nu: 0.3", "nu: 0x10", "is not decimal"},
    {"nu: 0.3", "nu: 1_000", "has '_' between its digits"},
    {"nu: 0.3", "nu: 010", "octal"},
    {"nu: 0.3", "nu: \"0.3*t\"", "'t' cannot be used in this value; only constants are known here"},
    {"velocity: [\"0.1*y\"", "velocity: [\"0.1*t\"", "only x, y (m) and constants are known here"},
    {"bottom: fixed", "botom: fixed", "unknown key 'botom' in grid.sides; did you mean 'bottom'?"},
    {"bottom: fixed", "bottom: fixd", "grid.sides.bottom: unknown word 'fixd'; did you mean 'fixed'?"},
    {"bottom: fixed", "bottom: {boundary: dashpots}, right: {a: 1}", "key 'boundary' is missing in grid.sides.right"},
    {"bottom: fixed", "bottom: {boundary: dashpots, c: 1}", "unknown key 'c' in grid.sides.bottom"},
    {"bottom: fixed", "bottom: fixed, top: {boundary: dashpots}", "no body of material points has its outline on this side"},
    {"to: [8, 4]", "to: [8, -4]", "not beyond grid.from"},
    {"to: [8, 4]", "to: [8]", "grid.to needs two numbers [x, y], not 1"},
    {"to: [8, 4]\n  cell: 0.5\n  sides: {", "to: [8, 4.1]\n  cell: 0.5\n  sides: {top: roller, ", "set grid.to to 4 or 4.5 along y"},
    {"[[1, 1], [2, 2]]", "[[1, 1], [2, 9]]",
     "body 'block' lies partly outside the grid: it reaches from [1, 1] to [2, 9] m, the grid from [0, 0] to [8, 4] m"},
    {"[[1, 1], [2, 2]]", "[[11, 1], [12, 2]]", "body 'block' lies wholly outside the grid"},
    {"[[1, 1], [2, 2]]", "[[2, 1], [1, 2]]", "the second corner must lie above and to the right"},
    {"{box: [[1, 1], [2, 2]]}", "{disc: {center: [2, 2], radius: 1e-200}}",
     "disc: the radius is 1e-200 m, too small to compute with, 2 m from the origin; write 2e-12 m or more"},
    {"{box: [[1, 1], [2, 2]]}", "{disc: {center: [0, 0], radius: 1e-200}}", "0 m from the origin; write 1e-30 m or more"},
    {"{box: [[1, 1], [2, 2]]}", "{disc: {center: [2, 2], radius: 1e-13}}", "disc: the radius is 1e-13 m, too small"},
    {"{box: [[1, 1], [2, 2]]}", "{box: [[0, 0], [1e-40, 1]]}", "the shorter side is 1e-40 m, too small"},
    {"{box: [[1, 1], [2, 2]]}", "{polygon: [[0, 0], [1e-200, 0], [0, 1e-200]]}", "the longest piece is 1e-200 m, too small"},
    {"{box: [[1, 1], [2, 2]]}", "{disc: {center: [2, 2], radius: 0}}", "radius is 0 but must be greater than 0 m"},
    {"{box: [[1, 1], [2, 2]]}", "{ring: {center: [2, 2], radius: 0.5, inner: 0.5}}", "inner radius 0.5 m is not less than radius 0.5 m"},
    {"{box: [[1, 1], [2, 2]]}", "{polygon: [[1, 1], [2, 2], [2, 1], [1, 2]]}", "the outline meets itself"},
    {"{box: [[1, 1], [2, 2]]}", "{polygon: [[1, 1], [2, 2], [3, 3]]}", "meets itself"},
    {"{box: [[1, 1], [2, 2]]}", "{polygon: [[1, 1], [2, 2]]}", "three corners or more"},
    {"{box: [[1, 1], [2, 2]]}", "{}", "one of box, disc, ring, polygon, union and mesh"},
    {"{box: [[1, 1], [2, 2]]}", "{mesh: a.msh}", "shape.mesh must be a mapping"},
    {"{box: [[1, 1], [2, 2]]}", "{union: [{mesh: {box: [[1, 1], [2, 2]], elements: [2, 2]}}]}", "a mesh stands alone"},
    {"{box: [[1, 1], [2, 2]]}", "{mesh: {box: [[1, 1], [2, 2]], elements: [2, 2], hourglass: 1, type: q4r}}",
     "mesh.hourglass belongs to finite elements"},
    {"{rule: gauss, per_cell: 9}", "{rule: gauss, points: 500}", "fill.points belongs to rule cvt; with rule gauss write per_cell"},
    {"{rule: gauss, per_cell: 9}", "{rule: regular, seed: 2}", "fill.seed belongs to rule cvt"},
    {"{rule: gauss, per_cell: 9}", "{rule: cvt, points: 0}", "fill.points"},
    {"{rule: gauss, per_cell: 9}", "{rule: cvt, points: 500, per_cell: 9}", "has both points and per_cell"},
    {"{rule: gauss, per_cell: 9}", "{rule: cvt, tolerance: 2}", "fill.tolerance"},
    {"{box: [[1, 1], [2, 2]]}", "{box: [[1, 1], [2, 2]], holes: [[[1, 1], [2, 1], [2, 2]]]}", "holes stand beside a polygon"},
    {"{box: [[1, 1], [2, 2]]}", "{polygon: [[1, 1], [3, 1], [3, 3]], holes: [[2, 1.5], [2.5, 1.5], [2.5, 2]]}",
     "needs a list of three corners or more"},
    {"{box: [[1, 1], [2, 2]]}", "{polygon: [[1, 1], [3, 1], [3, 3]], holes: [[[2, 1.5], [3.5, 1.5], [2.5, 2]]]}",
     "holes[0]: its piece from corner 0 meets the outline"},
    {"{box: [[1, 1], [2, 2]]}", "{polygon: [[1, 1], [3, 1], [3, 3]], holes: [[[5, 1.5], [5.5, 1.5], [5.5, 2]]]}",
     "holes[0] lies outside of the polygon"},
    {"{rule: gauss, per_cell: 9}", "{per_cell: 0}", "per_cell is 0 but must be at least 1"},
    {"    method: material-points", "    method: finite-element", "unknown word 'finite-element'; did you mean 'finite-elements'?"},
    {"    fill: {rule: gauss, per_cell: 9}", "    basis: bspline4", "unknown word 'bspline4'; did you mean 'bspline2'?"},
    {"    fill: {rule: gauss, per_cell: 9}", "    transfer: apik", "unknown word 'apik'; did you mean 'apic'?"},
    {"    fill: {rule: gauss, per_cell: 9}", "    transfer: {xpic: 0}",
     "bodies.block.transfer.xpic is 0 but must be at least 1 and at most 20"},
    {"    fill: {rule: gauss, per_cell: 9}", "    transfer: {fmpm: -1}",
     "bodies.block.transfer.fmpm is -1 but must be at least 1 and at most 20"},
    {"    fill: {rule: gauss, per_cell: 9}", "    transfer: {xpic: 21}",
     "bodies.block.transfer.xpic is 21 but must be at least 1 and at most 20"},
    {"    fill: {rule: gauss, per_cell: 9}", "    transfer: {xpic: 2.5}", "2.5 is not a whole number"},
    {"    fill: {rule: gauss, per_cell: 9}", "    transfer: {xpik: 2}", "did you mean 'xpic'?"},
    {"    fill: {rule: gauss, per_cell: 9}", "    transfer: xpic", "'xpic' needs its order; write {xpic: 2}"},
    {"    fill: {rule: gauss, per_cell: 9}", "    transfer: {apic: 1}", "unknown key 'apic'"},
    {"    fill: {rule: gauss, per_cell: 9}", "    transfer: {xpic: 2, fmpm: 2}",
     "bodies.block.transfer needs one of flip, xpic and fmpm, not 2 of them"},
    {"    fill: {rule: gauss, per_cell: 9}", "    transfer: tpic\n    update: usl",
     "transfer tpic with update usl on basis gimp is unstable"},
    {"    fill: {rule: gauss, per_cell: 9}", "    transfer: {}", "bodies.block.transfer needs one of flip, xpic and fmpm, not 0 of them"},
    {"    fill: {rule: gauss, per_cell: 9}", "    transfer: {flip: 1.1}", "flip is 1.1 but must be at least 0 and at most 1"},
    {"    fill: {rule: gauss, per_cell: 9}", "    mesh: {}",
     "bodies.block.mesh belongs to method finite-elements and rigid; leave it out of a body of method material-points"},
    {"    fill: {rule: gauss, per_cell: 9}", "    fix: []",
     "bodies.block.fix belongs to method finite-elements; leave it out of a body of method material-points"},
    {"title: two blocks", "space: 3d", "space: '3d' is not in this version yet; there is: plane-strain, axisymmetric"},
    {"title: two blocks", "stages: []", "stages is empty; write at least one, or time"},
    {"title: two blocks", "stages: [{duration: 1}]", "time and stages say the same thing twice"},
    {"time: {end: 1, cfl: 0.4}", "stages: [{cfl: 0.4}]", "stages[0] needs one of end and duration"},
    {"time: {end: 1, cfl: 0.4}", "stages: [{end: 1}, {end: 1}]", "stages[1].end is 1 s, but the stage begins at 1 s"},
    {"time: {end: 1, cfl: 0.4}", "stages: [{end: 1, name: a}, {end: 2, name: a}]", "there is a stage 'a' already"},
    {"time: {end: 1, cfl: 0.4}", "stages: [{end: 1, scheme: newmark}]", "'newmark' is not in this version yet; there is: explicit"},
    {"time: {end: 1, cfl: 0.4}", "stages: [{end: 1, scheme: quasi-static}]", "'quasi-static' is not in this version yet; there is: explicit"},
    {"time: {end: 1, cfl: 0.4}", "stages: [{end: 1, dt: 1e-3, cfl: 0.4}]", "stages[0] has both dt and cfl"},
    {"time: {end: 1, cfl: 0.4}", "stages: [{end: 1, ramp: 0.5}]", "stages[0].ramp is of gravity: ramp"},
    {"time: {end: 1, cfl: 0.4}", "stages: [{end: 1, gravity: ramp, ramp: 2}]", "longer than the stage"},
    {"time: {end: 1, cfl: 0.4}", "stages: [{end: 1, until: {}}]", "stages[0].until: write unbalanced_force: 1e-4"},
    {"time: {end: 1, cfl: 0.4}", "stages: [{end: 1, damping: {local: 1.5}}]", "stages[0].damping.local is 1.5"},
    {"    fill: {rule: gauss, per_cell: 9}", "    initial: {stress: k0}", "must be K0, gravity or four numbers"},
    {"    fill: {rule: gauss, per_cell: 9}", "    initial: {stress: [1, 2]}", "must be K0, gravity or four numbers"},
    {"    fill: {rule: gauss, per_cell: 9}", "    initial: {stress: gravity, K0: 0.5}", "K0 belongs to stress: K0"},
    {"title: two blocks", "boundaries: [{on: nobody, where: {side: top}, boundary: dashpots}]",
     "boundaries[0].on: there is no body 'nobody'"},
    {"title: two blocks", "boundaries: [{on: block, where: {side: top}, boundary: dashpot}]",
     "there is no plugin 'dashpot'; did you mean 'dashpots'?"},
    {"title: two blocks", "boundaries: [{on: block, where: {side: top}, boundary: dashpots, c: 1}]", "unknown key 'c' in boundaries[0]"},
    {"title: two blocks", "boundaries: [{on: block, boundary: dashpots}]", "key 'where' is missing in boundaries[0]"},
    {"title: two blocks", "checkpoint: {}", "checkpoint: write every (s), steps or wall (minutes)"},
    {"title: two blocks", "checkpoint: {steps: 0}", "checkpoint.steps is 0"},
    {"title: two blocks", "checkpoint: {every: -1}", "checkpoint.every is -1 but must be greater than 0 s"},
    {"title: two blocks", "checkpoint: {wall: 1 m}", "the unit 'm' does not have the dimension of 'min'"},
    {"title: two blocks", "trade: {vary: [{set: constants.nothing, values: [1]}]}", "the scene has no constant 'nothing'"},
    {"title: two blocks", "tittle: two blocks", ":2:1: error: unknown key 'tittle' in the scene; did you mean 'title'?"},
    {"abut: 1", "abut: 2", "this program reads version 1"},
    {"abut: 1", "{}", "not YAML"},
    {"time: {end: 1, cfl: 0.4}", "time: {end: 1, cfl: 0.4, dt: 0.1}", "time has both dt and cfl"},
    {"time: {end: 1, cfl: 0.4}", "time: {end: 0}", "time.end is 0 but must be greater than 0 s"},
    {"time: {end: 1, cfl: 0.4}", "time: {end: 1 m}", "the unit 'm' does not have the dimension of 's'"},
    {"time: {end: 1, cfl: 0.4}", "time: 1", "time must be a mapping"},
    {"gravity: [0, -9.81]", "gravity: [0, -9.81, 0]", "gravity needs two numbers [x, y], not 3"},
    {"gravity: [0, -9.81]", "gravity: [0, \"x\"]", "'x' cannot be used in this value; only t"},
    {"{mu: 0.25,", "{t: 0.25,", "'t' is a variable of formulas"},
    {"{mu: 0.25,", "{sin: 0.25,", "'sin' is a function"},
    {"{mu: 0.25,", "{e: 0.25,", "'e' has a meaning already"},
    {"{mu: 0.25,", "{mu: twice,", "constants.mu: unknown name 'twice'"},
    {"{mu: 0.25,", "{mu: 1/0,", "is infinite, not a finite number"},
    {"value: position.x", "value: position.z", "monitors[0].value: unknown value 'position.z' of a body; did you mean 'position.x'?"},
    {"value: position.x", "value: plastic_strian", "did you mean 'plastic_strain'?"},
    {"value: position.x", "value: position.x, over: mas", "monitors[0].over: unknown word 'mas'; did you mean 'mass'?"},
    {"value: position.x", "value: position.x, over: mass, at: [1, 1]", "at names one point, so over has no meaning"},
    {"value: position.x", "value: momentum.x, at: [1, 1]", "monitors[0].at has no meaning for 'momentum.x'"},
    {"name: x,", "name: kinetic,", "is a column of history.csv already"},
    {"name: push", "name: x", "there is a monitor 'x' already in line 29"},
    {"contact: 0", "contact: 1", "there is no contact 1; they count from 0 to 0"},
    {"contact: 0", "contact: 0, body: block", "has both body and contact"},
    {"monitor: x", "monitor: y", "there is no monitor 'y'"},
    {"monitor: x", "column: x", "'x' is a monitor; write monitor: x"},
    {"monitor: x", "column: kinetik", "unknown column 'kinetik'; did you mean 'kinetic'?"},
    {"monitor: x", "column: block.t", "unknown column 't'"},
    {"monitor: x, reference: \"1.5 + 2*t\"", "monitor: x, reference: 3 s", "the unit 's' does not have the dimension of 'm'"},
    {"tolerance: 0.01", "tolerance: 0.01, norm: lmax", "expect[0].norm: unknown word 'lmax'; did you mean 'max'?"},
    {"tolerance: 0.01", "tolerance: 0.01, norm: duration", "key 'level' is missing in expect[0]"},
    {"tolerance: 0.01", "tolerance: 0.01, level: 1", "expect[0].level has no meaning for norm final"},
    {"tolerance: 0.01", "tolerance: 0.01, to: 2", "2 s is after the end of the run at 1 s"},
    {"tolerance: 0.01", "tolerance: 0.01, from: 0.5, to: 0.2", "the window from 0.5 to 0.2 s is empty"},
    {", tolerance: 0.01", "", "key 'tolerance' is missing in expect[0]"},
    {"title: two blocks", "output: {every: 0.1, fields: [stres]}", "output.fields[0]: unknown field 'stres'; did you mean 'stress'?"},
    {"title: two blocks", "output: {every: 0.1, fields: [stress, stress]}", "field 'stress' stands twice"},
    {"title: two blocks", "history: {every: 0}", "history.every is 0 but must be at least 1"},
    {"title: two blocks", "damping: {local: 1}", "damping.local is 1 but must be at least 0 and less than 1"},
    {"title: two blocks", "loads: [{body: block, where: {side: tpo}, traction: [0, 0]}]",
     "loads[0].where.side: unknown word 'tpo'; did you mean 'top'?"},
    {"title: two blocks", "loads: [{body: block, where: {}, traction: [0, 0]}]", "says nothing"},
    {"title: two blocks", "loads: [{body: block, where: {x: [1, 0]}, traction: [0, 0]}]", "the range goes from 1 down to 0"},
    {"title: two blocks", "title: {a: b}", "title must be a text, not a mapping"},
};

static void test_each_mistake_is_said_at_its_place_with_its_remedy(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof mistakes / sizeof mistakes[0]; i++) {
        outcome o = read_changed(mistakes[i].from, mistakes[i].to, NULL, 0);
        assert_true(said(&o, mistakes[i].said));
        assert_int_equal(o.status, AB_BAD_INPUT);
        assert_null(o.scene);
        forget(&o);
    }
}

static void test_all_mistakes_are_said_at_once_in_order_of_place(void **state) {
    (void)state;
    outcome o = read_changed("title: two blocks\nconstants: {mu: 0.25, E0: 20 MPa, twice: 2*mu}\n",
                             "tittle: a\nconstants: {mu: 0.25, E0: 20 MPq, t: 1}\n", NULL, 0);
    assert_int_equal(o.status, AB_BAD_INPUT);
    assert_int_equal(ab_report_errors(o.report), 3);
    assert_non_null(strstr(ab_report_text(o.report, 0), ":2:1: error: unknown key 'tittle'"));
    assert_non_null(strstr(ab_report_text(o.report, 1), ":3:27: error: constants.E0: unknown unit 'MPq'"));
    assert_non_null(strstr(ab_report_text(o.report, 2), ":3:35: error: constants.t"));
    forget(&o);
}

static void test_shapes_and_words_in_their_other_forms(void **state) {
    (void)state;
    outcome o = read_changed("    fill: {rule: gauss, per_cell: 9}\n",
                             "    basis: {gimp: fixed}\n    transfer: {flip: 0.9}\n    update: usf\n    gravity: false\n", NULL, 0);
    assert_int_equal(o.status, AB_OK);
    assert_false(o.scene->bodies[1].contiguous);
    assert_float_equal(o.scene->bodies[1].flip, 0.9, 0);
    assert_false(o.scene->bodies[1].gravity);
    forget(&o);
    static const struct {
        const char *text;
        ab_transfer transfer;
        double flip;
        int order;
    } transfers[] = {{"flip", AB_TRANSFER_FLIP, 1, 0}, {"pic", AB_TRANSFER_FLIP, 0, 0},       {"apic", AB_TRANSFER_APIC, 0, 0},
                     {"tpic", AB_TRANSFER_TPIC, 0, 0}, {"{xpic: 3}", AB_TRANSFER_XPIC, 1, 3}, {"{fmpm: 20}", AB_TRANSFER_FMPM, 1, 20}};
    for (size_t k = 0; k < sizeof transfers / sizeof *transfers; k++) {
        char text[80];
        snprintf(text, sizeof text, "    transfer: %s\n", transfers[k].text);
        o = read_changed("    fill: {rule: gauss, per_cell: 9}\n", text, NULL, 0);
        assert_int_equal(o.status, AB_OK);
        assert_int_equal(o.scene->bodies[1].transfer, transfers[k].transfer);
        assert_float_equal(o.scene->bodies[1].flip, transfers[k].flip, 0);
        if (transfers[k].order) assert_int_equal(o.scene->bodies[1].order, transfers[k].order);
        forget(&o);
    }
    o = read_changed("{box: [[1, 1], [2, 2]]}",
                     "{union: [{polygon: [[1, 1], [1, 2], [2, 2], [2, 1], [1, 1]]}, {ring: {center: [4, 2], radius: 50 cm, inner: 0.2}}]}",
                     NULL, 0);
    assert_int_equal(o.status, AB_OK);
    const ab_shape_spec *polygon = &o.scene->bodies[1].shape.members[0];
    assert_int_equal(polygon->count, 4);
    assert_float_equal(polygon->vertices[0][0], 2, 0); /* turned round to counter-clockwise */
    assert_float_equal(o.scene->bodies[1].shape.members[1].radius, 0.5, 1e-15);
    forget(&o);
    o = read_changed("bodies: [block, plane]", "bodies: all", NULL, 0);
    assert_int_equal(o.status, AB_OK);
    assert_int_equal(o.scene->contact_count, 1);
    forget(&o);
    o = read_changed("friction: mu", "friction: mu\n    normal: [3, 4]\n    gap: none\n    shared: 5 mm", NULL, 0);
    assert_int_equal(o.status, AB_OK);
    assert_int_equal(o.scene->contacts[0].finder_settings[0].integer, -1);
    assert_float_equal(o.scene->contacts[0].finder_settings[0].table[1], 0.8, 1e-15);
    assert_int_equal(o.scene->contacts[0].finder_settings[1].integer, 1);
    assert_float_equal(o.scene->contacts[0].finder_settings[2].real, 0.005, 1e-15);
    assert_float_equal(o.scene->contacts[0].responder_settings[1].real, 0.005, 1e-15);
    forget(&o);
    o = read_changed("algorithm: multi-velocity", "algorithm: both", NULL, 0);
    assert_int_equal(o.status, AB_OK);
    assert_ptr_equal(o.scene->contacts[0].responder, o.scene->contacts[0].finder);
    forget(&o);
    o = read_changed("nu: 0.3", "nu: 0.3, yield: [[0, 1 MPa], [0.1, 2 MPa]]", NULL, 0);
    assert_int_equal(o.status, AB_OK);
    assert_int_equal(o.scene->materials[0].settings[2].rows, 2);
    assert_float_equal(o.scene->materials[0].settings[2].table[3], 2e6, 1e-6);
    forget(&o);
    o = read_changed("to: [8, 4]", "to: [8.1, 4]", NULL, 0); /* right is free: extended */
    assert_int_equal(o.status, AB_OK);
    assert_int_equal(o.scene->grid_cells[0], 17);
    assert_float_equal(o.scene->grid_to[0], 8.5, 1e-12);
    forget(&o);
}

static void test_units_of_expects_follow_the_norm(void **state) {
    (void)state;
    outcome o = read_changed("monitor: x, reference: \"1.5 + 2*t\", tolerance: 0.01",
                             "monitor: push, norm: impulse, reference: 2 kN ms, scale: 1 N s, tolerance: 0.01", NULL, 0);
    assert_int_equal(o.status, AB_OK);
    assert_float_equal(o.scene->expects[0].reference.value, 2, 1e-12);
    forget(&o);
    o = read_changed("monitor: x, reference: \"1.5 + 2*t\", tolerance: 0.01",
                     "monitor: x, norm: duration, level: 15 cm, reference: 2 ms, tolerance: 0.01", NULL, 0);
    assert_int_equal(o.status, AB_OK);
    assert_float_equal(o.scene->expects[0].reference.value, 0.002, 1e-15);
    assert_float_equal(o.scene->expects[0].level, 0.15, 1e-15);
    forget(&o);
    o = read_changed("monitor: x, reference: \"1.5 + 2*t\", tolerance: 0.01",
                     "column: block.kinetic, norm: max, reference: \"2*t kJ\", tolerance: 0.01", NULL, 0);
    assert_int_equal(o.status, AB_OK);
    assert_string_equal(o.scene->expects[0].column, "block.kinetic");
    assert_float_equal(ab_number_at(&o.scene->expects[0].reference, 2, 0, 0, 0), 4000, 1e-9);
    forget(&o);
}

static void test_doubtful_choices_are_warned_of(void **state) {
    (void)state;
    outcome o = read_changed("contact:\n  - bodies: [block, plane]\n    algorithm: multi-velocity\n    friction: mu\nmonitors:\n  - {name: "
                             "x, body: block, value: position.x}\n  - {name: push, contact: 0, value: force.y}",
                             "monitors:\n  - {name: x, body: block, value: position.x}", NULL, 0);
    assert_int_equal(o.status, AB_OK);
    assert_true(said(&o, "warning: bodies 'plane' and 'block' touch or overlap"));
    forget(&o);
    o = read_changed("cfl: 0.4", "cfl: 1.5", NULL, 0);
    assert_int_equal(o.status, AB_OK);
    assert_true(said(&o, "above 1, the limit of stability"));
    forget(&o);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_good_scene_is_read_in_si),
        cmocka_unit_test(test_each_mistake_is_said_at_its_place_with_its_remedy),
        cmocka_unit_test(test_all_mistakes_are_said_at_once_in_order_of_place),
        cmocka_unit_test(test_shapes_and_words_in_their_other_forms),
        cmocka_unit_test(test_units_of_expects_follow_the_norm),
        cmocka_unit_test(test_doubtful_choices_are_warned_of),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
