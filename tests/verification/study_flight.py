#!/usr/bin/python3
"""How a disturbance of a free block grows as it flies through the grid with flip: study_flight.py BUILD [--basis gimp] [--update musl,usf,usavg]. Prints, for each update, the growth
per cell flown, (ln v - ln v0)/cells by least squares, over speeds (in wave speeds, across) and cfl (down), and the largest. About two minutes."""
import argparse
import csv
import math
import os
import subprocess
import tempfile

SPEEDS, CFLS = (0.03, 0.05, 0.08, 0.12, 0.2, 0.3, 0.5, 0.8, 1.2, 2), (0.3, 0.5, 0.7, 0.9)
SCENE = """abut: 1
title: A free block flies, disturbed by 1e-12
constants: {speed: %g, cells: %d, h: 0.5}
time: {end: cells*h/speed, cfl: %g}
grid: {from: ["-2*h", "-2*h"], to: ["(cells + 8)*h", "6*h"], cell: h}
materials: {m: {model: linear-elastic, E: 1, nu: 0, density: 1}}
bodies:
  block: {method: material-points, material: m, shape: {box: [["0.3*h", "0.3*h"], ["2.3*h", "2.3*h"]]}, fill: {rule: regular, per_cell: 4}, basis: %s, update: %s,
          velocity: ["speed + 1e-12*cos(5*x + 11*y)", "1e-12*sin(7*x + 3*y*y)"]}
monitors: [{name: vx, body: block, value: velocity.x, minus: speed, over: rms}]
history: {every: 20}
watchdog: {stop: false}
"""


def growth(abut, folder, *values):
    with open(folder + "/flight.yaml", "w") as stream:
        stream.write(SCENE % values)
    subprocess.run([abut, "run", folder + "/flight.yaml", "--quiet", "-j", "1", "-o", folder + "/out"], capture_output=True, check=False)
    with open(folder + "/out/history.csv") as stream:
        rows = [(float(row["t"]) * values[0] / 0.5, math.log(float(row["vx"]))) for row in csv.DictReader(stream) if 1e-14 < float(row["vx"]) < 1e-3]
    n, mean = len(rows), [sum(column) / len(rows) for column in zip(*rows)]
    return sum((x - mean[0]) * (y - mean[1]) for x, y in rows) / sum((x - mean[0]) ** 2 for x, _ in rows) if n > 9 else math.nan


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("build")
parser.add_argument("--basis", default="gimp")
parser.add_argument("--update", default="musl,usf,usavg")
options = parser.parse_args()
with tempfile.TemporaryDirectory(prefix="abut-flight-") as scratch:
    for update in options.update.split(","):
        largest = -math.inf
        print(f"{options.basis}, {update}: growth per cell\ncfl    " + " ".join(f"{speed:7g}" for speed in SPEEDS))
        for cfl in CFLS:
            found = [growth(os.path.abspath(options.build) + "/abut", scratch, speed, 150 if speed < 0.04 else 300, cfl, options.basis, update) for speed in SPEEDS]
            largest = max([largest, *found])
            print(f"{cfl:5g}  " + " ".join(f"{g:7.4f}" for g in found), flush=True)
        print(f"largest {largest:.4f}\n")
