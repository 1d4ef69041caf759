#!/bin/bash
# What `cmake --install` lays out: the program runs from there, and a plugin is built outside the tree by pkg-config alone and by
# find_package(abut), then found with --plugin-path. test_install.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
source=$PWD
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
cmake --install "$build" --prefix "$scratch/first" >/dev/null
mv "$scratch/first" "$scratch/prefix" # an installed tree can be moved
prefix=$scratch/prefix
cd "$scratch"

plugins=$(PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name abut.pc)") pkg-config --variable=plugindir abut)
for file in bin/abut include/abut_plugin.h share/doc/abut/cases/block_on_incline/scene.yaml share/doc/abut/docs/user.md share/doc/abut/README.md; do
    [ -f "$prefix/$file" ] || { echo "$file is not installed"; exit 1; }
done
[ -f "$plugins/material/linear_elastic.so" ] || { echo "no built-in plugins in '$plugins'"; exit 1; }
# What the installed pages link to lies beside them.
broken=$(find "$prefix/share/doc/abut" -name '*.md' | while read -r page; do
    grep -oE '\]\([^)#:]+\)' "$page" | sed 's/^](//; s/)$//' | while read -r link; do
        [ -e "$(dirname "$page")/$link" ] || echo "$page: $link"
    done
done)
[ -z "$broken" ] || { echo "links that lead nowhere: $broken"; exit 1; }
# Away from the build folder, so that only the installed plugins can be found.
env -u ABUT_PLUGIN_PATH "$prefix/bin/abut" plugins >listed.txt
grep -q linear-elastic listed.txt
"$prefix/bin/abut" check "$prefix/share/doc/abut/cases/block_on_incline/scene.yaml"

# A material of one's own: the linear-elastic one under another name.
mkdir -p own
sed 's/"linear-elastic"/"outside-elastic"/' "$source/plugins/material/linear_elastic.c" >own/outside_elastic.c
sed 's/model: linear-elastic/model: outside-elastic/' "$prefix/share/doc/abut/cases/block_on_incline/scene.yaml" >own/scene.yaml

mkdir -p by_pkgconfig/material by_cmake
# shellcheck disable=SC2046 # words are wanted
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name abut.pc)") \
    bash -c 'gcc -std=c11 -Wall -Wextra -Werror -O2 -shared -fPIC $(pkg-config --cflags abut) own/outside_elastic.c -o by_pkgconfig/material/outside_elastic.so -lm'
"$prefix/bin/abut" check own/scene.yaml --plugin-path by_pkgconfig

cat >own/CMakeLists.txt <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(own LANGUAGES C)
find_package(abut 0.1 REQUIRED)
abut_add_plugin(outside_elastic outside_elastic.c)
CMAKE
cmake -S own -B by_cmake -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build by_cmake >/dev/null
"$prefix/bin/abut" check own/scene.yaml --plugin-path by_cmake

# Without it the scene is refused, and the working directory is not searched.
cp by_pkgconfig/material/outside_elastic.so .
if "$prefix/bin/abut" check own/scene.yaml 2>refused.txt; then
    echo "a plugin was taken from the working directory"
    exit 1
fi
grep -q outside-elastic refused.txt
