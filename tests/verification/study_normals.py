#!/usr/bin/python3
# cost: 200
"""The tables of docs/accuracy.md about normals and gaps on shared nodes: study_normals.py BUILD [--write] prints them; --write puts them into docs/accuracy.md.
--surface=points: of bodies that touch by points on their outline; --draws=N and --only=WORD for less.

Two bodies a small gap apart, drawn at random angles on a grid moved by random parts of a cell; build/tests/node_normals says what the finder makes of each node they share, with every word of `normal`.
The angle to the exact normal and the error of the gap are those at nodes beside the place of contact (within half a cell of it along the face; on conforming faces at all nodes). A mean is
weighted with the share of the face that a node has under the default; nodes with less than a hundredth of a cell are left out. The study
fails where a normal is no unit vector, or where the normal that is the default is off by more than a degree on a flat, or its gap by more than 0.01 of a cell."""
import math
import os
import subprocess
import sys
import tempfile
from collections import defaultdict

import numpy as np

from pages import finish, table

BUILD = sys.argv[1]
WRITE = "--write" in sys.argv
DRAWS = int(next((word[8:] for word in sys.argv if word.startswith("--draws=")), 12))
SCRATCH = os.environ.get("ABUT_SCRATCH") or tempfile.mkdtemp()
PAGE = "docs/accuracy.md"
BEGIN, END = "<!-- made by study_normals.py: begin -->", "<!-- made by study_normals.py: end -->"
METHODS = ["average", "mass-gradient", "volume-gradient", "density-gradient", "geometric", "regression", "convex", "stiffer", "faces"]
ONLY = next((word[7:] for word in sys.argv if word.startswith("--only=")), "")
SURFACE = next((word[10:] for word in sys.argv if word.startswith("--surface=")), "domains")
failures = []
random = np.random.default_rng(20)


class Draw:
    """A place and an angle: local coordinates s along the face of the first body, n out of it."""

    def __init__(self, angle):
        self.t = np.array([math.cos(angle), math.sin(angle)])
        self.n = np.array([-math.sin(angle), math.cos(angle)])

    def at(self, s, n):
        return [float(x) for x in s * self.t + n * self.n]

    def polygon(self, *places):
        return f"shape: {{polygon: {[self.at(*place) for place in places]}}}"

    def box(self, s0, n0, s1, n1):
        return self.polygon((s0, n0), (s1, n0), (s1, n1), (s0, n1))

    def disc(self, n, radius):
        return f"shape: {{disc: {{center: {self.at(0, n)}, radius: {radius}}}}}"

    def mesh(self, s0, n0, s1, n1):
        """Elements somewhat larger than cells."""
        corner = [self.at(*place) for place in ((s0, n0), (s1, n0), (s1, n1), (s0, n1))]
        edges = dict(bottom=[corner[0], corner[1]], right=[corner[1], corner[2]], top=[corner[3], corner[2]], left=[corner[0], corner[3]])
        patch = ", ".join(f"{name}: {edge}" for name, edge in edges.items())
        return f"mesh: {{patch: {{{patch}}}, elements: [{round((s1 - s0) / 1.1)}, {round((n1 - n0) / 1.1)}], type: q4}}"


def points(shape, basis, per_cell):
    return f"{{method: material-points, material: soft, basis: {basis}, fill: {{per_cell: {per_cell}}}, surface: {SURFACE}, {shape}}}"


def beside(s, n, g):
    return abs(s) <= 0.5, (0, 1), g


def flat(draw, g, make, width=6):
    return make(draw.box(-6, -4, 6, 0)), make(draw.box(-width, g, width, 4 + g)), lambda s, n: (abs(s) <= width - 2, (0, 1), g)


def edge(draw, g, make):
    return make(draw.box(-6, -4, 6, 0)), make(draw.box(-3, g, 3, 4 + g)), lambda s, n: (2 < abs(s) <= 3, (0, 1), g)


def disc_on_flat(radius):
    return lambda draw, g, make: (make(draw.box(-5, -4, 5, 0)), make(draw.disc(radius + g, radius)), lambda s, n: beside(s, n, g))


def disc_on_disc(radius):
    return lambda draw, g, make: (make(draw.disc(-radius, radius)), make(draw.disc(radius + g, radius)), lambda s, n: beside(s, n, g))


def disc_in_ring(radius):
    def scene(draw, g, make):
        ring = f"shape: {{ring: {{center: {draw.at(0, 0)}, radius: {radius + 3}, inner: {radius + g}}}}}"
        return make(ring), make(draw.disc(0, radius)), lambda s, n: (True, (-s / math.hypot(s, n), -n / math.hypot(s, n)) if s or n else (0, 1), g)

    return scene


