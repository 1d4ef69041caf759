/* document.c: libyaml's events -> a tree of nodes, with every limit checked before memory is spent. */
#include "core/document.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <yaml.h>

typedef struct anchor {
    const char *name;
    ab_node *node; /* NULL while its value is still being read */
} anchor;

typedef struct builder {
    ab_document *document;
    const char *file;
    yaml_parser_t parser;
    const char *bytes; /* the text that is parsed */
    size_t length;
    ab_report *report;
    anchor anchors[AB_DOCUMENT_ANCHORS];
    size_t anchor_count;
} builder;

typedef struct growing { /* children of a node that is being read */
    ab_entry *entries;
    size_t count, capacity;
} growing;

static ab_status no_memory(ab_report *report) { return ab_report_failure(report, "no memory left while reading the scene"); }

static ab_mark place(const builder *b, yaml_mark_t mark) { return (ab_mark){b->file, (int)mark.line + 1, (int)mark.column + 1}; }

static ab_status new_node(builder *b, ab_node_kind kind, ab_mark mark, ab_node **node) {
    if (++b->document->nodes > AB_DOCUMENT_NODES)
        return ab_report_error(b->report, mark, "the file has more than %d values; a scene needs far fewer", AB_DOCUMENT_NODES);
    *node = ab_arena_take(b->document->arena, sizeof **node);
    if (*node == NULL) return no_memory(b->report);
    (*node)->kind = kind;
    (*node)->mark = mark;
    (*node)->weight = 1;
    return AB_OK;
}

/* A copy of a tree, so that an override of one place does not change another that was written as an alias. Its weight was checked. */
static ab_node *copied(ab_document *document, const ab_node *from) {
    ab_node *node = ab_arena_take(document->arena, sizeof *node);
    if (node == NULL) return NULL;
    *node = *from;
    if (from->kind == AB_NODE_LIST) {
        node->items = ab_arena_array(document->arena, from->count, sizeof *node->items);
        if (node->items == NULL) return NULL;
        for (size_t i = 0; i < from->count; i++)
            if ((node->items[i] = copied(document, from->items[i])) == NULL) return NULL;
    }
    if (from->kind == AB_NODE_MAP) {
        node->entries = ab_arena_array(document->arena, from->count, sizeof *node->entries);
        if (node->entries == NULL) return NULL;
        for (size_t i = 0; i < from->count; i++) {
            node->entries[i] = from->entries[i];
            if ((node->entries[i].value = copied(document, from->entries[i].value)) == NULL) return NULL;
        }
    }
    return node;
}

static anchor *anchor_named(builder *b, const char *name) {
    for (size_t i = b->anchor_count; i > 0; i--) /* the latest of that name */
        if (strcmp(b->anchors[i - 1].name, name) == 0) return &b->anchors[i - 1];
    return NULL;
}

/* Remembers the anchor of a node that begins; *index is where, or SIZE_MAX. */
static ab_status open_anchor(builder *b, const yaml_char_t *name, ab_mark mark, size_t *index) {
    *index = SIZE_MAX;
    if (name == NULL) return AB_OK;
    if (b->anchor_count == AB_DOCUMENT_ANCHORS)
        return ab_report_error(b->report, mark, "the file has more than %d anchors (&name)", AB_DOCUMENT_ANCHORS);
    const char *copy = ab_arena_text(b->document->arena, (const char *)name, strlen((const char *)name));
    if (copy == NULL) return no_memory(b->report);
    *index = b->anchor_count++;
    b->anchors[*index] = (anchor){copy, NULL};
    return AB_OK;
}

static ab_status resolve_alias(builder *b, const char *name, ab_mark mark, ab_node **node) {
    const anchor *found = anchor_named(b, name);
    if (found == NULL) return ab_report_error(b->report, mark, "alias '*%.64s' has no anchor '&%.64s' before it", name, name);
    if (found->node == NULL)
        return ab_report_error(b->report, mark, "alias '*%.64s' stands inside its own anchor, so the value would contain itself", name);
    if (found->node->weight > AB_DOCUMENT_NODES - b->document->nodes)
        return ab_report_error(b->report, mark, "with its aliases written out the file has more than %d values; '*%.64s' is refused",
                               AB_DOCUMENT_NODES, name);
    b->document->nodes += found->node->weight;
    *node = copied(b->document, found->node);
    return *node == NULL ? no_memory(b->report) : AB_OK;
}

