/* plugin_host.h: finds, checks and loads plugins (docs: plugins/abut_plugin.h), keeps the classes they offer, resolves settings. */
#ifndef AB_PLUGIN_HOST_H
#define AB_PLUGIN_HOST_H

#include <stdatomic.h>

#include "abut_plugin.h"
#include "core/report.h"

typedef struct ab_registry ab_registry;

/* A loaded class as the host keeps it: its own zero-filled copy of the plugin's tables, normalised to this host's struct sizes. */
typedef struct ab_loaded_class {
    ab_class class_;          /* struct_size etc. already checked */
    ab_material_ops material; /* zeroed for other kinds */
    ab_boundary_ops boundary;
    ab_contact_ops contact;
    const char *path; /* file it came from */
    const char *plugin_name, *plugin_version, *plugin_licence;
    const struct ab_loaded_class *guarded; /* the class that this one stands before as its guard (core/guard.h); NULL: none */
} ab_loaded_class;

/* Search path: `paths` (colon separated, from --plugin-path; may be NULL), then $ABUT_PLUGIN_PATH, then the folder of built-ins (beside the
 * binary in a build tree, <libdir>/abut/plugins once installed). Files are found by the class they offer: scanning reads the one data symbol of each
 * *.so there. Loading is lazy: ab_registry_open only lists files; a file is loaded (dlopen RTLD_NOW | RTLD_LOCAL, never closed while the registry
 * lives) when a class of the kind is looked up and not known yet.
 * How a file tells its class without being loaded: by its name: classes of kind K live in files named <anything>.so under the folders
 * `material/`, `boundary/`, `contact/` of each search path entry, or directly in the entry; the class name with '-' as '_' is tried first
 * (linear-elastic -> material/linear_elastic.so), in every entry; only if that misses are the other files of the kind opened.
 * Strict: two files among those opened that offer the same class are an error that names both (the same file met twice is one), and so is any
 * opened file that is refused. Empty entries of a search path are passed over, so the working directory is searched only where it is named. */
ab_status ab_registry_create(const char *paths, ab_registry **registry, ab_report *report);
/* From now on files and folders that other users can write to are no reason to refuse a plugin. */
void ab_registry_force(ab_registry *registry);
void ab_registry_destroy(ab_registry *registry);

/* The class of that kind and name, loading what it takes. NULL with an error in the report: at `mark`, naming paths tried, nearest names. */
const ab_loaded_class *ab_registry_find(ab_registry *registry, uint32_t kind, const char *name, ab_mark mark, ab_report *report);

/* Reports "no material model 'X'; did you mean 'Y'? looked in: ..." (kind 0: any plugin) and returns AB_BAD_INPUT. */
ab_status ab_registry_not_found(const ab_registry *registry, uint32_t kind, const char *name, ab_mark mark, ab_report *report);
/* "DIR, DIR (not there)"; returns how many. */
size_t ab_registry_paths(const ab_registry *registry, char *text, size_t size);

/* Every plugin on the search path, loaded (for `abut plugins` and for docs). Refused files are reported as errors. */
ab_status ab_registry_load_all(ab_registry *registry, ab_report *report);
size_t ab_registry_count(const ab_registry *registry);
const ab_loaded_class *ab_registry_class(const ab_registry *registry, size_t index); /* in order of kind, name */

/* Host services for create(). One ab_service per instance, which must not move afterwards; messages are kept for the error that follows. */
typedef struct ab_service {
    ab_host host;                   /* pass &service.host to create; whoever has a finder sets host.reserve (and its context) before */
    char message[512];              /* last message */
    char who[96];                   /* "material 'soil' (von-mises)" */
    atomic_flag busy;               /* while a thread writes message */
    const ab_loaded_class *guarded; /* of the class whose create gets this host; set it after ab_service_init */
} ab_service;
void ab_service_init(ab_service *service, const char *who);

#endif
