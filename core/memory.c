/* memory.c: see memory.h. Arrays of 4 MiB and more are mapped in 2 MiB steps and offered to the system for huge pages. */
#define _GNU_SOURCE
#include "core/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>

enum { HUGE_PAGE = 2 << 20, HUGE_FROM = 4 << 20 };

void *ab_memory_take(size_t bytes) {
    if (bytes > SIZE_MAX / 2) return NULL;
    if (bytes < HUGE_FROM) {
        const size_t rounded = (bytes + 64) / 64 * 64;
        void *pointer = aligned_alloc(64, rounded);
        if (pointer) memset(pointer, 0, rounded);
        return pointer;
    }
    const size_t rounded = (bytes + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE;
    char *raw = mmap(NULL, rounded + HUGE_PAGE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (raw == MAP_FAILED) return NULL;
    char *aligned = (char *)(((uintptr_t)raw + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE);
    if (aligned > raw) munmap(raw, (size_t)(aligned - raw));
    const size_t tail = (size_t)(raw + HUGE_PAGE - aligned);
    if (tail) munmap(aligned + rounded, tail);
    madvise(aligned, rounded, MADV_HUGEPAGE);
    return aligned;
}

void ab_memory_give(void *pointer, size_t bytes) {
    if (!pointer) return;
    if (bytes < HUGE_FROM) {
        free(pointer);
        return;
    }
    munmap(pointer, (bytes + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE);
}

int ab_memory_grow(void **pointer, size_t *capacity, size_t wanted, size_t size) {
    if (wanted <= *capacity) return 1;
    size_t enough = *capacity ? *capacity : 64;
    while (enough < wanted) {
        if (enough > SIZE_MAX / 2) return 0;
        enough *= 2;
    }
    if (enough > SIZE_MAX / 2 / size) return 0;
    void *more = ab_memory_take(enough * size);
    if (!more) return 0;
    if (*pointer) memcpy(more, *pointer, *capacity * size);
    ab_memory_give(*pointer, *capacity * size);
    *pointer = more;
    *capacity = enough;
    return 1;
}

bool ab_memory_resize(void *pointer, size_t count, size_t size) {
    void **p = pointer, *more = count <= SIZE_MAX / 2 / size ? realloc(*p, count * size) : NULL;
    if (more) *p = more;
    return more != NULL;
}

bool ab_memory_append(void *pointer, size_t *capacity, size_t wanted, size_t size) {
    if (wanted <= *capacity) return true;
    if (wanted > SIZE_MAX / 4 || !ab_memory_resize(pointer, 2 * wanted, size)) return false;
    *capacity = 2 * wanted;
    return true;
}

size_t ab_memory_peak(void) {
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (size_t)usage.ru_maxrss * 1024 : 0;
}