/* True where the place is in an indentation that has a tab at or before it. */
static bool tab_indents(const builder *b, ab_mark mark) {
    const char *c = b->bytes, *end = b->bytes + b->length;
    for (int line = 1; line < mark.line && c != NULL; line++) c = memchr(c, '\n', (size_t)(end - c)), c = c == NULL ? NULL : c + 1;
    for (int column = 1; c != NULL && c < end && column <= mark.column && (*c == ' ' || *c == '\t'); column++, c++)
        if (*c == '\t') return true;
    return false;
}

/* The next event, or the syntax error in libyaml's words. */
static ab_status next_event(builder *b, yaml_event_t *event) {
    if (yaml_parser_parse(&b->parser, event)) return AB_OK;
    const char *problem = b->parser.problem == NULL ? "not YAML" : b->parser.problem;
    if (b->parser.error == YAML_MEMORY_ERROR) return no_memory(b->report);
    if (b->parser.error == YAML_READER_ERROR)
        return ab_report_error(b->report, (ab_mark){b->file, 0, 0}, "not readable as YAML: %s", problem);
    const ab_mark mark = place(b, b->parser.problem_mark);
    if (tab_indents(b, mark)) return ab_report_error(b->report, mark, "not YAML: a tab; indent with spaces");
    if (b->parser.context != NULL)
        return ab_report_error(b->report, mark, "not YAML: %s (%s that began in line %d)", problem, b->parser.context,
                               (int)b->parser.context_mark.line + 1);
    return ab_report_error(b->report, mark, "not YAML: %s", problem);
}

static ab_status grow(builder *b, growing *children, ab_entry entry) {
    if (children->count == children->capacity) {
        const size_t capacity = children->capacity == 0 ? 8 : children->capacity * 2;
        ab_entry *entries = realloc(children->entries, capacity * sizeof *entries);
        if (entries == NULL) return no_memory(b->report);
        children->entries = entries;
        children->capacity = capacity;
    }
    children->entries[children->count++] = entry;
    return AB_OK;
}

static ab_status read_node(builder *b, const yaml_event_t *event, int depth, ab_node **node);

static ab_status read_scalar(builder *b, const yaml_event_t *event, ab_node *node) {
    const size_t length = event->data.scalar.length;
    if (length > AB_DOCUMENT_TEXT)
        return ab_report_error(b->report, node->mark, "a text of %zu characters; the longest allowed is %d", length, AB_DOCUMENT_TEXT);
    if (memchr(event->data.scalar.value, '\0', length) != NULL)
        return ab_report_error(b->report, node->mark, "a NUL character inside a text");
    node->text = ab_arena_text(b->document->arena, (const char *)event->data.scalar.value, length);
    node->plain = event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    return node->text == NULL ? no_memory(b->report) : AB_OK;
}

static ab_status read_list(builder *b, ab_node *node, int depth, growing *children) {
    for (;;) {
        yaml_event_t event;
        AB_TRY(next_event(b, &event));
        if (event.type == YAML_SEQUENCE_END_EVENT) {
            yaml_event_delete(&event);
            break;
        }
        ab_entry entry = {NULL, node->mark, NULL};
        ab_status status = read_node(b, &event, depth + 1, &entry.value);
        yaml_event_delete(&event);
        if (status == AB_OK) status = grow(b, children, entry);
        AB_TRY(status);
    }
    node->count = children->count;
    node->items = ab_arena_array(b->document->arena, node->count, sizeof *node->items);
    if (node->items == NULL) return no_memory(b->report);
    for (size_t i = 0; i < node->count; i++) {
        node->items[i] = children->entries[i].value;
        node->weight += node->items[i]->weight;
    }
    return AB_OK;
}

