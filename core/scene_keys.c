/* scene_keys.c: what a scene may say, key by key. */
#include "core/scene_keys.h"

#include <math.h>

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define SECTION(name_, title_, keys_, more_, help_, example_)                                                                              \
    const ab_section ab_section_##name_ = {                                                                                                \
        .title = title_, .help = help_, .example = example_, .keys = keys_, .count = COUNT(keys_), .more = more_}

/* RANGE adds the flag; ANY leaves a side open. */
#define ANY INFINITY
#define POSITIVE .flags = AB_KEY_RANGE | AB_KEY_MIN_OPEN, .min = 0, .max = INFINITY
#define POSITIVE_REQUIRED .flags = AB_KEY_REQUIRED | AB_KEY_RANGE | AB_KEY_MIN_OPEN, .min = 0, .max = INFINITY

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

static const ab_key body[] = {
    [BODY_METHOD] = {"method", AB_KEY_WORD, .flags = AB_KEY_REQUIRED, .words = "material-points|finite-elements|rigid",
                     .help = "how the body is computed"},
    [BODY_MATERIAL] = {"material", AB_KEY_NAME, .help = "name of one of the materials; required but for rigid bodies, whose mass it gives"},
    [BODY_SHAPE] = {"shape", AB_KEY_SECTION, .help = "outline at the start; material-points, rigid"},
    [BODY_FILL] = {"fill", AB_KEY_SECTION, .help = "how points are placed in it; default {rule: regular, per_cell: 4}"},
    [BODY_BASIS] = {"basis", AB_KEY_WORD, .words = "linear|gimp|bspline2|bspline3|cpdi", .initial = "gimp",
                    .help = "basis functions; gimp may say {gimp: contiguous} or {gimp: fixed}; cpdi: domains are parallelograms that the "
                            "deformation carries "
                            "along, for large shear and stretch"},
    [BODY_TRANSFER] = {"transfer", AB_KEY_WORD, .words = "flip|pic|apic|tpic", .initial = "flip",
                       .help = "how velocities come back; a blend is {flip: 0.99}, further ones are {xpic: 2} and {fmpm: 2}"},
    [BODY_UPDATE] =
        {"update", AB_KEY_WORD, .words = "usf|usl|musl|usavg", .initial = "musl",
         .help = "when stress is updated: first, last, last from mapped-back velocities; usavg: half first and half last, which makes no "
                 "energy however far a body flies, for 1.7 times the work"},
    [BODY_F_BAR] = {"f_bar", AB_KEY_WORD, .words = "false|cell|patch", .initial = "false",
                    .help =
                        "against locking where volume is kept (nu near 0.5, plastic flow): the change of volume and the pressure are "
                        "averaged over the points of a cell, or over a patch of 3 x 3 cells, which leaves no checkerboard of pressures"},
    [BODY_SURFACE] = {"surface", AB_KEY_WORD, .words = "domains|points", .initial = "domains",
                      .help = "what of the body touches others: the domains of its material points, or points on its own outline, a cell "
                              "apart (multi-velocity: the outline between them); another distance is {points: 0.25}"},
    [BODY_VELOCITY] = {"velocity", AB_KEY_VECTOR, .unit = "m s-1", .initial = "[0, 0]", .variables = AB_VARIABLES_XY,
                       .help = "velocity at the start"},
    [BODY_INITIAL] = {"initial", AB_KEY_SECTION,
                      .help =
                          "stress at the start, so that the body begins in equilibrium (docs/stages.md); material-points, finite-elements"},
    [BODY_GRAVITY] = {"gravity", AB_KEY_FLAG, .initial = "true", .help = "false: gravity does not act on this body"},
    [BODY_FORCE] =
        {"body_force", AB_KEY_VECTOR, .unit = "m s-2", .initial = "[0, 0]", .variables = AB_VARIABLES_MOTION,
         .help = "force per mass, besides gravity, as a field: x, y: where a point (or node) is now, X, Y: where it was at the start; "
                 "material-points, finite-elements"},
    [BODY_MESH] = {"mesh", AB_KEY_SECTION, .help = "elements at the start; finite-elements, and rigid in place of a shape"},
    [BODY_FIX] = {"fix", AB_KEY_SECTION, .help = "list of parts whose velocity is given; finite-elements"},
    [BODY_MOTION] = {"motion", AB_KEY_SECTION, .help = "what of its motion is given; rigid. Without it the body is free"},
};
SECTION(body, "bodies.NAME", body, NULL,
        "One entry a body. Each body has its own velocity field; bodies meet only through `contact`. `shape`, `fill`, `basis`, `transfer`, "
        "`update`, `f_bar` and `surface` belong to method material-points, `mesh` and `fix` to finite-elements, `shape` or `mesh` and "
        "`motion` to rigid; "
        "the others to all, `body_force` to all but rigid.",
        "bodies:\n  block:\n    method: material-points\n    material: soil\n    shape: {box: [[1, 0], [2, 1]]}\n    velocity: [\"0.1*y\", "
        "0]\n");

