#!/bin/bash
# cost: 40
# Points and their grid, from outside: a point that leaves, an outflow side, a far place, an empty grid, threads; and the scenes of single bodies on a
# shifted grid and turned by 90 degrees. test_points.sh BUILD
set -eu
build=${1:?the build folder}
build=$(realpath "$build")
here=$(cd "$(dirname "$0")" && pwd)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
fail() { echo "FAILED: $1"; exit 1; }
run() { "$build/abut" run "$@" --quiet -j 1; }

cat >thrown.yaml <<'YAML'
abut: 1
space: plane-strain
time: {end: 1, dt: 5e-4}
gravity: [0, -9.81]
constants: {u: 3, v: 2}
grid: {from: [-1, -2], to: [3, 2], cell: 0.1}
materials: {stone: {model: linear-elastic, E: 1e5, nu: 0.3, density: 1000}}
bodies: {stone: {method: material-points, material: stone, shape: {box: [[0, 0], [0.5, 0.4]]}, velocity: [u, v]}}
history: {every: 1}
YAML

# A point that leaves stops the run, by name.
status=0
run thrown.yaml -o left --set constants.u=6 2>left.txt || status=$?
[ $status -eq 1 ] || fail "a point left the grid and the run ended with $status"
for said in "body 'stone'" "point [0-9]+ " "right side" "t = 0\.4" "make the grid larger" "outflow"; do
    grep -qE "$said" left.txt || fail "'$said' is not in: $(cat left.txt)"
done

# Outflow counts them out, and the ledger books what they carry; half of a block that flies straight leaves, then all of it.
run thrown.yaml -o out --set 'gravity=[0, 0]' --set 'grid.sides={right: outflow}' --set 'constants={u: 6, v: 0}' --set time.end=0.6
run thrown.yaml -o half --set 'gravity=[0, 0]' --set 'grid.sides={right: outflow}' --set 'constants={u: 5, v: 0}' --set time.end=0.55
run thrown.yaml -o falls --set 'grid.sides={bottom: outflow}' --set constants.u=0 --set constants.v=0
python3 - <<'PYTHON'
import csv, json

def rows(name):
    with open(f"{name}/history.csv") as stream:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(stream)]

start = 0.5 * 1000 * 0.2 * 36
out = rows("out")
assert abs(out[0]["kinetic"] - start) < 1e-9 * start
for row in out:
    assert abs(row["kinetic"] + row["outflow"] - start) < 1e-9 * start, row
    assert abs(row["remainder"]) < 1e-9 * start, row
assert out[-1]["kinetic"] == 0 and abs(out[-1]["outflow"] - start) < 1e-9 * start
start = 0.5 * 1000 * 0.2 * 25
half = rows("half")
assert abs(half[-1]["kinetic"] - start / 2) < 0.06 * start and abs(half[-1]["kinetic"] + half[-1]["outflow"] - start) < 1e-9 * start
falls = rows("falls") # the centre of each row of points has fallen by its height above the bottom when it leaves
work = 1000 * 0.2 * 9.81 * 2.2
assert falls[-1]["kinetic"] == 0 and abs(falls[-1]["outflow"] - work) < 0.01 * work, (falls[-1], work)
assert max(abs(row["remainder"]) for row in falls) < 1e-6 * work, max(abs(row["remainder"]) for row in falls)
print("points leave: counted and booked")
PYTHON

# A million cells away from the grid's corner, and with the whole scene a million cells away: the same answer.
for place in 0 1e6; do
    cat >far.yaml <<YAML
abut: 1
space: plane-strain
time: {end: 0.05, dt: 5e-4}
constants: {far: "$place/8"}
gravity: [0, -9.81]
grid: {from: [-4, -4], to: ["far+4", "far+4"], cell: 0.125}
materials: {stone: {model: linear-elastic, E: 1e5, nu: 0.3, density: 1000}}
bodies: {stone: {method: material-points, material: stone, shape: {box: [["far", "far"], ["far+1", "far+0.5"]]}, velocity: ["1+y-far", "0.5*(x-far)"]}}
monitors:
  - {name: x, body: stone, value: displacement.x, over: max}
  - {name: y, body: stone, value: displacement.y, over: min}
  - {name: xx, body: stone, value: stress.xx, over: max}
  - {name: xy, body: stone, value: stress.xy, over: min}
