/* test_fuzz_files.c: readers of checkpoints and of what libgmsh makes of a mesh file, on good ones that were changed at random, the same changes in every run. Lengths and
 * counts are what a reader trusts, so they are changed more often than the rest. The long run is slow_fuzz.sh. */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>

#include "tests/fuzz/targets_files.h"

enum { MOST_BYTES = 1 << 18, CHECKPOINTS = 500, MESHES = 30000, MOST_RECORDS = 4096 };

static uint64_t random_state;

static size_t below(size_t count) {
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return count ? (size_t)(random_state >> 33) % count : 0;
}

/* A number that is near the old one, near the end of its kind, or near nothing. */
static uint64_t odd_number(uint64_t old) {
    static const uint64_t odd[] = {0,          1,          2,          7,          8,         9,          64,
                                   UINT8_MAX,  UINT16_MAX, INT32_MAX,  UINT32_MAX, INT64_MAX, UINT64_MAX, 1ull << 29,
                                   1ull << 32, 1ull << 61, 1ull << 63, 1ull << 58, 1000,      1ull << 40};
    switch (below(5)) {
    case 0: return old + 1;
    case 1: return old - 1;
    case 2: return old ^ 1ull << below(64);
    case 3: return old + below(2000) - 1000;
    default: return odd[below(sizeof odd / sizeof *odd)];
    }
}

static size_t padded(size_t bytes) { return (bytes + 7) / 8 * 8; }

/* ---- checkpoints ------------------------------------------------------------------------------------------------------------ */

typedef struct place {
    size_t at, values, end; /* of a record */
    uint32_t type;
} place;

static size_t find_records(const uint8_t *bytes, size_t count, place *records) {
    static const size_t width[] = {0, 8, 8, 4, 1};
    size_t found = 0;
    for (size_t at = FUZZ_HEAD; at < count && found < MOST_RECORDS;) {
        uint32_t name, type;
        uint64_t values;
        memcpy(&name, bytes + at, 4), memcpy(&type, bytes + at + 4, 4), memcpy(&values, bytes + at + 8, 8);
        const size_t first = at + 16 + padded(name);
        records[found++] = (place){at, first, first + padded(values * width[type]), type};
        at = records[found - 1].end;
    }
    return found;
}

/* One change of one record. */
static size_t change_record(uint8_t *bytes, size_t count, const place *records, size_t found) {
    place r = records[below(found)];
    for (int k = 0; k < 3 && r.type != 2; k++) r = records[below(found)]; /* counts and places rather than sizes in metres */
    const size_t length = r.end - r.values, at = r.values + (length ? below(length) : 0) / 8 * 8;
    uint64_t number;
    switch (below(10)) {
    case 0: /* lengths of names, types */
        memcpy(&number, bytes + r.at, 4);
        number = odd_number(number & UINT32_MAX);
        memcpy(bytes + r.at + 4 * below(2), &number, 4);
        break;
    case 1: /* counts */
        memcpy(&number, bytes + r.at + 8, 8);
        number = odd_number(number);
        memcpy(bytes + r.at + 8, &number, 8);
        break;
    case 2: /* it goes */ memmove(bytes + r.at, bytes + r.end, count - r.end); return count - (r.end - r.at);
    case 3: /* another one's values */
    {
        const place *other = records + below(found);
        const size_t some = other->end - other->values < length ? other->end - other->values : length;
        memmove(bytes + r.values, bytes + other->values, some);
        break;
    }
    case 4: /* it is shorter by a number, and says so */
        if (length < 8) break;
        memcpy(&number, bytes + r.at + 8, 8);
        number -= r.type == 4 ? 8 : r.type == 3 ? 2 : 1;
        memcpy(bytes + r.at + 8, &number, 8);
        memmove(bytes + r.end - 8, bytes + r.end, count - r.end);
        return count - 8;
    default:
        if (length < 8) break;
        memcpy(&number, bytes + at, 8);
        number = r.type == 3 ? (number & ~(uint64_t)UINT32_MAX) | (odd_number(number) & UINT32_MAX) : odd_number(number);
        memcpy(bytes + at, &number, 8);
    }
    return count;
}

static void refuse_input(const uint8_t *bytes, size_t count, int number) {
    FILE *kept = fopen("fuzz_input", "wb");
    if (kept) fwrite(bytes, 1, count, kept), fclose(kept);
    fail_msg("input %d is in ./fuzz_input", number);
}

