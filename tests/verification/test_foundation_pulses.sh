#!/bin/bash
# cost: 4
# The foundation under three pulses (cases/foundation_pulses) on cells of 0.125 m: sides that are held throw waves back, which strain the ground along the second shear band
# and shake the sides; sides that absorb do so much less. test_foundation_pulses.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
scene=$(realpath cases/foundation_pulses/scene.yaml)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
held='{left: roller, right: roller, bottom: fixed}'
viscous='{left: roller, right: {boundary: viscous}, bottom: {boundary: viscous}}'
viscoelastic='{left: roller, right: {boundary: viscoelastic, r_b: 6}, bottom: {boundary: viscoelastic, r_b: 4}}'
for sides in held viscous viscoelastic; do
    "$build/abut" run "$scene" --quiet -j 1 -o $sides --set constants.h=0.125 --set output.every=0.6 --set "grid.sides=${!sides}"
done
python3 - <<'PYTHON'
import csv

rows = {}
for sides in ("held", "viscous", "viscoelastic"):
    with open(f"{sides}/history.csv", newline="") as stream:
        rows[sides] = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]
held = rows["held"]
for sides, found in rows.items():
    last, start = found[-1], found[0]
    bottom = min(row["bottom_stress"] for row in found) - start["bottom_stress"]
    print(f"{sides}: settlement {-last['foundation']:.3f} m, plastic strain beyond {last['beyond']:.4f}, bottom pressed by {-bottom:.0f} Pa, remainder {last['remainder']:.3g} of {last['external']:.4g} J")
    assert abs(last["remainder"]) < 2e-3 * last["external"], "the ledger"
    assert -last["foundation"] > 0.2, "hardly pressed"
    if sides != "held":
        assert held[-1]["beyond"] > 1.5 * last["beyond"], "as much plastic strain beyond as with sides that are held"
        assert min(row["bottom_stress"] for row in held) - held[0]["bottom_stress"] < 1.7 * bottom, "the bottom throws back as much as one that is held"
PYTHON
