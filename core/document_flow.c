/* document_flow.c: a value of a document written back as one line of YAML: what --set takes. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "core/document.h"
#include "core/files.h"

/* A plain scalar that means the same in the middle of a flow list. */
static bool may_stay_plain(const ab_node *node) { return node->plain && node->text[0] != '\0' && strpbrk(node->text, ",[]{}:#\n") == NULL; }

static void write(ab_text *text, const ab_node *node) {
    if (node->kind == AB_NODE_SCALAR) {
        if (may_stay_plain(node))
            ab_text_add(text, "%s", node->text);
        else
            ab_text_add_escaped(text, node->text); /* a JSON string is a YAML string */
        return;
    }
    const bool list = node->kind == AB_NODE_LIST;
    ab_text_add(text, list ? "[" : "{");
    for (size_t i = 0; i < node->count; i++) {
        if (i > 0) ab_text_add(text, ", ");
        if (!list) ab_text_add(text, "%s: ", node->entries[i].key);
        write(text, list ? node->items[i] : node->entries[i].value);
    }
    ab_text_add(text, list ? "]" : "}");
}

char *ab_node_flow(ab_arena *arena, const ab_node *node) {
    ab_text text = {0};
    write(&text, node);
    char *line = text.failed ? NULL : ab_arena_text(arena, text.bytes, text.count);
    ab_text_clear(&text);
    return line;
}

void ab_document_write(ab_text *text, const ab_document *document) {
    const ab_node *root = document->root;
    for (size_t i = 0; root->kind == AB_NODE_MAP && i < root->count; i++) {
        const ab_node *value = root->entries[i].value;
        ab_text_add(text, "%s:", root->entries[i].key);
        const bool inner = value->kind != AB_NODE_SCALAR && value->count > 0;
        if (!inner) ab_text_add(text, " ");
        for (size_t k = 0; inner && k < value->count; k++) {
            if (value->kind == AB_NODE_LIST)
                ab_text_add(text, "\n  - ");
            else
                ab_text_add(text, "\n  %s: ", value->entries[k].key);
            write(text, value->kind == AB_NODE_LIST ? value->items[k] : value->entries[k].value);
        }
        if (!inner) write(text, value);
        ab_text_add(text, "\n");
    }
}
