/* checkpoint_items.c: what is kept in a checkpoint, one item after the other: the same call saves and loads. */
#include <stdlib.h>
#include <string.h>

#include "core/checkpoint_inner.h"

static bool keep(ab_checkpoint *c, const char *name, uint32_t type, void *values, size_t count) {
    if (c->status != AB_OK) return false;
    if (ab_checkpoint_loads(c)) return ab_checkpoint_load(c, name, type, values, count);
    ab_checkpoint_save(c, name, type, values, count);
    return true;
}

bool ab_keep_doubles(ab_checkpoint *c, const char *name, double *values, size_t count) { return keep(c, name, AB_DOUBLES, values, count); }
bool ab_keep_u64(ab_checkpoint *c, const char *name, uint64_t *values, size_t count) { return keep(c, name, AB_U64, values, count); }
bool ab_keep_u32(ab_checkpoint *c, const char *name, uint32_t *values, size_t count) { return keep(c, name, AB_U32, values, count); }
bool ab_keep_bytes(ab_checkpoint *c, const char *name, void *values, size_t count) { return keep(c, name, AB_BYTES, values, count); }

bool ab_keep_flags(ab_checkpoint *c, const char *name, bool *values, size_t count) {
    const ab_checkpoint_record *r = c->status == AB_OK && ab_checkpoint_loads(c) ? ab_checkpoint_find(c, name) : NULL;
    for (size_t k = 0; r != NULL && r->type == AB_BYTES && k < r->count; k++) /* another bit pattern is no bool */
        if (r->values[k] != 0 && r->values[k] != 1) return ab_checkpoint_refuse(c, "'%s%s' is damaged", c->prefix, name);
    if (r != NULL) c->next = (size_t)(r - c->records);
    return keep(c, name, AB_BYTES, values, count);
}

bool ab_keep_size(ab_checkpoint *c, const char *name, size_t *value) {
    uint64_t number = *value;
    if (!keep(c, name, AB_U64, &number, 1)) return false;
    *value = (size_t)number;
    return true;
}

bool ab_keep_long(ab_checkpoint *c, const char *name, long *value) {
    uint64_t number = (uint64_t)*value;
    if (!keep(c, name, AB_U64, &number, 1)) return false;
    *value = (long)number;
    return true;
}

bool ab_keep_count(ab_checkpoint *c, const char *name, size_t *count, size_t each) {
    size_t number = *count;
    if (!ab_keep_size(c, name, &number)) return false;
    if (ab_checkpoint_loads(c)) {
        const ab_checkpoint_record *last = &c->records[c->count - 1];
        const size_t bytes = (size_t)(last->values - c->bytes) + last->count * AB_CHECKPOINT_WIDTH[last->type];
        if (number > bytes / (each > 0 ? each : 1))
            return ab_checkpoint_refuse(c, "'%s%s' is damaged: %zu is more than it has", c->prefix, name, number);
    }
    *count = number;
    return true;
}

bool ab_checkpoint_put(ab_checkpoint *c, const char *name, const void *bytes, size_t count) {
    if (c->status != AB_OK) return false;
    ab_checkpoint_save(c, name, AB_BYTES, bytes, count);
    return true;
}

const void *ab_checkpoint_get(ab_checkpoint *c, const char *name, size_t *count) {
    const ab_checkpoint_record *r = c->status == AB_OK ? ab_checkpoint_find(c, name) : NULL;
    *count = 0;
    if (r == NULL || r->type != AB_BYTES) return NULL;
    *count = r->count;
    return r->values;
}

/* ---- plugins ---------------------------------------------------------------------------------------------------------------- */

typedef struct stream {
    char *bytes;
    size_t count, capacity, at;
} stream;

static int stream_write(void *context, const void *bytes, size_t count) {
    stream *s = context;
    if (count > s->capacity - s->count) {
        const size_t capacity = 2 * (s->count + count) + 256;
        char *more = realloc(s->bytes, capacity);
        if (more == NULL) return -1;
        s->bytes = more;
        s->capacity = capacity;
    }
    if (count > 0) memcpy(s->bytes + s->count, bytes, count);
    s->count += count;
    return 0;
}

static int stream_read(void *context, void *bytes, size_t count) {
    stream *s = context;
    if (count > s->count - s->at) return -1;
    if (count > 0) memcpy(bytes, s->bytes + s->at, count);
    s->at += count;
    return 0;
}

bool ab_keep_plugin(ab_checkpoint *c, const char *name, const ab_class *class_, void *self) {
    if (c->status != AB_OK) return false;
    if (class_->save == NULL) return true;
    stream s = {0};
    const ab_stream given = {sizeof given, &s, stream_write, stream_read};
    if (ab_checkpoint_loads(c)) {
        s.bytes = (char *)(uintptr_t)ab_checkpoint_get(c, name, &s.count);
        if (s.bytes == NULL) return ab_checkpoint_refuse(c, "has no '%s%s'", c->prefix, name);
        if (class_->load(self, &given) != 0 || s.at != s.count)
            return ab_checkpoint_refuse(c, "plugin '%s' cannot read its own part of it, '%s%s'", class_->name, c->prefix, name);
        return true;
    }
    const bool good = class_->save(self, &given) == 0;
    if (good) ab_checkpoint_save(c, name, AB_BYTES, s.bytes, s.count);
    free(s.bytes);
    return good || ab_checkpoint_refuse(c, "plugin '%s' cannot save its state ('%s%s')", class_->name, c->prefix, name);
}
