/* test_document.c: what a file may be, what it may not, and that a hostile one is refused quickly. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/document.h"

/* Parses; true when it is refused with the piece in the message, or, with piece NULL, accepted. */
static bool parses(const char *bytes, size_t length, const char *piece) {
    ab_report *report = ab_report_create();
    ab_document *document = NULL;
    const ab_status status = ab_document_parse("f.yaml", bytes, length, &document, report);
    const char *text = ab_report_text(report, 0);
    bool good = piece == NULL ? status == AB_OK && text == NULL : text != NULL && strstr(text, piece) != NULL;
    if (!good) fprintf(stderr, "expected: %s\ngot: %s\n", piece == NULL ? "no error" : piece, text == NULL ? "no error" : text);
    ab_document_destroy(document);
    ab_report_destroy(report);
    return good;
}

static bool text_parses(const char *text, const char *piece) { return parses(text, strlen(text), piece); }

static char *repeated(const char *piece, size_t times) {
    const size_t n = strlen(piece);
    char *text = malloc(n * times + 1);
    for (size_t i = 0; i < times; i++) memcpy(text + i * n, piece, n);
    text[n * times] = '\0';
    return text;
}

static void test_every_value_knows_its_place(void **state) {
    (void)state;
    const char *text = "a: 1\nb:\n  - {c: \"x\"}\n";
    ab_report *report = ab_report_create();
    ab_document *document = NULL;
    assert_int_equal(ab_document_parse("f.yaml", text, strlen(text), &document, report), AB_OK);
    const ab_node *b = ab_node_find(document->root, "b");
    assert_int_equal(b->kind, AB_NODE_LIST);
    const ab_node *c = ab_node_find(b->items[0], "c");
    assert_string_equal(c->text, "x");
    assert_false(c->plain);
    assert_int_equal(c->mark.line, 3);
    assert_int_equal(c->mark.column, 9);
    assert_int_equal(b->items[0]->entries[0].mark.column, 6);
    assert_null(ab_node_find(document->root, "z"));
    ab_document_destroy(document);
    ab_report_destroy(report);
}

static void test_what_is_not_a_scene_file_is_refused_by_name(void **state) {
    (void)state;
    assert_true(text_parses("", "the file is empty"));
    assert_true(text_parses("# only a comment\n", "the file is empty"));
    assert_true(text_parses("a: 1\n---\nb: 2\n", "f.yaml:2:1: error: a second document begins here"));
    assert_true(text_parses("a: 1\nb: 2\na: 3\n", "f.yaml:3:1: error: key 'a' stands twice; it was given in line 1"));
    assert_true(text_parses("a: [1, 2\nb: 3\n", "not YAML"));
    assert_true(text_parses("a: 'x\n", "not YAML"));
    assert_true(text_parses("a: \tb: c: d\n", "not YAML"));
    assert_true(text_parses("a: !!python/object:os.system x\n", "tags are not used"));
    assert_true(text_parses("a: &x 1\n<<: *x\n", "merge keys"));
    assert_true(text_parses("? [a]\n: 1\n", "a key must be a plain word"));
    assert_true(text_parses("\"\": 1\n", "an empty key"));
    assert_true(text_parses("a: *b\n", "alias '*b' has no anchor"));
    assert_true(text_parses("a: &b [*b]\n", "would contain itself"));
    assert_true(text_parses("&b a: {c: *b}\n", NULL));
    assert_true(text_parses("a: &b {c: *b}\n", "would contain itself"));
    assert_true(parses("a: 1\0b\n", 7, "f.yaml:1:5: error: a NUL character"));
    assert_true(parses("a: 1\nb: \xff\n", 10, "f.yaml:2:4: error: byte 0xFF is not UTF-8"));
    assert_true(parses("a: \xc0\xaf\n", 6, "is not UTF-8"));
    assert_true(parses("a: \xed\xa0\x80\n", 7, "is not UTF-8"));
    assert_true(parses("\xff\xfe" "a\0", 4, "UTF-16"));
    assert_true(text_parses("a: \033[31m\n", "control character 0x1B"));
    assert_true(text_parses("a: \"x\\0y\"\n", "a NUL character inside a text"));
    assert_true(text_parses("\xef\xbb\xbf" "a: \xc3\xa9\nb: 1\n", NULL));
    assert_true(text_parses("\xef\xbb\xbf" "a: 1\na: 2\n", "f.yaml:2:1: error: key 'a' stands twice"));
    assert_true(text_parses("a:\n\tb: 1\n", "f.yaml:2:1: error: not YAML: a tab; indent with spaces"));
    assert_true(text_parses("a:\n  b: 1\n \tc: 1\n", "a tab; indent with spaces"));
    assert_true(text_parses("a: &x [1, 2]\nb: *x\n", NULL));
    assert_true(text_parses("a: 1\r\nb: 2\r\n", NULL));
}

