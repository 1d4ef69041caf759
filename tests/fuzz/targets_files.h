/* targets_files.h: readers of what a run and other programs leave on the disk, each fed with bytes: checkpoints, and what libgmsh makes of a mesh file. As targets.h. */
#ifndef FUZZ_TARGETS_FILES_H
#define FUZZ_TARGETS_FILES_H

#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif

#include <zlib.h>

#include "contact/contact.h"
#include "core/checkpoint_run.h"
#include "core/results.h"
#include "fem/body.h"
#include "fem/mesh_gmsh.h"
#include "mpm/body.h"
#include "tests/fuzz/targets.h"

/* ---- checkpoints ------------------------------------------------------------------------------------------------------------ */

enum { FUZZ_HEAD = 64, FUZZ_BYTES_AT = 24, FUZZ_CRC_AT = 32 }; /* the head of checkpoint.c */

static inline ab_status fuzz_points(const ab_scene *scene, size_t body, int threads, ab_domain **domain, ab_report *report) {
    return mpm_create_in(scene, body, NULL, threads, domain, report);
}

static const ab_method fuzz_methods[] = {{"material-points", fuzz_points}, {"finite-elements", fem_create}, {"rigid", rigid_create}};

static inline ab_run_options fuzz_options(const char *folder) {
    return (ab_run_options){
        .folder = folder, .threads = 1, .quiet = true, .methods = fuzz_methods, .method_count = 3, .interact = contact_create};
}

/* The scene whose checkpoints are read. */
static inline const ab_scene *fuzz_restart_scene(void) {
    static ab_scene *scene;
    if (scene) return scene;
    ab_report *report = ab_report_create();
    char path[4096];
    const char *source = getenv("ABUT_SOURCE");
    snprintf(path, sizeof path, "%s/tests/fuzz/corpus/restart.yaml", source ? source : ".");
    if (ab_scene_read(path, NULL, 0, fuzz_registry(), &scene, report) != AB_OK) {
        ab_report_print(report, stderr);
        abort();
    }
    ab_report_destroy(report);
    return scene;
}

/* Length and check sum as those of a file that is whole. */
static inline void fuzz_mend(uint8_t *bytes, size_t count) {
    if (count < FUZZ_HEAD) return;
    const uint64_t size = count;
    memcpy(bytes + FUZZ_BYTES_AT, &size, sizeof size);
    memset(bytes + FUZZ_CRC_AT, 0, 4);
    const uint32_t crc = (uint32_t)crc32(crc32(0, NULL, 0), bytes, (uInt)count);
    memcpy(bytes + FUZZ_CRC_AT, &crc, 4);
}

/* Goes on from it as a run would, up to the first step. 1: status and report differ. */
static inline int fuzz_restart(const uint8_t *bytes, size_t count) {
    char path[64];
    const ab_scene *scene = fuzz_restart_scene();
    const int file = fuzz_file(bytes, count, path);
    if (file < 0) return 0;
    const ab_run_options options = fuzz_options("/nonexistent");
    ab_report *report = ab_report_create();
    ab_checkpoint *checkpoint = NULL;
    ab_schedule *schedule = NULL;
    ab_results *results = NULL;
    ab_state_view view;
    ab_status status = ab_checkpoint_open_for(path, scene, &checkpoint, report);
    if (status == AB_OK) status = ab_schedule_create(scene, &options, &schedule, report);
    if (status == AB_OK) {
        ab_schedule_view(schedule, &view);
        status = ab_results_create(options.folder, scene, &view, &results, report);
    }
    if (status == AB_OK) status = ab_checkpoint_restore(checkpoint, schedule, results);
    if (status == AB_OK) ab_schedule_look(schedule);
    const int wrong = (status == AB_OK) != (ab_report_errors(report) == 0) || (status != AB_OK && !ab_report_text(report, 0));
    if (wrong) fprintf(stderr, "status %d with %zu errors: %s\n", (int)status, ab_report_errors(report), ab_report_text(report, 0));
    ab_results_destroy(results);
    ab_schedule_destroy(schedule);
    ab_checkpoint_destroy(checkpoint);
    ab_report_destroy(report);
    close(file);
    return wrong;
}

/* As the bytes are, where the check sum tells, and with the check sum put right, so that what is behind it has to. */
static inline int fuzz_checkpoint(const uint8_t *bytes, size_t count) {
    if (fuzz_restart(bytes, count)) return 1;
    uint8_t *mended = malloc(count + 1);
    if (!mended) return 0;
    memcpy(mended, bytes, count);
    fuzz_mend(mended, count);
    const int wrong = fuzz_restart(mended, count);
    free(mended);
    return wrong;
}

/* ---- meshes ----------------------------------------------------------------------------------------------------------------- */

/* The stream from the process in which libgmsh reads a file, as a mesh of 4 nodes an element and of 8. What is taken must be a mesh. */
static inline int fuzz_mesh(const uint8_t *bytes, size_t count) {
    int wrong = 0;
    char text[FEM_GMSH_TEXT], *copy = malloc(count + !count); /* of just this length, at a place for numbers */
    fem_gmsh_file file = {0};
    if (!copy) return 0;
    memcpy(copy, bytes, count);
    const bool taken = fem_gmsh_take(copy, count, &file, text) == 1;
    for (int k = 0; taken && k < 2; ++k) {
        const ab_body_spec spec = {.name = "beam",
                                   .mesh = {.kind = AB_MESH_FILE, .type = k ? AB_ELEMENT_Q8 : AB_ELEMENT_Q4, .file = (char *)"beam.msh"}};
        ab_report *report = ab_report_create();
        fem_mesh *mesh = NULL;
        const ab_status status = fem_gmsh_mesh(&spec, "beam.msh", &file, &mesh, report);
        if ((status == AB_OK) != (mesh != NULL) || (status == AB_OK) != (ab_report_errors(report) == 0)) wrong = 1;
        for (size_t e = 0; mesh && e < mesh->element_count; ++e)
            for (int a = 0; a < mesh->nodes; ++a)
                if (mesh->connectivity[e * (size_t)mesh->nodes + (size_t)a] >= mesh->node_count) wrong = 1;
        fem_mesh_destroy(mesh);
        ab_report_destroy(report);
    }
    if (wrong) fprintf(stderr, "a mesh that is none\n");
    free(copy);
    return wrong;
}

#endif
