/* command.c: the table of commands, and what is common to them: finding the command, its help, reading the scene. */
#include "core/commands.h"

#include <stdlib.h>
#include <string.h>

#include "core/suggest.h"

#if defined(__clang__)
#define COMPILER "clang " __clang_version__
#else
#define COMPILER "gcc " __VERSION__
#endif

static int command_plugins(const ab_command_line *line) {
    if (line->word_count && !strcmp(line->words[0], "new")) return ab_command_plugin_new(line);
    if (line->word_count && !strcmp(line->words[0], "check")) return ab_command_plugin_check(line);
    return ab_command_plugins(line);
}

static int command_version(const ab_command_line *line) {
    (void)line;
    printf("abut %s\nplugin interface %u.%u\nbuilt for %s by %s\n", ABUT_VERSION, AB_ABI_MAJOR, AB_ABI_MINOR,
           ABUT_ARCH[0] ? ABUT_ARCH : "any machine", COMPILER);
    return AB_OK;
}

static int command_help(const ab_command_line *line);

static const ab_command commands[] = {
    {"run", "SCENE", "run a scene; results.h5, results.xdmf, history.csv and summary.json land in the results folder",
     "Progress goes to standard error: a bar on a terminal, plain lines elsewhere. Results that are there already are replaced,\n"
     "but with --restart gone on with from the checkpoint.\n"
     "  abut run cases/block_on_incline/scene.yaml -o results/incline --set constants.mu=0.3",
     AB_OPTION_OUTPUT | AB_OPTION_THREADS | AB_OPTION_SET | AB_OPTION_PLUGIN_PATH | AB_OPTION_FORCE_PLUGINS | AB_OPTION_QUIET |
         AB_OPTION_STRICT | AB_OPTION_RESTART,
     1, 1, ab_command_run},
    {"check", "SCENE", "read a scene, load its plugins, say all that is wrong; nothing runs, nothing is written", NULL,
     AB_OPTION_SET | AB_OPTION_PLUGIN_PATH | AB_OPTION_FORCE_PLUGINS, 1, 1, ab_command_check},
    {"plan", "SCENE", "what this scene needs, and what it will not pay for: points, memory, passes, plugins, steps, time", NULL,
     AB_OPTION_THREADS | AB_OPTION_SET | AB_OPTION_PLUGIN_PATH | AB_OPTION_FORCE_PLUGINS | AB_OPTION_JSON, 1, 1, ab_command_plan},
    {"trade", "SCENE", "accuracy against cost: run a scene with several settings, and set its errors beside its cost",
     "The settings are those of the scene's `trade` (abut help scene), or given by --vary; every combination is run, or with --path those\n"
     "that are worth it, each in a process of its own. What was run before with the same scene is not run again. trade.csv, trade.json and "
     "trade.svg land in the results folder.\n"
     "  abut trade tests/verification/bar_1.yaml --vary constants.cells=25,50,100 --vary bodies.bar.basis=linear,gimp --tolerance 1e-2",
     AB_OPTION_OUTPUT | AB_OPTION_THREADS | AB_OPTION_SET | AB_OPTION_PLUGIN_PATH | AB_OPTION_FORCE_PLUGINS | AB_OPTION_QUIET |
         AB_OPTION_VARY | AB_OPTION_TOLERANCE | AB_OPTION_SECONDS | AB_OPTION_JOBS | AB_OPTION_LIMIT | AB_OPTION_WRITE | AB_OPTION_PATH,
     1, 1, ab_command_trade},
    {"extremes", "SCENE", "how far quantities go: where a run stops being right, where it stops being stable, from where it is refused",
     "The quantities are those of the scene's `extremes` (abut help scene), or given by --vary PATH=FROM..TO or PATH=a,b,c; each is "
     "driven\n"
     "on its own: a ladder of runs first, then halves where the verdict changes. What was run before with the same scene is not run again. "
     "extremes.csv, extremes.json and, with a map, map.svg land in\nthe results folder. --strict: exit 3 where a quantity does not hold.\n"
     "  abut extremes tests/verification/bar_1.yaml --vary time.cfl=0.1..1.2",
     AB_OPTION_OUTPUT | AB_OPTION_THREADS | AB_OPTION_SET | AB_OPTION_PLUGIN_PATH | AB_OPTION_FORCE_PLUGINS | AB_OPTION_QUIET |
         AB_OPTION_STRICT | AB_OPTION_VARY | AB_OPTION_JOBS | AB_OPTION_LIMIT | AB_OPTION_MAP,
     1, 1, ab_command_extremes},
    {"plugins", "[show NAME | new KIND NAME | check NAME]",
     "list the plugins found, tell all about one (settings with unit, range, default), or begin one",
     "Plugins are looked for in --plugin-path, in $ABUT_PLUGIN_PATH, then among those that came with abut.\n"
     "  abut plugins new KIND NAME     writes a plugin that works, to be changed: source, CMakeLists.txt and a scene; KIND is material, "
     "finder or\n"
     "                                 response (of contact). Into the folder NAME, or -o; nothing that is there is overwritten\n"
     "  abut plugins check FILE.so     (or the name of a class) tries the promises that abut_plugin.h asks of plugins, one per line; --set "
     "KEY=VALUE\n"
     "                                 gives a setting, in SI. Exit 1 where one is broken",
     AB_OPTION_PLUGIN_PATH | AB_OPTION_FORCE_PLUGINS | AB_OPTION_OUTPUT | AB_OPTION_SET, 0, 3, command_plugins},
    {"version", "", "the version, and what it was built for", NULL, 0, 0, 0, command_version},
    {"help", "[COMMAND | scene]", "this help, or more about one command, or every key of a scene file", NULL, 0, 0, 1, command_help},
    {.name = NULL},
};
enum { command_count = sizeof commands / sizeof *commands - 1 };

