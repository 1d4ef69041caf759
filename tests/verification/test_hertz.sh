#!/bin/bash
# cost: 30
# The cylinder on the plane with other elements, responses, sizes and materials; and the scene must miss where the plane holds the surface, too.
# test_hertz.sh BUILD; with ABUT_ALL=yes (tests/run --all) some more
set -u
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
scene=tests/verification/hertz.yaml
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
linear=(constants.order=1 constants.n=0.5)
variant "q4, twice the elements" bodies.cylinder.mesh.type=q4 "${linear[@]}"
variant "q4r, twice the elements" bodies.cylinder.mesh.type=q4r "${linear[@]}"
[ "${ABUT_ALL:-no}" = no ] || variant "q8r" bodies.cylinder.mesh.type=q8r
[ "${ABUT_ALL:-no}" = no ] || variant "neo-hookean" materials.rubber.model=neo-hookean
variant "stiff springs" 'contact[0]={bodies: [plane, cylinder], algorithm: point-to-segment, response: penalty, stiffness_of: modulus, stiffness: 100}' 'expect[4].tolerance=0.01'
variant "the bodies the other way round" constants.side=-1 'contact[0].bodies=[cylinder,plane]'
[ "${ABUT_ALL:-no}" = no ] || variant "half the size, another material" constants.R=0.5 constants.E=4e6 constants.nu=0.2 constants.P=2000
run 'contact[0]={bodies: [plane, cylinder], algorithm: point-to-segment, response: coulomb, friction: 1}'
if [ $? -ne 3 ]; then
    missed=$((missed + 1))
    echo "MISSED  with friction the scene must miss what it expects"
fi
[ $missed -eq 0 ]
