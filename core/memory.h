/* memory.h: large, zeroed, 64-byte aligned arrays; huge pages where the system gives them; and growing lists. */
#ifndef AB_MEMORY_H
#define AB_MEMORY_H

#include <stdbool.h>
#include <stddef.h>

/* NULL when there is no memory. bytes = 0 gives a valid pointer. */
void *ab_memory_take(size_t bytes);
void ab_memory_give(void *pointer, size_t bytes); /* bytes as taken */

/* Grows *pointer (elements of `size` bytes) so that it holds `wanted`; old content is kept. False when there is no memory: nothing changed. */
int ab_memory_grow(void **pointer, size_t *capacity, size_t wanted, size_t size);

/* Of arrays from malloc, freed by free: `pointer` is the address of the array's pointer, NULL there is an empty array. False when there is no memory: nothing changed.
 * resize: to `count` elements of `size` bytes. append: room for `wanted`, twice that where there is less, so that a list may grow by one. */
bool ab_memory_resize(void *pointer, size_t count, size_t size);
bool ab_memory_append(void *pointer, size_t *capacity, size_t wanted, size_t size);

size_t ab_memory_peak(void); /* bytes resident at most so far, of this process */

#endif
