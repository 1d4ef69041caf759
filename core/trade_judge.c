/* trade_judge.c: what the runs of a trade are worth: errors from what they wrote, and which of them no other beats in both error and cost. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/trade.h"

static const double ROUNDED = 1e-9; /* of a monitor's size: runs that differ by less are alike */

static double number_of(const ab_node *map, const char *key) {
    const ab_node *node = ab_node_find(map, key);
    return node != NULL && node->kind == AB_NODE_SCALAR && !ab_node_is_null(node) ? strtod(node->text, NULL) : NAN;
}

ab_status ab_trade_choose_judges(ab_trade *trade, const ab_scene *scene, ab_report *report) {
    const bool chosen = trade->spec->judge_count > 0, monitors = scene->expect_count == 0;
    const size_t count = chosen ? trade->spec->judge_count : monitors ? scene->monitor_count : scene->expect_count;
    if (count == 0)
        return ab_report_failure(report, "%s has neither expects nor monitors, so there is nothing to measure an error of; add one",
                                 trade->runs.scene);
    trade->judges = calloc(count, sizeof *trade->judges);
    if (trade->judges == NULL) return ab_report_failure(report, "no memory to judge the runs");
    trade->judge_count = count;
    for (size_t k = 0; k < count; k++) {
        const size_t which = chosen ? trade->spec->judges[k] : k;
        trade->judges[k] =
            (ab_judge){.name = monitors ? scene->monitors[which].name : scene->expects[which].name, .monitor = monitors, .reference = NAN};
    }
    for (size_t i = 0; i < trade->count; i++) {
        ab_trial *trial = &trade->trials[i];
        trial->errors = calloc(count, sizeof *trial->errors);
        trial->values = calloc(count, sizeof *trial->values);
        trial->peaks = calloc(count, sizeof *trial->peaks);
        if (trial->errors == NULL || trial->values == NULL || trial->peaks == NULL)
            return ab_report_failure(report, "no memory to judge the runs");
        for (size_t k = 0; k < count; k++) trial->errors[k] = trial->values[k] = NAN;
    }
    return AB_OK;
}

static void fail(ab_trial *trial, const char *why) {
    trial->run.state = AB_CHILD_FAILED;
    free(trial->run.why);
    trial->run.why = strdup(why);
}

static void read_summary(const ab_trade *trade, ab_trial *trial, ab_report *report) {
    char path[4200];
    snprintf(path, sizeof path, "%s/summary.json", trial->run.folder);
    ab_document *document = NULL;
    if (ab_document_read(path, &document, report) != AB_OK) {
        fail(trial, "its summary.json cannot be read; remove the run's folder and begin again");
        return;
    }
    const ab_node *ledger = ab_node_find(document->root, "ledger"), *expects = ab_node_find(document->root, "expects");
    if (ledger != NULL) trial->remainder = number_of(ledger, "remainder_relative");
    trial->work = number_of(document->root, "steps") * fmax(number_of(document->root, "points") + number_of(document->root, "nodes"), 1);
    for (size_t e = 0; expects != NULL && expects->kind == AB_NODE_LIST && e < expects->count; e++) {
        const ab_node *name = ab_node_find(expects->items[e], "name");
        for (size_t k = 0; k < trade->judge_count; k++) {
            if (trade->judges[k].monitor || name == NULL || strcmp(name->text, trade->judges[k].name) != 0) continue;
            trial->errors[k] = fabs(number_of(expects->items[e], "error"));
            trial->values[k] = number_of(expects->items[e], "value");
        }
    }
    ab_document_destroy(document);
}

/* The last row of history.csv, and the largest value of each column: a row may be longer than any buffer of a fixed size, so the file is gone through field by field. */
static void read_history(const ab_trade *trade, ab_trial *trial) {
    enum { FIELD = 400 };
    char path[4200], field[FIELD];
    snprintf(path, sizeof path, "%s/history.csv", trial->run.folder);
    FILE *file = fopen(path, "r");
    size_t used = 0, column = 0, row = 0, *judge_of = NULL, columns = 0;
    for (int c; file != NULL && (c = getc(file)) != EOF;) {
        if (c != ',' && c != '\n') {
            if (used + 1 < FIELD) field[used++] = (char)c;
            continue;
        }
        field[used] = '\0';
        used = 0;
        if (row == 0) {
            size_t *more = realloc(judge_of, (columns + 1) * sizeof *more);
            if (more == NULL) break;
            judge_of = more;
            judge_of[columns] = SIZE_MAX;
            for (size_t k = 0; k < trade->judge_count; k++)
                if (strcmp(trade->judges[k].name, field) == 0) judge_of[columns] = k;
            columns++;
        } else if (column < columns && judge_of[column] != SIZE_MAX) {
            trial->values[judge_of[column]] = strtod(field, NULL);
            trial->peaks[judge_of[column]] = fmax(trial->peaks[judge_of[column]], fabs(trial->values[judge_of[column]]));
        }
        column = c == '\n' ? 0 : column + 1;
        row += c == '\n';
    }
    if (file != NULL) fclose(file);
    free(judge_of);
}