static char folder[64];

/* A checkpoint of restart.yaml, as a run leaves it. */
static size_t write_checkpoint(uint8_t *bytes) {
    strcpy(folder, "/tmp/abut-fuzz-XXXXXX");
    assert_non_null(mkdtemp(folder));
    ab_report *report = ab_report_create();
    const ab_run_options options = fuzz_options(folder);
    const ab_status status = ab_run(fuzz_restart_scene(), &options, report);
    if (status != AB_OK) ab_report_print(report, stderr);
    assert_int_equal(status, AB_OK);
    ab_report_destroy(report);
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, AB_CHECKPOINT_PREVIOUS);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t count = fread(bytes, 1, MOST_BYTES, file);
    fclose(file);
    DIR *directory = opendir(folder);
    for (const struct dirent *entry; (entry = readdir(directory));)
        if (entry->d_name[0] != '.') unlinkat(dirfd(directory), entry->d_name, 0);
    closedir(directory);
    rmdir(folder);
    assert_true(count > 1000 && count < MOST_BYTES);
    return count;
}

static void test_checkpoints(void **state) {
    (void)state;
    uint8_t *good = malloc(MOST_BYTES), *bytes = malloc(MOST_BYTES), *again = malloc(MOST_BYTES);
    place *records = malloc(MOST_RECORDS * sizeof *records);
    const size_t whole = write_checkpoint(good), found = find_records(good, whole, records);
    assert_true(found > 200 && records[found - 1].end == whole);
    /* what is changed below is a checkpoint that is taken, and the check sum made here is the one it has */
    memcpy(again, good, whole);
    fuzz_mend(again, whole);
    assert_memory_equal(good, again, whole);
    assert_int_equal(fuzz_restart(good, whole), 0);
    random_state = 7;
    size_t taken = 0;
    for (int n = 0; n < CHECKPOINTS; n++) {
        size_t count = whole;
        memcpy(bytes, good, whole);
        if (n % 16 == 15) {
            for (size_t k = 1 + below(6); k > 0; k--) bytes[below(count)] ^= (uint8_t)(1u << below(8)); /* anywhere */
            if (n % 32 == 31) count = below(count);
        } else if (n % 16 == 14) {
            for (size_t k = 1 + below(3); k > 0; k--) bytes[below(FUZZ_HEAD)] = (uint8_t)below(256);
        } else {
            count = change_record(bytes, count, records, found);
        }
        if (fuzz_checkpoint(bytes, count)) refuse_input(bytes, count, n);
        taken += count == whole;
    }
    assert_true(taken > CHECKPOINTS / 2);
    free(good), free(bytes), free(again), free(records);
}

/* ---- meshes ----------------------------------------------------------------------------------------------------------------- */

static void test_meshes(void **state) {
    (void)state;
    static const char *const names[] = {"squares", "middles", "mixed", "refused"};
    enum { SEEDS = sizeof names / sizeof *names, MOST = 4096 };
    uint8_t seeds[SEEDS][MOST], bytes[MOST];
    size_t counts[SEEDS];
    for (size_t k = 0; k < SEEDS; k++) {
        char path[4096];
        const char *source = getenv("ABUT_SOURCE");
        snprintf(path, sizeof path, "%s/tests/fuzz/corpus/%s.mesh", source ? source : ".", names[k]);
        FILE *file = fopen(path, "rb");
        assert_non_null(file);
        counts[k] = fread(seeds[k], 1, MOST, file);
        fclose(file);
        assert_int_equal(fuzz_mesh(seeds[k], counts[k]), 0);
    }
    random_state = 7;
    for (int n = 0; n < MESHES; n++) {
        const size_t s = below(SEEDS);
        size_t count = counts[s];
        memcpy(bytes, seeds[s], count);
        for (size_t k = 1 + below(3); k > 0; k--) {
            const size_t at = below(count / 8) * 8;
            uint64_t number, other;
            memcpy(&number, bytes + at, 8);
            memcpy(&other, seeds[s] + below(counts[s] / 8) * 8, 8);
            number = below(3) ? odd_number(number) : other;
            memcpy(bytes + at, &number, 8);
        }
        if (below(8) == 0) count = below(count);
        if (fuzz_mesh(bytes, count)) refuse_input(bytes, count, n);
    }
}

int main(void) {
    unsetenv("ABUT_PLUGIN_PATH");
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_checkpoints), cmocka_unit_test(test_meshes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