def corner_on_flat(draw, g, make):
    return make(draw.box(-5, -4, 5, 0)), make(draw.polygon((0, g), (4, 4 + g), (0, 8 + g), (-4, 4 + g))), lambda s, n: beside(s, n, g)


def corner_in_corner(draw, g, make):
    """Along the walls theirs; in the corner anything between them."""
    notch = draw.polygon((-4, -4), (5, -4), (5, 0), (0, 0), (0, 5), (-4, 5))

    def exact(s, n):
        if max(s, n) < 1.0:
            return True, "between", g
        return max(s, n) < 4, ((0, 1) if s > n else (1, 0)), g

    return make(notch), make(draw.box(g, g, 5 + g, 5 + g)), exact


def mesh_on_points(draw, g, make):
    return make(draw.box(-6, -4, 6, 0)), f"{{method: finite-elements, material: stiff, {draw.mesh(-5, g, 5, 4 + g)}}}", lambda s, n: (abs(s) <= 4, (0, 1), g)


def mesh_corner_on_points(draw, g, make):
    turned = Draw(math.atan2(draw.t[1], draw.t[0]) + math.pi / 4)
    origin = np.array(draw.at(0, g))
    turned.at = lambda s, n: [float(x) for x in origin + s * turned.t + n * turned.n]
    return make(draw.box(-5, -4, 5, 0)), f"{{method: finite-elements, material: stiff, {turned.mesh(0, 0, 5, 5)}}}", lambda s, n: beside(s, n, g)


def mesh_on_mesh(draw, g, make):
    return (f"{{method: finite-elements, material: soft, {draw.mesh(-6, -4, 6, 0)}}}", f"{{method: finite-elements, material: stiff, {draw.mesh(-5, g, 5, 4 + g)}}}",
            lambda s, n: (abs(s) <= 4, (0, 1), g))


def rigid_disc_on_points(draw, g, make):
    return make(draw.box(-5, -4, 5, 0)), f"{{method: rigid, material: stiff, {draw.disc(8 + g, 8)}}}", lambda s, n: beside(s, n, g)


SHAPES = {
    "flat on flat, along the grid": (flat, False),
    "flat on flat": (flat, True),
    "edge of a block on flat": (edge, True),
    **{f"circle of {r} h on flat": (disc_on_flat(r), True) for r in (2, 4, 8, 16)},
    **{f"circle on circle, {r} h": (disc_on_disc(r), True) for r in (2, 4, 8, 16)},
    **{f"circle of {r} h in a ring": (disc_in_ring(r), True) for r in (2, 4, 8)},
    "corner of 90 degrees on flat": (corner_on_flat, True),
    "corner in a corner": (corner_in_corner, True),
    "elements on points, flat": (mesh_on_points, True),
    "elements on elements, flat": (mesh_on_mesh, True),
    "corner of elements on points": (mesh_corner_on_points, True),
    "rigid circle of 8 h on points": (rigid_disc_on_points, True),
}


def draw_scenes(shape, basis, per_cell, draws):
    """Scene files and what is exact in each."""
    make_scene, turned = SHAPES[shape]
    scenes = []
    for k in range(draws):
        angle = float(random.uniform(0, 2 * math.pi)) if turned else 0.0
        draw, g, offset = Draw(angle), float(random.uniform(0, 0.1)), [float(x) for x in random.uniform(0, 1, 2)]
        a, b, exact = make_scene(draw, g, lambda text: points(text, basis, per_cell))
        path = f"{SCRATCH}/{len(os.listdir(SCRATCH))}.yaml"
        with open(path, "w") as stream:
            stream.write(f"""abut: 1
space: plane-strain
time: {{end: 1, dt: 1}}
grid: {{from: [{-40 + offset[0]}, {-40 + offset[1]}], to: [{40 + offset[0]}, {40 + offset[1]}], cell: 1}}
materials:
  soft: {{model: linear-elastic, E: 1, nu: 0, density: 1}}
  stiff: {{model: linear-elastic, E: 10, nu: 0, density: 2}}
bodies:
  a: {a}
  b: {b}
contact: [{{bodies: [a, b], algorithm: multi-velocity, response: frictionless}}]
""")
        scenes.append((path, draw, exact))
    return scenes


