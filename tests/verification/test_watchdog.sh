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
[ $missed -eq 0 ]
