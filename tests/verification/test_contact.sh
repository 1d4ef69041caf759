#!/bin/bash
# cost: 45
# The contact scenes in other places, directions and frames: each variant must meet what its scene expects.
# test_contact.sh BUILD; with ABUT_ALL=yes (tests/run --all) some more
set -u
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
folder=tests/verification
count=0 missed=0
variant() { # scene, what, settings of --set
    local scene=$1 what=$2 name=$((++count)) set=(--set time.cfl=0.9) status
    shift 2
    for s in "$@"; do set+=(--set "$s"); done
    "$build/abut" run $folder/"$scene".yaml --quiet -j 1 --strict -o "$scratch/$name" "${set[@]}" 2>"$scratch/$name.log"
    status=$?
    if [ $status -eq 0 ]; then
        echo "passed  $scene: $what"
    else
        missed=$((missed + 1))
        echo "MISSED  $scene: $what (exit $status)"
        cat "$scratch/$name.log"
        [ -f "$scratch/$name/summary.json" ] && python3 $folder/expects.py "$scratch/$name/summary.json" | grep '^MISSED' | sed 's/^/        /'
    fi
}
up=(constants.turned=1 monitors[0].value=velocity.y monitors[1].value=velocity.y monitors[3].value=momentum.y)
variant impact "bodies in the other order" 'contact[0].bodies=[b,a]'
variant impact "grid moved by 0.37 of a cell" constants.shift=0.37
[ "${ABUT_ALL:-no}" = no ] || variant impact "bars along y" "${up[@]}"
variant impact "bars along y, free at their sides, grid moved both ways" "${up[@]}" constants.margin=2 constants.shift=0.37
variant impact "free at their sides, grid moved both ways" constants.margin=2 constants.shift=0.37
variant impact "in a frame that moves with the bars" constants.frame=2e-3
[ "${ABUT_ALL:-no}" = no ] || variant impact "in a frame that moves against them" constants.frame=-5e-4
variant impact "friction instead of none" 'contact[0]={bodies: [a, b], algorithm: multi-velocity, response: coulomb, friction: 1e6}'
variant impact "impedances 1 to 10 at 80 cells, surfaces that meet on a grid line" constants.ratio=10 constants.gap=2
[ "${ABUT_ALL:-no}" = no ] || variant impact "impedances 1 to 10" constants.ratio=10 constants.cells=160
variant impact "impedances 1 to 10, bodies in the other order, grid moved" constants.ratio=10 constants.cells=160 constants.shift=0.37 'contact[0].bodies=[b,a]'
variant diagonal "grid moved by 0.37 of a cell" constants.shift=0.37
variant discs "grid moved by 0.37 of a cell" constants.shift=0.37 'expect[6].tolerance=5e-3'
[ "${ABUT_ALL:-no}" = no ] || variant incline_turned "20 degrees, friction 0.1, grid moved" constants.degrees=20 constants.mu=0.1 constants.shift=0.0925
[ "${ABUT_ALL:-no}" = no ] || variant tied_bar "joint on a line of the grid" constants.cut=0.5 time.cfl=0.4
variant tied_bar "joint at 0.37" constants.cut=0.37 time.cfl=0.4
variant pulled_block "shear cap" constants.cap=150
variant pulled_block "friction instead of adhesion" constants.mu=0.2 constants.press=1000 constants.adhesion=0
variant pulled_block "friction and adhesion, grid moved" constants.mu=0.2 constants.press=500 constants.adhesion=100 constants.shift=0.04625
variant three_blocks "joints off the grid's lines" constants.shift=0.04625
variant three_blocks "no friction" constants.mu=0
variant three_blocks_free "grid moved by 0.37 of a cell" constants.shift=0.37

# Friction never gives energy back, in any step.
"$build/abut" run $folder/three_blocks_free.yaml --quiet -j 1 -o "$scratch/friction"
if python3 - "$scratch/friction/history.csv" <<'PYTHON'
import csv
import sys

with open(sys.argv[1]) as stream:
    work = [float(row["friction"]) for row in csv.DictReader(line for line in stream if not line.startswith("#"))]
assert len(work) > 300 and work[-1] > 1, "there is no friction to look at"
fall = max(a - b for a, b in zip(work, work[1:]))
print(f"friction work grows to {work[-1]:.4g} J in {len(work)} rows; largest fall {fall:.1e} J")
sys.exit(fall > 1e-12 * work[-1])
PYTHON
then echo "passed  friction work never falls"; else missed=$((missed + 1)) && echo "MISSED  friction work falls"; fi
echo "$count variants, $missed missed"
[ $missed -eq 0 ]
