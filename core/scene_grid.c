/* scene_grid.c: the background grid: corners, cells, sides. */
#include <math.h>
#include <string.h>

#include "core/scene_reader.h"

enum { BEYOND = 8 };             /* cells that the grid goes on beyond a side with a boundary plugin */
enum { MOST_CELLS = 100000000 }; /* in one direction; only cells with material cost anything, their numbers must fit */

void ab_scene_take_sides(ab_scene_reader *r, const ab_node *node, const char *where, ab_side_kind side[AB_SIDES]) {
    const ab_node *v[SIDES_KEYS];
    if (!ab_section_open(&r->base, &ab_section_sides, node, where, v)) return;
    for (int s = 0; s < SIDES_KEYS; s++) {
        const ab_key *key = &ab_section_sides.keys[s];
        if (v[s] != NULL && v[s]->kind == AB_NODE_MAP) {
            if (side != r->scene->side)
                ab_report_error(
                    r->base.report, v[s]->mark,
                    "%s.%s: boundary plugins at sides are those of the grid; write it there, or under boundaries with stages: [NAME]",
                    where, key->name);
            else
                r->side_boundary[s] = v[s], side[s] = AB_SIDE_FREE;
            continue;
        }
        char *word = NULL;
        if (v[s] == NULL || !ab_read_word(&r->base, key, v[s], where, &word)) continue; /* free, or as in the stage before */
        side[s] = strcmp(word, "roller") == 0    ? AB_SIDE_ROLLER
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
    if (v[GRID_SIDES] != NULL) ab_scene_take_sides(r, v[GRID_SIDES], "grid.sides", scene->side);
    if (from && cell) ab_scene_take_axis(r, v[GRID_FROM]->mark);
    for (int side = 0; side < AB_SIDES; side++) r->side_at[side] = side % 2 ? scene->grid_to[side / 2] : scene->grid_from[side / 2];
    for (int side = 0; from && to && cell && side < AB_SIDES; side++) /* what is not held there may move out */
        if (r->side_boundary[side] != NULL)
            (side % 2 ? scene->grid_to : scene->grid_from)[side / 2] += (side % 2 ? BEYOND : -BEYOND) * scene->grid_cell;
    if (from && to && cell)
        for (int d = 0; d < 2; d++) count_cells(r, d, v[GRID_TO]->mark);
}

bool ab_contact_needs_grid(const ab_contact_spec *contact) {
    return contact->finder != NULL && (contact->finder->class_.needs & AB_NEED_SHARED_NODES) != 0;
}

static bool is_points(const ab_body_spec *body) { return body->method != NULL && strcmp(body->method, "material-points") == 0; }

/* Why a body needs the grid: its method or a contact; false: it does not. */
static bool why_grid(const ab_scene *scene, size_t body, char *why, size_t size) {
    if (is_points(&scene->bodies[body])) {
        snprintf(why, size, "body '%.64s' is of material points", scene->bodies[body].name);
        return true;
    }
    for (size_t c = 0; c < scene->contact_count; c++) {
        const ab_contact_spec *contact = &scene->contacts[c];
        if ((contact->body[0] != body && contact->body[1] != body) || !ab_contact_needs_grid(contact)) continue;
        snprintf(why, size, "contact of '%.64s' and '%.64s' by %.64s looks at the nodes of the grid", scene->bodies[contact->body[0]].name,
                 scene->bodies[contact->body[1]].name, contact->finder->class_.name);
        return true;
    }
    return false;
}

/* The whole outline must lie in the grid. */
static void check_inside(ab_scene_reader *r, const ab_body_spec *body, const char *why) {
    const ab_scene *scene = r->scene;
    double low[2], high[2];
    if (scene->grid_cells[0] == 0 || scene->grid_cells[1] == 0 || !ab_body_bounds(body, low, high)) return;
    const double slack = 1e-9 * scene->grid_cell;
    bool inside = true, apart = false;
    for (int d = 0; d < 2; d++) {
        const double from = scene->grid_from[d] - slack - 1e-12 * fabs(scene->grid_from[d]),
                     to = scene->grid_to[d] + slack + 1e-12 * fabs(scene->grid_to[d]);
        inside = inside && low[d] >= from && high[d] <= to;
        apart = apart || high[d] <= from || low[d] >= to;
    }
    if (!inside)
        ab_report_error(r->base.report, body->mesh.kind != AB_MESH_NONE ? body->mesh.mark : body->shape.mark,
                        "body '%s' lies %s outside the grid: it reaches from [%.10g, %.10g] to [%.10g, %.10g] m, the grid from [%.10g, "
                        "%.10g] to [%.10g, %.10g] m%s%s; make the grid larger or move the body",
                        body->name, apart ? "wholly" : "partly", low[0], low[1], high[0], high[1], scene->grid_from[0], scene->grid_from[1],
                        scene->grid_to[0], scene->grid_to[1], is_points(body) ? "" : ", and ", is_points(body) ? "" : why);
}

void ab_scene_check_grid(ab_scene_reader *r, const ab_node *root) {
    const ab_scene *scene = r->scene;
    const bool written = ab_node_find(root, "grid") != NULL;
    char why[300];
    for (size_t b = 0; b < scene->body_count; b++) {
        if (!why_grid(scene, b, why, sizeof why)) continue;
        if (!written) {
            ab_report_error(r->base.report, root->mark,
                            "key 'grid' is missing in the scene: %s; write grid: {from: [x, y], to: [x, y], cell: h}", why);
            return;
        }
        check_inside(r, &scene->bodies[b], why);
    }
}
