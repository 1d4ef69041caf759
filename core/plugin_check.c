/* plugin_check.c: reads a plugin's tables as a suspicious host does. Each check says which class and which entry it is about. */
#include "core/plugin_check.h"

#include <math.h>
#include <string.h>

#define END_OF(type, member) (offsetof(type, member) + sizeof(((type *)0)->member))

/* Sizes of interface version 1.0: nothing of major version 1 is smaller. */
enum {
    PLUGIN_SMALLEST = END_OF(ab_plugin, classes),
    CLASS_SMALLEST = END_OF(ab_class, ops),
    MATERIAL_SMALLEST = END_OF(ab_material_ops, update),
    BOUNDARY_SMALLEST = END_OF(ab_boundary_ops, apply),
    CONTACT_SMALLEST = END_OF(ab_contact_ops, respond)
};

static const uint32_t material_needs = AB_NEED_DEFORMATION_GRADIENT | AB_NEED_VELOCITY_GRADIENT | AB_NEED_DENSITY;
static const uint32_t contact_needs = AB_NEED_SHARED_NODES | AB_NEED_MASS_GRADIENT | AB_NEED_AREA_VECTOR | AB_NEED_NEAR_POINTS |
                                      AB_NEED_SURFACE | AB_NEED_DISTANCE | AB_NEED_GAP | AB_NEED_FIXED_PLACES | AB_NEED_DENSITY_GRADIENT |
                                      AB_NEED_NEAREST_FACE | AB_NEED_AREA;
static const uint32_t material_gives = AB_GIVE_STRESS | AB_GIVE_DISSIPATION | AB_GIVE_WAVE_SPEED;
static const uint32_t contact_gives = AB_GIVE_POINTS | AB_GIVE_IMPULSE;
static const uint32_t boundary_needs = AB_NEED_WHOLE_SIDE | AB_NEED_AXES;
static const uint32_t boundary_gives = AB_GIVE_TRACTION | AB_GIVE_DAMPING | AB_GIVE_STIFFNESS | AB_GIVE_MOTION;

bool ab_check_head(const ab_plugin_head *head, ab_refusal *refusal) {
    if (head->abi_major != AB_ABI_MAJOR || head->abi_minor > AB_ABI_MINOR)
        return ab_refuse(refusal, "is built for plugin interface %u.%u and this abut has %u.%u; %s", head->abi_major, head->abi_minor,
                         AB_ABI_MAJOR, AB_ABI_MINOR,
                         head->abi_major == AB_ABI_MAJOR ? "update abut or build the plugin with this abut's header"
                                                         : "build the plugin with this abut's header");
    if (head->size_of_double != sizeof(double) || head->size_of_size_t != sizeof(size_t))
        return ab_refuse(refusal, "has numbers of another size: double %u bytes, size_t %u; this abut has %zu and %zu",
                         head->size_of_double, head->size_of_size_t, sizeof(double), sizeof(size_t));
    if (head->struct_size < PLUGIN_SMALLEST || head->struct_size > sizeof(ab_plugin) || head->struct_size > head->symbol_size)
        return ab_refuse(refusal,
                         "has a wrong struct size: its descriptor says %u bytes (the symbol has %llu) and that of interface %u.%u has %zu",
                         head->struct_size, (unsigned long long)head->symbol_size, AB_ABI_MAJOR, AB_ABI_MINOR, sizeof(ab_plugin));
    if (head->class_count == 0 || head->class_count > AB_CLASSES_MAX)
        return ab_refuse(refusal, "says it offers %u classes; 1 to %d are possible", head->class_count, AB_CLASSES_MAX);
    return true;
}

/* A text that ends within reason and has no control characters. */
static bool is_text(const char *text) {
    if (!text) return false;
    for (size_t i = 0; i <= AB_TEXT_MAX; i++) {
        if (text[i] == '\0') return true;
        if ((unsigned char)text[i] < 0x20 || text[i] == 0x7f) return false;
    }
    return false;
}

/* A word that can stand in a scene: letters, digits, '_' and '-', not first '-'; at most 63 of them. */
static bool is_word(const char *text) {
    if (!text || !*text || *text == '-') return false;
    for (size_t i = 0; i < 64; i++) {
        const char c = text[i];
        if (c == '\0') return true;
        if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-')) return false;
    }
    return false;
}

