#!/bin/bash
# cost: 45
# Each algorithm with each response and each pair of methods: two blocks turned by 30 degrees fly at each other obliquely and part. Whatever the pair, linear
# momentum is kept to rounding, contact and friction take energy and give none, and what the response promises of normal and tangential motion comes out; then
# impact.yaml by penalty and distance-power. test_responses.sh BUILD
set -eu
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
/usr/bin/env python3 - "$build/abut" "$scratch" <<'PYTHON'
import csv
import json
import math
import subprocess
import sys

abut, scratch = sys.argv[1:]
runs = wrong = 0

# Both blocks along a direction at 30 degrees: n. a flies at b along n with V and across it with U against b's -U. E = density = 1, nu = 0: waves have speed 1.
LONG, WIDE, V, U, GAP, CELL = 0.5, 0.25, 1e-3, 3e-4, 0.003, 1 / 24
N, T = (math.cos(math.pi / 6), 0.5), (-0.5, math.cos(math.pi / 6))


def at(along, across):
    return [along * N[k] + across * T[k] for k in range(2)]


def body(method, begin, velocity, index):
    corners = [at(begin, 0), at(begin + LONG, 0), at(begin + LONG, WIDE), at(begin, WIDE)]
    common = f"material: elastic, velocity: {velocity}"
    if method == "points":
        return f"{{method: material-points, {common}, shape: {{polygon: {corners}}}, fill: {{per_cell: 4}}}}"
    if method == "elements":
        edges = [[corners[0], corners[1]], [corners[1], corners[2]], [corners[3], corners[2]], [corners[0], corners[3]]]
        names = ("bottom", "right", "top", "left")
        patch = ", ".join(f"{name}: {edge}" for name, edge in zip(names, edges))
        return f"{{method: finite-elements, {common}, mesh: {{patch: {{{patch}}}, elements: [{12 + index}, {6 + index}], type: q4}}}}"
    return f"{{method: rigid, {common}, shape: {{polygon: {corners}}}}}"


def scene(methods, algorithm, response):
    velocity = [[V * N[k] + U * T[k] for k in range(2)], [-U * T[k] for k in range(2)]]
    values = "\n".join(f"  - {{name: momentum_{x}, value: momentum.{x}}}" for x in "xy")
    for b in "ab":
        values += "".join(f"\n  - {{name: {b}_v{x}, body: {b}, value: velocity.{x}}}" for x in "xy")
    return f"""abut: 1
space: plane-strain
time: {{end: {GAP / V + 3 * LONG}, cfl: 0.5}}
grid: {{from: [-0.5, -0.5], to: [1.5, 1.25], cell: {CELL}}}
materials: {{elastic: {{model: linear-elastic, E: 1, nu: 0, density: 1}}}}
bodies:
  a: {body(methods[0], 0, velocity[0], 0)}
  b: {body(methods[1], LONG + GAP, velocity[1], 1)}
contact: [{{bodies: [a, b], algorithm: {algorithm}, {response}}}]
monitors:
{values}
  - {{name: penetration, contact: 0, value: penetration}}
history: {{every: 1}}
"""


RESPONSES = {
    "coulomb": "response: coulomb, friction: 0.2",
    "frictionless": "response: frictionless",
    "tied": "response: tied",
    "distance-power": "response: distance-power, friction: 0.2",
    "penalty": "response: penalty, friction: 0.2",
    "penalty of modulus": "response: penalty, stiffness_of: modulus, stiffness: 3, friction: 0.2",
}
PAIRS = [("points", "points"), ("points", "elements"), ("elements", "points"), ("elements", "elements"), ("points", "rigid"), ("rigid", "elements")]
for algorithm in ("multi-velocity", "point-to-segment"):
    for response, text in RESPONSES.items():
        for methods in PAIRS:
            runs += 1
            name = f"{algorithm}, {response}, {methods[0]} and {methods[1]}"
            folder = f"{scratch}/{runs}"
            with open(f"{folder}.yaml", "w") as stream:
                stream.write(scene(methods, algorithm, text))
            done = subprocess.run([abut, "run", f"{folder}.yaml", "--quiet", "-j", "1", "-o", folder], capture_output=True, text=True)
            if done.returncode:
                print(f"WRONG   {name}: {done.stderr}")
                wrong += 1
                continue
            with open(f"{folder}/history.csv") as stream:
                rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(line for line in stream if not line.startswith("#"))]
            mass, first, last = LONG * WIDE, rows[0], rows[-1]
            drift = max(math.hypot(row["momentum_x"] - first["momentum_x"], row["momentum_y"] - first["momentum_y"]) for row in rows) / (mass * V)
            taken = (last["friction"] + last["contact"]) / first["kinetic"]
            friction_falls = max(max(a["friction"] - b["friction"] for a, b in zip(rows, rows[1:])), 0) / first["kinetic"]
            total = [row["kinetic"] + row["strain"] for row in rows]
            made = (max(total) - total[0]) / total[0]
            change = [[last[f"{b}_v{x}"] - first[f"{b}_v{x}"] for x in "xy"] for b in "ab"]
            normal = sum(change[1][k] * N[k] for k in range(2)) / V
            ratio = -sum(change[1][k] * T[k] for k in range(2)) / V / normal if normal else math.nan
            overlap = max(row["penetration"] for row in rows) / CELL
            bad = []
            if not drift < 1e-12: bad.append("momentum")
            if not taken > 0: bad.append("contact gives energy")
            if not made < 1e-9: bad.append("energy is made")
            if not friction_falls < 1e-3: bad.append("friction gives energy")
            if not overlap < 0.003: bad.append("overlap")
            # Elastic blocks nearly swap their normal speeds (what a few cells across can resolve of it); a rigid one keeps more, by its wave's reflection.
            low, high = (0.92, 1) if "rigid" not in methods else (0.78, 0.88)
            if response != "tied" and not low < normal < high: bad.append("normal impulse")
            # They stop slipping before they part, so that less than friction times the normal impulse is carried.
            low, high = (-1e-3, 1e-3) if response == "frictionless" else (-0.14, -0.12) if "rigid" not in methods else (-0.13, -0.1)
            if response != "tied" and not low < ratio < high: bad.append("tangential impulse")
            if response == "tied" and not normal < 0.7: bad.append("they part")
            print(f"{'WRONG ' if bad else 'passed'}  {name}: momentum {drift:.1e}, energy taken {taken:.3f} made {made:.1e}, b gains {normal:.3f} v, tangential {ratio:.3f} of it, "
                  f"overlap {overlap:.4f} cells{'' if not bad else ': ' + ', '.join(bad)}")
            wrong += bool(bad)

