#!/bin/bash
# cost: 8
# The block on the belt with every finder and response, another kinetic friction, another speed, the grid moved; and the scene must miss when friction does not fall.
# test_belt.sh BUILD
set -u
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
scene=tests/verification/belt.yaml
count=0 missed=0
run() { # settings of --set: exit status of the run
    local set=()
    for s in "$@"; do set+=(--set "$s"); done
    "$build/abut" run $scene --quiet -j 1 --strict -o "$scratch/$((++count))" "${set[@]}" 2>"$scratch/$count.log"
}
variant() { # what, settings
    local what=$1 status
    shift
    run "$@"
    status=$?
    if [ $status -eq 0 ]; then
        echo "passed  $what"
    else
        missed=$((missed + 1))
        echo "MISSED  $what (exit $status)"
        cat "$scratch/$count.log"
        [ -f "$scratch/$count/summary.json" ] && python3 tests/verification/expects.py "$scratch/$count/summary.json" | grep '^MISSED' | sed 's/^/        /'
    fi
}
moved=('grid.from=[-1.0925,-0.9075]' 'grid.to=[2.6575,1.8425]')
nodes=contact[0].algorithm=multi-velocity
springs=(contact[0].response=penalty bodies.block.motion.spin=0)
variant "shared nodes" $nodes
variant "shared nodes, grid moved by 0.37 of a cell" $nodes "${moved[@]}"
variant "penalty" "${springs[@]}"
variant "penalty on shared nodes" $nodes "${springs[@]}"
variant "kinetic friction 0.4" constants.kinetic=0.4
variant "half the speed" constants.v=0.05
run contact[0].kinetic_friction=static
if [ $? -ne 3 ]; then
    missed=$((missed + 1))
    echo "MISSED  with one coefficient the scene must miss what it expects"
fi
[ $missed -eq 0 ]
