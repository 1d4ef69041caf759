#!/usr/bin/env python3
# cost: 12
"""A disc lands aslant, with friction, on a plane that no line of the grid fits; drawn turned, mirrored and with its axes swapped it must do the same, turned, mirrored and
swapped: no order of nodes, points or elements may show. Every basis, by shared nodes and by surfaces, on points and on elements larger than cells. (What several nodes bear of a load
between two faces in one column of nodes is undetermined, and each slips at a limit of its own: contact/rounds.c.) usage: test_turned_friction.py BUILD"""
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

FRAMES = {  # x and y of the drawing from those of the scene
    "plain": lambda x, y: (x, y),
    "mirrored": lambda x, y: (-x, y),
    "upside down": lambda x, y: (x, -y),
    "a quarter": lambda x, y: (-y, x),
    "half a turn": lambda x, y: (-x, -y),
    "swapped": lambda x, y: (y, x),
}
METHODS = [
    ("linear", "{flip: 0.99}", "musl"),
    ("gimp", "flip", "musl"),
    ("cpdi", "flip", "usavg"),
    ("bspline2", "flip", "musl"),
    ("bspline2", "apic", "musl"),
    ("bspline3", "apic", "musl"),
]
SAME = 1e-8  # of the largest momentum, force or energy: rounding, as it grows over the impact
END, DT, CELL, LANDED = 0.3, 1.5e-3, 0.25, 5e3  # LANDED, N: less than what the plane bears at most


def scene(frame, finder, method, elements):
    turn = FRAMES[frame]
    basis, transfer, update = method

    def pair(x, y):
        return "[%r, %r]" % turn(x, y)

    def box(x0, y0, x1, y1):
        (ax, ay), (bx, by) = turn(x0, y0), turn(x1, y1)
        return f"[[{min(ax, bx)!r}, {min(ay, by)!r}], [{max(ax, bx)!r}, {max(ay, by)!r}]]"

    across = turn(1, 0)[0] != 0
    bottom = {(0, 1): "bottom", (0, -1): "top", (1, 0): "left", (-1, 0): "right"}[turn(0, 1)]
    points = f"method: material-points, basis: {basis}, transfer: {transfer}, update: {update}"
    plane = f"{points}, shape: {{box: {box(-1, -1, 4, 0.1)}}}"
    if elements:
        plane = f"method: finite-elements, mesh: {{box: {box(-1, -1, 4, 0.1)}, elements: {[7, 3] if across else [3, 7]}, type: q4}}, fix: [{{where: {{side: {bottom}}}, velocity: [0, 0]}}]"
    from_to = box(-1, -1, 4, 3)
    return f"""abut: 1
time: {{end: {END}, dt: {DT}}}
gravity: {pair(0, -9.81)}
grid: {{from: {from_to[1:from_to.index("]") + 1]}, to: {from_to[from_to.index("]") + 3:-1]}, cell: {CELL}, sides: {{{bottom}: fixed}}}}
materials: {{m: {{model: linear-elastic, E: 1e6, nu: 0.3, density: 1000}}}}
bodies:
  disc: {{{points}, material: m, shape: {{disc: {{center: {pair(1.07, 0.72)}, radius: 0.53}}}}, velocity: {pair(2.0, -3.0)}}}
  plane: {{{plane}, material: m}}
contact: [{{bodies: [disc, plane], algorithm: {finder}, response: coulomb, friction: 0.3}}]
monitors:
  - {{name: x, body: disc, value: momentum.x}}
  - {{name: y, body: disc, value: momentum.y}}
  - {{name: push, contact: 0, value: normal-force}}
history: {{every: 1}}
"""


def history(build, folder, frame, *rest):
    """Rows of (momentum x, y in the plain frame, energies, force), each as a part of its largest; the largest force."""
    path = Path(folder) / "scene.yaml"
    path.write_text(scene(frame, *rest))
    done = subprocess.run([f"{build}/abut", "run", path, "--quiet", "-j", "1", "-o", f"{folder}/out"], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{frame} {rest}: {done.stderr}")
    with open(f"{folder}/out/history.csv", newline="") as stream:
        rows = [[float(row[k]) for k in ("x", "y", "kinetic", "strain", "friction", "push")] for row in csv.DictReader(stream)]
    ex, ey = FRAMES[frame](1, 0), FRAMES[frame](0, 1)
    rows = [[ex[0] * r[0] + ex[1] * r[1], ey[0] * r[0] + ey[1] * r[1], *r[2:]] for r in rows]
    push = max(r[5] for r in rows)
    most = [max(max(abs(r[0]), abs(r[1])) for r in rows)] * 2 + [max(abs(r[k]) for r in rows) for k in range(2, 6)]
    return [[v / m for v, m in zip(r, most)] for r in rows], push


def main():
    build, missed = sys.argv[1], 0
    with tempfile.TemporaryDirectory() as folder:
        for finder in ("multi-velocity", "point-to-segment"):
            for elements in (False, True):
                for method in METHODS:
                    case = (finder, method, elements)
                    plain, push = history(build, folder, "plain", *case)
                    worst, seen = 0.0, "plain"
                    for frame in list(FRAMES)[1:]:
                        other = history(build, folder, frame, *case)[0]
                        apart = max(abs(a - b) for p, q in zip(plain, other) for a, b in zip(p, q)) if len(plain) == len(other) else 1.0
                        worst, seen = max((worst, seen), (apart, frame))
                    good = worst < SAME and push > LANDED
                    missed += not good
                    print(f"{finder:16s} on {'elements' if elements else 'points':8s} {' '.join(method):22s} push {push:.4g} N, apart by {worst:.1e} ({seen}) {'' if good else 'MISSED'}", flush=True)
    sys.exit(1 if missed else 0)


main()
