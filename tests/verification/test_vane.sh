#!/bin/bash
# cost: 3
# The vane of cases/vane in clay of finite elements: torque 2 pi r^2 c_u within 2 % on two meshes, first order in the elements around it, and their limit within 0.2 %. And in clay of
# material points that is stronger than its surface: the torque of the surface within 0.15 %, which takes that no node gets a share of the area that the clay's points do not reach. test_vane.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
case=$(realpath cases/vane)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
for n in 6 12; do "$build/abut" run "$case/elements.yaml" --quiet --strict -j 1 -o "$n" --set constants.n=$n; done
"$build/abut" run "$case/scene.yaml" --quiet --strict -j 1 -o points --set constants.cells=8 --set constants.clay=1.5 --set 'constants.end=10*r/cs' --set 'constants.turn=3*cu/G'
python3 - <<'PYTHON'
import json

coarse, fine = (e["value"] / e["reference"] - 1 for e in (json.load(open(f"{n}/summary.json"))["expects"][0] for n in (6, 12)))
width = [1 / sum(20 ** (k / (n - 1)) for k in range(n)) for n in (6, 12)]
limit = fine - (coarse - fine) * width[1] / (width[0] - width[1])
print(f"torque {coarse:+.4f}, {fine:+.4f}, drawn to elements of no width {limit:+.4f}")
assert coarse > fine > 0, "an element cannot shear in less than its width"
assert abs(limit) < 2e-3, "the limit"
e = json.load(open("points/summary.json"))["expects"][0]
print(f"torque of the surface, material points {e['value'] / e['reference'] - 1:+.5f}")
assert abs(e["value"] / e["reference"] - 1) < 1.5e-3, "material points"
PYTHON
