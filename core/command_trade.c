/* command_trade.c: abut trade: reads the scene with what the command line adds to its `trade`, runs, judges, writes. */
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/commands.h"
#include "core/trade.h"

/* "PATH=a,b" as an entry of trade.vary; commas inside brackets or quotes belong to a value, so YAML itself takes the list apart. */
static void add_vary(ab_text *text, const ab_override *vary, bool first) {
    ab_text_add(text, "%s{set: ", first ? "[" : ", ");
    ab_text_add_escaped(text, vary->path);
    ab_text_add(text, ", values: [%s]}", vary->value);
}

/* The scene, read with all of --set and with --vary, --tolerance, --seconds and --limit as settings of its `trade`. */
static ab_status read_scene(const ab_command_line *line, ab_registry **registry, ab_scene **scene, ab_report *report) {
    ab_override more[5];
    size_t count = 0;
    ab_text vary = {0};
    for (size_t i = 0; i < line->vary_count; i++) add_vary(&vary, &line->vary[i], i == 0);
    ab_text_add(&vary, "]");
    if (line->vary_count > 0) more[count++] = (ab_override){"trade.vary", vary.bytes};
    if (line->tolerance != NULL) more[count++] = (ab_override){"trade.tolerance", line->tolerance};
    if (line->path) more[count++] = (ab_override){"trade.search", "path"};
    if (line->seconds != NULL) more[count++] = (ab_override){"trade.seconds", line->seconds};
    if (line->limit != NULL) more[count++] = (ab_override){"trade.limit", line->limit};
    ab_status status = AB_FAILED;
    if (vary.failed)
        fprintf(stderr, "abut: error: no memory\n");
    else
        status = ab_command_scene_with(line, more, count, registry, scene, report);
    ab_text_clear(&vary);
    return status;
}

/* Every value of every ladder on its own, the others as the scene has them: what the scene's check refuses is said before anything runs. */
static ab_status check_values(const ab_command_line *line, const ab_scene *scene, ab_registry *registry, ab_report *report) {
    ab_override *list = calloc(line->override_count + AB_TRADE_PATHS, sizeof *list);
    if (list == NULL) return ab_report_failure(report, "no memory");
    if (line->override_count > 0) memcpy(list, line->overrides, line->override_count * sizeof *list);
    ab_status status = AB_OK;
    for (size_t k = 0; k < scene->trade.ladder_count; k++) {
        const ab_ladder *ladder = &scene->trade.ladders[k];
        size_t wrong = 0;
        ab_report *first = NULL;
        for (size_t v = 0; v < ladder->value_count; v++) {
            size_t set = line->override_count;
            for (size_t p = 0; p < ladder->path_count; p++)
                if (strcmp(ladder->paths[p], AB_CHILD_THREADS) != 0) list[set++] = (ab_override){ladder->paths[p], ladder->values[v]};
            ab_report *own = ab_report_create();
            ab_scene *tried = NULL;
            if (own != NULL && ab_scene_read(line->words[0], list, set, registry, &tried, own) != AB_OK) wrong++;
            ab_scene_destroy(tried);
            if (first == NULL && wrong > 0)
                first = own;
            else
                ab_report_destroy(own);
        }
        if (wrong == ladder->value_count &&
            first != NULL) { /* some may go only with another ladder's value; all of them is a mistake in the path */
            status = ab_report_error(report, ladder->mark, "no value of '%s' is accepted; the first mistake: %s", ladder->name,
                                     ab_report_first_error(first) != NULL ? ab_report_first_error(first) : "not known");
        }
        ab_report_destroy(first);
    }
    free(list);
    return status;
}

/* Whether --write can be: before all runs, rather than after them. */
static ab_status check_place(const ab_command_line *line, ab_report *report) {
    if (line->write == NULL) return AB_OK;
    struct stat scene, there;
    const bool is_there = stat(line->write, &there) == 0;
    if (is_there && stat(line->words[0], &scene) == 0 && scene.st_dev == there.st_dev && scene.st_ino == there.st_ino)
        return ab_report_error(report, AB_NOWHERE, "--write %s: that is the scene itself, whose comments would be lost; name another file",
                               line->write);
    if (is_there && !S_ISREG(there.st_mode))
        return ab_report_error(report, AB_NOWHERE, "--write %s: that is no file that a scene can be kept in; name another", line->write);
    char folder[PATH_MAX];
    const char *slash = strrchr(line->write, '/');
    snprintf(folder, sizeof folder, "%.*s", slash == NULL ? 1 : (int)(slash - line->write) + (slash == line->write),
             slash == NULL ? "." : line->write);
    if (access(folder, W_OK) == 0) return AB_OK;
    return ab_report_error(report, AB_NOWHERE, "--write %s: the folder '%s' cannot be written: %s", line->write, folder, strerror(errno));
}

