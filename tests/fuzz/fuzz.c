/* fuzz.c: one target for libFuzzer: -DFUZZ=fuzz_scene, fuzz_set or fuzz_plugin. */
#include "tests/fuzz/targets.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count) {
    if (FUZZ(bytes, count)) abort();
    return 0;
}
