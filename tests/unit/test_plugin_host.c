/* test_plugin_host.c: the search path, lazy loading, the look into the file, the checks of the tables, the services. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/plugin_check.h"
#include "core/plugin_host.h"

static char built_in[4096]; /* <build>/plugins, absolute */

static void expect_text(const ab_report *report, const char *text) {
    for (size_t i = 0; ab_report_text(report, i); i++)
        if (strstr(ab_report_text(report, i), text)) return;
    fail_msg("the report does not say '%s' but '%s'", text, ab_report_text(report, 0) ? ab_report_text(report, 0) : "nothing");
}

static ab_registry *open_registry(const char *paths, ab_report *report) {
    ab_registry *registry = NULL;
    assert_int_equal(ab_registry_create(paths, &registry, report), AB_OK);
    return registry;
}

static void test_nothing_is_loaded_that_was_not_asked_for(void **state) {
    (void)state;
    ab_report *report = ab_report_create();
    ab_registry *registry = open_registry(built_in, report);
    assert_int_equal(ab_registry_count(registry), 0);
    const ab_loaded_class *found = ab_registry_find(registry, AB_MATERIAL, "linear-elastic", AB_NOWHERE, report);
    assert_non_null(found);
    assert_int_equal(ab_registry_count(registry), 1);
    assert_string_equal(found->class_.name, "linear-elastic");
    assert_int_equal(found->class_.struct_size, sizeof(ab_class));
    assert_non_null(found->material.update);
    assert_null(found->contact.find);
    assert_null(found->contact.respond);
    assert_null(found->boundary.apply);
    assert_memory_equal(found->path, built_in, strlen(built_in));
    assert_ptr_equal(found, ab_registry_find(registry, AB_MATERIAL, "linear-elastic", AB_NOWHERE, report));
    assert_int_equal(ab_report_errors(report), 0);
    ab_registry_destroy(registry);
    ab_report_destroy(report);
}

static void test_classes_come_in_order_of_kind_and_name(void **state) {
    (void)state;
    ab_report *report = ab_report_create();
    ab_registry *registry = open_registry(built_in, report);
    assert_int_equal(ab_registry_load_all(registry, report), AB_OK);
    const size_t count = ab_registry_count(registry);
    assert_true(count >= 3);
    for (size_t i = 1; i < count; i++) {
        const ab_class *before = &ab_registry_class(registry, i - 1)->class_, *after = &ab_registry_class(registry, i)->class_;
        assert_true(before->kind < after->kind || (before->kind == after->kind && strcmp(before->name, after->name) < 0));
    }
    assert_null(ab_registry_class(registry, count));
    ab_registry_destroy(registry);
    ab_report_destroy(report);
}

static void test_a_folder_named_twice_offers_nothing_twice(void **state) {
    (void)state;
    char paths[3 * sizeof built_in + 64];
    ab_report *report = ab_report_create();
    snprintf(paths, sizeof paths, "%s::%s/:%s/material", built_in, built_in, built_in);
    ab_registry *registry = open_registry(paths, report);
    assert_int_equal(ab_registry_load_all(registry, report), AB_OK);
    assert_non_null(ab_registry_find(registry, AB_MATERIAL, "von-mises", AB_NOWHERE, report));
    ab_registry_destroy(registry);
    ab_report_destroy(report);
}

static void test_what_is_not_found_names_the_nearest_and_the_folders(void **state) {
    (void)state;
    ab_report *report = ab_report_create();
    ab_registry *registry = open_registry(built_in, report);
    assert_null(ab_registry_find(registry, AB_MATERIAL, "linear-elastc", (ab_mark){"scene.yaml", 3, 9}, report));
    expect_text(report, "scene.yaml:3:9: error: no material model 'linear-elastc'; did you mean 'linear-elastic'? looked in: ");
    expect_text(report, built_in);
    assert_null(ab_registry_find(registry, AB_CONTACT, "linear-elastic", AB_NOWHERE, report)); /* another kind */
    assert_null(ab_registry_find(registry, AB_MATERIAL, "", AB_NOWHERE, report));
    assert_null(ab_registry_find(registry, AB_MATERIAL, "../../../etc/passwd", AB_NOWHERE, report));
    ab_registry_destroy(registry);
    ab_report_destroy(report);
}

