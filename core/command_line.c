/* command_line.c: from argv to an ab_command_line, and the help that goes with it. One table says what options there are. */
#include "core/commands.h"

#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#include "core/suggest.h"

enum { most_threads = 4096 };

typedef struct option_text {
    unsigned bit;
    const char *name;
    char letter;       /* 0: none */
    const char *value; /* NULL: a flag */
    const char *help;
} option_text;

static const option_text option_texts[] = {
    {AB_OPTION_OUTPUT, "output", 'o', "DIR", "folder of the results (default: results/NAME, NAME being the scene's folder or file)"},
    {AB_OPTION_THREADS, "threads", 'j', "N",
     "threads to run on (default: all cores, fewer for a small scene); results do not depend on it"},
    {AB_OPTION_SET, "set", 0, "PATH=VALUE", "put VALUE in the scene at PATH, such as contact[0].friction=0.3; may be repeated"},
    {AB_OPTION_PLUGIN_PATH, "plugin-path", 0, "FOLDERS", "look for plugins here first; folders separated by ':'"},
    {AB_OPTION_FORCE_PLUGINS, "force-plugins", 0, NULL, "load plugins from files and folders that other users can write to"},
    {AB_OPTION_RESTART, "restart", 0, "FILE", "go on from a checkpoint, such as DIR/checkpoint.abut; with -o DIR in the same results"},
    {AB_OPTION_QUIET, "quiet", 'q', NULL, "no progress and no closing table"},
    {AB_OPTION_STRICT, "strict", 0, NULL, "exit 3 when an expect of the scene is missed (extremes: when a quantity does not hold)"},
    {AB_OPTION_JSON, "json", 0, NULL, "print JSON"},
    {AB_OPTION_VARY, "vary", 0, "PATH=VALUES",
     "values to try at PATH, separated by commas (extremes: from easy to hard, or FROM..TO); may be repeated"},
    {AB_OPTION_PATH, "path", 0, NULL, "follow the best settings from the scene's own, in place of all combinations"},
    {AB_OPTION_TOLERANCE, "tolerance", 0, "ERROR", "which is the cheapest run with no larger error than this"},
    {AB_OPTION_SECONDS, "seconds", 0, "S", "which is the most accurate run that takes no more processor time than this"},
    {AB_OPTION_JOBS, "jobs", 0, "N", "runs at a time (default: 1); more disturb each other's times"},
    {AB_OPTION_LIMIT, "limit", 0, "S", "stop a run that takes longer than this"},
    {AB_OPTION_MAP, "map", 0, "A,B", "run all combinations of two of the quantities, for map.svg"},
    {AB_OPTION_WRITE, "write", 0, "FILE", "write the scene with the settings that were found"},
};
enum { option_count = sizeof option_texts / sizeof *option_texts };

/* ---- help --------------------------------------------------------------------------------------------------------------------------- */

static void print_options(unsigned options, FILE *stream) {
    fprintf(stream, "\nOptions:\n");
    for (size_t i = 0; i < option_count; i++) {
        const option_text *text = &option_texts[i];
        if (!(options & text->bit)) continue;
        char left[64], letter[8] = "    ";
        if (text->letter) snprintf(letter, sizeof letter, "-%c, ", text->letter);
        snprintf(left, sizeof left, "%s--%s%s%s", letter, text->name, text->value ? " " : "", text->value ? text->value : "");
        fprintf(stream, "  %-26s %s\n", left, text->help);
    }
    fprintf(stream, "  %-26s %s\n", "-h, --help", "this help");
}

static void print_exit_codes(FILE *stream) {
    fprintf(stream, "\nExit status: 0 done; 1 the run failed; 2 the input is wrong; 3 an expect was missed with --strict;\n"
                    "130, 143 stopped by a signal, checkpoint written.\n");
}

