#!/bin/bash
# cost: 10
# A run that goes on from a checkpoint in its middle, on another number of threads, has the same bits as the one that never stopped: every row of history.csv and every field, of
# scenes of every kind. What is no checkpoint of this scene and version is refused by name, and so is one that is damaged at any place. test_checkpoint.sh BUILD
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$(realpath "${1:?the build folder}")
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
wrong=0 pairs=()
say() { wrong=1; echo "$1"; [ -f "${2:-}" ] && sed 's/^/    /' "$2"; }
run() { "$build/abut" run "$1" --quiet "${@:2}"; }

# kind NAME STEPS END [OPTION]...: the scene up to that time, with a checkpoint every so many steps; from the last but one to the end once more.
kind() {
    local name=$1 steps=$2 end=$3 scene=$scratch/$1.yaml out=$scratch/$1 options
    [ -f "$scene" ] || scene=tests/verification/$name.yaml
    options=(--set time.end="$end" --set "output={every: $end/5, fields: [velocity, stress]}" "${@:4}")
    run "$scene" -j 1 -o "$out" --set checkpoint.steps="$steps" "${options[@]}" >"$out.log" 2>&1 || { say "$name: exit $?" "$out.log"; return; }
    cp -r "$out" "$out.again"
    run "$scene" -j 2 -o "$out.again" --restart "$out/checkpoint.previous.abut" "${options[@]}" >"$out.log" 2>&1 || { say "$name: exit $? of the restart" "$out.log"; return; }
    pairs+=("$out" "$out.again")
}

# Everything that a body of points can have beside contact: points that leave, damping that ends, a random fill, first strain then motion, a body force, f_bar.
cat >"$scratch/points.yaml" <<'SCENE'
abut: 1
gravity: [0, -9.81]
damping: {local: 0.2, until: 0.06}
time: {end: 0.1, cfl: 0.4}
grid: {from: [-2, 0], to: [2, 3], cell: 0.25, sides: {bottom: fixed, right: outflow}}
materials:
  clay: {model: von-mises, E: 1e6, nu: 0.4, density: 1800, yield: 2e3}
  rubber: {model: neo-hookean, E: 1e5, nu: 0.3, density: 1000}
bodies:
  clay: {method: material-points, material: clay, shape: {disc: {center: [-0.8, 1], radius: 0.6}}, fill: {rule: cvt, points: 150, seed: 7}, update: usf, transfer: apic, velocity: ["1+y", "-5*x"]}
  flying: {method: material-points, material: rubber, shape: {box: [[1, 1], [1.9, 2]]}, velocity: [20, 3], basis: bspline2, f_bar: cell, transfer: {xpic: 2}}
  pulled: {method: material-points, material: rubber, shape: {box: [[0, 0], [0.5, 0.75]]}, basis: {gimp: contiguous}, body_force: ["10*sin(20*t)", "Y"]}
loads:
  - {body: pulled, where: {side: top}, pressure: "1e3*t"}
monitors:
  - {name: rms, body: clay, value: velocity.y, over: rms, minus: "X*t"}
  - {name: left, body: flying, value: mass}
expect:
  - {name: mean, monitor: rms, norm: mean, reference: 1, tolerance: 100}
SCENE
cat >"$scratch/rolling.yaml" <<'SCENE'
abut: 1
gravity: [0, -9.81]
time: {end: 0.05, cfl: 0.4}
grid: {from: [-2, -1], to: [2, 2], cell: 0.1}
materials:
  soft: {model: linear-elastic, E: 1e5, nu: 0.3, density: 1000}
bodies:
  disc: {method: material-points, material: soft, shape: {disc: {center: [0, 0.31], radius: 0.3}}, velocity: ["0.5+2*(y-0.31)", "-2*x-0.5"]}
  ground: {method: material-points, material: soft, shape: {box: [[-1, -0.4], [1, 0]]}}
  beam: {method: finite-elements, material: soft, mesh: {box: [[0.31, 0.05], [0.8, 0.5]], elements: [6, 6], type: q8r}, velocity: [-0.5, -0.5]}
contact:
  - {bodies: [disc, ground], algorithm: point-to-segment, response: penalty, friction: 0.3, stiffness: 0.5}
  - {bodies: [beam, ground], algorithm: multi-velocity, response: coulomb, friction: 0.3}
  - {bodies: [disc, beam], algorithm: point-to-segment, response: coulomb, friction: 0.3}
SCENE
# So deep in each other that a point finds its face only by what the steps before know: by how much bodies overlapped, and how long faces were at the start.
cat >"$scratch/deep.yaml" <<'SCENE'
abut: 1
gravity: [0, -10]
time: {end: 0.12, cfl: 0.5}
materials:
  soft: {model: linear-elastic, E: 1e5, nu: 0.3, density: 1000}
bodies:
  block: {method: finite-elements, material: soft, mesh: {box: [[0, 0], [1, 0.4]], elements: [10, 4], type: q4}}
  plate: {method: finite-elements, material: soft, mesh: {box: [[0.15, 0.401], [0.85, 0.7]], elements: [7, 3], type: q4}, velocity: [0, -3]}
contact:
  - {bodies: [block, plate], algorithm: point-to-segment, response: penalty, stiffness: 0.01, friction: 0.3}
monitors:
  - {name: depth, contact: 0, value: penetration}
  - {name: push, contact: 0, value: force.y}
SCENE

kind points 40 0.1
kind deep 11 0.12
kind rolling 50 0.05
kind bar_transfers 40 1
kind ring 20 0.01 --set constants.cells=24 --set bodies.ring.update=usavg --set expect=[]
kind vortex 30 0.2
kind hertz_points 100 0.01
kind springs_slide 25 0.3
kind penalty_corner 40 0.05
kind rigid_push 50 0.05
kind impact_fe_mpm 190 3
kind fe_column_von_mises 100 2
kind fe_spin 150 0.5
kind pressed_carried 50 10
kind belt 150 0.1
kind axi_tube 100 0.3
kind free_field 40 0.3

