#!/bin/bash
# cost: 2
# Local damping beside what is driven: the end of a run tells what it took of the driving work, with the remedy that fits, and is silent where it took little, had ended before, or only brought a load or
# weight to rest. test_drag.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
cd "${ABUT_SCRATCH:-$(mktemp -d)}" || exit 1
cat >scene.yaml <<'SCENE'
abut: 1
title: A plate pressed into a block
constants: {v: 0.05}
damping: {local: 0.5}
time: {end: 0.4, cfl: 0.5}
grid: {from: [-0.5, -0.25], to: [1.5, 1.5], cell: 0.125, sides: {bottom: fixed}}
materials:
  soft: {model: linear-elastic, E: 1e6, nu: 0.2, density: 1000}
bodies:
  block: {method: material-points, material: soft, shape: {box: [[0, -0.25], [1, 0.75]]}}
  plate: {method: rigid, shape: {box: [[-0.25, 0.75], [1.25, 1]]}, motion: {velocity: [0, -v], spin: 0}}
contact: [{bodies: [block, plate], algorithm: multi-velocity, response: coulomb, friction: 0.3}]
history: {every: 1}
SCENE
elements='{method: finite-elements, material: soft, mesh: {box: [[0, -0.25], [1, 0.75]], elements: [8, 8], type: q4}, fix: [{where: {side: bottom}, velocity: [0, 0]}, {where: {side: top}, velocity: [null, -v]}]}'
wrong=0
told() { # PATTERN ("" for nothing about damping) SETTING...
    local pattern=$1 set=() s status
    shift
    for s; do set+=(--set "$s"); done
    "$build/abut" run scene.yaml --quiet -j 1 -o out "${set[@]}" >said.txt 2>&1
    status=$?
    if [ $status -ne 0 ] || { [ -n "$pattern" ] && ! grep -Eq -- "$pattern" said.txt; } || { [ -z "$pattern" ] && grep -q 'local damping' said.txt; }; then
        wrong=1
        echo "MISSED  '$pattern' (exit $status): $*"
        sed 's/^/        /' said.txt
    else
        echo "passed  '$pattern': $*"
    fi
}
told "scene.yaml:11:3: warning: local damping took 6\.8.* J while body 'plate' was driven, 3\.2.* % of the work of 212 J .*let it move only after damping.until"
# What it says is the ledger's: here all damping is beside the plate, and all work from outside is its.
python3 - <<'PYTHON' || wrong=1
import json, re
end = json.load(open("out/summary.json"))["ledger"]["end"]
took, part, work = map(float, re.search(r"took (\S+) J .*, (\S+) % of the work of (\S+) J", open("said.txt").read()).groups())
good = abs(took / end["damping"] - 1) < 0.01 and abs(work / end["external"] - 1) < 0.01 and abs(part - 100 * end["damping"] / end["external"]) < 0.01
print("passed" if good else "MISSED", "the ledger:", took, end["damping"], work, end["external"])
raise SystemExit(not good)
PYTHON
cp said.txt whole.txt
told "damping.until: 0.0[12]" 'bodies.plate.motion.velocity[1]="t < 0.02 ? 0 : -v"'
told "" damping.local=0.1
told "" damping.until=0.02 'bodies.plate.motion.velocity[1]="t < 0.02 ? 0 : -v"'
told "" 'bodies.plate.motion={velocity: [0, 0], spin: 0}' 'gravity=[0, -10]'
told "" 'gravity=[0, -10]' # the block settles meanwhile, which damping is there for
told "" "bodies.plate.motion={velocity: [0, null], spin: 0, mass: 1000}" 'gravity=[0, -10]'
told "local damping took .* body 'block' was driven" "bodies={block: $elements}" contact=[]
# A restart knows of what was before it.
"$build/abut" run scene.yaml --quiet -j 1 -o again --set checkpoint.steps=60 >again.txt 2>&1
"$build/abut" run scene.yaml --quiet -j 1 -o again --set checkpoint.steps=60 --restart again/checkpoint.previous.abut >again.txt 2>&1
cmp whole.txt again.txt || { wrong=1; echo "MISSED  a restart"; cat again.txt; }
sed -i 's/^damping:.*//; s/^time:.*/stages: [{name: push, duration: 0.4, cfl: 0.5, damping: {local: 0.5}}]/' scene.yaml
told "leave .damping. out of the stage in which it moves"
told "" 'stages[0].damping.local=0.1'
[ $wrong -eq 0 ]
