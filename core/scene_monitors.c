/* scene_monitors.c: what a scene watches and what it expects; words, names and units. How they are computed: monitor.h, expect.h. */
#include <math.h>
#include <string.h>

#include "core/scene_reader.h"
#include "core/suggest.h"

enum { MOST_WORDS = 400, MOST_MONITORS = 1000, UNIT = 80 };

/* Unit of a monitor's value; "" where the value is not known. */
static const char *value_unit(const ab_scene *scene, const ab_monitor_spec *monitor) {
    const ab_words *words = monitor->body >= 0      ? &ab_words_body_values
                            : monitor->contact >= 0 ? &ab_words_contact_values
                            : monitor->of_boundary  ? &ab_words_boundary_values
                                                    : &ab_words_scene_values;
    if (monitor->value == NULL) return "";
    const ab_word *word = ab_words_find(words, monitor->value);
    if (word != NULL) return word->unit;
    if (monitor->body < 0) return "";
    char name[128];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(monitor->value, "."), monitor->value);
    const ab_state *state = ab_scene_state_named(scene, (size_t)monitor->body, name);
    return state == NULL ? "" : state->unit == NULL ? "1" : state->unit;
}

/* "plastic_strain" or "back_stress.xy": a declared state of the body's material, with a component where it has several. */
static bool is_state(const ab_scene *scene, size_t body, const char *value) {
    static const char *const components[] = {
        [AB_SCALAR] = "", [AB_VECTOR] = "x y", [AB_SYMMETRIC] = "xx yy zz xy", [AB_FULL] = "xx xy yx yy zz"};
    char name[128];
    const size_t length = strcspn(value, ".");
    snprintf(name, sizeof name, "%.*s", (int)length, value);
    const ab_state *state = ab_scene_state_named(scene, body, name);
    if (state == NULL || state->shape < AB_SCALAR || state->shape > AB_FULL) return false;
    if (state->shape == AB_SCALAR) return value[length] == '\0';
    if (value[length] != '.') return false;
    const char *wanted = value + length + 1, *c = components[state->shape];
    while (*c != '\0') {
        const size_t n = strcspn(c, " ");
        if (strlen(wanted) == n && strncmp(c, wanted, n) == 0) return true;
        c += n + (c[n] == ' ');
    }
    return false;
}

static void check_value(ab_scene_reader *r, const ab_node *node, const char *where, ab_monitor_spec *monitor) {
    const ab_scene *scene = r->scene;
    const ab_words *words = monitor->body >= 0      ? &ab_words_body_values
                            : monitor->contact >= 0 ? &ab_words_contact_values
                            : monitor->of_boundary  ? &ab_words_boundary_values
                                                    : &ab_words_scene_values;
    char path[AB_WHERE], tail[AB_TAIL];
    const char *text = ab_scene_word(r, node, ab_where_join(path, where, "value"), "one word such as position.x"), *names[MOST_WORDS];
    if (text == NULL) return;
    if (ab_words_find(words, text) != NULL || (monitor->body >= 0 && is_state(scene, (size_t)monitor->body, text))) {
        monitor->value = ab_reader_text(&r->base, text);
        return;
    }
    size_t count = 0;
    for (size_t i = 0; i < words->count; i++) names[count++] = words->word[i].name;
    for (size_t b = 0; b < scene->body_count; b++) {
        if (monitor->body != (int)b || scene->bodies[b].material >= scene->material_count) continue;
        const ab_loaded_class *model = scene->materials[scene->bodies[b].material].loaded;
        for (uint32_t s = 0; model != NULL && s < model->class_.nstate && count < MOST_WORDS; s++)
            names[count++] = model->class_.state[s].name;
    }
    ab_report_error(r->base.report, node->mark, "%s: unknown value '%.64s' of %s%s", path, text,
                    monitor->body >= 0      ? "a body"
                    : monitor->contact >= 0 ? "a contact"
                    : monitor->of_boundary  ? "a boundary"
                                            : "the scene (name a body or a contact for theirs)",
                    ab_suggest_tail(text, names, count, tail, sizeof tail));
}

