#!/bin/bash
# cost: 20
# ParaView's own reader shows what results.h5 holds: of a finished run, and of one that was killed. slow_paraview.sh BUILD
set -eu
cd "$(dirname "$0")/../.."
build=${1:?the build folder}
command -v pvpython >/dev/null || { echo "pvpython is not there (Debian package python3-paraview)"; exit 77; }
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
scene=tests/verification/two_blocks.yaml
"$build/abut" run $scene --quiet -j 1 -o "$scratch/out" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
pvpython tests/verification/check_results_paraview.py "$scratch/out"
"$build/abut" run cases/block_on_beam/scene.yaml --quiet -j 1 -o "$scratch/beam" --set time.end=0.2 >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
pvpython tests/verification/check_results_paraview.py "$scratch/beam"
"$build/abut" run $scene --quiet -j 1 -o "$scratch/killed" --set output.every=1e-4 --set grid.cell=0.02 >"$scratch/log" 2>&1 &
run=$!
for _ in $(seq 600); do
    [ "$(grep -c '<Time ' "$scratch/killed/results.xdmf" 2>/dev/null)" -ge 3 ] 2>/dev/null && break
    kill -0 $run || { cat "$scratch/log"; exit 1; }
    sleep 0.05
done
kill -9 $run
wait $run 2>/dev/null || true
pvpython tests/verification/check_results_paraview.py "$scratch/killed" killed
