/* targets.h: readers of what comes from outside, each fed with bytes: scenes, --set, tables in files, the descriptor of a plugin's file. For test_fuzz.c (a short run with changes of known
 * inputs, in every build) and for libFuzzer (fuzz.c, by slow_fuzz.sh). Whatever the bytes are: no crash, no leak, an error where one is due. */
#ifndef FUZZ_TARGETS_H
#define FUZZ_TARGETS_H

#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "core/document.h"
#include "core/plugin_elf.h"
#include "core/scene.h"
#include "core/table_file.h"

/* A file in memory with these bytes; its name in `path`. -1: none. */
static inline int fuzz_file(const uint8_t *bytes, size_t count, char path[64]) {
    const int file = memfd_create("fuzz", MFD_CLOEXEC);
    if (file < 0 || write(file, bytes, count) != (ssize_t)count) return -1;
    snprintf(path, 64, "/proc/self/fd/%d", file);
    return file;
}

static inline ab_registry *fuzz_registry(void) {
    static ab_registry *registry; /* plugins stay loaded */
    ab_report *report = registry ? NULL : ab_report_create();
    char folder[4096];
    const char *build = getenv("ABUT_BUILD");
    snprintf(folder, sizeof folder, "%s/plugins", build ? build : "build");
    if (report) ab_registry_create(folder, &registry, report);
    ab_report_destroy(report);
    return registry;
}

/* Reads it as abut check does. 1: there is a report although the status is good, or the other way round. */
static inline int fuzz_read(const char *path, const ab_override *overrides, size_t count) {
    ab_report *report = ab_report_create();
    ab_scene *scene = NULL;
    const ab_status status = ab_scene_read(path, overrides, count, fuzz_registry(), &scene, report);
    const int wrong = (status == AB_OK) != (ab_report_errors(report) == 0) || (status == AB_OK) != (scene != NULL);
    if (wrong) fprintf(stderr, "status %d with %zu errors: %s\n", (int)status, ab_report_errors(report), ab_report_text(report, 0));
    ab_scene_destroy(scene);
    ab_report_destroy(report);
    return wrong;
}

static inline int fuzz_scene(const uint8_t *bytes, size_t count) {
    char path[64];
    const int file = fuzz_file(bytes, count, path);
    const int wrong = file >= 0 && fuzz_read(path, NULL, 0);
    if (file >= 0) close(file);
    return wrong;
}

static const char fuzz_base[] = "abut: 1\nspace: plane-strain\ntime: {end: 1}\ngrid: {from: [0, 0], to: [2, 2], cell: 0.5}\nmaterials: {m: "
                                "{model: linear-elastic, E: 1e6, nu: 0.3, density: "
                                "1000}}\nbodies:\n  a: {method: material-points, material: m, shape: {box: [[0, 0], [1, 1]]}}\n  b: "
                                "{method: material-points, material: m, shape: {box: [[1, 0], [2, "
                                "1]]}}\ncontact:\n  - {bodies: [a, b], algorithm: multi-velocity, response: coulomb}\n";

/* PATH=VALUE, one a line. */
static inline int fuzz_set(const uint8_t *bytes, size_t count) {
    enum { LINES = 8 };
    char *text = malloc(count + 1), *rest = NULL, path[64];
    ab_override overrides[LINES];
    size_t lines = 0;
    if (!text) return 0;
    memcpy(text, bytes, count);
    text[count] = '\0';
    for (char *line = strtok_r(text, "\n", &rest); line && lines < LINES; line = strtok_r(NULL, "\n", &rest)) {
        char *equals = strchr(line, '=');
        if (!equals || equals == line) continue;
        *equals = '\0';
        overrides[lines++] = (ab_override){line, equals + 1};
    }
    const int file = fuzz_file((const uint8_t *)fuzz_base, sizeof fuzz_base - 1, path);
    const int wrong = file >= 0 && fuzz_read(path, overrides, lines);
    if (file >= 0) close(file);
    free(text);
    return wrong;
}

/* A setting that is a table from a file: the first line is what the scene says of it (columns: [t, a], units: [s, m/s2]), the rest is the file. What is taken must be finite and
 * grow in its first column. */
static inline int fuzz_table(const uint8_t *bytes, size_t count) {
    static const ab_param param = {"history", "s, m s-2", "acceleration in time", NULL, AB_TABLE, AB_INCREASING, 0, 0, 0};
    static ab_units *units; /* reading what they are takes longer than a table does */
    static int reads;
    if (reads++ % 10000 == 0) {
        ab_units_destroy(units);
        units = ab_units_create();
    }
    const uint8_t *end = memchr(bytes, '\n', count);
    const size_t first = end ? (size_t)(end - bytes) : count;
    char path[64], *text = malloc(first + 100);
    const int file = fuzz_file(bytes + first + (end != NULL), count - first - (end != NULL), path);
    ab_reader reader = {.arena = ab_arena_create(),
                        .formulas = ab_formulas_create(),
                        .units = units,
                        .report = ab_report_create(),
                        .scene_path = "/scene.yaml"};
    ab_document *document = NULL;
    int wrong = 0;
    if (file >= 0 && text && reader.arena && reader.formulas && reader.units && reader.report) {
        ab_value value = {0};
        const int head = sprintf(text, "{file: %s, ", path);
        memcpy(text + head, bytes, first);
        text[head + (int)first] = '}';
        if (ab_document_parse("scene.yaml", text, (size_t)head + first + 1, &document, reader.report) == AB_OK) {
            const size_t before = ab_report_errors(reader.report); /* a key twice is told with the document, which goes on */
            const bool taken = ab_table_file_read(&reader, &param, document->root, "boundaries[0]", &value);
            wrong = taken != (ab_report_errors(reader.report) == before) || taken != (value.rows * value.columns > 0);
        }
        for (size_t k = 0; k < value.rows * value.columns; k++)
            if (!isfinite(value.table[k]) || (k && k % value.columns == 0 && !(value.table[k] > value.table[k - value.columns]))) wrong = 1;
        if (wrong) fprintf(stderr, "%zu x %zu numbers, %zu errors\n", value.rows, value.columns, ab_report_errors(reader.report));
    }
    ab_document_destroy(document);
    ab_report_destroy(reader.report);
    ab_formulas_destroy(reader.formulas);
    ab_arena_destroy(reader.arena);
    if (file >= 0) close(file);
    free(text);
    return wrong;
}

/* The head of a plugin's descriptor, read from the file before any code of it runs. */
static inline int fuzz_plugin(const uint8_t *bytes, size_t count) {
    char path[64];
    const int file = fuzz_file(bytes, count, path);
    ab_plugin_head head;
    ab_refusal refusal = {""};
    const int wrong = file >= 0 && !ab_elf_read_head(path, "abut_plugin_v1", &head, &refusal) && !refusal.text[0];
    if (wrong) fprintf(stderr, "refused without a reason\n");
    if (file >= 0) close(file);
    return wrong;
}

#endif
