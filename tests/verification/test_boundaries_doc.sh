#!/bin/bash
# The scene of docs/boundaries.md, cut out of the text, runs and meets its expect, on elements as it stands. test_boundaries_doc.sh BUILD
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$(realpath "${1:?the build folder}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
sed -n '/^```yaml/,/^```/p' docs/boundaries.md | sed '/^```$/q' | sed '/^```/d' >"$scratch/example.yaml"
grep -q 'boundary: viscous' "$scratch/example.yaml" || { echo "docs/boundaries.md has no example any more"; exit 1; }
"$build/abut" run "$scratch/example.yaml" --quiet --strict -j 1 -o "$scratch/out" || { echo "MISSED  the example of docs/boundaries.md"; exit 1; }
