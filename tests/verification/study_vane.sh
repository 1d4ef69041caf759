#!/bin/bash
# cost: 30
# The vane of cases/vane at 4, 8 and 12 cells in its radius: the torque of each within 2 % of 2 pi r^2 c_u.
# study_vane.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
scene=$(realpath cases/vane/scene.yaml)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
for cells in 4 8 12; do "$build/abut" run "$scene" --quiet --strict -j 1 -o "$cells" --set constants.cells=$cells; done
python3 - <<'PYTHON'
import json

for cells in (4, 8, 12):
    torque, _, surface = json.load(open(f"{cells}/summary.json"))["expects"][:3]
    print(cells, *(f"{e['name']} {e['value'] / e['reference'] - 1:+.4f}" for e in (torque, surface)))
PYTHON
