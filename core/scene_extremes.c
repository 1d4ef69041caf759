/* scene_extremes.c: what `abut extremes` is to drive: quantities with their ends, the map, what counts as not stable. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/extremes.h"
#include "core/scene_reader.h"
#include "core/suggest.h"

static void take_values(ab_scene_reader *r, const ab_node *node, const char *where, ab_extreme *e) {
    char path[AB_WHERE];
    if (!ab_scene_is_list(r, node, ab_where_join(path, where, "values"), "values, from easy to hard")) return;
    if (node->count == 0 || node->count > AB_EXTREMES_VALUES) {
        ab_report_error(r->base.report, node->mark, "%s has %zu values; give 1 to %d", path, node->count, AB_EXTREMES_VALUES);
        return;
    }
    e->values = ab_reader_take(&r->base, node->count, sizeof *e->values);
    for (size_t i = 0; e->values != NULL && i < node->count; i++) {
        e->values[i] = ab_node_flow(r->base.arena, node->items[i]);
        if (e->values[i] == NULL) {
            r->base.out_of_memory = true;
            return;
        }
        for (size_t k = 0; k < i; k++)
            if (strcmp(e->values[k], e->values[i]) == 0)
                ab_report_error(r->base.report, node->items[i]->mark, "%s: %s stands there twice; leave one out", path, e->values[i]);
    }
    e->value_count = node->count;
}

static void take_with(ab_scene_reader *r, const ab_node *node, const char *where, ab_extreme *e) {
    char path[AB_WHERE];
    ab_where_join(path, where, "with");
    if (node->kind != AB_NODE_MAP || node->count == 0 || node->count > AB_EXTREMES_PATHS) {
        ab_report_error(r->base.report, node->mark, "%s must be a mapping of 1 to %d paths to values, such as {bodies.bar.basis: linear}",
                        path, AB_EXTREMES_PATHS);
        return;
    }
    e->with = ab_reader_take(&r->base, node->count, sizeof *e->with);
    for (size_t i = 0; e->with != NULL && i < node->count; i++) {
        const char *value = ab_node_flow(r->base.arena, node->entries[i].value), *key = ab_reader_text(&r->base, node->entries[i].key);
        if (value == NULL || key == NULL) {
            r->base.out_of_memory = true;
            return;
        }
        e->with[e->with_count++] = (ab_override){key, value};
    }
}

/* How rungs lie between the ends: one a decade with log, else 9, unless the scene says. */
static void take_scale(ab_scene_reader *r, const ab_node *const *v, const char *where, ab_extreme *e) {
    const ab_key *key = ab_section_extreme.keys;
    const double ratio = e->from != 0 ? e->to / e->from : 0;
    e->logarithmic = ratio >= 100 || (ratio > 0 && ratio <= 0.01);
    char *scale = NULL;
    if (v[EXTREME_SCALE] != NULL && ab_read_word(&r->base, &key[EXTREME_SCALE], v[EXTREME_SCALE], where, &scale))
        e->logarithmic = strcmp(scale, "log") == 0;
    if (e->logarithmic && !(ratio > 0))
        ab_report_error(r->base.report, v[EXTREME_SCALE] != NULL ? v[EXTREME_SCALE]->mark : e->mark,
                        "%s: with scale log both ends need one sign, and neither may be 0: %g to %g", where, e->from, e->to);
    long rungs = e->logarithmic && ratio > 0 ? lround(fabs(log10(ratio))) + 1 : 9;
    if (rungs < 5) rungs = 5;
    if (rungs > AB_EXTREMES_VALUES) rungs = AB_EXTREMES_VALUES;
    ab_read_integer(&r->base, &key[EXTREME_RUNGS], v[EXTREME_RUNGS], where, &rungs);
    e->rungs = (size_t)rungs;
}

