/* scene_boundaries.c: boundary plugins on parts of outlines. */
#include <math.h>
#include <string.h>

#include "core/scene_reader.h"
#include "core/settings.h"

static const double NEAR = 0.25; /* cells: an outline as near to a side of the grid lies on it */
enum { MOST_ENTRIES = 1000, MOST_NAMES = 256 };

static const ab_loaded_class *boundary_class(ab_scene_reader *r, const ab_node *node, const char *where) {
    char path[AB_WHERE];
    const char *name = ab_scene_word(r, node, ab_where_join(path, where, "boundary"), "the name of a boundary plugin");
    if (name == NULL) return NULL;
    const ab_loaded_class *found = ab_registry_find(r->registry, AB_BOUNDARY, name, node->mark, r->base.report);
    if (found == NULL) return NULL;
    const char *space;
    if (!(found->class_.spaces & ab_scene_space(r->scene, &space)))
        ab_report_error(r->base.report, node->mark, "%s: '%s' does not work in %s", path, name, space);
    return found;
}

/* The plugin and its settings. False where it is not known. */
static bool take_plugin(ab_scene_reader *r, const ab_section *section, const ab_node *node, const ab_node *name, const char *where,
                        ab_boundary_spec *boundary) {
    if (name == NULL) return false;
    boundary->loaded = boundary_class(r, name, where);
    if (boundary->loaded == NULL) return false;
    const ab_class *class_ = &boundary->loaded->class_;
    const char *names[MOST_NAMES];
    const size_t count = ab_settings_names(class_, names, 0, MOST_NAMES);
    ab_section_unknown(&r->base, section, names, count, name->override_, node, where);
    boundary->settings = ab_settings_read(&r->base, class_, node, where);
    return boundary->settings != NULL;
}

/* How it acts: at points or nodes, holding or not. */
static void take_ways(ab_scene_reader *r, const ab_node *const *v, const char *where, ab_boundary_spec *boundary) {
    const ab_key *key = ab_section_boundary.keys;
    const ab_body_spec *body = &r->scene->bodies[boundary->body];
    const bool points = strcmp(body->method, "material-points") == 0;
    char *at = NULL;
    if (ab_read_word(&r->base, &key[BOUNDARY_AT], v[BOUNDARY_AT], where, &at)) boundary->nodes = strcmp(at, "nodes") == 0;
    if (boundary->nodes && !points)
        ab_report_error(r->base.report, v[BOUNDARY_AT]->mark, "%s.at: nodes is a choice for material points; on '%s' leave it out", where,
                        body->name);
    if (boundary->nodes && points && body->basis != NULL && strncmp(body->basis, "bspline", 7) == 0)
        ab_report_error(r->base.report, v[BOUNDARY_AT]->mark,
                        "%s.at: nodes is not there yet with basis %s, whose outermost nodes go by others; use at: points, or basis gimp, "
                        "linear or cpdi",
                        where, body->basis);
    const uint32_t gives = boundary->loaded->class_.gives;
    if (boundary->nodes && points && body->basis != NULL && strcmp(body->basis, "gimp") == 0 && (gives & AB_GIVE_STIFFNESS))
        ab_report_error(r->base.report, v[BOUNDARY_AT]->mark,
                        "%s.at: springs of '%s' at nodes stand on nodes with next to no mass once the outline of a gimp body moves through "
                        "cells, and the stable step goes to nothing; use at: points, or basis linear",
                        where, boundary->loaded->class_.name);
    boundary->hold = (gives & AB_GIVE_DAMPING) && (body->initial.kind != AB_INITIAL_NONE || (boundary->absent & 1u));
    if (v[BOUNDARY_HOLD] == NULL || !ab_read_flag(&r->base, &key[BOUNDARY_HOLD], v[BOUNDARY_HOLD], where, &boundary->hold) ||
        !boundary->hold)
        return;
    if (!(gives & AB_GIVE_TRACTION))
        ab_report_error(r->base.report, v[BOUNDARY_HOLD]->mark,
                        "%s.hold: '%s' prescribes motion, which holds whatever stands there; leave it out", where,
                        boundary->loaded->class_.name);
}

