/* scene_trade.c: what `abut trade` is to try: ladders of settings, the expects that count, what is asked of the answer. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/scene_reader.h"
#include "core/suggest.h"
#include "core/trade.h"

/* Threads are a setting of the command line: `-j`. */
static void check_threads(ab_scene_reader *r, const ab_ladder *ladder) {
    bool among = false;
    for (size_t p = 0; p < ladder->path_count; p++) among = among || strcmp(ladder->paths[p], AB_CHILD_THREADS) == 0;
    for (size_t i = 0; i < ladder->value_count && among; i++) {
        char *end;
        const long count = strtol(ladder->values[i], &end, 10);
        if (*end != '\0' || count < 1 || count > 4096)
            ab_report_error(r->base.report, ladder->mark, "threads: '%.64s' is no number of threads from 1 to 4096; write them as 1, 2, 4",
                            ladder->values[i]);
    }
}

/* A new constant may come by --set; one that no formula can know would be a ladder on which nothing changes. */
static bool is_known(ab_scene_reader *r, const ab_node *node, const char *path, const char *text) {
    static const char section[] = "constants.";
    const ab_node *constants = ab_node_find(r->scene->private_->document->root, "constants");
    if (strncmp(text, section, sizeof section - 1) != 0 || constants == NULL || constants->kind != AB_NODE_MAP) return true;
    const char *names[AB_DOCUMENT_KEYS], *name = text + sizeof section - 1;
    for (size_t i = 0; i < constants->count; i++) {
        if (strcmp(constants->entries[i].key, name) == 0) return true;
        names[i] = constants->entries[i].key;
    }
    char tail[AB_TAIL];
    ab_report_error(r->base.report, node->mark, "%s: the scene has no constant '%.64s'%s", path, name,
                    ab_suggest_tail(name, names, constants->count, tail, sizeof tail));
    return false;
}

bool ab_scene_take_paths(ab_scene_reader *r, const ab_node *node, const char *where, const char ***paths, size_t *path_count) {
    const size_t count = node->kind == AB_NODE_LIST ? node->count : 1;
    char path[AB_WHERE];
    ab_where_join(path, where, "set");
    if (count == 0 || count > AB_TRADE_PATHS) {
        ab_report_error(r->base.report, node->mark, "%s names %zu paths; give 1 to %d", path, count, AB_TRADE_PATHS);
        return false;
    }
    *paths = ab_reader_take(&r->base, count, sizeof **paths);
    if (*paths == NULL) return false;
    for (size_t i = 0; i < count; i++) {
        const ab_node *item = node->kind == AB_NODE_LIST ? node->items[i] : node;
        const char *text = ab_scene_word(r, item, path, "a path as for --set, such as constants.cells");
        if (text == NULL || !is_known(r, item, path, text)) return false;
        (*paths)[(*path_count)++] = ab_reader_text(&r->base, text);
    }
    return true;
}

static void take_ladder(ab_scene_reader *r, const ab_node *node, const char *where, ab_ladder *ladder) {
    const ab_node *v[LADDER_KEYS];
    ladder->mark = node->mark;
    if (!ab_section_open(&r->base, &ab_section_ladder, node, where, v) || v[LADDER_SET] == NULL || v[LADDER_VALUES] == NULL) return;
    if (!ab_scene_take_paths(r, v[LADDER_SET], where, &ladder->paths, &ladder->path_count)) return;
    char *name = NULL, path[AB_WHERE];
    ab_read_text(&r->base, &ab_section_ladder.keys[LADDER_NAME], v[LADDER_NAME], where, &name);
    ladder->name = name != NULL ? name : ladder->paths[0];
    const ab_node *values = v[LADDER_VALUES];
    if (!ab_scene_is_list(r, values, ab_where_join(path, where, "values"), "values")) return;
    if (values->count == 0 || values->count > AB_TRADE_VALUES) {
        ab_report_error(r->base.report, values->mark, "%s has %zu values; give 1 to %d", path, values->count, AB_TRADE_VALUES);
        return;
    }
    ladder->values = ab_reader_take(&r->base, values->count, sizeof *ladder->values);
    if (ladder->values == NULL) return;
    for (size_t i = 0; i < values->count; i++) {
        ladder->values[i] = ab_node_flow(r->base.arena, values->items[i]);
        if (ladder->values[i] == NULL) {
            r->base.out_of_memory = true;
            return;
        }
        for (size_t k = 0; k < i; k++)
            if (strcmp(ladder->values[k], ladder->values[i]) == 0)
                ab_report_error(r->base.report, values->items[i]->mark, "%s: %s stands there twice; leave one out", path,
                                ladder->values[i]);
    }
    ladder->value_count = values->count;
    check_threads(r, ladder);
}

