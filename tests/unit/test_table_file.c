/* test_table_file.c: settings that are tables, from text files: separators, headers, units, and every mistake at its place. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/settings.h"
#include "core/table_file.h"

static char folder[64];

static int make_folder(void **state) {
    (void)state;
    strcpy(folder, "/tmp/abut-table-XXXXXX");
    return mkdtemp(folder) == NULL;
}

static int remove_folder(void **state) {
    (void)state;
    char path[128];
    snprintf(path, sizeof path, "%s/base.csv", folder);
    unlink(path);
    return rmdir(folder);
}

typedef struct outcome { /* of one file */
    ab_reader reader;
    ab_document *document;
    ab_value value;
    bool taken;
} outcome;

static const ab_param history = {"history", "s, m s-2", "acceleration in time", NULL, AB_TABLE, AB_INCREASING, 0, 0, 0};

/* base.csv with these bytes, read as the mapping {file: base.csv, MORE}. */
static outcome read_as(const char *bytes, size_t length, const char *more, const ab_param *param) {
    outcome o = {
        .reader = {.arena = ab_arena_create(), .formulas = ab_formulas_create(), .units = ab_units_create(), .report = ab_report_create()}};
    char path[128], scene[128], text[1000];
    snprintf(path, sizeof path, "%s/base.csv", folder);
    snprintf(scene, sizeof scene, "%s/scene.yaml", folder);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fwrite(bytes, 1, length, file);
    fclose(file);
    char *kept = ab_arena_text(o.reader.arena, scene, strlen(scene));
    o.reader.scene_path = kept;
    snprintf(text, sizeof text, "{file: base.csv%s%s}", more[0] ? ", " : "", more);
    assert_int_equal(ab_document_parse(kept, text, strlen(text), &o.document, o.reader.report), AB_OK);
    o.taken = ab_table_file_read(&o.reader, param, o.document->root, "boundaries[0]", &o.value);
    assert_int_equal(o.taken, ab_report_errors(o.reader.report) == 0);
    return o;
}

static void forget(outcome *o) {
    ab_document_destroy(o->document);
    ab_report_destroy(o->reader.report);
    ab_units_destroy(o->reader.units);
    ab_formulas_destroy(o->reader.formulas);
    ab_arena_destroy(o->reader.arena);
}

/* The file is taken and these are its numbers in SI. */
static void holds(const char *bytes, const char *more, const ab_param *param, size_t rows, size_t columns, const double *wanted) {
    outcome o = read_as(bytes, strlen(bytes), more, param);
    if (!o.taken) ab_report_print(o.reader.report, stderr);
    assert_true(o.taken);
    assert_int_equal(o.value.rows, rows);
    assert_int_equal(o.value.columns, columns);
    for (size_t k = 0; k < rows * columns; k++)
        if (fabs(o.value.table[k] - wanted[k]) > 1e-14 * fabs(wanted[k]))
            fail_msg("number %zu is %.17g, not %.17g", k, o.value.table[k], wanted[k]);
    assert_string_equal(o.reader.files->name, "base.csv");
    assert_null(o.reader.files->next);
    forget(&o);
}

/* The file is refused, and line `item` of the report holds each of the texts. */
static void refused(const char *bytes, const char *more, const ab_param *param, size_t errors, size_t item, const char *first,
                    const char *second) {
    outcome o = read_as(bytes, strlen(bytes), more, param);
    assert_false(o.taken);
    const char *text = ab_report_text(o.reader.report, item);
    if (ab_report_errors(o.reader.report) != errors || text == NULL || strstr(text, first) == NULL || strstr(text, second) == NULL) {
        ab_report_print(o.reader.report, stderr);
        fail_msg("wanted %zu errors, number %zu with '%s' and '%s'", errors, item, first, second);
    }
    forget(&o);
}

static const double plain[] = {0, 1, 0.5, -2.5, 1, 0};

static void test_columns_are_apart_by_commas_semicolons_tabs_or_blanks(void **state) {
    (void)state;
    holds("0,1\n0.5,-2.5\n1,0\n", "", &history, 3, 2, plain);
    holds("0;1\n0.5;-2.5\n1;0", "", &history, 3, 2, plain);
    holds("0\t1\n0.5\t-2.5\n1\t0\n", "", &history, 3, 2, plain);
    holds("  0   1\n\n  0.5 \t -2.5  \n 1 0\n\n", "", &history, 3, 2, plain);
    holds("\xEF\xBB\xBF"
          "0,1\r\n0.5,-2.5\r\n1,0\r\n",
          "", &history, 3, 2, plain);
    holds("0,1\r0.5,-2.5\r1,0", "", &history, 3, 2, plain);
    holds("\"0\",\"1\",\n.5,-2.5E0,\n1.,0.0,\n", "", &history, 3, 2, plain); /* a separator at the end opens no column */
    holds("0 1\n0.05D+01 -25.d-1\n001.0 -0\n", "", &history, 3, 2, plain);   /* Fortran, fixed width */
    holds("# a record\n0, 1 # first\n   # nothing here\n0.5, -2.5\n#1, 1\n1, 0\n", "", &history, 3, 2, plain);
}

