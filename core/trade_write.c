/* trade_write.c: what a trade found: a table on the terminal, trade.csv, trade.json and trade.svg. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/trade.h"

static const char *const STATES[] = {"not run", "running", "done", "failed", "refused", "over the limit", "skipped"};

/* By cost; what is not done last. */
static const ab_trade *sorting; /* qsort has no argument to spare */
static int by_cost(const void *a, const void *b) {
    const ab_trial *x = &sorting->trials[*(const size_t *)a], *y = &sorting->trials[*(const size_t *)b];
    const bool x_done = x->run.state == AB_CHILD_DONE, y_done = y->run.state == AB_CHILD_DONE;
    if (x_done != y_done) return x_done ? -1 : 1;
    if (x_done && ab_trade_cost(sorting, x) != ab_trade_cost(sorting, y))
        return ab_trade_cost(sorting, x) < ab_trade_cost(sorting, y) ? -1 : 1;
    return *(const size_t *)a < *(const size_t *)b ? -1 : 1;
}
static size_t *sorted(const ab_trade *trade) {
    size_t *order = malloc((trade->count + 1) * sizeof *order);
    if (order == NULL) return NULL;
    for (size_t i = 0; i < trade->count; i++) order[i] = i;
    sorting = trade;
    qsort(order, trade->count, sizeof *order, by_cost);
    return order;
}

/* The judge whose error is the run's. */
static const char *worst(const ab_trade *trade, const ab_trial *trial) {
    for (size_t k = 0; k < trade->judge_count; k++)
        if (!(trial->errors[k] < trial->error)) return trade->judges[k].name; /* the largest, or one that is not known */
    return "";
}

static int width_of(const ab_trade *trade, size_t ladder) {
    size_t width = strlen(trade->spec->ladders[ladder].name);
    for (size_t v = 0; v < trade->spec->ladders[ladder].value_count; v++) {
        const size_t length = strlen(trade->spec->ladders[ladder].values[v]);
        width = length > width ? length : width;
    }
    return width > 40 ? 40 : (int)width;
}

static void sentence(const ab_trade *trade, FILE *stream) {
    char settings[2000];
    const size_t cheap = ab_trade_cheapest(trade, trade->spec->tolerance), good = ab_trade_most_accurate(trade, trade->spec->seconds);
    fprintf(stream, "\n  ");
    if (cheap == SIZE_MAX)
        fprintf(stream, "No run has an error of %g or less", trade->spec->tolerance);
    else
        fprintf(stream, "The cheapest within an error of %g is %s (%.3g s, error %.2g)", trade->spec->tolerance,
                ab_trade_settings(trade, &trade->trials[cheap], settings, sizeof settings), ab_trade_cost(trade, &trade->trials[cheap]),
                trade->trials[cheap].error);
    if (good == SIZE_MAX)
        fprintf(stream, "; no run with a known error takes %g s or less.\n", trade->spec->seconds);
    else
        fprintf(stream, "; the most accurate within %g s is %s (%.3g s, error %.2g).\n", trade->spec->seconds,
                ab_trade_settings(trade, &trade->trials[good], settings, sizeof settings), ab_trade_cost(trade, &trade->trials[good]),
                trade->trials[good].error);
}

/* What the sentence rests on, where that is not firm. */
static void doubts(const ab_trade *trade, FILE *stream) {
    size_t count = 0;
    for (size_t k = 0; k < trade->judge_count; k++)
        if (trade->judges[k].doubt[0] != '\0') fprintf(stream, "%s%s", count++ == 0 ? "  But " : "; ", trade->judges[k].doubt);
    if (count > 0) fprintf(stream, ". There errors are no more than differences to the finest run, whose own may be larger.\n");
}

/* What a walk left out, and why. */
static void path_notes(const ab_trade *trade, size_t wanted, FILE *stream) {
    fprintf(stream, "  %zu of %zu combinations were run: a path from the scene's own settings along the front\n", wanted, trade->count);
    for (size_t k = 0; k < trade->spec->ladder_count; k++)
        for (size_t v = 0; v < trade->spec->ladders[k].value_count; v++)
            if (ab_trade_given_up(trade, k, v))
                fprintf(stream, "  %s=%s was beaten, or broke off, wherever it was tried, and was given up\n", trade->spec->ladders[k].name,
                        trade->spec->ladders[k].values[v]);
    size_t dear = 0;
    for (size_t i = 0; i < trade->count; i++)
        dear += trade->trials[i].front && ab_trade_cost(trade, &trade->trials[i]) > trade->spec->seconds;
    if (dear > 0 && ab_trade_cheapest(trade, trade->spec->tolerance) != SIZE_MAX)
        fprintf(stream, "  steps beyond runs of more than %g s were not taken: the tolerance is met for less\n", trade->spec->seconds);
}

