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
# The scene of ground at rest, further down.
awk '/^```yaml/ {block = ""; inside = 1; next} /^```$/ {if (inside && block ~ /initial: {stress: K0}/ && block ~ /^abut: 1/) printf "%s", block; inside = 0; next} inside {block = block $0 "\n"}' docs/boundaries.md >"$scratch/rest.yaml"
grep -q 'boundary: viscous' "$scratch/rest.yaml" || { echo "docs/boundaries.md has no ground at rest any more"; exit 1; }
"$build/abut" run "$scratch/rest.yaml" --quiet --strict -j 1 -o "$scratch/out" || { echo "MISSED  the ground at rest of docs/boundaries.md"; exit 1; }
