#!/bin/bash
# cost: 10
# The scene of docs/structures.md, cut out of the text, checks, runs and meets its expect, as it stands and with every variant that the text names.
# test_structures_doc.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
page=$(realpath docs/structures.md)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
sed -n '/^```yaml$/,/^```$/{/^```/!p}' "$page" >strike.yaml
"$build/abut" check strike.yaml
"$build/abut" plan strike.yaml >plan
grep -q "of 'beam'" plan
"$build/abut" run strike.yaml --strict --quiet -j 1
[ -f results/strike/results_beam.xdmf ]
variants=0
while read -r line; do
    variants=$((variants + 1))
    eval "set -- ${line#abut run strike.yaml}"
    echo "$*"
    "$build/abut" run strike.yaml --strict --quiet -j 1 -o other "$@"
done < <(grep -E '^    abut run strike.yaml --set' "$page" | sed 's/^ *//')
[ $variants -eq 3 ]
