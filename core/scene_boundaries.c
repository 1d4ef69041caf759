/* scene_boundaries.c: boundary plugins on parts of outlines. */
#include <string.h>

#include "core/scene_reader.h"
#include "core/settings.h"

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

static void take_boundary(ab_scene_reader *r, const ab_node *node, const char *where, ab_boundary_spec *boundary) {
    const ab_node *v[BOUNDARY_KEYS];
    char path[AB_WHERE];
    boundary->mark = node->mark;
    if (!ab_section_open(&r->base, &ab_section_boundary, node, where, v)) return;
    if (v[BOUNDARY_ON] != NULL) {
        const char *name = ab_scene_word(r, v[BOUNDARY_ON], ab_where_join(path, where, "on"), "the name of a body");
        const int body = name == NULL ? -1 : ab_scene_body_named(r, name, v[BOUNDARY_ON]->mark, path);
        if (body >= 0) boundary->body = (size_t)body;
        if (body >= 0 && strcmp(r->scene->bodies[body].method, "rigid") == 0)
            ab_report_error(
                r->base.report, v[BOUNDARY_ON]->mark,
                "%s: '%s' is rigid: no wave travels in it that a boundary could answer; write its motion, or a force under loads", path,
                name);
    }
    if (v[BOUNDARY_WHERE] != NULL) ab_scene_take_where(r, v[BOUNDARY_WHERE], ab_where_join(path, where, "where"), &boundary->where);
    take_plugin(r, &ab_section_boundary, node, v[BOUNDARY_PLUGIN], where, boundary);
}

void ab_scene_take_boundaries(ab_scene_reader *r, const ab_node *node) {
    ab_scene *scene = r->scene;
    if (node == NULL || !ab_scene_is_list(r, node, "boundaries", "entries - {on: BODY, where: ..., boundary: NAME, settings ...}")) return;
    if (node->count > MOST_ENTRIES) {
        ab_report_error(r->base.report, node->mark, "boundaries has %zu entries, more than %d", node->count, MOST_ENTRIES);
        return;
    }
    scene->boundaries = ab_reader_take(&r->base, node->count, sizeof *scene->boundaries);
    if (scene->boundaries == NULL) return;
    scene->boundary_count = scene->boundary_listed = node->count;
    for (size_t i = 0; i < node->count; i++) {
        char where[AB_WHERE];
        snprintf(where, sizeof where, "boundaries[%zu]", i);
        take_boundary(r, node->items[i], where, &scene->boundaries[i]);
    }
}
