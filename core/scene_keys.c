/* scene_keys.c: what a scene may say, key by key: the scene as a whole, contacts, loads and boundaries. */
#include "core/scene_section.h"

static const ab_key top[] = {
    [TOP_ABUT] = {"abut", AB_KEY_INTEGER, .flags = AB_KEY_REQUIRED, .unit = "1", .help = "version of the scene format, 1"},
    [TOP_TITLE] = {"title", AB_KEY_TEXT, .initial = "", .help = "one line that says what this is"},
    [TOP_SPACE] =
        {"space", AB_KEY_WORD, .initial = "plane-strain", .words = "plane-strain|axisymmetric|!3d",
         .help = "kind of space; axisymmetric: x is the radius, y runs along the axis, masses, forces and energies are of whole rings"},
    [TOP_CONSTANTS] = {"constants", AB_KEY_SECTION, .help = "names for numbers, used in every expression"},
    [TOP_GRAVITY] = {"gravity", AB_KEY_VECTOR, .unit = "m s-2", .initial = "[0, 0]", .variables = AB_VARIABLE_T,
                     .help = "acceleration of gravity"},
    [TOP_DAMPING] = {"damping", AB_KEY_SECTION, .help = "local non-viscous damping"},
    [TOP_TIME] = {"time", AB_KEY_SECTION, .help = "how long, and in which steps; required but for scenes with stages"},
    [TOP_GRID] = {"grid", AB_KEY_SECTION,
                  .help = "the background grid; needed by material points, and by contact algorithms that look at its nodes"},
    [TOP_MATERIALS] = {"materials", AB_KEY_SECTION, .help = "materials by name; all bodies but rigid ones need one"},
    [TOP_BODIES] = {"bodies", AB_KEY_SECTION, .flags = AB_KEY_REQUIRED, .help = "bodies by name"},
    [TOP_CONTACT] = {"contact", AB_KEY_SECTION, .help = "list of pairs of bodies that meet"},
    [TOP_LOADS] = {"loads", AB_KEY_SECTION, .help = "list of tractions and pressures on outlines, and forces at places"},
    [TOP_MONITORS] = {"monitors", AB_KEY_SECTION, .help = "list of single numbers followed in time"},
    [TOP_HISTORY] = {"history", AB_KEY_SECTION, .help = "rows of history.csv"},
    [TOP_OUTPUT] = {"output", AB_KEY_SECTION, .help = "frames of results.h5"},
    [TOP_EXPECT] = {"expect", AB_KEY_SECTION, .help = "list of answers that must come out"},
    [TOP_STAGES] = {"stages", AB_KEY_SECTION,
                    .help = "list of parts of the run with settings of their own, in place of time (docs/stages.md)"},
    [TOP_BOUNDARIES] = {"boundaries", AB_KEY_SECTION,
                        .help = "list of boundary plugins on parts of outlines: sides that absorb waves, bases that shake"},
    [TOP_CHECKPOINT] = {"checkpoint", AB_KEY_SECTION, .help = "when the state of the run is saved, to go on from"},
    [TOP_CHECKED] =
        {"checked", AB_KEY_FLAG, .initial = "false",
         .help = "watch every call of every plugin: arrays that end where memory ends, old state read only, finite numbers, losses not "
                 "negative, weights that sum to 1; a broken promise ends the run. Same results, slower; for plugins under development"},
    [TOP_WATCHDOG] = {"watchdog", AB_KEY_SECTION, .help = "when a run is ended because it makes energy"},
    [TOP_TRADE] = {"trade", AB_KEY_SECTION, .help = "settings that `abut trade` tries; a run does not look at them"},
    [TOP_EXTREMES] = {"extremes", AB_KEY_SECTION,
                      .help = "quantities that `abut extremes` drives until the run breaks; a run does not look at them"},
};
SECTION(top, "The scene", top, NULL, "Top level of the file.",
        "abut: 1\ntitle: Block on a plane\nspace: plane-strain\ngravity: [0, -9.81]\n");

