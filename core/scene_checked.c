/* scene_checked.c: `checked: true` puts a guard before every plugin that the scene uses. */
#include "core/guard.h"
#include "core/scene_reader.h"

/* The class with its guard, one for each class. */
static const ab_loaded_class *guarded(ab_scene_reader *r, const ab_loaded_class *loaded) {
    const ab_scene *scene = r->scene;
    if (loaded == NULL || loaded->guarded != NULL) return loaded;
    for (size_t k = 0; k < scene->material_count; k++)
        if (scene->materials[k].loaded != NULL && scene->materials[k].loaded->guarded == loaded) return scene->materials[k].loaded;
    for (size_t k = 0; k < scene->contact_count; k++) {
        const ab_loaded_class *finder = scene->contacts[k].finder, *responder = scene->contacts[k].responder;
        if (finder != NULL && finder->guarded == loaded) return finder;
        if (responder != NULL && responder->guarded == loaded) return responder;
    }
    for (size_t k = 0; k < scene->boundary_count; k++)
        if (scene->boundaries[k].loaded != NULL && scene->boundaries[k].loaded->guarded == loaded) return scene->boundaries[k].loaded;
    ab_loaded_class *outer = ab_reader_take(&r->base, 1, sizeof *outer);
    if (outer == NULL) return loaded;
    ab_guard_class(loaded, outer);
    return outer;
}

void ab_scene_take_checked(ab_scene_reader *r, const ab_node *node) {
    ab_scene *scene = r->scene;
    ab_read_flag(&r->base, &ab_section_top.keys[TOP_CHECKED], node, "", &scene->checked);
    if (!scene->checked) return;
    for (size_t k = 0; k < scene->material_count; k++) scene->materials[k].loaded = guarded(r, scene->materials[k].loaded);
    for (size_t k = 0; k < scene->contact_count; k++) {
        scene->contacts[k].finder = guarded(r, scene->contacts[k].finder);
        scene->contacts[k].responder = guarded(r, scene->contacts[k].responder);
    }
    for (size_t k = 0; k < scene->boundary_count; k++) scene->boundaries[k].loaded = guarded(r, scene->boundaries[k].loaded);
}