bool ab_check_plugin(const ab_plugin *plugin, ab_refusal *refusal) {
    if (!is_word(plugin->name)) return ab_refuse(refusal, "has no name, or one that is not of letters, digits, '-' and '_'");
    if (!is_text(plugin->version) || !is_text(plugin->licence))
        return ab_refuse(refusal, "(plugin '%s') has no version or no licence", plugin->name);
    if (!plugin->classes) return ab_refuse(refusal, "(plugin '%s') has class_count %u and no classes", plugin->name, plugin->class_count);
    for (uint32_t i = 0; i < plugin->class_count; i++)
        if (!plugin->classes[i]) return ab_refuse(refusal, "(plugin '%s') has no class %u of %u", plugin->name, i, plugin->class_count);
    return true;
}

const char *ab_kind_name(uint32_t kind) {
    switch (kind) {
    case AB_MATERIAL: return "material";
    case AB_BOUNDARY: return "boundary";
    case AB_CONTACT: return "contact";
    default: return NULL;
    }
}

size_t ab_choice_count(const char *choices) {
    size_t count = 1, length = 0;
    if (!choices) return 0;
    for (const char *c = choices; *c; c++) {
        if (*c != '|') {
            length++;
        } else {
            if (length == 0) return 0;
            count++, length = 0;
        }
    }
    return length == 0 ? 0 : count;
}

bool ab_param_allows(const ab_param *param, double value) {
    if (isnan(value)) return false;
    if (param->min == 0.0 && param->max == 0.0) return true;
    const bool above = param->flags & AB_MIN_OPEN ? value > param->min : value >= param->min;
    const bool below = param->flags & AB_MAX_OPEN ? value < param->max : value <= param->max;
    return above && below;
}

static bool check_param(const ab_class *class_, uint32_t index, ab_refusal *refusal) {
    const ab_param *param = &class_->param[index];
    const uint32_t known = AB_REQUIRED | AB_MIN_OPEN | AB_MAX_OPEN | AB_OR_DIRECTION | AB_COLUMNS_2 | AB_INCREASING;
    if (!is_word(param->name))
        return ab_refuse(refusal, "(class '%s') has no name for setting %u, or one that is no word", class_->name, index);
#define SETTING "(class '%s', setting '%s') "
    for (uint32_t other = 0; other < index; other++)
        if (strcmp(class_->param[other].name, param->name) == 0)
            return ab_refuse(refusal, "(class '%s') declares the setting '%s' twice", class_->name, param->name);
    if (param->type < AB_REAL || param->type > AB_TABLE)
        return ab_refuse(refusal, SETTING "has type %u, which is none", class_->name, param->name, param->type);
    if (param->flags & ~known)
        return ab_refuse(refusal, SETTING "has unknown flags 0x%x", class_->name, param->name, param->flags & ~known);
    if ((param->flags & AB_OR_DIRECTION) && param->type != AB_CHOICE)
        return ab_refuse(refusal, SETTING "has AB_OR_DIRECTION and is not AB_CHOICE", class_->name, param->name);
    if ((param->flags & (AB_COLUMNS_2 | AB_INCREASING)) && param->type != AB_TABLE)
        return ab_refuse(refusal, SETTING "has %s and is not AB_TABLE", class_->name, param->name,
                         param->flags & AB_COLUMNS_2 ? "AB_COLUMNS_2" : "AB_INCREASING");
    if (!is_text(param->help) || !*param->help) return ab_refuse(refusal, SETTING "has no line of help", class_->name, param->name);
    if ((param->type == AB_REAL || param->type == AB_TABLE) ? !is_text(param->unit) || !*param->unit : param->unit && !is_text(param->unit))
        return ab_refuse(refusal, SETTING "has no unit; write \"1\" for a pure number", class_->name, param->name);
    if (param->type == AB_CHOICE ? !is_text(param->choices) || ab_choice_count(param->choices) == 0 : param->choices != NULL)
        return ab_refuse(refusal,
                         param->type == AB_CHOICE ? SETTING "is AB_CHOICE without choices (\"one|two\")"
                                                  : SETTING "has choices and is not AB_CHOICE",
                         class_->name, param->name);
    if (isnan(param->min) || isnan(param->max) || param->min > param->max)
        return ab_refuse(refusal, SETTING "has the range %g to %g, which holds nothing", class_->name, param->name, param->min, param->max);
    if ((param->flags & AB_REQUIRED) || param->type == AB_TABLE) return true; /* no default to look at */
    if (param->type == AB_CHOICE) {
        if (!(param->initial >= 0.0 && param->initial < (double)ab_choice_count(param->choices) && param->initial == floor(param->initial)))
            return ab_refuse(refusal, SETTING "has the default %g, which is no place among '%s'", class_->name, param->name, param->initial,
                             param->choices);
    } else if (param->type == AB_FLAG) {
        if (param->initial != 0.0 && param->initial != 1.0)
            return ab_refuse(refusal, SETTING "is a flag with the default %g", class_->name, param->name, param->initial);
    } else if (!ab_param_allows(param, param->initial) || (param->type == AB_INTEGER && param->initial != floor(param->initial))) {
        return ab_refuse(refusal, SETTING "has the default %g outside of its own range %g to %g", class_->name, param->name, param->initial,
                         param->min, param->max);
    }
    return true;
#undef SETTING
}