static const ab_key damping[] = {
    [DAMPING_LOCAL] = {"local", AB_KEY_NUMBER, .unit = "1", .initial = "0", .flags = AB_KEY_RANGE | AB_KEY_MAX_OPEN, .min = 0, .max = 1,
                       .help = "part of the unbalanced force that is taken away against the motion"},
    [DAMPING_UNTIL] = {"until", AB_KEY_NUMBER, .unit = "s", POSITIVE, .help = "time when the damping ends; without it: never"},
};
SECTION(damping, "damping", damping, NULL, "Local non-viscous damping, to settle a scene before it begins in earnest.",
        "damping: {local: 0.5, until: 0.3}\n");

static const ab_key time_[] = {
    [TIME_END] = {"end", AB_KEY_NUMBER, .unit = "s", POSITIVE_REQUIRED, .help = "time when the run ends"},
    [TIME_DT] = {"dt", AB_KEY_NUMBER, .unit = "s", POSITIVE, .help = "fixed time step; in place of cfl"},
    [TIME_CFL] = {"cfl", AB_KEY_NUMBER, .unit = "1", .initial = "0.25", POSITIVE,
                  .help = "time step as a part of the critical one; in place of dt. 0.5 is enough for bodies that stay small-strained in "
                          "their cells; fast spin across cells makes energy there"},
};
SECTION(
    time, "time", time_, NULL,
    "`dt` or `cfl`, not both; with neither, cfl 0.25. `--set time.dt=...` takes the place of a cfl in the file, and the other way round.",
    "time: {end: 1.5, cfl: 0.4}\n");

static const ab_key stage[] = {
    [STAGE_NAME] = {"name", AB_KEY_TEXT, .help = "what loads, supports and results call it; default stage-1, stage-2 ..."},
    [STAGE_SCHEME] = {"scheme", AB_KEY_WORD, .words = "explicit|!quasi-static|!newmark", .initial = "explicit",
                      .help = "how it is computed"},
    [STAGE_END] = {"end", AB_KEY_NUMBER, .unit = "s", POSITIVE, .help = "time of the scene at which it ends; or"},
    [STAGE_DURATION] = {"duration", AB_KEY_NUMBER, .unit = "s", POSITIVE, .help = "how long it takes; with until: at most"},
    [STAGE_DT] = {"dt", AB_KEY_NUMBER, .unit = "s", POSITIVE, .help = "fixed time step; in place of cfl"},
    [STAGE_CFL] = {"cfl", AB_KEY_NUMBER, .unit = "1", .initial = "0.25", POSITIVE, .help = "time step as a part of the critical one"},
    [STAGE_GRAVITY] = {"gravity", AB_KEY_WORD, .words = "keep|ramp|off", .initial = "keep",
                       .help =
                           "keep: as the scene has it; ramp: grows (1-cos)/2 to that from what it was in the stage before, from nothing "
                           "in the first; off: none"},
    [STAGE_RAMP] = {"ramp", AB_KEY_NUMBER, .unit = "s", POSITIVE, .help = "how long gravity: ramp takes; default: half of the stage"},
    [STAGE_DAMPING] = {"damping", AB_KEY_SECTION, .help = "{local: 0.7} or {kinetic: true}; default: none"},
    [STAGE_UNTIL] = {"until", AB_KEY_SECTION, .help = "it ends when the bodies have come to rest"},
    [STAGE_SIDES] = {"sides", AB_KEY_SECTION,
                     .help = "sides of the grid from here on, as grid.sides; those that are not named stay as they were"},
    [STAGE_DISPLACEMENTS] = {"displacements", AB_KEY_WORD, .words = "keep|zero", .initial = "keep",
                             .help = "at its end; zero: from there on they are counted from where things are then"},
    [STAGE_VELOCITIES] = {"velocities", AB_KEY_WORD, .words = "keep|zero", .initial = "keep",
                          .help = "at its end; zero: what is not driven begins the next stage at rest"},
};
SECTION(
    stage, "stages[i]", stage, NULL,
    "A list, in place of `time`. The clock goes on from stage to stage; one that ends early, by `until`, leaves the rest of its time out, "
    "so that what comes "
    "after begins at the same time however long the settling took. Loads and supports act in all stages but where they have `stages`.",
    "stages:\n  - {name: settle, duration: 2, gravity: ramp, damping: {local: 0.7}, until: {unbalanced_force: 1e-4, kinetic_energy: 1e-4}, "
    "displacements: zero}\n  - {name: shake, duration: 5, cfl: 0.5, sides: {right: free}}\n");

