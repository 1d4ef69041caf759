/* trade_runs.c: the runs of a trade: which are made, and in which order. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/trade.h"

const char *ab_trade_settings(const ab_trade *trade, const ab_trial *trial, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (size_t k = 0; k < trade->spec->ladder_count && used < size; k++) {
        const ab_ladder *ladder = &trade->spec->ladders[k];
        used += (size_t)snprintf(text + used, size - used, "%s%s=%s", k > 0 ? ", " : "", ladder->name, ladder->values[trial->rung[k]]);
    }
    return text;
}

ab_status ab_trade_plan(ab_trade *trade, ab_report *report) {
    size_t count = 1;
    for (size_t k = 0; k < trade->spec->ladder_count; k++) count *= trade->spec->ladders[k].value_count;
    trade->trials = calloc(count, sizeof *trade->trials);
    if (trade->trials == NULL) return ab_report_failure(report, "no memory for %zu runs", count);
    trade->count = count;
    for (size_t i = 0; i < count; i++) {
        ab_trial *trial = &trade->trials[i];
        size_t rest = i, set = 0;
        for (size_t k = trade->spec->ladder_count; k-- > 0;) {
            trial->rung[k] = rest % trade->spec->ladders[k].value_count;
            rest /= trade->spec->ladders[k].value_count;
        }
        trial->error = trial->remainder = NAN;
        ab_override settings[AB_TRADE_LADDERS * AB_TRADE_PATHS];
        for (size_t k = 0; k < trade->spec->ladder_count; k++)
            for (size_t p = 0; p < trade->spec->ladders[k].path_count; p++)
                settings[set++] = (ab_override){trade->spec->ladders[k].paths[p], trade->spec->ladders[k].values[trial->rung[k]]};
        char label[2000];
        AB_TRY(ab_child_plan(&trade->runs, &trial->run, settings, set, ab_trade_settings(trade, trial, label, sizeof label), report));
    }
    return AB_OK;
}

void ab_trade_clear(ab_trade *trade) {
    for (size_t i = 0; i < trade->count; i++) {
        ab_trial *trial = &trade->trials[i];
        ab_child_clear(&trial->run);
        free(trial->errors), free(trial->values), free(trial->peaks);
    }
    free(trade->trials), free(trade->judges);
    ab_child_runs_end(&trade->runs);
    trade->trials = NULL, trade->judges = NULL;
    trade->count = trade->judge_count = 0;
}

bool ab_ladder_is_numeric(const ab_ladder *ladder) {
    for (size_t i = 0; i < ladder->value_count; i++) {
        char *end;
        strtod(ladder->values[i], &end);
        if (end == ladder->values[i] || *end != '\0') return false;
    }
    return true;
}

/* Runs that are dearer than one that was over the limit: as far or further on every ladder of numbers, the same on every other. */
static void skip_dearer(ab_trade *trade, const ab_trial *slow) {
    for (size_t i = 0; i < trade->count; i++) {
        ab_trial *trial = &trade->trials[i];
        if (trial->run.state != AB_CHILD_WAITING) continue;
        bool dearer = true;
        for (size_t k = 0; k < trade->spec->ladder_count && dearer; k++)
            dearer = ab_ladder_is_numeric(&trade->spec->ladders[k]) ? trial->rung[k] >= slow->rung[k] : trial->rung[k] == slow->rung[k];
        if (!dearer) continue;
        char settings[600], why[800];
        trial->run.state = AB_CHILD_SKIPPED;
        snprintf(why, sizeof why, "a cheaper run is over the limit: %s", ab_trade_settings(trade, slow, settings, sizeof settings));
        ab_child_say_why(&trial->run, why);
    }
}

ab_child *ab_trade_next(void *owner) {
    ab_trade *trade = owner;
    if (trade->spec->path && trade->stale) {
        ab_trade_judge(trade, trade->report);
        ab_trade_walk_on(trade);
        trade->stale = false;
    }
    ab_child *best = NULL;
    size_t least = SIZE_MAX;
    for (size_t i = 0; i < trade->count; i++) {
        if (trade->trials[i].run.state != AB_CHILD_WAITING || (trade->spec->path && !trade->trials[i].wanted)) continue;
        size_t height = 0;
        for (size_t k = 0; k < trade->spec->ladder_count; k++) height += trade->trials[i].rung[k];
        if (height < least) least = height, best = &trade->trials[i].run;
    }
    return best;
}

static void ended(void *owner, ab_child *child) {
    ab_trade *trade = owner;
    trade->stale = true;
    for (size_t i = 0; i < trade->count && child->state == AB_CHILD_LIMIT; i++)
        if (&trade->trials[i].run == child) skip_dearer(trade, &trade->trials[i]);
}

static size_t count_ended(void *owner, size_t *expected) {
    const ab_trade *trade = owner;
    size_t count = 0, wanted = 0;
    for (size_t i = 0; i < trade->count; i++) {
        count += trade->trials[i].run.state >= AB_CHILD_DONE;
        wanted += trade->trials[i].wanted || trade->trials[i].run.state != AB_CHILD_WAITING;
    }
    *expected = trade->spec->path ? wanted : trade->count; /* of a walk: as far as is known */
    return count;
}

ab_status ab_trade_run(ab_trade *trade, const ab_scene *scene, ab_registry *registry, ab_report *report) {
    AB_TRY(ab_trade_choose_judges(trade, scene, report));
    trade->report = report;
    if (trade->spec->path) AB_TRY(ab_trade_walk_begin(trade, report));
    trade->runs.owner = trade;
    trade->runs.next = ab_trade_next;
    trade->runs.ended = ended;
    trade->runs.count = count_ended;
    trade->runs.limit = trade->spec->limit;
    return ab_child_runs_run(&trade->runs, scene, registry, report);
}