void ab_command_help(const ab_command *commands, const ab_command *command, FILE *stream) {
    if (command) {
        fprintf(stream, "Usage: abut %s%s%s%s\n\n%s\n", command->name, command->options ? " [OPTION]..." : "", command->words[0] ? " " : "",
                command->words, command->summary);
        if (command->help) fprintf(stream, "\n%s\n", command->help);
        print_options(command->options, stream);
        print_exit_codes(stream);
        return;
    }
    fprintf(
        stream,
        "abut %s: bodies of material points in contact, through algorithms loaded at run time.\n\nUsage: abut COMMAND ...\n\nCommands:\n",
        ABUT_VERSION);
    for (const ab_command *c = commands; c->name; c++) {
        if (!c->run) continue;
        char left[64];
        snprintf(left, sizeof left, "%s %s", c->name, c->words);
        fprintf(stream, "  %-26s %s\n", left, c->summary);
    }
    fprintf(stream, "\n`abut help COMMAND` tells more about one of them.\n");
    print_exit_codes(stream);
}

/* ---- reading ------------------------------------------------------------------------------------------------------------------------ */

static int wrong(const ab_command *command, const char *format, const char *what, const char *remedy) {
    fprintf(stderr, "abut %s: error: ", command->name);
    fprintf(stderr, format, what);
    fprintf(stderr, "%s%s\n", remedy[0] ? "; " : "", remedy);
    return AB_BAD_INPUT;
}

static int unknown_option(const ab_command *command, const char *given) {
    const char *names[option_count + 1];
    size_t count = 0;
    for (size_t i = 0; i < option_count; i++)
        if (command->options & option_texts[i].bit) names[count++] = option_texts[i].name;
    names[count++] = "help";
    char bare[64], remedy[160];
    snprintf(bare, sizeof bare, "%.*s", (int)strcspn(given + strspn(given, "-"), "="), given + strspn(given, "-"));
    const char *near = strlen(bare) > 1 ? ab_suggest(bare, names, count) : NULL;
    if (near)
        snprintf(remedy, sizeof remedy, "did you mean '--%s'?", near);
    else
        snprintf(remedy, sizeof remedy, "`abut help %s` lists the options", command->name);
    return wrong(command, "unknown option '%s'", given, remedy);
}

static int read_count(const ab_command *command, const char *text, int *count, const char *complaint, const char *remedy) {
    char *end = NULL;
    errno = 0;
    const long value = strtol(text, &end, 10);
    if (errno || end == text || *end || value < 1 || value > most_threads) return wrong(command, complaint, text, remedy);
    *count = (int)value;
    return AB_OK;
}

/* A positive number, which the scene's own check reads again. */
static int read_positive(const ab_command *command, const char *text, const char **kept, const char *complaint) {
    char *end = NULL;
    const double value = strtod(text, &end);
    if (end == text || *end || !(value > 0)) return wrong(command, complaint, text, "for example 1e-2");
    *kept = text;
    return AB_OK;
}

static int read_pair(const ab_command *command, char *text, ab_override *list, size_t *count, const char *complaint, const char *remedy) {
    char *equals = strchr(text, '=');
    if (!equals || equals == text) return wrong(command, complaint, text, remedy);
    *equals = '\0'; /* argv is ours to cut */
    list[(*count)++] = (ab_override){text, equals + 1};
    return AB_OK;
}

