#!/usr/bin/python3
"""Pressure of Hertz by points on the outline and by domains of material points, over places of the block in the grid: study_surface_points.py BUILD [--first N].

Prints a table: error of the peak pressure, root mean square of the errors inside 0.8 a against the exact mean over what each point stands for, and error of the half
width from the second moment of the pressure, in per cent. Needs h5py and numpy."""
import subprocess
import sys
import tempfile

import h5py
import numpy as np

PLACES = [(0.37, 0.31), (0.05, 0.5), (0.2, 0.0), (0.55, 0.25), (0.8, 0.7), (0.1, 0.25)]  # shift, aside
SPRINGS = "{bodies: [block, cylinder], algorithm: point-to-segment, passes: first, response: penalty, stiffness_of: modulus, stiffness: 3}"
FEWER = ["bodies.block.fill={per_cell: 4}", "bodies.block.transfer=flip", "constants.deep=0.4"]
WAYS = [  # surface, response, what else is said of it, settings
    ("points", "coulomb", "9 a cell, apic", []),
    ("points", "coulomb", "4 a cell, flip", FEWER),
    ("points", "penalty", "4 a cell, flip", FEWER + ["contact[0]=" + SPRINGS]),
    ("domains", "coulomb", "4 a cell, flip", FEWER),
    ("domains", "penalty", "4 a cell, flip", FEWER + ["contact[0]=" + SPRINGS]),
]
E, NU, P, R = 1e7, 0.3, 1e4, 1.0
P0 = np.sqrt(P * E / (1 - NU**2) / np.pi / R)
A = np.sqrt(4 * P * R * (1 - NU**2) / np.pi / E)


def load(z):
    """Force of Hertz' pressure up to z."""
    z = np.clip(z / A, -1, 1)
    return P0 * A * 0.5 * (z * np.sqrt(1 - z * z) + np.arcsin(z))


def errors(build, folder, surface, more, shift, aside):
    settings = [f"bodies.block.surface={surface}", f"constants.shift={shift}", f"constants.aside={aside}"] + more
    command = [f"{build}/abut", "run", "tests/verification/hertz_points.yaml", "--quiet", "-j", "1", "-o", folder]
    for s in settings:
        command += ["--set", s]
    subprocess.run(command, check=False, capture_output=True)
    with h5py.File(f"{folder}/results.h5") as file:
        c = file[sorted(k for k in file if k.startswith("frame"))[-1]]["contact_0"]
        x, p, area = c["position"][:, 0], c["pressure"][:], c["area"][:]
    inside = abs(x) < 0.8 * A
    exact = (load(x + area / 2) - load(x - area / 2)) / area
    force = p * area
    middle = (force * x).sum() / force.sum()
    width = 2 * np.sqrt((force * (x - middle) ** 2).sum() / force.sum()) / A
    return p.max() / P0 - 1, np.sqrt(np.mean((p[inside] / exact[inside] - 1) ** 2)), width - 1


def main():
    build = sys.argv[1]
    places = PLACES[: int(sys.argv[3])] if "--first" in sys.argv else PLACES
    print("| surface | response | points, transfer | " + " | ".join(f"{s} h, {a} h" for s, a in places) + " |")
    print("| --- | --- | --- |" + " --- |" * len(places))
    with tempfile.TemporaryDirectory() as folder:
        for surface, response, what, more in WAYS:
            cells = [" / ".join(f"{100 * e:.1f}" for e in errors(build, folder, surface, more, s, a)) for s, a in places]
            print(f"| {surface} | {response} | {what} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
