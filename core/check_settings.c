/* check_settings.c: settings to try a class with: the plainest that it takes, others inside of their ranges, at their ends and beyond. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/check.h"

enum { SEARCH = 2000, INSIDE = 60, KEPT_INSIDE = 8 };

const char *ab_check_words(const ab_check *check, const ab_value *settings, char *text, size_t size) {
    const ab_class *class_ = &check->loaded->class_;
    size_t used = 0;
    text[0] = '\0';
    for (uint32_t k = 0; k < class_->nparam && used < size; k++) {
        const ab_param *p = &class_->param[k];
        if (!settings[k].given && !(p->flags & AB_REQUIRED)) continue;
        int wrote;
        if (p->type == AB_CHOICE) {
            const char *word = p->choices;
            for (int64_t skip = settings[k].integer; skip > 0 && strchr(word, '|'); skip--) word = strchr(word, '|') + 1;
            wrote = snprintf(text + used, size - used, "%s%s = %.*s", used ? ", " : "", p->name, (int)strcspn(word, "|"), word);
        } else if (p->type == AB_TABLE)
            wrote = snprintf(text + used, size - used, "%s%s = a table of %zu rows", used ? ", " : "", p->name, settings[k].rows);
        else
            wrote = snprintf(text + used, size - used, "%s%s = %.9g", used ? ", " : "", p->name,
                             p->type == AB_REAL ? settings[k].real : (double)settings[k].integer);
        if (wrote > 0) used += (size_t)wrote;
    }
    if (text[0] == '\0') snprintf(text, size, "default settings");
    return text;
}

/* A number of the size that such a setting has. */
static double typical(const ab_param *p) {
    const bool any = p->min == 0.0 && p->max == 0.0, low = !any && isfinite(p->min), high = !any && isfinite(p->max);
    if (low && high && p->max - p->min < 100.0) return p->min + 0.6 * (p->max - p->min);
    const char *unit = p->unit ? p->unit : "1";
    const bool modulus = strlen(p->name) == 1;
    double size = 1.0;
    if (strcmp(unit, "Pa") == 0)
        size = modulus ? 1e7 : 1e5;
    else if (strcmp(unit, "Pa s") == 0)
        size = 1e3;
    else if (strcmp(unit, "s") == 0)
        size = 0.01;
    else if (strcmp(unit, "kg m-3") == 0)
        size = 1000.0;
    else if (strcmp(unit, "m") == 0)
        size = 0.1;
    else if (strncmp(unit, "deg", 3) == 0)
        size = 20.0;
    if (low) return p->min + size;
    return high ? p->max - size : size;
}

static void put(ab_value *value, const ab_param *p, double number) {
    value->given = 1;
    value->real = p->type == AB_REAL ? number : floor(number);
    value->integer = isfinite(value->real) && fabs(value->real) < 1e15 ? (int64_t)value->real : 0;
}

/* Rows 1 1, 2 2 ...: pairs where the setting is of pairs, or has a first column that grows. */
static void put_table(ab_check *check, ab_value *value, const ab_param *p) {
    const size_t columns = p->flags & (AB_COLUMNS_2 | AB_INCREASING) ? 2 : 1;
    *value = (ab_value){.table = check->shared->table, .columns = columns, .rows = AB_CHECK_TABLE, .given = 1};
}

static void put_default(ab_check *check, ab_value *value, const ab_param *p) {
    memset(value, 0, sizeof *value);
    if (p->type == AB_TABLE) {
        if (!(p->flags & AB_REQUIRED)) return;
        put_table(check, value, p);
        return;
    }
    put(value, p, p->flags & AB_REQUIRED ? (p->type == AB_CHOICE || p->type == AB_FLAG ? 0.0 : typical(p)) : p->initial);
    value->given = (p->flags & AB_REQUIRED) != 0;
}

/* A random one inside of its range. */
static void put_inside(ab_check *check, ab_value *value, const ab_param *p) {
    if (p->type == AB_TABLE) {
        put_table(check, value, p);
        return;
    }
    if (p->type == AB_CHOICE || p->type == AB_FLAG) {
        put(value, p, floor(ab_check_uniform(check, 0.0, p->type == AB_FLAG ? 2.0 : (double)ab_choice_count(p->choices))));
        return;
    }
    const bool any = p->min == 0.0 && p->max == 0.0, low = !any && isfinite(p->min), high = !any && isfinite(p->max);
    double number;
    if (low && high && p->max - p->min < 100.0)
        number = p->min + ab_check_uniform(check, 0.01, 0.99) * (p->max - p->min);
    else {
        const double base = (p->flags & AB_REQUIRED) || p->initial == 0.0 || !isfinite(p->initial) ? typical(p) : p->initial;
        number = (low ? p->min : 0.0) + (base - (low ? p->min : 0.0)) * pow(10.0, ab_check_uniform(check, -1.5, 1.0));
    }
    if (p->type == AB_INTEGER) number = floor(number + 0.5);
    if (ab_param_allows(p, number)) put(value, p, number);
}

