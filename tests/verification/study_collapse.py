#!/usr/bin/python3
# cost: 150
"""The table of cases/column_collapse/README.md: run-out over the height of the column, by mesh. study_collapse.py BUILD [CELLS ...], 12 16 24 36 48 where none are given (64: two minutes more).

Three fronts, each as a part of a L from the place where the column stood: the furthest point; and where the deposit, spread over windows of L/10, is as deep as 3 and 5 % of the column's height, as an
experiment sees it that leaves single grains out. Exit status 1 where the last two meshes differ by more than 3 % in any of them, or the deposit's front is more than a tenth from 1.2. Needs h5py and numpy."""
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

L, A = 0.1, 1.0
H = A * L


def fronts(path):
    with h5py.File(path) as file:
        last = file[sorted(name for name in file if name.startswith("frame"))[-1]]
        x, y = last["column/position"][:, 0], last["column/position"][:, 1]
    x = np.sort(x)
    window, places = L / 10, np.linspace(L, 4 * L, 6001)
    depth = (np.searchsorted(x, places + window / 2) - np.searchsorted(x, places - window / 2)) * (L * H / len(x)) / window
    found = [x[-1]] + [places[depth > part * H][-1] for part in (0.03, 0.05)]
    return [(front - L) / H for front in found] + [y.max() / H]


build = os.path.realpath(sys.argv[1])
scene = os.path.realpath("cases/column_collapse/scene.yaml")
rows = []
print("cells in L | furthest point | deeper than 3 % of H | than 5 % | height left")
with tempfile.TemporaryDirectory(dir=os.environ.get("ABUT_SCRATCH")) as folder:
    for cells in sys.argv[2:] or ("12", "16", "24", "36", "48"):
        subprocess.run([f"{build}/abut", "run", scene, "--quiet", "-j", "1", "-o", f"{folder}/{cells}", "--set", f"constants.rows={cells}"], check=True)
        rows.append(fronts(f"{folder}/{cells}/results.h5"))
        print(cells, *(f"{front:.3f}" for front in rows[-1]), flush=True)
settled = len(rows) < 2 or all(abs(a - b) < 0.03 * b for a, b in zip(rows[-2], rows[-1]))
sys.exit(not (settled and all(abs(front - 1.2) < 0.12 for front in rows[-1][:3])))