static void take_monitor_name(ab_scene_reader *r, const ab_node *node, const char *where, ab_monitor_spec *monitor) {
    char path[AB_WHERE];
    const char *name = ab_scene_word(r, node, ab_where_join(path, where, "name"), "a name");
    if (name == NULL || !ab_name_ok(&r->base, "monitor", name, node->mark)) return;
    if (ab_words_find(&ab_words_columns, name) != NULL)
        ab_report_error(r->base.report, node->mark, "%s: '%s' is a column of history.csv already; choose another name", path, name);
    for (size_t i = 0; i < r->scene->monitor_count; i++) {
        const ab_monitor_spec *other = &r->scene->monitors[i];
        if (other != monitor && other->name != NULL && strcmp(other->name, name) == 0)
            ab_report_error(r->base.report, node->mark, "%s: there is a monitor '%s' already in line %d", path, name, other->mark.line);
    }
    monitor->name = ab_reader_text(&r->base, name);
}

/* The number behind `contact` or `boundary` where there are `count` of them. */
static bool take_number(ab_scene_reader *r, int key, const ab_node *node, const char *where, size_t count, long *number) {
    const char *what = ab_section_monitor.keys[key].name;
    if (!ab_read_integer(&r->base, &ab_section_monitor.keys[key], node, where, number)) return false;
    if (*number >= 0 && *number < (long)count) return true;
    if (key == MONITOR_BOUNDARY && r->scene->boundary_count > count)
        ab_report_error(r->base.report, node->mark,
                        "%s.boundary: there is no boundary %ld in the list under boundaries, which has %zu; those under grid.sides have no "
                        "number: write the side there instead, {on: BODY, where: {side: SIDE}, boundary: NAME}",
                        where, *number, count);
    else if (count == 0)
        ab_report_error(r->base.report, node->mark, "%s.%s: there is no %s %ld, the scene has none", where, what, what, *number);
    else
        ab_report_error(r->base.report, node->mark, "%s.%s: there is no %s %ld; they count from 0 to %zu", where, what, what, *number,
                        count - 1);
    return false;
}

/* Of what: a body, a contact, a boundary or the scene. False when the name is wrong. */
static bool take_subject(ab_scene_reader *r, const ab_node *const *v, const char *where, ab_monitor_spec *monitor) {
    char path[AB_WHERE];
    long contact = 0;
    if (v[MONITOR_BOUNDARY] != NULL && (v[MONITOR_BODY] != NULL || v[MONITOR_CONTACT] != NULL)) {
        ab_report_error(r->base.report, v[MONITOR_BOUNDARY]->mark, "%s has boundary beside body or contact; keep one", where);
        return false;
    }
    if (v[MONITOR_BODY] != NULL && v[MONITOR_CONTACT] != NULL) {
        ab_report_error(r->base.report, v[MONITOR_CONTACT]->mark, "%s has both body and contact; keep one", where);
        return false;
    }
    if (v[MONITOR_BODY] != NULL) {
        const char *name = ab_scene_word(r, v[MONITOR_BODY], ab_where_join(path, where, "body"), "the name of a body");
        if (name != NULL) monitor->body = ab_scene_body_named(r, name, v[MONITOR_BODY]->mark, path);
        return monitor->body >= 0;
    }
    if (v[MONITOR_CONTACT] != NULL) {
        if (!take_number(r, MONITOR_CONTACT, v[MONITOR_CONTACT], where, r->scene->contact_count, &contact)) return false;
        monitor->contact = (int)contact;
    } else if (v[MONITOR_BOUNDARY] != NULL) {
        if (!take_number(r, MONITOR_BOUNDARY, v[MONITOR_BOUNDARY], where, r->scene->boundary_listed, &contact)) return false;
        monitor->of_boundary = true;
        monitor->boundary = (size_t)contact;
    }
    return true;
}

