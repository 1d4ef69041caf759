/* test_scene_set.c: --set reaches every value of a scene; wrong paths and values are said; damaged scenes never stop the reader. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fake_registry.h"
#include "scene_text.h"

static outcome with(const char *path, const char *value) {
    const ab_override override = {path, value};
    return read_changed(NULL, NULL, &override, 1);
}

static void test_an_override_is_as_if_the_file_had_said_so(void **state) {
    (void)state;
    outcome o = with("constants.mu", "0.5");
    assert_int_equal(o.status, AB_OK);
    assert_float_equal(o.scene->contacts[0].responder_settings[0].real, 0.5, 0);
    forget(&o);
    o = with("contact[0].friction", "twice/2 + 0.5");
    assert_int_equal(o.status, AB_OK);
    assert_float_equal(o.scene->contacts[0].responder_settings[0].real, 0.75, 1e-15);
    forget(&o);
    o = with("contact[0].algorithm", "both");
    assert_int_equal(o.status, AB_OK);
    assert_string_equal(o.scene->contacts[0].finder->class_.name, "both");
    forget(&o);
    o = with("contact[0].normal", "[0, 1]");
    assert_int_equal(o.status, AB_OK);
    assert_int_equal(o.scene->contacts[0].finder_settings[0].integer, -1);
    forget(&o);
    o = with("bodies.plane.fill.per_cell", "16");
    assert_int_equal(o.status, AB_OK);
    assert_int_equal(o.scene->bodies[0].per_cell, 16);
    forget(&o);
    o = with("damping", "{local: 0.5, until: 30 ms}");
    assert_int_equal(o.status, AB_OK);
    assert_float_equal(o.scene->damping_until, 0.03, 1e-15);
    forget(&o);
}

static void test_dt_and_cfl_take_each_others_place(void **state) {
    (void)state;
    outcome o = with("time.dt", "1e-3");
    assert_int_equal(o.status, AB_OK);
    assert_float_equal(o.scene->time_dt, 1e-3, 0);
    assert_float_equal(o.scene->time_cfl, 0, 0);
    forget(&o);
    const ab_override cfl = {"time.cfl", "0.3"};
    o = read_changed("cfl: 0.4", "dt: 1e-3", &cfl, 1);
    assert_int_equal(o.status, AB_OK);
    assert_float_equal(o.scene->time_dt, 0, 0);
    assert_float_equal(o.scene->time_cfl, 0.3, 0);
    forget(&o);
    const ab_override both[] = {{"time.cfl", "0.3"}, {"time.dt", "1e-3"}};
    o = read_changed(NULL, NULL, both, 2);
    assert_int_equal(o.status, AB_BAD_INPUT);
    assert_true(said(&o, "--set time.cfl: error: time has both dt and cfl"));
    forget(&o);
}

/* A run that --set makes shorter leaves out what is expected after its end; one that the file makes too short is wrong. */
static void test_a_shortened_run_leaves_late_expects_out(void **state) {
    (void)state;
    static const char one[] = "reference: \"1.5 + 2*t\", tolerance: 0.01}";
    static const char late[] = "reference: 0, from: 0.75, tolerance: 0.01}\n  - {name: ends, monitor: x, reference: 0, to: 0.9, tolerance: 0.01}\n"
                               "  - {name: kept, monitor: x, reference: 0, from: 0.001, tolerance: 0.01}";
    const ab_override shorter[] = {{"time.end", "0.01"}, {"expect[0].from", "0.02"}};
    outcome o = read_changed(one, late, shorter, 1);
    assert_int_equal(o.status, AB_OK);
    assert_true(said(&o, "warning: expect[0] is left out: its window reaches to 0.75 s, but --set ends the run at 0.01 s"));
    assert_true(said(&o, "warning: expect[1] is left out: its window reaches to 0.9 s"));
    assert_int_equal(o.scene->expect_count, 1);
    assert_string_equal(o.scene->expects[0].name, "kept");
    forget(&o);
    o = read_changed(one, late, shorter, 2);
    assert_int_equal(o.status, AB_BAD_INPUT);
    assert_true(said(&o, "error: expect[0]: the window from 0.02 to 0.01 s is empty"));
    forget(&o);
    o = read_changed(one, "reference: 0, from: 2, tolerance: 0.01}", NULL, 0);
    assert_int_equal(o.status, AB_BAD_INPUT);
    assert_true(said(&o, "the window from 2 to 1 s is empty"));
    forget(&o);
}

