#!/bin/bash
# Each plugin that is wrong on purpose is refused by its file's name, for the right reason, with exit 2, by `abut plugins` and by a scene that
# names its class; and what its file alone gives away is refused before any code of it runs. test_wrong.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
header=$(realpath "$(dirname "$0")/../../plugins/abut_plugin.h")
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
unset ABUT_PLUGIN_PATH
wrong=0
cd "$scratch" || exit 1

# scene MODEL SETTINGS: a block alone
scene() {
    cat <<YAML
abut: 1
title: One block
space: plane-strain
time: {end: 1e-3, dt: 1e-4}
grid: {from: [0, 0], to: [2, 2], cell: 0.5}
materials:
  stuff: {model: $1, $2density: 1000}
bodies:
  block: {method: material-points, material: stuff, shape: {box: [[0.5, 0.5], [1, 1]]}, fill: {rule: regular, per_cell: 4}}
YAML
}

# say TEXT...: one thing that is not as it should be
say() {
    wrong=1
    printf '%s\n' "$@"
}

# refused FILE PATTERN EARLY: FILE is offered under the name of the class wrong-class. EARLY: none of its code may run.
refused() {
    local name=$1 pattern=$2 early=${3:-} folder=$scratch/$1 printed status
    mkdir -p "$folder/material"
    cp "${4:-$build/tests/plugins/wrong_$name.so}" "$folder/material/wrong_class.so" || { say "wrong_$name.so is not built"; return; }
    scene wrong-class 'E: 1e6, ' >"$folder/scene.yaml"
    for command in 'plugins' 'plugins show wrong-class' "check $folder/scene.yaml" "run $folder/scene.yaml -o $folder/out"; do
        # shellcheck disable=SC2086 # the words of the command
        printed=$("$build/abut" $command --plugin-path "$folder" 2>&1 </dev/null)
        status=$?
        [ $status -eq 2 ] || say "$name: abut $command exits $status, wanted 2: $printed"
        grep -qE -- "$pattern" <<<"$printed" || say "$name: abut $command does not say '$pattern': $printed"
        grep -qF -- "$folder/material/wrong_class.so" <<<"$printed" || say "$name: abut $command does not name the file: $printed"
        if [ "$early" = early ] && grep -q 'code of the wrong plugin ran' <<<"$printed"; then say "$name: its code ran"; fi
    done
    [ ! -e "$folder/out" ] || say "$name: the refused run wrote something"
}

# Its file says enough. The numbers are the header's, so that a new minor version of the interface needs no new test.
version() { sed -nE "s/^#define AB_ABI_$1 ([0-9]+)u .*/\\1/p" "$header"; }
major=$(version MAJOR) minor=$(version MINOR)
refused major "interface $((major + 1))\\.$minor and this abut has $major\\.$minor" early
refused minor "interface $major\\.$((minor + 1)) and this abut has $major\\.$minor; update abut" early
refused struct_size 'wrong struct size: its descriptor says 48 bytes' early
refused struct_size_huge 'wrong struct size: its descriptor says 4000 bytes' early
refused double_size 'numbers of another size' early
refused no_symbol "has no symbol 'abut_plugin_v1'" early
refused function "a function, not data" early
refused empty_data 'not in the file' early
echo 'not an object' >text.so
refused text 'is not a shared object' early text.so
: >empty.so
refused empty 'is not a shared object' early empty.so
cp "$build/abut" program.so
refused program "abut_plugin_v1|not a shared object" early program.so
whole=$(stat -c %s "$build/tests/plugins/wrong_nothing.so")
for size in 20 100 400 1000 4096 $((whole / 2)) $((whole * 3 / 4)); do
    head -c "$size" "$build/tests/plugins/wrong_nothing.so" >cut.so
    [ "$size" -lt "$whole" ] && refused "cut_at_$size" 'is damaged|is not a shared object|no symbol' early cut.so
done
# Its tables do.
refused class_size 'wrong struct size: its ab_class says 16 bytes'
refused ops_size 'wrong struct size: its ab_material_ops says 400 bytes'
refused no_update 'lacks update'
refused save 'has one of save and load'
refused gives 'cannot need 0x0 or give 0x20'
refused boundary_gives 'lacks AB_GIVE_TRACTION or AB_GIVE_MOTION among what it gives'
refused boundary_damping 'lacks AB_GIVE_TRACTION, which damping and stiffness are of'
refused kind 'kind 9, which is none'
refused no_name 'class without a name'
refused class_null 'has no class 1 of 2'
refused class_twice "offers the material class 'wrong-class' twice"
refused param_null 'nparam 1 and no settings'
refused param_count 'declares 100000 settings'
refused param_flags 'unknown flags 0x4000'
refused param_increasing 'has AB_INCREASING and is not AB_TABLE'
refused param_type 'type 77, which is none'
refused choices 'AB_CHOICE without choices'
refused default 'default 5 outside of its own range 0 to 2'
refused range 'range 2 to 1, which holds nothing'
refused unit 'has no unit'
refused undefined 'undefined symbol: nowhere_to_be_found'
case $(uname -m) in x86_64 | aarch64)
    refused flush_to_zero 'it turns on flush-to-zero'
    refused rounding 'changes the floating-point mode'
    nm "$build/tests/plugins/wrong_fast_math.so" | grep -q set_fast_math && refused fast_math 'it turns on flush-to-zero' ;;