static const ab_key calm[] = {
    [CALM_LOCAL] = {"local", AB_KEY_NUMBER, .unit = "1", .initial = "0", .flags = AB_KEY_RANGE | AB_KEY_MAX_OPEN, .min = 0, .max = 1,
                    .help = "part of the unbalanced force that is taken away against the motion (Cundall 1987)"},
    [CALM_KINETIC] = {"kinetic", AB_KEY_FLAG, .initial = "false",
                      .help = "true: when the kinetic energy of all bodies has passed a peak, they are stopped (Cundall 1982)"},
};
SECTION(calm, "stages[i].damping", calm, NULL, "What it takes is `damping` in the ledger.", "damping: {local: 0.7}\n");

static const ab_key until[] = {
    [UNTIL_FORCE] = {"unbalanced_force", AB_KEY_NUMBER, .unit = "1", POSITIVE,
                     .help = "force out of balance over the force applied (weight, loads): sizes summed over all nodes that are free"},
    [UNTIL_ENERGY] = {"kinetic_energy", AB_KEY_NUMBER, .unit = "1", POSITIVE,
                      .help = "kinetic energy over the work of weight and loads in this stage"},
    [UNTIL_MISSED] = {"missed", AB_KEY_WORD, .words = "stop|warn", .initial = "stop",
                      .help = "where the stage's time is over before: end the run, or go on with a warning"},
};
SECTION(until, "stages[i].until", until, NULL, "One of the two ratios or both; they must hold for ten steps on end.",
        "until: {unbalanced_force: 1e-4, kinetic_energy: 1e-4}\n");

static const ab_key grid[] = {
    [GRID_FROM] = {"from", AB_KEY_POINT, .unit = "m", .flags = AB_KEY_REQUIRED, .help = "lower left corner"},
    [GRID_TO] = {"to", AB_KEY_POINT, .unit = "m", .flags = AB_KEY_REQUIRED, .help = "upper right corner"},
    [GRID_CELL] = {"cell", AB_KEY_NUMBER, .unit = "m", POSITIVE_REQUIRED, .help = "side of the square cells"},
    [GRID_SIDES] = {"sides", AB_KEY_SECTION, .help = "what happens at the four sides"},
};
SECTION(grid, "grid", grid, NULL,
        "Needed by bodies of material points and by contact algorithms that look at grid nodes; finite elements and rigid bodies do "
        "without. Empty "
        "grid costs nothing. The extent must be a whole number of cells; where the side at `to` is free or outflow it is extended to "
        "the next one.",
        "grid:\n  from: [0, 0]\n  to: [8, 4]\n  cell: 0.25\n  sides: {bottom: fixed, left: roller, right: outflow}\n");

