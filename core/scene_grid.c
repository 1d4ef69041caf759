/* scene_grid.c: the background grid: corners, cells, sides. */
#include <math.h>
#include <string.h>

#include "core/scene_reader.h"

enum { MOST_CELLS = 100000000 }; /* in one direction; only cells with material cost anything, their numbers must fit */

static void take_sides(ab_scene_reader *r, const ab_node *node) {
    const ab_node *v[SIDES_KEYS];
    if (!ab_section_open(&r->base, &ab_section_sides, node, "grid.sides", v)) return;
    for (int s = 0; s < SIDES_KEYS; s++) {
        const ab_key *key = &ab_section_sides.keys[s];
        if (v[s] != NULL && v[s]->kind == AB_NODE_MAP) {
            ab_report_error(r->base.report, v[s]->mark,
                            "grid.sides.%s: boundary plugins at sides are not in this version yet; there is: free, roller, fixed, outflow",
                            key->name);
            continue;
        }
        char *word = NULL;
        if (!ab_read_word(&r->base, key, v[s], "grid.sides", &word)) continue;
        r->scene->side[s] = strcmp(word, "roller") == 0    ? AB_SIDE_ROLLER
                            : strcmp(word, "fixed") == 0   ? AB_SIDE_FIXED
                            : strcmp(word, "outflow") == 0 ? AB_SIDE_OUTFLOW
                                                           : AB_SIDE_FREE;
    }
}

/* Cells along direction d: a whole number, by extension where the far side is open. */
static void count_cells(ab_scene_reader *r, int d, ab_mark mark) {
    ab_scene *scene = r->scene;
    const char axis = d == 0 ? 'x' : 'y';
    const double from = scene->grid_from[d], to = scene->grid_to[d], cell = scene->grid_cell;
    if (!(to > from)) {
        ab_report_error(r->base.report, mark, "grid.to is %.10g m along %c, not beyond grid.from at %.10g m", to, axis, from);
        return;
    }
    const double cells = (to - from) / cell;
    if (!(cells <= MOST_CELLS)) {
        ab_report_error(r->base.report, mark, "grid has %.3g cells along %c, more than %d; make grid.cell larger", cells, axis, MOST_CELLS);
        return;
    }
    double whole = round(cells);
    const ab_side_kind side = scene->side[d == 0 ? AB_RIGHT : AB_TOP];
    if (fabs(cells - whole) > fmin(1e-6 * cells, 1e-3)) {
        whole = ceil(cells);
        if (side != AB_SIDE_FREE && side != AB_SIDE_OUTFLOW) {
            ab_report_error(r->base.report, mark,
                            "grid: from %.10g to %.10g m along %c is %.8g cells of %.10g m, not a whole number, and the %s side is held "
                            "there; set grid.to to %.10g or %.10g along %c",
                            from, to, axis, cells, cell, d == 0 ? "right" : "top", from + floor(cells) * cell, from + whole * cell, axis);
            return;
        }
    }
    if (whole < 1) whole = 1;
    scene->grid_cells[d] = (int)whole;
    if (fabs(cells - whole) > 1e-9 * cells) scene->grid_to[d] = from + whole * cell;
}

void ab_scene_take_grid(ab_scene_reader *r, const ab_node *node) {
    if (node == NULL) return;
    ab_scene *scene = r->scene;
    const ab_node *v[GRID_KEYS];
    scene->mark_grid = node->mark;
    if (!ab_section_open(&r->base, &ab_section_grid, node, "grid", v)) return;
    const ab_key *key = ab_section_grid.keys;
    const bool from = ab_read_point(&r->base, &key[GRID_FROM], v[GRID_FROM], "grid", scene->grid_from);
    const bool to = ab_read_point(&r->base, &key[GRID_TO], v[GRID_TO], "grid", scene->grid_to);
    const bool cell = ab_read_number(&r->base, &key[GRID_CELL], v[GRID_CELL], "grid", &scene->grid_cell);
    if (v[GRID_SIDES] != NULL) take_sides(r, v[GRID_SIDES]);
    if (from && to && cell)
        for (int d = 0; d < 2; d++) count_cells(r, d, v[GRID_TO]->mark);
}
