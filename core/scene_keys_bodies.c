/* scene_keys_bodies.c: what a scene may say of a body, key by key. */
#include "core/scene_section.h"

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
    [FIX_VELOCITY] =
        {"velocity", AB_KEY_VECTOR, .unit = "m s-1", .flags = AB_KEY_REQUIRED, .variables = AB_VARIABLES_T_START,
         .help = "their velocity, X, Y being the place of the node at the start (so [\"-w*Y\", \"w*X\"] begins to turn them); null "
                 "in place of a number leaves that direction free"},
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
