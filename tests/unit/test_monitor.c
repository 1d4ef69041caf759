/* Monitors of bodies whose numbers are known. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "core/monitor.h"
#include "fake_domain.h"

static ab_monitor_spec of_body(int body, const char *value, const char *over) {
    static char name[] = "it";
    return (ab_monitor_spec){.name = name,
                             .body = body,
                             .contact = -1,
                             .value = (char *)(uintptr_t)value,
                             .over = (char *)(uintptr_t)over,
                             .where = {.side = -1}};
}

/* The value of one monitor at step 5 (t = 0.5). *reads: how many fields that took. */
static double value_of(const ab_monitor_spec *spec, size_t lost, long *reads) {
    fake_run *run = fake_create(4, 3);
    ab_report *report = ab_report_create();
    ab_monitors *monitors = NULL;
    run->scene.monitors = (ab_monitor_spec *)(uintptr_t)spec;
    run->scene.monitor_count = 1;
    assert_int_equal(ab_monitors_create(&run->view, &monitors, report), AB_OK);
    fake_update(run, 5, 0.1);
    run->domains[0].lost = lost;
    const long before = run->domains[0].reads;
    double value = 0, again = 0;
    assert_int_equal(ab_monitor_value(monitors, 0, &run->view, &value, report), AB_OK);
    if (reads != NULL) *reads = run->domains[0].reads - before;
    assert_int_equal(ab_monitor_value(monitors, 0, &run->view, &again, report), AB_OK);
    if (!isnan(value)) assert_float_equal(value, again, 0);
    ab_monitors_destroy(monitors);
    ab_report_destroy(report);
    free(run);
    return value;
}

static double plain(int body, const char *value, const char *over) {
    const ab_monitor_spec spec = of_body(body, value, over);
    return value_of(&spec, 0, NULL);
}

static void test_whole_body_values_read_no_points(void **state) {
    (void)state;
    static const struct {
        const char *value;
        double expected;
    } known[] = {
        {"position.x", 2.5}, {"position.y", 4.25},     {"displacement.x", 0.5}, {"velocity.y", 0.5}, {"momentum.x", 10},
        {"mass", 10},        {"energy.kinetic", 4.5},  {"energy.strain", 0.5},  {"energy.total", 5}, {"energy.remainder", 0},
        {"momentum.y", 5},   {"displacement.y", 0.25},
    };
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        const ab_monitor_spec spec = of_body(0, known[k].value, NULL);
        long reads = -1;
        assert_float_equal(value_of(&spec, 0, &reads), known[k].expected, 1e-14);
        assert_int_equal(reads, 0);
    }
}

static void test_points_are_gathered(void **state) {
    (void)state;
    assert_float_equal(plain(0, "position.x", "max"), 3.5, 1e-15);
    assert_float_equal(plain(0, "position.x", "min"), 0.5, 1e-15);
    assert_float_equal(plain(0, "position.x", "sum"), 8, 1e-15);
    assert_float_equal(plain(0, "position.x", "volume"), 2, 1e-15);
    assert_float_equal(plain(0, "stress.xy", "volume"), 10, 1e-14);
    assert_float_equal(plain(0, "stress.yy", "mass"), 60, 1e-13);
    assert_float_equal(plain(0, "back_stress.xy", "volume"), 10, 1e-14); /* a state, whose components the body does not name */
    assert_float_equal(plain(0, "pressure", "volume"), -50, 1e-13);
    assert_float_equal(plain(0, "speed", "max"), sqrt(1.25), 1e-15);
    assert_float_equal(plain(0, "displacement.y", "max"), 0.25, 1e-15);
    assert_float_equal(plain(0, "volume", NULL), 8, 0);
    assert_float_equal(plain(0, "mass", "max"), 4, 0);
}

static void test_a_point_is_followed_by_its_id(void **state) {
    (void)state;
    ab_monitor_spec spec = of_body(0, "position.x", NULL);
    spec.has_at = true;
    spec.at[0] = 2.2;
    spec.at[1] = 4.1; /* point 2 stands at (2, 4) */
    assert_float_equal(value_of(&spec, 0, NULL), 2.5, 1e-15);
    assert_float_equal(value_of(&spec, 2, NULL), 2.5, 1e-15);
    assert_true(isnan(value_of(&spec, 3, NULL)));
    static char displacement[] = "displacement.x";
    spec.value = displacement;
    assert_float_equal(value_of(&spec, 2, NULL), 0.5, 1e-15);
}