static const ab_key mesh[] = {
    [MESH_BOX] = {"box", AB_KEY_SECTION, .unit = "m", .help = "[[x, y], [x, y]]: lower left and upper right corner"},
    [MESH_PATCH] = {"patch", AB_KEY_SECTION, .help = "or a patch between four edges"},
    [MESH_FILE] = {"file", AB_KEY_TEXT, .help = "or a Gmsh file, from the scene's folder; needs a program built with libgmsh"},
    [MESH_ELEMENTS] = {"elements", AB_KEY_POINT, .unit = "1",
                       .help = "[nx, ny]: elements along x (bottom) and along y (left); required with box and patch"},
    [MESH_GRADING] = {"grading", AB_KEY_POINT, .unit = "1", .initial = "[1, 1]",
                      .help =
                          "size of the last element over that of the first, along x and along y, in equal steps of ratio; box and patch"},
    [MESH_TYPE] = {"type", AB_KEY_WORD, .words = "q4|q4r|q6|q8|q8r", .initial = "q8",
                   .help =
                       "q4: 4 nodes, 2x2 Gauss points; q4r: 1 Gauss point, stabilised; q6: q4 with incompatible modes (bends well); q8: 8 "
                       "nodes, 3x3, the default because it bends without locking and has no motion that costs no energy; q8r: 2x2, "
                       "faster, and it does not lock where volume is kept (plastic flow)"},
    [MESH_F_BAR] = {"f_bar", AB_KEY_FLAG, .initial = "false",
                    .help = "true: the change of volume is averaged over the element, against locking where volume is kept; type q4"},
    [MESH_HOURGLASS] = {"hourglass", AB_KEY_NUMBER, .unit = "1", .initial = "1", POSITIVE,
                        .help = "part of the stabilisation that the exact stiffness in bending asks for; type q4r"},
};
SECTION(mesh, "bodies.NAME.mesh", mesh, NULL,
        "One of `box`, `patch` and `file`. A file (.msh of Gmsh, any version of the format) holds quadrilaterals only, of 4 nodes "
        "(Mesh.RecombineAll = 1) or of 8 (besides, Mesh.ElementOrder = 2 and Mesh.SecondOrderIncomplete = 1) as `type` has them; all its "
        "surfaces are taken together, and its numbers stand in messages.",
        "mesh: {box: [[0, 0], [3.75, 0.5]], elements: [15, 2], type: q8}\n");