static ab_status check_key(builder *b, const ab_node *key, const growing *children) {
    if (key->kind != AB_NODE_SCALAR)
        return ab_report_error(b->report, key->mark, "a key must be a plain word, not %s", ab_node_kind_name(key));
    if (key->text[0] == '\0') return ab_report_error(b->report, key->mark, "an empty key");
    if (key->plain && strcmp(key->text, "<<") == 0)
        return ab_report_error(b->report, key->mark, "merge keys '<<' are not read; use an alias for a whole value or write the keys out");
    if (children->count >= AB_DOCUMENT_KEYS)
        return ab_report_error(b->report, key->mark, "more than %d keys in one mapping", AB_DOCUMENT_KEYS);
    return AB_OK;
}

static ab_status read_map(builder *b, ab_node *node, int depth, growing *children) {
    for (;;) {
        yaml_event_t event;
        AB_TRY(next_event(b, &event));
        if (event.type == YAML_MAPPING_END_EVENT) {
            yaml_event_delete(&event);
            break;
        }
        ab_node *key = NULL;
        ab_status status = read_node(b, &event, depth + 1, &key);
        yaml_event_delete(&event);
        if (status == AB_OK) status = check_key(b, key, children);
        AB_TRY(status);
        AB_TRY(next_event(b, &event));
        ab_entry entry = {key->text, key->mark, NULL};
        status = read_node(b, &event, depth + 1, &entry.value);
        yaml_event_delete(&event);
        AB_TRY(status);
        const ab_entry *twin = NULL;
        for (size_t i = 0; i < children->count && twin == NULL; i++)
            if (strcmp(children->entries[i].key, entry.key) == 0) twin = &children->entries[i];
        if (twin != NULL) { /* said, and reading goes on: the rest may have mistakes as well */
            ab_report_error(b->report, entry.mark, "key '%.64s' stands twice; it was given in line %d already", entry.key, twin->mark.line);
            continue;
        }
        AB_TRY(grow(b, children, entry));
    }
    node->count = children->count;
    node->entries = ab_arena_array(b->document->arena, node->count, sizeof *node->entries);
    if (node->entries == NULL) return no_memory(b->report);
    for (size_t i = 0; i < node->count; i++) {
        node->entries[i] = children->entries[i];
        node->weight += 1 + node->entries[i].value->weight;
    }
    return AB_OK;
}

/* The node that begins with `event`, all of it. */
static ab_status read_node(builder *b, const yaml_event_t *event, int depth, ab_node **node) {
    const ab_mark mark = place(b, event->start_mark);
    if (depth > AB_DOCUMENT_DEPTH) return ab_report_error(b->report, mark, "nested deeper than %d levels", AB_DOCUMENT_DEPTH);
    if (event->type == YAML_ALIAS_EVENT) return resolve_alias(b, (const char *)event->data.alias.anchor, mark, node);
    const yaml_char_t *name = NULL, *tag = NULL;
    ab_node_kind kind = AB_NODE_SCALAR;
    if (event->type == YAML_SCALAR_EVENT) {
        name = event->data.scalar.anchor;
        tag = event->data.scalar.tag;
    } else if (event->type == YAML_SEQUENCE_START_EVENT) {
        kind = AB_NODE_LIST;
        name = event->data.sequence_start.anchor;
        tag = event->data.sequence_start.tag;
    } else if (event->type == YAML_MAPPING_START_EVENT) {
        kind = AB_NODE_MAP;
        name = event->data.mapping_start.anchor;
        tag = event->data.mapping_start.tag;
    } else {
        return ab_report_error(b->report, mark, "not YAML: a value is missing here");
    }
    if (tag != NULL) return ab_report_error(b->report, mark, "tags are not used in scenes; leave '%.64s' out", (const char *)tag);
    size_t index = SIZE_MAX;
    AB_TRY(open_anchor(b, name, mark, &index));
    AB_TRY(new_node(b, kind, mark, node));
    if (kind == AB_NODE_SCALAR) {
        AB_TRY(read_scalar(b, event, *node));
    } else {
        growing children = {NULL, 0, 0};
        const ab_status status = kind == AB_NODE_LIST ? read_list(b, *node, depth, &children) : read_map(b, *node, depth, &children);
        free(children.entries);
        AB_TRY(status);
    }
    if (index != SIZE_MAX) b->anchors[index].node = *node;
    return AB_OK;
}

