/* extremes_verdict.c: whether a run was right, wrong, unstable or refused: from its exit, its ledger, its expects. */
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "core/document.h"
#include "core/extremes.h"

static const double MASS = 1e-9; /* of the mass at the start: less is rounding */

const char *ab_verdict_name(ab_verdict verdict) {
    static const char *const names[] = {"not known", "right", "wrong", "unstable", "refused"};
    return names[verdict];
}

static double number_of(const ab_node *map, const char *key) {
    const ab_node *node = map != NULL ? ab_node_find(map, key) : NULL;
    return node != NULL && node->kind == AB_NODE_SCALAR && !ab_node_is_null(node) ? strtod(node->text, NULL) : NAN;
}

static double mass_of(const ab_node *root, const char *when) {
    const ab_node *motion = ab_node_find(root, "motion");
    return motion != NULL ? number_of(ab_node_find(motion, when), "mass") : NAN;
}

static void say(ab_sample *s, ab_verdict verdict, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void say(ab_sample *s, ab_verdict verdict, const char *format, ...) {
    if (verdict <= s->verdict) return; /* the worst is told */
    va_list list;
    va_start(list, format);
    vsnprintf(s->why, sizeof s->why, format, list);
    va_end(list);
    s->verdict = verdict;
}

/* In the l2 norm value and reference are the sizes of two histories, alike to all digits shown where these run apart. */
static void say_miss(ab_sample *s, const ab_node *item, const char *shown, double error, double tolerance) {
    const ab_node *norm = ab_node_find(item, "norm");
    const double value = number_of(item, "value"), reference = number_of(item, "reference");
    s->verdict = AB_VERDICT_RIGHT; /* of several that are missed the worst is told */
    if (norm != NULL && norm->kind == AB_NODE_SCALAR && strcmp(norm->text, "l2") == 0)
        say(s, AB_VERDICT_WRONG, "'%s' is off by %.2g in the l2 norm of its history, whose size is %.4g where %.4g is wanted; %.2g allowed",
            shown, error, value, reference, tolerance);
    else
        say(s, AB_VERDICT_WRONG, "'%s' is %.4g, not %.4g: off by %.2g, %.2g allowed", shown, value, reference, error, tolerance);
}

static void judge_expects(const ab_extremes *x, ab_sample *s, const ab_node *expects) {
    const size_t count = expects != NULL && expects->kind == AB_NODE_LIST ? expects->count : 0;
    s->parts = calloc(x->scene->expect_count + 1, sizeof *s->parts);
    double worst = -1;
    for (size_t e = 0; e < count; e++) {
        const ab_node *item = expects->items[e], *name = ab_node_find(item, "name");
        const double value = number_of(item, "value"), reference = number_of(item, "reference"), error = fabs(number_of(item, "error")),
                     tolerance = number_of(item, "tolerance");
        const char *shown = name != NULL && name->kind == AB_NODE_SCALAR ? name->text : "an expect";
        if (s->parts != NULL && e < x->scene->expect_count) s->parts[e] = reference != 0 ? value / reference : number_of(item, "error");
        if (!isfinite(error)) {
            say(s, AB_VERDICT_UNSTABLE, "'%s' came out as no number", shown);
            continue;
        }
        const double off = tolerance > 0 ? error / tolerance : error > 0 ? INFINITY : 0;
        if (off > worst) {
            worst = off;
            s->error = error, s->tolerance = tolerance;
            if (off > 1 && s->verdict <= AB_VERDICT_WRONG) say_miss(s, item, shown, error, tolerance);
        }
    }
}

static void judge_summary(const ab_extremes *x, ab_sample *s) {
    char path[4200];
    snprintf(path, sizeof path, "%s/summary.json", s->run.folder);
    ab_report *report = ab_report_create();
    ab_document *document = NULL;
    if (report == NULL || ab_document_read(path, &document, report) != AB_OK) {
        s->verdict = AB_VERDICT_NONE;
        snprintf(s->why, sizeof s->why, "its summary.json cannot be read; remove the run's folder and begin again");
    } else {
        s->verdict = AB_VERDICT_RIGHT;
        const ab_node *root = document->root;
        judge_expects(x, s, ab_node_find(root, "expects"));
        const ab_node *ledger = ab_node_find(root, "ledger");
        s->remainder = number_of(ledger, "remainder_relative");
        const double before = mass_of(root, "start"), after = mass_of(root, "end");
        if (!isfinite(s->remainder))
            say(s, AB_VERDICT_UNSTABLE, "the ledger came out as no number");
        else if (s->remainder > x->spec->energy)
            say(s, AB_VERDICT_UNSTABLE, "energy made: %.3g of what moved, %g allowed", s->remainder, x->spec->energy);
        if (!(fabs(after - before) <= MASS * before)) say(s, AB_VERDICT_UNSTABLE, "mass lost: %.9g kg of %.9g are left", after, before);
    }
    ab_document_destroy(document);
    ab_report_destroy(report);
}

void ab_extremes_judge(const ab_extremes *x, ab_sample *s) {
    const char *why = s->run.why != NULL ? s->run.why : "";
    s->why[0] = '\0';
    s->told = false;
    s->verdict = AB_VERDICT_NONE;
    switch (s->run.state) {
    case AB_CHILD_DONE: judge_summary(x, s); break;
    case AB_CHILD_REFUSED:
        s->told = true;
        say(s, AB_VERDICT_REFUSED, "%s", why);
        break;
    case AB_CHILD_FAILED:
        s->told = !s->run.killed;
        if (s->run.machine)
            snprintf(s->why, sizeof s->why, "%s", why);
        else
            say(s, AB_VERDICT_UNSTABLE, "%s", why);
        break;
    case AB_CHILD_LIMIT: say(s, AB_VERDICT_UNSTABLE, "%s", why); break;
    case AB_CHILD_WAITING:
    case AB_CHILD_RUNNING:
    case AB_CHILD_SKIPPED: break;
    }
}

void ab_extremes_compare(const ab_extremes *x, size_t quantity) {
    const ab_extreme *e = &x->spec->quantities[quantity];
    const ab_sample *first = NULL;
    for (size_t i = 0; i < x->count && e->same > 0; i++) {
        ab_sample *s = x->samples[i];
        if (s->quantity != quantity || s->second != SIZE_MAX) continue;
        if (s->rung == 0) first = s;
        if (s->rung == 0 || s->verdict != AB_VERDICT_RIGHT || s->parts == NULL) continue;
        if (first == NULL || first->parts == NULL) {
            say(s, AB_VERDICT_WRONG, "there is nothing to compare with: the first value did not come to its end");
            continue;
        }
        for (size_t k = 0; k < x->scene->expect_count; k++) {
            const double off = fabs(s->parts[k] - first->parts[k]);
            if (off <= e->same) continue;
            say(s, AB_VERDICT_WRONG, "'%s' is %.17g of its reference, %.17g with %s: they differ by %.2g, %.2g allowed",
                x->scene->expects[k].name, s->parts[k], first->parts[k], first->shown, off, e->same);
        }
    }
}

/* Whether a sample lies on the part of the way that has to be right. */
static bool must_be_right(const ab_extreme *e, const ab_sample *s) {
    if (!isfinite(e->right_to)) return false;
    if (e->values == NULL) return e->to > e->from ? s->value <= e->right_to : s->value >= e->right_to;
    for (size_t k = 0; k < e->value_count; k++) { /* up to the value that is named */
        char *end;
        const double value = strtod(e->values[k], &end);
        if (end != e->values[k] && *end == '\0' && value == e->right_to) return s->rung <= k;
    }
    return true;
}

const ab_sample *ab_extremes_fault(const ab_extremes *x, size_t quantity) {
    const ab_extreme *e = &x->spec->quantities[quantity];
    const ab_sample *fault = NULL;
    for (size_t i = 0; i < x->count; i++) {
        const ab_sample *s = x->samples[i];
        if (s->quantity != quantity || s->second != SIZE_MAX || s->verdict == AB_VERDICT_RIGHT) continue;
        const bool stopped = s->verdict == AB_VERDICT_UNSTABLE && s->told && isfinite(e->right_to);
        if (!must_be_right(e, s) && (s->verdict == AB_VERDICT_REFUSED || stopped)) continue;
        if (fault == NULL || s->verdict > fault->verdict) fault = s;
    }
    return fault;
}