static void test_places_of_the_start(void **state) {
    (void)state;
    ab_monitor_spec spec = of_body(0, "position.x", "sum");
    spec.has_where = true;
    spec.where.has[0] = true;
    spec.where.range[0][0] = 0.5;
    spec.where.range[0][1] = 2.5; /* points 1 and 2 */
    assert_float_equal(value_of(&spec, 0, NULL), 4, 1e-15);
    spec.where = (ab_where){.side = AB_TOP};
    assert_float_equal(value_of(&spec, 0, NULL), 3.5, 1e-15);
}

static void test_rotation_rate_of_a_translation_is_zero(void **state) {
    (void)state;
    assert_float_equal(plain(0, "rotation-rate", NULL), 0, 1e-14);
}

static void test_values_of_a_contact_and_of_the_scene(void **state) {
    (void)state;
    ab_monitor_spec spec = of_body(-1, "force.y", NULL);
    spec.contact = 0;
    assert_float_equal(value_of(&spec, 0, NULL), 3.5, 1e-15);
    static char active[] = "active", pressure[] = "pressure.max", length[] = "length", total[] = "momentum.x", dt[] = "dt",
                energy[] = "energy.kinetic";
    spec.value = active;
    assert_float_equal(value_of(&spec, 0, NULL), 2, 0);
    spec.value = pressure;
    assert_float_equal(value_of(&spec, 0, NULL), 25, 1e-14);
    spec.value = length;
    assert_float_equal(value_of(&spec, 0, NULL), 0.75, 0);
    spec.contact = -1;
    spec.value = total;
    assert_float_equal(value_of(&spec, 0, NULL), 16, 1e-14);
    spec.value = dt;
    assert_float_equal(value_of(&spec, 0, NULL), 0.1, 0);
    spec.value = energy;
    assert_float_equal(value_of(&spec, 0, NULL), 9, 1e-14);
}

/* At step 5 the contact puts (1.5, 3.5) N on the plane, and 20 N m about the origin, where points stood at t = 0.4: the centres of mass at (2, 4) +
 * 0.4 (1, 0.5) (block) and (4/3, 8/3) + 0.4 (1, 0.5) (plane). */
static void test_force_on_a_body_is_the_sum_of_its_contacts(void **state) {
    (void)state;
    static const struct {
        const char *value;
        int body;
        double expected;
    } known[] = {{"force.x", 1, 1.5},
                 {"force.y", 1, 3.5},
                 {"force.x", 0, -1.5},
                 {"force.y", 0, -3.5},
                 {"moment", 1, 20 - ((4. / 3 + 0.4) * 3.5 - (8. / 3 + 0.2) * 1.5)},
                 {"moment", 0, -20 + (2.4 * 3.5 - 4.2 * 1.5)}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        const ab_monitor_spec spec = of_body(known[k].body, known[k].value, NULL);
        assert_float_equal(value_of(&spec, 0, NULL), known[k].expected, 1e-13);
    }
}

static void test_two_contacts_of_a_body_add_up(void **state) {
    (void)state;
    fake_run *run = fake_create(4, 3);
    ab_report *report = ab_report_create();
    ab_monitors *monitors = NULL;
    ab_monitor_spec specs[] = {of_body(0, "force.y", NULL), of_body(1, "force.y", NULL)};
    ab_contact_spec contacts[] = {{.body = {0, 1}}, {.body = {1, 0}}, {.body = {0, 1}}};
    const ab_contact_totals totals[] = {{.force = {0, 1}}, {.force = {0, 10}}, {.force = {0, 100}}};
    run->scene.contacts = contacts;
    run->scene.contact_count = 3;
    run->view.contacts = totals;
    run->scene.monitors = specs;
    run->scene.monitor_count = 2;
    assert_int_equal(ab_monitors_create(&run->view, &monitors, report), AB_OK);
    double on_first = 0, on_second = 0;
    assert_int_equal(ab_monitor_value(monitors, 0, &run->view, &on_first, report), AB_OK);
    assert_int_equal(ab_monitor_value(monitors, 1, &run->view, &on_second, report), AB_OK);
    assert_float_equal(on_first, -1 + 10 - 100, 0);
    assert_float_equal(on_second, 91, 0);
    ab_monitors_destroy(monitors);
    ab_report_destroy(report);
    free(run);
}

