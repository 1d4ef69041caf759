/* extremes_search.c: which values are tried: ladders first, then halves between rungs where the verdict changes: where the first stretch of each kind begins and ends. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/extremes.h"

/* ---- numbers as texts ------------------------------------------------------------------------------------------------------------------- */

/* With as few digits as read back the same. */
static void number_text(double value, char *text, size_t size) {
    for (int digits = 1; digits <= 17; digits++) {
        snprintf(text, size, "%.*g", digits, value);
        if (strtod(text, NULL) == value) return;
    }
}

/* The number with the fewest digits strictly between low and high (in this order), or NaN. */
static double shortest_between(double value, double low, double high) {
    char text[40];
    for (int digits = 1; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        const double rounded = strtod(text, NULL);
        if (rounded > low && rounded < high) return rounded;
    }
    return NAN;
}

/* `value` of the quantity with the number for each @; in quotes where it would otherwise be read as a mapping, as "@ > 1 ? 2 : 3" would. */
static void put_number(const ab_extreme *e, const char *number, char *text, size_t size) {
    const char *from = e->value != NULL ? e->value : "@";
    const bool quote = *from != '{' && *from != '[' && strstr(from, ": ") != NULL && strchr(from, '"') == NULL;
    const char *mark = quote ? "\"" : "";
    size_t used = (size_t)snprintf(text, size, "%s", mark);
    for (; *from != '\0' && used + 1 < size; from++) {
        const int written =
            *from == '@' ? snprintf(text + used, size - used, "%s", number) : snprintf(text + used, size - used, "%c", *from);
        used += (size_t)written;
    }
    if (used < size) snprintf(text + used, size - used, "%s", mark);
}

size_t ab_extremes_rungs(const ab_extreme *e) { return e->values != NULL ? e->value_count : e->rungs; }

/* The number of a rung; both ends as they are given, rungs between them with few digits. NaN: a word. */
static double rung_value(const ab_extreme *e, size_t rung) {
    if (e->values != NULL) {
        char *end;
        const double value = strtod(e->values[rung], &end);
        return end != e->values[rung] && *end == '\0' ? value : NAN;
    }
    if (rung == 0) return e->from;
    if (rung + 1 == e->rungs) return e->to;
    const double part = (double)rung / (double)(e->rungs - 1), step = 1 / (double)(e->rungs - 1);
    const double value = e->logarithmic ? e->from * pow(e->to / e->from, part) : e->from + part * (e->to - e->from);
    if (e->whole) return round(value);
    const double near = e->logarithmic ? fabs(value) * 0.1 * fabs(log(e->to / e->from)) * step : 0.1 * fabs(e->to - e->from) * step;
    const double rounded = shortest_between(value, value - near, value + near);
    return isfinite(rounded) ? rounded : value;
}

/* ---- samples --------------------------------------------------------------------------------------------------------------------------------- */

static size_t put_settings(const ab_extreme *e, const char *text, ab_override *settings, size_t count) {
    for (size_t w = 0; w < e->with_count; w++) settings[count++] = e->with[w];
    for (size_t p = 0; p < e->path_count; p++) settings[count++] = (ab_override){e->paths[p], text};
    return count;
}

/* The text that paths get, and what tables show of it. */
static double describe(const ab_extreme *e, size_t rung, double value, char *text, char shown[80]) {
    char number[AB_EXTREMES_TEXT / 2];
    if (rung != SIZE_MAX && e->values != NULL) {
        snprintf(number, sizeof number, "%s", e->values[rung]);
        value = rung_value(e, rung);
    } else
        number_text(value, number, sizeof number);
    put_number(e, number, text, AB_EXTREMES_TEXT);
    snprintf(shown, 80, "%.79s", number);
    return value;
}

