/* scene_materials.c: materials by name, each with the settings that its model declares. */
#include <string.h>

#include "core/scene_reader.h"
#include "core/settings.h"

static void take_material(ab_scene_reader *r, const ab_entry *entry, ab_material_spec *material) {
    enum { MOST = 128 };
    char where[AB_WHERE];
    const ab_node *v[MATERIAL_KEYS];
    ab_where_join(where, "materials", entry->key);
    material->mark = entry->mark;
    material->name = ab_reader_text(&r->base, entry->key);
    ab_name_ok(&r->base, "material", entry->key, entry->mark);
    if (!ab_section_open(&r->base, &ab_section_material, entry->value, where, v)) return;
    ab_read_number(&r->base, &ab_section_material.keys[MATERIAL_DENSITY], v[MATERIAL_DENSITY], where, &material->density);
    if (v[MATERIAL_MODEL] == NULL) return;
    char path[AB_WHERE];
    const char *model = ab_scene_word(r, v[MATERIAL_MODEL], ab_where_join(path, where, "model"), "the name of a material model");
    if (model == NULL) return;
    material->loaded = ab_registry_find(r->registry, AB_MATERIAL, model, v[MATERIAL_MODEL]->mark, r->base.report);
    if (material->loaded == NULL) return; /* its settings are not known, so nothing can be said about the other keys */
    const ab_class *class_ = &material->loaded->class_;
    const char *space;
    if (!(class_->spaces & ab_scene_space(r->scene, &space)))
        ab_report_error(r->base.report, v[MATERIAL_MODEL]->mark, "%s: model '%s' does not work in %s", path, model, space);
    const char *names[MOST];
    const size_t count = ab_settings_names(class_, names, 0, MOST);
    ab_section_unknown(&r->base, &ab_section_material, names, count, v[MATERIAL_MODEL]->override_, entry->value, where);
    material->settings = ab_settings_read(&r->base, class_, entry->value, where);
}

void ab_scene_take_materials(ab_scene_reader *r, const ab_node *node) {
    if (node == NULL) return;
    ab_scene *scene = r->scene;
    if (node->kind != AB_NODE_MAP || node->count == 0) {
        ab_report_error(r->base.report, node->mark, "materials must be a mapping {name: {model: ..., density: ...}, ...}, not %s",
                        node->kind == AB_NODE_MAP ? "an empty one" : ab_node_kind_name(node));
        return;
    }
    scene->materials = ab_reader_take(&r->base, node->count, sizeof *scene->materials);
    if (scene->materials == NULL) return;
    scene->material_count = node->count;
    for (size_t i = 0; i < node->count; i++) take_material(r, &node->entries[i], &scene->materials[i]);
}
