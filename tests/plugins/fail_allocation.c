/* fail_allocation.c: for LD_PRELOAD: allocation number $FAIL_AT (from 0) of the program fails, all others go through; how many there were is appended to $FAIL_COUNT_FILE. Counts
 * only what the program and its plugins ask for themselves: what libraries do with a failure inside is theirs. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);

static atomic_long asked;
static long fail_at = -1;
static uintptr_t low, high; /* of the program's code */

static void find_code(void);

static __attribute__((constructor)) void begin(void) {
    const char *at = getenv("FAIL_AT");
    fail_at = at ? atol(at) : -1;
    find_code();
}

static __attribute__((destructor)) void end(void) {
    const char *path = getenv("FAIL_COUNT_FILE");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (file) fprintf(file, "%ld\n", atomic_load(&asked)), fclose(file);
}

/* The main program's mappings, from /proc/self/maps: the first file in it. */
static void find_code(void) {
    char line[4400], name[4096] = "", first[4096] = "";
    FILE *maps = fopen("/proc/self/maps", "r");
    while (maps && fgets(line, sizeof line, maps)) {
        unsigned long from = 0, to = 0;
        name[0] = '\0';
        if (sscanf(line, "%lx-%lx %*s %*s %*s %*s %4095s", &from, &to, name) < 2) continue;
        if (!first[0]) strcpy(first, name), low = from;
        if (strcmp(first, name) == 0) high = to;
    }
    if (maps) fclose(maps);
}

static int fails(const void *caller) {
    if ((uintptr_t)caller < low || (uintptr_t)caller >= high) return 0;
    return atomic_fetch_add(&asked, 1) == fail_at;
}

#define FAIL(what)                                                                                                                         \
    do {                                                                                                                                   \
        if (fails(__builtin_return_address(0))) {                                                                                          \
            errno = ENOMEM;                                                                                                                \
            return what;                                                                                                                   \
        }                                                                                                                                  \
    } while (0)

__attribute__((visibility("default"))) void *malloc(size_t size) {
    FAIL(NULL);
    return __libc_malloc(size);
}
__attribute__((visibility("default"))) void *calloc(size_t count, size_t size) {
    FAIL(NULL);
    return __libc_calloc(count, size);
}
__attribute__((visibility("default"))) void *realloc(void *old, size_t size) {
    FAIL(NULL);
    return __libc_realloc(old, size);
}
__attribute__((visibility("default"))) void *aligned_alloc(size_t alignment, size_t size) {
    FAIL(NULL);
    return __libc_memalign(alignment, size);
}
__attribute__((visibility("default"))) int posix_memalign(void **made, size_t alignment, size_t size) {
    FAIL(ENOMEM);
    *made = __libc_memalign(alignment, size);
    return *made ? 0 : ENOMEM;
}
