/* document_set.c: --set PATH=VALUE, put into the tree as if the file had said so. */
#include "core/document.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "core/suggest.h"

enum { MOST_STEPS = 32 };

static const ab_mark mark_set = {"--set", 0, 0};

typedef struct step { /* one piece of a path: a key, or an index */
    const char *key;
    size_t index;
    bool is_index;
    size_t end; /* characters of the path up to and with this piece */
} step;

static ab_status no_memory(ab_report *report) { return ab_report_failure(report, "no memory left while reading --set"); }

static ab_status split(ab_arena *arena, const char *path, step *steps, size_t *count, ab_report *report) {
    *count = 0;
    const char *c = path;
    while (*c != '\0') {
        if (*count == MOST_STEPS) return ab_report_error(report, mark_set, "path '%.64s...' has more than %d steps", path, MOST_STEPS);
        step *s = &steps[(*count)++];
        if (*c == '[') {
            char *end = NULL;
            const unsigned long index = isdigit((unsigned char)c[1]) ? strtoul(c + 1, &end, 10) : 0;
            if (end == NULL || *end != ']' || end - c > 9)
                return ab_report_error(report, mark_set, "path '%s': after '[' a number and ']' must stand, as in contact[0].friction",
                                       path);
            *s = (step){NULL, index, true, (size_t)(end + 1 - path)};
            c = end + 1;
        } else {
            const size_t length = strcspn(c, ".[");
            if (length == 0)
                return ab_report_error(report, mark_set, "path '%s': a key is missing at character %d", path, (int)(c - path) + 1);
            *s = (step){ab_arena_text(arena, c, length), 0, false, (size_t)(c - path) + length};
            if (s->key == NULL) return no_memory(report);
            c += length;
        }
        if (*c == '.') {
            c++;
            if (*c == '\0' || *c == '[') return ab_report_error(report, mark_set, "path '%s': a key is missing after '.'", path);
        } else if (*c != '\0' && *c != '[') {
            return ab_report_error(report, mark_set, "path '%s': '.' is missing at character %d", path, (int)(c - path) + 1);
        }
    }
    if (*count == 0) return ab_report_error(report, mark_set, "the path is empty; write --set constants.mu=0.2");
    return AB_OK;
}

/* Makes a tree as if it had come from the command line; `mark` names the --set it came by. */
static void stamp(ab_node *node, ab_mark mark) {
    node->mark = mark;
    node->override_ = true;
    for (size_t i = 0; i < node->count; i++) {
        if (node->kind == AB_NODE_LIST) stamp(node->items[i], mark);
        if (node->kind == AB_NODE_MAP) {
            node->entries[i].mark = mark;
            stamp(node->entries[i].value, mark);
        }
    }
}

static ab_node *copied(ab_arena *arena, const ab_node *from) {
    ab_node *node = ab_arena_take(arena, sizeof *node);
    if (node == NULL) return NULL;
    *node = *from;
    if (from->kind == AB_NODE_SCALAR) {
        node->text = ab_arena_text(arena, from->text, strlen(from->text));
        return node->text == NULL ? NULL : node;
    }
    node->items = from->kind == AB_NODE_LIST ? ab_arena_array(arena, from->count, sizeof *node->items) : NULL;
    node->entries = from->kind == AB_NODE_MAP ? ab_arena_array(arena, from->count, sizeof *node->entries) : NULL;
    if (node->items == NULL && node->entries == NULL) return NULL;
    for (size_t i = 0; i < from->count; i++) {
        if (from->kind == AB_NODE_LIST) {
            if ((node->items[i] = copied(arena, from->items[i])) == NULL) return NULL;
        } else {
            const char *key = from->entries[i].key;
            node->entries[i].key = ab_arena_text(arena, key, strlen(key));
            node->entries[i].value = copied(arena, from->entries[i].value);
            if (node->entries[i].key == NULL || node->entries[i].value == NULL) return NULL;
        }
    }
    return node;
}

static ab_status value_node(ab_document *document, const char *path, const char *value, ab_mark mark, ab_node **node, ab_report *report) {
    ab_document *small = NULL;
    const size_t blank = strspn(value, " \t");
    if (value[blank] == '\0') return ab_report_error(report, mark_set, "%s: the value after '=' is missing", path);
    ab_report *own = ab_report_create();
    if (own == NULL) return no_memory(report);
    ab_status status = ab_document_parse("--set", value, strlen(value), &small, own);
    if (ab_report_errors(own) > 0) {
        const char *text = ab_report_text(own, 0), *why = text == NULL ? NULL : strstr(text, "error: ");
        status =
            ab_report_error(report, mark_set, "%s: the value '%.200s' cannot be read: %s", path, value, why == NULL ? "not YAML" : why + 7);
    }
    ab_report_destroy(own);
    if (status == AB_OK) {
        *node = copied(document->arena, small->root);
        if (*node == NULL)
            status = no_memory(report);
        else
            stamp(*node, mark);
    }
    ab_document_destroy(small);
    return status;
}

