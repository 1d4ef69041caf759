/* fuzz.c: one target for libFuzzer: -DFUZZ=fuzz_scene, fuzz_set, fuzz_table, fuzz_plugin, fuzz_checkpoint or fuzz_mesh. */
#include "tests/fuzz/targets_files.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count) {
    if (FUZZ(bytes, count)) abort();
    return 0;
}