static void test_an_empty_entry_is_not_the_working_directory(void **state) {
    (void)state;
    char before[4096], folder[sizeof built_in + 16];
    ab_report *report = ab_report_create();
    assert_non_null(getcwd(before, sizeof before));
    snprintf(folder, sizeof folder, "%s/material", built_in);
    assert_int_equal(chdir(folder), 0);
    ab_registry *registry = open_registry("::", report);
    const ab_loaded_class *found = ab_registry_find(registry, AB_MATERIAL, "linear-elastic", AB_NOWHERE, report);
    if (found) assert_memory_not_equal(found->path, built_in, strlen(built_in)); /* an installed one may be there */
    ab_registry_destroy(registry);
    registry = open_registry(".", report); /* named */
    found = ab_registry_find(registry, AB_MATERIAL, "linear-elastic", AB_NOWHERE, report);
    assert_non_null(found);
    assert_int_equal(found->path[0], '/');
    assert_int_equal(chdir(before), 0);
    ab_registry_destroy(registry);
    ab_report_destroy(report);
}

static void test_a_named_folder_must_be_there(void **state) {
    (void)state;
    ab_report *report = ab_report_create();
    ab_registry *registry = (ab_registry *)built_in;
    assert_int_equal(ab_registry_create("/no/such/folder", &registry, report), AB_BAD_INPUT);
    assert_null(registry);
    expect_text(report, "there is no folder '/no/such/folder'");
    ab_report_destroy(report);
}

static void test_two_registries_live_side_by_side(void **state) {
    (void)state;
    ab_report *report = ab_report_create();
    ab_registry *one = open_registry(built_in, report), *two = open_registry(built_in, report);
    assert_non_null(ab_registry_find(one, AB_MATERIAL, "neo-hookean", AB_NOWHERE, report));
    const ab_loaded_class *other = ab_registry_find(two, AB_MATERIAL, "neo-hookean", AB_NOWHERE, report);
    ab_registry_destroy(one);
    assert_string_equal(other->class_.help, "compressible neo-Hookean elasticity, any strain"); /* the object is still loaded */
    ab_registry_destroy(two);
    ab_report_destroy(report);
}

/* ---- the look into the file -------------------------------------------------------------------------------------------------------- */

static unsigned char *read_all(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*size);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

