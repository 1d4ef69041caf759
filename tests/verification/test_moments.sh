#!/bin/bash
# cost: 2
# Monitors of bodies against the laws they must obey in every step: the moment of the contact forces on a rigid body turns it as its moment of inertia says, standing and seen
# from a moving frame; what contact and supports put on a body of elements is the change of its momentum and, about the origin, of its angular momentum. test_moments.sh BUILD
set -eu
cd "$(dirname "$0")/../.."
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
cat >"$scratch/scene.yaml" <<'SCENE'
abut: 1
space: plane-strain
constants: {V: 0}
gravity: [1, -9.81]
time: {end: 0.1, dt: 1e-4}
materials: {stone: {model: linear-elastic, E: 1e7, nu: 0.3, density: 2000}}
bodies:
  table: {method: finite-elements, material: stone, mesh: {box: [[0, 0], [2, 0.2]], elements: [16, 2], type: q8}, fix: [{where: {side: bottom}, velocity: [V, 0]}], velocity: [V, 0], gravity: false}
  ball: {method: rigid, material: stone, shape: {disc: {center: [1.1, 0.3], radius: 0.1}}, velocity: [V, 0]}
  cube: {method: rigid, material: stone, shape: {box: [[1.4, 0.2], [1.5, 0.6]]}, velocity: [V, 0]}
contact:
  - {bodies: [ball, table], algorithm: point-to-segment, response: coulomb, friction: 0.3}
  - {bodies: [table, cube], algorithm: point-to-segment, response: coulomb, friction: 0.3}
monitors:
  - {name: ball_m, body: ball, value: moment}
  - {name: ball_s, body: ball, value: rotation-rate}
  - {name: cube_m, body: cube, value: moment}
  - {name: cube_s, body: cube, value: rotation-rate}
  - {name: held, body: table, value: reaction.y}
  - {name: heldx, body: table, value: reaction.x}
  - {name: heldm, body: table, value: reaction.moment}
  - {name: L, body: table, value: angular-momentum}
  - {name: tm, body: table, value: moment}
  - {name: tpx, body: table, value: momentum.x}
  - {name: tpy, body: table, value: momentum.y}
  - {name: tx, body: table, value: position.x}
  - {name: ty, body: table, value: position.y}
  - {name: fx, body: table, value: force.x}
  - {name: fy, body: table, value: force.y}
SCENE
for speed in 0 3; do
    "$build/abut" run "$scratch/scene.yaml" --quiet -j 1 -o "$scratch/$speed" --set constants.V=$speed >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
    python3 - "$scratch/$speed/history.csv" <<'PYTHON'
import csv
import math
import sys

with open(sys.argv[1], newline="") as stream:
    rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]
inertia = {"ball": 0.5 * 2000 * math.pi * 0.1**4, "cube": 2000 * 0.1 * 0.4 * (0.1**2 + 0.4**2) / 12}
worst, largest = {}, {}


def check(name, size, off):
    worst[name] = max(worst.get(name, 0.0), abs(off))
    largest[name] = max(largest.get(name, 0.0), abs(size))


for a, b in zip(rows, rows[1:]):
    dt = b["dt"]
    for body in inertia:
        check(body, b[f"{body}_m"], inertia[body] * (b[f"{body}_s"] - a[f"{body}_s"]) / dt - b[f"{body}_m"])
    check("table x", b["heldx"], (b["tpx"] - a["tpx"]) / dt - b["fx"] - b["heldx"])
    check("table y", b["held"], (b["tpy"] - a["tpy"]) / dt - b["fy"] - b["held"])
    moment = b["tm"] + a["tx"] * b["fy"] - a["ty"] * b["fx"]  # about the origin
    check("table turns", b["heldm"], (b["L"] - a["L"]) / dt - moment - b["heldm"])
assert all(size > 1 for size in largest.values()), largest
for name in worst:  # contact acts where the surfaces meet, the nodes of a face turn a little further: not quite to rounding
    assert worst[name] < (1e-6 if name == "table turns" else 1e-9) * largest[name], (name, worst[name], largest[name])
print("balance of each step:", {name: f"{worst[name] / largest[name]:.1e}" for name in worst})
PYTHON
done
