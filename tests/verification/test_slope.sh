#!/bin/bash
# cost: 4
# The slope of Griffiths and Lane (cases/slope) on four rows of elements: stands at strengths divided by 1.3, slides at 1.4, with no dilation; with dilation as friction, which limit analysis assumes,
# stands at 1.36 and slides at 1.42 (Bishop and Morgenstern 1960: 1.38). abut extremes cases/slope/scene.yaml finds the place between.
# test_slope.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
scene=$(realpath cases/slope/scene.yaml)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
missed=0
slope() { # exit status wanted, dilation, F: 0 stands, 3 slides
    local status=0
    "$build/abut" run "$scene" --quiet --strict -j 1 -o "$2-$3" --set constants.rows=4 --set "constants.psi=$2" --set "constants.F=$3" || status=$?
    if [ $status -eq "$1" ]; then echo "passed  dilation $2, F = $3: exit $status"; else missed=1 && echo "MISSED  dilation $2, F = $3: exit $status, not $1"; fi
}
slope 0 0 1.3
slope 3 0 1.4
slope 0 phi 1.36
slope 3 phi 1.42
exit $missed
