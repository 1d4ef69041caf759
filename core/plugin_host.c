/* plugin_host.c: the registry: which files lie on the search path, which of them were opened, which classes they brought. */
#include "core/plugin_host.h"

#include <dirent.h>
#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/plugin_load.h"
#include "core/suggest.h"

typedef struct folder { /* an entry of the search path */
    char *path;         /* absolute where it exists, else as it was written */
    bool exists;
} folder;

typedef struct candidate { /* a file that may be a plugin */
    char *path;
    uint32_t kind; /* by the folder it lies in; 0: any */
    dev_t device;
    ino_t inode;
    bool opened, refused;
    ab_refusal refusal;
    ab_plugin_file file;
} candidate;

struct ab_registry {
    folder *folders;
    size_t folder_count;
    candidate *candidates; /* all listed at the start; the array does not move afterwards */
    size_t candidate_count;
    ab_loaded_class **classes; /* in order of kind, name */
    size_t class_count;
    bool forced; /* who can write to a plugin is not looked at */
};

/* ---- the search path --------------------------------------------------------------------------------------------------------------- */

/* One more element at the end of an array; NULL (array untouched) without memory. The new element is zeroed. */
static void *grow(void *array_pointer, size_t *count, size_t element) {
    void **array = array_pointer;
    char *grown = realloc(*array, (*count + 1) * element);
    if (!grown) return NULL;
    *array = grown;
    char *added = grown + *count * element;
    memset(added, 0, element);
    (*count)++;
    return added;
}

