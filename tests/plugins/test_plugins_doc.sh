#!/bin/bash
# The files and commands of docs/plugins.md and docs/plugin-examples.md, cut out of the text, build against an installed tree and do what the text says; the material stays below
# sixty lines. test_plugins_doc.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
page=$(realpath docs/plugins.md) examples=$(realpath docs/plugin-examples.md)
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
cmake --install "$build" --prefix "$scratch/installed" >/dev/null
mkdir -p "$scratch/own"
cd "$scratch/own"
PKG_CONFIG_PATH=$(dirname "$(find "$scratch/installed" -name abut.pc)")
export PKG_CONFIG_PATH CMAKE_PREFIX_PATH=$scratch/installed PATH=$scratch/installed/bin:$PATH
unset ABUT_PLUGIN_PATH
export OMP_NUM_THREADS=1

# "<!-- file: NAME -->" stands before a fenced block that is that file, "<!-- run -->" before commands.
cut_out() {
    awk '
    /^<!-- file: .* -->$/ { name = $3; next }
    /^<!-- run -->$/ { name = sprintf("run_%02d.sh", ++runs); next }
    /^```/ { inside = !inside; if (!inside) { if (name != "") close(name); name = "" } next }
    inside && name != "" { print > name }
    ' "$1"
}
cut_out "$page"
lines=$(wc -l <maxwell.c)
[ "$lines" -lt 60 ] || { echo "maxwell.c has $lines lines; the text promises fewer than 60"; exit 1; }
[ "$(ls run_*.sh | wc -l)" -eq 4 ] || { echo "the text has other commands than this test knows: $(ls)"; exit 1; }
for commands in run_*.sh; do
    echo "== $commands"
    bash -eux "$commands"
done
cc -std=c11 -Wall -Wextra -Werror -shared -fPIC $(pkg-config --cflags abut) maxwell.c -o strict.so -lm
cc -std=c11 -Wall -Wextra -Werror -shared -fPIC $(pkg-config --cflags abut) oil_film.c -o strict.so -lm
# The same class in two folders is refused.
if abut plugins --plugin-path build:plugins 2>twice.txt; then
    echo "the same class in two files was taken"
    exit 1
fi
grep -q "offers the material class 'maxwell', and so does" twice.txt

# The three examples: no warnings, and every promise kept (their commands ask the check, which would end this).
mkdir -p "$scratch/examples"
cd "$scratch/examples"
cut_out "$examples"
[ "$(ls run_*.sh | wc -l)" -eq 3 ] || { echo "the examples have other commands than this test knows: $(ls)"; exit 1; }
for file in speed_friction cyclic_soil shaker; do cc -std=c11 -Wall -Wextra -Wshadow -Werror -shared -fPIC $(pkg-config --cflags abut) $file.c -o strict.so -lm; done
for commands in run_*.sh; do
    echo "== $commands"
    bash -eux "$commands"
done
