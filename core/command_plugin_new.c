/* command_plugin_new.c: `abut plugins new KIND NAME` writes a plugin that works, to be changed: its source, CMakeLists.txt and a scene that uses it. */
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/commands.h"
#include "core/files.h"
#include "core/plugin_host.h"
#include "core/plugin_new.h"
#include "core/suggest.h"

enum { NAME_MAX_ = 40, FILES = 3 };

static ab_status check_kind(const char *kind, ab_report *report) {
    static const char *const kinds[] = {"material", "boundary", "finder", "response"};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        if (strcmp(kind, kinds[k]) == 0) return AB_OK;
    if (strcmp(kind, "contact") == 0)
        return ab_report_error(report, AB_NOWHERE,
                               "new contact: a contact plugin finds contact points or responds to them; write `abut plugins new finder "
                               "NAME` or `abut plugins new response NAME`");
    const char *near = ab_suggest(kind, (const char **)(uintptr_t)kinds, sizeof kinds / sizeof *kinds);
    return ab_report_error(report, AB_NOWHERE, "new %s: there is no such kind%s%s%s; the kinds are material, boundary, finder and response",
                           kind, near ? "; did you mean '" : "", near ? near : "", near ? "'" : "");
}

/* A name has to be one in scenes, in file names and, with '_' for '-', in C. */
static ab_status check_name(const char *name, ab_report *report) {
    size_t length = strlen(name);
    bool good = length > 0 && length <= NAME_MAX_ && islower((unsigned char)name[0]) && name[length - 1] != '-';
    for (size_t i = 0; good && i < length; i++)
        good = islower((unsigned char)name[i]) || isdigit((unsigned char)name[i]) || (name[i] == '-' && name[i + 1] != '-');
    static const char *const taken[] = {
        /* of the source that is written */
        "law", "create", "destroy", "update", "find", "reach", "respond", "apply", "params", "states", "ops", "classes", "class", "main",
        "size-t", "offsetof",
        /* of C and C++ */
        "auto", "bool", "break", "case", "char", "const", "continue", "default", "delete", "do", "double", "else", "enum", "extern",
        "false", "float", "for", "goto", "if", "inline", "int", "long", "new", "private", "register", "restrict", "return", "short",
        "signed", "sizeof", "static", "struct", "switch", "this", "true", "typedef", "union", "unsigned", "void", "volatile", "while",
        /* of its mathematics */
        "abs", "acos", "asin", "atan", "cbrt", "ceil", "cos", "cosh", "div", "erf", "exp", "exp2", "expm1", "fabs", "floor", "fma", "fmax",
        "fmin", "fmod", "gamma", "hypot", "isnan", "j0", "j1", "jn", "lgamma", "log", "log10", "log2", "pow", "rint", "round", "signgam",
        "sin", "sinh", "sqrt", "tan", "tanh", "tgamma", "trunc", "y0", "y1", "yn"};
    if (good && (strncmp(name, "ab-", 3) == 0 || strncmp(name, "abut-", 5) == 0))
        return ab_report_error(report, AB_NOWHERE, "'%s': names that begin with ab- or abut- are those of the interface; take another",
                               name);
    for (size_t k = 0; good && k < sizeof taken / sizeof *taken; k++)
        if (strcmp(name, taken[k]) == 0)
            return ab_report_error(report, AB_NOWHERE, "'%s' has a meaning in the source that is to be written; take another name", name);
    if (good) return AB_OK;
    return ab_report_error(report, AB_NOWHERE,
                           "'%.64s' cannot be the name of a plugin: it takes small letters, digits and single '-' between them, a letter "
                           "first, at most %d characters, such as soft-clay",
                           name, NAME_MAX_);
}

/* The text with my-law and my_law replaced; NULL without memory. */
static char *fill_in(const char *text, const char *name) {
    const size_t length = strlen(name), size = strlen(text) * (length + 2) / 2 + 64;
    char *filled = malloc(size);
    if (!filled) return NULL;
    size_t used = 0;
    while (*text) {
        const bool dash = strncmp(text, "my-law", 6) == 0, under = strncmp(text, "my_law", 6) == 0;
        if (!dash && !under) {
            filled[used++] = *text++;
            continue;
        }
        for (size_t i = 0; i < length; i++) filled[used++] = under && name[i] == '-' ? '_' : name[i];
        text += 6;
    }
    filled[used] = '\0';
    return filled;
}

static ab_status write_new(const char *path, const char *text, ab_report *report) {
    const int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) return ab_report_failure(report, "cannot write '%s': %s", path, strerror(errno));
    const size_t length = strlen(text);
    size_t done = 0;
    while (done < length) {
        const ssize_t wrote = write(file, text + done, length - done);
        if (wrote < 0 && errno == EINTR) continue;
        if (wrote <= 0) break;
        done += (size_t)wrote;
    }
    const bool good = done == length;
    const int why = errno;
    if (close(file) != 0 || !good) return ab_report_failure(report, "cannot write '%s': %s", path, strerror(why));
    return AB_OK;
}