static bool is_folder(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

static char *join(const char *left, const char *middle, const char *right) {
    const size_t size = strlen(left) + strlen(middle) + strlen(right) + 1;
    char *text = malloc(size);
    if (text) snprintf(text, size, "%s%s%s", left, middle, right);
    return text;
}

static ab_status no_memory(ab_report *report) { return ab_report_failure(report, "no memory for the list of plugins"); }

static ab_status add_folder(ab_registry *registry, const char *path, ab_report *report) {
    char *absolute = realpath(path, NULL);
    const bool exists = absolute && is_folder(absolute);
    for (size_t i = 0; exists && i < registry->folder_count; i++)
        if (strcmp(registry->folders[i].path, absolute) == 0) return free(absolute), AB_OK;
    char *kept = exists ? absolute : strdup(path);
    if (!exists) free(absolute);
    folder *added = kept ? grow(&registry->folders, &registry->folder_count, sizeof *added) : NULL;
    if (!added) return free(kept), no_memory(report);
    *added = (folder){.path = kept, .exists = exists};
    return AB_OK;
}

/* The entries of "a:b:c"; empty ones are passed over. must: each has to be there. */
static ab_status add_folders(ab_registry *registry, const char *paths, bool must, ab_report *report) {
    ab_status status = AB_OK;
    while (paths && *paths) {
        const size_t length = strcspn(paths, ":");
        char *path = strndup(paths, length);
        if (!path) return no_memory(report);
        if (length > 0) {
            if (must && !is_folder(path)) status = ab_report_error(report, AB_NOWHERE, "--plugin-path: there is no folder '%s'", path);
            const ab_status added = add_folder(registry, path, report);
            if (added != AB_OK) status = added;
        }
        free(path);
        paths += length + (paths[length] == ':');
    }
    return status;
}

/* The folder of built-ins: beside the program in a build tree; in an installation, also one that was moved, where it lies from the
 * program; else where it was to be installed. */
static ab_status add_builtin_folder(ab_registry *registry, ab_report *report) {
    static const char *const from_program[] = {"/plugins", "/" ABUT_PLUGINS_FROM_BIN};
    char program[4096];
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = '\0';
    char *slash = strrchr(program, '/');
    for (size_t i = 0; slash && i < sizeof from_program / sizeof *from_program; i++) {
        *slash = '\0';
        char *path = join(program, "", from_program[i]);
        if (!path) return no_memory(report);
        const bool found = is_folder(path);
        const ab_status status = found ? add_folder(registry, path, report) : AB_OK;
        free(path);
        if (found || status != AB_OK) return status;
    }
    return add_folder(registry, ABUT_LIBDIR "/abut/plugins", report);
}

/* ---- the files --------------------------------------------------------------------------------------------------------------------- */

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

/* Lists the *.so of one folder in order of name. */
static ab_status list_files(ab_registry *registry, const char *path, uint32_t kind, ab_report *report) {
    DIR *directory = opendir(path);
    if (!directory)
        return errno == ENOENT || errno == ENOTDIR
                   ? AB_OK
                   : ab_report_error(report, AB_NOWHERE, "cannot read the plugin folder '%s': %s", path, strerror(errno));
    char **names = NULL;
    size_t count = 0;
    ab_status status = AB_OK;
    for (const struct dirent *entry; status == AB_OK && (entry = readdir(directory));) {
        const size_t length = strlen(entry->d_name);
        if (entry->d_name[0] == '.' || length < 4 || strcmp(entry->d_name + length - 3, ".so") != 0) continue;
        char **name = grow(&names, &count, sizeof *names);
        if (!name || !(*name = join(path, "/", entry->d_name))) status = no_memory(report);
    }
    closedir(directory);
    if (status == AB_OK && count > 0) qsort(names, count, sizeof *names, by_name);
    for (size_t i = 0; i < count; i++) {
        struct stat file;
        bool known = false;
        if (status == AB_OK && stat(names[i], &file) == 0) { /* a dangling link is listed, and refused when it is opened */
            for (size_t k = 0; k < registry->candidate_count && !known; k++)
                known = registry->candidates[k].inode == file.st_ino && registry->candidates[k].device == file.st_dev;
        } else {
            memset(&file, 0, sizeof file);
        }
        candidate *added = status == AB_OK && !known ? grow(&registry->candidates, &registry->candidate_count, sizeof *added) : NULL;
        if (added)
            *added = (candidate){.path = names[i], .kind = kind, .device = file.st_dev, .inode = file.st_ino};
        else
            free(names[i]);
        if (!added && !known && status == AB_OK) status = no_memory(report);
    }
    free(names);
    return status;
}

static ab_status list_folder(ab_registry *registry, const char *path, ab_report *report) {
    for (uint32_t kind = AB_MATERIAL; ab_kind_name(kind); kind++) {
        char *below = join(path, "/", ab_kind_name(kind));
        const ab_status status = below ? list_files(registry, below, kind, report) : no_memory(report);
        free(below);
        AB_TRY(status);
    }
    return list_files(registry, path, 0, report);
}

ab_status ab_registry_create(const char *paths, ab_registry **registry, ab_report *report) {
    ab_registry *made = calloc(1, sizeof *made);
    *registry = NULL;
    if (!made) return no_memory(report);
    ab_status status = add_folders(made, paths, true, report);
    if (status == AB_OK) status = add_folders(made, getenv("ABUT_PLUGIN_PATH"), false, report);
    if (status == AB_OK) status = add_builtin_folder(made, report);
    for (size_t i = 0; i < made->folder_count && status == AB_OK; i++)
        if (made->folders[i].exists) status = list_folder(made, made->folders[i].path, report);
    if (status != AB_OK) return ab_registry_destroy(made), status;
    *registry = made;
    return AB_OK;
}

void ab_registry_force(ab_registry *registry) { registry->forced = true; }

void ab_registry_destroy(ab_registry *registry) {
    if (!registry) return;
    for (size_t i = 0; i < registry->class_count; i++) free(registry->classes[i]);
    for (size_t i = 0; i < registry->candidate_count; i++) {
        ab_plugin_unload(&registry->candidates[i].file);
        free(registry->candidates[i].path);
    }
    for (size_t i = 0; i < registry->folder_count; i++) free(registry->folders[i].path);
    free(registry->classes);
    free(registry->candidates);
    free(registry->folders);
    free(registry);
}

size_t ab_registry_paths(const ab_registry *registry, char *text, size_t size) {
    size_t used = 0;
    if (size > 0) text[0] = '\0';
    for (size_t i = 0; i < registry->folder_count && used < size; i++) {
        const folder *entry = &registry->folders[i];
        const int written = snprintf(text + used, size - used, "%s%s%s", i ? ", " : "", entry->path, entry->exists ? "" : " (not there)");
        used += written > 0 ? (size_t)written : 0;
    }
    return registry->folder_count;
}

/* ---- opening ----------------------------------------------------------------------------------------------------------------------- */

static int compare_classes(const void *a, const void *b) {
    const ab_loaded_class *left = *(ab_loaded_class *const *)a, *right = *(ab_loaded_class *const *)b;
    if (left->class_.kind != right->class_.kind) return left->class_.kind < right->class_.kind ? -1 : 1;
    return strcmp(left->class_.name, right->class_.name);
}

static const ab_loaded_class *known_class(const ab_registry *registry, uint32_t kind, const char *name) {
    for (size_t i = 0; i < registry->class_count; i++)
        if (registry->classes[i]->class_.kind == kind && strcmp(registry->classes[i]->class_.name, name) == 0) return registry->classes[i];
    return NULL;
}

static bool add_classes(ab_registry *registry, candidate *from) {
    const ab_plugin_file *file = &from->file;
    for (uint32_t i = 0; i < file->plugin.class_count; i++) {
        const ab_class *class_ = &file->classes[i].class_;
        const ab_loaded_class *other = known_class(registry, class_->kind, class_->name);
        if (other)
            return ab_refuse(&from->refusal, "offers the %s class '%s', and so does %s; take one of them off the search path",
                             ab_kind_name(class_->kind), class_->name, other->path);
    }
    for (uint32_t i = 0; i < file->plugin.class_count; i++) {
        const ab_class_copy *copy = &file->classes[i];
        ab_loaded_class *made = calloc(1, sizeof *made);
        ab_loaded_class **added = made ? grow(&registry->classes, &registry->class_count, sizeof *added) : NULL;
        if (!added) return free(made), ab_refuse(&from->refusal, "cannot be loaded: no memory");
        *made = (ab_loaded_class){.class_ = copy->class_,
                                  .material = copy->material,
                                  .boundary = copy->boundary,
                                  .contact = copy->contact,
                                  .path = from->path,
                                  .plugin_name = file->plugin.name,
                                  .plugin_version = file->plugin.version,
                                  .plugin_licence = file->plugin.licence};
        *added = made;
    }
    qsort(registry->classes, registry->class_count, sizeof *registry->classes, compare_classes);
    return true;
}

/* Opens a file once; says each time why it was refused. The object of a refused duplicate stays loaded, its classes unknown. */
static ab_status open_candidate(ab_registry *registry, candidate *from, ab_mark mark, ab_report *report) {
    if (!from->opened) {
        from->opened = true;
        from->refused = (!registry->forced && !ab_plugin_is_safe(from->path, &from->refusal)) ||
                        !ab_plugin_load(from->path, &from->file, &from->refusal) || !add_classes(registry, from);
    }
    return from->refused ? ab_report_error(report, mark, "plugin %s %s", from->path, from->refusal.text) : AB_OK;
}

/* True when the file's name says it offers that class: linear_elastic.so, or linear-elastic.so, for linear-elastic. */
static bool is_named_for(const candidate *file, const char *name) {
    const char *slash = strrchr(file->path, '/'), *c = slash ? slash + 1 : file->path;
    while (*name && (*c == *name || (*c == '_' && *name == '-'))) c++, name++;
    return *name == '\0' && strcmp(c, ".so") == 0;
}

static ab_status open_kind(ab_registry *registry, uint32_t kind, const char *name, ab_mark mark, ab_report *report) {
    ab_status status = AB_OK;
    for (size_t i = 0; i < registry->candidate_count; i++) {
        candidate *file = &registry->candidates[i];
        if ((kind && file->kind && file->kind != kind) || (name && !is_named_for(file, name))) continue;
        if (open_candidate(registry, file, mark, report) != AB_OK) status = AB_BAD_INPUT;
    }
    return status;
}

ab_status ab_registry_not_found(const ab_registry *registry, uint32_t kind, const char *name, ab_mark mark, ab_report *report) {
    static const char *const words[] = {"plugin", "material model", "boundary", "contact algorithm"};
    const char **names = calloc(registry->class_count + 1, sizeof *names);
    char paths[2048], tail[600] = "";
    size_t count = 0;
    for (size_t i = 0; names && i < registry->class_count; i++)
        if (!kind || registry->classes[i]->class_.kind == kind) names[count++] = registry->classes[i]->class_.name;
    if (names) ab_suggest_tail(name, names, count, tail, sizeof tail - 1); /* room for a semicolon */
    ab_registry_paths(registry, paths, sizeof paths);
    ab_report_error(report, mark, "no %s '%s'%s looked in: %s", words[kind <= AB_CONTACT ? kind : 0], name,
                    tail[0] == '\0'                 ? ";"
                    : tail[strlen(tail) - 1] == '?' ? tail
                                                    : strcat(tail, ";"),
                    paths);
    free(names);
    return AB_BAD_INPUT;
}

const ab_loaded_class *ab_registry_find(ab_registry *registry, uint32_t kind, const char *name, ab_mark mark, ab_report *report) {
    if (open_kind(registry, kind, name, mark, report) != AB_OK) return NULL;
    const ab_loaded_class *found = known_class(registry, kind, name);
    if (found) return found;
    if (open_kind(registry, kind, NULL, mark, report) == AB_OK) {
        found = known_class(registry, kind, name);
        if (found) return found;
    }
    ab_registry_not_found(registry, kind, name, mark, report);
    return NULL;
}

ab_status ab_registry_load_all(ab_registry *registry, ab_report *report) { return open_kind(registry, 0, NULL, AB_NOWHERE, report); }

size_t ab_registry_count(const ab_registry *registry) { return registry->class_count; }

const ab_loaded_class *ab_registry_class(const ab_registry *registry, size_t index) {
    return index < registry->class_count ? registry->classes[index] : NULL;
}
