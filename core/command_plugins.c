/* command_plugins.c: `abut plugins` lists what the search path offers, `abut plugins show NAME` tells all that a class declares. */
#include <math.h>
#include <string.h>

#include "core/commands.h"
#include "core/plugin_check.h"
#include "core/plugin_host.h"

typedef struct word {
    uint32_t bit;
    const char *text;
} word;

static const word spaces[] = {{AB_PLANE_STRAIN, "plane strain"}, {AB_AXISYMMETRIC, "axisymmetric"}, {AB_SPACE_3D, "3-D"}};
static const word needs[] = {{AB_NEED_DEFORMATION_GRADIENT, "deformation gradient"},
                             {AB_NEED_VELOCITY_GRADIENT, "velocity gradient"},
                             {AB_NEED_SHARED_NODES, "shared nodes"},
                             {AB_NEED_MASS_GRADIENT, "mass gradient"},
                             {AB_NEED_AREA_VECTOR, "area vector"},
                             {AB_NEED_NEAR_POINTS, "points near the node"},
                             {AB_NEED_SURFACE, "points and faces of surfaces"},
                             {AB_NEED_DISTANCE, "distance from the stiffer body"},
                             {AB_NEED_GAP, "gap"},
                             {AB_NEED_FIXED_PLACES, "fixed places"},
                             {AB_NEED_DENSITY_GRADIENT, "density gradient"},
                             {AB_NEED_NEAREST_FACE, "nearest face"},
                             {AB_NEED_AREA, "area"},
                             {AB_NEED_WHOLE_SIDE, "the whole side"},
                             {AB_NEED_AXES, "axes of space"}};
static const word gives[] = {{AB_GIVE_STRESS, "stress"},
                             {AB_GIVE_DISSIPATION, "dissipation"},
                             {AB_GIVE_WAVE_SPEED, "wave speed"},
                             {AB_GIVE_POINTS, "contact points (algorithm)"},
                             {AB_GIVE_IMPULSE, "impulses (response)"},
                             {AB_GIVE_TRACTION, "traction"},
                             {AB_GIVE_DAMPING, "damping"},
                             {AB_GIVE_STIFFNESS, "stiffness"},
                             {AB_GIVE_MOTION, "motion"}};
static const char *const shapes[] = {"?", "scalar", "vector", "symmetric tensor", "full tensor"};

static int longest(int width, const char *text) {
    const int length = (int)strlen(text);
    return length > width ? length : width;
}

static void print_words(const char *title, const word *words, size_t count, uint32_t bits) {
    const char *between = "";
    printf("  %-11s", title);
    for (size_t i = 0; i < count; i++) {
        if (!(bits & words[i].bit)) continue;
        printf("%s%s", between, words[i].text);
        between = ", ";
    }
    printf("%s\n", *between ? "" : "nothing");
}
#define WORDS(list) list, sizeof(list) / sizeof *(list)

/* "> 0", "-1 < nu < 0.5", "0 or 1", "a | b | [x, y]", "any" */
static void describe_range(const ab_param *param, char *text, size_t size) {
    const bool any = param->min == 0.0 && param->max == 0.0, low = !any && isfinite(param->min), high = !any && isfinite(param->max);
    const char *const above = param->flags & AB_MIN_OPEN ? ">" : ">=", *const below = param->flags & AB_MAX_OPEN ? "<" : "<=";
    const char *const left = param->flags & AB_MIN_OPEN ? "<" : "<=";
    const char *const what = param->type == AB_INTEGER ? "whole, "
                             : param->type == AB_TABLE ? param->flags & AB_COLUMNS_2 ? "pairs, " : "table, "
                                                       : "";
    if (param->type == AB_CHOICE) {
        size_t used = 0;
        for (const char *c = param->choices; *c && used + 4 < size; c++)
            used += (size_t)snprintf(text + used, size - used, *c == '|' ? " | " : "%c", *c);
        if (param->flags & AB_OR_DIRECTION && used + 12 < size) snprintf(text + used, size - used, " | [x, y]");
    } else if (param->type == AB_FLAG)
        snprintf(text, size, "true | false");
    else if (low && high)
        snprintf(text, size, "%s%g %s %s %s %g", what, param->min, left, param->name, below, param->max);
    else if (low)
        snprintf(text, size, "%s%s %g", what, above, param->min);
    else if (high)
        snprintf(text, size, "%s%s %g", what, below, param->max);
    else
        snprintf(text, size, "%sany", what);
}

static void describe_default(const ab_param *param, char *text, size_t size) {
    if (param->flags & AB_REQUIRED)
        snprintf(text, size, "required");
    else if (param->type == AB_TABLE)
        snprintf(text, size, "default: empty");
    else if (param->type == AB_FLAG)
        snprintf(text, size, "default %s", param->initial != 0.0 ? "true" : "false");
    else if (param->type == AB_CHOICE) {
        const char *start = param->choices;
        for (int place = (int)param->initial; place > 0; place--) start = strchr(start, '|') + 1;
        snprintf(text, size, "default %.*s", (int)strcspn(start, "|"), start);
    } else if (isinf(param->initial)) /* no scene can write it */
        snprintf(text, size, "optional");
    else
        snprintf(text, size, "default %g", param->initial);
}