static void test_folders_and_missing_files_are_said(void **state) {
    (void)state;
    ab_report *report = ab_report_create();
    ab_document *document = NULL;
    assert_int_equal(ab_document_read("/tmp", &document, report), AB_BAD_INPUT);
    assert_int_equal(ab_document_read("/no/such/scene.yaml", &document, report), AB_BAD_INPUT);
    assert_non_null(strstr(ab_report_text(report, 0), "is a folder"));
    assert_non_null(strstr(ab_report_text(report, 1), "No such file"));
    ab_report_destroy(report);
}

static void test_hostile_files_are_refused_quickly(void **state) {
    (void)state;
    const clock_t start = clock();
    assert_true(text_parses("a: &a [x,x,x,x,x,x,x,x,x,x]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a,*a]\nc: &c [*b,*b,*b,*b,*b,*b,*b,*b,*b,*b]\n"
                            "d: &d [*c,*c,*c,*c,*c,*c,*c,*c,*c,*c]\ne: &e [*d,*d,*d,*d,*d,*d,*d,*d,*d,*d]\nf: &f [*e,*e,*e,*e,*e,*e,*e,*e,*e,*e]\n"
                            "g: [*f,*f,*f,*f,*f,*f,*f,*f,*f,*f]\n", "with its aliases written out"));
    static const char *const pieces[] = {"[", "{a: ", "- ", "? ", "a:\n - ", "[{a: "};
    for (size_t i = 0; i < sizeof pieces / sizeof pieces[0]; i++) {
        char *text = repeated(pieces[i], 200000);
        assert_true(parses(text, strlen(text), "error"));
        free(text);
    }
    char *text = repeated("- 1\n", 600000);
    assert_true(text_parses(text, "more than 500000 values"));
    free(text);
    text = repeated("- &a 1\n", 2000);
    assert_true(text_parses(text, "more than 1000 anchors"));
    free(text);
    text = repeated("x", 20000);
    assert_true(text_parses(text, "the longest allowed is 16384"));
    free(text);
    text = repeated("x", (16 << 20) + 1);
    assert_true(text_parses(text, "the largest scene allowed is 16 MiB"));
    free(text);
    text = malloc(1 << 20);
    size_t used = 0;
    for (int i = 0; i < 3000; i++) used += (size_t)sprintf(text + used, "k%d: 1\n", i);
    assert_true(text_parses(text, "more than 1000 keys"));
    free(text);
    assert_true((double)(clock() - start) / CLOCKS_PER_SEC < 20); /* generous: sanitizers, a busy machine */
}

typedef struct setting {
    const char *path, *value, *said; /* said NULL: accepted */
} setting;

