/* commands.h: the command line: which commands there are, which options each takes, and the functions behind them. main.c joins them. */
#ifndef AB_COMMANDS_H
#define AB_COMMANDS_H

#include "core/child_runs.h"
#include "core/scheduler.h"

enum ab_option_bits { /* options a command takes */
                      AB_OPTION_OUTPUT = 1u,
                      AB_OPTION_THREADS = 2u,
                      AB_OPTION_SET = 4u,
                      AB_OPTION_PLUGIN_PATH = 8u,
                      AB_OPTION_QUIET = 16u,
                      AB_OPTION_STRICT = 32u,
                      AB_OPTION_JSON = 64u,
                      AB_OPTION_VARY = 128u,
                      AB_OPTION_TOLERANCE = 256u,
                      AB_OPTION_SECONDS = 512u,
                      AB_OPTION_JOBS = 1024u,
                      AB_OPTION_WRITE = 2048u,
                      AB_OPTION_LIMIT = 4096u,
                      AB_OPTION_MAP = 8192u,
                      AB_OPTION_RESTART = 1u << 16,
                      AB_OPTION_FORCE_PLUGINS = 1u << 17,
                      AB_OPTION_PATH = 16384u
};

/* A command line once it is understood. Texts are borrowed from argv. */
typedef struct ab_command_line {
    const char *output;      /* -o; NULL: not given */
    int threads;             /* -j; 0: not given */
    const char *plugin_path; /* --plugin-path; NULL: not given */
    const char *restart;     /* --restart FILE; NULL: not given */
    bool force_plugins;      /* those that others can write to are loaded too */
    bool quiet, strict, json;
    ab_override *overrides; /* --set, in order */
    size_t override_count;
    ab_override *vary; /* --vary PATH=VALUE,VALUE,... in order */
    size_t vary_count;
    bool path;                       /* --path */
    const char *tolerance, *seconds; /* as written; NULL: not given */
    int jobs;                        /* 0: not given */
    const char *write;               /* --write FILE */
    const char *limit, *map;         /* --limit S, --map A,B; NULL: not given */
    char **words;                    /* what is not an option: the scene, or the words of `abut plugins` */
    int word_count;
    const ab_method *methods; /* main's table: how a body of each method is made */
    size_t method_count;
    ab_interaction_maker interact; /* main's contact */
} ab_command_line;

typedef struct ab_command {
    const char *name, *words;                /* "run", "SCENE" */
    const char *summary;                     /* one line */
    const char *help;                        /* the rest, shown by `abut help NAME` */
    unsigned options;                        /* or of enum ab_option_bits */
    int fewest, most;                        /* words it takes */
    int (*run)(const ab_command_line *line); /* returns the exit status; NULL: not in this version */
} ab_command;

/* Reads argv with main's table of methods, runs the command, returns the exit status (docs/user.md). Commands end in a NULL name. */
int ab_command_main(int argc, char **argv, const ab_method *methods, size_t method_count, ab_interaction_maker interact);

/* argv[1..argc-1] are the options and words behind the command. Returns AB_OK, or AB_BAD_INPUT with the reason printed, or -1 where the
 * command's help is asked for. Release with ab_command_line_clear either way. */
int ab_command_line_read(const ab_command *command, int argc, char **argv, ab_command_line *line);
void ab_command_line_clear(ab_command_line *line);

/* Help on one command, or (NULL) on the program. */
void ab_command_help(const ab_command *commands, const ab_command *command, FILE *stream);

/* Reads the scene that the line names, with its plugins. On failure the report is printed and both are NULL. */
ab_status ab_command_scene(const ab_command_line *line, ab_registry **registry, ab_scene **scene, ab_report *report);
/* Reads the scene by `read` (ab_command_scene, or a command's own), prints its warnings, before a long run rather than after it, and lets `act` use it. Returns the exit
 * status; all is printed and released. */
int ab_command_with_scene(const ab_command_line *line, ab_status (*read)(const ab_command_line *, ab_registry **, ab_scene **, ab_report *),
                          ab_status (*act)(const ab_command_line *, const ab_scene *, ab_registry *, ab_report *));
/* The same with more overrides behind those of the line. */
ab_status ab_command_scene_with(const ab_command_line *line, const ab_override *more, size_t count, ab_registry **registry,
                                ab_scene **scene, ab_report *report);

int ab_command_run(const ab_command_line *line);
int ab_command_check(const ab_command_line *line);
int ab_command_plan(const ab_command_line *line);
int ab_command_trade(const ab_command_line *line);    /* command_trade.c */
int ab_command_extremes(const ab_command_line *line); /* command_extremes.c */

/* Runs of the line's scene as child processes, in -o or (that text goes into `folder`) in results/NAME-ENDING. */
ab_child_runs ab_command_child_runs(const ab_command_line *line, const char *ending, char *folder, size_t size);

/* results/NAME: NAME is the scene's folder where the file is called scene.yaml, else the file without its ending. */
void ab_command_folder(const char *scene, char *folder, size_t size);

/* core/command_plugins.c: the list, and `show NAME`. */
int ab_command_plugins(const ab_command_line *line);

/* `abut plugins new KIND NAME`: core/command_plugin_new.c; words[0] is "new". */
int ab_command_plugin_new(const ab_command_line *line);

/* `abut plugins check FILE.so|NAME`: core/check.c; words[0] is "check". */
int ab_command_plugin_check(const ab_command_line *line);

#endif