static void write_all(const char *path, const unsigned char *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

/* However a file is cut off or overwritten, reading it ends, with a head or with a reason (the sanitizers watch). */
static void test_the_reader_survives_any_damage(void **state) {
    (void)state;
    char path[sizeof built_in + 64], copy[] = "/tmp/abut-damaged-XXXXXX";
    const int made = mkstemp(copy);
    assert_true(made >= 0);
    close(made);
    size_t size;
    ab_plugin_head head;
    ab_refusal refusal;
    snprintf(path, sizeof path, "%s/material/linear_elastic.so", built_in);
    assert_true(ab_elf_read_head(path, "abut_plugin_v1", &head, &refusal));
    assert_int_equal(head.struct_size, sizeof(ab_plugin));
    assert_int_equal(head.class_count, 1);
    assert_true(ab_check_head(&head, &refusal));
    assert_false(ab_elf_read_head(path, "abut_plugin_v2", &head, &refusal));
    assert_false(ab_elf_read_head("/no/such/file.so", "abut_plugin_v1", &head, &refusal));
    assert_false(ab_elf_read_head("/tmp", "abut_plugin_v1", &head, &refusal));
    assert_false(ab_elf_read_head("/dev/zero", "abut_plugin_v1", &head, &refusal));
    unsigned char *bytes = read_all(path, &size), *damaged = malloc(size);
    for (size_t length = 0; length < size; length += length < 1500 ? 7 : 1009) {
        write_all(copy, bytes, length);
        refusal.text[0] = '\0';
        if (!ab_elf_read_head(copy, "abut_plugin_v1", &head, &refusal)) assert_true(refusal.text[0] != '\0');
    }
    uint64_t random = 12345;
    const size_t tables = size < 4096 ? size : 4096; /* headers, dynamic symbols and hashes stand at the front */
    for (int trial = 0; trial < 3000; trial++) {
        memcpy(damaged, bytes, size);
        for (int change = 0; change < 1 + trial % 6; change++) {
            random = random * 6364136223846793005u + 1442695040888963407u;
            const size_t place = (random >> 33) % (trial % 3 ? tables : size);
            damaged[place] = trial % 2 ? (unsigned char)(random >> 20) : 0xff;
        }
        write_all(copy, damaged, size);
        refusal.text[0] = '\0';
        if (!ab_elf_read_head(copy, "abut_plugin_v1", &head, &refusal)) assert_true(refusal.text[0] != '\0');
    }
    for (size_t place = 0; place + 8 <= 1024; place += 8) /* every offset of the headers as large as can be */
        for (int way = 0; way < 2; way++) {
            memcpy(damaged, bytes, size);
            memset(damaged + place, 0xff, 8);
            if (way) damaged[place + 7] = 0x7f;
            write_all(copy, damaged, size);
            refusal.text[0] = '\0';
            if (!ab_elf_read_head(copy, "abut_plugin_v1", &head, &refusal)) assert_true(refusal.text[0] != '\0');
        }
    unlink(copy);
    free(bytes);
    free(damaged);
}

/* ---- the tables -------------------------------------------------------------------------------------------------------------------- */

static void test_versions_are_refused_by_number(void **state) {
    (void)state;
    ab_refusal refusal;
    const ab_plugin_head good = {sizeof(ab_plugin), AB_ABI_MAJOR, AB_ABI_MINOR, sizeof(double), sizeof(size_t), 1, sizeof(ab_plugin)};
    assert_true(ab_check_head(&good, &refusal));
    ab_plugin_head head = good;
    head.abi_major++;
    assert_false(ab_check_head(&head, &refusal));
    head = good, head.abi_minor++;
    assert_false(ab_check_head(&head, &refusal));
    head = good, head.size_of_size_t = 4;
    assert_false(ab_check_head(&head, &refusal));
    for (uint32_t wrong = 0; wrong < 2000; wrong++) {
        head = good, head.struct_size = wrong, head.symbol_size = 4096;
        assert_int_equal(ab_check_head(&head, &refusal), wrong == sizeof(ab_plugin));
    }
    head = good, head.class_count = 0;
    assert_false(ab_check_head(&head, &refusal));
    head.class_count = UINT32_MAX;
    assert_false(ab_check_head(&head, &refusal));
}

static int no_create(const ab_host *host, const ab_value *settings, void **self) { return (void)host, (void)settings, (void)self, 0; }
static void no_destroy(void *self) { (void)self; }
static int no_update(void *self, ab_batch *batch) { return (void)self, (void)batch, 0; }
static const ab_material_ops no_ops = {sizeof no_ops, NULL, no_update};

static ab_class plain_class(const ab_param *param, uint32_t nparam, const ab_state *own_state, uint32_t nstate) {
    return (ab_class){.struct_size = sizeof(ab_class),
                      .kind = AB_MATERIAL,
                      .spaces = AB_PLANE_STRAIN,
                      .gives = AB_GIVE_STRESS | AB_GIVE_WAVE_SPEED,
                      .nparam = nparam,
                      .nstate = nstate,
                      .name = "plain",
                      .help = "plain",
                      .reference = "",
                      .param = param,
                      .state = own_state,
                      .create = no_create,
                      .destroy = no_destroy,
                      .ops = &no_ops};
}

static void test_tables_that_cannot_be_true_are_refused(void **state) {
    (void)state;
    static const ab_param wrong[] = {
        {NULL, "1", "h", NULL, AB_REAL, AB_REQUIRED, 0, 0, 1},
        {"", "1", "h", NULL, AB_REAL, AB_REQUIRED, 0, 0, 1},
        {"a b", "1", "h", NULL, AB_REAL, AB_REQUIRED, 0, 0, 1},
        {"a\nb", "1", "h", NULL, AB_REAL, AB_REQUIRED, 0, 0, 1},
        {"a", NULL, "h", NULL, AB_REAL, AB_REQUIRED, 0, 0, 1},
        {"a", "1", NULL, NULL, AB_REAL, AB_REQUIRED, 0, 0, 1},
        {"a", "1", "h\x1b[31m", NULL, AB_REAL, AB_REQUIRED, 0, 0, 1},
        {"a", "1", "h", NULL, 0, AB_REQUIRED, 0, 0, 1},
        {"a", "1", "h", NULL, AB_REAL, 1u << 31, 0, 0, 1},
        {"a", "1", "h", NULL, AB_REAL, AB_OR_DIRECTION, 0, 0, 1},
        {"a", "1", "h", NULL, AB_REAL, AB_COLUMNS_2, 0, 0, 1},
        {"a", "1", "h", "x|y", AB_REAL, 0, 0, 0, 1},
        {"a", NULL, "h", NULL, AB_CHOICE, 0, 0, 0, 0},
        {"a", NULL, "h", "", AB_CHOICE, 0, 0, 0, 0},
        {"a", NULL, "h", "x||y", AB_CHOICE, 0, 0, 0, 0},
        {"a", NULL, "h", "x|", AB_CHOICE, 0, 0, 0, 0},
        {"a", NULL, "h", "x|y", AB_CHOICE, 0, 2, 0, 0},
        {"a", NULL, "h", "x|y", AB_CHOICE, 0, -1, 0, 0},
        {"a", NULL, "h", "x|y", AB_CHOICE, 0, 0.5, 0, 0},
        {"a", NULL, "h", "x|y", AB_CHOICE, 0, NAN, 0, 0},
        {"a", NULL, "h", NULL, AB_FLAG, 0, 2, 0, 0},
        {"a", "1", "h", NULL, AB_REAL, 0, NAN, 0, 0},
        {"a", "1", "h", NULL, AB_REAL, 0, 0, 1, 2},
        {"a", "1", "h", NULL, AB_REAL, AB_MIN_OPEN, 1, 1, 2},
        {"a", "1", "h", NULL, AB_REAL, AB_MAX_OPEN, 2, 1, 2},
        {"a", "1", "h", NULL, AB_REAL, AB_REQUIRED, 0, NAN, 1},
        {"a", "1", "h", NULL, AB_REAL, AB_REQUIRED, 0, 2, 1},
        {"a", "1", "h", NULL, AB_INTEGER, 0, 1.5, 1, 2},
    };
    static const ab_state wrong_states[] = {
        {NULL, "1", "h", AB_SCALAR, AB_COPY, 0},   {"a", NULL, "h", AB_SCALAR, AB_COPY, 0},
        {"a", "1", NULL, AB_SCALAR, AB_COPY, 0},   {"a", "1", "h", 0, AB_COPY, 0},
        {"a", "1", "h", AB_FULL + 1, AB_COPY, 0},  {"a", "1", "h", AB_SCALAR, 0, 0},
        {"a", "1", "h", AB_SCALAR, AB_SUM + 1, 0}, {"a", "1", "h", AB_SCALAR, AB_SUM, NAN},
    };
    static const ab_param right[] = {
        {"E", "Pa", "h", NULL, AB_REAL, AB_REQUIRED | AB_MIN_OPEN, 0, 0, INFINITY},
        {"a", "1", "h", NULL, AB_REAL, 0, 2, 1, 2},
        {"any", "1", "h", NULL, AB_REAL, AB_MIN_OPEN, 0, 0, 0},
        {"way", NULL, "h", "x|y", AB_CHOICE, AB_OR_DIRECTION, 1, 0, 0},
        {"on", NULL, "h", NULL, AB_FLAG, 0, 1, 0, 0},
        {"count", "1", "h", NULL, AB_INTEGER, 0, 3, 1, 9},
        {"curve", "Pa", "h", NULL, AB_TABLE, AB_COLUMNS_2, 0, 0, 0},
    };
    ab_class_copy copy;
    ab_refusal refusal;
    ab_class class_ = plain_class(right, 7, NULL, 0);
    refusal.text[0] = '\0';
    assert_true(ab_check_class(&class_, &copy, &refusal));
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        class_ = plain_class(&wrong[i], 1, NULL, 0);
        if (ab_check_class(&class_, &copy, &refusal)) fail_msg("setting %zu is taken", i);
    }
    for (size_t i = 0; i < sizeof wrong_states / sizeof *wrong_states; i++) {
        class_ = plain_class(NULL, 0, &wrong_states[i], 1);
        if (ab_check_class(&class_, &copy, &refusal)) fail_msg("state %zu is taken", i);
    }
    const ab_param twice[] = {right[0], right[0]};
    class_ = plain_class(twice, 2, NULL, 0);
    assert_false(ab_check_class(&class_, &copy, &refusal));
    class_ = plain_class(right, 1, NULL, AB_STATES_MAX + 1);
    assert_false(ab_check_class(&class_, &copy, &refusal));
    class_ = plain_class(right, 1, NULL, 1);
    assert_false(ab_check_class(&class_, &copy, &refusal));
    for (int part = 0; part < 7; part++) {
        class_ = plain_class(right, 1, NULL, 0);
        switch (part) {
        case 0: class_.create = NULL; break;
        case 1: class_.destroy = NULL; break;
        case 2: class_.ops = NULL; break;
        case 3: class_.spaces = 0; break;
        case 4: class_.kind = 0; break;
        case 5: class_.gives = AB_GIVE_STRESS; break;
        default: class_.help = NULL; break;
        }
        if (ab_check_class(&class_, &copy, &refusal)) fail_msg("a class without part %d is taken", part);
    }
}