static ab_status add(ab_extremes *x, size_t quantity, size_t rung, double value, size_t second, size_t second_rung, ab_report *report) {
    if (x->count == x->capacity) {
        const size_t capacity = x->capacity > 0 ? 2 * x->capacity : 64;
        ab_sample **more = realloc(x->samples, capacity * sizeof *more);
        if (more == NULL) return ab_report_failure(report, "no memory for %zu runs", capacity);
        x->samples = more;
        x->capacity = capacity;
    }
    ab_sample *s = calloc(1, sizeof *s);
    if (s == NULL) return ab_report_failure(report, "no memory for one more run");
    x->samples[x->count++] = s; /* a place of its own: children must not move */
    s->quantity = quantity, s->rung = rung, s->second = second, s->second_rung = second_rung;
    s->error = s->tolerance = s->remainder = NAN;
    const ab_extreme *e = &x->spec->quantities[quantity], *other = second != SIZE_MAX ? &x->spec->quantities[second] : NULL;
    s->value = describe(e, rung, value, s->text, s->shown);
    ab_override settings[4 * AB_EXTREMES_PATHS];
    size_t count = put_settings(e, s->text, settings, 0);
    char label[400];
    snprintf(label, sizeof label, "%.100s=%s", e->name, s->shown);
    if (other != NULL) {
        describe(other, second_rung, rung_value(other, second_rung), s->other, s->other_shown);
        count = put_settings(other, s->other, settings, count);
        snprintf(label + strlen(label), sizeof label - strlen(label), ", %.100s=%s", other->name, s->other_shown);
    }
    return ab_child_plan(&x->runs, &s->run, settings, count, label, report);
}

ab_status ab_extremes_plan(ab_extremes *x, ab_report *report) {
    for (size_t q = 0; q < x->spec->count; q++) {
        const ab_extreme *e = &x->spec->quantities[q];
        double before = NAN;
        for (size_t k = 0; k < ab_extremes_rungs(e); k++) {
            const double value = rung_value(e, k);
            if (e->values == NULL && value == before) continue; /* whole numbers, more rungs than numbers */
            before = value;
            AB_TRY(add(x, q, k, value, SIZE_MAX, 0, report));
        }
    }
    if (!x->spec->has_map) return AB_OK;
    const size_t a = x->spec->map[0], b = x->spec->map[1];
    for (size_t i = 0; i < ab_extremes_rungs(&x->spec->quantities[a]); i++)
        for (size_t k = 0; k < ab_extremes_rungs(&x->spec->quantities[b]); k++)
            AB_TRY(add(x, a, i, rung_value(&x->spec->quantities[a], i), b, k, report));
    return AB_OK;
}

void ab_extremes_clear(ab_extremes *x) {
    for (size_t i = 0; i < x->count; i++) {
        ab_child_clear(&x->samples[i]->run);
        free(x->samples[i]->parts);
        free(x->samples[i]);
    }
    free(x->samples);
    ab_child_runs_end(&x->runs);
    x->samples = NULL;
    x->count = x->capacity = 0;
}

/* ---- the way of one quantity ------------------------------------------------------------------------------------------------------------------- */

/* Of two samples of a quantity, whether a comes later on the way from its easy end to its hard one. */
static bool comes_later(const ab_extreme *e, const ab_sample *a, const ab_sample *b) {
    if (e->values != NULL) return a->rung > b->rung;
    return e->to > e->from ? a->value > b->value : a->value < b->value;
}

size_t ab_extremes_along(const ab_extremes *x, size_t quantity, ab_sample **list) {
    const ab_extreme *e = &x->spec->quantities[quantity];
    size_t count = 0;
    for (size_t i = 0; i < x->count; i++) {
        ab_sample *s = x->samples[i];
        if (s->quantity != quantity || s->second != SIZE_MAX) continue;
        size_t at = count++;
        for (; at > 0 && comes_later(e, list[at - 1], s); at--) list[at] = list[at - 1];
        list[at] = s;
    }
    return count;
}

ab_stretch ab_extremes_stretch(ab_sample *const *list, size_t count, ab_verdict worst) {
    ab_stretch stretch = {{NULL, NULL}, {NULL, NULL}};
    const ab_sample *first = NULL;
    for (size_t i = 0; i < count && stretch.end.after == NULL; i++) {
        if (list[i]->verdict == AB_VERDICT_NONE) continue;
        if (first == NULL) first = list[i];
        if (list[i]->verdict < worst) {
            if (stretch.begin.after == NULL) stretch.begin.after = list[i];
            stretch.end.before = list[i];
        } else if (stretch.begin.after == NULL)
            stretch.begin.before = list[i];
        else
            stretch.end.after = list[i];
    }
    if (stretch.begin.after == NULL) stretch.begin.before = NULL, stretch.end.after = first;
    return stretch;
}

const ab_sample *ab_extremes_cell(const ab_extremes *x, size_t rung, size_t second_rung) {
    for (size_t i = 0; i < x->count; i++)
        if (x->samples[i]->second != SIZE_MAX && x->samples[i]->rung == rung && x->samples[i]->second_rung == second_rung)
            return x->samples[i];
    return NULL;
}

