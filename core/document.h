/* document.h: a YAML file as a tree in which every value knows its line and column. Bounded in every direction, so that a hostile file
 * costs little time and memory: size, nesting, number of values after aliases are expanded, length of a text. */
#ifndef AB_DOCUMENT_H
#define AB_DOCUMENT_H

#include "core/arena.h"
#include "core/report.h"

enum ab_document_limits {
    AB_DOCUMENT_BYTES = 16 << 20,
    AB_DOCUMENT_DEPTH = 64,
    AB_DOCUMENT_NODES = 500000,
    AB_DOCUMENT_ANCHORS = 1000,
    AB_DOCUMENT_KEYS = 1000, /* in one mapping */
    AB_DOCUMENT_TEXT = 16384 /* characters of one scalar */
};

typedef enum ab_node_kind { AB_NODE_SCALAR = 1, AB_NODE_LIST, AB_NODE_MAP } ab_node_kind;

typedef struct ab_node ab_node;

typedef struct ab_entry { /* of a mapping */
    const char *key;
    ab_mark mark; /* of the key */
    ab_node *value;
} ab_entry;

struct ab_node {
    ab_node_kind kind;
    bool plain;     /* a scalar without quotes */
    bool override_; /* came by --set; mark.file then is "--set PATH" */
    ab_mark mark;
    const char *text;  /* scalar, closed by NUL, without NUL inside */
    size_t count;      /* of items or entries */
    ab_node **items;   /* list */
    ab_entry *entries; /* mapping, in the order of the file */
    size_t weight;     /* nodes below, itself counted */
};

typedef struct ab_document {
    ab_arena *arena;
    char *path;
    ab_node *root;
    size_t nodes;
} ab_document;

/* Reads a file; `path` is what messages show. On failure the report says why and *document is NULL. */
ab_status ab_document_read(const char *path, ab_document **document, ab_report *report);
/* The same from memory. */
ab_status ab_document_parse(const char *name, const char *bytes, size_t length, ab_document **document, ab_report *report);
void ab_document_destroy(ab_document *document);

/* The value of a key of a mapping, or NULL. */
ab_node *ab_node_find(const ab_node *map, const char *key);
/* True for nothing: an empty plain scalar, ~ or null. */
bool ab_node_is_null(const ab_node *node);
/* "a mapping", "a list", "a text", for messages. */
const char *ab_node_kind_name(const ab_node *node);

/* A value as one line of YAML, as --set takes it, in the arena; NULL: no memory. */
char *ab_node_flow(ab_arena *arena, const ab_node *node);

/* The whole document as YAML, comments left out. */
struct ab_text;
void ab_document_write(struct ab_text *text, const ab_document *document);

/* Puts VALUE (YAML, flow style) at PATH, such as contact[0].friction or bodies.block.fill.per_cell. A last key that is not there is added,
 * mappings on the way too, but for entries that the user names (bodies.NAME, materials.NAME), which must exist. */
ab_status ab_document_set(ab_document *document, const char *path, const char *value, ab_report *report);

/* The value at such a path; NULL: there is none. */
const ab_node *ab_document_get(ab_document *document, const char *path);

#endif