#define SIDE_WORDS "free|roller|fixed|outflow"
static const ab_key sides[] = {
    [SIDES_LEFT] = {"left", AB_KEY_WORD, .words = SIDE_WORDS, .initial = "free", .help = "x = from"},
    [SIDES_RIGHT] = {"right", AB_KEY_WORD, .words = SIDE_WORDS, .initial = "free", .help = "x = to"},
    [SIDES_BOTTOM] = {"bottom", AB_KEY_WORD, .words = SIDE_WORDS, .initial = "free", .help = "y = from"},
    [SIDES_TOP] = {"top", AB_KEY_WORD, .words = SIDE_WORDS, .initial = "free", .help = "y = to"},
};
SECTION(sides, "grid.sides", sides, NULL,
        "`fixed` holds both directions, `roller` the one across the side. A point that leaves through a `free` side stops the run; "
        "`outflow` counts it out. Sides act on material points; other bodies are held by `fix` and `motion`. In place of a word a side may "
        "have a boundary plugin, "
        "{boundary: NAME, settings ...}: it acts on all of the outlines of material points that lies on that side at the start (as "
        "`boundaries` does), and "
        "the grid goes on 8 cells beyond.",
        "sides: {left: roller, right: {boundary: viscous, a: 1}, bottom: fixed, top: free}\n");

static const ab_key material[] = {
    [MATERIAL_MODEL] = {"model", AB_KEY_NAME, .flags = AB_KEY_REQUIRED, .help = "name of a material plugin (`abut plugins` lists them)"},
    [MATERIAL_DENSITY] = {"density", AB_KEY_NUMBER, .unit = "kg m-3", POSITIVE_REQUIRED, .help = "density at the start"},
};
SECTION(material, "materials.NAME", material, "every setting that the model declares (`abut plugins show MODEL`)", "One entry a material.",
        "materials:\n  soil: {model: linear-elastic, E: \"20 MPa\", nu: 0.3, density: 1800}\n");

static const ab_key contact[] = {
    [CONTACT_BODIES] = {"bodies", AB_KEY_SECTION, .flags = AB_KEY_REQUIRED, .help = "two names [a, b], or all for every pair"},
    [CONTACT_ALGORITHM] = {"algorithm", AB_KEY_NAME, .flags = AB_KEY_REQUIRED,
                           .help = "name of a contact plugin that finds contact points"},
    [CONTACT_RESPONSE] = {"response", AB_KEY_NAME,
                          .help =
                              "name of a contact plugin that gives impulses; default: the algorithm itself where it does, else coulomb"},
};
SECTION(contact, "contact[i]", contact, "every setting that the algorithm or the response declares (`abut plugins show NAME`)",
        "A list, one entry a pair. Bodies without an entry do not see each other.",
        "contact:\n  - bodies: [block, plane]\n    algorithm: multi-velocity\n    response: coulomb\n    friction: 0.3\n");

static const ab_key load[] = {
    [LOAD_BODY] = {"body", AB_KEY_NAME, .flags = AB_KEY_REQUIRED, .help = "name of a body"},
    [LOAD_WHERE] = {"where", AB_KEY_SECTION, .help = "part of its outline at the start; with traction or pressure"},
    [LOAD_TRACTION] = {"traction", AB_KEY_VECTOR, .unit = "Pa", .variables = AB_VARIABLES_TXY,
                       .help = "force per area as it was at the start; its direction stays; x, y: the place at the start; material-points, "
                               "finite-elements"},
    [LOAD_PRESSURE] = {"pressure", AB_KEY_FORMULA, .unit = "Pa", .variables = AB_VARIABLES_TXY,
                       .help = "in place of traction: force per area as it is now, against the outline as it lies now; x, y: the place at "
                               "the start; material-points, finite-elements"},
    [LOAD_AT] = {"at", AB_KEY_POINT, .unit = "m",
                 .help =
                     "a place at the start, with force: of finite elements the nearest node is taken, of a rigid body the place itself"},
    [LOAD_FORCE] = {"force", AB_KEY_VECTOR, .unit = "N", .variables = AB_VARIABLE_T,
                    .help = "force (per m of thickness) on that place of the body; finite-elements, rigid"},
    [LOAD_STAGES] = {"stages", AB_KEY_SECTION, .help = "name of a stage or list of names: it acts in these only; default: in all"},
};
SECTION(load, "loads[i]", load, NULL, "A list. `where` with `traction` or `pressure`, or `at` with `force`.",
        "loads:\n  - {body: block, where: {side: top}, traction: [0, \"-10e3*min(t/0.1, 1)\"]}\n  - {body: wall, where: {side: left}, "
        "pressure: "
        "\"9.81e3*max(0, 5-y)\"}\n  - {body: beam, at: [3.75, 0.25], force: "
        "[0, \"-2 kN\"]}\n");

