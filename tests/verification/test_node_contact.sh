#!/bin/bash
# cost: 30
# Contact on shared nodes, basis by basis: when a force first acts, and how long the face is that acts. Two blocks that meet at a thousandth of the wave speed, along the grid and
# turned, on grids moved by irrational parts of a cell: the first force (more than 0.1 % of that of the impact) acts within 0.1 h of touch for every smooth basis. Blocks of one width and of different widths, of points and of elements, tied on
# two meshes: the monitor `length` is the true length within 2 %, on arcs too, and it takes adhesion times length to shear them. Then each normal
# carries the impact of two bars and a circle on a plane. test_node_contact.sh BUILD
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


def check(passed, text):
    global wrong
    wrong += not passed
    print(f"{'passed' if passed else 'WRONG '}  {text}", flush=True)


def run(text, *settings):
    """Columns of the history."""
    global runs
    runs += 1
    folder = f"{scratch}/{runs}"
    with open(f"{folder}.yaml", "w") as stream:
        stream.write(text)
    command = [abut, "run", f"{folder}.yaml", "--quiet", "-j", "1", "-o", folder]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        check(False, f"{folder}.yaml: {done.stderr}")
        return []
    with open(f"{folder}/history.csv") as stream:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(line for line in stream if not line.startswith("#"))]


def blocks(kinds, angle, h, widths, shift, gap, velocity, contact, end, tall=0.8, moduli=(1, 1)):
    """Block a below and b above a face turned by the angle; velocity: of b against a, along the face and across it."""
    c, s = math.cos(angle), math.sin(angle)

    def at(x, y):
        return [x * c - y * s, x * s + y * c]

    def body(k, x0, y0, x1, y1, part):
        corner = [at(x0, y0), at(x1, y0), at(x1, y1), at(x0, y1)]
        v = [part * x for x in at(*velocity)]
        common = f"material: {'ab'[k]}, velocity: {v}"
        if kinds[k][0] == "elements":
            edges = f"bottom: {corner[:2]}, right: {corner[1:3]}, top: {[corner[3], corner[2]]}, left: {[corner[0], corner[3]]}"
            number = [round((x1 - x0) / (kinds[k][1] * h)), round((y1 - y0) / (kinds[k][1] * h))]
            return f"{{method: finite-elements, {common}, mesh: {{patch: {{{edges}}}, elements: {number}, type: q4}}}}"
        if kinds[k][0] == "rigid":
            return f"{{method: rigid, {common}, shape: {{polygon: {corner}}}}}"
        return f"{{method: material-points, {common}, basis: {kinds[k][0]}, fill: {{per_cell: {kinds[k][1]}}}, shape: {{polygon: {corner}}}}}"

    return f"""abut: 1
space: plane-strain
time: {{end: {end}, cfl: 0.3}}
grid: {{from: [{-2 + 0.4142 * h}, {-2 + 0.23 * h}], to: [2.2, 2.2], cell: {h}}}
materials:
  a: {{model: linear-elastic, E: {moduli[0]}, nu: 0, density: 1}}
  b: {{model: linear-elastic, E: {moduli[1]}, nu: 0, density: 1}}
bodies:
  a: {body(0, -widths[0], -tall, widths[0], 0, -0.5)}
  b: {body(1, shift - widths[1], gap, shift + widths[1], tall + gap, 0.5)}
contact: [{{bodies: [a, b], algorithm: multi-velocity, {contact}}}]
monitors:
  - {{name: length, contact: 0, value: length}}
  - {{name: fx, contact: 0, value: force.x}}
  - {{name: fy, contact: 0, value: force.y}}
history: {{every: 1}}
"""


# ---- first contact
H, V = 0.1, 1e-3
LEAST = 0.001  # of the force of the impact, W v/2: at the ends of the face a node with next to no mass may be held early
for basis in ("gimp", "bspline2", "bspline3"):
    for angle in (0, math.pi / 6):
        for shift in (0, 0.0314):
            gap = 0.02 + shift
            rows = run(blocks(((basis, 4), (basis, 4)), angle, H, (0.4, 0.4), 0, gap, (0, -V), "response: frictionless", (gap + 0.1 * H) / V, 0.3))
            first = next((row for row in rows if math.hypot(row["fx"], row["fy"]) > LEAST * 0.4 * V), None)
            early = (gap - V * first["t"]) / H if first else math.nan
            check(abs(early) <= 0.1, f"first contact, {basis}, turned by {math.degrees(angle):.0f}: at a gap of {early:.4f} h")