static const char *template_text(const char *file) {
    for (const ab_plugin_template *t = ab_plugin_templates; t->file; t++)
        if (strcmp(t->file, file) == 0) return t->text;
    return NULL;
}

static ab_status write_all(const char *kind, const char *name, const char *folder, ab_report *report) {
    char path[FILES][PATH_MAX], template_name[FILES][32], file[NAME_MAX_ + 1];
    snprintf(file, sizeof file, "%s", name);
    for (char *c = file; *c; c++)
        if (*c == '-') *c = '_';
    snprintf(template_name[0], sizeof *template_name, "%s.c", kind);
    snprintf(template_name[1], sizeof *template_name, "CMakeLists.txt");
    snprintf(template_name[2], sizeof *template_name, "%s.yaml", kind);
    int fits = snprintf(path[0], sizeof *path, "%s/%s.c", folder, file) < (int)sizeof *path;
    fits = fits && snprintf(path[1], sizeof *path, "%s/CMakeLists.txt", folder) < (int)sizeof *path;
    fits = fits && snprintf(path[2], sizeof *path, "%s/%s.yaml", folder, file) < (int)sizeof *path;
    if (!fits) return ab_report_error(report, AB_NOWHERE, "the folder's name is too long: '%.80s...'", folder);
    AB_TRY(ab_folder_make(folder, report));
    struct stat there;
    for (int k = 0; k < FILES; k++) /* all or nothing */
        if (lstat(path[k], &there) == 0)
            return ab_report_error(report, AB_NOWHERE,
                                   "'%s' is there already and is not overwritten; take another name or another folder (-o)", path[k]);
    for (int k = 0; k < FILES; k++) {
        const char *text = template_text(template_name[k]);
        char *filled = text ? fill_in(text, name) : NULL;
        const ab_status status = filled ? write_new(path[k], filled, report) : ab_report_failure(report, "no memory for '%s'", path[k]);
        free(filled);
        AB_TRY(status);
    }
    printf("wrote %s, %s, %s\n\n"
           "  cd %s\n"
           "  cmake -S . -B build -DCMAKE_PREFIX_PATH=PREFIX && cmake --build build    # PREFIX: where abut is installed\n"
           "  abut plugins check build/%s.so\n"
           "  abut run %s.yaml --strict --plugin-path build\n",
           path[0], path[1], path[2], folder, file, file);
    return AB_OK;
}

/* A second plugin of a name and kind that is there already would be refused when a scene asks for it. Plugins that cannot be loaded are not this command's matter. */
static ab_status check_not_there(const char *kind, const char *name, const ab_command_line *line, ab_report *report) {
    const uint32_t wanted = strcmp(kind, "material") == 0 ? AB_MATERIAL : strcmp(kind, "boundary") == 0 ? AB_BOUNDARY : AB_CONTACT;
    ab_report *aside = ab_report_create();
    ab_registry *registry = NULL;
    ab_status status = AB_OK;
    if (aside != NULL && ab_registry_create(line->plugin_path, &registry, aside) == AB_OK) {
        ab_registry_load_all(registry, aside);
        for (size_t i = 0; i < ab_registry_count(registry) && status == AB_OK; i++) {
            const ab_loaded_class *there = ab_registry_class(registry, i);
            if (there->class_.kind == wanted && strcmp(there->class_.name, name) == 0)
                status = ab_report_error(report, AB_NOWHERE, "'%s' is the name of a plugin that is there already, %s; take another", name,
                                         there->path);
        }
    }
    ab_registry_destroy(registry);
    ab_report_destroy(aside);
    return status;
}

int ab_command_plugin_new(const ab_command_line *line) {
    ab_report *report = ab_report_create();
    if (!report) return AB_FAILED;
    ab_status status = AB_OK;
    if (line->word_count != 3)
        status =
            ab_report_error(report, AB_NOWHERE,
                            "`abut plugins new` takes a kind (material, boundary, finder, response) and a name, such as `abut plugins new "
                            "material soft-clay`");
    if (status == AB_OK) status = check_kind(line->words[1], report);
    if (status == AB_OK) status = check_name(line->words[2], report);
    if (status == AB_OK) status = check_not_there(line->words[1], line->words[2], line, report);
    if (status == AB_OK) status = write_all(line->words[1], line->words[2], line->output ? line->output : line->words[2], report);
    fflush(stdout);
    ab_report_print(report, stderr);
    ab_report_destroy(report);
    return (int)status;
}