/* How far outside its body's box a place may be drawn before it is doubted, m, with the box; false: nobody knows the box. */
static bool box_of(const ab_scene_reader *r, const ab_monitor_spec *monitor, double low[2], double high[2], double *slack) {
    if (!ab_body_bounds(&r->scene->bodies[monitor->body], low, high)) return false;
    *slack = r->scene->grid_cell > 0 ? r->scene->grid_cell : 0.05 * fmax(high[0] - low[0], high[1] - low[1]);
    return true;
}

static void warn_of_place_outside(ab_scene_reader *r, const ab_node *node, const char *where, const ab_monitor_spec *monitor) {
    char path[AB_WHERE];
    double low[2], high[2], slack;
    if (!monitor->has_at || !box_of(r, monitor, low, high, &slack)) return;
    for (int d = 0; d < 2; d++)
        if (monitor->at[d] < low[d] - slack || monitor->at[d] > high[d] + slack) {
            ab_report_warning(r->base.report, node->mark, "%s: [%g, %g] lies outside body '%s'; its nearest point is taken",
                              ab_where_join(path, where, "at"), monitor->at[0], monitor->at[1], r->scene->bodies[monitor->body].name);
            break;
        }
}

/* A single x or y means the points nearest to it, however far they are. */
static void warn_of_row_outside(ab_scene_reader *r, const ab_node *node, const char *where, const ab_monitor_spec *monitor) {
    char path[AB_WHERE];
    double low[2], high[2], slack;
    if (!monitor->has_where || !box_of(r, monitor, low, high, &slack)) return;
    for (int d = 0; d < 2; d++) {
        const double *range = monitor->where.range[d];
        if (monitor->where.has[d] && range[0] == range[1] && (range[0] < low[d] - slack || range[0] > high[d] + slack))
            ab_report_warning(r->base.report, node->mark, "%s: %c = %g lies outside body '%s'; its nearest points are taken",
                              ab_where_join(path, where, "where"), d ? 'y' : 'x', range[0], r->scene->bodies[monitor->body].name);
    }
}

static void take_places(ab_scene_reader *r, const ab_node *const *v, const char *where, ab_monitor_spec *monitor) {
    char path[AB_WHERE];
    const ab_scene *scene = r->scene;
    const bool of_points = monitor->body >= 0 && monitor->value != NULL &&
                           (ab_value_is_of_points(monitor->value) || is_state(scene, (size_t)monitor->body, monitor->value));
    static const int place_keys[] = {MONITOR_AT, MONITOR_OVER, MONITOR_WHERE, MONITOR_MINUS};
    for (int i = 0; i < 4; i++) {
        const ab_node *node = v[place_keys[i]];
        if (node != NULL && !of_points)
            ab_report_error(r->base.report, node->mark,
                            "%s.%s has no meaning for '%s', which does not belong to single points; leave it out", where,
                            ab_section_monitor.keys[place_keys[i]].name, monitor->value == NULL ? "" : monitor->value);
    }
    if (!of_points) return;
    if (v[MONITOR_MINUS] != NULL) {
        ab_key key = ab_section_monitor.keys[MONITOR_MINUS];
        key.unit = value_unit(scene, monitor);
        monitor->has_minus = ab_read_formula(&r->base, &key, v[MONITOR_MINUS], where, &monitor->minus);
    }
    if (v[MONITOR_AT] != NULL) {
        for (int i = 1; i < 3; i++)
            if (v[place_keys[i]] != NULL)
                ab_report_error(r->base.report, v[place_keys[i]]->mark, "%s: at names one point, so %s has no meaning; keep one", where,
                                ab_section_monitor.keys[place_keys[i]].name);
        monitor->has_at = ab_read_point(&r->base, &ab_section_monitor.keys[MONITOR_AT], v[MONITOR_AT], where, monitor->at);
        warn_of_place_outside(r, v[MONITOR_AT], where, monitor);
        return;
    }
    if (v[MONITOR_WHERE] != NULL)
        monitor->has_where = ab_scene_take_where(r, v[MONITOR_WHERE], ab_where_join(path, where, "where"), &monitor->where);
    warn_of_row_outside(r, v[MONITOR_WHERE], where, monitor);
    if (v[MONITOR_OVER] != NULL)
        ab_read_word(&r->base, &ab_section_monitor.keys[MONITOR_OVER], v[MONITOR_OVER], where, &monitor->over);
    else if (strcmp(monitor->value, "mass") != 0 && strcmp(monitor->value, "volume") != 0)
        monitor->over = ab_reader_text(&r->base, "mass");
}

