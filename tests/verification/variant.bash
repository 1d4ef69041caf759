# Part of test_surface_gap.sh and test_surface_points.sh, which set build and scratch: variant WHAT SCENE SETTINGS runs a scene that must meet its expects.
count=0 missed=0
variant() { # what, scene, settings of --set
    local what=$1 scene=$2 set=() status
    shift 2
    for s in "$@"; do set+=(--set "$s"); done
    "$build/abut" run tests/verification/$scene.yaml --quiet -j "${threads:-1}" --strict -o "$scratch/$((++count))" "${set[@]}" 2>"$scratch/$count.log"
    status=$?
    if [ $status -eq "${wanted:-0}" ]; then
        echo "passed  $what"
    else
        missed=$((missed + 1))
        echo "MISSED  $what (exit $status)"
        cat "$scratch/$count.log"
        [ -f "$scratch/$count/summary.json" ] && python3 tests/verification/expects.py "$scratch/$count/summary.json" | grep '^MISSED' | sed 's/^/        /'
    fi
}