static ab_status add_entry(ab_document *document, ab_node *map, const char *key, ab_mark mark, ab_node *value, ab_report *report) {
    if (map->count >= AB_DOCUMENT_KEYS) return ab_report_error(report, mark_set, "more than %d keys in one mapping", AB_DOCUMENT_KEYS);
    ab_entry *entries = ab_arena_array(document->arena, map->count + 1, sizeof *entries);
    if (entries == NULL) return no_memory(report);
    if (map->count > 0) memcpy(entries, map->entries, map->count * sizeof *entries);
    entries[map->count] = (ab_entry){key, mark, value};
    map->entries = entries;
    map->count++;
    return AB_OK;
}

/* Where a step leads inside `node`: the slot that holds the value, or NULL with *status set. A key that is missing is added with `fresh`. */
static ab_node **slot(ab_document *document, ab_node *node, const step *s, const char *path, size_t before, bool may_add, ab_node *fresh,
                      ab_status *status, ab_report *report) {
    const int shown = (int)before;
    char tail[1024];
    if (s->is_index) {
        if (node->kind == AB_NODE_LIST && s->index < node->count) return &node->items[s->index];
        if (node->kind == AB_NODE_LIST && node->count > 0)
            *status = ab_report_error(report, mark_set, "%s: '%.*s' has %zu entries, [0] to [%zu]", path, shown, path, node->count,
                                      node->count - 1);
        else
            *status = ab_report_error(report, mark_set, "%s: '%.*s' is %s, so it has no [%zu]", path, shown, path,
                                      node->kind == AB_NODE_LIST ? "an empty list" : ab_node_kind_name(node), s->index);
        return NULL;
    }
    if (node->kind != AB_NODE_MAP) {
        *status = ab_report_error(report, mark_set, "%s: '%.*s' is %s, so it has no key '%s'%s", path, shown, path, ab_node_kind_name(node),
                                  s->key, node->kind == AB_NODE_LIST ? "; write [0], [1] ..." : "; set it as a whole");
        return NULL;
    }
    for (size_t i = 0; i < node->count; i++)
        if (strcmp(node->entries[i].key, s->key) == 0) return &node->entries[i].value;
    if (!may_add) {
        const char *names[AB_DOCUMENT_KEYS];
        for (size_t i = 0; i < node->count; i++) names[i] = node->entries[i].key;
        char place[80] = "at the top level";
        if (shown > 0) snprintf(place, sizeof place, "in '%.*s'", shown < 64 ? shown : 64, path);
        *status = ab_report_error(report, mark_set, "%s: there is no '%s' %s%s", path, s->key, place,
                                  ab_suggest_tail(s->key, names, node->count, tail, sizeof tail));
        return NULL;
    }
    *status = add_entry(document, node, s->key, fresh->mark, fresh, report);
    return *status == AB_OK ? &node->entries[node->count - 1].value : NULL;
}

ab_status ab_document_set(ab_document *document, const char *path, const char *value, ab_report *report) {
    if (strlen(path) > 1000) return ab_report_error(report, mark_set, "a path of %zu characters", strlen(path));
    step steps[MOST_STEPS];
    size_t count = 0;
    AB_TRY(split(document->arena, path, steps, &count, report));
    char name[1100];
    snprintf(name, sizeof name, "--set %s", path);
    const ab_mark mark = {ab_arena_text(document->arena, name, strlen(name)), 0, 0};
    if (mark.file == NULL) return no_memory(report);
    ab_node *fresh = NULL;
    AB_TRY(value_node(document, path, value, mark, &fresh, report));
    ab_node *node = document->root;
    ab_node **at = NULL;
    for (size_t i = 0; i < count; i++) {
        const bool last = i + 1 == count;
        ab_node *next = fresh;
        if (!last) {
            next = ab_arena_take(document->arena, sizeof *next);
            if (next == NULL) return no_memory(report);
            *next = (ab_node){.kind = AB_NODE_MAP, .mark = mark, .override_ = true, .weight = 1};
        }
        const bool named_by_user =
            i == 1 && !steps[0].is_index && (strcmp(steps[0].key, "bodies") == 0 || strcmp(steps[0].key, "materials") == 0);
        const bool may_add = last || (!named_by_user && !steps[i + 1].is_index);
        ab_status status = AB_OK;
        at = slot(document, node, &steps[i], path, i == 0 ? 0 : steps[i - 1].end, may_add, next, &status, report);
        if (at == NULL) return status;
        node = *at;
    }
    *at = fresh;
    return AB_OK;
}

const ab_node *ab_document_get(ab_document *document, const char *path) {
    ab_report *own = ab_report_create(); /* what is not there is no mistake */
    if (own == NULL) return NULL;
    step steps[MOST_STEPS];
    size_t count = 0;
    ab_status status = split(document->arena, path, steps, &count, own);
    ab_node *node = status == AB_OK ? document->root : NULL;
    for (size_t i = 0; node != NULL && i < count; i++) {
        ab_node **at = slot(document, node, &steps[i], path, i == 0 ? 0 : steps[i - 1].end, false, NULL, &status, own);
        node = at != NULL ? *at : NULL;
    }
    ab_report_destroy(own);
    return node;
}
