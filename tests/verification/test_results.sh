#!/bin/bash
# cost: 3
# What a run leaves opens elsewhere and says what history.csv says. test_results.sh BUILD
set -eu
cd "$(dirname "$0")/../.."
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
"$build/abut" run tests/verification/two_blocks.yaml --quiet -j 1 -o "$scratch/out" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
/usr/bin/python3 tests/verification/check_results.py "$scratch/out" left_x=position.x:left:mean right_high=position.y:right:max \
    left_slow=velocity.x:left:min left_shear=stress.xy:left:max left_press=stress.xx:left:min
# Elements of both orders, rigid bodies with and without a mesh, no grid anywhere.
cat >"$scratch/meshes.yaml" <<'SCENE'
abut: 1
space: plane-strain
gravity: [0, -9.81]
time: {end: 0.1, dt: 1e-4}
materials: {stone: {model: von-mises, E: 1e7, nu: 0.3, density: 2000, yield: 1e9}}
bodies:
  table:
    method: finite-elements
    material: stone
    mesh: {box: [[0, 0], [2, 0.2]], elements: [16, 2], type: q8}
    fix: [{where: {side: left}, velocity: [0, 0]}, {where: {side: right}, velocity: [0, 0]}]
  plate: {method: finite-elements, material: stone, mesh: {box: [[0.1, 0.2], [0.9, 0.25]], elements: [8, 1], type: q4}}
  ball: {method: rigid, material: stone, shape: {disc: {center: [1.1, 0.301], radius: 0.1}}}
  cube: {method: rigid, material: stone, mesh: {box: [[1.4, 0.2], [1.6, 0.4]], elements: [2, 2], type: q4}}
contact:
  - {bodies: [plate, table], algorithm: point-to-segment, response: coulomb, friction: 0.3}
  - {bodies: [ball, table], algorithm: point-to-segment, response: coulomb, friction: 0.3}
  - {bodies: [cube, table], algorithm: point-to-segment, response: coulomb, friction: 0.3}
monitors:
  - {name: lowest, body: table, value: displacement.y, over: min}
  - {name: pressed, body: plate, value: stress.yy, over: min}
  - {name: ball_y, body: ball, value: position.y, over: max}
  - {name: cube_v, body: cube, value: velocity.y, over: min}
  - {name: held, body: table, value: reaction.y}
output: {every: 0.02, fields: [velocity, displacement, stress, plastic_strain]}
SCENE
"$build/abut" run "$scratch/meshes.yaml" --quiet -j 1 -o "$scratch/meshes" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
/usr/bin/python3 tests/verification/check_results.py "$scratch/meshes" lowest=displacement.y:table:min pressed=stress.yy:plate:min ball_y=position.y:ball:max \
    cube_v=velocity.y:cube:min
# A body of elements that is alone has its own file, too.
"$build/abut" run tests/verification/fe_bar.yaml --quiet -j 1 -o "$scratch/bar" --set 'output={fields: [stress, velocity]}' --set time.end=1 >"$scratch/log" 2>&1 ||
    { cat "$scratch/log"; exit 1; }
/usr/bin/python3 tests/verification/check_results.py "$scratch/bar"
[ -f "$scratch/bar/results_bar.xdmf" ]
# What ended a run that failed stands in its summary, not a warning that was given before.
"$build/abut" run tests/verification/two_blocks.yaml --quiet -j 1 -o "$scratch/failed" --set time.dt=0.05 --set time.end=50 --set "watchdog={stop: false}" >"$scratch/log" 2>&1 && { echo "a step far above the limit did not fail"; exit 1; }
grep -q 'warning: .*above the stable limit' "$scratch/log" || { cat "$scratch/log"; exit 1; }
grep -q '"outcome": "failed: [^w]*error: ' "$scratch/failed/summary.json" || { grep outcome "$scratch/failed/summary.json"; exit 1; }
