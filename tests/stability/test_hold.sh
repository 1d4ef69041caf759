#!/bin/bash
# cost: 14
# What extremes must not change: a body at rest, the place of the origin, the units, friction without bound against a tie, a body a hundred million times as stiff, and
# penetration at any stable step. test_hold.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
here=$(cd "$(dirname "$0")" && pwd)
cd "${ABUT_SCRATCH:-$(mktemp -d)}" || exit 1
missed=0
must() { # output, scene, settings
    local out=$1 scene=$here/$2.yaml set=()
    shift 2
    for s in "$@"; do set+=(--set "$s"); done
    "$build/abut" run "$scene" --strict -j 1 -o "$out" "${set[@]}" >said 2>&1 && return
    echo "MISSED  $scene: $*"
    sed 's/^/        /' said
    missed=$((missed + 1))
}
same() { # of two runs: names of columns, largest difference of their size, factor on the second
    /usr/bin/python3 - "$@" <<'P' || missed=$((missed + 1))
import csv
import sys

one, other = ([{k: float(v) for k, v in row.items() if v} for row in csv.DictReader(open(f"{d}/history.csv"))] for d in sys.argv[1:3])
bad = len(one) != len(other)
for item in sys.argv[3:]:
    name, bound, factor = (item.split(":") + ["1"])[:3]
    size = max(abs(r[name]) for r in one)
    off = max(abs(p[name] - q[name] * float(factor)) for p, q in zip(one, other)) / size
    print(f"{sys.argv[1]} and {sys.argv[2]}: {name} differs by {off:.1e} of {size:.3g}, {bound} allowed")
    bad = bad or not off <= float(bound)
sys.exit(bad)
P
}
must floor rest_on_floor
for finder in multi-velocity point-to-segment; do must rest rest_stacked "contact[0].algorithm=$finder"; done
for finder in multi-velocity point-to-segment; do # the faces sink past a line of the grid, by 5e-5 of a cell
    must rest rest_stacked "contact[0].algorithm=$finder" constants.top=2
done

impact=../verification/impact
twenty=('constants.cells=20' 'expect=[]')
must plain $impact "${twenty[@]}"
must units $impact "${twenty[@]}" constants.L=1000 constants.E=1e-6 constants.rho=1e-12 constants.v=1 # mm, t, s
same plain units a_v:1e-9:1e-3 b_v:1e-9:1e-3 energy:1e-9:1 push:1e-7:1e3 penetration:1e-7:1e-3
must far $impact "${twenty[@]}" constants.far=5e4 'grid.from=["along0 + far", "across0 + far"]' 'grid.to=["along1 + far", "across1 + far"]' \
    'bodies.a.shape={box: [["far", "far"], ["L + far", "wide + far"]]}' 'bodies.b.shape={box: [["x1 + far", "far"], ["x2 + far", "wide + far"]]}'
same plain far a_v:1e-7 b_v:1e-7 energy:1e-7 push:1e-5

pulled=(constants.end=0.2 constants.rate=200 'expect=[]')
must rough ../verification/pulled_block "${pulled[@]}" 'contact=[{bodies: [block, plane], algorithm: multi-velocity, response: coulomb, friction: 1e6}]'
must tied ../verification/pulled_block "${pulled[@]}" 'contact=[{bodies: [block, plane], algorithm: multi-velocity, response: tied}]'
same rough tied block_x:1e-4 held:1e-4 pressed:1e-4
for shift in 0 0.04; do # no gap to close and nothing pulls: then both are one law
    pressed=("${pulled[@]}" constants.shift=$shift 'bodies.block.shape={box: [[1, "0.5 - 1e-4"], [2, 1]]}')
    must rough ../verification/pulled_block "${pressed[@]}" 'contact=[{bodies: [block, plane], algorithm: multi-velocity, response: coulomb, friction: 1e6}]'
    must tied ../verification/pulled_block "${pressed[@]}" 'contact=[{bodies: [block, plane], algorithm: multi-velocity, response: tied}]'
    same rough tied block_x:1e-8 held:1e-8 pressed:1e-8
done

for finder in multi-velocity point-to-segment; do
    for cfl in 0.2 0.5 0.95; do
        must out $impact "${twenty[@]}" "contact[0]={bodies: [a, b], algorithm: $finder, response: coulomb, friction: 0.3}" time.cfl=$cfl \
            'expect=[{name: penetration, monitor: penetration, norm: peak, reference: 0, scale: h, tolerance: 1e-3}]'
    done
    must out $impact constants.cells=20 constants.ratio=1e8 "contact[0].algorithm=$finder" \
        'expect=[{name: force, monitor: push, norm: mean, from: "meet + 0.1*lasts", to: "meet + 0.9*lasts", reference: force, tolerance: 0.01},
          {name: no energy made or lost, column: remainder, norm: max, reference: 0, scale: energy, tolerance: 0.02},
          {name: penetration, monitor: penetration, norm: peak, reference: 0, scale: h, tolerance: 1e-3}]'
done
[ $missed -eq 0 ] && echo "passed: $(basename "$0")"
[ $missed -eq 0 ]
