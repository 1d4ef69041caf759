#!/bin/bash
# cost: 3
# What a run leaves opens elsewhere and says what history.csv says. test_results.sh BUILD
set -eu
cd "$(dirname "$0")/../.."
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
cat >"$scratch/scene.yaml" <<'SCENE'
abut: 1
title: Two blocks that meet, <watched> & "written"
space: plane-strain
time: {end: 0.02, cfl: 0.4}
grid: {from: [-2, -1], to: [2, 1], cell: 0.1}
materials:
  rubber: {model: linear-elastic, E: 1e5, nu: 0.3, density: 1000}
bodies:
  left: {method: material-points, material: rubber, shape: {box: [[-1, -0.5], [0, 0.5]]}, fill: {rule: regular, per_cell: 4}, velocity: [1, 0]}
  right: {method: material-points, material: rubber, shape: {box: [[0, -0.4], [1, 0.4]]}, fill: {rule: regular, per_cell: 9}, velocity: [-1, 0.5]}
contact:
  - {bodies: [left, right], algorithm: multi-velocity, response: coulomb, friction: 0.2}
monitors:
  - {name: left_x, body: left, value: position.x, over: mass}
  - {name: right_high, body: right, value: position.y, over: max}
  - {name: left_slow, body: left, value: velocity.x, over: min}
  - {name: left_shear, body: left, value: stress.xy, over: max}
  - {name: left_press, body: left, value: stress.xx, over: min}
history: {every: 1}
output: {every: 0.004, fields: [stress, velocity]}
expect:
  - {name: it was sampled, monitor: left_x, reference: 0, norm: final, tolerance: 10}
SCENE
"$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$scratch/out" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
/usr/bin/python3 tests/verification/check_results.py "$scratch/out" left_x=position.x:left:mean right_high=position.y:right:max \
    left_slow=velocity.x:left:min left_shear=stress.xy:left:max left_press=stress.xx:left:min