esac

# Nothing else was wrong with them.
mkdir -p nothing/material
cp "$build/tests/plugins/wrong_nothing.so" nothing/material/wrong_class.so
"$build/abut" plugins show wrong-class --plugin-path nothing >shown.txt 2>&1 || say "the plugin with nothing wrong is refused: $(cat shown.txt)"

# Two files, one class: both are named, also when their names do not say it.
for name in linear_elastic another; do
    mkdir -p "twice_$name/material"
    cp "$build/tests/plugins/wrong_duplicate.so" "twice_$name/material/$name.so"
    scene linear-elastic 'E: 1e6, nu: 0.3, ' >"twice_$name/scene.yaml"
    "$build/abut" plugins --plugin-path "twice_$name" >said.txt 2>&1
    [ $? -eq 2 ] || say "a class offered twice does not exit 2: $(cat said.txt)"
    grep -q "twice_$name/material/$name.so" said.txt && grep -q "$build/plugins/material/linear_elastic.so" said.txt ||
        say "a class offered twice: both files are to be named: $(cat said.txt)"
done
"$build/abut" check twice_linear_elastic/scene.yaml --plugin-path twice_linear_elastic >said.txt 2>&1
[ $? -eq 2 ] && grep -q "offers the material class 'linear-elastic', and so does" said.txt || say "a scene takes one of two: $(cat said.txt)"

# Settings outside of their range, wrong in kind, unknown, missing.
command=check
settings() {
    local pattern=$1 values=$2
    scene "${3:-linear-elastic}" "$values" >settings.yaml
    # shellcheck disable=SC2086 # the words of the command
    "$build/abut" $command settings.yaml >said.txt 2>&1
    [ $? -eq 2 ] && grep -qE -- "$pattern" said.txt && grep -q '^settings.yaml:7:' said.txt || say "settings '$values': wanted '$pattern': $(cat said.txt)"
}
settings 'nu' 'E: 1e6, nu: 0.5, '
settings 'nu' 'E: 1e6, nu: -1, '
settings 'E' 'E: 0, nu: 0.3, '
settings 'E' 'E: -1e6, nu: 0.3, '
settings 'E' 'nu: 0.3, '
settings 'Pa' 'E: "1 kg", nu: 0.3, '
settings "did you mean 'nu'" 'E: 1e6, nu: 0.3, un: 1, '
# What only the plugin can see, it says when the run makes it.
command='run -o refused_out'
settings 'softens faster' 'E: 1e6, nu: 0.3, yield: 1e3, hardening: -2e6, ' von-mises
settings 'above yield' 'E: 1e6, nu: 0.3, yield: 1e3, residual: 2e3, ' von-mises
[ ! -e refused_out ] || say "a run whose material refused its settings wrote something"
scene linear-elastic 'E: 1e6, nu: 0.3, ' >settings.yaml
"$build/abut" check settings.yaml >said.txt 2>&1 || say "a scene with nothing wrong is refused: $(cat said.txt)"

# A class that is nowhere: the nearest name and the folders that were searched. The working directory is none of them, but where it is named.
scene linear-elastc 'E: 1e6, nu: 0.3, ' >nowhere.yaml
"$build/abut" check nowhere.yaml --plugin-path nothing >said.txt 2>&1
[ $? -eq 2 ] && grep -q "no material model 'linear-elastc'; did you mean 'linear-elastic'? looked in: $scratch/nothing, $build/plugins" said.txt ||
    say "a class that is nowhere: $(cat said.txt)"
scene wrong-class 'E: 1e6, ' >nothing/scene.yaml
cd nothing/material || exit 1
ABUT_PLUGIN_PATH=: "$build/abut" check ../scene.yaml >/dev/null 2>&1 && say "a plugin was taken from the working directory"
ABUT_PLUGIN_PATH=. "$build/abut" check ../scene.yaml >said.txt 2>&1 || say "a plugin was not taken from the folder that was named: $(cat said.txt)"
"$build/abut" plugins --plugin-path no/such/folder >said.txt 2>&1
[ $? -eq 2 ] && grep -q "there is no folder 'no/such/folder'" said.txt || say "a search path that is not there: $(cat said.txt)"
exit $wrong