/* --set KEY=VALUE, in SI. */
static void put_given(ab_check *check, ab_value *settings) {
    const ab_class *class_ = &check->loaded->class_;
    for (size_t o = 0; o < check->line->override_count; o++) {
        const ab_override *given = &check->line->overrides[o];
        bool known = false;
        for (uint32_t k = 0; k < class_->nparam; k++) {
            const ab_param *p = &class_->param[k];
            if (strcmp(p->name, given->path) != 0) continue;
            known = true;
            char *end = NULL;
            double number = strtod(given->value, &end);
            if (p->type == AB_CHOICE) {
                const size_t count = ab_choice_count(p->choices), length = strlen(given->value);
                const char *word = p->choices;
                number = NAN;
                for (size_t w = 0; w < count; w++, word += strcspn(word, "|") + 1)
                    if (strcspn(word, "|") == length && strncmp(word, given->value, length) == 0) number = (double)w;
            } else if (end == given->value || *end)
                number = NAN;
            if (isnan(number) || (p->type != AB_CHOICE && !ab_param_allows(p, number)))
                ab_check_fail(check, "--set %s=%s: not a value of that setting (numbers in SI, without a unit)", given->path, given->value);
            put(&settings[k], p, number);
        }
        if (!known) ab_check_fail(check, "--set %s: class '%s' has no setting of that name", given->path, class_->name);
    }
}

/* Asks create; keeps the settings where it takes them and there is room. A refusal needs a reason. */
static bool ask(ab_check *check, const ab_value *settings, bool keep, const char *where) {
    char words[400];
    ab_check_words(check, settings, words, sizeof words);
    ab_check_trying(check, "create with %s%s", words, where);
    ab_check_instance instance;
    const bool taken = ab_check_open(check, &instance, settings, NULL);
    if (taken)
        ab_check_close(&instance);
    else if (!instance.service.message[0])
        ab_check_fail(check, "create refuses %s%s and gives no reason; say it by host->message", words, where);
    if (taken && keep && check->shared->variants < AB_CHECK_VARIANTS)
        memcpy(check->shared->settings[check->shared->variants++], settings, check->loaded->class_.nparam * sizeof *settings);
    return taken;
}

static void at_the_ends(ab_check *check, const ab_value *base) {
    const ab_class *class_ = &check->loaded->class_;
    static ab_value settings[AB_PARAMS_MAX];
    for (uint32_t k = 0; k < class_->nparam; k++) {
        const ab_param *p = &class_->param[k];
        if (p->type == AB_TABLE) continue;
        memcpy(settings, base, class_->nparam * sizeof *settings);
        if (p->type == AB_CHOICE || p->type == AB_FLAG) {
            const size_t count = p->type == AB_FLAG ? 2 : ab_choice_count(p->choices);
            for (size_t w = 0; w < count; w++) put(&settings[k], p, (double)w), ask(check, settings, true, "");
            continue;
        }
        const bool any = p->min == 0.0 && p->max == 0.0;
        const double ends[2] = {any ? -INFINITY : p->min, any ? INFINITY : p->max};
        for (int e = 0; e < 2; e++) {
            if (!isfinite(ends[e])) continue;
            put(&settings[k], p, ends[e]);
            const bool inside = ab_param_allows(p, ends[e]);
            ask(check, settings, inside, inside ? ", the end of its range" : ", just outside of its range");
        }
    }
}

/* The host refuses these before a plugin sees them; but a plugin that is asked has to come back. */
static void outside(ab_check *check, const ab_value *base) {
    const ab_class *class_ = &check->loaded->class_;
    static ab_value settings[AB_PARAMS_MAX];
    for (uint32_t k = 0; k < class_->nparam; k++) {
        const ab_param *p = &class_->param[k];
        if (p->type != AB_REAL) continue;
        const double numbers[] = {0.0, -1.0, 1e300, -1e300, INFINITY, NAN};
        memcpy(settings, base, class_->nparam * sizeof *settings);
        for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++) {
            if (ab_param_allows(p, numbers[n])) continue;
            put(&settings[k], p, numbers[n]);
            char words[400];
            ab_check_trying(check, "create with %s, outside of its range", ab_check_words(check, settings, words, sizeof words));
            ab_check_instance instance;
            if (ab_check_open(check, &instance, settings, NULL)) ab_check_close(&instance);
        }
    }
}

void ab_check_settings(ab_check *check) {
    const ab_class *class_ = &check->loaded->class_;
    static ab_value plain[AB_PARAMS_MAX], settings[AB_PARAMS_MAX];
    for (int k = 0; k < 2 * AB_CHECK_TABLE; k++) check->shared->table[k] = k / 2 + 1.0;
    for (uint32_t k = 0; k < class_->nparam; k++) put_default(check, &plain[k], &class_->param[k]);
    put_given(check, plain);
    bool found = ask(check, plain, true, "");
    for (int n = 0; n < SEARCH && !found; n++) { /* settings that go together: others may not */
        for (uint32_t k = 0; k < class_->nparam; k++) {
            put_default(check, &plain[k], &class_->param[k]);
            if ((class_->param[k].flags & AB_REQUIRED) ||
                (n % 2 && ab_check_uniform(check, 0.0, 1.0) < 0.5)) /* of two, one may have to be given */
                put_inside(check, &plain[k], &class_->param[k]);
        }
        put_given(check, plain);
        found = ask(check, plain, true, "");
    }
    if (!found) ab_check_fail(check, "create refuses all that was tried; give settings that go together by --set KEY=VALUE");
    for (int n = 0; n < INSIDE; n++) {
        memcpy(settings, plain, sizeof settings);
        for (uint32_t k = 0; k < class_->nparam; k++)
            if ((class_->param[k].flags & AB_REQUIRED) || ab_check_uniform(check, 0.0, 1.0) < 0.5)
                put_inside(check, &settings[k], &class_->param[k]);
        put_given(check, settings);
        ask(check, settings, check->shared->variants < KEPT_INSIDE, "");
    }
    at_the_ends(check, plain);
    outside(check, plain);
}
