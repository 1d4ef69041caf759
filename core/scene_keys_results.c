/* scene_keys_results.c: what a scene may say of its results, key by key: monitors, files, expects, trade and extremes; tables. */
#include "core/scene_section.h"

static const ab_key monitor[] = {
    [MONITOR_NAME] = {"name", AB_KEY_TEXT, .flags = AB_KEY_REQUIRED, .help = "its column in history.csv"},
    [MONITOR_BODY] = {"body", AB_KEY_NAME, .help = "of a body; without body, contact and boundary: of the whole scene"},
    [MONITOR_CONTACT] = {"contact", AB_KEY_INTEGER, .unit = "1", .help = "of a contact: its place in the list, from 0"},
    [MONITOR_BOUNDARY] = {"boundary", AB_KEY_INTEGER, .unit = "1", .help = "of a boundary: its place in the list, from 0"},
    [MONITOR_VALUE] = {"value", AB_KEY_TEXT, .flags = AB_KEY_REQUIRED, .help = "what is followed; the lists stand below"},
    [MONITOR_AT] = {"at", AB_KEY_POINT, .unit = "m", .help = "of the one point that is nearest to this place at the start"},
    [MONITOR_OVER] = {"over", AB_KEY_WORD, .words = "mass|volume|max|min|sum|rms",
                      .help = "how the body's points become one number; default mass"},
    [MONITOR_WHERE] = {"where", AB_KEY_SECTION, .help = "of the points that stood here at the start"},
    [MONITOR_MINUS] =
        {"minus", AB_KEY_FORMULA, .variables = AB_VARIABLES_T_START,
         .help = "taken from the value at every point before they become one number, in the unit of the value; X, Y: the place of "
                 "the point at the start. With over: rms the error against an exact field"},
};
SECTION(monitor, "monitors[i]", monitor, NULL, "A list.",
        "monitors:\n  - {name: block_x, body: block, value: position.x}\n  - {name: push, contact: 0, value: force.y}\n"
        "  - {name: error, body: block, value: displacement.x, minus: \"1e-3*X*t\", over: rms}\n");

static const ab_key history[] = {
    [HISTORY_EVERY] = {"every", AB_KEY_INTEGER, .unit = "1", .initial = "1", .flags = AB_KEY_RANGE, .min = 1, .max = 1e9,
                       .help = "steps from row to row"},
};
SECTION(history, "history", history, NULL, "Rows of history.csv.", "history: {every: 10}\n");

static const ab_key output[] = {
    [OUTPUT_EVERY] = {"every", AB_KEY_NUMBER, .unit = "s", .initial = "0", .flags = AB_KEY_RANGE, .min = 0, .max = ANY,
                      .help = "time from frame to frame; 0: the first and the last only"},
    [OUTPUT_FIELDS] = {"fields", AB_KEY_SECTION, .help = "list of fields; positions are always there"},
    [OUTPUT_CONTACT] =
        {"contact", AB_KEY_FLAG, .initial = "false",
         .help =
             "true: the contact points of each contact too, with normal, gap, area, force on the second body, pressure, shear, and slip"},
};
SECTION(output, "output", output, NULL,
        "Frames of results.h5. Only what is asked for is written. Besides the fields below, a state of a material by its name. "
        "Contact points of the step before the frame stand in a group of their own for each contact, contact_0 and on "
        "(results_contact_0.xdmf shows them).",
        "output: {every: \"20 ms\", fields: [stress, velocity]}\n");