/* The scene with the settings of one run, on stdout's terms: a file that `abut run` takes. */
static ab_status write_scene(const ab_command_line *line, const ab_trade *trade, size_t chosen, ab_report *report) {
    if (chosen == SIZE_MAX) return ab_report_failure(report, "%s is not written: no run met the tolerance or the time", line->write);
    ab_document *document = NULL;
    AB_TRY(ab_document_read(trade->runs.scene, &document, report));
    ab_status status = AB_OK;
    for (size_t i = 0; i < trade->runs.override_count && status == AB_OK; i++)
        status = ab_document_set(document, trade->runs.overrides[i].path, trade->runs.overrides[i].value, report);
    for (size_t k = 0; k < trade->spec->ladder_count; k++) {
        const ab_ladder *ladder = &trade->spec->ladders[k];
        for (size_t p = 0; p < ladder->path_count && status == AB_OK; p++)
            if (strcmp(ladder->paths[p], AB_CHILD_THREADS) != 0) /* the first line of the file says them */
                status = ab_document_set(document, ladder->paths[p], ladder->values[trade->trials[chosen].rung[k]], report);
    }
    ab_text text = {0};
    char settings[2000], place[PATH_MAX]; /* where a link leads to; a file that is not there yet is its own place */
    const char *file = realpath(line->write, place) != NULL ? place : line->write;
    ab_text_add(&text, "# %s with %s\n", trade->runs.scene, ab_trade_settings(trade, &trade->trials[chosen], settings, sizeof settings));
    ab_document_write(&text, document);
    if (status == AB_OK)
        status = text.failed ? ab_report_failure(report, "no memory for %s", line->write)
                             : ab_file_replace(file, text.bytes, text.count, report);
    ab_text_clear(&text);
    ab_document_destroy(document);
    if (status == AB_OK) printf("  %s holds the scene with %s\n", line->write, settings);
    return status;
}

static ab_status trade_scene(const ab_command_line *line, const ab_scene *scene, ab_registry *registry, ab_report *report) {
    if (scene->trade.ladder_count == 0)
        return ab_report_error(report, AB_NOWHERE,
                               "%s has no `trade`, and no --vary is given: nothing to try; for example --vary grid.cell=0.5,0.25,0.125",
                               line->words[0]);
    AB_TRY(check_values(line, scene, registry, report));
    AB_TRY(check_place(line, report));
    char folder[PATH_MAX + 32];
    ab_trade trade = {.runs = ab_command_child_runs(line, "trade", folder, sizeof folder), .spec = &scene->trade};
    const ab_run_options options = {
        .threads = 1, .quiet = true, .methods = line->methods, .method_count = line->method_count, .interact = line->interact};
    ab_status status = ab_trade_order(&trade, &options, registry, report);
    if (status == AB_OK) status = ab_trade_plan(&trade, report);
    if (status == AB_OK) status = ab_trade_run(&trade, scene, registry, report);
    const bool stopped = status > 128;
    if (status == AB_OK || stopped) { /* what is done is judged all the same */
        ab_trade_judge(&trade, report);
        ab_status judged = ab_trade_write(&trade, report);
        ab_trade_table(&trade, stdout); /* also where there is no room for the files */
        if (judged == AB_OK && line->write != NULL) {
            size_t chosen = ab_trade_cheapest(&trade, scene->trade.tolerance);
            if (chosen == SIZE_MAX) chosen = ab_trade_most_accurate(&trade, scene->trade.seconds);
            judged = write_scene(line, &trade, chosen, report);
        }
        if (judged == AB_OK) printf("  %s holds trade.csv, trade.json and trade.svg\n", trade.runs.folder);
        size_t done = 0;
        for (size_t i = 0; i < trade.count; i++) done += trade.trials[i].run.state == AB_CHILD_DONE;
        if (judged == AB_OK && done == 0 && !stopped)
            judged = ab_report_failure(report, "no run came to its end; the table says why each did not");
        if (!stopped) status = judged;
    }
    ab_trade_clear(&trade);
    return status;
}

int ab_command_trade(const ab_command_line *line) { return ab_command_with_scene(line, read_scene, trade_scene); }
