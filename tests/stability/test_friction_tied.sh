#!/bin/bash
# cost: 10
# Friction without bound is a tie as long as nothing pulls, with point-to-segment, too: a block pressed onto a plane and sheared along it by both responses, on two meshes,
# with either body first; with points on the outline of one of them. test_friction_tied.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
here=$(cd "$(dirname "$0")" && pwd)
cd "${ABUT_SCRATCH:-$(mktemp -d)}" || exit 1
missed=0
finder=point-to-segment
run() { # output, contact, settings
    local out=$1 contact=$2
    shift 2
    "$build/abut" run "$here/../verification/pulled_block.yaml" --strict --quiet -j 1 -o "$out" --set "contact=[{algorithm: $finder, $contact}]" "$@" >said 2>&1 && return
    echo "MISSED  $out: $contact $*"
    sed 's/^/        /' said
    missed=$((missed + 1))
}
# Name, bodies and passes, tolerance, settings. Friction and tie of the same scene: forces and displacement of the block, all along the run, by their largest; and the
# smallest normal force of a contact point in the tie, of the mean one. `rough` is what is held against the tie.
rough="response: coulomb, friction: 1e6"
alike() {
    local name=$1 contact=$2 tolerance=$3
    shift 3
    run "$name-rough" "$contact, $rough" "$@"
    run "$name-tied" "$contact, response: tied" "$@"
    /usr/bin/python3 - "$name" "$tolerance" <<'P' || missed=$((missed + 1))
import csv
import sys

import h5py

name, tolerance = sys.argv[1], float(sys.argv[2])
rough, tied = ([{k: float(v) for k, v in row.items() if v} for row in csv.DictReader(open(f"{name}-{r}/history.csv"))] for r in ("rough", "tied"))
off, bad = {}, len(rough) != len(tied)
for column in ("held", "pressed", "block_x"):
    size = max(abs(row[column]) for row in tied)
    off[column] = max(abs(p[column] - q[column]) for p, q in zip(rough, tied)) / size
    rounding = 1e-15 / size if column == "block_x" else 0.0  # of a place, m
    bad = bad or not (size > 0 and off[column] <= max(tolerance, rounding))
pull, most = 0.0, 0
with h5py.File(f"{name}-tied/results.h5") as frames:
    for frame in frames.values():
        points = frame.get("contact_0") if isinstance(frame, h5py.Group) else None
        if points is None or not len(points["gap"]):
            continue
        normal = (points["force"][:] * points["normal"][:]).sum(axis=1)
        most = max(most, len(normal))
        if normal.sum() > 0:
            pull = min(pull, normal.min() / normal.mean())
print(f"{name}: along {off['held']:.1e}, normal {off['pressed']:.1e}, displacement {off['block_x']:.1e}, {tolerance:g} allowed; "
      f"{most} points, the tie pulls at one by {-pull:.2g} of the mean push")
sys.exit(bad)
P
}
common=(constants.end=0.07 constants.rate=200 'expect=[]' 'output={every: 0.02, contact: true}')
settings() { # cell, height of the faces, where the plane begins and ends, further ones
    set_=(--set "grid.cell=$1" --set "bodies.block.shape={box: [[1, \"$2 - 1e-4\"], [2, 1]]}" --set "bodies.plane.shape={box: [[$3, 0], [$4, $2]]}")
    shift 4
    local s
    for s in "${common[@]}" "$@"; do set_+=(--set "$s"); done
}
for cell in 0.25 0.125; do
    settings $cell 0.54 0 4 # a block on a wider plane, the faces within a cell; and on a line of the grid
    alike block-$cell "bodies: [block, plane]" 1e-9 "${set_[@]}"
    alike block-turned-$cell "bodies: [plane, block]" 1e-9 "${set_[@]}"
    settings $cell 0.5 0 4
    alike line-$cell "bodies: [block, plane]" 1e-9 "${set_[@]}"
done
for pass in first second; do alike $pass "bodies: [block, plane], passes: $pass" 1e-9 "${set_[@]}"; done # by the centres of points one pass does
# Points on the outline of one of the bodies alone: the other's material points go with their outline then, by default, and either law finds what it finds with both. (By their
# centres tie and friction were 0.16 and 1.2 apart along.)
settings 0.25 0.54 0 4
alike points-on-block "bodies: [block, plane]" 1e-4 "${set_[@]}" --set bodies.block.surface=points
alike points-on-plane "bodies: [block, plane]" 2e-3 "${set_[@]}" --set bodies.plane.surface=points
# Two passes by the centres of points: points of a tie pull, and this is all of the difference, as friction whose points may pull shows.
settings 0.25 0.54 0 4
rough="response: coulomb, friction: 1e6, adhesion: 1e12, tensile_strength: 1e12"
alike centre-pulling "bodies: [block, plane], touching: centre" 1e-9 "${set_[@]}"
# On every basis, with either finder: where tie and friction differ, by up to 0.025, it is by what the tie pulls at a corner of the block as waves go through it.
settings 0.25 0.6 0 4
for method in "linear flip" "linear apic" "gimp flip" "cpdi apic" "bspline2 apic"; do
    basis=${method% *} transfer=${method#* }
    for finder in multi-velocity point-to-segment; do
        alike "pulling-$basis-$transfer-$finder" "bodies: [block, plane]" 1e-9 "${set_[@]}" --set bodies.block.basis=$basis --set bodies.plane.basis=$basis \
            --set bodies.block.transfer=$transfer --set bodies.plane.transfer=$transfer
    done
done
[ $missed -eq 0 ] && echo "passed: $(basename "$0")"
[ $missed -eq 0 ]
