/* test_scene_reference.c: docs/scene.md is what the tables say, and its opening example is a scene. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fake_registry.h"
#include "scene_text.h"

/* The reference as text; to be freed. */
static char *reference(void) {
    FILE *stream = tmpfile();
    assert_non_null(stream);
    ab_scene_write_reference(stream);
    const long length = ftell(stream);
    assert_true(length > 0);
    char *text = calloc(1, (size_t)length + 1);
    rewind(stream);
    assert_int_equal(fread(text, 1, (size_t)length, stream), length);
    fclose(stream);
    return text;
}

static void test_the_page_in_docs_is_up_to_date(void **state) {
    (void)state;
    char path[1000];
    const char *source = getenv("ABUT_SOURCE"); /* set by ctest */
    snprintf(path, sizeof path, "%s/docs/scene.md", source == NULL ? "." : source);
    char *wanted = reference();
    char *found = calloc(1, strlen(wanted) + 2);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t length = fread(found, 1, strlen(wanted) + 1, file);
    fclose(file);
    if (length != strlen(wanted) || memcmp(wanted, found, length) != 0) print_error("docs/scene.md is old; write it anew: abut help scene > docs/scene.md\n");
    assert_int_equal(length, strlen(wanted));
    assert_memory_equal(wanted, found, length);
    free(found);
    free(wanted);
}

static void test_the_example_of_the_page_is_a_scene(void **state) {
    (void)state;
    char *text = reference(), *begin = strstr(text, "```yaml\n") + 8, *end = strstr(begin, "```");
    outcome o = read_bytes(begin, (size_t)(end - begin), NULL, 0);
    if (o.status != AB_OK) ab_report_print(o.report, stderr);
    assert_int_equal(o.status, AB_OK);
    assert_int_equal(ab_report_warnings(o.report), 0);
    forget(&o);
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_page_in_docs_is_up_to_date),
        cmocka_unit_test(test_the_example_of_the_page_is_a_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