static const ab_key expect[] = {
    [EXPECT_NAME] = {"name", AB_KEY_TEXT, .flags = AB_KEY_REQUIRED, .help = "what the closing table calls it"},
    [EXPECT_MONITOR] = {"monitor", AB_KEY_NAME, .help = "name of a monitor"},
    [EXPECT_COLUMN] = {"column", AB_KEY_TEXT, .help = "or a ledger column of history.csv (kinetic, block.kinetic, remainder ...)"},
    [EXPECT_REFERENCE] = {"reference", AB_KEY_FORMULA, .flags = AB_KEY_REQUIRED, .variables = AB_VARIABLE_T,
                          .help = "the right answer, in the unit of the monitor and norm"},
    [EXPECT_NORM] = {"norm", AB_KEY_WORD, .initial = "final",
                     .words = "final|max|l2|mean|peak|min|range|time-of-peak|first-above|last-above|duration|integral|impulse|slope",
                     .help = "what is compared; the list stands below"},
    [EXPECT_TOLERANCE] = {"tolerance", AB_KEY_NUMBER, .unit = "1", .flags = AB_KEY_REQUIRED | AB_KEY_RANGE, .min = 0, .max = ANY,
                          .help = "largest error allowed, relative to scale"},
    [EXPECT_SCALE] = {"scale", AB_KEY_NUMBER, POSITIVE,
                      .help = "size that errors are measured by, in the unit of the reference; default: the reference's own size"},
    [EXPECT_FROM] = {"from", AB_KEY_NUMBER, .unit = "s", .initial = "0", .flags = AB_KEY_RANGE, .min = 0, .max = ANY,
                     .help = "beginning of the time window"},
    [EXPECT_TO] = {"to", AB_KEY_NUMBER, .unit = "s", POSITIVE, .help = "end of the time window; default: the end of the run"},
    [EXPECT_LEVEL] = {"level", AB_KEY_NUMBER, .help = "threshold, in the unit of the monitor; for norms that ask for one"},
};
SECTION(expect, "expect[i]", expect, NULL,
        "A list. Each compares a monitor or a column with a reference; `abut run --strict` exits 3 when one misses.",
        "expect:\n  - {name: slides, monitor: block_x, reference: \"0.5*a*t^2\", norm: l2, tolerance: 0.02}\n");

static const ab_key watchdog[] = {
    [WATCHDOG_ENERGY] = {"energy", AB_KEY_NUMBER, .unit = "1", .initial = "0.5", POSITIVE,
                         .help = "the ledger's remainder, as a part of the energy put into the run (what it starts with, work from "
                                 "outside, weight), above which it is ended"},
    [WATCHDOG_STOP] = {"stop", AB_KEY_FLAG, .initial = "true", .help = "false: it goes on, and the closing table says how much was made"},
};
SECTION(watchdog, "watchdog", watchdog, NULL,
        "A run that goes on making energy has no result; it is ended, with the body, the place, the likely cause and the remedy.",
        "watchdog: {energy: 0.1}\n");

static const ab_key checkpoint[] = {
    [CHECKPOINT_EVERY] = {"every", AB_KEY_NUMBER, .unit = "s", POSITIVE, .help = "time between checkpoints"},
    [CHECKPOINT_STEPS] = {"steps", AB_KEY_INTEGER, .flags = AB_KEY_RANGE, .min = 1, .max = INFINITY, .unit = "1",
                          .help = "steps between checkpoints"},
    [CHECKPOINT_WALL] = {"wall", AB_KEY_NUMBER, .unit = "min", POSITIVE,
                         .help = "minutes on the clock between checkpoints; a bare number is minutes, others have their unit (\"2 h\")"},
};
SECTION(checkpoint, "checkpoint", checkpoint, NULL,
        "One of them or more; and one at the end. `checkpoint.abut` lies in the folder of the results, the one before it beside it; `abut "
        "run SCENE --restart FILE` "
        "goes on from it, to the same last bit as if it had never stopped (docs/runs.md). A run that is stopped by a signal leaves one in "
        "any case.",
        "checkpoint: {every: 0.5, wall: 30}\n");

