#!/bin/bash
# cost: 150
# The strip footing within 3 % of (2 + pi) c_u at three meshes: of points and of elements q4, both with f_bar, at 10, 12 and 16 (elements: 11, 12, 16) cells in half of its width, and of q8r at 8, 10 and 12.
# test_footing.sh holds the order of the error on coarser meshes. About three minutes.
# study_footing.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
points=$(realpath cases/strip_footing/scene.yaml) elements=$(realpath tests/verification/fe_footing.yaml)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
footing() { # NAME SCENE CELLS SETTING...
    local set=() pair
    for pair in "constants.cells=$3" "${@:4}"; do set+=(--set "$pair"); done
    "$build/abut" run "$2" --quiet -j 1 -o "$1-$3" "${set[@]}"
    python3 - "$1-$3" <<'PYTHON'
import json
import math
import sys

error = -json.load(open(sys.argv[1] + "/summary.json"))["expects"][0]["value"] / 1e4 / (2 + math.pi) - 1
print(f"{sys.argv[1]:12} {error:+.4f}")
assert 0 < error < 0.03, "not within 3 %"
PYTHON
}
for cells in 10 12 16; do footing points "$points" $cells; done
for cells in 11 12 16; do footing q4 "$elements" $cells; done
for cells in 8 10 12; do footing q8r "$elements" $cells bodies.ground.mesh.type=q8r bodies.ground.mesh.f_bar=false; done
# The same about an axis: a circular punch (Shield 1955: 5.69 c_u), pushed on until its load stays; of first order in the element.
for cells in 4 8 12; do
    "$build/abut" run "$elements" --quiet --strict -j 1 -o circular-$cells --set space=axisymmetric --set 'bodies.footing.shape={box: [[0, 0], [b, "b/4"]]}' --set bodies.ground.mesh.type=q8r --set bodies.ground.mesh.f_bar=false \
        --set constants.cells=$cells --set 'constants.way=0.00024*b' --set constants.end=0.4 --set 'expect[0].reference="-5.69*cu*pi*b^2"' --set 'expect[0].tolerance=0.46/cells'
done
