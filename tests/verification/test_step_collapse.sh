#!/bin/bash
# cost: 1
# A step by cfl that falls without end stops the run: a body whose speed grows as h/(T - t) would take its cells in ever shorter steps and never reach T. The error
# says when, how far the step fell, by which limit and what to do; what was computed can be read. A step that only ends on time is no collapse.
# test_step_collapse.sh BUILD
set -eu
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
scene() { # end, gravity
    cat <<YAML
abut: 1
constants: {h: 1, T: 1, C: 1.5}
gravity: ["$2", 0]
time: {end: $1, cfl: 0.4}
grid: {from: [0, 0], to: [100, 4], cell: h}
materials: {m: {model: linear-elastic, E: 1, nu: 0, density: 1}}
bodies:
  rocket: {method: material-points, material: m, shape: {box: [[1, 1], [3, 3]]}}
monitors:
  - {name: v, body: rocket, value: velocity.x}
history: {every: 1}
YAML
}
scene 2 "C*h/(T - t)^2" >"$scratch/collapse.yaml"
status=0
"$build/abut" run "$scratch/collapse.yaml" --quiet -j 1 -o "$scratch/collapse" >"$scratch/log" 2>&1 || status=$?
cat "$scratch/log"
[ $status -eq 1 ] || { echo "ended with status $status"; exit 1; }
for words in 'error: at 0.99999999[0-9]* s, after' 'collapsed to [0-9.]*e-10 s' "limit: points of 'rocket' at 1[0-9.]*e.09 m/s, wave speed 1 m/s" 'use a smaller cfl' 'is in the results'; do
    grep -q "$words" "$scratch/log" || { echo "the error does not say: $words"; exit 1; }
done
python3 - "$scratch/collapse" <<'PYTHON'
import csv
import json
import sys

folder = sys.argv[1]
with open(f"{folder}/summary.json") as stream:
    summary = json.load(stream)
assert summary["outcome"].startswith("failed: error: at 0.99999999"), summary["outcome"]
with open(f"{folder}/history.csv") as stream:
    rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
assert len(rows) == summary["steps"] + 1 > 50, len(rows)
t, v = float(rows[-2]["t"]), float(rows[-2]["v"])
assert 0.5 < v * (1 - t) / 1.5 < 2, (t, v)  # what it should be: C h/(T - t)
PYTHON

# An end that leaves 1e-12 of a step to go
scene "0.2*20*(1 + 1e-12)" 0 >"$scratch/end.yaml"
"$build/abut" run "$scratch/end.yaml" --quiet -j 1 -o "$scratch/end"

# The collapse is seen between two steps, so there is a checkpoint of that moment. A failure within a step has no whole state: the checkpoint before is named, from which the same bits come again, with
# as many frames as one likes; or it is said that there is none.
[ -f "$scratch/collapse/checkpoint.abut" ] || { echo "a collapse leaves no checkpoint"; exit 1; }
fails() { # what it says on its way, settings: the body flies through the side of the grid
    local says=$1 status=0
    shift
    "$build/abut" run "$scratch/wall.yaml" -j 1 -o "$scratch/wall" "$@" >"$scratch/log" 2>&1 || status=$?
    [ $status -eq 1 ] && grep -qE "$says" "$scratch/log" || { cat "$scratch/log"; echo "ended with status $status, wanted 1 and: $says"; exit 1; }
    failures=$((failures + 1))
    sed -n "s/^error: //p" "$scratch/log" >"$scratch/error_$failures"
}
failures=0
scene 10 2 | sed "s/100, 4/20, 4/" >"$scratch/wall.yaml"
fails "there is no checkpoint: with checkpoint: "
fails "the last checkpoint is of step [0-9]*0; --restart $scratch/wall/checkpoint.abut computes the same bits" --set checkpoint.steps=10
fails "there is no checkpoint since; --restart $scratch/wall/checkpoint.abut computes" --restart "$scratch/wall/checkpoint.abut" --set output.every=1e-4
cmp "$scratch/error_2" "$scratch/error_3" && grep -q "left the grid" "$scratch/error_3"