static const ab_key trade[] = {
    [TRADE_VARY] = {"vary", AB_KEY_SECTION, .help = "list of ladders"},
    [TRADE_ERROR] =
        {"error", AB_KEY_SECTION,
         .help =
             "list of names of expects, or of monitors in a scene without expects: the error of a run is the largest of theirs; default: "
             "all. Monitors are measured against the finest of the runs, or the limit that they tend to"},
    [TRADE_TOLERANCE] = {"tolerance", AB_KEY_NUMBER, .unit = "1", .initial = "0.01", POSITIVE,
                         .help = "the error to be met for the least cost"},
    [TRADE_SECONDS] = {"seconds", AB_KEY_NUMBER, .unit = "s", .initial = "10", POSITIVE,
                       .help = "the cost within which to be most accurate"},
    [TRADE_LIMIT] = {"limit", AB_KEY_NUMBER, .unit = "s", POSITIVE,
                     .help = "a run that takes longer is stopped, and dearer ones of the same ladder are not tried; default: none"},
    [TRADE_SEARCH] = {"search", AB_KEY_WORD, .words = "all|path", .initial = "all",
                      .help =
                          "all: every combination of the ladders is run; path: from the scene's own settings on, those next to the best "
                          "so far (docs/trade.md)"},
    [TRADE_COST] = {"cost", AB_KEY_WORD, .words = "cpu|wall", .initial = "cpu",
                    .help = "cpu: seconds of the processor, of all threads; wall: seconds until it is done, where `threads` are a ladder"},
};
SECTION(trade, "trade", trade, NULL,
        "Accuracy against cost: `abut trade SCENE` runs the scene with several settings. `threads` is a setting, too.",
        "trade:\n  vary:\n    - {set: constants.cells, values: [20, 40, 80]}\n    - {name: basis, set: [bodies.a.basis, bodies.b.basis], "
        "values: [linear, gimp]}\n  tolerance: 1e-2\n  seconds: 10\n");

static const ab_key ladder[] = {
    [LADDER_SET] = {"set", AB_KEY_SECTION, .flags = AB_KEY_REQUIRED,
                    .help = "path of a value, as for --set, or a list of paths that all get it"},
    [LADDER_VALUES] = {"values", AB_KEY_SECTION, .flags = AB_KEY_REQUIRED, .help = "list of values, in any order"},
    [LADDER_NAME] = {"name", AB_KEY_TEXT, .help = "what the table calls it; default: the path"},
};
SECTION(ladder, "trade.vary[i]", ladder, NULL, "A list.", "- {set: grid.cell, values: [0.5, 0.25, 0.125]}\n");

static const ab_key extremes[] = {
    [EXTREMES_VARY] = {"vary", AB_KEY_SECTION, .help = "list of quantities; each is driven on its own, the others as the scene has them"},
    [EXTREMES_MAP] = {"map", AB_KEY_SECTION,
                      .help = "[name, name]: two of the quantities, of which all combinations of rungs are run for a picture, map.svg"},
    [EXTREMES_LIMIT] = {"limit", AB_KEY_NUMBER, .unit = "s", POSITIVE,
                        .help = "a run that takes longer is stopped and counts as not stable; default: none"},
    [EXTREMES_ENERGY] = {"energy", AB_KEY_NUMBER, .unit = "1", .initial = "0.1", POSITIVE,
                         .help = "the ledger's remainder at the end of a run, as a part of the largest energy that moved, above which the "
                                 "run made energy and counts as not stable"},
};
SECTION(extremes, "extremes", extremes, NULL,
        "How far quantities go: `abut extremes SCENE` finds where the run stops being right (an expect is missed), where it stops being "
        "stable, and from where it is refused.",
        "extremes:\n  vary:\n    - {name: dt, set: time.cfl, from: 0.1, to: 1.2, right_to: 0.9}\n    - {name: stiffness ratio, set: "
        "constants.ratio, from: 1, "
        "to: 1e8}\n  map: [dt, stiffness ratio]\n  limit: 20\n");