static void take_monitor(ab_scene_reader *r, const ab_node *node, const char *where, ab_monitor_spec *monitor) {
    const ab_node *v[MONITOR_KEYS];
    if (!ab_section_open(&r->base, &ab_section_monitor, node, where, v)) return;
    if (v[MONITOR_NAME] != NULL) take_monitor_name(r, v[MONITOR_NAME], where, monitor);
    if (!take_subject(r, v, where, monitor) || v[MONITOR_VALUE] == NULL) return;
    check_value(r, v[MONITOR_VALUE], where, monitor);
    if (monitor->value != NULL) take_places(r, v, where, monitor);
}

void ab_scene_take_monitors(ab_scene_reader *r, const ab_node *node) {
    ab_scene *scene = r->scene;
    if (node == NULL || !ab_scene_is_list(r, node, "monitors", "entries - {name: ..., body: ..., value: ...}")) return;
    if (node->count > MOST_MONITORS) {
        ab_report_error(r->base.report, node->mark, "monitors has %zu entries, more than %d", node->count, MOST_MONITORS);
        return;
    }
    scene->monitors = ab_reader_take(&r->base, node->count, sizeof *scene->monitors);
    if (scene->monitors == NULL) return;
    scene->monitor_count = node->count;
    for (size_t i = 0; i < node->count; i++)
        scene->monitors[i] = (ab_monitor_spec){.mark = node->items[i]->mark, .body = -1, .contact = -1, .where = {.side = -1}};
    for (size_t i = 0; i < node->count; i++) {
        char where[AB_WHERE];
        snprintf(where, sizeof where, "monitors[%zu]", i);
        take_monitor(r, node->items[i], where, &scene->monitors[i]);
    }
}

static bool outflow(const ab_scene *scene) {
    for (size_t k = 0; k < scene->stage_count; k++)
        for (int s = 0; s < AB_SIDES; s++)
            if (scene->stages[k].side[s] == AB_SIDE_OUTFLOW) return true;
    for (int s = 0; s < AB_SIDES; s++)
        if (scene->side[s] == AB_SIDE_OUTFLOW) return true;
    return false;
}

/* "kinetic" or "block.kinetic". Gives the unit, or NULL with the mistake reported. */
static const char *take_column(ab_scene_reader *r, const ab_node *node, const char *where, ab_expect_spec *expect) {
    const ab_scene *scene = r->scene;
    char path[AB_WHERE], tail[AB_TAIL];
    const char *text = ab_scene_word(r, node, ab_where_join(path, where, "column"), "the name of a column of history.csv");
    if (text == NULL) return NULL;
    const char *dot = strrchr(text, '.'), *last = dot == NULL ? text : dot + 1, *names[MOST_WORDS];
    if (dot != NULL) {
        char body[80];
        snprintf(body, sizeof body, "%.*s", (int)(dot - text), text);
        if (ab_scene_body_named(r, body, node->mark, path) < 0) return NULL;
    }
    const ab_word *word = ab_words_find(&ab_words_columns, last);
    if (word != NULL && !(dot != NULL && ab_column_is_total(last)) && (strcmp(last, "outflow") != 0 || outflow(scene)) &&
        (strcmp(last, "stage") != 0 || scene->stage_count > 0)) {
        expect->column = ab_reader_text(&r->base, text);
        return word->unit;
    }
    size_t count = 0;
    for (size_t i = 0; i < ab_words_columns.count; i++)
        if (dot == NULL || !ab_column_is_total(ab_words_columns.word[i].name)) names[count++] = ab_words_columns.word[i].name;
    for (size_t m = 0; m < scene->monitor_count; m++)
        if (scene->monitors[m].name != NULL && strcmp(scene->monitors[m].name, text) == 0) {
            ab_report_error(r->base.report, node->mark, "%s: '%s' is a monitor; write monitor: %s", path, text, text);
            return NULL;
        }
    ab_report_error(r->base.report, node->mark, "%s: unknown column '%.64s'%s", path, last,
                    ab_suggest_tail(last, names, count, tail, sizeof tail));
    return NULL;
}

