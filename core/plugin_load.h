/* plugin_load.h: one file on the search path, from its name to the classes in it. */
#ifndef AB_PLUGIN_LOAD_H
#define AB_PLUGIN_LOAD_H

#include "core/plugin_check.h"

typedef struct ab_plugin_file {
    void *handle;           /* of dlopen */
    ab_plugin plugin;       /* zero-filled copy */
    ab_class_copy *classes; /* plugin.class_count of them */
} ab_plugin_file;

/* Checks the file, loads it, checks what it brought. `path` is absolute. False with the reason; nothing is then left loaded. */
bool ab_plugin_load(const char *path, ab_plugin_file *file, ab_refusal *refusal);
/* plugin_safe.c: false with the reason where another user could change the file or a folder on the way to it. */
bool ab_plugin_is_safe(const char *path, ab_refusal *refusal);
void ab_plugin_unload(ab_plugin_file *file);

#endif