static int read_option(const ab_command *command, const option_text *option, char *value, ab_command_line *line) {
    switch (option->bit) {
    case AB_OPTION_OUTPUT:
        if (!value[0]) return wrong(command, "%s wants the name of a folder", "-o", "");
        line->output = value;
        return AB_OK;
    case AB_OPTION_THREADS:
        return read_count(command, value, &line->threads, "-j wants a number of threads from 1 to 4096, not '%s'",
                          "leave it out to use as many as the scene is worth");
    case AB_OPTION_JOBS:
        return read_count(command, value, &line->jobs, "--jobs wants a number of runs from 1 to 4096, not '%s'",
                          "leave it out for one at a time");
    case AB_OPTION_SET:
        return read_pair(command, value, line->overrides, &line->override_count, "--set wants PATH=VALUE, not '%s'",
                         "for example --set contact[0].friction=0.3");
    case AB_OPTION_VARY:
        return read_pair(command, value, line->vary, &line->vary_count,
                         "--vary wants PATH=VALUE,VALUE,... (extremes: or PATH=FROM..TO), not '%s'",
                         "for example --vary constants.cells=20,40,80");
    case AB_OPTION_TOLERANCE: return read_positive(command, value, &line->tolerance, "--tolerance wants an error above 0, not '%s'");
    case AB_OPTION_SECONDS: return read_positive(command, value, &line->seconds, "--seconds wants a time above 0, not '%s'");
    case AB_OPTION_LIMIT: return read_positive(command, value, &line->limit, "--limit wants seconds above 0, not '%s'");
    case AB_OPTION_MAP:
        if (!strchr(value, ','))
            return wrong(command, "--map wants two names with a comma between them, not '%s'", value, "for example --map cfl,mu");
        line->map = value;
        return AB_OK;
    case AB_OPTION_WRITE:
        if (!value[0]) return wrong(command, "%s wants the name of a file", "--write", "");
        line->write = value;
        return AB_OK;
    case AB_OPTION_PLUGIN_PATH: line->plugin_path = value; return AB_OK;
    case AB_OPTION_FORCE_PLUGINS: line->force_plugins = true; return AB_OK;
    case AB_OPTION_RESTART:
        if (!value[0]) return wrong(command, "%s wants the name of a checkpoint", "--restart", "");
        line->restart = value;
        return AB_OK;
    case AB_OPTION_QUIET: line->quiet = true; return AB_OK;
    case AB_OPTION_PATH: line->path = true; return AB_OK;
    case AB_OPTION_STRICT: line->strict = true; return AB_OK;
    default: line->json = true; return AB_OK;
    }
}

static int check_words(const ab_command *command, const ab_command_line *line) {
    char remedy[96];
    snprintf(remedy, sizeof remedy, "usage: abut %s %s", command->name, command->words);
    if (line->word_count < command->fewest) return wrong(command, "%s missing", command->words, remedy);
    if (line->word_count > command->most) return wrong(command, "one word too many: '%s'", line->words[command->most], remedy);
    return AB_OK;
}

int ab_command_line_read(const ab_command *command, int argc, char **argv, ab_command_line *line) {
    struct option longs[option_count + 2] = {{0}};
    char shorts[2 * option_count + 4] = ":h"; /* ':' first: a missing value is told from an unknown option */
    int count = 0, letters = 2;
    enum { help_code = 256, first_code = 257 };
    longs[count++] = (struct option){"help", no_argument, NULL, help_code};
    for (int i = 0; i < option_count; i++) {
        const option_text *text = &option_texts[i];
        if (!(command->options & text->bit)) continue;
        longs[count++] = (struct option){text->name, text->value ? required_argument : no_argument, NULL, first_code + i};
        if (text->letter) shorts[letters++] = text->letter;
        if (text->letter && text->value) shorts[letters++] = ':';
    }
    line->overrides = calloc((size_t)argc + 1, sizeof *line->overrides);
    line->vary = calloc((size_t)argc + 1, sizeof *line->vary);
    if (!line->overrides || !line->vary) return wrong(command, "%s", "no memory", "");
    optind = 0; /* from the start, with glibc's own state cleared */
    opterr = 0;
    for (;;) {
        const int before = optind ? optind : 1;
        const int code = getopt_long(argc, argv, shorts, longs, NULL);
        if (code == -1) break;
        if (code == 'h' || code == help_code) return -1;
        const char *given = argv[optind > before ? optind - 1 : before];
        if (code == ':') return wrong(command, "option '%s' wants a value", given, "");
        if (code == '?') {
            char letter[3] = {'-', (char)optopt, '\0'};
            return unknown_option(command, optopt > 0 && optopt < 256 ? letter : given);
        }
        const option_text *option = code >= first_code ? &option_texts[code - first_code] : NULL;
        for (size_t i = 0; !option && i < option_count; i++)
            if (option_texts[i].letter == code) option = &option_texts[i];
        const int status = read_option(command, option, optarg, line);
        if (status != AB_OK) return status;
    }
    line->words = argv + optind;
    line->word_count = argc - optind;
    return check_words(command, line);
}

void ab_command_line_clear(ab_command_line *line) {
    free(line->overrides);
    free(line->vary);
    line->overrides = line->vary = NULL;
    line->override_count = line->vary_count = 0;
}
