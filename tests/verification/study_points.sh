#!/bin/bash
# cost: 60
# Convergence of the scenes of single bodies on three meshes, with the rates printed; fails where a rate is lower than promised. study_points.sh BUILD
#
# Velocities of update usf stand half a step ahead of the clock, those of usl and musl half a step behind (constants.lead of the bars): with that taken
# out, the error is second order in the cell at a fixed dt c/h. As it is read from the monitors, half a step is part of the error, which is of first order.
set -eu
build=$(realpath "${1:?the build folder}")
here=$(cd "$(dirname "$0")" && pwd)
cd "${ABUT_SCRATCH:-$(mktemp -d)}"

cat >table.py <<'PYTHON'
"""table.py NAME LEAST EXPECT FOLDER CELLS ...: errors of one expect and the rates between meshes; exit 1 where the last rate is below LEAST."""
import json, math, sys

name, least, wanted = sys.argv[1], float(sys.argv[2]), sys.argv[3]
runs = list(zip(sys.argv[4::2], map(float, sys.argv[5::2])))
errors = []
for folder, _ in runs:
    with open(f"{folder}/summary.json") as stream:
        errors += [e["error"] for e in json.load(stream)["expects"] if e["name"] == wanted]
rates = [math.log(errors[k] / errors[k + 1]) / math.log(runs[k + 1][1] / runs[k][1]) for k in range(len(runs) - 1)]
print(f"{name:34s} {wanted:26s}", *(f"{n:g}: {e:.3e} " for (_, n), e in zip(runs, errors)), "rates", *(f"{r:.2f}" for r in rates))
sys.exit(0 if min(rates) >= least else 1)
PYTHON

failed=0
study() { # title, least rate, scene, expect, meshes, options
    local title=$1 least=$2 scene=$3 expect=$4 meshes=$5 cells list=()
    shift 5
    for cells in $meshes; do
        "$build/abut" run "$here/$scene.yaml" --quiet -j 1 -o "study_$cells" --set constants.cells="$cells" --set history.every=1 "$@" 2>/dev/null
        list+=("study_$cells" "$cells")
    done
    python3 table.py "$title" "$least" "$expect" "${list[@]}" || { echo "    below $least"; failed=1; }
}

speed="centre-of-mass speed"
study "bar_1 usf" 1.9 bar_1 "$speed" "25 50 100" --set constants.lead=0.5
study "bar_1 usf" 1.9 bar_1 "stress at the fixed end" "25 50 100"
study "bar_1 usf, meshes that do not fit" 1.8 bar_1 "$speed" "25.37 50.37 100.37" --set constants.lead=0.5
study "bar_1 usf, read as it is" 0 bar_1 "$speed" "25 50 100"
study "bar_1 musl" 1.9 bar_1 "$speed" "25 50 100" --set constants.lead=-0.5 --set bodies.bar.update=musl
study "bar_1 musl, read as it is" 0 bar_1 "$speed" "25 50 100" --set bodies.bar.update=musl
study "bar_1 usl" 1.9 bar_1 "$speed" "25 50 100" --set constants.lead=-0.5 --set bodies.bar.update=usl
study "bar_1 usf, ledger" 1.9 bar_1 "ledger closes" "25 50 100"
study "bar_1 usf, 9 points per cell" 1.9 bar_1 "$speed" "25 50 100" --set constants.lead=0.5 --set bodies.bar.fill.per_cell=9
study "bar_1 usf, linear" 0 bar_1 "$speed" "25 50 100" --set constants.lead=0.5 --set bodies.bar.basis=linear
study "bar_5 usf" 1.9 bar_5 "$speed" "112 225 450" --set constants.lead=0.5
study "pulse" 1.5 pulse "peak at 75 m" "200 400 800"
study "pulse, shifted" 1.5 pulse "peak at 75 m" "200 400 800" --set constants.shift=0.37
exit $failed
