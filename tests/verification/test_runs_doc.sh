#!/bin/bash
# cost: 2
# The scene and the commands of docs/runs.md, cut out of the page, do what the page says. test_runs_doc.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
page=$(realpath docs/runs.md)
checker=$(realpath tests/verification/same_results.py)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
mkdir -p bin
ln -sf "$build/abut" bin/abut
PATH=$PWD/bin:$PATH
sed -n '/^```yaml$/,/^```$/{/^```/!p}' "$page" >drop.yaml
awk '/^<!-- run -->$/ {run = 1; next} run && /^```sh$/ {inside = 1; next} /^```$/ {run = inside = 0} inside' "$page" >commands
[ "$(wc -l <commands)" -ge 7 ]
bash -eux commands
/usr/bin/python3 "$checker" whole twice
[ "$(tail -1 drop/history.csv | cut -d, -f1)" = "$(tail -1 whole/history.csv | cut -d, -f1)" ]
said=$(sed -n 's/^<!-- says: \(.*\) -->$/\1/p' "$page")
command=$(awk '/^<!-- says: / {run = 1; next} run && /^```sh$/ {inside = 1; next} /^```$/ {run = inside = 0} inside' "$page")
if bash -c "$command" >out 2>&1; then exit 1; fi
grep -qF -- "$said" out || { cat out; exit 1; }
