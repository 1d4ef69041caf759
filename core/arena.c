/* arena.c: a list of blocks, handed out from the front. */
#include "core/arena.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK_BYTES = 1 << 15, ALIGN = 16 };

typedef struct block {
    struct block *next;
    size_t used, size;
} block;

struct ab_arena {
    block *first;
};

static size_t rounded(size_t bytes) { return (bytes + ALIGN - 1) / ALIGN * ALIGN; }

ab_arena *ab_arena_create(void) { return calloc(1, sizeof(ab_arena)); }

void ab_arena_destroy(ab_arena *arena) {
    if (arena == NULL) return;
    for (block *b = arena->first; b != NULL;) {
        block *next = b->next;
        free(b);
        b = next;
    }
    free(arena);
}

void *ab_arena_take(ab_arena *arena, size_t bytes) {
    if (bytes > SIZE_MAX / 4) return NULL;
    const size_t head = rounded(sizeof(block)), want = rounded(bytes == 0 ? 1 : bytes);
    block *b = arena->first;
    if (b == NULL || b->size - b->used < want) {
        const size_t size = want > BLOCK_BYTES / 4 ? want : (size_t)BLOCK_BYTES - head;
        block *fresh = calloc(1, head + size);
        if (fresh == NULL) return NULL;
        fresh->size = size;
        if (b != NULL && size == want) { /* a large piece has a block of its own; go on filling the present one */
            fresh->next = b->next;
            b->next = fresh;
        } else {
            fresh->next = b;
            arena->first = fresh;
        }
        b = fresh;
    }
    void *piece = (char *)b + head + b->used;
    b->used += want;
    return piece;
}

void *ab_arena_array(ab_arena *arena, size_t count, size_t size) {
    if (size != 0 && count > SIZE_MAX / size) return NULL;
    return ab_arena_take(arena, count * size);
}

char *ab_arena_text(ab_arena *arena, const char *text, size_t length) {
    char *copy = ab_arena_take(arena, length + 1);
    if (copy != NULL) memcpy(copy, text, length);
    return copy;
}
