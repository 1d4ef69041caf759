#!/bin/bash
# cost: 3
# What a run leaves opens elsewhere and says what history.csv says. test_results.sh BUILD
set -eu
cd "$(dirname "$0")/../.."
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
"$build/abut" run tests/verification/two_blocks.yaml --quiet -j 1 -o "$scratch/out" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
/usr/bin/python3 tests/verification/check_results.py "$scratch/out" left_x=position.x:left:mean right_high=position.y:right:max \
    left_slow=velocity.x:left:min left_shear=stress.xy:left:max left_press=stress.xx:left:min
# What ended a run that failed stands in its summary, not a warning that was given before.
"$build/abut" run tests/verification/two_blocks.yaml --quiet -j 1 -o "$scratch/failed" --set time.dt=0.05 --set time.end=50 >"$scratch/log" 2>&1 && { echo "a step far above the limit did not fail"; exit 1; }
grep -q 'warning: .*above the stable limit' "$scratch/log" || { cat "$scratch/log"; exit 1; }
grep -q '"outcome": "failed: [^w]*error: ' "$scratch/failed/summary.json" || { grep outcome "$scratch/failed/summary.json"; exit 1; }
