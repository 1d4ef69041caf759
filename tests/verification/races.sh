#!/bin/bash
# Scenes on several threads under clang's thread sanitizer: two threads that touch the same byte, one of them writing, without an order between them fail here, whether or not it changed a result this time.
# clang's OpenMP library tells the sanitizer of its barriers by libarcher.so, so what it reports is real: without that library every parallel loop would be reported, and the first check below sees to it
# that it is at work. Libraries that are not built with the sanitizer (HDF5, UDUNITS, GEOS, muParser) are only used by one thread at a time; what they do among themselves is not looked at.
# races.sh BUILD-THREAD [all]: scenes of a few steps; all: every scene for ten seconds, and the unit tests.
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$(realpath "${1:?the build folder of preset thread}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
archer=$(find -L "$(dirname "$(ldd "$build/abut" | awk '/libomp\.so/ {print $3}')")" /usr/lib/llvm-*/lib -maxdepth 1 -name libarcher.so 2>/dev/null | head -n 1)
[ -n "$archer" ] || { echo "libarcher.so is not there, without which every parallel loop looks like a race: install libomp-dev"; exit 1; }
export OMP_TOOL_LIBRARIES=$archer OMP_WAIT_POLICY=passive
export TSAN_OPTIONS="ignore_noninstrumented_modules=1 exitcode=66 halt_on_error=0 history_size=3 suppressions=$PWD/tests/verification/races.txt"
wrong=0 ran=0
judge() { # name, status, log
    ran=$((ran + 1))
    local races
    races=$(grep -c 'WARNING: ThreadSanitizer' "$3")
    [ "$races" -eq 0 ] && { [ "$2" -eq 0 ] || [ "$2" -eq "${also:-0}" ]; } && return
    wrong=1
    echo "$1: exit $2, $races reports"
    head -n 60 "$3" | sed 's/^/    /'
}
races() { # name, scene, settings
    local name=$1 scene=$2 set=()
    shift 2
    for s in "$@"; do set+=(--set "$s"); done
    timeout 300 "$build/abut" run "$scene" --quiet -j 3 -o "$scratch/$name" "${set[@]}" >"$scratch/$name.log" 2>&1
    judge "$name" $? "$scratch/$name.log"
}

# Large enough for every loop that small bodies do on one thread: more than 2000 elements, 8000 points inside them.
cat >"$scratch/all.yaml" <<'SCENE'
abut: 1
title: Points, elements and a rigid body, all in contact, for a few steps
gravity: [0, -9.81]
time: {end: 3e-4, dt: 1e-4}
grid: {from: [-1, -1], to: [4, 3], cell: 0.05}
materials:
  soil: {model: von-mises, E: 1e6, nu: 0.3, density: 1800, yield: 2e4}
  clay: {model: modified-cam-clay, lambda: 0.1, kappa: 0.02, M: 1, nu: 0.3, void_ratio: 1, pressure: 1e4, density: 1800}
  steel: {model: neo-hookean, E: 1e7, nu: 0.3, density: 2000}
bodies:
  soil: {method: material-points, material: soil, shape: {box: [[0, 0], [3, 1]]}, velocity: [0, 0.5], f_bar: cell, body_force: ["x*t", "y"]}
  block: {method: material-points, material: steel, shape: {disc: {center: [0.8, 1.4], radius: 0.4}}, velocity: [1, -1], fill: {rule: cvt, points: 400, iterations: 8}}
  plate: {method: finite-elements, material: steel, mesh: {box: [[1.6, 1], [2.9, 1.4]], elements: [130, 20], type: q4}, velocity: [0, -1]}
  floor: {method: rigid, shape: {box: [[-0.5, -0.4], [3.5, 0]]}, motion: {velocity: [0, 0], spin: 0}}
contact:
  - {bodies: [soil, block], algorithm: multi-velocity, response: coulomb, friction: 0.3}
  - {bodies: [soil, plate], algorithm: multi-velocity, response: coulomb, friction: 0.3}
  - {bodies: [soil, floor], algorithm: multi-velocity, response: coulomb, friction: 0.3}
monitors:
  - {name: push, contact: 0, value: force.y}
  - {name: speed, body: soil, value: velocity.y}
history: {every: 1}
output: {every: 2e-4, fields: [stress, velocity]}
checkpoint: {steps: 2}
SCENE

OMP_TOOL=disabled "$build/abut" run "$scratch/all.yaml" --quiet -j 3 -o "$scratch/blind" >"$scratch/blind.log" 2>&1
grep -q 'WARNING: ThreadSanitizer' "$scratch/blind.log" || { wrong=1; echo "without what OpenMP says of its barriers there should be reports: the build in $build does not look for races"; }
all=$scratch/all.yaml
races plain "$all"
races linear_apic "$all" bodies.soil.basis=linear bodies.soil.transfer=apic bodies.soil.f_bar=patch bodies.soil.update=usf
races bspline2_tpic "$all" bodies.soil.basis=bspline2 bodies.soil.transfer=tpic bodies.soil.f_bar=patch bodies.soil.update=usl
races bspline3_xpic "$all" bodies.soil.basis=bspline3 'bodies.soil.transfer={xpic: 3}' bodies.soil.material=clay
races cpdi_fmpm "$all" bodies.soil.basis=cpdi 'bodies.soil.transfer={fmpm: 2}' bodies.soil.f_bar=false
races segments "$all" 'contact[0].algorithm=point-to-segment' 'contact[1].algorithm=point-to-segment' 'contact[2].algorithm=point-to-segment' 'contact[1].response=penalty'
races penalty_normals "$all" 'contact[0].response=penalty' 'contact[1].response=penalty' 'contact[0].normal=regression'
races surface_points "$all" bodies.soil.surface=points bodies.soil.f_bar=false
races q8_clay "$all" bodies.plate.mesh.type=q8 bodies.soil.material=clay time.dt=2e-5 time.end=6e-5
races q6 "$all" bodies.plate.mesh.type=q6 bodies.plate.material=soil
races checked "$all" checked=true
races restarted "$all" checkpoint.steps=1
timeout 300 "$build/abut" run "$all" --quiet -j 2 -o "$scratch/restarted" --set checkpoint.steps=1 --restart "$scratch/restarted/checkpoint.previous.abut" >"$scratch/restart.log" 2>&1
judge "a restart" $? "$scratch/restart.log"
races axisymmetric tests/verification/axi_two_tubes.yaml time.end=T/20 expect=[]
races turned tests/verification/incline_turned.yaml time.end=0.004 constants.settle=0.002 expect=[]
races boundaries_of_points tests/verification/boundary_cavity.yaml time.end=0.02*b/c expect=[]
races boundaries_of_elements tests/verification/boundary_pulse_fe.yaml time.end=0.002 expect=[]
races belt tests/verification/rigid_belt.yaml expect=[] 'time={end: 1e-3, cfl: 0.5}'

if [ "${2:-}" = all ]; then
    for scene in tests/verification/*.yaml cases/*/scene.yaml; do # as far as each comes in ten seconds
        name=${scene//\//_}
        timeout -s TERM -k 60 10 "$build/abut" run "$scene" --quiet -j 3 -o "$scratch/$name" --set expect=[] >"$scratch/$name.log" 2>&1
        also=124 judge "$name" $? "$scratch/$name.log"
        rm -rf "${scratch:?}/$name"
    done
    ctest --test-dir "$build" -j 2 --timeout 3000 --output-on-failure >"$scratch/units.log" 2>&1
    judge "unit tests" $? "$scratch/units.log"
fi
echo "$ran runs without a race: $([ $wrong -eq 0 ] && echo yes || echo no)"
exit $wrong