static void print_settings(const ab_class *class_) {
    int name = 0, unit = 0, initial = 0;
    char text[512];
    for (uint32_t i = 0; i < class_->nparam; i++) {
        describe_default(&class_->param[i], text, sizeof text);
        name = longest(name, class_->param[i].name), initial = longest(initial, text);
        unit = longest(unit, class_->param[i].unit ? class_->param[i].unit : "");
    }
    for (uint32_t i = 0; i < class_->nparam; i++) {
        const ab_param *param = &class_->param[i];
        describe_default(param, text, sizeof text);
        printf("    %-*s  %-*s  %-*s  ", name, param->name, unit, param->unit ? param->unit : "", initial, text);
        describe_range(param, text, sizeof text);
        printf("%s\n    %-*s  %s\n", text, name, "", param->help);
    }
}

static void print_class(const ab_loaded_class *loaded) {
    const ab_class *class_ = &loaded->class_;
    printf("%s (%s): %s\n", class_->name, ab_kind_name(class_->kind), class_->help);
    printf("  %-11s%s\n", "file", loaded->path);
    printf("  %-11s%s %s, licence %s\n", "plugin", loaded->plugin_name, loaded->plugin_version, loaded->plugin_licence);
    if (*class_->reference) printf("  %-11s%s\n", "reference", class_->reference);
    print_words("spaces", WORDS(spaces), class_->spaces);
    print_words("needs", WORDS(needs), class_->needs);
    print_words("gives", WORDS(gives), class_->gives);
    printf("  %s\n", class_->nparam ? "settings" : "no settings");
    print_settings(class_);
    printf("  %s\n", class_->nstate ? "states" : "no states");
    for (uint32_t i = 0; i < class_->nstate; i++) {
        const ab_state *state = &class_->state[i];
        printf("    %s  %s  %s, starts at %g\n    %*s  %s\n", state->name, state->unit, shapes[state->shape], state->initial,
               (int)strlen(state->name), "", state->help);
    }
}

static void list(const ab_registry *registry) {
    const size_t count = ab_registry_count(registry);
    int name = 4, version = 7, help = 0;
    for (size_t i = 0; i < count; i++) {
        const ab_loaded_class *loaded = ab_registry_class(registry, i);
        name = longest(name, loaded->class_.name), version = longest(version, loaded->plugin_version),
        help = longest(help, loaded->class_.help);
    }
    for (size_t i = 0; i < count; i++) {
        const ab_loaded_class *loaded = ab_registry_class(registry, i);
        printf("%-8s  %-*s  %-*s  %-*s  %s\n", ab_kind_name(loaded->class_.kind), name, loaded->class_.name, version,
               loaded->plugin_version, help, loaded->class_.help, loaded->path);
    }
}

/* Prints every class of that name, of whatever kind. */
static ab_status show(const ab_registry *registry, const char *name, ab_report *report) {
    size_t shown = 0;
    for (size_t i = 0; i < ab_registry_count(registry); i++) {
        const ab_loaded_class *loaded = ab_registry_class(registry, i);
        if (strcmp(loaded->class_.name, name) == 0) print_class(loaded), shown++;
    }
    return shown ? AB_OK : ab_registry_not_found(registry, 0, name, AB_NOWHERE, report);
}

int ab_command_plugins(const ab_command_line *line) {
    ab_report *report = ab_report_create();
    ab_registry *registry = NULL;
    ab_status status = report ? AB_OK : AB_FAILED;
    if (status == AB_OK && line->word_count > 0 && strcmp(line->words[0], "show") != 0)
        status = ab_report_error(
            report, AB_NOWHERE,
            "unknown word '%s' behind `abut plugins`; write `abut plugins`, or behind it show NAME, new KIND NAME or check NAME",
            line->words[0]);
    else if (status == AB_OK && line->word_count > 0 && line->word_count != 2)
        status = ab_report_error(report, AB_NOWHERE, "`abut plugins show` takes one name; `abut plugins` lists them");
    if (status == AB_OK) status = ab_registry_create(line->plugin_path, &registry, report);
    if (status == AB_OK && line->force_plugins) ab_registry_force(registry);
    if (status == AB_OK) {
        status = ab_registry_load_all(registry, report); /* what is refused is said, and the rest is shown all the same */
        if (line->word_count == 0)
            list(registry);
        else {
            const ab_status found = show(registry, line->words[1], report);
            if (status == AB_OK) status = found;
        }
    }
    if (report) {
        fflush(stdout);
        ab_report_print(report, stderr);
    }
    ab_registry_destroy(registry);
    ab_report_destroy(report);
    return status;
}
