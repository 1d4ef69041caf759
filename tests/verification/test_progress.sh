#!/bin/bash
# cost: 6
# On a terminal a run draws a bar; no line is longer than the terminal is wide, and nothing of it stays. test_progress.sh BUILD
set -eu
build=$(realpath "${1:?the build folder}")
command -v script >/dev/null || { echo "script(1) is not there"; exit 77; }
cd "${ABUT_SCRATCH:-$(mktemp -d)}"
cat >scene.yaml <<'SCENE'
abut: 1
space: plane-strain
time: {end: 1000, dt: 1e-4}
grid: {from: [0, 0], to: [4, 4], cell: 0.25}
materials: {rubber: {model: linear-elastic, E: 1e5, nu: 0.3, density: 1000}}
bodies: {block: {method: material-points, material: rubber, shape: {box: [[1, 1], [3, 3]]}}}
history: {every: 1000}
SCENE
for columns in 40 64 80 140; do
    # stopped by one signal after two seconds (timeout would send another to its group, and a second one ends a run at once): a bar is drawn ten times a second
    script -qec "stty cols $columns rows 24; timeout --foreground -s INT 2 '$build/abut' run scene.yaml -j 1 -o out >table.txt" /dev/null </dev/null >drawn.txt || true
    python3 - $columns <<'PYTHON'
import re
import sys

columns = int(sys.argv[1])
drawn = open("drawn.txt", encoding="utf-8", newline="").read()
drawn, told, end = drawn.partition("stopped at t = ") # on a line of its own, where the bar was
assert re.fullmatch(r"[0-9.e+-]+ s; go on with --restart out/checkpoint.abut\r\n", end), repr(end)
assert drawn.endswith("\r\x1b[K"), repr(drawn[-80:])
lines = [re.sub(r"\x1b\[[0-9;]*[A-Za-z]", "", line) for line in re.split(r"[\r\n]+", drawn)]
lines = [line for line in lines if line]
assert len(lines) >= 3, drawn
longest = max(map(len, lines))
assert longest < columns, (columns, longest, lines)
assert all(re.match(r" *\d+ %", line) for line in lines), lines
if columns > 60:
    assert all(re.search(r"% [#.]{10,20} ", line) for line in lines), lines
print(f"{columns} columns: {len(lines)} lines, the longest of {longest}: {lines[-1]}")
PYTHON
done