/* The command of that name, or NULL with the reason printed. */
static const ab_command *find_command(const char *name) {
    const char *names[command_count];
    size_t count = 0;
    for (size_t i = 0; i < command_count; i++) {
        if (commands[i].run) names[count++] = commands[i].name;
        if (strcmp(commands[i].name, name) != 0) continue;
        if (commands[i].run) return &commands[i];
        fprintf(stderr, "abut: error: '%s' is not in this version yet; `abut help` lists what is\n", name);
        return NULL;
    }
    const char *near = ab_suggest(name, names, count);
    if (near)
        fprintf(stderr, "abut: error: unknown command '%s'; did you mean '%s'?\n", name, near);
    else
        fprintf(stderr, "abut: error: unknown command '%s'; `abut help` lists the commands\n", name);
    return NULL;
}

static int command_help(const ab_command_line *line) {
    if (line->word_count && !strcmp(line->words[0], "scene")) {
        ab_scene_write_reference(stdout);
        return AB_OK;
    }
    const ab_command *command = line->word_count ? find_command(line->words[0]) : NULL;
    if (line->word_count && !command) return AB_BAD_INPUT;
    ab_command_help(commands, command, stdout);
    return AB_OK;
}

/* What was printed has to arrive, or the exit status says that it did not. */
static int flushed(int status) {
    if (fflush(stdout) == 0 && !ferror(stdout)) return status;
    fprintf(stderr, "abut: error: standard output could not be written\n");
    return status == AB_OK ? AB_FAILED : status;
}

int ab_command_main(int argc, char **argv, const ab_method *methods, size_t method_count, ab_interaction_maker interact) {
    if (argc < 2) {
        ab_command_help(commands, NULL, stderr);
        return AB_BAD_INPUT;
    }
    const char *name = argv[1];
    if (!strcmp(name, "--help") || !strcmp(name, "-h")) name = "help";
    if (!strcmp(name, "--version")) name = "version";
    const ab_command *command = find_command(name);
    if (!command) return AB_BAD_INPUT;
    ab_command_line line = {.methods = methods, .method_count = method_count, .interact = interact};
    int status = ab_command_line_read(command, argc - 1, argv + 1, &line);
    if (status == AB_OK) {
        status = command->run(&line);
    } else if (status < 0) {
        ab_command_help(commands, strcmp(command->name, "help") ? command : NULL, stdout);
        status = AB_OK;
    }
    ab_command_line_clear(&line);
    return flushed(status);
}

ab_status ab_command_scene_with(const ab_command_line *line, const ab_override *more, size_t count, ab_registry **registry,
                                ab_scene **scene, ab_report *report) {
    ab_command_line whole = *line;
    whole.overrides = calloc(line->override_count + count + 1, sizeof *whole.overrides);
    if (whole.overrides == NULL) {
        fprintf(stderr, "abut: error: no memory\n");
        return AB_FAILED;
    }
    if (line->override_count > 0) memcpy(whole.overrides, line->overrides, line->override_count * sizeof *more);
    if (count > 0) memcpy(whole.overrides + line->override_count, more, count * sizeof *more);
    whole.override_count = line->override_count + count;
    const ab_status status = ab_command_scene(&whole, registry, scene, report);
    free(whole.overrides);
    return status;
}

ab_status ab_command_scene(const ab_command_line *line, ab_registry **registry, ab_scene **scene, ab_report *report) {
    *scene = NULL;
    *registry = NULL;
    ab_status status = ab_registry_create(line->plugin_path, registry, report);
    if (status == AB_OK && line->force_plugins) ab_registry_force(*registry);
    if (status == AB_OK) status = ab_scene_read(line->words[0], line->overrides, line->override_count, *registry, scene, report);
    if (status == AB_OK) return AB_OK;
    ab_report_print(report, stderr);
    ab_registry_destroy(*registry);
    *registry = NULL;
    return status;
}

int ab_command_with_scene(const ab_command_line *line, ab_status (*read)(const ab_command_line *, ab_registry **, ab_scene **, ab_report *),
                          ab_status (*act)(const ab_command_line *, const ab_scene *, ab_registry *, ab_report *)) {
    ab_report *report = ab_report_create();
    if (report == NULL) {
        fprintf(stderr, "abut: error: no memory\n");
        return AB_FAILED;
    }
    ab_registry *registry = NULL;
    ab_scene *scene = NULL;
    ab_status status = read(line, &registry, &scene, report);
    if (status == AB_OK) {
        ab_report_print(report, stderr);
        status = act(line, scene, registry, report);
        ab_report_print(report, stderr);
        ab_scene_destroy(scene);
        ab_registry_destroy(registry);
    }
    ab_report_destroy(report);
    return (int)status;
}

ab_child_runs ab_command_child_runs(const ab_command_line *line, const char *ending, char *folder, size_t size) {
    ab_command_folder(line->words[0], folder, size);
    const size_t length = strlen(folder);
    snprintf(folder + length, size - length, "-%s", ending);
    return (ab_child_runs){.scene = line->words[0],
                           .folder = line->output != NULL ? line->output : folder,
                           .plugin_path = line->plugin_path,
                           .force_plugins = line->force_plugins,
                           .overrides = line->overrides,
                           .override_count = line->override_count,
                           .jobs = line->jobs > 0 ? line->jobs : 1,
                           .threads = line->threads > 0 ? line->threads : 1,
                           .quiet = line->quiet};
}