void ab_trade_table(const ab_trade *trade, FILE *stream) {
    size_t *order = sorted(trade), left = 0;
    fprintf(stream, "\n  ");
    for (size_t k = 0; k < trade->spec->ladder_count; k++)
        fprintf(stream, "%-*.*s  ", width_of(trade, k), width_of(trade, k), trade->spec->ladders[k].name);
    fprintf(stream, "%10s  %10s  %9s  %8s  %10s  worst\n", "error", "cpu, s", "wall, s", "MB", "remainder");
    for (size_t i = 0; order != NULL && i < trade->count; i++) {
        const ab_trial *trial = &trade->trials[order[i]];
        if (trade->spec->path && !trial->wanted) continue; /* said below the table */
        fprintf(stream, "%s ", trial->front ? "*" : " ");
        for (size_t k = 0; k < trade->spec->ladder_count; k++) {
            const int width = width_of(trade, k);
            fprintf(stream, "%-*.*s  ", width, width, trade->spec->ladders[k].values[trial->rung[k]]);
        }
        if (trial->run.state != AB_CHILD_DONE) {
            fprintf(stream, "%s%s%.300s\n", STATES[trial->run.state], trial->run.why != NULL ? ": " : "",
                    trial->run.why != NULL ? trial->run.why : "");
            left++;
            continue;
        }
        if (isfinite(trial->error))
            fprintf(stream, "%10.2e", trial->error);
        else
            fprintf(stream, "%10s", trade->judges[0].monitor ? "finest" : "none");
        fprintf(stream, "  %10.3g  %9.3g  %8.3g  %+10.1e  %s\n", trial->run.cpu, trial->run.wall, 1e-6 * trial->run.bytes, trial->remainder,
                worst(trade, trial));
    }
    free(order);
    fprintf(stream, "\n  * no other run is both cheaper and better; error: the largest of ");
    for (size_t k = 0; k < trade->judge_count && k < 6; k++) fprintf(stream, "%s'%s'", k > 0 ? ", " : "", trade->judges[k].name);
    if (trade->judge_count > 6) fprintf(stream, " and %zu more", trade->judge_count - 6);
    fprintf(stream, "\n");
    if (trade->reference[0] != '\0') fprintf(stream, "  %s\n", trade->reference);
    size_t wanted = 0;
    for (size_t i = 0; i < trade->count; i++) wanted += trade->trials[i].wanted;
    if (left > 0) fprintf(stream, "  %zu of %zu runs have no answer\n", left, trade->spec->path ? wanted : trade->count);
    if (trade->spec->path) path_notes(trade, wanted, stream);
    sentence(trade, stream);
    doubts(trade, stream);
}

static void csv_number(ab_text *text, double value) {
    ab_text_add(text, ",");
    if (isfinite(value)) ab_text_add_number(text, value);
}

static void write_csv(const ab_trade *trade, ab_text *text) {
    for (size_t k = 0; k < trade->spec->ladder_count; k++) ab_text_add_csv(text, trade->spec->ladders[k].name), ab_text_add(text, ",");
    ab_text_add(text, "outcome,front,error,cpu_seconds,wall_seconds,peak_bytes,remainder");
    for (size_t k = 0; k < trade->judge_count; k++) {
        ab_text_add(text, ",");
        ab_text_add_csv(text, trade->judges[k].name);
    }
    ab_text_add(text, "\n");
    for (size_t i = 0; i < trade->count; i++) {
        const ab_trial *trial = &trade->trials[i];
        for (size_t k = 0; k < trade->spec->ladder_count; k++)
            ab_text_add_csv(text, trade->spec->ladders[k].values[trial->rung[k]]), ab_text_add(text, ",");
        ab_text_add(text, "%s,%d", STATES[trial->run.state], trial->front);
        const bool ran = trial->run.state == AB_CHILD_DONE || trial->run.state == AB_CHILD_FAILED;
        csv_number(text, trial->error);
        csv_number(text, ran ? trial->run.cpu : NAN);
        csv_number(text, ran ? trial->run.wall : NAN);
        csv_number(text, ran ? trial->run.bytes : NAN);
        csv_number(text, trial->remainder);
        for (size_t k = 0; k < trade->judge_count; k++) csv_number(text, trial->errors[k]);
        ab_text_add(text, "\n");
    }
}

