#!/bin/bash
# docs/scene.md is what `abut help scene` prints, and every file and folder that README.md and docs/*.md point to is there. test_docs.sh BUILD
set -u
build=${1:?the build folder}
wrong=0
if ! "$build/abut" help scene | diff docs/scene.md - >&2; then
    echo "docs/scene.md is not what the program checks: $build/abut help scene >docs/scene.md"
    wrong=1
fi
for page in README.md docs/*.md cases/*/README.md; do
    while read -r target; do
        case $target in http*) continue ;; esac
        [ -e "$(dirname "$page")/${target%%#*}" ] || { echo "$page points to $target, which is not there"; wrong=1; }
    done < <(grep -oE '\]\([^)#]+[^)]*\)' "$page" | sed -E 's/^\]\(//; s/\)$//')
done
exit $wrong