static ab_status read_stream(builder *b) {
    bool in_document = false, ended = false;
    while (!ended) {
        yaml_event_t event;
        AB_TRY(next_event(b, &event));
        ab_status status = AB_OK;
        const ab_mark mark = place(b, event.start_mark);
        switch (event.type) {
        case YAML_STREAM_END_EVENT: ended = true; break;
        case YAML_DOCUMENT_START_EVENT:
            if (in_document)
                status = ab_report_error(b->report, mark, "a second document begins here; a scene is one document, so leave the '---' out");
            in_document = true;
            break;
        case YAML_STREAM_START_EVENT:
        case YAML_DOCUMENT_END_EVENT: break;
        default: status = read_node(b, &event, 1, &b->document->root); break;
        }
        yaml_event_delete(&event);
        AB_TRY(status);
    }
    if (b->document->root == NULL)
        return ab_report_error(b->report, (ab_mark){b->file, 0, 0}, "the file is empty; docs/scene.md shows what a scene holds");
    return AB_OK;
}

/* Length of the UTF-8 character at the front of `left` bytes; 0 when it is not one. */
static size_t utf8_length(const unsigned char *s, size_t left) {
    size_t n = s[0] < 0x80 ? 1 : s[0] >= 0xC2 && s[0] < 0xE0 ? 2 : s[0] >= 0xE0 && s[0] < 0xF0 ? 3 : s[0] >= 0xF0 && s[0] < 0xF5 ? 4 : 0;
    if (n == 0 || n > left) return 0;
    for (size_t i = 1; i < n; i++)
        if ((s[i] & 0xC0) != 0x80) return 0;
    if (n == 3 && ((s[0] == 0xE0 && s[1] < 0xA0) || (s[0] == 0xED && s[1] > 0x9F))) return 0;
    if (n == 4 && ((s[0] == 0xF0 && s[1] < 0x90) || (s[0] == 0xF4 && s[1] > 0x8F))) return 0;
    return n;
}

/* The bytes must be text in UTF-8 without control characters; the first that is not is named with its place. */
static ab_status check_text(const char *file, const char *bytes, size_t length, ab_report *report) {
    const unsigned char *s = (const unsigned char *)bytes;
    ab_mark mark = {file, 1, 1};
    if (length >= 2 && ((s[0] == 0xFF && s[1] == 0xFE) || (s[0] == 0xFE && s[1] == 0xFF)))
        return ab_report_error(report, mark, "the file is in UTF-16; save it as UTF-8");
    for (size_t i = 0; i < length;) {
        const size_t n = utf8_length(s + i, length - i);
        if (n == 0) return ab_report_error(report, mark, "byte 0x%02X is not UTF-8; save the file as UTF-8", s[i]);
        if (s[i] == 0) return ab_report_error(report, mark, "a NUL character; this does not look like a text file");
        if ((s[i] < 32 && s[i] != '\n' && s[i] != '\r' && s[i] != '\t') || s[i] == 127)
            return ab_report_error(report, mark, "control character 0x%02X; remove it", s[i]);
        mark.column++;
        if (s[i] == '\n') mark = (ab_mark){file, mark.line + 1, 1};
        i += n;
    }
    return AB_OK;
}

