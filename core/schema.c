/* schema.c: checks a mapping and single values against a table of keys. */
#include "core/schema.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/suggest.h"

const char *ab_where_join(char *buffer, const char *where, const char *key) {
    if (where[0] == '\0')
        snprintf(buffer, AB_WHERE, "%s", key);
    else
        snprintf(buffer, AB_WHERE, "%.120s.%.64s", where, key);
    return buffer;
}

void *ab_reader_take(ab_reader *reader, size_t count, size_t size) {
    void *piece = ab_arena_array(reader->arena, count, size);
    if (piece == NULL) reader->out_of_memory = true;
    return piece;
}

char *ab_reader_text(ab_reader *reader, const char *text) {
    char *copy = ab_arena_text(reader->arena, text, strlen(text));
    if (copy == NULL) reader->out_of_memory = true;
    return copy;
}

static const ab_key *key_named(const ab_section *section, const char *name) {
    for (size_t k = 0; k < section->count; k++)
        if (strcmp(section->keys[k].name, name) == 0) return &section->keys[k];
    return NULL;
}

void ab_section_unknown(ab_reader *reader, const ab_section *section, const char *const *more, size_t more_count, bool swapped,
                        const ab_node *node, const char *where) {
    enum { MOST = 200 };
    const char *names[MOST];
    size_t count = 0;
    for (size_t m = 0; m < more_count && count < MOST; m++) names[count++] = more[m];
    for (size_t k = 0; k < section->count && count < MOST; k++)
        if (section->keys[k].type != AB_KEY_LATER) names[count++] = section->keys[k].name;
    for (size_t i = 0; i < node->count; i++) {
        const ab_entry *entry = &node->entries[i];
        bool known = key_named(section, entry->key) != NULL;
        for (size_t m = 0; m < more_count && !known; m++) known = strcmp(more[m], entry->key) == 0;
        if (known) continue;
        if (swapped && !entry->value->override_) { /* the file speaks to the plugin that --set has put another in place of */
            ab_report_warning(reader->report, entry->mark, "%s: '%.64s' is no setting of the plugins chosen by --set; it is left out",
                              where, entry->key);
            continue;
        }
        char tail[AB_TAIL];
        ab_report_error(reader->report, entry->mark, "unknown key '%.64s' in %s%s", entry->key, where[0] == '\0' ? "the scene" : where,
                        ab_suggest_tail(entry->key, names, count, tail, sizeof tail));
    }
}

bool ab_section_open(ab_reader *reader, const ab_section *section, const ab_node *node, const char *where, const ab_node **values) {
    for (size_t k = 0; k < section->count; k++) values[k] = NULL;
    const char *shown = where[0] == '\0' ? "the scene" : where;
    if (node->kind != AB_NODE_MAP) {
        ab_report_error(reader->report, node->mark, "%s must be a mapping {key: value, ...}, not %s", shown, ab_node_kind_name(node));
        return false;
    }
    if (section->more == NULL) ab_section_unknown(reader, section, NULL, 0, false, node, where);
    for (size_t k = 0; k < section->count; k++) {
        const ab_key *key = &section->keys[k];
        const ab_node *value = ab_node_find(node, key->name);
        char path[AB_WHERE];
        if (value == NULL) {
            if (key->flags & AB_KEY_REQUIRED)
                ab_report_error(reader->report, node->mark, "key '%s' is missing in %s: %s", key->name, shown, key->help);
        } else if (key->type == AB_KEY_LATER) {
            ab_report_error(reader->report, value->mark, "%s is not in this version yet: %s", ab_where_join(path, where, key->name),
                            key->help);
        } else if (ab_node_is_null(value)) {
            if (key->flags & AB_KEY_NULL) continue;
            ab_report_error(reader->report, value->mark, "%s has no value: %s", ab_where_join(path, where, key->name), key->help);
        } else {
            values[k] = value;
        }
    }
    return true;
}

static bool complain(ab_reader *reader, const ab_key *key, ab_mark mark, const char *where, const char *why) {
    char path[AB_WHERE];
    ab_report_error(reader->report, mark, "%s: %s", ab_where_join(path, where, key->name), why);
    return false;
}

