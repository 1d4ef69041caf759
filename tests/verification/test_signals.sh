#!/bin/bash
# cost: 8
# A run that is asked to end by a signal says so, leaves what it had with a checkpoint and exits 128 + the signal; one that meets a full disk, at once or later, exits 1 and says which
# file could not be written. test_signals.sh BUILD
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$(realpath "${1:?the build folder}")
scratch=$(realpath "${ABUT_SCRATCH:-$(mktemp -d)}")
wrong=0
cat >"$scratch/scene.yaml" <<'SCENE'
abut: 1
title: Two blocks that fall
space: plane-strain
gravity: [0, -9.81]
time: {end: 1000, dt: 1e-4}
grid: {from: [-8, -100], to: [8, 8], cell: 0.25}
materials:
  rubber: {model: linear-elastic, E: 1e5, nu: 0.3, density: 1000}
bodies:
  block: {method: material-points, material: rubber, shape: {box: [[-4, -4], [0, 4]]}}
  other: {method: material-points, material: rubber, shape: {box: [[2, -4], [4, 4]]}}
history: {every: 1}
output: {every: 1e-3, fields: [stress, velocity]}
SCENE
say() { wrong=1; echo "$1"; [ -f "${2:-}" ] && sed 's/^/    /' "$2"; }

for signal in INT TERM HUP; do
    out=$scratch/$signal
    "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$out" >"$out.log" 2>&1 &
    run=$!
    for _ in $(seq 200); do
        [ "$(grep -c '<Time ' "$out/results.xdmf" 2>/dev/null)" -ge 3 ] 2>/dev/null && break
        sleep 0.05
    done
    kill -$signal $run
    wait $run
    status=$?
    number=$(kill -l $signal)
    [ $status -eq $((128 + number)) ] || say "SIG$signal: exit $status, wanted $((128 + number))" "$out.log"
    grep -q "\"outcome\": \"stopped by signal $number\"" "$out/summary.json" || say "SIG$signal: summary.json does not say that the run was stopped"
    /usr/bin/python3 tests/verification/check_results.py "$out" >"$out.check" 2>&1 || say "SIG$signal: the results cannot be read" "$out.check"
    [ -f "$out/checkpoint.abut" ] || say "SIG$signal: no checkpoint"
    end=$(/usr/bin/python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["time"] + 1e-3)' "$out/summary.json")
    "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$out" --restart "$out/checkpoint.abut" --set time.end="$end" >"$out.log" 2>&1 ||
        say "SIG$signal: exit $? of a run that goes on from its checkpoint" "$out.log"
done

# Two signals at once are one: `timeout` sends its own to the program and to its group. Stopped by SIGSTOP, a run meets both at the same moment.
begin() { # settings: a run in $out that has written three frames; its process is $run
    rm -rf "$out"
    "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$out" "$@" >"$out.log" 2>&1 &
    run=$!
    for _ in $(seq 200); do
        [ "$(grep -c '<Time ' "$out/results.xdmf" 2>/dev/null)" -ge 3 ] 2>/dev/null && break
        sleep 0.05
    done
}
good_order() { # what, status: the run in $out was ended with all that it leaves
    [ "$2" -eq 130 ] || [ "$2" -eq 143 ] || say "$1: exit $2" "$out.log"
    [ -f "$out/checkpoint.abut" ] && [ -f "$out/summary.json" ] || say "$1: the run was ended at once, without a checkpoint"
    /usr/bin/python3 tests/verification/check_results.py "$out" >"$out.check" 2>&1 || say "$1: the results cannot be read" "$out.check"
}
out=$scratch/twice
begin
kill -STOP $run
kill -TERM $run
kill -INT $run
kill -CONT $run
wait $run
good_order "two signals at once" $?
rm -rf "$out"
timeout -s INT 2 "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$out" >"$out.log" 2>&1
[ $? -eq 124 ] || say "a run under timeout: exit $?" "$out.log"
good_order "a run under timeout" 130

# Whoever sends another one later does not want to wait, and the frames can be read: here a step that never ends.
out=$scratch/looping
mkdir "$scratch/loops"
cp "$build/tests/plugins/broken/broken_material_LOOPS.so" "$scratch/loops" # for ever, where something is strained by more than 0.05 in a step
sed 's/model: linear-elastic/model: my-law/' "$scratch/scene.yaml" >"$scratch/loops.yaml"
"$build/abut" run "$scratch/loops.yaml" --quiet -j 1 -o "$out" --plugin-path "$scratch/loops" --set output.every=1e-4 \
    --set 'bodies.other.body_force=["t < 0.01 ? 0 : 1e7*(x - 3)", 0]' >"$out.log" 2>&1 &
