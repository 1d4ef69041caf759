#!/bin/bash
# cost: 9
# The strip footing at 4 and 8 cells in half of its width, of points and of finite elements: both too strong, in proportion to h, and towards (2 + pi) c_u within 0.5 %.
# test_footing.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
points=$(realpath cases/strip_footing/scene.yaml) elements=$(realpath tests/verification/fe_footing.yaml)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
for scene in "$points" "$elements"; do
    for cells in 4 8; do "$build/abut" run "$scene" --quiet -j 1 -o "$cells" --set constants.cells=$cells; done
    python3 - <<'PYTHON'
import json
import math

found = [-json.load(open(f"{cells}/summary.json"))["expects"][0]["value"] / 1e4 for cells in (4, 8)]
errors = [value / (2 + math.pi) - 1 for value in found]
limit = 2 * found[1] - found[0]
print("N_c", found, "errors", errors, "limit", limit, limit / (2 + math.pi) - 1)
assert 0 < errors[1] < 0.04, "8 cells"
assert 1.8 < errors[0] / errors[1] < 2.2, "not of first order"
assert abs(limit / (2 + math.pi) - 1) < 0.005, "the limit"
PYTHON
done
