/* command_check.c: abut check: everything that can be known to be wrong without running, or but for a first step in memory. */
#include "core/commands.h"
#include "core/doubts.h"

static void count(FILE *stream, const char *before, size_t number, const char *one, const char *many) {
    if (number) fprintf(stream, "%s%zu %s", before, number, number == 1 ? one : many);
}

static void print_ok(const char *path, const ab_scene *scene, size_t warnings) {
    printf("%s: ok: ", path);
    count(stdout, "", scene->body_count, "body", "bodies");
    count(stdout, ", ", scene->material_count, "material", "materials");
    count(stdout, ", ", scene->contact_count, "contact", "contacts");
    count(stdout, ", ", scene->load_count, "load", "loads");
    count(stdout, ", ", scene->boundary_count, "boundary", "boundaries");
    count(stdout, ", ", scene->monitor_count, "monitor", "monitors");
    count(stdout, ", ", scene->expect_count, "expect", "expects");
    count(stdout, "; ", warnings, "warning", "warnings");
    printf("\n");
}

int ab_command_check(const ab_command_line *line) {
    ab_report *report = ab_report_create();
    if (!report) {
        fprintf(stderr, "abut: error: no memory\n");
        return AB_FAILED;
    }
    ab_registry *registry = NULL;
    ab_scene *scene = NULL;
    ab_status status = ab_command_scene(line, &registry, &scene, report);
    if (status == AB_OK) { /* bodies and plugins are made too: only they know what settings together make no sense */
        const ab_run_options options = {
            .threads = 1, .methods = line->methods, .method_count = line->method_count, .interact = line->interact};
        ab_schedule *schedule = NULL;
        status = ab_schedule_create(scene, &options, &schedule, report);
        if (status == AB_OK) status = ab_doubts(schedule, report);
        if (status == AB_OK) { /* and only they know which values and fields they have */
            ab_state_view view;
            ab_schedule_view(schedule, &view);
            status = ab_results_check(scene, &view, report);
        }
        if (status == AB_OK && scene->contact_count)
            status = ab_schedule_step(schedule, report); /* of bodies that are drawn into each other only contact knows */
        ab_schedule_destroy(schedule);
        const size_t warnings = ab_report_warnings(report);
        ab_report_print(report, stderr);
        if (status == AB_OK) print_ok(line->words[0], scene, warnings);
        ab_scene_destroy(scene);
        ab_registry_destroy(registry);
    }
    ab_report_destroy(report);
    return (int)status;
}