# In a folder of its own a run that goes on begins there. Checkpoints do not change a run; a guard before its plugins, its monitors, its end may be others.
run "$scratch/rolling.yaml" -j 1 -o "$scratch/plain" --set "output={every: 0.05/5, fields: [velocity, stress]}" || say "rolling without checkpoints: exit $?"
run "$scratch/rolling.yaml" -j 1 -o "$scratch/new" --restart "$scratch/rolling/checkpoint.previous.abut" --set "output={every: 0.05/5, fields: [velocity, stress]}" --set checked=true ||
    say "a restart in a new folder: exit $?"
pairs+=("$scratch/rolling" "$scratch/plain")
/usr/bin/python3 tests/verification/same_results.py "${pairs[@]}" || wrong=1
/usr/bin/python3 tests/verification/same_results.py --later "$scratch/rolling" "$scratch/new" || wrong=1
[ $(wc -l <"$scratch/rolling/history.csv") -gt $(wc -l <"$scratch/new/history.csv") ] || say "the new folder has the rows before the checkpoint too"

[ $wrong -eq 0 ] || exit 1

# Where the watchdog has ended a run, it goes on from there with a watchdog that does not.
flying=(--set constants.cells=40 --set constants.frame=0.02 --set 'contact[0].gap=none' --set bodies.a.basis=linear --set bodies.b.basis=linear --set 'time={end: 35, cfl: 0.9}' --set expect=[])
run tests/verification/impact.yaml -j 1 -o "$scratch/wild" "${flying[@]}" >"$scratch/wild.log" 2>&1
[ $? -eq 1 ] && grep -q "the run makes energy" "$scratch/wild.log" || say "the watchdog does not end a run that makes energy" "$scratch/wild.log"
run tests/verification/impact.yaml -j 1 -o "$scratch/wild" --restart "$scratch/wild/checkpoint.abut" "${flying[@]}" --set watchdog.stop=false >"$scratch/wild.log" 2>&1 ||
    say "a run that the watchdog has ended does not go on: exit $?" "$scratch/wild.log"
run tests/verification/impact.yaml -j 1 -o "$scratch/tame" "${flying[@]}" --set watchdog.stop=false >"$scratch/wild.log" 2>&1 || say "exit $?" "$scratch/wild.log"
/usr/bin/python3 tests/verification/same_results.py "$scratch/tame" "$scratch/wild" || wrong=1

# refused STATUS TEXT OPTION...: the restart ends so, says that, and leaves the folder as it was.
good=$scratch/points/checkpoint.abut
refused() {
    local before after
    before=$(cd "$scratch/points" && md5sum * 2>&1)
    run "$scratch/points.yaml" -o "$scratch/points" "${@:3}" >"$scratch/refused.log" 2>&1
    [ $? -eq "$1" ] || say "${*:3}: another exit status than $1" "$scratch/refused.log"
    grep -qF -- "$2" "$scratch/refused.log" || say "${*:3}: does not say '$2'" "$scratch/refused.log"
    after=$(cd "$scratch/points" && md5sum * 2>&1)
    [ "$before" = "$after" ] || say "${*:3}: the folder has changed"
}
refused 2 "'bodies.clay.update: \"usf\"' was there, 'bodies.clay.update: \"usl\"' is now" --restart "$good" --set bodies.clay.update=usl
refused 2 "has other columns than this scene" --restart "$good" --set monitors=[] --set expect=[]
refused 2 "its fields have changed since the checkpoint" --restart "$good" --set "output={every: 0.1/5, fields: [mass]}"
refused 2 "time.end of the scene is 0.01 s: write a later one" --restart "$good" --set time.end=0.01
refused 2 "cannot be opened: No such file or directory" --restart "$scratch/nothing.abut"
refused 2 "is no checkpoint of abut" --restart "$scratch/points.yaml"
refused 2 "is no file" --restart "$scratch/points"
size=$(stat -c %s "$good")
for bytes in 0 9 63 64 1000 $((size / 2)) $((size - 1)); do
    head -c $bytes "$good" >"$scratch/cut.abut"
    refused 2 "checkpoint '$scratch/cut.abut': is " --restart "$scratch/cut.abut"
done
(cat "$good"; echo) >"$scratch/longer.abut"
refused 2 "is damaged: it has $((size + 1)) bytes and should have $size" --restart "$scratch/longer.abut"
for at in 0 17 25 33 37 64 80 $((size / 3)) $((size - 4)); do
    cp "$good" "$scratch/flipped.abut"
    printf "\\x$(printf %02x $(($(od -An -tu1 -j "$at" -N 1 "$good") ^ 32)))" | dd of="$scratch/flipped.abut" bs=1 seek="$at" conv=notrunc status=none
    refused 2 "checkpoint '$scratch/flipped.abut': " --restart "$scratch/flipped.abut"
done
cp "$good" "$scratch/other.abut"
printf '9.8.7\0' | dd of="$scratch/other.abut" bs=1 seek=36 conv=notrunc status=none
refused 2 "was written by abut 9.8.7" --restart "$scratch/other.abut"
cp -r "$scratch/points" "$scratch/altered"
sed -i '3s/0/1/' "$scratch/altered/history.csv"
run "$scratch/points.yaml" -o "$scratch/altered" --restart "$good" >"$scratch/altered.log" 2>&1
[ $? -eq 2 ] && grep -q "is not the one that the checkpoint was written beside" "$scratch/altered.log" || say "a history.csv that was altered is not noticed" "$scratch/altered.log"
exit $wrong
