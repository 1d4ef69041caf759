/* checkpoint_inner.h: the insides of a checkpoint, for checkpoint.c and checkpoint_items.c only. */
#ifndef AB_CHECKPOINT_INNER_H
#define AB_CHECKPOINT_INNER_H

#include "core/checkpoint.h"

enum { AB_CHECKPOINT_ITEM = 400 }; /* bytes of the name of an item, at most */

enum { AB_DOUBLES = 1, AB_U64, AB_U32, AB_BYTES };
static const size_t AB_CHECKPOINT_WIDTH[] = {0, 8, 8, 4, 1};

typedef struct ab_checkpoint_record {
    const char *name;
    size_t length;
    uint32_t type;
    size_t count;
    const char *values;
} ab_checkpoint_record;

struct ab_checkpoint {
    char *path, *part; /* part: where it is written; NULL when it is read */
    ab_report *report;
    ab_status status;
    char prefix[AB_CHECKPOINT_ITEM];
    size_t depth, depths[8];
    /* writing */
    int file;
    int error; /* errno of the first write that failed */
    char *buffer;
    size_t buffered;
    uint64_t written;
    uint32_t crc;
    /* reading */
    char *bytes;
    ab_checkpoint_record *records;
    size_t count, next; /* next: most likely wanted */
};

/* Behind what is there. */
void ab_checkpoint_save(ab_checkpoint *, const char *name, uint32_t type, const void *values, size_t count);
/* Items are asked for in the order in which they were saved, but for those that somebody passes over. NULL: there is none. */
const ab_checkpoint_record *ab_checkpoint_find(ab_checkpoint *, const char *name);
bool ab_checkpoint_load(ab_checkpoint *, const char *name, uint32_t type, void *values, size_t count);

#endif