static void take_judges(ab_scene_reader *r, const ab_node *node, ab_trade_spec *trade) {
    const ab_scene *scene = r->scene;
    const bool monitors = scene->expect_count == 0; /* then errors are those of monitors */
    const size_t known = monitors ? scene->monitor_count : scene->expect_count;
    if (!ab_scene_is_list(r, node, "trade.error", "names of expects, or of monitors where there are none")) return;
    trade->judges = ab_reader_take(&r->base, node->count, sizeof *trade->judges);
    for (size_t i = 0; i < node->count && trade->judges != NULL; i++) {
        const char *name = ab_scene_word(r, node->items[i], "trade.error", "the name of an expect or monitor"), *names[AB_DOCUMENT_KEYS];
        if (name == NULL) continue;
        size_t found = SIZE_MAX, count = 0;
        for (size_t e = 0; e < known; e++) {
            const char *its = monitors ? scene->monitors[e].name : scene->expects[e].name;
            if (its == NULL) continue;
            if (strcmp(its, name) == 0) found = e;
            if (count < AB_DOCUMENT_KEYS) names[count++] = its;
        }
        char tail[AB_TAIL];
        if (found == SIZE_MAX)
            ab_report_error(r->base.report, node->items[i]->mark, "trade.error: there is no %s '%.64s'%s", monitors ? "monitor" : "expect",
                            name, ab_suggest_tail(name, names, count, tail, sizeof tail));
        else
            trade->judges[trade->judge_count++] = found;
    }
}

/* Of two ladders that set one path the first would change nothing. */
static void check_apart(ab_scene_reader *r, const ab_trade_spec *trade, size_t i) {
    for (size_t k = 0; k < i; k++)
        for (size_t p = 0; p < trade->ladders[i].path_count; p++)
            for (size_t q = 0; q < trade->ladders[k].path_count; q++)
                if (strcmp(trade->ladders[i].paths[p], trade->ladders[k].paths[q]) == 0)
                    ab_report_error(r->base.report, trade->ladders[i].mark,
                                    "trade.vary[%zu]: %s is set by trade.vary[%zu], too, and a run has one value of it; put all its values "
                                    "into one ladder",
                                    i, trade->ladders[i].paths[p], k);
}

void ab_scene_take_trade(ab_scene_reader *r, const ab_node *node) {
    ab_trade_spec *trade = &r->scene->trade;
    const ab_key *key = ab_section_trade.keys;
    const ab_node *v[TRADE_KEYS] = {NULL};
    trade->limit = INFINITY;
    if (node != NULL && !ab_section_open(&r->base, &ab_section_trade, node, "trade", v)) return;
    ab_read_number(&r->base, &key[TRADE_TOLERANCE], v[TRADE_TOLERANCE], "trade", &trade->tolerance);
    ab_read_number(&r->base, &key[TRADE_SECONDS], v[TRADE_SECONDS], "trade", &trade->seconds);
    ab_read_number(&r->base, &key[TRADE_LIMIT], v[TRADE_LIMIT], "trade", &trade->limit);
    char *search = NULL, *cost = NULL;
    ab_read_word(&r->base, &key[TRADE_SEARCH], v[TRADE_SEARCH], "trade", &search);
    ab_read_word(&r->base, &key[TRADE_COST], v[TRADE_COST], "trade", &cost);
    trade->path = search != NULL && strcmp(search, "path") == 0;
    trade->wall = cost != NULL && strcmp(cost, "wall") == 0;
    if (v[TRADE_ERROR] != NULL) take_judges(r, v[TRADE_ERROR], trade);
    const ab_node *vary = v[TRADE_VARY];
    if (vary == NULL || !ab_scene_is_list(r, vary, "trade.vary", "ladders - {set: ..., values: [...]}")) return;
    if (vary->count == 0 || vary->count > AB_TRADE_LADDERS) {
        ab_report_error(r->base.report, vary->mark, "trade.vary has %zu ladders; give 1 to %d", vary->count, AB_TRADE_LADDERS);
        return;
    }
    trade->ladders = ab_reader_take(&r->base, vary->count, sizeof *trade->ladders);
    if (trade->ladders == NULL) return;
    trade->ladder_count = vary->count;
    size_t runs = 1;
    for (size_t i = 0; i < vary->count; i++) {
        char where[AB_WHERE];
        snprintf(where, sizeof where, "trade.vary[%zu]", i);
        take_ladder(r, vary->items[i], where, &trade->ladders[i]);
        check_apart(r, trade, i);
        if (trade->ladders[i].value_count > 0 && runs <= AB_TRADE_RUNS) runs *= trade->ladders[i].value_count;
    }
    if (runs > AB_TRADE_RUNS)
        ab_report_error(r->base.report, vary->mark, "trade.vary makes %zu combinations or more; %d are the most: use shorter ladders", runs,
                        AB_TRADE_RUNS);
}