static bool check_state(const ab_class *class_, uint32_t index, ab_refusal *refusal) {
    const ab_state *state = &class_->state[index];
    if (!is_word(state->name))
        return ab_refuse(refusal, "(class '%s') has no name for state %u, or one that is no word", class_->name, index);
    for (uint32_t other = 0; other < index; other++)
        if (strcmp(class_->state[other].name, state->name) == 0)
            return ab_refuse(refusal, "(class '%s') declares the state '%s' twice", class_->name, state->name);
    if (!is_text(state->unit) || !*state->unit || !is_text(state->help))
        return ab_refuse(refusal, "(class '%s', state '%s') has no unit or no help", class_->name, state->name);
    if (state->shape < AB_SCALAR || state->shape > AB_FULL)
        return ab_refuse(refusal, "(class '%s', state '%s') has shape %u, which is none", class_->name, state->name, state->shape);
    if (state->travel < AB_COPY || state->travel > AB_SUM)
        return ab_refuse(refusal, "(class '%s', state '%s') has travel %u, which is none", class_->name, state->name, state->travel);
    if (!isfinite(state->initial))
        return ab_refuse(refusal, "(class '%s', state '%s') begins with %g", class_->name, state->name, state->initial);
    return true;
}

/* Copies min(size, own) bytes of a struct that begins with its size; the copy was zeroed. False when the size cannot be true. */
static bool copy_struct(void *to, size_t own, const void *from, size_t smallest, const char *what, const ab_class *class_,
                        ab_refusal *refusal) {
    uint32_t size;
    memcpy(&size, from, sizeof size);
    if (size < smallest || size > own)
        return ab_refuse(refusal, "(class '%s') has a wrong struct size: its %s says %u bytes and that of interface %u.%u has %zu",
                         class_->name ? class_->name : "?", what, size, AB_ABI_MAJOR, AB_ABI_MINOR, own);
    memcpy(to, from, size);
    return true;
}