static void test_ranges_are_open_and_closed_as_declared(void **state) {
    (void)state;
    ab_param param = {"a", "1", "h", NULL, AB_REAL, 0, 0, -1, 2};
    assert_true(ab_param_allows(&param, -1) && ab_param_allows(&param, 2));
    assert_false(ab_param_allows(&param, -1.0000001) || ab_param_allows(&param, 2.0000001) || ab_param_allows(&param, NAN));
    param.flags = AB_MIN_OPEN | AB_MAX_OPEN;
    assert_false(ab_param_allows(&param, -1) || ab_param_allows(&param, 2));
    assert_true(ab_param_allows(&param, 1.9999999));
    param.min = param.max = 0;
    assert_true(ab_param_allows(&param, -1e300) && ab_param_allows(&param, 0));
    assert_int_equal(ab_choice_count("a|b|c"), 3);
    assert_int_equal(ab_choice_count("a"), 1);
    assert_int_equal(ab_choice_count("|a"), 0);
}

static void test_services_give_zeroed_aligned_memory(void **state) {
    (void)state;
    static ab_service service;
    ab_service_init(&service, "material 'soil' (plain)");
    const ab_host *host = &service.host;
    assert_int_equal(host->struct_size, sizeof(ab_host));
    for (size_t bytes = 0; bytes < 300; bytes += 37) {
        unsigned char *memory = host->allocate(host->context, bytes);
        assert_non_null(memory);
        assert_int_equal((uintptr_t)memory % 64, 0);
        for (size_t i = 0; i < bytes; i++) assert_int_equal(memory[i], 0);
        memset(memory, 0xff, bytes);
        host->release(host->context, memory);
    }
    assert_null(host->allocate(host->context, SIZE_MAX));
    host->release(host->context, NULL);
    char text[1000];
    memset(text, 'x', sizeof text);
    text[sizeof text - 1] = '\0';
    host->message(host->context, text); /* longer than there is room for */
    assert_int_equal(strlen(service.message), sizeof service.message - 1);
    host->message(host->context, "last");
    assert_string_equal(service.message, "last");
    host->message(host->context, NULL);
    assert_string_equal(service.message, "(no text)");
}

int main(void) {
    const char *build = getenv("ABUT_BUILD");
    char *absolute = realpath(build ? build : ".", NULL);
    snprintf(built_in, sizeof built_in, "%s/plugins", absolute ? absolute : ".");
    free(absolute);
    unsetenv("ABUT_PLUGIN_PATH");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing_is_loaded_that_was_not_asked_for),
        cmocka_unit_test(test_classes_come_in_order_of_kind_and_name),
        cmocka_unit_test(test_a_folder_named_twice_offers_nothing_twice),
        cmocka_unit_test(test_what_is_not_found_names_the_nearest_and_the_folders),
        cmocka_unit_test(test_an_empty_entry_is_not_the_working_directory),
        cmocka_unit_test(test_a_named_folder_must_be_there),
        cmocka_unit_test(test_two_registries_live_side_by_side),
        cmocka_unit_test(test_the_reader_survives_any_damage),
        cmocka_unit_test(test_versions_are_refused_by_number),
        cmocka_unit_test(test_tables_that_cannot_be_true_are_refused),
        cmocka_unit_test(test_ranges_are_open_and_closed_as_declared),
        cmocka_unit_test(test_services_give_zeroed_aligned_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