/* ---- references of a scene without expects ----------------------------------------------------------------------------------------------- */

static ab_trial *at(const ab_trade *trade, const size_t rung[AB_TRADE_LADDERS]) {
    size_t place = 0;
    for (size_t k = 0; k < trade->spec->ladder_count; k++) place = place * trade->spec->ladders[k].value_count + rung[k];
    return trade->trials[place].run.state == AB_CHILD_DONE ? &trade->trials[place] : NULL;
}

/* The one highest on all ladders together; of several the one with the most point-steps; of these the last. */
static ab_trial *find_finest(const ab_trade *trade) {
    ab_trial *best = NULL;
    size_t most = 0;
    for (size_t i = 0; i < trade->count; i++) {
        ab_trial *trial = &trade->trials[i];
        size_t height = 0;
        for (size_t k = 0; k < trade->spec->ladder_count; k++) height += trial->rung[k];
        if (trial->run.state != AB_CHILD_DONE || (best != NULL && (height < most || (height == most && trial->work < best->work))))
            continue;
        most = height, best = trial;
    }
    return best;
}

/* Three runs that differ on one ladder alone, by a constant factor: the limit that their values tend to (Richardson 1911, with the order they show;
 * Roache 1998). False where they do not tend to one, with the reason as the judge's doubt: not monotone, or an order out of 0.5 to 6. */
static bool extrapolate(ab_judge *judge, const double value[3], double size, double factor, const char *along) {
    const double first = value[1] - value[0], second = value[2] - value[1], ratio = first / second;
    judge->order = NAN;
    judge->doubt[0] = '\0';
    if (fabs(first) <= ROUNDED * size && fabs(second) <= ROUNDED * size) return false; /* the same but for rounding */
    judge->order = log(fabs(ratio)) / log(factor);
    if (ratio > 0 && judge->order > 0.5 && judge->order < 6) {
        judge->reference = value[2] + second / (ratio - 1);
        return true;
    }
    snprintf(judge->doubt, sizeof judge->doubt, "'%.60s' %s along %.60s: it changes by %.2g, then by %.2g", judge->name,
             fabs(second) >= fabs(first) ? "does not converge"
             : ratio < 0                 ? "goes to and fro"
             : judge->order <= 0.5       ? "hardly converges"
                                         : "shows no order of convergence yet",
             along, first, second);
    judge->order = NAN;
    return false;
}

/* The ladder along which there are three runs up to the finest; their values go to `three`. NULL: none. */
static const ab_ladder *find_three(const ab_trade *trade, ab_trial *best, ab_trial *three[3], double *factor) {
    for (size_t k = 0; k < trade->spec->ladder_count; k++) {
        size_t rung[AB_TRADE_LADDERS], there = 0;
        memcpy(rung, best->rung, sizeof rung);
        if (!ab_trade_refines(trade, k, best->rung[k], factor)) continue;
        for (size_t i = 0; i < 3; i++) {
            rung[k] = best->rung[k] - 2 + i;
            three[i] = at(trade, rung);
            there += three[i] != NULL;
        }
        if (there == 3) return &trade->spec->ladders[k];
    }
    return NULL;
}

