#!/bin/bash
# cost: 60
# Rigid bodies with both finders, on grids moved by part of a cell, rolling and sliding, against points, elements and each other; what stands in no single scene.
# test_rigid.sh BUILD
set -eu
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
missed=0
one() { # scene, settings: every expect must be met
    local scene=$1
    shift
    if "$build/abut" run "$scene" --quiet -j 1 --strict -o "$scratch/one" "$@" >"$scratch/log" 2>&1; then
        echo "ok      $scene $*"
    else
        echo "MISSED  $scene $*"
        cat "$scratch/log"
        python3 tests/verification/expects.py "$scratch/one/summary.json" || true
        missed=$((missed + 1))
    fi
}
here=tests/verification
for finder in multi-velocity point-to-segment; do
    by="--set contact[0].algorithm=$finder"
    for mu in 0 0.1 0.2 0.3; do one $here/rigid_wedge.yaml $by --set constants.mu=$mu; done
    one $here/rigid_wedge.yaml $by --set constants.shift=0.0213
    one $here/rigid_wedge_points.yaml $by --set constants.mu=0.3 --set constants.shift=0.0213
    one $here/rigid_push.yaml $by --set constants.shift=0.0183
    one $here/rigid_impact.yaml $by --set constants.shift=0.0183
    one $here/rigid_impact.yaml $by --set constants.ratio=10
    one $here/rigid_cylinder.yaml $by --set constants.shift=0.0213
    one $here/rigid_cylinder.yaml $by --set constants.mu=0.05 --set constants.shift=0.0213
    one $here/rigid_cylinder_elastic.yaml $by --set constants.mu=0.05
done
one $here/rigid_cylinder_elastic.yaml --set contact[0].algorithm=point-to-segment

# the same bits on any number of threads
for threads in 1 2 3; do
    "$build/abut" run $here/rigid_impact.yaml --quiet -j $threads -o "$scratch/threads$threads" >/dev/null 2>&1
done
cmp "$scratch/threads1/history.csv" "$scratch/threads2/history.csv"
cmp "$scratch/threads1/history.csv" "$scratch/threads3/history.csv"

# rigid bodies alone have no limit of the step to go by
sed 's/, dt: 2e-4//' $here/rigid_cylinder.yaml >"$scratch/nodt.yaml"
if "$build/abut" run "$scratch/nodt.yaml" --quiet -o "$scratch/nodt" 2>"$scratch/log"; then
    echo "a scene of rigid bodies ran without time.dt"
    missed=$((missed + 1))
fi
grep -q 'write time.dt' "$scratch/log"
exit $((missed > 0))
