#!/usr/bin/python3
# cost: 40
"""The table of docs/accuracy.md about fills: study_density.py BUILD [--write] prints it; --write puts it into docs/accuracy.md.

How evenly the mass of a uniform square comes to the nodes of the grid, and to Halton's points (places that nodes may have for points that have moved), for each rule of filling
and each basis. The first table is that of the study this repeats, with its figures. It fails where the weights here are not those of the program (a step of PIC tells), where a
fill on its own grid is not even to rounding, or where cvt is not better than points at random."""
import math
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

from pages import finish, table

BUILD = sys.argv[1]
WRITE = "--write" in sys.argv
SCRATCH = os.environ.get("ABUT_SCRATCH") or tempfile.mkdtemp()
PAGE = "docs/accuracy.md"
BEGIN, END = "<!-- made by study_density.py: begin -->", "<!-- made by study_density.py: end -->"
CELLS, H = 10, 0.1  # of the unit square
SEEDS = range(1, 11)  # of the first table; the others take four
failures = []


def fill(rule, per_cell, seed=1):
    """Rows x, y, volume, xx, yy, xy of the points in the unit square."""
    if rule == "random":
        rng, n = np.random.default_rng(seed), per_cell * CELLS**2
        area = np.full(n, 1 / n)
        return np.column_stack([rng.random(n), rng.random(n), area, area / 4, area / 4, 0 * area])
    command = [f"{BUILD}/tests/fill_points", "1", str(H), rule, str(per_cell)] + ([str(per_cell * CELLS**2), str(seed)] if rule == "cvt" else [])
    return np.array([[float(v) for v in line.split()] for line in subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()])


def weight(basis, d, half):
    """Of a node for points d cells away along one direction; half: size of their domains, cells."""
    a = np.abs(d)
    if basis == "linear":
        return np.maximum(1 - a, 0)
    if basis == "bspline2":
        return np.where(a < 0.5, 0.75 - a * a, np.where(a < 1.5, 0.5 * (1.5 - a) ** 2, 0))
    if basis == "bspline3":
        return np.where(a < 1, 2 / 3 - a * a + a**3 / 2, np.where(a < 2, (2 - a) ** 3 / 6, 0))
    low, high = np.maximum(d - half, -1), np.minimum(d + half, 1)  # gimp: the hat averaged over the domain
    return np.where(high > low, (high - low - 0.5 * (high * np.abs(high) - low * np.abs(low))) / (2 * half), 0)


def halves(points):
    return np.minimum(np.sqrt(points[:, 3:5]), 0.5 * H) / H


def density(points, places, basis):
    """At places, relative to the density of the body."""
    l = halves(points)
    w = [weight(basis, (points[None, :, c] - places[:, None, c]) / H, l[None, :, c]) for c in range(2)]
    return (w[0] * w[1]) @ points[:, 2] / H**2


def continuum(places, basis):
    """The same of a body without points: the part of each weight that lies over the square."""
    fine = np.linspace(-2.5, 2.5, 50001)
    sums = np.concatenate([[0], np.cumsum(0.5 * (lambda w: w[1:] + w[:-1])(weight("linear" if basis == "gimp" else basis, fine, None))) * (fine[1] - fine[0])])
    part = [np.interp((1 - places[:, c]) / H, fine, sums) - np.interp(-places[:, c] / H, fine, sums) for c in range(2)]
    return part[0] * part[1]


def halton(count):
    def inverse(k, base):
        value, part = 0, 1
        while k:
            part /= base
            value, k = value + part * (k % base), k // base
        return value

    return np.array([[inverse(k, 2), inverse(k, 3)] for k in range(1, count + 1)])


def nodes(offset=(0, 0)):
    at = [np.arange(CELLS + 1) * H + o * H for o in offset]
    x, y = np.meshgrid(at[0][at[0] <= 1 + 1e-9], at[1][at[1] <= 1 + 1e-9])
    return np.column_stack([x.ravel(), y.ravel()])


