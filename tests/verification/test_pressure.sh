#!/bin/bash
# cost: 12
# Blocks that are pressed from all around, in every element type and every basis: size and work where they can be had to that, no thrust anywhere.
# test_pressure.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
here=$(cd "$(dirname "$0")" && pwd)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
export OMP_WAIT_POLICY=passive

cat >look.py <<'PYTHON'
"""look.py NAME FOLDER EXPECT=LIMIT..: errors of expects at most these; those of "stays along" always at most 1e-8."""
import json, sys

errors = {e["name"]: e["error"] for e in json.load(open(f"{sys.argv[2]}/summary.json"))["expects"]}
limits = {"stays along x": 1e-8, "stays along y": 1e-8} | {k: float(v) for k, v in (a.split("=") for a in sys.argv[3:])}
print(f"{sys.argv[1]:30}", *(f"{k}: {errors[k]:.1e} of {v:g};" for k, v in limits.items()))
for name, limit in limits.items():
    assert errors[name] is not None and errors[name] <= limit, f"{name}: {errors[name]} of {limit}"
PYTHON
run() { # name, scene, options -- limits
    local name=$1 scene=$2 options=()
    shift 2
    while [ "$1" != -- ]; do options+=("$1"); shift; done
    "$build/abut" run "$here/$scene.yaml" --quiet -j 1 -o out "${options[@]}"
    python3 look.py "$name" out "${@:2}"
}

for type in q4r q6 q8 q8r; do # the inertia in the scene is that of q4
    inertia='mass*a^2/6*(1+2/cells^2)'
    case $type in q8 | q8r) inertia='mass*a^2*((1-1/cells^2)/6+22/76/cells^2)' ;; esac # corners 3/76, middles 16/76 of an element
    run "elements, $type" fe_pressed --set bodies.block.mesh.type=$type --set constants.inertia="$inertia" -- \
        size=1e-3 'work of the pressure=2e-3' 'spins faster=2e-2' 'ledger closes=1e-3' 'angular momentum=1e-10'
done
run "elements, f_bar" fe_pressed --set bodies.block.mesh.f_bar=true -- size=1e-3 'angular momentum=1e-10' 'ledger closes=1e-3'
for update in usf usl usavg; do run "points, $update" pressed --set bodies.block.update=$update -- size=1e-4 'work of the pressure=2e-3' 'ledger closes=5e-3'; done
run "points, fixed domains" pressed --set 'bodies.block.basis={gimp: fixed}' --set constants.F=0.97 -- size=1e-4 'work of the pressure=1e-3' 'ledger closes=1e-4'
run "points, linear" pressed --set bodies.block.basis=linear --set constants.F=0.97 -- size=1e-2 'work of the pressure=5e-2'
run "points, drawn at 30 degrees" pressed --set constants.turn=pi/6 --set constants.F=0.97 -- size=2e-4 'stress out of the plane=2e-3' 'ledger closes=1e-3'
