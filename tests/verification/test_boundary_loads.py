#!/usr/bin/env python3
"""The boundary plugins pressure and traction do what the same words under loads do, to rounding, while a soft block is pressed and bent by a fifth of its height: on
elements of two kinds, on rings and on points, at pieces of their outline and at its nodes. usage: test_boundary_loads.py BUILD"""
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

SCENE = """
abut: 1
title: Loads and boundaries
space: {space}
time: {{end: 0.4, cfl: 0.5}}
{grid}
materials:
  soft: {{model: neo-hookean, E: 1e5, nu: 0.3, density: 1000}}
bodies:
  one: {{{body}}}
  two: {{{body}}}
loads:
  - {{body: one, where: {{side: top}}, pressure: "2e4*min(1, t/0.2)"}}
  - {{body: one, where: {{side: right}}, traction: ["3e3*min(1, t/0.1)", "-2e3*min(1, t/0.1)"]}}
boundaries:
  - {{on: two, where: {{side: top}}, boundary: pressure, pressure: 2e4, history: [[0, 0], [0.2, 1]]{at}}}
  - {{on: two, where: {{side: right}}, boundary: traction, x: 3e3, y: -2e3, history: [[0, 0], [0.1, 1]], area: start}}
monitors:
  - {{name: x1, body: one, value: displacement.x, at: [1.5, 1]}}
  - {{name: x2, body: two, value: displacement.x, at: [1.5, 1]}}
  - {{name: y1, body: one, value: displacement.y, at: [0.5, 1]}}
  - {{name: y2, body: two, value: displacement.y, at: [0.5, 1]}}
"""
FE = "method: finite-elements, material: soft, mesh: {{box: [[0.5, 0], [1.5, 1]], elements: [4, 4], type: {0}}}, fix: [{{where: {{side: bottom}}, velocity: [0, 0]}}]"
POINTS = "method: material-points, material: soft, shape: {box: [[0.5, 0], [1.5, 1]]}, fill: {rule: regular, per_cell: 4}, basis: gimp"
GRID = "grid: {from: [0, 0], to: [3, 2], cell: 0.125, sides: {bottom: fixed}}"
CASES = {
    "q4": ("plane-strain", "", FE.format("q4"), 1e-12),
    "q8": ("plane-strain", "", FE.format("q8"), 1e-12),
    "rings": ("axisymmetric", "", FE.format("q4"), 1e-12),
    "points": ("plane-strain", GRID, POINTS, 2e-12),  # light nodes go by others, whose weights of 2 and -1 make rounding larger
    "points at nodes": ("plane-strain", GRID, POINTS, 2e-12),
    "points sheared": ("plane-strain", GRID, POINTS, 1e-3),
}


def main():
    build, missed = sys.argv[1], 0
    with tempfile.TemporaryDirectory() as folder:
        for name, (space, grid, body, hold) in CASES.items():
            scene = Path(folder) / f"{name}.yaml"
            text = SCENE.format(space=space, grid=grid, body=body, at=", at: nodes" if name.endswith("nodes") else "")
            if name in ("points", "points at nodes"):  # a traction of loads acts at the point under a piece of outline, that of a boundary at the piece
                text = "".join(line for line in text.splitlines(True) if "side: right" not in line)
            scene.write_text(text)
            subprocess.run([f"{build}/abut", "run", scene, "--quiet", "-j", "1", "-o", f"{folder}/{name}"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            with open(f"{folder}/{name}/history.csv", newline="") as stream:
                rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(stream)]
            apart = max(abs(row[c + "1"] - row[c + "2"]) for row in rows for c in "xy")
            work = max(abs(row["one.external"] + row["two.boundary"]) for row in rows) / rows[-1]["one.external"]
            moved = max(abs(row["y1"]) for row in rows)
            good = apart < hold and work < hold and moved > 0.1
            missed += not good
            print(f"{name:15s} moved by {moved:.3g} m, apart by {apart:.2g} m, work by {work:.2g} of it {'' if good else 'MISSED'}")
    sys.exit(1 if missed else 0)


main()
