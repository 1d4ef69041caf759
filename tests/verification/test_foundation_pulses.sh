#!/bin/bash
# cost: 12
# The foundation under three pulses (cases/foundation_pulses), on the source's cells of 0.0625 m and twice as wide: with sides that are held the second shear band comes up to the surface beside the
# foundation, with sides that absorb it does not; held sides are pressed twice as hard, and the foundation settles less. test_foundation_pulses.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
scene=$(realpath cases/foundation_pulses/scene.yaml)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
held='{left: roller, right: roller, bottom: fixed}'
viscous='{left: roller, right: {boundary: viscous}, bottom: {boundary: viscous}}'
viscoelastic='{left: roller, right: {boundary: viscoelastic, r_b: 6}, bottom: {boundary: viscoelastic, r_b: 4}}'
run() { # cell, sides
    "$build/abut" run "$scene" --quiet -j 1 -o "$2-$1" --set constants.h="$1" --set output.every=0.6 --set "grid.sides=${!2}"
}
for sides in held viscous viscoelastic; do run 0.125 $sides; done
for sides in held viscous; do run 0.0625 $sides; done
python3 - <<'PYTHON'
import csv
import os

for cell in ("0.125", "0.0625"):
    rows = {}
    for sides in ("held", "viscous", "viscoelastic"):
        if not os.path.exists(f"{sides}-{cell}"):
            continue
        with open(f"{sides}-{cell}/history.csv", newline="") as stream:
            rows[sides] = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]
    pressed = {s: {side: r[0][side] - min(row[side] for row in r) for side in ("bottom_stress", "side_stress")} for s, r in rows.items()}
    held = rows["held"][-1]
    for sides, found in rows.items():
        last = found[-1]
        print(f"{cell} {sides}: settlement {-last['foundation']:.3f} m, plastic strain beyond {last['beyond']:.4f}, at the surface {last['surface_beyond']:.3f}, bottom pressed by "
              f"{pressed[sides]['bottom_stress']:.0f} Pa, side {pressed[sides]['side_stress']:.0f}, remainder {last['remainder']:.3g} of {last['external']:.4g} J")
        assert abs(last["remainder"]) < 2e-3 * last["external"], "the ledger"
        if sides == "held":
            assert last["surface_beyond"] > 0.1, "the second band does not come up between sides that are held"
            continue
        assert last["surface_beyond"] < 0.01, "the second band comes up although the sides absorb"
        assert held["beyond"] > 10 * last["beyond"], "as much plastic strain beyond as with sides that are held"
        assert pressed["held"]["bottom_stress"] > 1.9 * pressed[sides]["bottom_stress"] and pressed["held"]["side_stress"] > 1.5 * pressed[sides]["side_stress"], "echoes"
        twice = [min(r, key=lambda row: abs(row["t"] - 0.4))["foundation"] for r in (rows["held"], found)]
        assert -twice[0] < -0.95 * twice[1], "held ground settles as much in two pulses"
PYTHON
