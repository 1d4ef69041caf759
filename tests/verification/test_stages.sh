#!/bin/bash
# cost: 8
# Initial stress and stages beyond what their scenes show: meshes, elements, rings; a run that goes on from a checkpoint in either stage has the same bits; what cannot be is said. test_stages.sh BUILD
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$(realpath "${1:?the build folder}")
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
wrong=0
say() { wrong=1; echo "$1"; [ -f "${2:-}" ] && sed 's/^/    /' "$2"; }
passes() { "$build/abut" run "$1" --strict --quiet -j 1 -o "$scratch/out" "${@:2}" >"$scratch/log" 2>&1 || say "${*}: exit $?" "$scratch/log"; }
# refuses STATUS TEXT SCENE OPTION...
refuses() {
    "$build/abut" run "$3" --quiet -j 1 -o "$scratch/refused" "${@:4}" >"$scratch/log" 2>&1
    local status=$?
    [ $status -eq "$1" ] && grep -qF -- "$2" "$scratch/log" || say "${*:3}: exit $status, and does not say '$2'" "$scratch/log"
}
ground=tests/verification/k0_ground.yaml column=tests/verification/stages_column.yaml

# Level ground: at rest to rounding at two meshes and with other bases, in rings, of finite elements, turned by a quarter; the second order of the cell where points lie across its lines.
passes $ground --set constants.cells=16
passes $ground --set constants.above=0.3
passes $ground --set constants.above=0.3 --set constants.cells=16
passes $ground --set bodies.ground.basis=linear
passes $ground --set bodies.ground.basis=cpdi
passes $ground --set space=axisymmetric
passes $ground --set 'materials.soil={model: mohr-coulomb, E: E, nu: nu, density: rho, cohesion: 0, friction: "30 deg"}' --set 'constants.K0=0.5'
cat >"$scratch/elements.yaml" <<'SCENE'
abut: 1
gravity: [-10, 0]
constants: {cells: 4}
time: {end: 0.1, cfl: 0.8}
materials:
  soil: {model: linear-elastic, E: 1e7, nu: 0.3, density: 2000}
bodies:
  ground:
    method: finite-elements
    material: soil
    mesh: {box: [[0, 0], [2, 1]], elements: ["2*cells", cells], type: q4}
    fix: [{where: {side: left}, velocity: [0, 0]}, {where: {side: bottom}, velocity: [null, 0]}, {where: {side: top}, velocity: [null, 0]}]
    initial: {stress: K0, surcharge: "2 kPa"}
loads:
  - {body: ground, where: {side: right}, pressure: 2e3}
monitors:
  - {name: fastest, body: ground, value: speed, over: max}
  - {name: first, body: ground, value: stress.xx, over: volume}
expect:
  - {name: at rest, monitor: fastest, reference: 0, norm: max, tolerance: 1e-10}
  - {name: mean stress, monitor: first, reference: -2.2e4, norm: max, tolerance: 1e-10}
SCENE
passes "$scratch/elements.yaml"
passes "$scratch/elements.yaml" --set constants.cells=8
passes "$scratch/elements.yaml" --set 'bodies.ground.initial={stress: ["-2e3-2e4*(2-x)", "-(2e3+2e4*(2-x))*3/7", "-(2e3+2e4*(2-x))*3/7", 0]}'
# Modified Cam clay keeps the ellipse through its stress: normally consolidated, it stays at rest and pc is p + q^2/(M^2 p).
cat >"$scratch/clay.yaml" <<'SCENE'
abut: 1
gravity: [0, -10]
constants: {h: 0.25}
time: {end: 0.05, cfl: 0.5}
grid: {from: [0, 0], to: [1, 3], cell: h, sides: {left: roller, right: roller, bottom: roller}}
materials:
  clay: {model: modified-cam-clay, kappa: 0.02, lambda: 0.1, M: 1, nu: 0.3, density: 2000, void_ratio: 1, pressure: 1e4}
bodies:
  ground: {method: material-points, material: clay, shape: {box: [[0, 0], [1, 2]]}, initial: {stress: K0, K0: 0.6, surcharge: "10 kPa"}}
loads:
  - {body: ground, where: {side: top}, pressure: 1e4}
monitors:
  - {name: pc, body: ground, value: preconsolidation, over: rms, minus: "(1e4+2e4*(2-Y))*(2.2/3+0.16*3/2.2)"}
  - {name: fastest, body: ground, value: speed, over: max}
expect:
  - {name: ellipse, monitor: pc, reference: 0, scale: 1e4, norm: max, tolerance: 1e-6}
  - {name: at rest, monitor: fastest, reference: 0, norm: max, tolerance: 1e-8}
SCENE
passes "$scratch/clay.yaml"