YAML
    run far.yaml -o far_$place
    "$build/abut" plan far.yaml --json >plan_$place.json
done
python3 - <<'PYTHON'
import csv, json

def last(name):
    with open(f"{name}/history.csv") as stream:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(stream)][-1]

near, far = last("far_0"), last("far_1e6")
sizes = {"x": 0.05, "y": 0.05, "xx": 1e4, "xy": 1e4, "kinetic": 500, "strain": 50}
worst = max(abs(near[k] - far[k]) / size for k, size in sizes.items())
print(f"a million cells away: apart by {worst:.1e}") # places have 1e-16 of 1.25e5 m
assert worst < 1e-7
plans = [json.load(open(f"plan_{place}.json")) for place in ("0", "1e6")]
assert plans[0]["points"] == plans[1]["points"]
assert abs(plans[0]["bytes"] - plans[1]["bytes"]) <= 0.01 * plans[0]["bytes"], [p["bytes"] for p in plans]
PYTHON

# The same bits for 1, 2 and 3 threads: enough points that three of them work.
cat >threads.yaml <<'YAML'
abut: 1
space: plane-strain
time: {end: 0.012, dt: 2e-4}
grid: {from: [-2, -2], to: [2, 2], cell: 0.02}
materials: {stone: {model: neo-hookean, E: 1e5, nu: 0.3, density: 1000}}
bodies: {stone: {method: material-points, material: stone, shape: {disc: {center: [0, 0], radius: 1}}, velocity: ["3-8*y", "8*x"]}}
output: {fields: [stress, velocity]}
YAML
points=$("$build/abut" plan threads.yaml --json | python3 -c 'import json,sys; print(json.load(sys.stdin)["points"])')
[ "$points" -gt 20000 ] || fail "only $points points"
for update in musl usf; do
    for threads in 1 2 3; do
        OMP_WAIT_POLICY=passive "$build/abut" run threads.yaml --quiet -j $threads -o ${update}_$threads --set bodies.stone.update=$update
        cmp ${update}_1/history.csv ${update}_$threads/history.csv || fail "history.csv differs on $threads threads ($update)"
    done
    python3 - $update <<'PYTHON'
import sys
import h5py

def datasets(path):
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.update({name: item[()].tobytes()}) if isinstance(item, h5py.Dataset) else None)
    return found

first = datasets(f"{sys.argv[1]}_1/results.h5")
for threads in (2, 3):
    assert datasets(f"{sys.argv[1]}_{threads}/results.h5") == first, f"results.h5 differs on {threads} threads"
PYTHON
done
echo "$points points: the same bits on 1, 2 and 3 threads"

# The scenes of single bodies on a grid moved by 0.37 of a cell, and turned by 90 degrees: every expect holds again.
again() { # name, what, options
    run "$here/$1.yaml" -o again --strict "${@:3}" >again.txt 2>&1 || fail "$1 $2: $(cat again.txt; python3 "$here/expects.py" again/summary.json | grep MISSED)"
    echo "$1 $2"
}
turned=(--set constants.turned=1)
for scene in fall pulse translation column column_neo_hookean column_von_mises; do again $scene shifted --set constants.shift=0.37; done
again bar_1 turned "${turned[@]}" --set 'grid.sides={left: roller, right: roller, bottom: roller, top: free}' --set monitors[0].value=velocity.y --set monitors[1].value=velocity.x --set monitors[2].value=stress.yy
again pulse turned "${turned[@]}" --set 'grid.sides={bottom: roller, top: roller}' --set 'loads[0]={body: column, where: {side: right}, traction: ["-p*exp(-((t-t0)/s)^2)", 0]}' \
    --set monitors[3].value=stress.xx --set monitors[4].value=displacement.x --set monitors[5].value=displacement.x --set monitors[6].value=momentum.x
again translation turned --set constants.vx=-0.6 --set constants.vy=1 --set 'grid.from=["(shift-80)*h", "(shift-4)*h"]' --set 'grid.to=["(shift+20)*h", "(shift+120)*h"]' --set monitors[0].over=max --set monitors[1].over=min
