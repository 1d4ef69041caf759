/* The files of a run: what stands in them, while it lasts, at its end, and when the disk is full. */
#include <errno.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>
#include <hdf5.h>

#include "core/progress.h"
#include "fake_domain.h"

static char folder[4096];

static const char *path_of(const char *name) {
    static char path[4200];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static bool exists(const char *name) { return access(path_of(name), F_OK) == 0; }

static char *text_of(const char *name) { /* caller frees */
    FILE *file = fopen(path_of(name), "r");
    assert_non_null(file);
    char *text = calloc(1, 1 << 20);
    assert_non_null(text);
    fread(text, 1, (1 << 20) - 1, file);
    fclose(file);
    return text;
}

static int fresh_folder(void **state) {
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/abut_results_XXXXXX", base != NULL ? base : "/tmp");
    if (mkdtemp(folder) == NULL) return -1;
    return 0;
}

static int remove_folder(void **state) {
    (void)state;
    char command[4300];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

static void ask_for_everything(fake_run *run) {
    static char stress[] = "stress", velocity[] = "velocity", back[] = "back_stress", mass[] = "mass",
                *fields[] = {stress, velocity, back, mass};
    static char x[] = "x", tip[] = "a, \"b\"", value[] = "position.x", expect[] = "far \"enough\"", norm[] = "final",
                remainder[] = "block.kinetic";
    static ab_monitor_spec monitors[2];
    static ab_expect_spec expects[2];
    monitors[0] = (ab_monitor_spec){.name = x, .body = 0, .contact = -1, .value = value};
    monitors[1] = (ab_monitor_spec){.name = tip, .body = 1, .contact = -1, .value = value, .has_at = true};
    expects[0] = (ab_expect_spec){.name = expect, .monitor = 0, .norm = norm, .reference = {.value = 3}, .to = 1, .tolerance = 1e-12};
    expects[1] = (ab_expect_spec){
        .name = x, .monitor = SIZE_MAX, .column = remainder, .norm = norm, .reference = {.value = 3.9}, .to = 1, .tolerance = 0.01};
    run->scene.output_fields = fields;
    run->scene.output_field_count = 4;
    run->scene.has_output = true;
    run->scene.output_every = 0.5;
    run->scene.monitors = monitors;
    run->scene.monitor_count = 2;
    run->scene.expects = expects;
    run->scene.expect_count = 2;
}

static const ab_run_facts facts = {.wall_seconds = 1,
                                   .cpu_seconds = 1,
                                   .point_steps_per_second = (double)NAN,
                                   .points = 7,
                                   .steps = 10,
                                   .threads = 1,
                                   .version = "0",
                                   .outcome = "done"};

static ab_status run_steps(ab_results *results, fake_run *run, long first, long last, ab_report *report) {
    for (long step = first; step <= last; step++) {
        fake_update(run, step, 0.1);
        AB_TRY(ab_results_step(results, &run->view, report));
    }
    return AB_OK;
}

static void read_numbers(hid_t file, const char *name, double *values, size_t wanted) {
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    assert_true(set >= 0);
    const hid_t space = H5Dget_space(set);
    assert_int_equal(H5Sget_simple_extent_npoints(space), wanted);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    H5Sclose(space);
    H5Dclose(set);
}

static void check_frames(int frames) {
    const hid_t file = H5Fopen(path_of("results.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(file >= 0);
    H5G_info_t info;
    H5Gget_info(file, &info);
    assert_int_equal(info.nlinks, frames);
    for (int k = 0; k < frames; k++) {
        char name[64];
        double values[64];
        snprintf(name, sizeof name, "/frame_%06d/block/position", k);
        read_numbers(file, name, values, 12);
        assert_float_equal(values[3 * 2], 2 + 0.5 * k, 1e-14);
        assert_float_equal(values[3 * 2 + 2], 0, 0);
        snprintf(name, sizeof name, "/frame_%06d/block/stress", k);
        read_numbers(file, name, values, 24);
        static const double order[6] = {20, 40, 60, 8, 0, 0}; /* xx yy zz xy yz xz of point 1 */
        for (int c = 0; c < 6; c++) assert_float_equal(values[6 + c], order[c], 0);
        snprintf(name, sizeof name, "/frame_%06d/block/back_stress", k);
        read_numbers(file, name, values, 24);
        assert_float_equal(values[9], 8, 0);
        snprintf(name, sizeof name, "/frame_%06d/all/position", k);
        read_numbers(file, name, values, 21);
        assert_float_equal(values[3 * 5], 1 + 0.5 * k, 1e-14); /* the plane's second point */
        snprintf(name, sizeof name, "/frame_%06d/all/body", k);
        read_numbers(file, name, values, 7);
        assert_float_equal(values[3], 0, 0);
        assert_float_equal(values[4], 1, 0);
        snprintf(name, sizeof name, "/frame_%06d/all/id", k);
        read_numbers(file, name, values, 7);
        assert_float_equal(values[6], 2, 0);
    }
    const hid_t set = H5Dopen2(file, "/frame_000000/plane/velocity", H5P_DEFAULT), unit = H5Aopen(set, "unit", H5P_DEFAULT),
                type = H5Aget_type(unit);
    char text[32] = "";
    assert_true(H5Aread(unit, type, text) >= 0);
    assert_string_equal(text, "m s-1");
    assert_true(H5Aexists(set, "components") > 0);
    H5Tclose(type);
    H5Aclose(unit);
    H5Dclose(set);
    H5Fclose(file);
}

static void test_a_whole_run(void **state) {
    (void)state;
    fake_run *run = fake_create(4, 3);
    ab_report *report = ab_report_create();
    ab_results *results = NULL;
    size_t missed = 9;
    ask_for_everything(run);
    assert_int_equal(ab_results_open(folder, &run->scene, &run->view, &results, report), AB_OK);
    assert_int_equal(run_steps(results, run, 0, 6, report), AB_OK);
    check_frames(2); /* readable while the run lasts */
    assert_true(exists("frames/frame_000001.h5"));
    assert_false(exists("frames/frame_000001.h5.part"));
    assert_int_equal(run_steps(results, run, 7, 10, report), AB_OK);
    assert_int_equal(ab_results_frame(results, &run->view, report), AB_OK); /* written already: not a second time */
    FILE *table = fopen(path_of("table.txt"), "w");
    ab_results_table(results, &run->view, &facts, table);
    fclose(table);
    assert_int_equal(ab_results_close(results, &run->view, &facts, &missed, report), AB_OK);
    ab_results_destroy(results);
    assert_int_equal(ab_report_warnings(report), 0);
    assert_int_equal(missed, 1);
    check_frames(3);
    assert_false(exists("frames")); /* one file, whole in itself */
    assert_true(exists("results_block.xdmf"));
    assert_false(exists("results.h5.part"));

    char *history = text_of("history.csv");
    assert_memory_equal(
        history, "t,step,dt,kinetic,strain,potential,plastic,friction,contact,boundary,damping,external,remainder,block.kinetic,", 110);
    assert_non_null(strstr(history, ",plane.external,x,\"a, \"\"b\"\"\"\n0,0,"));
    size_t lines = 0;
    for (const char *c = history; *c != '\0'; c++) lines += *c == '\n';
    assert_int_equal(lines, 12);
    free(history);

    char *summary = text_of("summary.json");
    assert_non_null(strstr(summary, "\"point_steps_per_second\": null"));
    assert_non_null(strstr(summary, "\"name\": \"far \\\"enough\\\"\", \"monitor\": \"x\", \"norm\": \"final\", \"value\": 3"));
    assert_non_null(strstr(summary, "\"error\": 0.025641025641025"));
    free(summary);
    char *lined = text_of("table.txt");
    assert_non_null(strstr(lined, "MISS"));
    for (const char *line = lined; line != NULL && *line != '\0';) {
        const char *end = strchr(line, '\n');
        if (end == NULL) break;
        if (strstr(line, "results in") != line + 2) assert_true(end - line <= 100);
        line = end + 1;
    }
    free(lined);
    char *xdmf = text_of("results.xdmf");
    assert_non_null(strstr(xdmf, "Two &lt;bodies&gt; &amp; &quot;more&quot;"));
    free(xdmf);
    ab_report_destroy(report);
    free(run);
}

static void test_nothing_is_written_for_a_wrong_scene(void **state) {
    (void)state;
    fake_run *run = fake_create(4, 3);
    ab_report *report = ab_report_create();
    ab_results *results = NULL;
    char elsewhere[4300], spin[] = "spin", velocity[] = "velocity", charge[] = "charge", *fields[] = {spin, velocity, charge};
    ask_for_everything(run);
    run->scene.output_fields = fields;
    run->scene.output_field_count = 3;
    snprintf(elsewhere, sizeof elsewhere, "%s/deep/er", folder);
    assert_int_equal(ab_results_open(elsewhere, &run->scene, &run->view, &results, report), AB_BAD_INPUT);
    assert_null(results);
    assert_false(exists("deep"));
    assert_non_null(strstr(ab_report_text(report, 0), "spin"));
    assert_non_null(strstr(ab_report_text(report, 1), "charge")); /* the others are looked for all the same */
    ab_report_destroy(report);
    free(run);
}

static void test_history_alone_when_no_output_is_asked_for(void **state) {
    (void)state;
    fake_run *run = fake_create(4, 3);
    ab_report *report = ab_report_create();
    ab_results *results = NULL;
    size_t missed = 9;
    run->scene.history_every = 4;
    assert_int_equal(ab_results_open(path_of("deep/er/"), &run->scene, &run->view, &results, report), AB_OK);
    assert_int_equal(run_steps(results, run, 0, 10, report), AB_OK);
    assert_int_equal(ab_results_close(results, &run->view, &facts, &missed, report), AB_OK);
    ab_results_destroy(results);
    assert_int_equal(missed, 0);
    assert_false(exists("deep/er/results.h5"));
    char *history = text_of("deep/er/history.csv");
    assert_non_null(strstr(history, "\n1,10,")); /* the last step has its row, due or not */
    size_t lines = 0;
    for (const char *c = history; *c != '\0'; c++) lines += *c == '\n';
    assert_int_equal(lines, 5); /* header, 0, 4, 8, 10 */
    free(history);
    ab_report_destroy(report);
    free(run);
}

static void check_elements(const char *name, size_t count, const double *wanted) {
    const hid_t file = H5Fopen(path_of("results.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    double values[16];
    read_numbers(file, name, values, count);
    for (size_t k = 0; k < count; k++) assert_float_equal(values[k], wanted[k], 0);
    H5Fclose(file);
}

static bool in_results(const char *name) {
    const hid_t file = H5Fopen(path_of("results.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    const bool is = H5Lexists(file, name, H5P_DEFAULT) > 0;
    H5Fclose(file);
    return is;
}

static void check_text(const char *name, const char *wanted) {
    char *text = text_of(name);
    if (strstr(text, wanted) == NULL) fail_msg("'%s' is not in %s", wanted, name);
    free(text);
}

static void test_elements_are_shown_as_such(void **state) {
    (void)state;
    static const double eight[8] = {0, 2, 4, 6, 1, 3, 5, 7}, four[8] = {0, 2, 3, 1, 2, 4, 5, 3};
    fake_run *run = fake_create(8, 6);
    ab_report *report = ab_report_create();
    ab_results *results = NULL;
    size_t missed = 9;
    fake_mesh(run, 0), fake_mesh(run, 1);
    ask_for_everything(run);
    assert_int_equal(ab_results_open(folder, &run->scene, &run->view, &results, report), AB_OK);
    assert_int_equal(run_steps(results, run, 0, 10, report), AB_OK);
    assert_int_equal(ab_results_close(results, &run->view, &facts, &missed, report), AB_OK);
    ab_results_destroy(results);
    check_elements("/frame_000000/block/connectivity", 8, eight);
    check_elements("/frame_000000/plane/connectivity", 8, four);
    assert_false(in_results("/frame_000001/block/connectivity")); /* once */
    assert_false(in_results("/frame_000000/block/vertices"));
    assert_true(in_results("/frame_000000/all/vertices"));
    check_text("results_block.xdmf", "TopologyType=\"Quadrilateral_8\" NumberOfElements=\"1\">");
    check_text("results_block.xdmf", "Dimensions=\"1 8\" Format=\"HDF\">results.h5:/frame_000000/block/connectivity<");
    check_text("results_block.xdmf", "Dimensions=\"8 3\" Format=\"HDF\">results.h5:/frame_000002/block/position<");
    check_text("results_plane.xdmf", "TopologyType=\"Quadrilateral\" NumberOfElements=\"2\">");
    check_text("results_plane.xdmf", "Dimensions=\"2 4\" Format=\"HDF\">results.h5:/frame_000000/plane/connectivity<");
    check_text("results.xdmf", "TopologyType=\"Polyvertex\" NumberOfElements=\"14\"");
    ab_report_destroy(report);
    free(run);
}

static void test_a_body_of_elements_alone_has_its_own_file(void **state) {
    (void)state;
    fake_run *run = fake_create(6, 3);
    ab_report *report = ab_report_create();
    run->scene.body_count = 1;
    run->scene.contact_count = 0;
    run->scene.has_output = true;
    for (int meshed = 0; meshed < 2; meshed++) { /* a cloud alone is in results.xdmf already */
        ab_results *results = NULL;
        size_t missed = 9;
        if (meshed) fake_mesh(run, 0);
        assert_int_equal(ab_results_open(folder, &run->scene, &run->view, &results, report), AB_OK);
        assert_int_equal(run_steps(results, run, 0, 3, report), AB_OK);
        assert_int_equal(ab_results_close(results, &run->view, &facts, &missed, report), AB_OK);
        ab_results_destroy(results);
        assert_true(exists("results.xdmf"));
        assert_int_equal(exists("results_block.xdmf"), meshed);
    }
    check_text("results_block.xdmf", "NumberOfElements=\"2\">");
    ab_report_destroy(report);
    free(run);
}

/* The head of the closing table and the costs in summary.json. */
static void check_speed(const ab_run_facts *what, const char *head, const char *speed, const char *summary) {
    fake_run *run = fake_create(6, 3);
    ab_report *report = ab_report_create();
    ab_results *results = NULL;
    size_t missed = 9;
    assert_int_equal(ab_results_open(folder, &run->scene, &run->view, &results, report), AB_OK);
    FILE *table = fopen(path_of("table.txt"), "w");
    ab_results_table(results, &run->view, what, table);
    fclose(table);
    assert_int_equal(ab_results_close(results, &run->view, what, &missed, report), AB_OK);
    ab_results_destroy(results);
    check_text("table.txt", head);
    check_text("table.txt", speed);
    check_text("summary.json", summary);
    ab_report_destroy(report);
    free(run);
}

static void test_points_and_elements_are_counted_apart(void **state) {
    (void)state;
    ab_run_facts both = facts;
    both.nodes = 9, both.elements = 2;
    both.point_steps_per_second = 3e6, both.element_steps_per_second = 5e5;
    check_speed(&both, "10 steps of 7 points and 2 elements in 1 s\n",
                "\n  3 million point-steps and 0.5 million element-steps per second\n",
                "\"points\": 7,\n  \"nodes\": 9,\n  \"elements\": 2,");
    both.points = 0;
    check_speed(&both, "10 steps of 2 elements in 1 s\n", "\n  0.5 million element-steps per second\n",
                "\"element_steps_per_second\": 500000");
    both.rigid = 1;
    check_speed(&both, "10 steps of 2 elements and 1 rigid body in 1 s\n", "\n  0.5 million element-steps per second\n",
                "\"rigid_bodies\": 1,");
    both.points = 7, both.rigid = 2;
    check_speed(&both, "10 steps of 7 points, 2 elements and 2 rigid bodies in 1 s\n", "element-steps", "\"rigid_bodies\": 2,");
    both.points = both.elements = 0;
    check_speed(&both, "10 steps of 2 rigid bodies in 1 s\n", "\n  0.01 thousand steps per second\n", "\"points\": 0,");
    both.points = 7, both.elements = both.rigid = 0;
    check_speed(&both, "10 steps of 7 points in 1 s\n", "\n  3 million point-steps per second\n", "\"elements\": 0,");
}

static void test_the_alarm_names_remedies_for_the_bodies_there_are(void **state) {
    (void)state;
    static const char *const remedies[] = {"a finer grid, or a smaller dt",
                                           "a finer grid, more elements, or a smaller dt", "build on; more elements, or a smaller dt"};
    for (int meshes = 0; meshes < 3; meshes++) {
        fake_run *run = fake_create(6, 8);
        ab_report *report = ab_report_create();
        ab_results *results = NULL;
        size_t missed = 9;
        for (int b = 0; b < meshes; b++) fake_mesh(run, b);
        assert_int_equal(ab_results_open(folder, &run->scene, &run->view, &results, report), AB_OK);
        assert_int_equal(run_steps(results, run, 0, 3, report), AB_OK);
        run->view.remainder = 1;
        assert_int_equal(ab_results_close(results, &run->view, &facts, &missed, report), AB_OK);
        ab_results_destroy(results);
        assert_int_equal(ab_report_warnings(report), 1);
        assert_non_null(strstr(ab_report_text(report, 0), remedies[meshes]));
        ab_report_destroy(report);
        free(run);
    }
}

static void test_points_that_left(void **state) {
    (void)state;
    fake_run *run = fake_create(4, 3);
    ab_report *report = ab_report_create();
    ab_results *results = NULL;
    size_t missed = 9;
    ask_for_everything(run);
    run->scene.side[AB_RIGHT] = AB_SIDE_OUTFLOW;
    assert_int_equal(ab_results_open(folder, &run->scene, &run->view, &results, report), AB_OK);
    assert_int_equal(run_steps(results, run, 0, 0, report), AB_OK);
    run->domains[0].lost = 4; /* nothing is left of the block */
    run->domains[1].lost = 1;
    assert_int_equal(run_steps(results, run, 1, 10, report), AB_OK);
    assert_int_equal(ab_results_close(results, &run->view, &facts, &missed, report), AB_OK);
    ab_results_destroy(results);
    const hid_t file = H5Fopen(path_of("results.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    double values[12];
    read_numbers(file, "/frame_000000/all/id", values, 7);
    read_numbers(file, "/frame_000002/all/id", values, 2);
    assert_float_equal(values[0], 1, 0);
    read_numbers(file, "/frame_000001/all/vertices", values, 2);
    read_numbers(file, "/frame_000001/block/position", values, 0);
    H5Fclose(file);
    char *history = text_of("history.csv");
    assert_non_null(strstr(history, "external,outflow,remainder"));
    free(history);
    ab_report_destroy(report);
    free(run);
}

/* A disk that is full: every write that would make a file larger than `bytes` fails. */
static void limit_files(rlim_t bytes) {
    struct rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = bytes < limit.rlim_max ? bytes : limit.rlim_max;
    setrlimit(RLIMIT_FSIZE, &limit);
}

static void test_a_full_disk_takes_nothing_back(void **state) {
    (void)state;
    fake_run *run = fake_create(4, 3);
    ab_report *report = ab_report_create();
    ab_results *results = NULL;
    size_t missed = 9;
    ask_for_everything(run);
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(ab_results_open(folder, &run->scene, &run->view, &results, report), AB_OK);
    assert_int_equal(run_steps(results, run, 0, 6, report), AB_OK);
    limit_files(3000);
    const ab_status status = run_steps(results, run, 7, 10, report);
    const ab_status closed = ab_results_close(results, &run->view, &facts, &missed, report);
    limit_files(RLIM_INFINITY);
    assert_int_equal(status, AB_FAILED);
    assert_int_equal(closed, AB_FAILED);
    assert_true(ab_report_errors(report) >= 1);
    assert_non_null(strstr(ab_report_text(report, 0), strerror(EFBIG)));
    ab_results_destroy(results);
    check_frames(2);
    assert_false(exists("results.h5.part"));
    assert_false(exists("frames/frame_000002.h5.part"));
    char *history = text_of("history.csv");
    assert_non_null(strstr(history, "\n0.5,5,"));
    free(history);
    ab_report_destroy(report);
    free(run);
}

static void test_no_room_to_gather_keeps_the_links(void **state) {
    (void)state;
    fake_run *run = fake_create(4, 3);
    ab_report *report = ab_report_create();
    ab_results *results = NULL;
    size_t missed = 9;
    ask_for_everything(run);
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(ab_results_open(folder, &run->scene, &run->view, &results, report), AB_OK);
    assert_int_equal(run_steps(results, run, 0, 10, report), AB_OK);
    assert_int_equal(ab_results_frame(results, &run->view, report), AB_OK);
    limit_files(100000); /* a frame fits, three together with the room set aside do not */
    assert_int_equal(ab_results_close(results, &run->view, &facts, &missed, report), AB_OK);
    limit_files(RLIM_INFINITY);
    assert_int_equal(ab_report_warnings(report), 1);
    ab_results_destroy(results);
    check_frames(3);
    assert_true(exists("frames/frame_000002.h5"));
    ab_report_destroy(report);
    free(run);
}

static void test_an_earlier_run_is_replaced(void **state) {
    test_a_full_disk_takes_nothing_back(state); /* leaves frames/ behind */
    test_a_whole_run(state);
    test_a_whole_run(state);
}

static void test_without_a_rhythm_the_first_and_the_last_frame(void **state) {
    (void)state;
    fake_run *run = fake_create(4, 3);
    ab_report *report = ab_report_create();
    ab_results *results = NULL;
    size_t missed = 9;
    ask_for_everything(run);
    run->scene.output_every = 0;
    assert_int_equal(ab_results_open(folder, &run->scene, &run->view, &results, report), AB_OK);
    assert_int_equal(run_steps(results, run, 0, 5, report), AB_OK);
    assert_int_equal(ab_results_close(results, &run->view, &facts, &missed, report), AB_OK);
    ab_results_destroy(results);
    check_frames(2); /* the last at t = 0.5, as the second of a whole run */
    ab_report_destroy(report);
    free(run);
}

static void test_progress_fits_the_terminal(void **state) {
    (void)state;
    fake_run *run = fake_create(4, 3);
    ab_progress progress;
    char line[512];
    ab_progress_begin(&progress, stderr, false, 1, 7);
    progress.terminal = true;
    fake_update(run, 5, 0.1);
    for (int width = 1; width < 250; width++) {
        ab_progress_format(&progress, &run->view, width, line, sizeof line);
        assert_true((int)strlen(line) <= width);
    }
    assert_non_null(strstr(line, " 50 % ##########.........."));
    assert_non_null(strstr(line, "wave speed"));
    free(run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_a_whole_run, fresh_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_nothing_is_written_for_a_wrong_scene, fresh_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_history_alone_when_no_output_is_asked_for, fresh_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_elements_are_shown_as_such, fresh_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_a_body_of_elements_alone_has_its_own_file, fresh_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_points_and_elements_are_counted_apart, fresh_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_the_alarm_names_remedies_for_the_bodies_there_are, fresh_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_points_that_left, fresh_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_a_full_disk_takes_nothing_back, fresh_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_no_room_to_gather_keeps_the_links, fresh_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_an_earlier_run_is_replaced, fresh_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_without_a_rhythm_the_first_and_the_last_frame, fresh_folder, remove_folder),
        cmocka_unit_test(test_progress_fits_the_terminal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
