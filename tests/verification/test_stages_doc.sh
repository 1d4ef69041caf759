#!/bin/bash
# cost: 2
# The scene of docs/stages.md, cut out of the text, runs and meets its expects. test_stages_doc.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
page=$(realpath docs/stages.md)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
sed -n '/^```yaml$/,/^```$/{/^```/!p}' "$page" >bank.yaml
"$build/abut" check bank.yaml
"$build/abut" run bank.yaml --strict --quiet -j 1
