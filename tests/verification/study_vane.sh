#!/bin/bash
# cost: 90
# The tables of cases/vane/README.md. Elements: the torque at three meshes within 2 % and of first order, the limit within 0.2 %. Material points: the surface's strength within 2 % at four meshes, and the
# clay's own (response: tied), whose error falls with the cell. study_vane.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
case=$(realpath cases/vane)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
run() { # folder, scene, options
    "$build/abut" run "$case/$2.yaml" --quiet -j 1 -o "$1" "${@:3}"
}
for n in 6 12 24; do
    run "q8r-$n" elements --set constants.n=$n
    run "q4-$n" elements --set constants.n=$n --set bodies.clay.mesh.type=q4 --set bodies.clay.mesh.f_bar=true
done
for cells in 4 6 8 12; do
    for clay in 1 1.5; do run "clay$clay-$cells" scene --set constants.cells=$cells --set constants.clay=$clay; done
done
for cells in 4 6 8; do run "segment-$cells" scene --set constants.cells=$cells --set contact[0].algorithm=point-to-segment; done
for cells in 4 8 16; do
    for way in multi-velocity point-to-segment; do
        run "tied-$way-$cells" scene --set constants.cells=$cells --set "contact=[{bodies: [vane, clay], algorithm: $way, response: tied}]"
    done
done
python3 - <<'PYTHON'
import json


def row(name, meshes):
    errors = []
    for mesh in meshes:
        e = json.load(open(f"{name}-{mesh}/summary.json"))["expects"][0]
        errors.append(e["value"] / e["reference"] - 1)
    print(f"{name:22}", *(f"{mesh}: {100 * e:+.2f} %" for mesh, e in zip(meshes, errors)))
    return errors


for name in ("q8r", "q4"):
    coarse, middle, fine = row(name, (6, 12, 24))
    limit = 2 * fine - middle
    print(f"{'':22} limit {100 * limit:+.2f} %")
    assert 0.02 > coarse > middle > fine > 0 and abs(limit) < 2e-3, "elements"
for name in ("clay1", "clay1.5"):
    assert max(map(abs, row(name, (4, 6, 8, 12)))) < (0.02 if name == "clay1" else 0.003), "multi-velocity"
row("segment", (4, 6, 8))
for way in ("multi-velocity", "point-to-segment"):
    coarse, middle, fine = row(f"tied-{way}", (4, 8, 16))
    assert coarse > 1.6 * middle > 1.6 * 1.9 * fine, "tied"
PYTHON