static void test_set_changes_one_value_or_says_why_not(void **state) {
    (void)state;
    static const char text[] = "constants: {mu: 0.1}\nbodies:\n  block: &b {fill: {rule: regular}}\n  plane: *b\ncontact:\n  - {friction: 0.1}\ngravity: [0, -9.81]\n";
    static const setting settings[] = {
        {"constants.mu", "0.2", NULL},
        {"contact[0].friction", "2*mu", NULL},
        {"bodies.block.fill.per_cell", "16", NULL},
        {"gravity[1]", "0", NULL},
        {"gravity", "[0, 1]", NULL},
        {"damping.local", "0.1", NULL},
        {"grid.sides", "{bottom: roller}", NULL},
        {"contact[1].friction", "0", "--set: error: contact[1].friction: 'contact' has 1 entries, [0] to [0]"},
        {"bodies.blok.fill", "1", "there is no 'blok' in 'bodies'; did you mean 'block'?"},
        {"a[99].b", "1", "--set: error: a[99].b: there is no 'a' at the top level"},
        {"gravity.y", "1", "'gravity' is a list [...], so it has no key 'y'; write [0]"},
        {"constants.mu.x", "1", "'constants.mu' is a single value, so it has no key 'x'"},
        {"constants[0]", "1", "'constants' is a mapping {...}, so it has no [0]"},
        {"contact[0]x", "1", "'.' is missing at character 11"},
        {"contact[x]", "1", "after '[' a number"},
        {"contact[99999999999]", "1", "after '[' a number"},
        {"contact.", "1", "a key is missing after '.'"},
        {".a", "1", "a key is missing at character 1"},
        {"", "1", "the path is empty"},
        {"a", "", "the value after '=' is missing"},
        {"a", "[1", "the value '[1' cannot be read"},
        {"a", "1\n---\n2", "a second document"},
        {"a", "*x", "has no anchor"},
    };
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++) {
        ab_report *report = ab_report_create();
        ab_document *document = NULL;
        assert_int_equal(ab_document_parse("f.yaml", text, sizeof text - 1, &document, report), AB_OK);
        const ab_status status = ab_document_set(document, settings[i].path, settings[i].value, report);
        const char *said = ab_report_text(report, 0);
        if (settings[i].said == NULL) {
            assert_int_equal(status, AB_OK);
            assert_null(said);
        } else {
            if (said == NULL || strstr(said, settings[i].said) == NULL) fprintf(stderr, "%s: %s\n", settings[i].path, said == NULL ? "accepted" : said);
            assert_non_null(said);
            assert_non_null(strstr(said, settings[i].said));
            assert_int_equal(status, AB_BAD_INPUT);
        }
        if (i == 2) { /* an alias is a value of its own */
            assert_non_null(ab_node_find(ab_node_find(ab_node_find(ab_node_find(document->root, "bodies"), "block"), "fill"), "per_cell"));
            assert_null(ab_node_find(ab_node_find(ab_node_find(ab_node_find(document->root, "bodies"), "plane"), "fill"), "per_cell"));
        }
        ab_document_destroy(document);
        ab_report_destroy(report);
    }
}

/* Small damages in many places of a real text: never a crash, and always an answer. */
static void test_damaged_files_are_answered(void **state) {
    (void)state;
    static const char text[] = "abut: 1\nconstants: {mu: 0.1, \"E\": 2e6}\nbodies:\n  block: &b {fill: {rule: 'regular'}, at: [[1, 2], [3, 4]]}\n  plane: *b # a comment\nlist:\n  - x\n  - >\n    folded\n  - |\n    kept\n";
    static const char bytes[] = "[]{}&*!|>'\"%@`#:-?,\n\t\\~ \xc3\x80x9";
    char copy[sizeof text];
    uint32_t random = 12345;
    for (int i = 0; i < 4000; i++) {
        memcpy(copy, text, sizeof text);
        size_t length = sizeof text - 1;
        for (int k = 0; k < 1 + i % 4; k++) {
            random = random * 1664525u + 1013904223u;
            copy[(random >> 8) % length] = bytes[(random >> 20) % (sizeof bytes - 1)];
        }
        if (i % 5 == 0) length = (random >> 10) % length;
        ab_report *report = ab_report_create();
        ab_document *document = NULL;
        const ab_status status = ab_document_parse("f.yaml", copy, length, &document, report);
        assert_true((status == AB_OK) == (document != NULL));
        assert_true(status == AB_OK || ab_report_errors(report) > 0);
        ab_document_destroy(document);
        ab_report_destroy(report);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_value_knows_its_place),
        cmocka_unit_test(test_what_is_not_a_scene_file_is_refused_by_name),
        cmocka_unit_test(test_folders_and_missing_files_are_said),
        cmocka_unit_test(test_hostile_files_are_refused_quickly),
        cmocka_unit_test(test_set_changes_one_value_or_says_why_not),
        cmocka_unit_test(test_damaged_files_are_answered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
