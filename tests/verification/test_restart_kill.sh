#!/bin/bash
# cost: 14
# Killed with -9 at 200 random moments, in the middle of a checkpoint or a frame or just after its start, a run can always be restarted, and comes to the same bits as one that was never killed.
# test_restart_kill.sh BUILD [KILLS]: 200
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$(realpath "${1:?the build folder}")
wanted=${2:-200}
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
wrong=0
say() { wrong=1; echo "$1"; [ -f "${2:-}" ] && sed 's/^/    /' "$2"; }
cat >"$scratch/scene.yaml" <<'SCENE'
abut: 1
title: A block of points falls onto a beam of elements
space: plane-strain
gravity: [0, -9.81]
time: {end: 0.06, cfl: 0.5}
grid: {from: [-1, -1], to: [2, 2], cell: 0.1}
materials:
  rubber: {model: von-mises, E: 1e5, nu: 0.3, density: 1000, yield: 1e3}
bodies:
  block: {method: material-points, material: rubber, shape: {box: [[0, 0.21], [0.3, 0.5]]}, velocity: [0.5, -2]}
  beam: {method: finite-elements, material: rubber, mesh: {box: [[-0.2, 0], [0.5, 0.2]], elements: [7, 2], type: q4}, fix: [{where: {side: bottom}, velocity: [0, 0]}]}
contact:
  - {bodies: [block, beam], algorithm: point-to-segment, response: penalty, friction: 0.3}
monitors:
  - {name: push, contact: 0, value: force.y}
history: {every: 1}
output: {every: 0.02, fields: [stress, velocity]}
checkpoint: {steps: 3}
SCENE
run() { "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 "$@"; }
run -o "$scratch/whole" >"$scratch/whole.log" 2>&1 || { say "the run that is not killed: exit $?" "$scratch/whole.log"; exit 1; }
began=$(date +%s%N)
run -o "$scratch/timed" >/dev/null 2>&1
took=$((($(date +%s%N) - began) / 1000000)) # ms
[ $took -lt 900 ] || took=900               # a busy machine: kills come early then
kills=0 restarts=0 round=0 pairs=()
while [ $kills -lt "$wanted" ]; do
    out=$scratch/$((++round))
    mkdir "$out"
    options=()
    for _ in 1 2 3 4 5; do # killed, and killed again after each restart
        "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$out" "${options[@]}" >"$out.log" 2>&1 &
        process=$!
        sleep "$(printf '0.%03d' $((RANDOM % (took + 10))))"
        kill -9 $process 2>/dev/null
        wait $process 2>/dev/null
        status=$?
        [ $status -eq 0 ] && break
        [ $status -eq 137 ] || { say "round $round: exit $status after $kills kills" "$out.log"; break 2; }
        kills=$((kills + 1))
        [ -f "$out/checkpoint.abut" ] && options=(--restart "$out/checkpoint.abut") && restarts=$((restarts + 1))
    done
    run -o "$out" "${options[@]}" -j 2 >"$out.log" 2>&1 || { say "round $round: the restart ends with $?" "$out.log"; continue; }
    pairs+=("$scratch/whole" "$out")
done
/usr/bin/python3 tests/verification/same_results.py "$scratch/whole" "$scratch/timed" "${pairs[@]}" || wrong=1
[ $restarts -gt $((wanted / 4)) ] || say "only $restarts of $kills kills came after a first checkpoint"
echo "$kills runs killed, $restarts restarted from a checkpoint"
exit $wrong
