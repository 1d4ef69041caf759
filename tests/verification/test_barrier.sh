#!/bin/bash
# cost: 5
# Clay against a flexible wall, by both algorithms of contact: in every step the clay loses the momentum that contact books, the wall gains it with what its support and its weight
# give, and force on a body is that on the other reversed; all to rounding. test_barrier.sh BUILD
set -eu
cd "$(dirname "$0")/../.."
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
monitors="[{name: push_x, contact: 0, value: force.x}, {name: push_y, contact: 0, value: force.y}, {name: mass_force_x, body: mass, value: force.x},
  {name: wall_force_x, body: wall, value: force.x}, {name: wall_force_y, body: wall, value: force.y}, {name: held_x, body: wall, value: reaction.x},
  {name: held_y, body: wall, value: reaction.y}, {name: mass_x, body: mass, value: momentum.x}, {name: wall_x, body: wall, value: momentum.x},
  {name: wall_y, body: wall, value: momentum.y}, {name: weight, body: wall, value: mass}]"
for algorithm in multi-velocity point-to-segment; do
    "$build/abut" run cases/barrier/scene.yaml --quiet -j 1 -o "$scratch/$algorithm" --set contact[0].algorithm=$algorithm --set grid.cell=0.125 --set time.end=0.3 \
        --set "monitors=$monitors" --set 'expect=[]' --set 'output.every=0.1' >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
    /usr/bin/python3 tests/verification/check_results.py "$scratch/$algorithm"
    python3 - "$scratch/$algorithm/history.csv" $algorithm <<'PYTHON'
import csv
import sys

with open(sys.argv[1], newline="") as stream:
    rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]
size, worst, pushed = 14400.0, {}, 0.0  # kg m/s: the clay's momentum at the start


def check(name, off):
    worst[name] = max(worst.get(name, 0.0), abs(off) / size)


for before, now in zip(rows, rows[1:]):
    dt = now["dt"]
    pushed += dt * now["push_x"]
    check("clay", now["mass_x"] - before["mass_x"] + dt * now["push_x"])
    check("wall along x", now["wall_x"] - before["wall_x"] - dt * (now["push_x"] + now["held_x"]))
    check("wall along y", now["wall_y"] - before["wall_y"] - dt * (now["push_y"] + now["held_y"] - 9.81 * now["weight"]))
    check("force on the bodies", dt * (now["wall_force_x"] - now["push_x"]))
    check("force on the other body", dt * (now["mass_force_x"] + now["push_x"]))
    check("force on the bodies, y", dt * (now["wall_force_y"] - now["push_y"]))
assert pushed > 0.5 * size, pushed
assert all(value < 1e-13 for value in worst.values()), worst
print(f"{sys.argv[2]}: impulse {pushed:.6g} N s; balance of momentum in a step, of the first momentum: {max(worst.values()):.1e}")
PYTHON
done