static bool check_operations(ab_class_copy *copy, ab_refusal *refusal) {
    const ab_class *class_ = &copy->class_;
    const char *missing = NULL;
    uint32_t needs = 0, gives = 0;
    if (!class_->ops) return ab_refuse(refusal, "(class '%s') has no operations (ops is NULL)", class_->name);
    switch (class_->kind) {
    case AB_MATERIAL:
        if (!copy_struct(&copy->material, sizeof copy->material, class_->ops, MATERIAL_SMALLEST, "ab_material_ops", class_, refusal))
            return false;
        needs = material_needs, gives = material_gives;
        if (!copy->material.update)
            missing = "update";
        else if (!(class_->gives & AB_GIVE_STRESS))
            missing = "AB_GIVE_STRESS among what it gives";
        else if (!(class_->gives & AB_GIVE_WAVE_SPEED))
            missing = "AB_GIVE_WAVE_SPEED among what it gives (the time step needs it)";
        break;
    case AB_BOUNDARY:
        if (!copy_struct(&copy->boundary, sizeof copy->boundary, class_->ops, BOUNDARY_SMALLEST, "ab_boundary_ops", class_, refusal))
            return false;
        needs = boundary_needs, gives = boundary_gives;
        if (!copy->boundary.apply)
            missing = "apply";
        else if (!(class_->gives & (AB_GIVE_TRACTION | AB_GIVE_MOTION)))
            missing = "AB_GIVE_TRACTION or AB_GIVE_MOTION among what it gives";
        else if ((class_->gives & (AB_GIVE_DAMPING | AB_GIVE_STIFFNESS)) && !(class_->gives & AB_GIVE_TRACTION))
            missing = "AB_GIVE_TRACTION, which damping and stiffness are of, among what it gives";
        break;
    default:
        if (!copy_struct(&copy->contact, sizeof copy->contact, class_->ops, CONTACT_SMALLEST, "ab_contact_ops", class_, refusal))
            return false;
        needs = contact_needs, gives = contact_gives;
        if (!copy->contact.find && !copy->contact.respond)
            missing = "find or respond";
        else if (!copy->contact.find != !(class_->gives & AB_GIVE_POINTS))
            missing = copy->contact.find ? "AB_GIVE_POINTS among what it gives" : "find";
        else if (!copy->contact.respond != !(class_->gives & AB_GIVE_IMPULSE))
            missing = copy->contact.respond ? "AB_GIVE_IMPULSE among what it gives" : "respond";
        break;
    }
    if (missing) return ab_refuse(refusal, "(class '%s') lacks %s", class_->name, missing);
    if ((class_->needs & ~needs) || (class_->gives & ~gives))
        return ab_refuse(refusal, "(class '%s') needs 0x%x and gives 0x%x, and a %s class cannot need 0x%x or give 0x%x", class_->name,
                         class_->needs, class_->gives, ab_kind_name(class_->kind), class_->needs & ~needs, class_->gives & ~gives);
    return true;
}

bool ab_check_class(const ab_class *given, ab_class_copy *copy, ab_refusal *refusal) {
    memset(copy, 0, sizeof *copy);
    ab_class *class_ = &copy->class_;
    if (!copy_struct(class_, sizeof *class_, given, CLASS_SMALLEST, "ab_class", class_, refusal)) return false;
    if (!is_word(class_->name)) return ab_refuse(refusal, "has a class without a name, or with one that is no word");
    if (!is_text(class_->help) || !*class_->help || !is_text(class_->reference))
        return ab_refuse(refusal, "(class '%s') has no help or no reference", class_->name);
    if (!ab_kind_name(class_->kind)) return ab_refuse(refusal, "(class '%s') is of kind %u, which is none", class_->name, class_->kind);
    const uint32_t spaces = AB_PLANE_STRAIN | AB_AXISYMMETRIC | AB_SPACE_3D;
    if (class_->spaces == 0 || (class_->spaces & ~spaces))
        return ab_refuse(refusal, "(class '%s') is for spaces 0x%x, which are none", class_->name, class_->spaces);
    if (!class_->create != !class_->destroy || (!class_->create && class_->nparam > 0))
        return ab_refuse(refusal, "(class '%s') lacks create or destroy", class_->name);
    if (!class_->save != !class_->load)
        return ab_refuse(refusal, "(class '%s') has one of save and load; it needs both or neither", class_->name);
    if (class_->nparam > AB_PARAMS_MAX)
        return ab_refuse(refusal, "(class '%s') declares %u settings; %d are possible", class_->name, class_->nparam, AB_PARAMS_MAX);
    if (class_->nstate > AB_STATES_MAX)
        return ab_refuse(refusal, "(class '%s') declares %u states; %d are possible", class_->name, class_->nstate, AB_STATES_MAX);
    if (class_->nparam && !class_->param)
        return ab_refuse(refusal, "(class '%s') has nparam %u and no settings (param is NULL)", class_->name, class_->nparam);
    if (class_->nstate && !class_->state)
        return ab_refuse(refusal, "(class '%s') has nstate %u and no states (state is NULL)", class_->name, class_->nstate);
    for (uint32_t i = 0; i < class_->nparam; i++)
        if (!check_param(class_, i, refusal)) return false;
    for (uint32_t i = 0; i < class_->nstate; i++)
        if (!check_state(class_, i, refusal)) return false;
    return check_operations(copy, refusal);
}
