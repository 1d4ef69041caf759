#!/bin/bash
# cost: 8
# Killed with -9 at any moment, in the middle of writing a frame or between two, a run leaves every frame it had finished: read by h5py and by
# meshio without any repair. test_kill.sh BUILD
set -eu
cd "$(dirname "$0")/../.."
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
cat >"$scratch/scene.yaml" <<'SCENE'
abut: 1
title: A block that falls, a frame in every step
space: plane-strain
gravity: [0, -9.81]
time: {end: 1000, dt: 1e-4}
grid: {from: [-8, -100], to: [8, 8], cell: 0.25}
materials:
  rubber: {model: linear-elastic, E: 1e5, nu: 0.3, density: 1000}
bodies:
  block: {method: material-points, material: rubber, shape: {box: [[-4, -4], [0, 4]]}, fill: {rule: regular, per_cell: 16}}
  other: {method: material-points, material: rubber, shape: {box: [[2, -4], [4, 4]]}, fill: {rule: regular, per_cell: 16}}
history: {every: 1}
output: {every: 1e-4, fields: [stress, velocity]}
SCENE
listed() { grep -c '<Time ' "$1/results.xdmf" 2>/dev/null || true; }
for round in 1 2 3 4; do # many more, and restarted: test_restart_kill.sh
    out=$scratch/$round
    "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$out" >"$out.log" 2>&1 &
    run=$!
    for _ in $(seq 600); do
        [ "$(listed "$out")" -ge $((round + 1)) ] 2>/dev/null && break
        kill -0 $run 2>/dev/null || break
        sleep 0.05
    done
    sleep 0.0$((RANDOM % 100 + 100))
    kill -0 $run || { cat "$out.log"; echo "the run ended by itself"; exit 1; }
    before=$(listed "$out")
    kill -9 $run
    wait $run 2>/dev/null || true
    /usr/bin/python3 tests/verification/check_results.py "$out" --partial
    [ "$(listed "$out")" -ge "$before" ] || { echo "results.xdmf lost frames"; exit 1; }
    rm -rf "$out"
done
echo "4 killed runs are readable"
