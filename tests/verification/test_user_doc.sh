#!/bin/bash
# The scene of docs/user.md, cut out of the text, checks, runs, meets its expect, and slides as far as the text says. test_user_doc.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
page=$(realpath docs/user.md)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
sed -n '/^```yaml$/,/^```$/{/^```/!p}' "$page" >slide.yaml
"$build/abut" check slide.yaml
"$build/abut" plan slide.yaml
"$build/abut" run slide.yaml --strict --quiet
for option in constants.mu=0.5 'contact[0].response=frictionless' grid.cell=0.025; do
    grep -qF -- "--set $option" "$page" || grep -qF -- "--set '$option'" "$page"
    "$build/abut" run slide.yaml --quiet --set "$option" --set expect=[] --set time.end=0.01 -o other
done
python3 - "$page" <<'PYTHON'
import json
import re
import sys

said = float(re.search(r"the block slides ([0-9.]+) m", open(sys.argv[1]).read()).group(1))
found = json.load(open("results/slide/summary.json"))["expects"][0]["value"] - 0.7
print(f"the text says {said} m, the run {found:.5f} m")
assert abs(found - said) < 0.002, "the text and the run differ"
PYTHON