static const ab_key patch[] = {
    [PATCH_BOTTOM] = {"bottom", AB_KEY_SECTION, .unit = "m", .flags = AB_KEY_REQUIRED, .help = "from left to right"},
    [PATCH_RIGHT] = {"right", AB_KEY_SECTION, .unit = "m", .flags = AB_KEY_REQUIRED, .help = "from the end of bottom upwards"},
    [PATCH_TOP] = {"top", AB_KEY_SECTION, .unit = "m", .flags = AB_KEY_REQUIRED, .help = "from left to right"},
    [PATCH_LEFT] = {"left", AB_KEY_SECTION, .unit = "m", .flags = AB_KEY_REQUIRED, .help = "from the beginning of bottom upwards"},
};
SECTION(
    patch, "bodies.NAME.mesh.patch", patch, NULL,
    "Four edges that meet at the corners, each a list of points [[x, y], [x, y], ...] joined by straight pieces, or an arc of a circle. "
    "Nodes lie on them by length, and inside by transfinite interpolation.",
    "patch: # a quarter of a ring\n  bottom: [[1, 0], [2, 0]]\n  right: {arc: {from: [2, 0], to: [0, 2], center: [0, 0]}}\n  top: [[0, 1], "
    "[0, 2]]\n  left: {arc: {from: [1, 0], to: [0, 1], center: [0, 0]}}\n");

static const ab_key arc[] = {
    [ARC_FROM] = {"from", AB_KEY_POINT, .unit = "m", .flags = AB_KEY_REQUIRED, .help = "where it begins"},
    [ARC_TO] = {"to", AB_KEY_POINT, .unit = "m", .flags = AB_KEY_REQUIRED, .help = "where it ends"},
    [ARC_CENTER] = {"center", AB_KEY_POINT, .unit = "m", .flags = AB_KEY_REQUIRED, .help = "of the circle; the same distance from both"},
};
SECTION(arc, "arc", arc, NULL, "The shorter way round, less than half a circle.", NULL);

static const ab_key fix[] = {
    [FIX_WHERE] = {"where", AB_KEY_SECTION, .flags = AB_KEY_REQUIRED, .help = "which nodes"},
    [FIX_VELOCITY] = {"velocity", AB_KEY_VECTOR, .unit = "m s-1", .flags = AB_KEY_REQUIRED, .variables = AB_VARIABLE_T,
                      .help = "their velocity; null in place of a number leaves that direction free"},
    [FIX_STAGES] = {"stages", AB_KEY_SECTION, .help = "name of a stage or list of names: it holds in these only; default: in all"},
};
SECTION(fix, "bodies.NAME.fix[i]", fix, NULL,
        "A list. Nodes of a finite-element body whose velocity is given. Where two entries give one node a velocity in the same direction, "
        "the last one holds; a warning says so when they differ.",
        "fix:\n  - {where: {x: 0}, velocity: [0, 0]}\n  - {where: {side: top}, velocity: [null, \"-0.1*t\"]}\n");

static const ab_key initial[] = {
    [INITIAL_STRESS] =
        {"stress", AB_KEY_SECTION, .unit = "Pa", .flags = AB_KEY_REQUIRED, .variables = AB_VARIABLES_XY,
         .help = "K0: vertical stress is the weight of what the body has above, horizontal stress K0 times that; gravity: a stage in which "
                 "gravity grows and the scene settles is put before the start, t < 0; or [sxx, syy, szz, sxy], formulas of x, y, "
                 "tension positive"},
    [INITIAL_K0] = {"K0", AB_KEY_NUMBER, .unit = "1", .flags = AB_KEY_RANGE, .min = 0, .max = ANY,
                    .help =
                        "horizontal over vertical stress; default: 1 - sin(friction) of a material with a setting friction (Jaky 1944), "
                        "nu/(1 - nu) of others (elastic, sides held)"},
    [INITIAL_SURCHARGE] = {"surcharge", AB_KEY_NUMBER, .unit = "Pa", .initial = "0",
                           .help = "pressure of what else lies on the body's surface; stress: K0"},
    [INITIAL_TIME] = {"time", AB_KEY_NUMBER, .unit = "s", POSITIVE,
                      .help = "how long the settling may take; stress: gravity. Default: 200 times the slowest body's height over its wave "
                              "speed, times four"},
};
SECTION(initial, "bodies.NAME.initial", initial, NULL,
        "`K0` and `gravity` go along the scene's gravity at t = 0. A stress that the material cannot bear is refused, with the place.",
        "initial: {stress: K0, K0: 0.5, surcharge: \"10 kPa\"}\n");