/* The text of a scalar, or NULL with the mistake reported. */
static const char *scalar(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, const char *wanted) {
    if (node->kind == AB_NODE_SCALAR && !ab_node_is_null(node)) return node->text;
    char path[AB_WHERE];
    ab_report_error(reader->report, node->mark, "%s must be %s, not %s", ab_where_join(path, where, key->name), wanted,
                    ab_node_kind_name(node));
    return NULL;
}

static bool in_range(ab_reader *reader, const ab_key *key, ab_mark mark, const char *where, double value) {
    if (!(key->flags & AB_KEY_RANGE)) return true;
    const bool low = key->flags & AB_KEY_MIN_OPEN ? value > key->min : value >= key->min;
    const bool high = key->flags & AB_KEY_MAX_OPEN ? value < key->max : value <= key->max;
    if (low && high) return true;
    char path[AB_WHERE], lower[64] = "", upper[64] = "";
    if (isfinite(key->min)) snprintf(lower, sizeof lower, "%s %g", key->flags & AB_KEY_MIN_OPEN ? "greater than" : "at least", key->min);
    if (isfinite(key->max)) snprintf(upper, sizeof upper, "%s %g", key->flags & AB_KEY_MAX_OPEN ? "less than" : "at most", key->max);
    ab_report_error(reader->report, mark, "%s is %.10g but must be %s%s%s%s%s", ab_where_join(path, where, key->name), value, lower,
                    lower[0] != '\0' && upper[0] != '\0' ? " and " : "", upper, key->unit != NULL && strcmp(key->unit, "1") != 0 ? " " : "",
                    key->unit != NULL && strcmp(key->unit, "1") != 0 ? key->unit : "");
    return false;
}

static bool quantity(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, unsigned variables, ab_number *value) {
    const char *wanted = variables == AB_NO_VARIABLE ? "a number" : "a number or a formula",
               *text = scalar(reader, key, node, where, wanted);
    if (text == NULL) return false;
    char why[1200];
    ab_number read = {0, NULL, node->mark};
    if (strcmp(text, "true") == 0 || strcmp(text, "false") == 0)
        return complain(reader, key, node->mark, where, "a number is needed, not a flag");
    const ab_status status = ab_quantity_read(reader->formulas, reader->units, text, key->unit, variables, &read, why, sizeof why);
    if (status == AB_FAILED) reader->out_of_memory = true;
    if (status != AB_OK) return complain(reader, key, node->mark, where, why);
    read.mark = node->mark;
    *value = read;
    return true;
}

bool ab_read_formula(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, ab_number *value) {
    if (node == NULL) {
        if (key->initial == NULL) return false;
        *value = (ab_number){strtod(key->initial, NULL), NULL, AB_NOWHERE};
        return true;
    }
    ab_number read;
    if (!quantity(reader, key, node, where, key->variables, &read)) return false;
    if (read.expression == NULL && !in_range(reader, key, node->mark, where, read.value)) return false;
    *value = read;
    return true;
}

bool ab_read_number(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, double *value) {
    ab_number read;
    if (node == NULL) {
        if (key->initial == NULL) return false;
        *value = strtod(key->initial, NULL);
        return true;
    }
    if (!quantity(reader, key, node, where, AB_NO_VARIABLE, &read) || !in_range(reader, key, node->mark, where, read.value)) return false;
    *value = read.value;
    return true;
}

bool ab_read_integer(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, long *value) {
    double real = 0;
    if (!ab_read_number(reader, key, node, where, &real)) return false;
    if (real != floor(real) || fabs(real) > 1e15) {
        char why[80];
        snprintf(why, sizeof why, "%.10g is not a whole number", real);
        return complain(reader, key, node == NULL ? AB_NOWHERE : node->mark, where, why);
    }
    *value = (long)real;
    return true;
}

bool ab_read_flag(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, bool *value) {
    const char *text = node == NULL ? key->initial : scalar(reader, key, node, where, "true or false");
    if (text == NULL) return false;
    if (strcmp(text, "true") != 0 && strcmp(text, "false") != 0) {
        char why[160];
        snprintf(why, sizeof why, "'%.64s' is not true or false", text);
        return complain(reader, key, node == NULL ? AB_NOWHERE : node->mark, where, why);
    }
    *value = strcmp(text, "true") == 0;
    return true;
}

