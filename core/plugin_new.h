/* plugin_new.h: what `abut plugins new` writes: the files of plugins/new, which the build puts into the program. */
#ifndef AB_PLUGIN_NEW_H
#define AB_PLUGIN_NEW_H

typedef struct ab_plugin_template {
    const char *file; /* "material.c", "material.yaml", ..., "CMakeLists.txt" */
    const char *text; /* about the class my-law in the file my_law.c */
} ab_plugin_template;

extern const ab_plugin_template ab_plugin_templates[]; /* ends with file NULL */

#endif
