/* scene_keys.h: the tables of every section of a scene, and the place of each key in its table. */
#ifndef AB_SCENE_KEYS_H
#define AB_SCENE_KEYS_H

#include "core/schema.h"

enum {
    TOP_ABUT,
    TOP_TITLE,
    TOP_SPACE,
    TOP_CONSTANTS,
    TOP_GRAVITY,
    TOP_DAMPING,
    TOP_TIME,
    TOP_GRID,
    TOP_MATERIALS,
    TOP_BODIES,
    TOP_CONTACT,
    TOP_LOADS,
    TOP_MONITORS,
    TOP_HISTORY,
    TOP_OUTPUT,
    TOP_EXPECT,
    TOP_STAGES,
    TOP_BOUNDARIES,
    TOP_CHECKPOINT,
    TOP_TRADE,
    TOP_CHECKED,
    TOP_EXTREMES,
    TOP_WATCHDOG,
    TOP_KEYS
};
enum { DAMPING_LOCAL, DAMPING_UNTIL, DAMPING_KEYS };
enum { TIME_END, TIME_DT, TIME_CFL, TIME_KEYS };
enum { GRID_FROM, GRID_TO, GRID_CELL, GRID_SIDES, GRID_KEYS };
enum { SIDES_LEFT, SIDES_RIGHT, SIDES_BOTTOM, SIDES_TOP, SIDES_KEYS }; /* in the order of AB_LEFT ... */
enum { MATERIAL_MODEL, MATERIAL_DENSITY, MATERIAL_KEYS };
enum {
    BODY_METHOD,
    BODY_MATERIAL,
    BODY_SHAPE,
    BODY_FILL,
    BODY_BASIS,
    BODY_TRANSFER,
    BODY_UPDATE,
    BODY_F_BAR,
    BODY_SURFACE,
    BODY_VELOCITY,
    BODY_GRAVITY,
    BODY_FORCE,
    BODY_MESH,
    BODY_FIX,
    BODY_MOTION,
    BODY_KEYS
};
enum { MESH_BOX, MESH_PATCH, MESH_FILE, MESH_ELEMENTS, MESH_GRADING, MESH_TYPE, MESH_F_BAR, MESH_HOURGLASS, MESH_KEYS };
enum { PATCH_BOTTOM, PATCH_RIGHT, PATCH_TOP, PATCH_LEFT, PATCH_KEYS };
enum { ARC_FROM, ARC_TO, ARC_CENTER, ARC_KEYS };
enum { FIX_WHERE, FIX_VELOCITY, FIX_KEYS };
enum { MOTION_VELOCITY, MOTION_SPIN, MOTION_CENTER, MOTION_MASS, MOTION_INERTIA, MOTION_KEYS };
enum { SHAPE_BOX, SHAPE_DISC, SHAPE_RING, SHAPE_POLYGON, SHAPE_HOLES, SHAPE_UNION, SHAPE_MESH, SHAPE_KEYS };
enum { ROUND_CENTER, ROUND_RADIUS, ROUND_INNER, ROUND_KEYS };
enum { FILL_RULE, FILL_PER_CELL, FILL_POINTS, FILL_SEED, FILL_TOLERANCE, FILL_ITERATIONS, FILL_KEYS };
enum { BASIS_GIMP, BASIS_KEYS };
enum { SURFACE_POINTS, SURFACE_KEYS };
enum { TRANSFER_FLIP, TRANSFER_XPIC, TRANSFER_FMPM, TRANSFER_KEYS };
enum { CONTACT_BODIES, CONTACT_ALGORITHM, CONTACT_RESPONSE, CONTACT_KEYS };
enum { TABLE_FILE, TABLE_COLUMNS, TABLE_UNITS, TABLE_KEYS };
enum { LOAD_BODY, LOAD_WHERE, LOAD_TRACTION, LOAD_PRESSURE, LOAD_AT, LOAD_FORCE, LOAD_KEYS };
enum { BOUNDARY_ON, BOUNDARY_WHERE, BOUNDARY_PLUGIN, BOUNDARY_KEYS };
enum { WHERE_ALL, WHERE_SIDE, WHERE_X, WHERE_Y, WHERE_KEYS };
enum { MONITOR_NAME, MONITOR_BODY, MONITOR_CONTACT, MONITOR_VALUE, MONITOR_AT, MONITOR_OVER, MONITOR_WHERE, MONITOR_MINUS, MONITOR_KEYS };
enum { HISTORY_EVERY, HISTORY_KEYS };
enum { CHECKPOINT_EVERY, CHECKPOINT_STEPS, CHECKPOINT_WALL, CHECKPOINT_KEYS };
enum { OUTPUT_EVERY, OUTPUT_FIELDS, OUTPUT_CONTACT, OUTPUT_KEYS };
enum {
    EXPECT_NAME,
    EXPECT_MONITOR,
    EXPECT_COLUMN,
    EXPECT_REFERENCE,
    EXPECT_NORM,
    EXPECT_TOLERANCE,
    EXPECT_SCALE,
    EXPECT_FROM,
    EXPECT_TO,
    EXPECT_LEVEL,
    EXPECT_KEYS
};

enum { WATCHDOG_ENERGY, WATCHDOG_STOP, WATCHDOG_KEYS };
enum { TRADE_VARY, TRADE_ERROR, TRADE_TOLERANCE, TRADE_SECONDS, TRADE_LIMIT, TRADE_SEARCH, TRADE_COST, TRADE_KEYS };
enum { LADDER_SET, LADDER_VALUES, LADDER_NAME, LADDER_KEYS };
enum { EXTREMES_VARY, EXTREMES_MAP, EXTREMES_LIMIT, EXTREMES_ENERGY, EXTREMES_KEYS };
enum {
    EXTREME_SET,
    EXTREME_NAME,
    EXTREME_FROM,
    EXTREME_TO,
    EXTREME_SCALE,
    EXTREME_RUNGS,
    EXTREME_UNTIL,
    EXTREME_WHOLE,
    EXTREME_VALUES,
    EXTREME_VALUE,
    EXTREME_RIGHT_TO,
    EXTREME_SAME,
    EXTREME_WITH,
    EXTREME_OPEN,
    EXTREME_KEYS
};

extern const ab_section ab_section_top, ab_section_damping, ab_section_time, ab_section_grid, ab_section_sides, ab_section_material,
    ab_section_body, ab_section_shape, ab_section_disc, ab_section_ring, ab_section_fill, ab_section_basis, ab_section_transfer,
    ab_section_contact, ab_section_load, ab_section_where, ab_section_monitor, ab_section_history, ab_section_output, ab_section_expect,
    ab_section_surface, ab_section_mesh, ab_section_patch, ab_section_arc, ab_section_fix, ab_section_motion, ab_section_trade,
    ab_section_boundary, ab_section_ladder, ab_section_watchdog, ab_section_extremes, ab_section_extreme, ab_section_checkpoint,
    ab_section_table;

/* All of them, in the order of docs/scene.md; the last is NULL. */
extern const ab_section *const ab_sections[];

#endif
