/* test_fuzz.c: readers of scenes, of --set, of tables and of plugin files on known inputs that were changed at random, the same ones in every run. The long run is slow_fuzz.sh. */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>

#include "tests/fuzz/targets.h"

enum { MOST_BYTES = 1 << 16, SEEDS = 64, SCENES = 500, SETS = 1500, TABLES = 4000, PLUGINS = 3000 };

static uint64_t random_state = 7;

static size_t below(size_t count) {
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return count ? (size_t)(random_state >> 33) % count : 0;
}

typedef struct seed {
    uint8_t *bytes;
    size_t count;
} seed;

static seed seeds[SEEDS];
static size_t seed_count;

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

/* Files of a folder of the source (or, built, of the build) whose names end so, in order of name. */
static void take_seeds(const char *variable, const char *folder, const char *ending) {
    char path[4400], *names[512];
    size_t count = 0;
    const char *root = getenv(variable);
    snprintf(path, sizeof path, "%s/%s", root ? root : ".", folder);
    DIR *directory = opendir(path);
    assert_non_null(directory);
    for (const struct dirent *entry; (entry = readdir(directory)) && count < 512;) {
        const size_t length = strlen(entry->d_name), end = strlen(ending);
        if (length > end && !strcmp(entry->d_name + length - end, ending)) names[count++] = strdup(entry->d_name);
    }
    closedir(directory);
    qsort(names, count, sizeof *names, by_name);
    for (size_t k = 0; k < count; k++) {
        snprintf(path, sizeof path, "%s/%s/%s", root ? root : ".", folder, names[k]);
        FILE *file = seed_count < SEEDS ? fopen(path, "rb") : NULL;
        free(names[k]);
        if (!file) continue;
        seed *s = seeds + seed_count++;
        s->bytes = malloc(MOST_BYTES);
        s->count = fread(s->bytes, 1, MOST_BYTES, file);
        fclose(file);
    }
    assert_true(seed_count > 0);
}

static void drop_seeds(void) {
    for (size_t k = 0; k < seed_count; k++) free(seeds[k].bytes);
    seed_count = 0;
}

/* Bits turned, bytes put in, pieces copied within and from another input, the end cut off. */
static size_t change(uint8_t *bytes, size_t count) {
    static const char *const words[] = {"nan",
                                        "inf",
                                        "1e999",
                                        "-1",
                                        "0",
                                        "[",
                                        "]",
                                        "{",
                                        "}",
                                        "&a",
                                        "*a",
                                        "!!",
                                        "\"",
                                        "'",
                                        ": ",
                                        ", ",
                                        "\n",
                                        "  ",
                                        "#",
                                        "|",
                                        "1/0",
                                        "sqrt(-1)",
                                        "99999999999999999999",
                                        "\xc3"};
    for (size_t n = 1 + below(6); n > 0; n--) {
        const size_t at = below(count + 1), left = count - at;
        const seed *other = seeds + below(seed_count);
        const size_t from = below(other->count + 1), size = below(64) < other->count - from ? below(64) : 0;
        switch (below(7)) {
        case 0:
            if (left) bytes[at] ^= (uint8_t)(1u << below(8));
            break;
        case 1:
            if (left) bytes[at] = (uint8_t)below(256);
            break;
        case 2: count = at; break;
        case 3:
            if (count + 32 < MOST_BYTES) {
                const char *word = words[below(sizeof words / sizeof *words)];
                const size_t length = strlen(word);
                memmove(bytes + at + length, bytes + at, left);
                memcpy(bytes + at, word, length);
                count += length;
            }
            break;
        case 4: { /* a piece goes */
            const size_t gone = below(left + 1) % 40;
            memmove(bytes + at, bytes + at + gone, left - gone);
            count -= gone;
            break;
        }
        default: /* a piece of another one over it */
            if (from + size <= other->count && at + size <= count) memcpy(bytes + at, other->bytes + from, size);
        }
    }
    return count;
}

static void run(int (*target)(const uint8_t *, size_t), size_t inputs) {
    uint8_t *bytes = malloc(2 * MOST_BYTES);
    random_state = 7;
    for (size_t n = 0; n < inputs; n++) {
        const seed *s = seeds + (n < seed_count ? n : below(seed_count));
        memcpy(bytes, s->bytes, s->count);
        const size_t count = n < seed_count ? s->count : change(bytes, s->count);
        if (!target(bytes, count)) continue;
        FILE *kept = fopen("fuzz_input", "wb");
        if (kept) fwrite(bytes, 1, count, kept), fclose(kept);
        free(bytes);
        fail_msg("input %zu is in ./fuzz_input", n);
    }
    free(bytes);
    drop_seeds();
}

static void test_scenes(void **state) {
    (void)state;
    take_seeds("ABUT_SOURCE", "tests/fuzz/corpus", ".yaml");
    take_seeds("ABUT_SOURCE", "plugins/new", ".yaml");
    run(fuzz_scene, SCENES);
}

static void test_settings(void **state) {
    (void)state;
    take_seeds("ABUT_SOURCE", "tests/fuzz/corpus", ".set");
    run(fuzz_set, SETS);
}

static void test_tables(void **state) {
    (void)state;
    take_seeds("ABUT_SOURCE", "tests/fuzz/corpus", ".table");
    run(fuzz_table, TABLES);
}

static void test_plugin_files(void **state) {
    (void)state;
    take_seeds("ABUT_BUILD", "plugins/contact", "s.so");
    run(fuzz_plugin, PLUGINS);
}

int main(void) {
    unsetenv("ABUT_PLUGIN_PATH");
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_scenes), cmocka_unit_test(test_settings), cmocka_unit_test(test_tables),
                                       cmocka_unit_test(test_plugin_files)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
