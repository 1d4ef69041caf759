/* plugin_check.h: whether the tables of a plugin say things that can be true. */
#ifndef AB_PLUGIN_CHECK_H
#define AB_PLUGIN_CHECK_H

#include "abut_plugin.h"
#include "core/plugin_elf.h"

enum { AB_CLASSES_MAX = 64, AB_PARAMS_MAX = 256, AB_STATES_MAX = 64, AB_TEXT_MAX = 2000 };

/* Versions and sizes, before anything of the plugin is loaded. */
bool ab_check_head(const ab_plugin_head *head, ab_refusal *refusal);

/* Name, version, licence, class pointers. `plugin` is the host's zero-filled copy. */
bool ab_check_plugin(const ab_plugin *plugin, ab_refusal *refusal);

/* Copies a class into the host's zero-filled structs and checks every table of it. ops: room for the largest operations struct;
 * which of them is filled follows from the kind. */
typedef struct ab_class_copy {
    ab_class class_;
    ab_material_ops material;
    ab_boundary_ops boundary;
    ab_contact_ops contact;
} ab_class_copy;
bool ab_check_class(const ab_class *given, ab_class_copy *copy, ab_refusal *refusal);

/* How many words "a|b|c" has; 0 when it has none or an empty one. */
size_t ab_choice_count(const char *choices);

/* True when a value keeps the range that a setting declares (0, 0 stands for any). NaN keeps none. */
bool ab_param_allows(const ab_param *param, double value);

/* "material", "boundary", "contact" (the names of the folders, too); NULL for no kind. */
const char *ab_kind_name(uint32_t kind);

#endif
