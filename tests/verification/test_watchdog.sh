#!/bin/bash
# cost: 6
# A run that makes energy is ended early, with the culprit and a remedy that fits; one that does not is left alone. test_watchdog.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
here=$(cd "$(dirname "$0")" && pwd)
cd "${ABUT_SCRATCH:-$(mktemp -d)}" || exit 1
missed=0
expect() { # status, pattern ("" for nothing said), scene, settings
    local status=$1 pattern=$2 scene=$3 set=()
    shift 3
    for s in "$@"; do set+=(--set "$s"); done
    "$build/abut" run "$here/$scene.yaml" --quiet -j 1 -o out "${set[@]}" >said 2>&1
    local got=$?
    if [ $got -eq "$status" ] && { [ -z "$pattern" ] || grep -Eq -- "$pattern" said; }; then
        echo "passed  $scene, '$pattern': $*"
    else
        echo "MISSED  $scene: exit $got, wanted $status and '$pattern': $*"
        sed 's/^/        /' said
        missed=$((missed + 1))
    fi
}
flying=(constants.cells=40 constants.frame=0.02 'contact[0].gap=none' bodies.a.basis=linear bodies.b.basis=linear 'time={end: end, cfl: 0.9}')
expect 1 "makes energy: .* body '[ab]', whose fastest point, [0-9]+, moves at .*use basis gimp or bspline2" impact "${flying[@]}"
grep -q '"outcome": "failed: .*the run makes energy' out/summary.json || { echo "MISSED  summary.json does not say so" && missed=$((missed + 1)); }
[ "$(wc -l <out/history.csv)" -gt 20 ] || { echo "MISSED  the history up to there is lost" && missed=$((missed + 1)); }
expect 0 "the discretisation made" impact "${flying[@]}" 'watchdog={stop: false}'
expect 0 "" impact constants.cells=20
expect 0 "" translation constants.end='30*h' watchdog.energy=0.01
expect 0 "" fall watchdog.energy=0.1
expect 2 "watchdog.energy is -1 but must be greater than 0" fall watchdog.energy=-1

# Two bodies that never meet, at a step within the limit of one and beyond that of the other: the one that makes energy is named, wherever it stands in the scene, and
# exactly WATCH_STEPS = 20 steps after energy went over the threshold, by what the history of a run without watchdog says.
calm='  calm: {method: material-points, material: soft, shape: {box: [[1, 0], [6, 2]]}, velocity: ["2e-3*cos(pi*(x - 1)/5)", 0]}'
wild='  wild: {method: material-points, material: stiff, shape: {box: [[8, 0], [13, 2]]}, velocity: ["1e-3*cos(pi*(x - 8)/5)", 0]}'
two() { # file, bodies in their order
    cat >"$1" <<SCENE
abut: 1
time: {end: 21.6, dt: 0.45}
grid: {from: [0, 0], to: [14, 2], cell: 0.25, sides: {bottom: roller, top: roller}}
materials: {soft: {model: linear-elastic, E: 0.25, nu: 0, density: 1}, stiff: {model: linear-elastic, E: 1, nu: 0, density: 1}}
bodies:
$2
$3
history: {every: 1}
SCENE
}
two first.yaml "$wild" "$calm"
two last.yaml "$calm" "$wild"
"$build/abut" run last.yaml --quiet -j 1 -o free --set 'watchdog={stop: false}' >said 2>&1 || { cat said; missed=$((missed + 1)); }
thresholds=$(python3 - <<'PYTHON'
import csv
rows = [{k: float(v) for k, v in r.items()} for r in csv.DictReader(open("free/history.csv"))]
given = rows[0]["kinetic"]  # neither body has momentum, nothing is strained, nothing works from outside
made = [r["remainder"] / given for r in rows]
step = next(k for k in range(len(made)) if made[k] > 0.1)
assert made[step - 1] < 0.9 * made[step] and made[step] < 0.9 * made[step + 1] and all(m > made[step + 1] for m in made[step + 2 : step + 20])
print(repr(0.99 * made[step]), step + 19, repr(1.01 * made[step]), step + 20)
PYTHON
) || { echo "MISSED  no such history" && missed=$((missed + 1)); }
here=.
read -r below then above later <<<"$thresholds"
for scene in first last; do
    expect 1 "\(step $then\), with 1.25e-05 J put into it, .* in body 'wild', .* dt is above the stable limit" $scene "watchdog.energy=$below"
    expect 1 "\(step $later\), with 1.25e-05 J put into it, .* in body 'wild'" $scene "watchdog.energy=$above"
done
[ $missed -eq 0 ]