# The stage that gravity makes: before t = 0, on points and elements.
cat >"$scratch/made.yaml" <<'SCENE'
abut: 1
gravity: [0, -10]
time: {end: 0.05, cfl: 0.5}
grid: {from: [0, 0], to: [1, 1.5], cell: 0.125, sides: {left: roller, right: roller, bottom: roller}}
materials:
  soil: {model: linear-elastic, E: 1e7, nu: 0.3, density: 2000}
bodies:
  ground: {method: material-points, material: soil, shape: {box: [[0, 0], [1, 1]]}, initial: {stress: gravity}}
  pillar:
    method: finite-elements
    material: soil
    mesh: {box: [[0, 0], [1, 1]], elements: [4, 4], type: q8}
    fix: [{where: {side: left}, velocity: [0, null]}, {where: {side: right}, velocity: [0, null]}, {where: {side: bottom}, velocity: [null, 0]}]
monitors:
  - {name: points, body: ground, value: stress.yy, over: volume}
  - {name: elements, body: pillar, value: stress.yy, over: volume}
  - {name: moved, body: ground, value: displacement.y, over: min}
  - {name: moved_too, body: pillar, value: displacement.y, over: min}
expect:
  - {name: points, monitor: points, reference: -1e4, norm: max, tolerance: 1e-3}
  - {name: elements, monitor: elements, reference: -1e4, norm: max, tolerance: 1e-3}
  - {name: counted anew, monitor: moved, reference: 0, scale: 7.4e-4, norm: max, from: 1e-3, tolerance: 1e-3}
  - {name: counted anew too, monitor: moved_too, reference: 0, scale: 7.4e-4, norm: max, from: 1e-3, tolerance: 1e-3}
SCENE
passes "$scratch/made.yaml"

# A checkpoint in the first stage and one in the second; kinetic damping goes on, too.
for scene in $column tests/verification/fe_stages_column.yaml; do
    options=(--set constants.cells=6 --set "output={every: 0.01, fields: [velocity, stress, displacement]}" --set expect=[])
    "$build/abut" run $scene --quiet -j 1 -o "$scratch/whole" "${options[@]}" >"$scratch/log" 2>&1 || say "$scene: exit $?" "$scratch/log"
    steps=$(tail -1 "$scratch/whole/history.csv" | cut -d, -f2)
    first=$(awk -F, '$4 == 1 {n = $2} END {print n}' "$scratch/whole/history.csv")
    for at in $((first / 2)) $((first + (steps - first) / 2)); do
        rm -rf "$scratch/again"
        "$build/abut" run $scene --quiet -j 1 -o "$scratch/again" "${options[@]}" --set checkpoint.steps=$at >"$scratch/log" 2>&1 || say "$scene: exit $?" "$scratch/log"
        file=$scratch/again/checkpoint.previous.abut
        "$build/abut" run $scene --quiet -j 2 -o "$scratch/again" --restart "$file" "${options[@]}" --set checkpoint.steps=$at >"$scratch/log" 2>&1 || say "$scene: restart: exit $?" "$scratch/log"
        /usr/bin/python3 tests/verification/same_results.py "$scratch/whole" "$scratch/again" || wrong=1
    done
done
head -1 "$scratch/whole/history.csv" | grep -q '^t,step,dt,stage,kinetic' || say "history.csv has no column of the stage"
grep -q '"stages"' "$scratch/whole/summary.json" || say "summary.json does not name the stages"
"$build/abut" plan $column >"$scratch/log" 2>&1
grep -q "gravity" "$scratch/log" && grep -q "release" "$scratch/log" || say "the plan does not name the stages" "$scratch/log"

# What cannot be.
refuses 1 "stage 'gravity' has not come to rest by t = 0.12 s" $column --set 'stages[0].duration=0.12'
refuses 2 "does not bear the stress" $ground --set 'materials.soil={model: mohr-coulomb, E: E, nu: nu, density: rho, cohesion: 0, friction: "30 deg"}' --set bodies.ground.initial.K0=0.2
refuses 2 "there is none at the start" $ground --set materials.soil.model=neo-hookean
refuses 2 "has no rule of its own for K0" "$scratch/clay.yaml" --set 'bodies.ground.initial={stress: K0}'
refuses 2 "its mean stress must be below 0" "$scratch/clay.yaml" --set 'bodies.ground.initial.surcharge=-20 kPa'
refuses 2 "the scene has no gravity" $ground --set constants.g=0
refuses 2 "write gravity: keep there" tests/verification/k0_slope.yaml --set 'stages[0].gravity=ramp'
refuses 2 "kinetic damping would lose the strain" $column --set bodies.ground.update=usf
refuses 2 "there is no stage 'gravty'; did you mean 'gravity'?" tests/verification/fe_stages_column.yaml --set 'bodies.ground.fix[2].stages=gravty'
refuses 2 "the scene has no stages" "$scratch/elements.yaml" --set 'loads[0].stages=first'
exit $wrong
