#!/bin/bash
# cost: 3
# Bodies of elements and rigid bodies that come at each other faster than waves: the step is limited by what lies between them, so that they meet; where dt is given, or a given
# motion leaps, the run stops and says so. What flies together costs nothing. test_fast_bodies.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
cd "${ABUT_SCRATCH:-$(mktemp -d)}" || exit 1
missed=0
check() { # name, condition as exit status
    if [ "$2" -eq 0 ]; then echo "passed  $1"; else echo "MISSED  $1"; missed=$((missed + 1)); fi
}
last() { # folder, expression over rows (of dicts of numbers)
    /usr/bin/python3 - "$1" "$2" <<'P'
import csv
import sys

rows = [{k: float(v) for k, v in r.items() if v} for r in csv.DictReader(open(f"{sys.argv[1]}/history.csv"))]
good = eval(sys.argv[2])
print(f"        {sys.argv[1]}: {len(rows)} rows, last {({k: rows[-1][k] for k in ('t', 'n', 'm') if k in rows[-1]})}")
sys.exit(not good)
P
}
elements() { # speed of both, speed of the first beyond that
    cat <<S
abut: 1
time: {end: 0.02, cfl: 0.5}
materials: {m: {model: linear-elastic, E: 1e6, nu: 0.3, density: 1000}}
bodies:
  f: {method: finite-elements, material: m, mesh: {box: [[0, 0], [1, 1]], elements: [4, 4], type: q4}, velocity: [$(($1 + $2)), 0]}
  g: {method: finite-elements, material: m, mesh: {box: [[3, -1], [3.2, 2]], elements: [1, 8], type: q4}, velocity: [$1, 0]}
contact: [{bodies: [f, g], algorithm: point-to-segment, response: coulomb}]
monitors: [{name: n, contact: 0, value: normal-force}, {name: m, body: g, value: momentum.x}]
history: {every: 1}
S
}
rigid() { # time, motion of the ram, finder
    cat <<S
abut: 1
time: {end: 0.05, $1}
grid: {from: [-2, -2], to: [120, 4], cell: 0.25}
materials: {m: {model: linear-elastic, E: 1e6, nu: 0.3, density: 1000}}
bodies:
  f: {method: rigid, shape: {box: [[0, 0], [1, 1]]}, motion: {velocity: [$2, 0], spin: 0}}
  g: {method: material-points, material: m, shape: {box: [[3, -1], [3.5, 2]]}}
contact: [{bodies: [f, g], algorithm: $3, response: coulomb}]
monitors: [{name: n, contact: 0, value: normal-force}, {name: m, body: g, value: momentum.x}]
history: {every: 1}
S
}
box() { # time
    cat <<S
abut: 1
time: {end: 1.2, $1}
gravity: [0, -9.81]
bodies:
  box: {method: rigid, shape: {box: [[-0.1, 2], [0.1, 2.2]]}, motion: {mass: 1}}
  floor: {method: rigid, shape: {box: [[-2, -0.05], [2, 0]]}, motion: {velocity: [0, 0], spin: 0}}
contact: [{bodies: [box, floor], algorithm: point-to-segment, response: coulomb}]
monitors: [{name: m, body: box, value: displacement.y}, {name: n, contact: 0, value: normal-force}]
history: {every: 1}
S
}
go() { "$build/abut" run "$1.yaml" -q -j 1 -o "$1" >"$1.said" 2>&1; }

elements 0 2000 >thin.yaml
go thin
last thin 'max(r["n"] for r in rows) > 0 and rows[-1]["m"] > 1e4'
check "elements at 55 times the wave speed meet a plate of a fifth of a metre" $?

elements 0 0 >still.yaml && elements 2000 0 >together.yaml
go still && go together && [ "$(wc -l <still/history.csv)" = "$(wc -l <together/history.csv)" ]
check "elements that fly together at 2000 m/s take the steps of those at rest" $?

for finder in multi-velocity point-to-segment; do
    rigid 'cfl: 0.5' 2000 $finder >"ram_$finder.yaml"
    go "ram_$finder"
    last "ram_$finder" 'max(r["n"] for r in rows) > 0 and max(r["m"] for r in rows) > 1e4'
    check "a ram at 2000 m/s meets points, $finder" $?
    rigid 'dt: 1e-3' '"t < 0.01 ? 0 : 2000"' $finder >"leap_$finder.yaml"
    go "leap_$finder"
    [ $? -ne 0 ] && grep -q "contact of 'f' and 'g': they move by .* m against each other in one step, at 2000 m/s" "leap_$finder.said"
    check "a given motion that leaps to 2000 m/s with a given dt is stopped, $finder" $?
done

box 'dt: 2e-3' >lands.yaml
go lands && last lands 'abs(rows[-1]["m"] + 2) < 1e-9 and abs(rows[-1]["n"] - 9.81) < 1e-6'
check "a rigid box falls 2 m and lies on a rigid floor: place and weight" $?
box 'dt: 0.15' >through.yaml
go through
[ $? -ne 0 ] && grep -q "may pass through each other" through.said
check "with a dt in which it falls by four times its own size the run stops" $?
[ $missed -eq 0 ]
