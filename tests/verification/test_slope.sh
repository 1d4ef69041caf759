#!/bin/bash
# cost: 4
# The slope of Griffiths and Lane (cases/slope; they say 1.4): its factor of safety is within 1.4 +- 0.03 on 4 and 8 rows of elements with dilation as friction, which limit analysis assumes (Bishop and
# Morgenstern 1960: 1.38): stands at 1.37, as the scene itself does on 8 rows, and slides at 1.43 and before. Without dilation it slides earlier. test_slope.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
scene=$(realpath cases/slope/scene.yaml)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
missed=0
slope() { # exit status wanted, rows, dilation, F: 0 stands, 3 slides
    local status=0
    "$build/abut" run "$scene" --quiet --strict -j 1 -o "$2-$3-$4" --set constants.rows="$2" --set "constants.psi=$3" --set "constants.F=$4" || status=$?
    if [ $status -eq "$1" ]; then echo "passed  $2 rows, dilation $3, F = $4: exit $status"; else missed=1 && echo "MISSED  $2 rows, dilation $3, F = $4: exit $status, not $1"; fi
}
slope 0 4 phi 1.37
slope 3 4 phi 1.41
slope 3 8 phi 1.4
slope 0 4 0 1.3
slope 3 4 0 1.37
exit $missed