/* Ends or values, not both, and nothing that only goes with the other. */
static bool take_range(ab_scene_reader *r, const ab_node *const *v, const char *where, ab_extreme *e) {
    const ab_key *key = ab_section_extreme.keys;
    static const int ends_only[] = {EXTREME_FROM, EXTREME_TO, EXTREME_SCALE, EXTREME_RUNGS, EXTREME_UNTIL, EXTREME_WHOLE};
    if (v[EXTREME_VALUES] != NULL) {
        for (size_t i = 0; i < sizeof ends_only / sizeof *ends_only; i++)
            if (v[ends_only[i]] != NULL)
                ab_report_error(r->base.report, v[ends_only[i]]->mark,
                                "%s.%s goes with from and to, not with values; leave one of them out", where, key[ends_only[i]].name);
        take_values(r, v[EXTREME_VALUES], where, e);
        return e->value_count > 0;
    }
    if (v[EXTREME_FROM] == NULL || v[EXTREME_TO] == NULL) {
        ab_report_error(r->base.report, e->mark, "%s needs `from` and `to`, or `values`", where);
        return false;
    }
    if (v[EXTREME_SAME] != NULL)
        ab_report_error(r->base.report, v[EXTREME_SAME]->mark, "%s.same goes with `values`, the first of which is the measure", where);
    if (!ab_read_number(&r->base, &key[EXTREME_FROM], v[EXTREME_FROM], where, &e->from)) return false;
    if (!ab_read_number(&r->base, &key[EXTREME_TO], v[EXTREME_TO], where, &e->to)) return false;
    ab_read_flag(&r->base, &key[EXTREME_WHOLE], v[EXTREME_WHOLE], where, &e->whole);
    if (e->from == e->to)
        ab_report_error(r->base.report, v[EXTREME_TO]->mark, "%s: from and to are both %g; there is nothing between them", where, e->to);
    if (e->whole && (e->from != floor(e->from) || e->to != floor(e->to)))
        ab_report_error(r->base.report, v[EXTREME_WHOLE]->mark, "%s: with `whole` both ends are whole numbers, not %g and %g", where,
                        e->from, e->to);
    take_scale(r, v, where, e);
    return true;
}

/* Up to a value that is never tried nothing could be held. */
static void check_right_to(ab_scene_reader *r, const ab_node *node, const char *where, const ab_extreme *e) {
    if (node == NULL || !isfinite(e->right_to)) return;
    bool reached = e->values == NULL && e->right_to >= fmin(e->from, e->to) && e->right_to <= fmax(e->from, e->to);
    for (size_t k = 0; e->values != NULL && k < e->value_count; k++) {
        char *end;
        const double value = strtod(e->values[k], &end);
        reached = reached || (end != e->values[k] && *end == '\0' && value == e->right_to);
    }
    if (reached) return;
    if (e->values != NULL)
        ab_report_error(r->base.report, node->mark, "%s.right_to: %.10g is none of the values", where, e->right_to);
    else
        ab_report_error(r->base.report, node->mark, "%s.right_to: %.10g is not between from, %.10g, and to, %.10g: it would not be tried",
                        where, e->right_to, e->from, e->to);
}

static void take_extreme(ab_scene_reader *r, const ab_node *node, const char *where, ab_extreme *e) {
    const ab_key *key = ab_section_extreme.keys;
    const ab_node *v[EXTREME_KEYS];
    *e = (ab_extreme){.name = "", .mark = node->mark, .right_to = NAN};
    if (!ab_section_open(&r->base, &ab_section_extreme, node, where, v) || v[EXTREME_SET] == NULL) return;
    if (!ab_scene_take_paths(r, v[EXTREME_SET], where, &e->paths, &e->path_count)) return;
    char *name = NULL, *value = NULL, *open = NULL;
    ab_read_text(&r->base, &key[EXTREME_NAME], v[EXTREME_NAME], where, &name);
    e->name = name != NULL ? name : e->paths[0];
    if (v[EXTREME_OPEN] != NULL && ab_read_text(&r->base, &key[EXTREME_OPEN], v[EXTREME_OPEN], where, &open)) e->open = open;
    if (v[EXTREME_WITH] != NULL) take_with(r, v[EXTREME_WITH], where, e);
    if (!take_range(r, v, where, e)) return;
    ab_read_number(&r->base, &key[EXTREME_UNTIL], v[EXTREME_UNTIL], where, &e->until);
    ab_read_number(&r->base, &key[EXTREME_SAME], v[EXTREME_SAME], where, &e->same);
    ab_read_number(&r->base, &key[EXTREME_RIGHT_TO], v[EXTREME_RIGHT_TO], where, &e->right_to);
    check_right_to(r, v[EXTREME_RIGHT_TO], where, e);
    if (ab_read_text(&r->base, &key[EXTREME_VALUE], v[EXTREME_VALUE], where, &value)) e->value = value;
    if (value != NULL && (strchr(value, '@') == NULL || strlen(value) > AB_EXTREMES_TEXT / 2))
        ab_report_error(r->base.report, v[EXTREME_VALUE]->mark,
                        "%s.value: '%.64s' has no @ to put the number at, or more than %d characters; for example '@*h/c'", where, value,
                        AB_EXTREMES_TEXT / 2);
}