bool ab_read_text(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, char **value) {
    const char *text = node == NULL ? key->initial : scalar(reader, key, node, where, "a text");
    if (text == NULL) return false;
    for (const unsigned char *c = (const unsigned char *)text; *c != '\0'; c++) {
        if (*c == '\n' || *c == '\r') return complain(reader, key, node->mark, where, "a line break; write the text in one line");
        if (*c >= 32 && *c != 127 && !(c[0] == 0xC2 && c[1] >= 0x80 && c[1] < 0xA0)) continue; /* U+0080 to U+009F steer terminals, too */
        char why[80];
        snprintf(why, sizeof why, "control character 0x%02X; remove it", *c == 0xC2 ? c[1] : *c);
        return complain(reader, key, node->mark, where, why);
    }
    char *copy = ab_reader_text(reader, text);
    if (copy == NULL) return false;
    *value = copy;
    return true;
}

bool ab_read_word(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, char **value) {
    const char *text = node == NULL ? key->initial : scalar(reader, key, node, where, "one word");
    if (text == NULL) return false;
    enum { MOST = 32 };
    char copy[400], tail[AB_TAIL], why[AB_TAIL + 200];
    const char *names[MOST];
    size_t count = 0;
    snprintf(copy, sizeof copy, "%s", key->words);
    char available[300] = "";
    bool later = false;
    char *rest = NULL;
    for (char *word = strtok_r(copy, "|", &rest); word != NULL && count < MOST; word = strtok_r(NULL, "|", &rest)) {
        if (*word == '!') {
            later = later || strcmp(word + 1, text) == 0;
            continue;
        }
        if (strcmp(word, text) == 0) {
            char *kept = ab_reader_text(reader, text);
            if (kept != NULL) *value = kept;
            return kept != NULL;
        }
        names[count++] = word;
        snprintf(available + strlen(available), sizeof available - strlen(available), "%s%s", available[0] == '\0' ? "" : ", ", word);
    }
    if (later)
        snprintf(why, sizeof why, "'%s' is not in this version yet; there is: %s", text, available);
    else
        snprintf(why, sizeof why, "unknown word '%.64s'%s", text, ab_suggest_tail(text, names, count, tail, sizeof tail));
    return complain(reader, key, node == NULL ? AB_NOWHERE : node->mark, where, why);
}

static bool is_pair(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where) {
    char path[AB_WHERE];
    if (node->kind == AB_NODE_LIST && node->count == 2) return true;
    if (node->kind == AB_NODE_LIST)
        ab_report_error(reader->report, node->mark, "%s needs two numbers [x, y], not %zu", ab_where_join(path, where, key->name),
                        node->count);
    else
        ab_report_error(reader->report, node->mark, "%s must be two numbers [x, y], not %s", ab_where_join(path, where, key->name),
                        ab_node_kind_name(node));
    return false;
}

bool ab_read_vector(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, ab_number value[2]) {
    if (node == NULL) {
        if (key->initial == NULL) return false;
        char *end = NULL;
        value[0] = (ab_number){strtod(key->initial + 1, &end), NULL, AB_NOWHERE};
        value[1] = (ab_number){strtod(end + strspn(end, ", "), NULL), NULL, AB_NOWHERE};
        return true;
    }
    if (!is_pair(reader, key, node, where)) return false;
    ab_number read[2];
    const bool first = quantity(reader, key, node->items[0], where, key->variables, &read[0]);
    const bool second = quantity(reader, key, node->items[1], where, key->variables, &read[1]);
    if (!first || !second) return false;
    value[0] = read[0];
    value[1] = read[1];
    return true;
}

bool ab_read_point(ab_reader *reader, const ab_key *key, const ab_node *node, const char *where, double value[2]) {
    ab_number read[2];
    ab_key fixed = *key;
    fixed.variables = AB_NO_VARIABLE;
    if (!ab_read_vector(reader, &fixed, node, where, read)) return false;
    value[0] = read[0].value;
    value[1] = read[1].value;
    return true;
}

bool ab_name_ok(ab_reader *reader, const char *what, const char *name, ab_mark mark) {
    const size_t length = strlen(name);
    bool good = length > 0 && length <= 64 && (isalpha((unsigned char)name[0]) || name[0] == '_');
    for (size_t i = 0; i < length && good; i++) good = isalnum((unsigned char)name[i]) || name[i] == '_' || name[i] == '-';
    if (!good)
        ab_report_error(reader->report, mark,
                        "'%.80s' cannot be the name of a %s: letters, digits, '_' and '-', not a digit first, at most 64", name, what);
    return good;
}