static const ab_key extreme[] = {
    [EXTREME_SET] = {"set", AB_KEY_SECTION, .flags = AB_KEY_REQUIRED,
                     .help = "path of a value, as for --set, or a list of paths that all get it"},
    [EXTREME_NAME] = {"name", AB_KEY_TEXT, .help = "what the table calls it; default: the path"},
    [EXTREME_FROM] = {"from", AB_KEY_NUMBER, .help = "where to begin: the easy end"},
    [EXTREME_TO] = {"to", AB_KEY_NUMBER, .help = "where to end, below or above `from`"},
    [EXTREME_SCALE] = {"scale", AB_KEY_WORD, .words = "log|linear",
                       .help = "how rungs are spaced and halved; default: log where the ends have one sign and differ a hundredfold"},
    [EXTREME_RUNGS] = {"rungs", AB_KEY_INTEGER, .unit = "1", .flags = AB_KEY_RANGE, .min = 2, .max = 64,
                       .help = "values tried before any is halved, both ends among them; default: 9, or one a decade with log"},
    [EXTREME_UNTIL] = {"until", AB_KEY_NUMBER, .unit = "1", .initial = "0.02", POSITIVE,
                       .help = "halving ends where the bracket is this narrow: as a part of the range, with log of the value"},
    [EXTREME_WHOLE] = {"whole", AB_KEY_FLAG, .initial = "false", .help = "whole numbers alone"},
    [EXTREME_VALUES] = {"values", AB_KEY_SECTION, .help = "list of values, numbers or words, in place of from and to; none is halved"},
    [EXTREME_VALUE] = {"value", AB_KEY_TEXT,
                       .help = "what is put at the path, @ standing for the number: '@*h/c', '{flip: @}'; default: the number"},
    [EXTREME_RIGHT_TO] = {"right_to", AB_KEY_NUMBER,
                          .help = "it must be right up to there; beyond, a run may also end with an error of its own. Without it, runs "
                                  "must be right or refused everywhere"},
    [EXTREME_SAME] = {"same", AB_KEY_NUMBER, .unit = "1", POSITIVE,
                      .help = "with `values`: the number that each expect looks at, as a part of its reference, must be that of the first "
                              "value to within this"},
    [EXTREME_WITH] = {"with", AB_KEY_SECTION,
                      .help = "mapping of further paths to the values they have meanwhile: {bodies.bar.basis: linear}"},
    [EXTREME_OPEN] = {"open", AB_KEY_TEXT,
                      .help =
                          "in words, why it does not hold yet; --strict then asks that it does not, so that the word goes when it does"},
};
SECTION(extreme, "extremes.vary[i]", extreme, NULL, "A list.",
        "- {name: friction, set: constants.mu, from: 1e-3, to: 1e6}\n- {set: constants.turned, values: [0, 1], same: 1e-10}\n");

static const ab_key table[] = {
    [TABLE_FILE] =
        {"file", AB_KEY_TEXT, .flags = AB_KEY_REQUIRED,
         .help = "a text file of columns, from the scene's folder: apart by commas, semicolons, tabs or blanks; `#` begins a comment"},
    [TABLE_COLUMNS] = {"columns", AB_KEY_SECTION,
                       .help = "which ones, in order: names of the header line, or numbers from 1; default: all of them"},
    [TABLE_UNITS] = {"units", AB_KEY_SECTION,
                     .help = "a unit for each of these columns, null: SI; default: those of the header (`t [s]`), else SI"},
};
SECTION(table, "A setting that is a table", table, NULL,
        "Rows stand in the scene, each of its numbers as everywhere (`[[0, 0], [0.5, \"20 kPa\"]]`), or come from a file. Numbers in a "
        "file have decimal points. A file may "
        "begin with a line of names, with units in brackets. It has at most 64 MiB and 1000000 rows.",
        "velocity: {file: base.csv, columns: [t, vx], units: [s, \"cm/s\"]}\nvelocity: [[0, 0], [0.1, \"2 cm/s\"], [0.2, 0]]\n");