# ---- length of the face
PRESSED = 0.02  # of the largest force: with less a face that rebounds is open but for a few nodes
def length(kinds, limit, angles=(0, 0.4, math.pi / 6, 1.1), contact="response: tied", end=0.1):
    worst, text = 0, []
    for h in (0.2, 0.1):
        for angle in angles:
            for widths, shift in (((1, 0.63), 0.1),):
                rows = run(blocks(kinds, angle, h, widths, shift, 0, (0, -V), contact, end))
                most = max(math.hypot(row["fx"], row["fy"]) for row in rows)
                seen = [row["length"] for row in rows if math.hypot(row["fx"], row["fy"]) > PRESSED * most]
                part = seen[len(seen) // 2] / (2 * min(widths)) if seen else 0
                text.append(f"{part:.3f}")
                worst = max(worst, abs(part - 1))
    check(worst <= limit, f"length of the face, {contact}, {' and '.join(' '.join(map(str, kind)) for kind in kinds)}: {' '.join(text)} of the true one")


length((("gimp", 4), ("gimp", 4)), 0.02)
length((("gimp", 4), ("gimp", 9)), 0.02)
length((("bspline2", 4), ("bspline2", 4)), 0.02)
length((("bspline3", 4), ("bspline3", 4)), 0.02)
length((("gimp", 4), ("elements", 1.1)), 0.02)
length((("gimp", 4), ("rigid",)), 0.02)
length((("rigid",), ("gimp", 4)), 0.02)
length((("linear", 4), ("linear", 4)), 0.02, (0.2, 0.7))
length((("linear", 4), ("linear", 9)), 0.02)
length((("elements", 1), ("elements", 1.3)), 0.02, (0, 0.2, 0.7))
length((("linear", 4), ("elements", 1.1)), 0.02, (0.2, 0.7))
length((("bspline2", 4), ("bspline2", 9)), 0.02, (0, math.pi / 6, 0.7))
length((("bspline2", 4), ("elements", 1.1)), 0.02, (0, 0.4))
# pressed without friction: some nodes carry for those around them
for one, other in ((("bspline2", 4), ("elements", 1.1)), (("elements", 1), ("elements", 1.3)), (("bspline2", 4), ("rigid",))):
    length((one, other), 0.02, (0, math.pi / 4), "response: frictionless", 0.6)


# ---- length of an arc: a segment of a disc in a groove of its radius, 5 and 10 cells, 1.8 radii long, turned. What stands a few hundredths of a cell open, as outlines are round and points are
# not, is tied too.
def arc(kinds, limit, radius=1, half=0.9):
    def bow(r, first, last, pieces):
        return [[r * f(first + (last - first) * k / pieces) for f in (math.cos, math.sin)] for k in range(pieces + 1)]

    worst, text = 0, []
    for h in (0.2, 0.1):
        for turn in (0, 0.3):
            down = turn - math.pi / 2
            way = [math.cos(down), math.sin(down)]
            outlines = (bow(radius, down - half - 0.25, down + half + 0.25, 96) + bow(radius + 0.6, down + half + 0.25, down - half - 0.25, 32),
                        bow(radius, down - half, down + half, 64) + [[-0.1 * radius * x for x in way]])
            text_of = []
            for k in range(2):
                method = "method: rigid" if kinds[k][0] == "rigid" else f"method: material-points, basis: {kinds[k][0]}, fill: {{per_cell: {kinds[k][1]}}}"
                text_of.append(f"{{{method}, material: soil, velocity: {[(k - 0.5) * V * x for x in way]}, shape: {{polygon: {outlines[k]}}}}}")
            rows = run(f"""abut: 1
space: plane-strain
time: {{end: 0.1, cfl: 0.3}}
grid: {{from: [{-2.6 + 0.4142 * h}, {-2.6 + 0.23 * h}], to: [2.6, 2.6], cell: {h}}}
materials:
  soil: {{model: linear-elastic, E: 1, nu: 0, density: 1}}
bodies:
  groove: {text_of[0]}
  disc: {text_of[1]}
contact: [{{bodies: [groove, disc], algorithm: multi-velocity, response: tied, tolerance: 0.05}}]
monitors:
  - {{name: length, contact: 0, value: length}}
history: {{every: 1}}
""")
            seen = [row["length"] for row in rows if row["length"] > 0]
            part = seen[len(seen) // 2] / (2 * half * radius) if seen else 0
            text.append(f"{part:.3f}")
            worst = max(worst, abs(part - 1))
    check(worst <= limit, f"length of an arc, {' and '.join(' '.join(map(str, kind)) for kind in kinds)}: {' '.join(text)} of the true one")


for one, other in ((("gimp", 4), ("gimp", 4)), (("linear", 4), ("linear", 4)), (("bspline2", 4), ("bspline3", 4)), (("gimp", 4), ("rigid",)), (("rigid",), ("gimp", 4))):
    arc((one, other), 0.02)

# ---- what is carried without pressure: adhesion x length along the face, strength x length across it, while every point slips or parts
C = 1e-4
for kinds, limit in (((("gimp", 4), ("gimp", 9)), 0.02), ((("bspline2", 4), ("bspline2", 4)), 0.02), ((("gimp", 4), ("elements", 1.1)), 0.02), ((("rigid",), ("gimp", 4)), 0.02)):
    for h in (0.2, 0.1):
        angle, widths = 0.4, (1, 0.63)
        for velocity, what in (((V, 0), "sheared"), ((0, V), "pulled off")):
            rows = run(blocks(kinds, angle, h, widths, 0.1, 0, velocity, f"response: coulomb, adhesion: {C}, tensile_strength: {C}", 0.05))
            force = max([math.hypot(row["fx"], row["fy"]) for row in rows[:3]], default=0) / (C * 2 * min(widths))
            check(abs(force - 1) <= limit, f"{what}, {' and '.join(' '.join(map(str, kind)) for kind in kinds)}, h = {h}: force {force:.4f} of strength x length")


# ---- each normal: two bars turned by 30 degrees meet (impact_turned.yaml), and bars of elements and points (impact_fe_mpm.yaml) for faces
def impact(scene, limits, *settings):
    global runs
    runs += 1
    command = [abut, "run", f"tests/verification/{scene}.yaml", "--quiet", "-j", "1", "-o", f"{scratch}/{runs}"]
    for setting in settings:
        command += ["--set", f"contact[0].{setting}"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        return check(False, f"{scene}, {', '.join(settings)}: {done.stderr}")
    with open(f"{scratch}/{runs}/summary.json") as stream:
        expects = json.load(stream)["expects"]
    errors = {e["name"]: e["error"] for e in expects}
    bad = [name for name, limit in limits.items() if not errors[name] <= limit] if limits else [e["name"] for e in expects if not e["pass"]]
    shown = ", ".join(f"{name} {errors[name]:.2g}" for name in limits or errors)
    check(not bad, f"{scene}, {', '.join(settings)}: {shown}{': ' + ', '.join(bad) if bad else ''}")


GOOD, FAIR = 0.002, 0.04  # of the force: a normal that leans at the ends of the face loses some of it
for normal, force in (("average", GOOD), ("convex", GOOD), ("regression", GOOD), ("density-gradient", FAIR), ("geometric", FAIR), ("mass-gradient", FAIR),
                      ("volume-gradient", FAIR), ("stiffer", FAIR)):
    impact("impact_turned", {"force": force, "first touch": 0.01, "duration": 0.02, "momentum along x": 1e-12, "no penetration": 0.005}, f"normal={normal}")
impact("impact_turned", {"first touch": 0.4, "momentum along x": 1e-12}, "gap=regression")  # early: see docs/accuracy.md
impact("impact_fe_mpm", {}, "normal=faces")

# Nobody has faces: said where it stands.
done = subprocess.run([abut, "run", "tests/verification/impact_turned.yaml", "--quiet", "-o", f"{scratch}/none", "--set", "contact[0].normal=faces"], capture_output=True, text=True)
check(done.returncode == 2 and "takes the normal of a body's faces" in done.stderr and "impact_turned.yaml:" in done.stderr, f"faces without a mesh: {done.stderr.strip()}")

sys.exit(1 if wrong else 0)
PYTHON