static void json_number(ab_text *text, const char *name, double value) {
    ab_text_add(text, ", \"%s\": ", name);
    ab_text_add_number(text, value);
}

static void json_settings(const ab_trade *trade, const ab_trial *trial, ab_text *text) {
    ab_text_add(text, "{");
    for (size_t k = 0, written = 0; k < trade->spec->ladder_count; k++)
        for (size_t p = 0; p < trade->spec->ladders[k].path_count; p++) {
            ab_text_add(text, "%s", written++ > 0 ? ", " : "");
            ab_text_add_escaped(text, trade->spec->ladders[k].paths[p]);
            ab_text_add(text, ": ");
            ab_text_add_escaped(text, trade->spec->ladders[k].values[trial->rung[k]]);
        }
    ab_text_add(text, "}");
}

static void write_json(const ab_trade *trade, ab_text *text) {
    ab_text_add(text, "{\n  \"scene\": ");
    ab_text_add_escaped(text, trade->runs.scene);
    ab_text_add(text, ",\n  \"search\": \"%s\", \"cost\": \"%s\"", trade->spec->path ? "path" : "all", trade->spec->wall ? "wall" : "cpu");
    ab_text_add(text, ",\n  \"reference\": ");
    ab_text_add_escaped(text, trade->reference);
    ab_text_add(text, ", \"finest\": ");
    if (trade->finest == NULL) ab_text_add(text, "null");
    if (trade->finest != NULL) json_settings(trade, trade->finest, text);
    ab_text_add(text, ", \"doubts\": [");
    for (size_t k = 0, count = 0; k < trade->judge_count; k++) {
        if (trade->judges[k].doubt[0] == '\0') continue;
        ab_text_add(text, "%s", count++ > 0 ? ", " : "");
        ab_text_add_escaped(text, trade->judges[k].doubt);
    }
    ab_text_add(text, "]");
    json_number(text, "tolerance", trade->spec->tolerance);
    json_number(text, "seconds", trade->spec->seconds);
    const size_t cheap = ab_trade_cheapest(trade, trade->spec->tolerance), good = ab_trade_most_accurate(trade, trade->spec->seconds);
    ab_text_add(text, ",\n  \"cheapest\": ");
    if (cheap == SIZE_MAX) ab_text_add(text, "null");
    if (cheap != SIZE_MAX) json_settings(trade, &trade->trials[cheap], text);
    ab_text_add(text, ",\n  \"most_accurate\": ");
    if (good == SIZE_MAX) ab_text_add(text, "null");
    if (good != SIZE_MAX) json_settings(trade, &trade->trials[good], text);
    ab_text_add(text, ",\n  \"runs\": [");
    for (size_t i = 0; i < trade->count; i++) {
        const ab_trial *trial = &trade->trials[i];
        ab_text_add(text, "%s\n    {\"settings\": ", i > 0 ? "," : "");
        json_settings(trade, trial, text);
        ab_text_add(text, ", \"outcome\": \"%s\", \"folder\": ", STATES[trial->run.state]);
        ab_text_add_escaped(text, trial->run.folder);
        if (trial->run.why != NULL) ab_text_add(text, ", \"why\": "), ab_text_add_escaped(text, trial->run.why);
        ab_text_add(text, ", \"front\": %s", trial->front ? "true" : "false");
        json_number(text, "error", trial->error);
        json_number(text, "cpu_seconds", trial->run.cpu);
        json_number(text, "wall_seconds", trial->run.wall);
        json_number(text, "peak_bytes", trial->run.bytes);
        json_number(text, "remainder", trial->remainder);
        ab_text_add(text, ", \"errors\": {");
        for (size_t k = 0; k < trade->judge_count; k++) {
            ab_text_add(text, "%s", k > 0 ? ", " : "");
            ab_text_add_escaped(text, trade->judges[k].name);
            ab_text_add(text, ": ");
            ab_text_add_number(text, trial->errors[k]);
        }
        ab_text_add(text, "}}");
    }
    ab_text_add(text, "\n  ]\n}\n");
}

ab_status ab_trade_write(const ab_trade *trade, ab_report *report) {
    static void (*const writers[])(const ab_trade *, ab_text *) = {write_csv, write_json, ab_trade_picture};
    static const char *const names[] = {"trade.csv", "trade.json", "trade.svg"};
    for (int i = 0; i < 3; i++) {
        ab_text text = {0};
        writers[i](trade, &text);
        AB_TRY(ab_text_write(&text, trade->runs.folder, names[i], report));
    }
    return AB_OK;
}