static const char *take_monitor_of(ab_scene_reader *r, const ab_node *node, const char *where, ab_expect_spec *expect) {
    const ab_scene *scene = r->scene;
    char path[AB_WHERE], tail[AB_TAIL];
    const char *names[MOST_MONITORS], *text = ab_scene_word(r, node, ab_where_join(path, where, "monitor"), "the name of a monitor");
    size_t count = 0;
    if (text == NULL) return NULL;
    for (size_t m = 0; m < scene->monitor_count; m++) {
        if (scene->monitors[m].name == NULL) continue;
        names[count++] = scene->monitors[m].name;
        if (strcmp(scene->monitors[m].name, text) == 0) {
            expect->monitor = m;
            return value_unit(scene, &scene->monitors[m]);
        }
    }
    ab_report_error(r->base.report, node->mark, "%s: there is no monitor '%.64s'%s", path, text,
                    ab_suggest_tail(text, names, count, tail, sizeof tail));
    return NULL;
}

/* Unit of a norm of values in `unit`. */
static const char *norm_unit(const char *norm, const char *unit, char *buffer) {
    const ab_word *word = ab_words_find(&ab_words_norms, norm);
    if (word == NULL || word->unit[0] == '\0') return unit;
    if (word->unit[0] == 's') return "s";
    if (strcmp(unit, "1") == 0) return word->unit[0] == '*' ? "s" : "s-1";
    snprintf(buffer, UNIT, "%.60s %s", unit, word->unit[0] == '*' ? "s" : "s-1");
    return buffer;
}

/* False: the run was shortened by --set and does not reach the window. */
static bool take_window(ab_scene_reader *r, const ab_node *const *v, const char *where, ab_expect_spec *expect) {
    const ab_key *key = ab_section_expect.keys;
    const double end = r->scene->time_end;
    expect->to = end;
    ab_read_number(&r->base, &key[EXPECT_FROM], v[EXPECT_FROM], where, &expect->from);
    ab_read_number(&r->base, &key[EXPECT_TO], v[EXPECT_TO], where, &expect->to);
    const bool late = end > 0 && v[EXPECT_TO] != NULL && expect->to > end * (1 + 1e-12);
    const bool empty = end > 0 && v[EXPECT_FROM] != NULL && !(expect->from < expect->to);
    const ab_node *edge = late ? v[EXPECT_TO] : v[EXPECT_FROM];
    if (r->end_by_set && (late || (empty && expect->from >= end)) && !edge->override_) {
        ab_report_warning(r->base.report, edge->mark, "%s is left out: its window reaches to %.10g s, but --set ends the run at %.10g s",
                          where, fmax(expect->from, expect->to), end);
        return false;
    }
    if (late)
        ab_report_error(r->base.report, v[EXPECT_TO]->mark, "%s.to: %.10g s is after the end of the run at %.10g s", where, expect->to,
                        end);
    if (empty)
        ab_report_error(r->base.report, v[EXPECT_FROM]->mark, "%s: the window from %.10g to %.10g s is empty", where, expect->from,
                        expect->to);
    return true;
}