static void test_columns_are_chosen_by_name_or_number(void **state) {
    (void)state;
    static const char file[] = "n, \"t\", v, a\n7, 0, x, 1\n8, 0.5, y, -2.5\n9, 1, , 0\n";
    holds(file, "columns: [t, a]", &history, 3, 2, plain);
    holds(file, "columns: [2, 4]", &history, 3, 2, plain);
    holds(file, "columns: [t, 4]", &history, 3, 2, plain);
    static const double three[] = {0, 1, 7, 0.5, -2.5, 8, 1, 0, 9};
    holds(file, "columns: [t, a, n]", &history, 3, 3, three);
    refused(file, "columns: [t, A]", &history, 1, 0,
            "scene.yaml:1:31: error: boundaries[0].history.columns: ", "has no column 'A' (line 1); did you mean 'a'?");
    refused(file, "columns: [t, 5]", &history, 1, 0, "scene.yaml:1:31: error: boundaries[0].history.columns: '5': ", "has columns 1 to 4");
    refused(file, "columns: [t, 0.5]", &history, 1, 0, "has columns 1 to 4", "'0.5'");
    refused(file, "columns: [t, [a]]", &history, 1, 0, "columns[1] must be the name or the number of a column", "a list");
    refused(file, "columns: [t, t]", &history, 1, 0, "columns[1] is the first column once more, 't'", "choose another");
    refused(file, "columns: [2, t]", &history, 1, 0, "columns[1] is the first column once more, 't'", "choose another");
    refused(file, "columns: t", &history, 1, 0, "columns must be a list", "names or numbers");
    refused("t, t\n0, 1\n", "columns: [t, 2]", &history, 1, 0, "more than one column 't'", "write its number");
    refused("0, 1\n1, 2\n", "columns: [t, a]", &history, 2, 0, "has no line with names", "write the columns' numbers");
    refused(file, "column: [t, a]", &history, 4, 0, "unknown key 'column'", "did you mean 'columns'?");
}

static void test_units_come_from_the_header_or_the_scene(void **state) {
    (void)state;
    holds("t [ms], a [cm/s2]\n0, 100\n500, -250\n1000, 0\n", "", &history, 3, 2, plain);
    holds("t [ms]  a [cm s-2]\n0 100\n500 -250\n1000 0\n", "", &history, 3, 2, plain);
    holds("t (ms); a (filtered) (cm/s2)\n0; 100\n500; -250\n1000; 0\n", "columns: [t, a (filtered)]", &history, 3, 2, plain);
    holds("# recorded in 1995\n# t [ms], a [cm/s2]\n0, 100\n500, -250\n1000, 0\n", "", &history, 3, 2, plain);
    holds("# t, a\n0, 1\n0.5, -2.5\n1, 0\n", "columns: [t, a]", &history, 3, 2, plain);
    holds("t, a\n0, 100\n500, -250\n1000, 0\n", "units: [ms, cm/s2]", &history, 3, 2, plain);
    holds("t, a\n0, 100\n0.5, -250\n1, 0\n", "units: [~, \"cm s-2\"]", &history, 3, 2, plain);
    holds("a [cm/s2], t [ms]\n100, 0\n-250, 500\n0, 1000\n", "columns: [t, a], units: [ms, ~]", &history, 3, 2, plain);
    static const double gravity[] = {0, 9.80665, 1, 4.903325};
    holds("0 1\n1 0.5\n", "units: [s, gravity]", &history, 2, 2, gravity);
    refused("0 1\n1 0.5\n", "units: [s, g]", &history, 1, 0, "units: unit of column 2: the unit 'g' does not have the dimension of 'm s-2'",
            "written gravity");
    refused("t [s], a [mm/s]\n0, 1\n", "", &history, 1, 0, "base.csv:1:1: error: unit of column 2: the unit 'mm/s'",
            "dimension of 'm s-2'");
    refused("t [ms], a [m/s2]\n0, 1\n", "units: [s, m/s2]", &history, 1, 0, "units[0]: 's' here, and 'ms' in the header of",
            "(line 1); leave one of them out");
    refused("0 1\n", "units: [s]", &history, 1, 0, "has 1 units for 2 columns", "null where the column is in SI");
    refused("0 1\n", "units: s", &history, 1, 0, "units must be a list", "not a single value");
    static const double far[] = {1, 2, 3, 4, 5, 6};
    holds("1, 0.2, 30\n4, 0.5, 60\n", "units: [s, dam/s2, cm/s2]", &history, 2, 3,
          (const double[]){1, 2, 0.3, 4, 5, 0.6}); /* the last unit stands for all after it */
    holds("1 2 3 4 5 6", "", &(ab_param){"k", "1", "numbers", NULL, AB_TABLE, 0, 0, 0, 0}, 1, 6, far);
}

