/* command_run.c: abut run, and abut plan, which stops short of it. */
#include "core/commands.h"

#include <limits.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

void ab_command_folder(const char *scene, char *folder, size_t size) {
    char full[PATH_MAX];
    if (!realpath(scene, full)) snprintf(full, sizeof full, "%s", scene);
    char *file = strrchr(full, '/');
    char *name = file ? file + 1 : full;
    if (file > full && (!strcmp(name, "scene.yaml") || !strcmp(name, "scene.yml"))) {
        *file = '\0';
        char *parent = strrchr(full, '/');
        name = parent ? parent + 1 : full;
    } else {
        char *dot = strrchr(name, '.');
        if (dot > name) *dot = '\0';
    }
    snprintf(folder, size, "results/%s", name[0] ? name : "scene");
}

static int with_scene(const ab_command_line *line,
                      ab_status (*act)(const ab_command_line *, const ab_scene *, const ab_run_options *, ab_report *)) {
    ab_report *report = ab_report_create();
    if (!report) {
        fprintf(stderr, "abut: error: no memory\n");
        return AB_FAILED;
    }
    ab_registry *registry = NULL;
    ab_scene *scene = NULL;
    ab_status status = ab_command_scene(line, &registry, &scene, report);
    if (status == AB_OK) {
        char folder[PATH_MAX + 16];
        ab_command_folder(line->words[0], folder, sizeof folder);
        const ab_run_options options = {.folder = line->output ? line->output : folder,
                                        .restart = line->restart,
                                        .threads = line->threads ? line->threads : omp_get_max_threads(),
                                        .quiet = line->quiet,
                                        .strict = line->strict,
                                        .methods = line->methods,
                                        .method_count = line->method_count,
                                        .interact = line->interact};
        ab_report_print(report, stderr); /* warnings, before a long run rather than after it */
        status = act(line, scene, &options, report);
        ab_report_print(report, stderr);
        ab_scene_destroy(scene);
        ab_registry_destroy(registry);
    }
    ab_report_destroy(report);
    return (int)status;
}

static ab_status run(const ab_command_line *line, const ab_scene *scene, const ab_run_options *options, ab_report *report) {
    (void)line;
    return ab_run(scene, options, report);
}

static ab_status plan(const ab_command_line *line, const ab_scene *scene, const ab_run_options *options, ab_report *report) {
    return ab_plan_print(scene, options, line->json, stdout, report);
}

int ab_command_run(const ab_command_line *line) { return with_scene(line, run); }

int ab_command_plan(const ab_command_line *line) { return with_scene(line, plan); }