run=$!
before=none
for _ in $(seq 200); do
    frames=$(grep -c '<Time ' "$out/results.xdmf" 2>/dev/null)
    [ "${frames:-0}" -ge 100 ] && [ "$frames" = "$before" ] && break # it writes no more: the step that never ends has begun
    before=$frames
    sleep 0.5
done
began=$(date +%s%N)
kill -TERM $run
sleep 0.1
kill -TERM $run
ended=$(date +%s%N)
sleep 0.1
# (where the machine itself took longer between the two, they are two)
kill -0 $run 2>/dev/null || [ $((ended - began)) -gt 400000000 ] || say "a signal too many: a second one ended the run that came 0.1 s after the first"
sleep 0.6
kill -INT $run
wait $run
status=$?
[ $status -eq 130 ] || say "two signals: exit $status, wanted 130" "$out.log"
[ ! -f "$out/summary.json" ] || say "two signals: the run was ended in good order, not at once"
/usr/bin/python3 tests/verification/check_results.py "$out" --partial >"$out.check" 2>&1 || say "two signals: the results cannot be read" "$out.check"

# full NAME KIB CELL: no file may grow beyond that; the size of the cell says how large a frame is.
full() {
    local out=$scratch/full_$1 status
    (
        ulimit -f "$2"
        exec "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$out" --set time.end=0.2 --set grid.cell="$3"
    ) 2>&1 | cat >"$out.log" # what it says goes to no file, so that only its results meet the limit
    status=${PIPESTATUS[0]}
    [ $status -eq 1 ] || say "$2 KiB a file: exit $status, wanted 1" "$out.log"
    grep -qE "^error: .*cannot write '.*'.*: File too large" "$out.log" || say "$2 KiB a file: the message does not say what could not be written" "$out.log"
}
full at_once 0 0.25
full in_the_first_frame 60 0.25
full later 60 1
/usr/bin/python3 tests/verification/check_results.py "$scratch/full_later" --partial >"$scratch/later.check" 2>&1 ||
    say "the frames before a full disk cannot be read" "$scratch/later.check"

# A link in the folder is replaced by a file of our own: nothing is written where it leads to.
mkdir -p "$scratch/linked"
echo mine >"$scratch/precious"
for name in history.csv history.csv.part summary.json summary.json.part results.h5.part checkpoint.abut.part; do ln -s ../precious "$scratch/linked/$name"; done
"$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$scratch/linked" --set time.end=0.002 --set checkpoint.steps=5 >"$scratch/linked.log" 2>&1 ||
    say "a folder with links in it: exit $?" "$scratch/linked.log"
[ "$(cat "$scratch/precious")" = mine ] || say "a run has written through a link out of its folder"
mkdir -p "$scratch/linked_frames" "$scratch/elsewhere"
ln -s ../elsewhere "$scratch/linked_frames/frames"
"$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$scratch/linked_frames" --set time.end=0.002 >"$scratch/linked.log" 2>&1
[ $? -eq 1 ] && grep -q "frames' is a link to another place" "$scratch/linked.log" || say "frames is a link to another folder: not refused" "$scratch/linked.log"

# A place where nothing can be made is said as that.
mkdir -p "$scratch/taken/history.csv"
"$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$scratch/taken" --set time.end=0.01 >"$scratch/taken.log" 2>&1
status=$?
[ $status -eq 1 ] || say "history.csv is a folder: exit $status, wanted 1" "$scratch/taken.log"
grep -q "name another folder with -o" "$scratch/taken.log" || say "history.csv is a folder: no remedy" "$scratch/taken.log"

# What an earlier run with other bodies left is gone; files of other names stay.
out=$scratch/again
"$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$out" --set time.end=0.001 || say "the first of two runs failed"
touch "$out/notes.txt"
sed 's/^  other:/  second:/' "$scratch/scene.yaml" >"$scratch/renamed.yaml"
"$build/abut" run "$scratch/renamed.yaml" --quiet -j 1 -o "$out" --set time.end=0.001 || say "the second of two runs failed"
found=$(cd "$out" && echo *)
[ "$found" = "history.csv notes.txt results.h5 results.xdmf results_block.xdmf results_second.xdmf summary.json" ] || say "after two runs there are: $found"
exit $wrong