def measure(scenes):
    """By method: angles (degrees) and errors of the gap (cells) at the nodes that count, nodes whose normal is the average's, microseconds a shared node."""
    done = subprocess.run([f"{BUILD}/tests/node_normals", BUILD] + [path for path, _, _ in scenes], capture_output=True, text=True)
    if done.returncode:
        failures.append(f"node_normals {scenes[0][0]} ...: {done.stderr.strip()}")
        return {}
    by_path = {path: (draw, exact) for path, draw, exact in scenes}
    found = defaultdict(lambda: dict(angle=[], gap=[], same=[], weight=[], cost=[]))
    average = {}
    for line in done.stdout.splitlines():
        word = line.split()
        if word[0] == "normal":
            draw, exact = by_path[word[1]]
            into = found[word[2]]
            if int(word[3]):
                into["cost"].append(1e6 * float(word[4]) / int(word[3]))
            path, method = word[1], word[2]
            continue
        x, y, nx, ny, gap, area = map(float, word[1:])
        if abs(math.hypot(nx, ny) - 1) > 1e-14:
            failures.append(f"{path}, {method}: a normal of length {math.hypot(nx, ny)!r}")
        if method == "average":
            average[path, x, y] = nx, ny, area
        s, n = x * draw.t[0] + y * draw.t[1], x * draw.n[0] + y * draw.n[1]
        counts, normal, g = exact(s, n)
        *usual, weight = average.get((path, x, y), (0, 0, 0))
        if not counts or weight < 0.01:
            continue
        local = nx * draw.t[0] + ny * draw.t[1], nx * draw.n[0] + ny * draw.n[1]
        angle = math.degrees(math.atan2(local[1], local[0]))
        if normal == "between":
            off = max(0.0, -angle, angle - 90)
        else:
            off = abs((angle - math.degrees(math.atan2(normal[1], normal[0])) + 180) % 360 - 180)
        into["angle"].append(off)
        into["gap"].append(abs(gap - g))
        into["same"].append([nx, ny] == usual)
        into["weight"].append(weight)
    return found


def number(value):
    return "0" if value < 5e-4 else f"{value:.0f}" if value >= 9.95 else f"{value:.2g}"


def pair(values, weights):
    return f"{number(np.average(values, weights=weights))} ({number(np.max(values))})" if values else "-"


def main():
    angles, gaps, costs, same = [], [], defaultdict(list), defaultdict(list)
    for shape in [name for name in SHAPES if ONLY in name]:
        found = measure(draw_scenes(shape, "gimp", 4, DRAWS))
        if not found:
            continue
        angles.append([shape] + [pair(found[method]["angle"], found[method]["weight"]) if method in found else "-" for method in METHODS])
        gaps.append([shape] + [pair(found[method]["gap"], found[method]["weight"]) for method in ("average", "mass-gradient", "average+gap", "regression+gap")])
        for method in found:
            costs[method] += found[method]["cost"]
            same[method] += found[method]["same"] if shape != "flat on flat, along the grid" else []
        if shape.startswith("flat on flat") and not (max(found["average"]["angle"]) < 1 and max(found["average"]["gap"]) < 0.01):
            failures.append(f"{shape}: the default is off by {max(found['average']['angle']):.2g} degrees and {max(found['average']['gap']):.2g} of a cell")
    text = table("Angle between normal and exact normal in degrees, mean (largest), at nodes beside the place of contact; GIMP, 4 points a cell, gaps up to 0.1 h.", ["shape"] + METHODS, angles)
    text += "\n" + table("Error of the gap in h, mean (largest): `gap: distance` with `normal: average`, and with any other word (it is then measured along the average's direction all the same); `gap: regression` with "
                         "`average` and with `regression`.", ["shape", "distance, average", "distance, others", "regression, average", "regression, regression"], gaps)
    text += "\n" + table("Microseconds a shared node, everything a find does included, and per cent of nodes (flats along the grid left out) where the normal is that of `average`, because the word has no answer of its own there (at a corner of `faces`, with no concave body for `convex`).",
                         ["normal"] + METHODS, [["cost"] + [number(np.mean(costs[m])) for m in METHODS],
                                                ["no answer"] + [number(100 * np.mean(same[m])) if m in ("geometric", "regression", "convex", "faces", "density-gradient") else "-" for m in METHODS]])
    rows = []
    chosen = [s for s in SHAPES if s.startswith(("flat on flat", "circle of 4 h on", "circle on circle, 8", "circle of 4 h in", "corner"))and "elements" not in s]
    for basis in () if ONLY else ("linear", "gimp", "bspline2", "bspline3"):
        for per_cell in (4, 9, 16):
            whole = defaultdict(list)
            for shape in chosen:
                found = measure(draw_scenes(shape, basis, per_cell, max(DRAWS // 3, 2)))
                for method in found:
                    whole[method] += found[method]["angle"]
                    whole[method, "weight"] += found[method]["weight"]
                whole["gap"] += found["average"]["gap"] if found else []
            rows.append([basis, str(per_cell)] + [pair(whole[m], whole[m, "weight"]) for m in METHODS[:-1]] + [pair(whole["gap"], whole["average", "weight"])])
    text += "\n" + table(f"The same angles by basis and points a cell, over: {'; '.join(chosen)}. Last: error of the gap by `distance` and `average`, in h.", ["basis", "per_cell"] + METHODS[:-1] + ["gap"], rows)
    finish(text, failures, PAGE, BEGIN, END, WRITE)


main()