def check_weights():
    """A step of PIC gives every point sum N_i (sum N_i m v) / m_i: by the weights here and by the program."""
    for basis in ("linear", "gimp", "bspline2", "bspline3"):
        for rule in ("{rule: cvt, points: 400, seed: 1}", "{rule: gauss, per_cell: 4}"):
            scene = f"""abut: 1
time: {{end: 1e-9, dt: 1e-9}}
grid: {{from: [-0.5, -0.5], to: [1.5, 1.5], cell: {H}}}
materials: {{soft: {{model: linear-elastic, E: 1, nu: 0, density: 1}}}}
bodies:
  square:
    {{method: material-points, material: soft, shape: {{box: [[0, 0], [1, 1]]}}, fill: {rule}, basis: {basis}, transfer: pic, update: usl, velocity: ["sin(37*x+11*y)", "cos(5*x-41*y)"]}}
output: {{fields: [velocity, mass]}}
"""
            path = f"{SCRATCH}/pic.yaml"
            with open(path, "w") as stream:
                stream.write(scene)
            done = subprocess.run([f"{BUILD}/abut", "run", path, "--quiet", "-j", "1", "-o", f"{SCRATCH}/pic"], capture_output=True, text=True)
            if done.returncode:
                failures.append(f"{basis}, {rule}: {done.stderr}")
                continue
            with h5py.File(f"{SCRATCH}/pic/results.h5") as file:
                frames = sorted(name for name in file if name.startswith("frame_"))
                first, last = ({name: file[f][f"square/{name}"][:] for name in ("position", "velocity", "mass", "id")} for f in (frames[0], frames[-1]))
            points = fill("cvt" if "cvt" in rule else "gauss", 4)[first["id"].astype(int)]
            if np.abs(points[:, :2] - first["position"][:, :2]).max() > 1e-12:
                failures.append(f"{basis}, {rule}: not the points of the program")
            at = np.arange(-5, 16) * H
            w = [weight(basis, (points[None, :, c] - at[:, None]) / H, halves(points)[None, :, c]) for c in range(2)]
            w = np.einsum("ip,jp->ijp", *w).reshape(-1, len(points))
            mass = w @ points[:, 2]
            v = w @ (points[:, 2:3] * first["velocity"][:, :2])
            v = w.T @ np.where(mass[:, None] > 0, v / np.maximum(mass, 1e-300)[:, None], 0)
            where = [np.argsort(a["id"]) for a in (first, last)]
            # at the edge nodes with little mass go by others (mpm/light_nodes.c), which the weights do not know
            inside = (np.abs(points[where[0]][:, :2] - 0.5) < 0.5 - 3 * H).all(axis=1)
            off = np.abs(v[where[0]] - last["velocity"][where[1]][:, :2])[inside].max()
            if off > 1e-8:
                failures.append(f"{basis}, {rule}: the weights here are not the program's (a step of PIC differs by {off:.2g})")


def fills(rule, per_cell, seeds=SEEDS):
    return [fill(rule, per_cell, seed) for seed in (seeds if rule in ("cvt", "random") else [1])]


def source_table():
    at_nodes, at_halton = nodes(), halton(400)
    known = {"gauss": ("330.6 / 100.7", "374 / 51.1"), "cvt": ("330.6 / 110.9", "377.1 / 59.6")}
    rows = []
    for rule in ("none", "gauss", "regular", "cvt", "random"):
        row = [{"none": "a body without points", "gauss": "`gauss` (subdivision)", "random": "at random"}.get(rule, f"`{rule}`")]
        for k, places in enumerate((at_nodes, at_halton)):
            values = [400 * continuum(places, "linear")] if rule == "none" else [400 * density(p, places, "linear") for p in fills(rule, 4)]
            row += [f"{np.mean([v.mean() for v in values]):.1f} / {np.mean([v.std(ddof=1) for v in values]):.1f}", known.get(rule, ("", ""))[k]]
        rows.append(row)
    return table("400 points of mass 1 on the unit square, bilinear weights of 10 x 10 cells, at the 121 nodes and at 400 Halton points: mean / standard deviation of the "
                 "density (`cvt` and random: mean over ten seeds), beside the figures of the study that this repeats.",
                 ["points", "nodes", "study", "Halton points", "study"], rows)


def basis_table(per_cell):
    rng = np.random.default_rng(7)
    moved = np.concatenate([nodes(o) for o in rng.random((8, 2))])
    places = {"nodes of its own grid": nodes(), "nodes of a grid that is moved": moved, "Halton points": halton(500)}
    rows, rough = [], {}
    for rule in ("regular", "gauss", "cvt", "random"):
        sets = fills(rule, per_cell, SEEDS[:4])
        for basis in ("linear", "gimp", "bspline2", "bspline3"):
            row = [f"`{rule}`" if rule != "random" else "at random", basis]
            for name, at in places.items():
                exact = continuum(at, basis)
                inner = exact > 0.2  # a corner of a cell says little
                off = np.array([(density(p, at, basis) / exact - 1)[inner] for p in sets]) * 100
                rough[rule, basis, name] = math.sqrt((off**2).mean())
                row.append(f"{rough[rule, basis, name]:.2g} ({off.min():+.2g} to {off.max():+.2g})" if np.abs(off).max() > 1e-5 else "0")
            rows.append(row)
    for basis in ("linear", "gimp", "bspline2", "bspline3"):
        for name in places:
            if rough["cvt", basis, name] > 0.5 * rough["random", basis, name]:
                failures.append(f"{per_cell} a cell, {basis}, {name}: cvt is off by {rough['cvt', basis, name]:.2g} %, random points by {rough['random', basis, name]:.2g} %")
    if per_cell == 4 and rough["regular", "linear", "nodes of its own grid"] > 1e-5:
        failures.append("a lattice on its own grid is not even")
    return table(f"{per_cell} points a cell: density over that of a body without points, less 1, in per cent: root mean square (least to largest).", ["points", "basis"] + list(places), rows)


check_weights()
finish("\n".join([source_table(), basis_table(4), basis_table(9), basis_table(16)]), failures, PAGE, BEGIN, END, WRITE)
