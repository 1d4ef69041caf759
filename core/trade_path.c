/* trade_path.c: `search: path`: a walk along the front from the scene's own settings, in place of all combinations.
 *
 * Local search for a front (Paquete, Chiarandini, Stuetzle 2004, "Pareto local search"), on ladders: every run that no other clearly beats is followed, that is, its neighbours
 * are run: one value up and one down on a ladder of numbers, every value on a ladder of words, all else as it is. It ends when all that are not beaten have been followed.
 * Left out: values of a ladder of words that were beaten wherever they were tried, twice or more; and steps up from a run that is dearer than the seconds asked for, once the
 * tolerance is met. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/trade.h"

static const double CLEARLY = 0.1; /* times of runs on a busy machine are no better than that */

static bool done(const ab_trial *t) { return t->run.state == AB_CHILD_DONE && isfinite(t->error); }

/* A tenth less error at no more than a tenth more cost, or a tenth less cost at no more error. */
static bool beats(const ab_trade *trade, const ab_trial *a, const ab_trial *b) {
    if (!done(a)) return false;
    const double cost = ab_trade_cost(trade, a), other = ab_trade_cost(trade, b);
    return (a->error < (1 - CLEARLY) * b->error && cost <= (1 + CLEARLY) * other) || (a->error <= b->error && cost < (1 - CLEARLY) * other);
}

static bool is_promising(const ab_trade *trade, const ab_trial *t) {
    if (!done(t)) return false;
    for (size_t i = 0; i < trade->count; i++)
        if (&trade->trials[i] != t && beats(trade, &trade->trials[i], t)) return false;
    return true;
}

static size_t stride(const ab_trade *trade, size_t ladder) { /* the last ladder changes fastest */
    size_t step = 1;
    for (size_t k = ladder + 1; k < trade->spec->ladder_count; k++) step *= trade->spec->ladders[k].value_count;
    return step;
}

static ab_trial *neighbour(const ab_trade *trade, const ab_trial *t, size_t ladder, size_t rung) {
    const size_t place = (size_t)(t - trade->trials), step = stride(trade, ladder);
    return &trade->trials[place - t->rung[ladder] * step + rung * step];
}

bool ab_trade_given_up(const ab_trade *trade, size_t ladder, size_t value) {
    size_t beaten = 0;
    if (ab_ladder_is_numeric(&trade->spec->ladders[ladder])) return false;
    for (size_t i = 0; i < trade->count; i++) {
        const ab_trial *t = &trade->trials[i];
        const bool broke = t->run.state == AB_CHILD_FAILED || t->run.state == AB_CHILD_LIMIT;
        if (t->rung[ladder] != value || !(done(t) || broke)) continue;
        bool better = broke, compared = broke;
        for (size_t v = 0; v < trade->spec->ladders[ladder].value_count && !better; v++) {
            const ab_trial *other = neighbour(trade, t, ladder, v);
            if (v == value || !done(other)) continue;
            compared = true;
            better = beats(trade, other, t);
        }
        if (compared && !better) return false;
        beaten += better;
    }
    return beaten >= 2;
}

static bool is_met(const ab_trade *trade) {
    for (size_t i = 0; i < trade->count; i++)
        if (done(&trade->trials[i]) && trade->trials[i].error <= trade->spec->tolerance) return true;
    return false;
}

static void follow(ab_trade *trade, ab_trial *t) {
    const bool dear = t->run.state == AB_CHILD_LIMIT || (done(t) && ab_trade_cost(trade, t) > trade->spec->seconds && is_met(trade));
    for (size_t k = 0; k < trade->spec->ladder_count; k++) {
        const ab_ladder *ladder = &trade->spec->ladders[k];
        const bool numeric = ab_ladder_is_numeric(ladder);
        for (size_t v = 0; v < ladder->value_count; v++) {
            const bool next_to = v + 1 == t->rung[k] || v == t->rung[k] + 1;
            if (v == t->rung[k] || (numeric && !next_to) || (numeric && dear && v > t->rung[k])) continue;
            if (!numeric && ab_trade_given_up(trade, k, v)) continue;
            ab_trial *n = neighbour(trade, t, k, v);
            n->wanted = n->wanted || n->run.state == AB_CHILD_WAITING;
        }
    }
}

/* Whose run is under way or waits to be. */
static bool any_ahead(const ab_trade *trade) {
    for (size_t i = 0; i < trade->count; i++)
        if (trade->trials[i].run.state == AB_CHILD_RUNNING || (trade->trials[i].wanted && trade->trials[i].run.state == AB_CHILD_WAITING))
            return true;
    return false;
}

void ab_trade_walk_on(ab_trade *trade) {
    bool some = false;
    for (size_t i = 0; i < trade->count; i++) /* what waits beside a run that has been beaten since need not be made any more */
        if (trade->trials[i].run.state == AB_CHILD_WAITING) trade->trials[i].wanted = trade->trials[i].first;
    for (size_t i = 0; i < trade->count; i++) {
        some = some || done(&trade->trials[i]);
        if (is_promising(trade, &trade->trials[i])) follow(trade, &trade->trials[i]);
    }
    for (size_t i = 0; i < trade->count && !some && !any_ahead(trade); i++) /* nothing to be better than yet: on past what broke off */
        if (trade->trials[i].run.state > AB_CHILD_DONE) follow(trade, &trade->trials[i]);
}

static void want_first(ab_trial *t) { t->wanted = t->first = true; }

/* The rungs that the scene stands on: where a value of a ladder is what the scene says; else the first. */
ab_status ab_trade_walk_begin(ab_trade *trade, ab_report *report) {
    ab_document *document = NULL;
    AB_TRY(ab_document_read(trade->runs.scene, &document, report));
    ab_status status = AB_OK;
    for (size_t i = 0; i < trade->runs.override_count && status == AB_OK; i++)
        status = ab_document_set(document, trade->runs.overrides[i].path, trade->runs.overrides[i].value, report);
    size_t start = 0, top = trade->count - 1;
    for (size_t k = 0; k < trade->spec->ladder_count && status == AB_OK; k++) {
        const ab_ladder *ladder = &trade->spec->ladders[k];
        const ab_node *own = ab_document_get(document, ladder->paths[0]);
        const char *text = own != NULL ? ab_node_flow(document->arena, own) : NULL;
        for (size_t v = 0; v < ladder->value_count && text != NULL; v++) {
            char *ends[2];
            const double a = strtod(text, &ends[0]), b = strtod(ladder->values[v], &ends[1]);
            const bool same_number = *ends[0] == '\0' && *ends[1] == '\0' && a == b;
            if (same_number || strcmp(text, ladder->values[v]) == 0) start += v * stride(trade, k);
        }
    }
    ab_document_destroy(document);
    want_first(&trade->trials[start]);
    if (!trade->judges[0].monitor) return status;
    /* errors are against the finest run, or the limit of three: these come first */
    want_first(&trade->trials[top]);
    for (size_t k = 0; k < trade->spec->ladder_count; k++) {
        double factor;
        if (!ab_trade_refines(trade, k, trade->spec->ladders[k].value_count - 1, &factor)) continue;
        for (size_t below = 1; below <= 2; below++) want_first(&trade->trials[top - below * stride(trade, k)]);
        break;
    }
    return status;
}
