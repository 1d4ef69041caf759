#!/bin/bash
# cost: 15
# Every single allocation of a small run fails once: each time there is an error that says so and an exit status of 1 or 2, or the run does not need it and gives the
# same history. test_allocation.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
source=$PWD
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
export OMP_NUM_THREADS=1
cd "$scratch" || exit 1
cc -O1 -shared -fPIC "$source/tests/plugins/fail_allocation.c" -o fail.so || exit 1
cat >scene.yaml <<'YAML'
abut: 1
title: Two small bodies meet
space: plane-strain
gravity: [0, -9.81]
time: {end: 4e-4, dt: 1e-4}
grid: {from: [0, 0], to: [1, 1.5], cell: 0.25, sides: {left: roller, right: roller, bottom: fixed, top: free}}
materials:
  m: {model: linear-elastic, E: 1e6, nu: 0.3, density: 1000}
bodies:
  low: {method: finite-elements, material: m, mesh: {box: [[0.2, 0.2], [0.8, 0.5]], elements: [2, 1], type: q4}}
  high: {method: material-points, material: m, shape: {box: [[0.25, 0.5], [0.75, 1]]}, velocity: [0, -1]}
contact:
  - {bodies: [high, low], algorithm: multi-velocity, response: coulomb, friction: 0.3}
monitors:
  - {name: force, contact: 0, value: normal-force}
YAML
run() { "$build/abut" run scene.yaml --quiet -j 1 -o out >said.txt 2>&1; }
FAIL_COUNT_FILE=count.txt LD_PRELOAD=./fail.so run || { echo "the run fails without a failing allocation: $(cat said.txt)"; exit 77; }
cp out/history.csv wanted.csv
count=$(cat count.txt)
[ "$count" -gt 100 ] || { echo "only $count allocations were seen"; exit 1; }
wrong=0 errors=0
for ((n = 0; n < count; n++)); do
    rm -rf out
    FAIL_AT=$n LD_PRELOAD=./fail.so run
    status=$?
    case $status in
    0) cmp -s out/history.csv wanted.csv || { wrong=1; echo "allocation $n of $count fails: exit 0 and another history: $(cat said.txt)"; } ;;
    1 | 2)
        errors=$((errors + 1))
        grep -q 'error' said.txt || { wrong=1; echo "allocation $n of $count fails: exit $status and no error: $(cat said.txt)"; } ;;
    *) wrong=1; echo "allocation $n of $count fails: exit $status: $(cat said.txt)" ;;
    esac
done
[ $errors -gt $((count / 2)) ] || { wrong=1; echo "only $errors of $count failing allocations were errors"; }
exit $wrong
