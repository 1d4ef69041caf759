#!/bin/bash
# cost: 2000
# libFuzzer on the readers of scenes, of --set, of tables, of plugin files, of checkpoints and of mesh files, with address and undefined-behaviour sanitizers, ABUT_FUZZ_SECONDS
# (default 300) each, from tests/fuzz/corpus on. An input that breaks something is left in the scratch folder: it becomes a file of the corpus, and a test. slow_fuzz.sh BUILD
set -u
command -v clang >/dev/null || { echo "clang is not there"; exit 77; }
source=$PWD
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
fuzz=$source/build-fuzz
cmake -G Ninja -S . -B "$fuzz" -DCMAKE_C_COMPILER=clang -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_FLAGS_DEBUG="-O1 -g" -DABUT_SANITIZE=fuzzer-no-link,address,undefined >"$scratch/configured.txt" 2>&1 &&
    cmake --build "$fuzz" --target fuzz_scene fuzz_set fuzz_table fuzz_plugin fuzz_checkpoint fuzz_mesh >"$scratch/built.txt" 2>&1 || { tail "$scratch"/*.txt; exit 1; }
export ABUT_BUILD=${1:?the build folder} ABUT_SOURCE=$source
ABUT_BUILD=$(realpath "$ABUT_BUILD")
cd "$scratch" || exit 1
mkdir -p seeds/scene seeds/set seeds/table seeds/plugin seeds/checkpoint seeds/mesh
for folder in tests/fuzz/corpus tests/verification plugins/new; do # some have the same names
    for file in "$source/$folder"/*.yaml; do cp "$file" "seeds/scene/${folder//\//_}_${file##*/}"; done
done
cp "$source"/tests/fuzz/corpus/*.set seeds/set
cp "$source"/tests/fuzz/corpus/*.table seeds/table
cp "$ABUT_BUILD"/plugins/contact/frictionless.so "$ABUT_BUILD"/tests/plugins/wrong_nothing.so seeds/plugin
cp "$source"/tests/fuzz/corpus/*.mesh seeds/mesh
"$ABUT_BUILD/abut" run "$source/tests/fuzz/corpus/restart.yaml" -j 1 --quiet -o restart >restart.txt 2>&1 && cp restart/checkpoint*.abut seeds/checkpoint || { cat restart.txt; exit 1; }
status=0
for target in scene set table plugin checkpoint mesh; do
    mkdir -p "found/$target"
    # leaks: libmuparser's and libudunits' own tables stay
    ASAN_OPTIONS=detect_leaks=0 timeout 1800 "$fuzz/tests/fuzz/fuzz_$target" -max_total_time="${ABUT_FUZZ_SECONDS:-300}" -timeout=20 -rss_limit_mb=4096 -max_len=131072 -print_final_stats=1 \
        "found/$target" "seeds/$target" >"$target.txt" 2>&1 || { status=1; echo "fuzz_$target:"; grep -v '^#' "$target.txt" | tail -n 40; ls crash-* timeout-* oom-* 2>/dev/null; }
    grep -E 'number_of_executed_units|DONE' "$target.txt"
done
exit $status
