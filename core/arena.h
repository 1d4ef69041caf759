/* arena.h: many small pieces of memory that live and die together. Zeroed, 16-byte aligned, released all at once. */
#ifndef AB_ARENA_H
#define AB_ARENA_H

#include <stddef.h>

typedef struct ab_arena ab_arena;

ab_arena *ab_arena_create(void);
void ab_arena_destroy(ab_arena *arena);

/* bytes of zeroed memory, or NULL when there is none. A request of 0 bytes gives a valid pointer. */
void *ab_arena_take(ab_arena *arena, size_t bytes);
/* count * size bytes; NULL also when the product overflows. */
void *ab_arena_array(ab_arena *arena, size_t count, size_t size);
/* A copy of `length` characters, closed by a NUL. */
char *ab_arena_text(ab_arena *arena, const char *text, size_t length);

#endif