/* A quantity by its name, by its path, or by the last part of its path. */
static size_t find(const ab_extremes_spec *spec, const char *name) {
    for (size_t i = 0; i < spec->count; i++)
        if (strcmp(spec->quantities[i].name, name) == 0) return i;
    for (size_t i = 0; i < spec->count; i++) {
        const char *dot = spec->quantities[i].path_count > 0 ? strrchr(spec->quantities[i].paths[0], '.') : NULL;
        if (dot != NULL && strcmp(dot + 1, name) == 0) return i;
    }
    return SIZE_MAX;
}

static void take_map(ab_scene_reader *r, const ab_node *node, ab_extremes_spec *spec) {
    if (!ab_scene_is_list(r, node, "extremes.map", "two names of quantities")) return;
    if (node->count != 2) {
        ab_report_error(r->base.report, node->mark, "extremes.map names %zu quantities; a map has two", node->count);
        return;
    }
    const char *names[AB_EXTREMES_QUANTITIES];
    for (size_t i = 0; i < spec->count; i++) names[i] = spec->quantities[i].name;
    for (int i = 0; i < 2; i++) {
        const char *name = ab_scene_word(r, node->items[i], "extremes.map", "the name of a quantity");
        if (name == NULL) return;
        char tail[AB_TAIL];
        spec->map[i] = find(spec, name);
        if (spec->map[i] == SIZE_MAX)
            ab_report_error(r->base.report, node->items[i]->mark, "extremes.map: there is no quantity '%.64s'%s", name,
                            ab_suggest_tail(name, names, spec->count, tail, sizeof tail));
    }
    if (spec->map[0] == spec->map[1] && spec->map[0] != SIZE_MAX)
        ab_report_error(r->base.report, node->mark, "extremes.map names '%.64s' twice; a map has two quantities",
                        spec->quantities[spec->map[0]].name);
    else if (spec->map[0] != SIZE_MAX && spec->map[1] != SIZE_MAX) {
        const ab_extreme *a = &spec->quantities[spec->map[0]], *b = &spec->quantities[spec->map[1]];
        for (size_t i = 0; i < a->path_count; i++)
            for (size_t k = 0; k < b->path_count; k++)
                if (strcmp(a->paths[i], b->paths[k]) == 0)
                    ab_report_error(r->base.report, node->mark,
                                    "extremes.map: '%.64s' and '%.64s' both set %s, of which a run has one value; a map has two quantities",
                                    a->name, b->name, a->paths[i]);
    }
    spec->has_map = true;
}

void ab_scene_take_extremes(ab_scene_reader *r, const ab_node *node) {
    ab_extremes_spec *spec = &r->scene->extremes;
    const ab_key *key = ab_section_extremes.keys;
    const ab_node *v[EXTREMES_KEYS] = {NULL};
    spec->limit = INFINITY;
    if (node != NULL && !ab_section_open(&r->base, &ab_section_extremes, node, "extremes", v)) return;
    ab_read_number(&r->base, &key[EXTREMES_LIMIT], v[EXTREMES_LIMIT], "extremes", &spec->limit);
    ab_read_number(&r->base, &key[EXTREMES_ENERGY], v[EXTREMES_ENERGY], "extremes", &spec->energy);
    const ab_node *vary = v[EXTREMES_VARY];
    if (vary != NULL && ab_scene_is_list(r, vary, "extremes.vary", "quantities - {set: ..., from: ..., to: ...}")) {
        if (vary->count == 0 || vary->count > AB_EXTREMES_QUANTITIES) {
            ab_report_error(r->base.report, vary->mark, "extremes.vary has %zu quantities; give 1 to %d", vary->count,
                            AB_EXTREMES_QUANTITIES);
            return;
        }
        spec->quantities = ab_reader_take(&r->base, vary->count, sizeof *spec->quantities);
        if (spec->quantities == NULL) return;
        for (size_t i = 0; i < vary->count; i++) {
            char where[AB_WHERE];
            snprintf(where, sizeof where, "extremes.vary[%zu]", i);
            take_extreme(r, vary->items[i], where, &spec->quantities[i]);
            spec->count++;
            for (size_t k = 0; k < i; k++)
                if (spec->quantities[i].name[0] != '\0' && strcmp(spec->quantities[k].name, spec->quantities[i].name) == 0)
                    ab_report_error(r->base.report, vary->items[i]->mark, "%s: two quantities are called '%.64s'; give one another name",
                                    where, spec->quantities[i].name);
        }
    }
    if (v[EXTREMES_MAP] != NULL) take_map(r, v[EXTREMES_MAP], spec);
}