static const ab_key motion[] = {
    [MOTION_VELOCITY] = {"velocity", AB_KEY_VECTOR, .unit = "m s-1", .flags = AB_KEY_NULL, .variables = AB_VARIABLE_T,
                         .help = "velocity of the center; null in place of a number leaves that direction free"},
    [MOTION_SPIN] = {"spin", AB_KEY_FORMULA, .unit = "s-1", .flags = AB_KEY_NULL, .variables = AB_VARIABLE_T,
                     .help = "rate of turning in radians per second, counter-clockwise; without it or null: free"},
    [MOTION_CENTER] = {"center", AB_KEY_POINT, .unit = "m",
                       .help = "the place of the body at the start that velocity is of; default: the centre of mass"},
    [MOTION_MASS] = {"mass", AB_KEY_NUMBER, .unit = "kg", POSITIVE,
                     .help = "mass (per m of thickness); default: area times the material's density"},
    [MOTION_INERTIA] = {"inertia", AB_KEY_NUMBER, .unit = "kg m2", POSITIVE,
                        .help = "moment of inertia about the centre of mass (per m of thickness); default: that of the mass spread evenly"},
};
SECTION(motion, "bodies.NAME.motion", motion, NULL,
        "Of a rigid body. What is not given follows from forces, and needs a mass: from `mass` here or from the material's density.",
        "motion: {velocity: [0, \"-0.1*min(t, 1)\"], spin: 0}\n");

static const ab_key shape[] = {
    [SHAPE_BOX] = {"box", AB_KEY_SECTION, .unit = "m", .help = "[[x, y], [x, y]]: lower left and upper right corner"},
    [SHAPE_DISC] = {"disc", AB_KEY_SECTION, .unit = "m", .help = "{center: [x, y], radius: r}"},
    [SHAPE_RING] = {"ring", AB_KEY_SECTION, .unit = "m", .help = "{center: [x, y], radius: r, inner: r}"},
    [SHAPE_POLYGON] = {"polygon", AB_KEY_SECTION, .unit = "m",
                       .help = "[[x, y], ...], three corners or more, either way round, not crossing itself"},
    [SHAPE_HOLES] = {"holes", AB_KEY_SECTION, .unit = "m",
                     .help = "beside polygon: list of polygons inside of it that are left empty, [[[x, y], ...], ...]"},
    [SHAPE_UNION] = {"union", AB_KEY_SECTION, .help = "list of shapes taken together"},
    [SHAPE_MESH] =
        {"mesh", AB_KEY_SECTION,
         .help =
             "elements whose Gauss points fill it, written as `mesh` of finite elements (f_bar and hourglass apart); fill: {rule: gauss, "
             "per_cell: 4} then means 4 in each element; material-points"},
};
SECTION(shape, "bodies.NAME.shape", shape, NULL, "One of these; `holes` only beside `polygon`.",
        "shape: {disc: {center: [1, 1], radius: \"50 cm\"}}\n");

#define CENTER                                                                                                                             \
    { "center", AB_KEY_POINT, .unit = "m", .flags = AB_KEY_REQUIRED, .help = "middle" }
#define RADIUS                                                                                                                             \
    { "radius", AB_KEY_NUMBER, .unit = "m", POSITIVE_REQUIRED, .help = "outer radius" }
static const ab_key disc[] = {[ROUND_CENTER] = CENTER, [ROUND_RADIUS] = RADIUS};
SECTION(disc, "disc", disc, NULL, "A full circle.", NULL);
static const ab_key ring[] = {
    [ROUND_CENTER] = CENTER,
    [ROUND_RADIUS] = RADIUS,
    [ROUND_INNER] = {"inner", AB_KEY_NUMBER, .unit = "m", POSITIVE_REQUIRED, .help = "inner radius, less than radius"}};
SECTION(ring, "ring", ring, NULL, "A circle with a round hole.", NULL);