static void test_all_mistakes_are_told_at_their_places(void **state) {
    (void)state;
    static const char file[] = "t [s], a [m/s2]\n0, 1\n0.1, nan\n0.2\n0.2, one\n0.15, 2\n0.3, \n0.4, inf\n0.5, 0x10\n0.6, 1e999\n";
    refused(file, "", &history, 8, 0, "base.csv:3:6: error: column 2: 'nan' is not a finite number", "leave the line out");
    refused(file, "", &history, 8, 1, "base.csv:4:1: error: has 1 column; column 2 is wanted", "");
    refused(file, "", &history, 8, 2, "base.csv:5:6: error: 'one' in column 2 is not a number", "");
    refused(file, "", &history, 8, 3, "base.csv:6:1: error: column 1 has to grow from row to row: 0.15 here, and 0.2 in line 5", "");
    refused(file, "", &history, 8, 5, "base.csv:8:6: error: column 2: 'inf' is not a finite number", "");
    refused(file, "", &history, 8, 7, "base.csv:10:6: error: column 2: '1e999' is too large", "");
    refused("0, 1\n0, 2\n", "", &history, 1, 0, "base.csv:2:1: error: column 1 has to grow from row to row: 0 here, and 0 in line 1", "");
    refused("0;1\n0,1;2\n", "", &history, 1, 0, "'0,1' in column 1 is not a number; write decimal points, not commas", "base.csv:2:1");
    char many[4000] = "0 1\n";
    for (int k = 1; k < 100; k++) strcat(many, "x y\n");
    refused(many, "", &history, 11, 0, "base.csv: error: has 198 mistakes; the first 10 follow", "");
    const ab_param positive = {"depth", "m", "depths", NULL, AB_TABLE, AB_MIN_OPEN, 0, 0, INFINITY};
    refused("depth [cm]\n5\n-1\n", "", &positive, 1, 0, "base.csv:3:1: error: -0.01 in column 1 is out of the range of 'depth' (depths)",
            "");
    const ab_param pairs = {"k", "1", "pairs", NULL, AB_TABLE, AB_COLUMNS_2, 0, 0, 0};
    refused("1 2 3\n", "", &pairs, 1, 0, "has 3 columns and the setting needs 2; choose them with columns: [1, 2]", "");
    refused("1 2 3\n", "columns: [1, 2, 3]", &pairs, 1, 0, "must be a list of two names or numbers", "");
}

static void test_files_that_are_no_tables_are_refused(void **state) {
    (void)state;
    refused("", "", &history, 1, 0, "base.csv: error: has no row of numbers", "its columns apart by");
    refused("# nothing\n\n", "", &history, 1, 0, "has no row of numbers", "");
    refused("t, a\n", "", &history, 1, 0, "has no row of numbers", "");
    outcome o = read_as("\xff\xfe"
                        "0\0 \0"
                        "1\0",
                        8, "", &history);
    assert_non_null(strstr(ab_report_text(o.reader.report, 0), "is in UTF-16; save it as UTF-8"));
    forget(&o);
    o = read_as("0 1\n\0 1", 7, "", &history);
    assert_non_null(strstr(ab_report_text(o.reader.report, 0), "has a NUL character"));
    forget(&o);
}

static void test_the_file_is_looked_for_beside_the_scene(void **state) {
    (void)state;
    char path[128], text[200];
    snprintf(path, sizeof path, "%s/scene.yaml", folder);
    static const char *const names[] = {"nowhere.csv", ".", "/dev/zero", ""};
    static const char *const reasons[] = {"nowhere.csv': No such file or directory; it is looked for in the scene's folder",
                                          "is not a file of text", "'/dev/zero' is not a file of text", "is not a file of text"};
    for (size_t k = 0; k < 4; k++) {
        outcome o = {.reader = {.arena = ab_arena_create(),
                                .formulas = ab_formulas_create(),
                                .units = ab_units_create(),
                                .report = ab_report_create(),
                                .scene_path = path}};
        snprintf(text, sizeof text, "{file: \"%s\"}", names[k]);
        assert_int_equal(ab_document_parse(path, text, strlen(text), &o.document, o.reader.report), AB_OK);
        assert_false(ab_table_file_read(&o.reader, &history, o.document->root, "materials.soil", &o.value));
        const char *said = ab_report_text(o.reader.report, 0);
        if (strstr(said, reasons[k]) == NULL || strstr(said, "scene.yaml:1:8: error: materials.soil.history: ") == NULL)
            fail_msg("%s", said);
        forget(&o);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_columns_are_apart_by_commas_semicolons_tabs_or_blanks),
        cmocka_unit_test(test_columns_are_chosen_by_name_or_number),
        cmocka_unit_test(test_units_come_from_the_header_or_the_scene),
        cmocka_unit_test(test_all_mistakes_are_told_at_their_places),
        cmocka_unit_test(test_files_that_are_no_tables_are_refused),
        cmocka_unit_test(test_the_file_is_looked_for_beside_the_scene),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
