#!/bin/bash
# cost: 12
# Killed with -9 at any moment, in the middle of a checkpoint or a frame or just after its start, a run can be restarted: in the end it has the same bits as one that was
# never killed. test_restart_kill.sh BUILD [ROUNDS]: 20; slow_restart_kill.sh does 200
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$(realpath "${1:?the build folder}")
rounds=${2:-20}
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
wrong=0
say() { wrong=1; echo "$1"; [ -f "${2:-}" ] && sed 's/^/    /' "$2"; }
cat >"$scratch/scene.yaml" <<'SCENE'
abut: 1
title: A block of points falls onto a beam of elements
space: plane-strain
gravity: [0, -9.81]
time: {end: 0.1, cfl: 0.5}
grid: {from: [-1, -1], to: [2, 2], cell: 0.1}
materials:
  rubber: {model: von-mises, E: 1e5, nu: 0.3, density: 1000, yield: 1e3}
bodies:
  block: {method: material-points, material: rubber, shape: {box: [[0, 0.31], [0.5, 0.8]]}, velocity: [0.5, -2]}
  beam: {method: finite-elements, material: rubber, mesh: {box: [[-0.5, 0], [1, 0.3]], elements: [15, 3], type: q4}, fix: [{where: {side: bottom}, velocity: [0, 0]}]}
contact:
  - {bodies: [block, beam], algorithm: point-to-segment, response: penalty, friction: 0.3}
monitors:
  - {name: push, contact: 0, value: force.y}
history: {every: 1}
output: {every: 0.005, fields: [stress, velocity]}
checkpoint: {steps: 9}
SCENE
run() { "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 "$@"; }
run -o "$scratch/whole" >"$scratch/whole.log" 2>&1 || { say "the run that is not killed: exit $?" "$scratch/whole.log"; exit 1; }
began=$(date +%s%N)
run -o "$scratch/timed" >/dev/null 2>&1
took=$((($(date +%s%N) - began) / 1000000)) # ms
restarts=0 pairs=()
for round in $(seq "$rounds"); do
    out=$scratch/$round
    mkdir "$out"
    options=()
    for _ in 1 2; do # killed, and again after the restart
        "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$out" "${options[@]}" >"$out.log" 2>&1 &
        process=$!
        sleep "$(printf '0.%03d' $((RANDOM % (took < 900 ? took + 50 : 950))))"
        kill -9 $process 2>/dev/null
        wait $process 2>/dev/null
        status=$?
        [ $status -eq 137 ] || [ $status -eq 0 ] || { say "round $round: exit $status" "$out.log"; break; }
        options=()
        [ -f "$out/checkpoint.abut" ] && options=(--restart "$out/checkpoint.abut")
    done
    [ ${#options[@]} -gt 0 ] && restarts=$((restarts + 1))
    run -o "$out" "${options[@]}" -j 2 >"$out.log" 2>&1 || { say "round $round: the restart ends with $?" "$out.log"; continue; }
    pairs+=("$scratch/whole" "$out")
done
/usr/bin/python3 tests/verification/same_results.py "$scratch/whole" "$scratch/timed" "${pairs[@]}" || wrong=1
[ $restarts -gt 0 ] || say "no round came as far as a checkpoint"
echo "$rounds runs killed, $restarts restarted from a checkpoint"
exit $wrong