static void test_values_of_bodies_with_nodes(void **state) {
    (void)state;
    static const struct {
        const char *value;
        double expected;
    } known[] = {{"reaction.x", 1}, {"reaction.y", -1.5}, {"reaction.moment", 2.5}, {"rotation", 0.125}, {"rotation-rate", 0.25}};
    fake_run *run = fake_create(6, 3);
    ab_report *report = ab_report_create();
    ab_monitors *monitors = NULL;
    ab_monitor_spec specs[6];
    for (int k = 0; k < 5; k++) specs[k] = of_body(0, known[k].value, NULL);
    specs[5] = of_body(0, "position.x", NULL);
    specs[5].has_at = true;
    specs[5].at[0] = 1.6, specs[5].at[1] = 0.9; /* node 5 stands at (2, 1) */
    fake_mesh(run, 0);
    run->scene.grid_cell = 0; /* no grid */
    run->scene.monitors = specs;
    run->scene.monitor_count = 6;
    assert_int_equal(ab_monitors_create(&run->view, &monitors, report), AB_OK);
    fake_update(run, 5, 0.1);
    double value = 0;
    for (size_t k = 0; k < 5; k++) {
        assert_int_equal(ab_monitor_value(monitors, k, &run->view, &value, report), AB_OK);
        assert_float_equal(value, known[k].expected, 1e-14);
    }
    assert_int_equal(ab_monitor_value(monitors, 5, &run->view, &value, report), AB_OK);
    assert_float_equal(value, 2.5, 1e-14);
    assert_string_equal(ab_monitor_unit(monitors, 2), "N m");
    assert_string_equal(ab_monitor_unit(monitors, 3), "rad");
    assert_true(ab_monitor_is_cheap(monitors, 0));
    ab_monitors_destroy(monitors);
    ab_report_destroy(report);
    free(run);
}

static void test_values_of_nodes_are_refused_by_name_of_other_bodies(void **state) {
    (void)state;
    static const char *const reasons[] = {"is of fake and has no reaction", "is of fake and has no one angle", "is in no contact"};
    fake_run *run = fake_create(4, 3);
    ab_report *report = ab_report_create();
    ab_monitors *monitors = NULL;
    ab_monitor_spec specs[] = {of_body(0, "reaction.y", NULL), of_body(0, "rotation", NULL), of_body(0, "moment", NULL)};
    run->scene.contact_count = 0;
    run->scene.monitors = specs;
    run->scene.monitor_count = 3;
    assert_int_equal(ab_monitors_create(&run->view, &monitors, report), AB_BAD_INPUT);
    for (size_t k = 0; k < 3; k++) assert_non_null(strstr(ab_report_text(report, k), reasons[k]));
    ab_monitors_destroy(monitors);
    ab_report_destroy(report);
    free(run);
}

static void test_every_value_that_cannot_be_is_reported(void **state) {
    (void)state;
    fake_run *run = fake_create(4, 3);
    ab_report *report = ab_report_create();
    ab_monitors *monitors = NULL;
    ab_monitor_spec specs[] = {of_body(0, "stress.qq", NULL), of_body(0, "velocity.z", NULL), of_body(0, "energy.dark", NULL),
                               of_body(-1, "speed", NULL),    of_body(0, "position", NULL),   of_body(0, "mass", NULL)};
    run->scene.monitors = specs;
    run->scene.monitor_count = 6;
    assert_int_equal(ab_monitors_create(&run->view, &monitors, report), AB_BAD_INPUT);
    assert_int_equal(ab_report_errors(report), 5);
    ab_monitors_destroy(monitors);
    ab_report_destroy(report);
    free(run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_whole_body_values_read_no_points),
        cmocka_unit_test(test_points_are_gathered),
        cmocka_unit_test(test_a_point_is_followed_by_its_id),
        cmocka_unit_test(test_places_of_the_start),
        cmocka_unit_test(test_rotation_rate_of_a_translation_is_zero),
        cmocka_unit_test(test_values_of_a_contact_and_of_the_scene),
        cmocka_unit_test(test_force_on_a_body_is_the_sum_of_its_contacts),
        cmocka_unit_test(test_two_contacts_of_a_body_add_up),
        cmocka_unit_test(test_values_of_bodies_with_nodes),
        cmocka_unit_test(test_values_of_nodes_are_refused_by_name_of_other_bodies),
        cmocka_unit_test(test_every_value_that_cannot_be_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