static const ab_key fill[] = {
    [FILL_RULE] =
        {"rule", AB_KEY_WORD, .words = "regular|gauss|cvt", .initial = "regular",
         .help =
             "regular: a lattice fitted to the outline; gauss: the Gauss points of each cell; cvt: points at the centroids of their own "
             "Voronoi cells (Lloyd's iteration), for outlines that no lattice fits"},
    [FILL_PER_CELL] = {"per_cell", AB_KEY_INTEGER, .unit = "1", .initial = "4", .flags = AB_KEY_RANGE, .min = 1, .max = 10000,
                       .help = "points wanted in a full cell"},
    [FILL_POINTS] = {"points", AB_KEY_INTEGER, .unit = "1", .flags = AB_KEY_RANGE, .min = 1, .max = 1e6,
                     .help = "how many points in all, in place of per_cell; rule cvt"},
    [FILL_SEED] = {"seed", AB_KEY_INTEGER, .unit = "1", .initial = "1", .flags = AB_KEY_RANGE, .min = 0, .max = 1e9,
                   .help = "each number gives other points, the same one always the same; rule cvt"},
    [FILL_TOLERANCE] = {"tolerance", AB_KEY_NUMBER, .unit = "1", .initial = "1e-3", .flags = AB_KEY_RANGE, .min = 1e-9, .max = 0.5,
                        .help = "the iteration ends when no point moves by more than this part of the mean distance of points; rule cvt"},
    [FILL_ITERATIONS] = {"iterations", AB_KEY_INTEGER, .unit = "1", .initial = "2000", .flags = AB_KEY_RANGE, .min = 1, .max = 1e6,
                         .help = "rounds at most; a warning says where they did not do; rule cvt"},
};
SECTION(fill, "bodies.NAME.fill", fill, NULL, "How material points are placed.", "fill: {rule: cvt, points: 500, seed: 1}\n");

static const ab_key basis[] = {
    [BASIS_GIMP] = {"gimp", AB_KEY_WORD, .words = "contiguous|fixed", .flags = AB_KEY_REQUIRED,
                    .help = "contiguous: domains follow the stretch (default); fixed: they keep their size"},
};
SECTION(basis, "bodies.NAME.basis", basis, NULL, "As a mapping, in place of a word.", "basis: {gimp: fixed}\n");

static const ab_key transfer[] = {
    [TRANSFER_FLIP] = {"flip", AB_KEY_NUMBER, .unit = "1", .flags = AB_KEY_RANGE, .min = 0, .max = 1,
                       .help = "part of FLIP; the rest is PIC"},
    [TRANSFER_XPIC] = {"xpic", AB_KEY_INTEGER, .unit = "1", .flags = AB_KEY_RANGE, .min = 1, .max = 20,
                       .help = "order m of XPIC(m): PIC that loses only what the nodes cannot see; 1 is PIC, 2 to 5 are usual"},
    [TRANSFER_FMPM] = {"fmpm", AB_KEY_INTEGER, .unit = "1", .flags = AB_KEY_RANGE, .min = 1, .max = 20,
                       .help = "order m of FMPM(m): PIC with m terms of the inverse of the full mass matrix; 1 is PIC"},
};
SECTION(transfer, "bodies.NAME.transfer", transfer, NULL, "As a mapping, in place of a word: one of these keys.", "transfer: {xpic: 3}\n");

static const ab_key surface[] = {
    [SURFACE_POINTS] = {"points", AB_KEY_NUMBER, .unit = "1", .flags = AB_KEY_REQUIRED | AB_KEY_RANGE, .min = 0.1, .max = 4,
                        .help = "distance of points on the outline, in cells"},
};
SECTION(surface, "bodies.NAME.surface", surface, NULL, "As a mapping, in place of a word.", "surface: {points: 0.25}\n");

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
    [BOUNDARY_HOLD] =
        {"hold", AB_KEY_FLAG,
         .help =
             "true: it carries besides the traction with which the body's own stress stood there when it began to act, so that what was in "
             "equilibrium stays so; default: true for plugins with dashpots on bodies of points that begin with a stress, or behind "
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
    [LADDER_VALUES] = {"values", AB_KEY_SECTION, .flags = AB_KEY_REQUIRED, .help = "list of values, from cheap to dear"},
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
