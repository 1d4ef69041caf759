#!/bin/bash
# cost: 8
# `abut plugins new`: what it writes compiles outside the tree, with warnings as errors and as its own CMake lines say, passes the check, and its scene runs
# and meets what it expects, with and without guards and to the same bits. Names are checked, nothing is overwritten. test_new.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
header=$PWD/plugins
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
unset ABUT_PLUGIN_PATH
export OMP_NUM_THREADS=1
wrong=0
say() { wrong=1; printf '%s\n' "$*"; }
cmake --install "$build" --prefix "$scratch/prefix" >/dev/null || say "cannot install"
cd "$scratch" || exit 1

refused() { # PATTERN WORDS...: exit 2 with a line that matches
    local pattern=$1
    shift
    "$build/abut" plugins new "$@" >said.txt 2>&1
    [ $? -eq 2 ] && grep -q -- "$pattern" said.txt || say "plugins new $*: wanted '$pattern': $(cat said.txt)"
}
refused "did you mean 'material'" materail clay
refused 'finds contact points or responds' contact clay
refused 'has a meaning in the source' boundary sqrt
refused 'are those of the interface' material ab-host
refused 'takes a kind' material
refused 'linear-elastic. is the name of a plugin that is there already' material linear-elastic
refused 'cannot be the name' material Clay
refused 'cannot be the name' material ../clay
refused 'cannot be the name' material soft--clay
refused 'cannot be the name' material clay-
refused 'cannot be the name' material ''
refused 'take another name' material update
refused 'take another name' boundary apply
[ "$(ls)" = "$(printf 'prefix\nsaid.txt')" ] || say "a refused name left something: $(ls)"

for kind in material boundary finder response; do
    "$build/abut" plugins new $kind "own-$kind" >/dev/null || say "new $kind failed"
    file=own_$kind
    sum=$(cat own-$kind/* | cksum)
    refused 'is there already' $kind "own-$kind"
    [ "$sum" = "$(cat own-$kind/* | cksum)" ] || say "new $kind overwrote its files"
    cd own-$kind || exit 1
    cc -std=c11 -Wall -Wextra -Wshadow -Werror -shared -fPIC -I"$header" $file.c -o strict.so -lm || say "$file.c has warnings"
    { cmake -S . -B build -DCMAKE_PREFIX_PATH="$scratch/prefix" && cmake --build build; } >built.txt 2>&1 || say "$file.c is not built: $(cat built.txt)"
    "$build/abut" plugins check build/$file.so >checked.txt 2>&1 || say "$file.so fails its check: $(cat checked.txt)"
    for checked in false true; do
        "$build/abut" run $file.yaml --strict --quiet --plugin-path build -j 1 --set checked=$checked -o out_$checked >ran.txt 2>&1 || say "$file.yaml, checked $checked: $(cat ran.txt)"
        [ ! -s ran.txt ] || say "$file.yaml, checked $checked, says: $(cat ran.txt)"
    done
    cmp out_false/history.csv out_true/history.csv || say "$file: another result under guard"
    cd ..
done

# Into a folder of one's own choice, beside what is there already.
mkdir mine && touch mine/notes.txt
"$build/abut" plugins new response soft-clay -o mine >/dev/null || say "new into a folder that is there failed"
[ -f mine/soft_clay.c ] && [ -f mine/soft_clay.yaml ] && [ -f mine/notes.txt ] || say "files in a folder of one's own: $(ls mine)"
grep -q 'my.law' mine/* && say "the name of the template is left in mine: $(grep -l 'my.law' mine/*)"
exit $wrong