static const ab_key boundary[] = {
    [BOUNDARY_ON] = {"on", AB_KEY_NAME, .flags = AB_KEY_REQUIRED, .help = "name of a body"},
    [BOUNDARY_WHERE] = {"where", AB_KEY_SECTION, .flags = AB_KEY_REQUIRED,
                        .help = "part of its outline at the start; it follows the material"},
    [BOUNDARY_PLUGIN] = {"boundary", AB_KEY_NAME, .flags = AB_KEY_REQUIRED,
                         .help = "name of a boundary plugin (`abut plugins` lists them)"},
    [BOUNDARY_AT] = {"at", AB_KEY_WORD, .words = "points|nodes", .initial = "points",
                     .help = "points: at the pieces of the outline, through the body's basis; nodes: at the nodes of the grid that these "
                             "pieces hang on, each with "
                             "its share of the surface and its own velocity; material-points"},
    [BOUNDARY_HOLD] = {"hold", AB_KEY_FLAG,
                       .help =
                           "true: it carries besides what the body's own stress pulls with there when it begins to act (on finite elements "
                           "what each node has "
                           "out of balance), so that what was in "
                           "equilibrium stays so; default: true for plugins with dashpots on bodies that begin with a stress, or behind "
                           "another stage"},
    [BOUNDARY_STAGES] = {"stages", AB_KEY_SECTION, .help = "name of a stage or list of names: it acts in these only; default: in all"},
};
SECTION(boundary, "boundaries[i]", boundary, "every setting that the plugin declares (`abut plugins show NAME`)",
        "A list. A boundary plugin turns the state of a piece of outline (place, normal, displacement, velocity, wave speeds) into a "
        "traction on it, or "
        "says how it moves.",
        "boundaries:\n  - {on: soil, where: {side: bottom}, boundary: viscous}\n");

static const ab_key where[] = {
    [WHERE_ALL] = {"all", AB_KEY_FLAG, .help = "true: everywhere"},
    [WHERE_SIDE] = {"side", AB_KEY_WORD, .words = "left|right|bottom|top", .help = "the part of the outline that faces this way"},
    [WHERE_X] = {"x", AB_KEY_SECTION, .unit = "m", .help = "a place or a range [a, b]"},
    [WHERE_Y] = {"y", AB_KEY_SECTION, .unit = "m", .help = "a place or a range [a, b]"},
};
SECTION(where, "where", where, NULL, "A set of places of a body at the start; several keys together: all must hold.",
        "where: {side: top, x: [0, 0.5]}\n");

const ab_section *const ab_sections[] = {&ab_section_top,        &ab_section_damping,  &ab_section_time,
                                         &ab_section_stage,      &ab_section_calm,     &ab_section_until,
                                         &ab_section_grid,       &ab_section_sides,    &ab_section_material,
                                         &ab_section_body,       &ab_section_shape,    &ab_section_disc,
                                         &ab_section_ring,       &ab_section_fill,     &ab_section_basis,
                                         &ab_section_transfer,   &ab_section_surface,  &ab_section_mesh,
                                         &ab_section_patch,      &ab_section_arc,      &ab_section_initial,
                                         &ab_section_fix,        &ab_section_motion,   &ab_section_contact,
                                         &ab_section_load,       &ab_section_boundary, &ab_section_where,
                                         &ab_section_monitor,    &ab_section_history,  &ab_section_output,
                                         &ab_section_expect,     &ab_section_trade,    &ab_section_ladder,
                                         &ab_section_watchdog,   &ab_section_extremes, &ab_section_extreme,
                                         &ab_section_checkpoint, &ab_section_table,    NULL};