/* False: it is left out. */
static bool take_expect(ab_scene_reader *r, const ab_node *node, const char *where, ab_expect_spec *expect) {
    const ab_node *v[EXPECT_KEYS];
    if (!ab_section_open(&r->base, &ab_section_expect, node, where, v)) return true;
    ab_key key[EXPECT_KEYS];
    memcpy(key, ab_section_expect.keys, sizeof key);
    if (v[EXPECT_NAME] != NULL) ab_read_text(&r->base, &key[EXPECT_NAME], v[EXPECT_NAME], where, &expect->name);
    const char *unit = NULL;
    if ((v[EXPECT_MONITOR] != NULL) == (v[EXPECT_COLUMN] != NULL)) {
        ab_report_error(r->base.report, node->mark, "%s needs one of monitor and column%s", where,
                        v[EXPECT_MONITOR] != NULL ? ", not both" : "");
    } else {
        unit = v[EXPECT_MONITOR] != NULL ? take_monitor_of(r, v[EXPECT_MONITOR], where, expect)
                                         : take_column(r, v[EXPECT_COLUMN], where, expect);
    }
    char buffer[UNIT];
    const bool normed = ab_read_word(&r->base, &key[EXPECT_NORM], v[EXPECT_NORM], where, &expect->norm);
    if (unit != NULL && unit[0] == '\0') unit = NULL; /* the monitor has a mistake of its own */
    key[EXPECT_LEVEL].unit = unit;
    key[EXPECT_REFERENCE].unit = key[EXPECT_SCALE].unit = unit == NULL || !normed ? NULL : norm_unit(expect->norm, unit, buffer);
    if (v[EXPECT_REFERENCE] != NULL) ab_read_formula(&r->base, &key[EXPECT_REFERENCE], v[EXPECT_REFERENCE], where, &expect->reference);
    ab_read_number(&r->base, &key[EXPECT_SCALE], v[EXPECT_SCALE], where, &expect->scale);
    ab_read_number(&r->base, &key[EXPECT_LEVEL], v[EXPECT_LEVEL], where, &expect->level);
    if (v[EXPECT_TOLERANCE] != NULL) ab_read_number(&r->base, &key[EXPECT_TOLERANCE], v[EXPECT_TOLERANCE], where, &expect->tolerance);
    const bool kept = take_window(r, v, where, expect);
    if (!normed) return kept;
    if (ab_norm_needs_level(expect->norm) && v[EXPECT_LEVEL] == NULL)
        ab_report_error(r->base.report, node->mark, "key 'level' is missing in %s: norm %s needs the value that is to be exceeded", where,
                        expect->norm);
    if (!ab_norm_needs_level(expect->norm) && v[EXPECT_LEVEL] != NULL)
        ab_report_error(r->base.report, v[EXPECT_LEVEL]->mark, "%s.level has no meaning for norm %s; leave it out", where, expect->norm);
    return kept;
}

void ab_scene_take_expects(ab_scene_reader *r, const ab_node *node) {
    ab_scene *scene = r->scene;
    if (node == NULL || !ab_scene_is_list(r, node, "expect", "entries - {name: ..., monitor: ..., reference: ..., tolerance: ...}")) return;
    if (node->count > MOST_MONITORS) {
        ab_report_error(r->base.report, node->mark, "expect has %zu entries, more than %d", node->count, MOST_MONITORS);
        return;
    }
    scene->expects = ab_reader_take(&r->base, node->count, sizeof *scene->expects);
    if (scene->expects == NULL) return;
    for (size_t i = 0; i < node->count; i++) {
        char where[AB_WHERE];
        ab_expect_spec *expect = &scene->expects[scene->expect_count];
        *expect = (ab_expect_spec){.mark = node->items[i]->mark, .monitor = SIZE_MAX};
        snprintf(where, sizeof where, "expect[%zu]", i);
        if (take_expect(r, node->items[i], where, expect)) scene->expect_count++;
    }
}
