#!/bin/bash
# cost: 7
# What boundaries hold after a stage, beyond what scene fe_hold shows: another mesh, weight that leans, rings, corners that are not right angles, restarts with the same bits, what is not held falls; points that were stopped. test_hold.sh BUILD
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$(realpath "${1:?the build folder}")
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
wrong=0
say() { wrong=1; echo "$1"; [ -f "${2:-}" ] && sed 's/^/    /' "$2"; }
passes() { "$build/abut" run "$1" --strict --quiet -j 1 -o "$scratch/out" "${@:2}" >"$scratch/log" 2>&1 || say "${*}: exit $?" "$scratch/log"; }
misses() { "$build/abut" run "$1" --strict --quiet -j 1 -o "$scratch/out" "${@:2}" >"$scratch/log" 2>&1; local status=$?; [ $status -eq 3 ] || say "${*}: exit $status, not 3" "$scratch/log"; }
scene=tests/verification/fe_hold.yaml

passes $scene --set constants.n=2
passes $scene --set constants.lean=-3 --set 'expect[5].tolerance=10'
passes $scene --set space=axisymmetric --set 'bodies.c4.mesh.type=q8' --set 'expect[0].tolerance=1e-11' --set 'expect[4].reference=rho*g*2*pi*69' --set 'expect[5].tolerance=100' --set 'expect[7].tolerance=0.01'
# Not held: the block falls, and the springs do not count what it has settled by.
misses $scene --set 'boundaries[2].hold=false'

# What is held is kept in checkpoints: one in the stage in which it is, the same bits after it.
options=(--set "output={every: 0.2, fields: [velocity, stress]}" --set expect=[])
"$build/abut" run $scene --quiet -j 1 -o "$scratch/whole" "${options[@]}" >"$scratch/log" 2>&1 || say "$scene: exit $?" "$scratch/log"
steps=$(tail -1 "$scratch/whole/history.csv" | cut -d, -f2)
at=$((steps - 40))
"$build/abut" run $scene --quiet -j 1 -o "$scratch/again" "${options[@]}" --set checkpoint.steps=$at >"$scratch/log" 2>&1 || say "$scene: exit $?" "$scratch/log"
"$build/abut" run $scene --quiet -j 2 -o "$scratch/again" --restart "$scratch/again/checkpoint.previous.abut" "${options[@]}" --set checkpoint.steps=$at >"$scratch/log" 2>&1 || say "$scene: restart: exit $?" "$scratch/log"
/usr/bin/python3 tests/verification/same_results.py "$scratch/whole" "$scratch/again" || wrong=1

# Sides that lean, of a mesh from a file; K0 begins without a stage before.
cat >"$scratch/bank.msh" <<'MESH'
$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
9
1 0 0 0
2 2 0 0
3 4 0 0
4 0.5 1 0
5 2 1.1 0
6 3.2 1 0
7 0.9 2 0
8 1.9 2.1 0
9 2.5 2 0
$EndNodes
$Elements
4
1 3 2 1 1 1 2 5 4
2 3 2 1 1 2 3 6 5
3 3 2 1 1 4 5 8 7
4 3 2 1 1 5 6 9 8
$EndElements
MESH
cat >"$scratch/bank.yaml" <<'SCENE'
abut: 1
gravity: [-2, -10]
stages:
  - {name: settle, duration: 60, cfl: 0.8, gravity: ramp, ramp: 0.5, damping: {local: 0.5}, until: {unbalanced_force: 2e-11, kinetic_energy: 1e-10}, displacements: zero, velocities: zero}
  - {name: sides, duration: 0.05, cfl: 0.8}
  - {name: foot, duration: 0.05, cfl: 0.8}
materials:
  soil: {model: linear-elastic, E: 2e7, nu: 0.3, density: 2000}
bodies:
  bank:
    method: finite-elements
    material: soil
    mesh: {file: bank.msh, type: q4}
    fix:
      - {where: {y: 0}, velocity: [0, 0], stages: [settle, sides]}
      - {where: {side: left}, velocity: [0, 0], stages: settle}
boundaries:
  - {on: bank, where: {side: left}, boundary: viscous, stages: [sides, foot]}
  - {on: bank, where: {side: bottom}, boundary: viscous, stages: foot}
monitors:
  - {name: fastest, body: bank, value: speed, over: max}
  - {name: left, boundary: 0, value: force.x}
  - {name: foot, boundary: 1, value: force.y}
expect:
  - {name: at rest, monitor: fastest, norm: max, from: 60.0001, reference: 0, scale: 116, tolerance: 1e-12}
SCENE
passes "$scratch/bank.yaml"

# Points that were stopped at the end of a stage: what is held acts in the first step as long as their weight does, half of it.
cat >"$scratch/points.yaml" <<'SCENE'
abut: 1
gravity: [0, -10]
stages:
  - {name: settle, duration: 20, cfl: 0.5, gravity: ramp, ramp: 1, damping: {local: 0.7}, until: {unbalanced_force: 1e-6, kinetic_energy: 1e-6}, displacements: zero, velocities: zero}
  - {name: go, duration: 0.01, cfl: 0.5, sides: {bottom: free}}
grid: {from: [0, 0], to: [3, 5], cell: 0.5, sides: {bottom: fixed, left: roller, right: roller}}
materials:
  soil: {model: linear-elastic, E: 2e7, nu: 0.25, density: 1500}
bodies:
  ground: {method: material-points, material: soil, shape: {box: [[0, 0], [3, 4]]}}
boundaries:
  - {on: ground, where: {side: bottom}, boundary: viscous, stages: go}
monitors:
  - {name: fastest, body: ground, value: speed, over: max}
  - {name: foot, boundary: 0, value: force.y}
expect:
  - {name: hardly moves, monitor: fastest, norm: max, from: 20.0001, reference: 0, scale: 126, tolerance: 1e-4}
  - {name: its weight, monitor: foot, norm: max, from: 20.0001, reference: 1.8e5, tolerance: 0.03}
  - {name: ledger closes, column: remainder, norm: max, reference: 0, scale: 1000, tolerance: 1e-5}
SCENE
passes "$scratch/points.yaml"
exit $wrong
