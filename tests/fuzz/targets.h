/* targets.h: readers of what comes from outside, each fed with bytes: scenes, --set, the descriptor of a plugin's file. For test_fuzz.c (a short run with changes of known
 * inputs, in every build) and for libFuzzer (fuzz.c, by slow_fuzz.sh). Whatever the bytes are: no crash, no leak, an error where one is due. */
#ifndef FUZZ_TARGETS_H
#define FUZZ_TARGETS_H

#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "core/document.h"
#include "core/plugin_elf.h"
#include "core/scene.h"

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
