/* command_extremes.c: abut extremes: reads the scene with what the command line adds to its `extremes`, runs, judges, writes. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "core/commands.h"
#include "core/extremes.h"

/* "PATH=FROM..TO" or "PATH=a,b,c" as an entry of extremes.vary; what stands between the dots and commas is YAML's to read. */
static void add_vary(ab_text *text, const ab_override *vary, bool first) {
    const char *dots = strstr(vary->value, "..");
    ab_text_add(text, "%s{set: ", first ? "[" : ", ");
    ab_text_add_escaped(text, vary->path);
    if (dots != NULL) {
        ab_text_add(text, ", from: ");
        char *from = strndup(vary->value, (size_t)(dots - vary->value));
        text->failed = text->failed || from == NULL;
        if (from != NULL) ab_text_add_escaped(text, from);
        free(from);
        ab_text_add(text, ", to: ");
        ab_text_add_escaped(text, dots + 2);
        ab_text_add(text, "}");
    } else
        ab_text_add(text, ", values: [%s]}", vary->value);
}

static void add_map(ab_text *text, const char *map) {
    ab_text_add(text, "[");
    for (size_t i = 0; *map != '\0'; i++) {
        const size_t length = strcspn(map, ",");
        char *name = strndup(map, length);
        text->failed = text->failed || name == NULL;
        ab_text_add(text, "%s", i > 0 ? ", " : "");
        if (name != NULL) ab_text_add_escaped(text, name);
        free(name);
        map += length + (map[length] == ',');
    }
    ab_text_add(text, "]");
}

/* The scene, read with all of --set and with --vary, --map and --limit as settings of its `extremes`. */
static ab_status read_scene(const ab_command_line *line, ab_registry **registry, ab_scene **scene, ab_report *report) {
    ab_override more[3];
    size_t count = 0;
    ab_text vary = {0}, map = {0};
    for (size_t i = 0; i < line->vary_count; i++) add_vary(&vary, &line->vary[i], i == 0);
    ab_text_add(&vary, "]");
    if (line->map != NULL) add_map(&map, line->map);
    if (line->vary_count > 0) more[count++] = (ab_override){"extremes.vary", vary.bytes};
    if (line->map != NULL) more[count++] = (ab_override){"extremes.map", map.bytes};
    if (line->limit != NULL) more[count++] = (ab_override){"extremes.limit", line->limit};
    ab_status status = AB_FAILED;
    if (vary.failed || map.failed)
        fprintf(stderr, "abut: error: no memory\n");
    else
        status = ab_command_scene_with(line, more, count, registry, scene, report);
    ab_text_clear(&vary);
    ab_text_clear(&map);
    return status;
}

/* Refusal is an answer, but where not one value of a ladder is accepted the path is wrong: said before anything runs. */
static ab_status check_values(const ab_command_line *line, const ab_extremes *extremes, ab_registry *registry, ab_report *report) {
    ab_override *list = calloc(line->override_count + 4 * AB_EXTREMES_PATHS, sizeof *list);
    if (list == NULL) return ab_report_failure(report, "no memory");
    if (line->override_count > 0) memcpy(list, line->overrides, line->override_count * sizeof *list);
    ab_status status = AB_OK;
    for (size_t q = 0; q < extremes->spec->count; q++) {
        size_t accepted = 0;
        ab_report *first = NULL;
        for (size_t i = 0; i < extremes->count && accepted == 0; i++) {
            const ab_sample *s = extremes->samples[i];
            if (s->quantity != q || s->second != SIZE_MAX) continue;
            memcpy(list + line->override_count, s->run.settings, s->run.setting_count * sizeof *list);
            ab_report *own = ab_report_create();
            ab_scene *tried = NULL;
            if (own != NULL &&
                ab_scene_read(line->words[0], list, line->override_count + s->run.setting_count, registry, &tried, own) == AB_OK)
                accepted++;
            ab_scene_destroy(tried);
            if (first == NULL)
                first = own;
            else
                ab_report_destroy(own);
        }
        if (accepted == 0)
            status = ab_report_error(report, extremes->spec->quantities[q].mark, "no value of '%s' is accepted; the first mistake: %s",
                                     extremes->spec->quantities[q].name,
                                     first != NULL && ab_report_first_error(first) != NULL ? ab_report_first_error(first) : "not known");
        ab_report_destroy(first);
    }
    free(list);
    return status;
}

static ab_status drive(const ab_command_line *line, const ab_scene *scene, ab_registry *registry, ab_report *report) {
    if (scene->extremes.count == 0)
        return ab_report_error(report, AB_NOWHERE,
                               "%s has no `extremes`, and no --vary is given: nothing to drive; for example --vary time.cfl=0.1..1.2",
                               line->words[0]);
    char folder[PATH_MAX + 32];
    ab_extremes extremes = {
        .runs = ab_command_child_runs(line, "extremes", folder, sizeof folder), .scene = scene, .spec = &scene->extremes};
    ab_status status = ab_extremes_plan(&extremes, report);
    if (status == AB_OK) status = check_values(line, &extremes, registry, report);
    if (status == AB_OK) status = ab_extremes_run(&extremes, scene, registry, report);
    const bool stopped = status > 128;
    if (status == AB_OK || stopped) { /* what is done is told all the same */
        ab_status written = ab_extremes_write(&extremes, report);
        if (written == AB_OK) {
            ab_extremes_table(&extremes, stdout);
            printf("  %s holds extremes.csv%s extremes.json%s\n", extremes.runs.folder, scene->extremes.has_map ? "," : " and",
                   scene->extremes.has_map ? " and map.svg" : "");
        }
        bool as_said = true; /* what is open must not hold: the word is to go when it does */
        for (size_t q = 0; q < scene->extremes.count; q++)
            as_said = as_said && (ab_extremes_fault(&extremes, q) == NULL) == (scene->extremes.quantities[q].open == NULL);
        if (written == AB_OK && line->strict && !as_said) written = AB_MISSED;
        if (!stopped) status = written;
    }
    ab_extremes_clear(&extremes);
    return status;
}

int ab_command_extremes(const ab_command_line *line) { return ab_command_with_scene(line, read_scene, drive); }
