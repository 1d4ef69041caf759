#!/bin/bash
# cost: 6
# The punch on 2, 4 and 8 cells in half of its width: too strong in proportion to h by either contact, and towards (2 + pi) c_u within 0.5 %. On a smooth bottom it bears less than the upper bound of
# the layer that is squeezed out, H/b + b/H + 2 = 4.9 c_u.
# test_punch.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
scene=$(realpath tests/verification/punch.yaml)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
punch() { # FOLDER SETTING...
    local folder=$1 settings=() pair
    for pair in "${@:2}"; do settings+=(--set "$pair"); done
    "$build/abut" run "$scene" --quiet -j 1 -o "$folder" "${settings[@]}"
}
for algorithm in multi-velocity point-to-segment; do
    for cells in 2 4 8; do punch "$algorithm-$cells" constants.cells=$cells "contact[0].algorithm=$algorithm"; done
done
punch smooth-8 constants.cells=8 grid.sides.bottom=roller
python3 - <<'PYTHON'
import json
import math


def found(folder):
    with open(f"{folder}/summary.json") as stream:
        return -json.load(stream)["expects"][0]["value"] / 1e4 * 2


for algorithm, share in (("multi-velocity", 0.3), ("point-to-segment", 0.6)):
    values = [found(f"{algorithm}-{cells}") for cells in (2, 4, 8)]
    errors = [value / (2 + math.pi) - 1 for value in values]
    limit = 2 * values[2] - values[1]
    print(algorithm, "N_c", values, "errors", errors, "limit", limit, limit / (2 + math.pi) - 1)
    assert all(0 < error * cells < share for error, cells in zip(errors, (2, 4, 8))), "more than its share of a cell"
    assert all(1.8 < errors[i] / errors[i + 1] < 2.2 for i in (0, 1)), "not of first order"
    assert abs(limit / (2 + math.pi) - 1) < 0.005, "the limit"
smooth = found("smooth-8")
print("on a smooth bottom", smooth)
assert 4.7 < smooth < 4.9 * (1 + 0.3 / 8), "the layer that is squeezed out"
PYTHON