ab_status ab_document_parse(const char *name, const char *bytes, size_t length, ab_document **document, ab_report *report) {
    *document = NULL;
    if (length >= 3 && memcmp(bytes, "\xEF\xBB\xBF", 3) == 0) bytes += 3, length -= 3; /* a byte order mark says nothing in UTF-8 */
    if (length > AB_DOCUMENT_BYTES)
        return ab_report_error(report, (ab_mark){name, 0, 0}, "the file has %zu bytes; the largest scene allowed is %d MiB", length,
                               AB_DOCUMENT_BYTES >> 20);
    AB_TRY(check_text(name, bytes, length, report));
    ab_document *made = calloc(1, sizeof *made);
    builder *b = calloc(1, sizeof *b);
    ab_status status = AB_OK;
    if (made == NULL || b == NULL || (made->arena = ab_arena_create()) == NULL ||
        (made->path = ab_arena_text(made->arena, name, strlen(name))) == NULL || !yaml_parser_initialize(&b->parser)) {
        status = no_memory(report);
    } else {
        b->document = made;
        b->file = made->path;
        b->bytes = bytes;
        b->length = length;
        b->report = report;
        yaml_parser_set_encoding(&b->parser, YAML_UTF8_ENCODING);
        yaml_parser_set_input_string(&b->parser, (const unsigned char *)bytes, length);
        status = read_stream(b);
        yaml_parser_delete(&b->parser);
    }
    free(b);
    if (status != AB_OK) {
        ab_document_destroy(made);
        return status;
    }
    *document = made;
    return AB_OK;
}

ab_status ab_document_read(const char *path, ab_document **document, ab_report *report) {
    *document = NULL;
    const ab_mark mark = {path, 0, 0};
    struct stat facts;
    if (stat(path, &facts) != 0) return ab_report_error(report, mark, "cannot be read: %s", strerror(errno));
    if (S_ISDIR(facts.st_mode)) return ab_report_error(report, mark, "is a folder; name the scene file in it, such as %s/scene.yaml", path);
    if (S_ISREG(facts.st_mode) && facts.st_size > AB_DOCUMENT_BYTES)
        return ab_report_error(report, mark, "has %lld bytes; the largest scene allowed is %d MiB", (long long)facts.st_size,
                               AB_DOCUMENT_BYTES >> 20);
    FILE *file = fopen(path, "rb");
    if (file == NULL) return ab_report_error(report, mark, "cannot be read: %s", strerror(errno));
    size_t length = 0, capacity = 1 << 14;
    char *bytes = malloc(capacity);
    while (bytes != NULL && length <= AB_DOCUMENT_BYTES) { /* one byte more than allowed is enough to know: a pipe has no size */
        const size_t got = fread(bytes + length, 1, capacity - length, file);
        length += got;
        if (got == 0) break;
        if (length == capacity) {
            char *larger = realloc(bytes, capacity *= 2);
            if (larger == NULL) free(bytes);
            bytes = larger;
        }
    }
    const bool failed = ferror(file) != 0;
    const int reason = errno;
    fclose(file);
    ab_status status = AB_OK;
    if (bytes == NULL)
        status = no_memory(report);
    else if (failed)
        status = ab_report_error(report, mark, "cannot be read: %s", strerror(reason));
    else
        status = ab_document_parse(path, bytes, length, document, report);
    free(bytes);
    return status;
}

void ab_document_destroy(ab_document *document) {
    if (document == NULL) return;
    ab_arena_destroy(document->arena);
    free(document);
}

ab_node *ab_node_find(const ab_node *map, const char *key) {
    if (map == NULL || map->kind != AB_NODE_MAP) return NULL;
    for (size_t i = 0; i < map->count; i++)
        if (strcmp(map->entries[i].key, key) == 0) return map->entries[i].value;
    return NULL;
}

bool ab_node_is_null(const ab_node *node) {
    return node->kind == AB_NODE_SCALAR && node->plain &&
           (node->text[0] == '\0' || strcmp(node->text, "~") == 0 || strcmp(node->text, "null") == 0 || strcmp(node->text, "Null") == 0 ||
            strcmp(node->text, "NULL") == 0);
}

const char *ab_node_kind_name(const ab_node *node) {
    if (node->kind == AB_NODE_MAP) return "a mapping {...}";
    if (node->kind == AB_NODE_LIST) return "a list [...]";
    return ab_node_is_null(node) ? "nothing" : "a single value";
}