static void take_boundary(ab_scene_reader *r, const ab_node *node, const char *where, ab_boundary_spec *boundary) {
    const ab_node *v[BOUNDARY_KEYS];
    char path[AB_WHERE];
    int body = -1;
    boundary->mark = node->mark;
    if (!ab_section_open(&r->base, &ab_section_boundary, node, where, v)) return;
    if (v[BOUNDARY_ON] != NULL) {
        const char *name = ab_scene_word(r, v[BOUNDARY_ON], ab_where_join(path, where, "on"), "the name of a body");
        body = name == NULL ? -1 : ab_scene_body_named(r, name, v[BOUNDARY_ON]->mark, path);
        if (body >= 0 && r->scene->bodies[body].method == NULL) body = -1; /* its mistakes are told with the body */
        if (body >= 0) boundary->body = (size_t)body;
        if (body >= 0 && strcmp(r->scene->bodies[body].method, "rigid") == 0)
            ab_report_error(
                r->base.report, v[BOUNDARY_ON]->mark,
                "%s: '%s' is rigid: no wave travels in it that a boundary could answer; write its motion, or a force under loads", path,
                name);
    }
    if (v[BOUNDARY_WHERE] != NULL) ab_scene_take_where(r, v[BOUNDARY_WHERE], ab_where_join(path, where, "where"), &boundary->where);
    if (v[BOUNDARY_STAGES] != NULL) boundary->absent = ab_scene_take_absent(r, v[BOUNDARY_STAGES], ab_where_join(path, where, "stages"));
    if (take_plugin(r, &ab_section_boundary, node, v[BOUNDARY_PLUGIN], where, boundary) && body >= 0) take_ways(r, v, where, boundary);
}

/* A side of the grid that has a boundary plugin: on every body of points that has some of its outline there. */
static void take_side(ab_scene_reader *r, int side, const ab_node *node) {
    ab_scene *scene = r->scene;
    const ab_key *key = &ab_section_sides.keys[side];
    char where[AB_WHERE];
    snprintf(where, sizeof where, "grid.sides.%s", key->name);
    const ab_node *name = ab_node_find(node, "boundary");
    if (name == NULL) {
        ab_report_error(r->base.report, node->mark,
                        "key 'boundary' is missing in %s: the name of a boundary plugin, or write a word: free, roller, fixed, outflow",
                        where);
        return;
    }
    static const ab_key keys[] = {{"boundary", AB_KEY_NAME, .help = "name of a boundary plugin"}};
    static const ab_section section = {.title = "side", .keys = keys, .count = 1};
    ab_boundary_spec one = {.mark = node->mark, .on_side = true, .where = {.side = side, .mark = node->mark}};
    if (!take_plugin(r, &section, node, name, where, &one)) return;
    const int d = side / 2;
    const double slack = NEAR * scene->grid_cell;
    one.where.has[d] = true;
    one.where.range[d][0] = r->side_at[side] - slack;
    one.where.range[d][1] = r->side_at[side] + slack;
    bool met = false;
    for (size_t b = 0; b < scene->body_count; b++) {
        double low[2], high[2];
        if (scene->bodies[b].method == NULL || strcmp(scene->bodies[b].method, "material-points") != 0) continue;
        if (ab_body_bounds(&scene->bodies[b], low, high) && fabs((side % 2 ? high : low)[d] - r->side_at[side]) > slack) continue;
        one.body = b;
        one.hold = (one.loaded->class_.gives & AB_GIVE_DAMPING) && scene->bodies[b].initial.kind != AB_INITIAL_NONE;
        scene->boundaries[scene->boundary_count++] = one;
        met = true;
    }
    if (!met)
        ab_report_error(r->base.report, node->mark,
                        "%s: no body of material points has its outline on this side, at %c = %.10g m; move the side there, or write it "
                        "under boundaries with on: BODY",
                        where, d == 0 ? 'x' : 'y', r->side_at[side]);
}

void ab_scene_take_boundaries(ab_scene_reader *r, const ab_node *node) {
    ab_scene *scene = r->scene;
    if (node != NULL && !ab_scene_is_list(r, node, "boundaries", "entries - {on: BODY, where: ..., boundary: NAME, settings ...}")) return;
    if (node != NULL && node->count > MOST_ENTRIES) {
        ab_report_error(r->base.report, node->mark, "boundaries has %zu entries, more than %d", node->count, MOST_ENTRIES);
        return;
    }
    const size_t listed = node == NULL ? 0 : node->count;
    scene->boundaries = ab_reader_take(&r->base, listed + AB_SIDES * scene->body_count, sizeof *scene->boundaries);
    if (scene->boundaries == NULL) return;
    scene->boundary_count = scene->boundary_listed = listed;
    for (size_t i = 0; i < listed; i++) {
        char where[AB_WHERE];
        snprintf(where, sizeof where, "boundaries[%zu]", i);
        take_boundary(r, node->items[i], where, &scene->boundaries[i]);
    }
    for (int side = 0; side < AB_SIDES; side++)
        if (r->side_boundary[side] != NULL) take_side(r, side, r->side_boundary[side]);
}
