/* settings.h: settings of a plugin, from a mapping of the scene, checked against what the plugin declares. */
#ifndef AB_SETTINGS_H
#define AB_SETTINGS_H

#include "core/plugin_host.h"
#include "core/schema.h"

/* One value per declared setting, in its order, from the keys of `node` with the same names; keys that the class does not declare are not
 * looked at (ab_section_unknown has). NULL only when there is no memory. Mistakes are reported and leave the default. */
ab_value *ab_settings_read(ab_reader *reader, const ab_class *class_, const ab_node *node, const char *where);

/* Adds the names of the class's settings to a list of at most `most`. */
size_t ab_settings_names(const ab_class *class_, const char **names, size_t count, size_t most);

#endif