# Impact of two bars: force, duration, speeds, energy and momentum as with the exact response.
for settings in (["response=penalty"], ["response=penalty", "stiffness=1"], ["response=penalty", "stiffness_of=modulus", "stiffness=3"], ["response=distance-power"],
                 ["algorithm=point-to-segment"], ["algorithm=point-to-segment", "response=penalty"], ["algorithm=point-to-segment", "response=distance-power"]):
    runs += 1
    command = [abut, "run", "tests/verification/impact.yaml", "--strict", "--quiet", "-j", "1", "-o", f"{scratch}/{runs}", "--set", "constants.shift=0.37"]
    for setting in settings:
        command += ["--set", f"contact[0].{setting}"]
    done = subprocess.run(command, capture_output=True, text=True)
    print(f"{'WRONG ' if done.returncode else 'passed'}  impact of two bars, {', '.join(settings)} {done.stderr}")
    if not done.returncode:
        with open(f"{scratch}/{runs}/summary.json") as stream:
            print("        " + ", ".join(f"{e['name']} {e['error']:.2g}" for e in json.load(stream)["expects"]))
    wrong += bool(done.returncode)

# A block pulled along a plane: limits of adhesion and friction. Where both bodies see each other's faces each pass has half of the surface.
for settings in (["algorithm=point-to-segment"], ["algorithm=point-to-segment", "passes=first"], ["response=distance-power"], ["response=penalty", "friction=0.3"],
                 ["algorithm=point-to-segment", "response=penalty", "friction=0.3"]):
    runs += 1
    command = [abut, "run", "tests/verification/pulled_block.yaml", "--strict", "--quiet", "-j", "1", "-o", f"{scratch}/{runs}"]
    if "response=penalty" in settings:
        command += ["--set", "constants.mu=0.3", "--set", "constants.adhesion=0"]
    for setting in settings:
        command += ["--set", f"contact[0].{setting}"]
    done = subprocess.run(command, capture_output=True, text=True)
    print(f"{'WRONG ' if done.returncode else 'passed'}  block pulled along a plane, {', '.join(settings)}{' ' + done.stderr if done.returncode else ''}")
    wrong += bool(done.returncode)

# Springs feel every jump of a gap: a block that slides down a turned plane over the grid's cells makes no energy. (One step in a thousand with a normal that leans by
# a thousandth, and it is thrown off the plane.)
runs += 1
subprocess.run([abut, "run", "tests/verification/incline_turned.yaml", "--quiet", "-j", "1", "-o", f"{scratch}/{runs}", "--set", "contact[0].response=penalty", "--set", "constants.mu=0",
                "--set", "time.end=0.4"], capture_output=True, check=True)
with open(f"{scratch}/{runs}/summary.json") as stream:
    error = next(e["error"] for e in json.load(stream)["expects"] if e["name"] == "ledger closes")
print(f"{'passed' if error < 5e-4 else 'WRONG '}  block on springs slides down a turned plane: ledger closes to {error:.1e}")
wrong += not error < 5e-4

# A corner thrown at points by springs: no energy at any step, wherever the grid stands.
for cfl, shift in ((0.4, 0.0213), (0.2, 0), (0.1, 0), (0.05, 0), (0.05, 0.05)):
    runs += 1
    done = subprocess.run([abut, "run", "tests/verification/penalty_corner.yaml", "--strict", "--quiet", "-j", "1", "-o", f"{scratch}/{runs}", "--set", f"time.cfl={cfl}",
                           "--set", f"constants.shift={shift}"], capture_output=True, text=True)
    print(f"{'WRONG ' if done.returncode else 'passed'}  a corner thrown at points by springs, cfl {cfl}, shift {shift}{' ' + done.stderr if done.returncode else ''}")
    wrong += bool(done.returncode)

# The classical form: by velocities alone bodies meet cells too early; what fades with the distance meets later.
begins = {}
for response in ("frictionless", "distance-power"):
    runs += 1
    subprocess.run([abut, "run", "tests/verification/impact.yaml", "--quiet", "-j", "1", "-o", f"{scratch}/{runs}", "--set", f"contact[0].response={response}",
                    "--set", "contact[0].gap=none"], capture_output=True, check=True)
    with open(f"{scratch}/{runs}/summary.json") as stream:
        begins[response] = next(e["error"] for e in json.load(stream)["expects"] if e["name"].startswith("force begins"))
print(f"without gap contact begins {begins['frictionless']:.2f} cells too early, with distance-power {begins['distance-power']:.2f}")
wrong += not begins["distance-power"] < begins["frictionless"]
print(f"{runs} runs, {wrong} wrong")
sys.exit(wrong > 0)
PYTHON
