/* scene_text.c: a scene written out value by value. */
#include "core/scene_text.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "core/scene_reader.h"

static const char *const MAY_CHANGE[] = {"title",      "time.end", "monitors", "history", "output",  "expect",
                                         "checkpoint", "watchdog", "checked",  "trade",   "extremes"};

static void write_node(const ab_node *node, const char *path, ab_text *text) {
    char below[1000];
    for (size_t k = 0; k < sizeof MAY_CHANGE / sizeof *MAY_CHANGE; k++)
        if (strcmp(path, MAY_CHANGE[k]) == 0) return;
    if (node->kind == AB_NODE_SCALAR) {
        ab_text_add(text, "%s: ", path);
        ab_text_add_escaped(text, node->text);
        ab_text_add(text, "\n");
    }
    for (size_t i = 0; node->kind != AB_NODE_SCALAR && i < node->count; i++) {
        const bool list = node->kind == AB_NODE_LIST;
        if (list)
            snprintf(below, sizeof below, "%.900s[%zu]", path, i);
        else
            snprintf(below, sizeof below, "%.800s%s%.128s", path, path[0] ? "." : "", node->entries[i].key);
        write_node(list ? node->items[i] : node->entries[i].value, below, text);
    }
}

static void write_plugin(const ab_loaded_class *loaded, const char *where, size_t number, ab_text *text) {
    if (loaded != NULL)
        ab_text_add(text, "plugin of %s[%zu]: %s of %s %s\n", where, number, loaded->class_.name, loaded->plugin_name,
                    loaded->plugin_version);
}

/* A file that cannot be read has nothing to say here: who needs it will. */
static void write_file(const ab_scene *scene, const char *name, ab_text *text) {
    const char *slash = scene->path != NULL && name[0] != '/' ? strrchr(scene->path, '/') : NULL;
    const size_t folder = slash != NULL ? (size_t)(slash + 1 - scene->path) : 0;
    char *path = malloc(folder + strlen(name) + 1);
    if (path == NULL) {
        text->failed = true;
        return;
    }
    memcpy(path, scene->path, folder);
    strcpy(path + folder, name);
    FILE *file = fopen(path, "rbe");
    free(path);
    uLong crc = crc32(0, NULL, 0);
    unsigned long long bytes = 0;
    unsigned char block[1 << 14];
    for (size_t some; file != NULL && (some = fread(block, 1, sizeof block, file)) > 0; bytes += some) crc = crc32(crc, block, (uInt)some);
    if (file != NULL) fclose(file);
    ab_text_add(text, "file %s: %llu bytes, check sum %08lx\n", name, bytes, crc);
}

void ab_scene_text(const ab_scene *scene, ab_text *text) {
    write_node(scene->private_->document->root, "", text);
    for (size_t m = 0; m < scene->material_count; m++) write_plugin(scene->materials[m].loaded, "materials", m, text);
    for (size_t k = 0; k < scene->contact_count; k++) {
        write_plugin(scene->contacts[k].finder, "contact", k, text);
        write_plugin(scene->contacts[k].responder, "response of contact", k, text);
    }
    for (size_t k = 0; k < scene->boundary_count; k++) write_plugin(scene->boundaries[k].loaded, "boundaries", k, text);
    for (size_t b = 0; b < scene->body_count; b++)
        if (scene->bodies[b].mesh.file != NULL) write_file(scene, scene->bodies[b].mesh.file, text);
    for (const ab_file_read *file = scene->files; file != NULL; file = file->next) write_file(scene, file->name, text);
    ab_text_add(text, "\n");
}

void ab_scene_text_of_expect(const ab_scene *scene, size_t expect, ab_text *text) {
    const ab_node *root = scene->private_->document->root, *expects = ab_node_find(root, "expect"),
                  *monitors = ab_node_find(root, "monitors");
    const size_t monitor = scene->expects[expect].monitor;
    if (expects != NULL && expects->kind == AB_NODE_LIST && expect < expects->count) write_node(expects->items[expect], "-", text);
    if (monitor != SIZE_MAX && monitors != NULL && monitors->kind == AB_NODE_LIST && monitor < monitors->count)
        write_node(monitors->items[monitor], "of", text);
    ab_text_add(text, "\n");
}