static void find_references(ab_trade *trade) {
    ab_trial *best = find_finest(trade), *three[3];
    trade->finest = best;
    if (best == NULL) return;
    double factor = 0, low = INFINITY, high = -INFINITY;
    const ab_ladder *along = find_three(trade, best, three, &factor);
    size_t limits = 0;
    for (size_t k = 0; k < trade->judge_count; k++) {
        ab_judge *judge = &trade->judges[k];
        const double size = best->peaks[k]; /* not that of the last value, which may well be next to 0 */
        judge->reference = best->values[k];
        judge->order = NAN;
        judge->doubt[0] = '\0';
        if (along != NULL &&
            extrapolate(judge, (double[]){three[0]->values[k], three[1]->values[k], three[2]->values[k]}, size, factor, along->name))
            limits++, low = fmin(low, judge->order), high = fmax(high, judge->order);
        for (size_t i = 0; i < trade->count; i++)
            if (trade->trials[i].run.state == AB_CHILD_DONE)
                trade->trials[i].errors[k] = size > 0 ? fabs(trade->trials[i].values[k] - judge->reference) / size : 0;
        if (judge->reference == best->values[k]) best->errors[k] = NAN; /* it is its own measure */
    }
    char settings[160], finest[240], orders[40];
    ab_trade_settings(trade, best, settings, sizeof settings);
    snprintf(finest, sizeof finest, "the finest run, %s (%.3g point-steps)", settings, best->work);
    snprintf(orders, sizeof orders, high - low < 0.1 ? "%.2g" : "%.2g to %.2g", low, high);
    if (limits > 0)
        snprintf(trade->reference, sizeof trade->reference,
                 "errors are against the limit that %.100s tends to (%zu of %zu monitors, with order %s; finest: %s, %.3g point-steps)%s",
                 along->name, limits, trade->judge_count, orders, settings, best->work,
                 limits < trade->judge_count ? ", else against the finest run" : "");
    else
        snprintf(trade->reference, sizeof trade->reference, "errors are against %s%s", finest,
                 along != NULL ? ""
                               : ", and nothing says how near that is to the limit: no ladder has three runs up to it, each finer by the "
                                 "same factor");
}

/* ---- verdicts ------------------------------------------------------------------------------------------------------------------------------ */

static void find_front(ab_trade *trade) {
    for (size_t i = 0; i < trade->count; i++) {
        ab_trial *trial = &trade->trials[i];
        trial->front = trial->run.state == AB_CHILD_DONE && isfinite(trial->error);
        for (size_t k = 0; k < trade->count && trial->front; k++) {
            const ab_trial *other = &trade->trials[k];
            if (k == i || other->run.state != AB_CHILD_DONE || !isfinite(other->error)) continue;
            const double cost = ab_trade_cost(trade, trial), its = ab_trade_cost(trade, other);
            if (other->error <= trial->error && its <= cost && (other->error < trial->error || its < cost || k < i)) trial->front = false;
        }
    }
}

double ab_trade_cost(const ab_trade *trade, const ab_trial *trial) { return trade->spec->wall ? trial->run.wall : trial->run.cpu; }

void ab_trade_judge(ab_trade *trade, ab_report *report) {
    const bool monitors = trade->judges[0].monitor;
    for (size_t i = 0; i < trade->count; i++) {
        ab_trial *trial = &trade->trials[i];
        if (trial->run.state != AB_CHILD_DONE || trial->read) continue;
        trial->read = true;
        read_summary(trade, trial, report);
        if (monitors && trial->run.state == AB_CHILD_DONE) read_history(trade, trial);
    }
    if (monitors) find_references(trade);
    for (size_t i = 0; i < trade->count; i++) {
        ab_trial *trial = &trade->trials[i];
        trial->error = trial->run.state == AB_CHILD_DONE ? 0 : NAN;
        for (size_t k = 0; k < trade->judge_count; k++)
            if (!(trial->error >= trial->errors[k]) && !isnan(trial->error)) trial->error = trial->errors[k]; /* NaN stays: not known */
    }
    find_front(trade);
}

size_t ab_trade_cheapest(const ab_trade *trade, double tolerance) {
    size_t best = SIZE_MAX;
    for (size_t i = 0; i < trade->count; i++)
        if (trade->trials[i].run.state == AB_CHILD_DONE && trade->trials[i].error <= tolerance &&
            (best == SIZE_MAX || ab_trade_cost(trade, &trade->trials[i]) < ab_trade_cost(trade, &trade->trials[best])))
            best = i;
    return best;
}

size_t ab_trade_most_accurate(const ab_trade *trade, double seconds) {
    size_t best = SIZE_MAX;
    for (size_t i = 0; i < trade->count; i++)
        if (trade->trials[i].run.state == AB_CHILD_DONE && ab_trade_cost(trade, &trade->trials[i]) <= seconds &&
            isfinite(trade->trials[i].error) && (best == SIZE_MAX || trade->trials[i].error < trade->trials[best].error))
            best = i;
    return best;
}
