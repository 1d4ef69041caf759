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

/* What `abut run` is told by its line; `folder` holds the text of the results' place. */
static ab_run_options options_of(const ab_command_line *line, char *folder, size_t size) {
    ab_command_folder(line->words[0], folder, size);
    return (ab_run_options){.folder = line->output ? line->output : folder,
                            .restart = line->restart,
                            .threads = line->threads ? line->threads : omp_get_max_threads(),
                            .quiet = line->quiet,
                            .strict = line->strict,
                            .methods = line->methods,
                            .method_count = line->method_count,
                            .interact = line->interact};
}

static ab_status run(const ab_command_line *line, const ab_scene *scene, ab_registry *registry, ab_report *report) {
    (void)registry;
    char folder[PATH_MAX + 16];
    const ab_run_options options = options_of(line, folder, sizeof folder);
    return ab_run(scene, &options, report);
}

static ab_status plan(const ab_command_line *line, const ab_scene *scene, ab_registry *registry, ab_report *report) {
    (void)registry;
    char folder[PATH_MAX + 16];
    const ab_run_options options = options_of(line, folder, sizeof folder);
    return ab_plan_print(scene, &options, line->json, stdout, report);
}

int ab_command_run(const ab_command_line *line) { return ab_command_with_scene(line, ab_command_scene, run); }

int ab_command_plan(const ab_command_line *line) { return ab_command_with_scene(line, ab_command_scene, plan); }