/* The middle of a bracket, or NaN where it is narrow enough. */
static double middle_of(const ab_extreme *e, const ab_bracket *bracket) {
    if (e->values != NULL || bracket->before == NULL || bracket->after == NULL) return NAN;
    const double a = bracket->before->value, b = bracket->after->value, low = fmin(a, b), high = fmax(a, b);
    if (e->whole) {
        const double middle = floor(e->logarithmic ? copysign(sqrt(a * b), a) : low + 0.5 * (high - low));
        if (e->logarithmic ? fabs(log(b / a)) <= log1p(e->until) : high - low <= e->until * fabs(e->to - e->from)) return NAN;
        return middle > low && middle < high ? middle : high - low > 1.5 ? low + 1 : NAN;
    }
    if (e->logarithmic) {
        if (fabs(log(b / a)) <= log1p(e->until)) return NAN;
        const double middle = copysign(sqrt(a) * sqrt(b), a), quarter = pow(fabs(b / a), 0.25),
                     x = fabs(middle) / fmax(quarter, 1 / quarter), y = fabs(middle) * fmax(quarter, 1 / quarter);
        return a > 0 ? shortest_between(middle, x, y) : -shortest_between(-middle, x, y);
    }
    if (high - low <= e->until * fabs(e->to - e->from)) return NAN;
    return shortest_between(low + 0.5 * (high - low), low + 0.25 * (high - low), high - 0.25 * (high - low));
}

/* Adds the middles of brackets that are still wide, of quantities of which nothing runs. */
static void halve(ab_extremes *x) {
    static const ab_verdict changes[] = {AB_VERDICT_WRONG, AB_VERDICT_UNSTABLE, AB_VERDICT_REFUSED};
    ab_report *report = ab_report_create();
    ab_sample **list = calloc(x->count + 1, sizeof(ab_sample *));
    x->failed = x->failed || report == NULL || list == NULL;
    const size_t known = x->count;
    for (size_t q = 0; q < x->spec->count && !x->failed; q++) {
        size_t count = 0, waiting = 0;
        for (size_t i = 0; i < known; i++)
            waiting += x->samples[i]->quantity == q && x->samples[i]->second == SIZE_MAX && x->samples[i]->run.state < AB_CHILD_DONE;
        for (size_t i = known; i < x->count; i++) waiting += x->samples[i]->quantity == q;
        if (waiting > 0) continue;
        count = ab_extremes_along(x, q, list);
        double done[6];
        for (int c = 0; c < 6; c++) {
            const ab_stretch stretch = ab_extremes_stretch(list, count, changes[c / 2]);
            done[c] = middle_of(&x->spec->quantities[q], c % 2 == 0 ? &stretch.begin : &stretch.end);
            bool twice = !isfinite(done[c]);
            for (int k = 0; k < c && !twice; k++) twice = done[k] == done[c];
            for (size_t i = 0; i < count && !twice; i++) twice = list[i]->value == done[c];
            if (!twice && add(x, q, SIZE_MAX, done[c], SIZE_MAX, 0, report) != AB_OK) x->failed = true;
        }
    }
    free(list);
    ab_report_destroy(report);
}

static ab_child *next(void *owner) {
    ab_extremes *x = owner;
    for (int round = 0; round < 2 && !x->failed; round++) {
        for (size_t i = 0; i < x->count; i++)
            if (x->samples[i]->run.state == AB_CHILD_WAITING) return &x->samples[i]->run;
        if (round == 0) halve(x);
    }
    return NULL;
}

static void ended(void *owner, ab_child *child) {
    ab_extremes *x = owner;
    for (size_t i = 0; i < x->count; i++)
        if (&x->samples[i]->run == child) ab_extremes_judge(x, x->samples[i]);
    x->tried++;
}

static size_t count_ended(void *owner, size_t *expected) {
    const ab_extremes *x = owner;
    *expected = x->count;
    return x->tried;
}

ab_status ab_extremes_run(ab_extremes *x, const ab_scene *scene, ab_registry *registry, ab_report *report) {
    x->runs.owner = x;
    x->runs.next = next;
    x->runs.ended = ended;
    x->runs.count = count_ended;
    x->runs.limit = x->spec->limit;
    x->runs.keep_failures = true;
    const ab_status status = ab_child_runs_run(&x->runs, scene, registry, report);
    for (size_t q = 0; q < x->spec->count; q++) ab_extremes_compare(x, q);
    return x->failed ? ab_report_failure(report, "no memory for one more run") : status;
}