static void test_wrong_overrides_are_said_with_every_other_mistake(void **state) {
    (void)state;
    const ab_override wrong[] = {{"contact[3].friction", "1"}, {"bodies.blok.gravity", "false"}, {"contact[0].frction", "0.1"}, {"bodies.block.gravity", "perhaps"}, {"dampin.local", "0.1"}};
    outcome o = read_changed("title: two blocks", "tittle: two blocks", wrong, 5);
    assert_int_equal(o.status, AB_BAD_INPUT);
    assert_true(said(&o, "--set: error: contact[3].friction: 'contact' has 1 entries"));
    assert_true(said(&o, "--set: error: bodies.blok.gravity: there is no 'blok' in 'bodies'; did you mean 'block'?"));
    assert_true(said(&o, "--set contact[0].frction: error: unknown key 'frction' in contact[0]; did you mean 'friction'?"));
    assert_true(said(&o, "--set bodies.block.gravity: error: bodies.block.gravity: 'perhaps' is not true or false"));
    assert_true(said(&o, "--set dampin.local: error: unknown key 'dampin' in the scene; did you mean 'damping'?"));
    assert_true(said(&o, ":2:1: error: unknown key 'tittle'"));
    assert_int_equal(ab_report_errors(o.report), 6);
    forget(&o);
    o = with("contact", "[{bodies: [plane, block], algorithm: both}, {bodies: [block, plane], algorithm: both}]");
    assert_int_equal(o.status, AB_BAD_INPUT);
    assert_true(said(&o, "contact[1]: bodies 'block' and 'plane' meet already in contact[0]; one entry a pair"));
    forget(&o);
    o = with("constants.nu", "1");
    assert_int_equal(o.status, AB_OK);
    assert_true(said(&o, "--set constants.nu: warning: constants.nu is not in the file"));
    forget(&o);
}

/* Every damaged scene is either read or refused with a reason. */
static void test_damaged_scenes_are_answered(void **state) {
    (void)state;
    static const char *const pieces[] = {"[", "]", "{", "}", ":", "&a ", "*a", "null", "''", "-1", "1e999", "0", "[[]]", "{}", "t", "x", " 5 m", "all", "\n", "- ", "true", "|", "%", "1/0", "(("};
    char text[sizeof good_scene + 64];
    uint32_t random = 99;
    char plain[sizeof good_scene];
    strcpy(plain, good_scene);
    memcpy(strstr(plain, "20 MPa"), "2e7   ", 6); /* no unit, so that the database need not be read */
    const size_t length = sizeof good_scene - 1;
    for (int i = 0; i < 800; i++) {
        random = random * 1664525u + 1013904223u;
        const size_t at = (random >> 7) % length;
        random = random * 1664525u + 1013904223u;
        const size_t cut = i % 3 == 0 ? 0 : (random >> 9) % 12;
        const char *piece = pieces[(random >> 20) % (sizeof pieces / sizeof pieces[0])];
        const size_t rest = at + cut > length ? length : at + cut;
        const int n = snprintf(text, sizeof text, "%.*s%s%s", (int)at, plain, i % 4 == 0 ? "" : piece, plain + rest);
        outcome o = read_bytes(text, (size_t)n, NULL, 0);
        assert_true(o.status == AB_OK || o.status == AB_BAD_INPUT);
        assert_true((o.status == AB_OK) == (o.scene != NULL));
        assert_true((o.status == AB_OK) == (ab_report_errors(o.report) == 0));
        forget(&o);
    }
}

/* Every value of the good scene in turn becomes something of another kind. */
static void test_values_of_another_kind_are_answered(void **state) {
    (void)state;
    static const char *const paths[] = {"abut", "title", "constants", "constants.mu", "gravity", "gravity[0]", "time", "time.end", "grid", "grid.from", "grid.cell", "grid.sides", "grid.sides.top", "materials",
                                        "materials.rubber", "materials.rubber.model", "materials.rubber.E", "materials.rubber.yield", "bodies", "bodies.block", "bodies.block.method", "bodies.block.material",
                                        "bodies.block.shape", "bodies.block.shape.box", "bodies.block.shape.polygon", "bodies.block.shape.union", "bodies.block.fill", "bodies.block.fill.rule",
                                        "bodies.block.fill.per_cell", "bodies.block.basis", "bodies.block.transfer", "bodies.block.velocity", "contact", "contact[0]", "contact[0].bodies", "contact[0].algorithm",
                                        "contact[0].response", "contact[0].normal", "monitors", "monitors[0]", "monitors[0].name", "monitors[0].body", "monitors[0].at", "monitors[0].over", "monitors[0].where",
                                        "monitors[1].contact", "expect", "expect[0]", "expect[0].name", "expect[0].monitor", "expect[0].reference", "expect[0].from", "expect[0].norm", "loads", "history", "history.every",
                                        "output", "output.fields", "damping", "damping.local"};
    static const char *const values[] = {"{}", "[]", "~", "1", "-1", "word", "[1, 2]", "[[1, 2], [3, 4]]", "[a, b]", "{a: 1}", "1e300", "\"1e300 m\"", "true", "[{}]", "[~, ~]", "[[], []]", "[[0, 0], [1e300, 1e300]]", "\"\"", "[1e-300, 1e-300]"};
    for (size_t p = 0; p < sizeof paths / sizeof paths[0]; p++)
        for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) {
            const ab_override both[] = {{"constants.E0", "2e7"}, {paths[p], values[v]}}; /* no unit, so that the database need not be read */
            outcome o = read_changed(NULL, NULL, both, 2);
            assert_true(o.status == AB_OK || o.status == AB_BAD_INPUT);
            assert_true((o.status == AB_OK) == (ab_report_errors(o.report) == 0));
            forget(&o);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_an_override_is_as_if_the_file_had_said_so),
        cmocka_unit_test(test_dt_and_cfl_take_each_others_place),
        cmocka_unit_test(test_a_shortened_run_leaves_late_expects_out),
        cmocka_unit_test(test_wrong_overrides_are_said_with_every_other_mistake),
        cmocka_unit_test(test_damaged_scenes_are_answered),
        cmocka_unit_test(test_values_of_another_kind_are_answered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
