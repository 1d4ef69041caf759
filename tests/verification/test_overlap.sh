#!/bin/bash
# cost: 1
# Bodies that are drawn into each other are told of by abut check and before a run goes on: how many points, nodes or corners of each lie in the other and how deep, wherever the grid
# begins; bodies side by side are not. test_overlap.sh BUILD
set -eu
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
scene() { # overlap, lower body, upper body
    cat <<YAML
abut: 1
constants: {d: $1}
time: {end: 1e-6, dt: 1e-6}
grid: {from: [-0.7, -1.3], to: [2.8, 2.2], cell: 0.1}
materials: {m: {model: linear-elastic, E: 1e6, nu: 0.3, density: 1000}}
bodies:
  lower: {material: m, $2}
  upper: {material: m, $3}
contact: [{bodies: [upper, lower], algorithm: point-to-segment, response: coulomb}]
YAML
}
elements() { echo "method: finite-elements, mesh: {box: [[$1, \"$2\"], [$3, \"$4\"]], elements: [$5, $6], type: $7}"; }
shape() { echo "method: $1, shape: {box: [[$2, \"$3\"], [$4, \"$5\"]]}"; }
wrong=0
tell() { # name, words or nothing, what makes the scene
    scene "$3" "$4" "$5" >"$scratch/$1.yaml"
    "$build/abut" run "$scratch/$1.yaml" --quiet -j 1 -o "$scratch/$1" >"$scratch/$1.log" 2>&1 || { cat "$scratch/$1.log"; wrong=1; }
    "$build/abut" check "$scratch/$1.yaml" >"$scratch/$1.check" 2>&1 || { cat "$scratch/$1.check"; wrong=1; }
    cmp <(grep 'overlap at the start' "$scratch/$1.log") <(grep 'overlap at the start' "$scratch/$1.check") || { echo "$1: check and run tell otherwise"; wrong=1; }
    if [ -z "$2" ]; then
        ! grep 'overlap at the start' "$scratch/$1.log" || { echo "$1: nothing overlaps"; wrong=1; }
    else
        grep -q "overlap at the start, $2, and stay so" "$scratch/$1.log" || { echo "$1: not told: $2"; cat "$scratch/$1.log"; wrong=1; }
    fi
}
low=$(elements 0 -0.5 2 0 16 4 q4)
tell points "60 points of 'upper' in 'lower', up to 0.225 m deep" 0.3 "$low" "$(shape material-points 0.5 -d 1 0.5-d)"
tell nodes "37 points of 'upper' in 'lower', up to 0.238 m deep, and 9 points of 'lower' in 'upper', up to 0.2 m deep" 0.3 "$low" "$(elements 0.5 -d 1 0.5-d 4 4 q8)"
tell corners "2 points of 'upper' in 'lower', up to 0.2 m deep, and [0-9]* points of 'lower' in 'upper', up to 0.2 m deep" 0.2 "$low" "$(shape rigid 0.5 -d 1 0.5-d)"
tell outlines "[0-9]* points of 'upper' in 'lower', up to 0.175 m deep, and [0-9]* points of 'lower' in 'upper', up to 0.175 m deep" 0.2 "$(shape material-points 0 -0.5 2 0)" "$(shape material-points 0.5 -d 1 0.5-d)"
for method in material-points rigid; do tell "beside_$method" "" 0 "$low" "$(shape $method 0.5 -d 1 0.5-d)"; done
tell beside_elements "" 0 "$low" "$(elements 0.5 -d 1 0.5-d 4 4 q8)"
exit $wrong
