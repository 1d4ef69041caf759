#!/usr/bin/python3
"""Cattaneo 1938, Mindlin 1949: a cylinder is pressed on with P and then dragged with Q < mu P: it sticks within c = a sqrt(1 - Q/(mu P)) of the middle and slips
beyond. study_cattaneo.py BUILD [Q/(mu P) ...]; exit status 1 where the stick zone is off by more than a cell, or the shear by more than a tenth of mu p0 in the mean.

The block of hertz_points.yaml with nu = 0.49 (and f_bar): only bodies that are alike, or keep their volume against a rigid one, are pressed on without shear. A point sticks where
its force across is below 0.97 of the limit. Needs h5py and numpy."""
import subprocess
import sys
import tempfile

import h5py
import numpy as np

E, NU, P, R, MU = 1e7, 0.49, 1e4, 1.0, 0.3
P0 = np.sqrt(P * E / (1 - NU**2) / np.pi / R)
A = np.sqrt(4 * P * R * (1 - NU**2) / np.pi / E)
CONTACT = "{bodies: [block, cylinder], algorithm: point-to-segment, passes: first, response: coulomb, recovery: 20, friction: %g}" % MU
FORCE = '["%g*0.5*(1 - cos(pi*min(max(t/(8*T) - 1.5, 0), 1)))", "-P*0.5*(1 - cos(pi*min(t/(8*T), 1)))"]'


def load(z, part=1.0):
    """Force up to z of the pressure of Hertz, and of the one like it on `part` of its width."""
    a = part * A
    z = np.clip(z / a, -1, 1)
    return P0 * part * a * 0.5 * (z * np.sqrt(1 - z * z) + np.arcsin(z))


def run(build, ratio, folder):
    settings = {
        "constants.nu": NU, "constants.deep": 0.4, "bodies.block.fill": "{per_cell: 4}", "bodies.block.transfer": "flip", "bodies.block.f_bar": "cell", "time.end": "30*T", "contact[0]": CONTACT,
        "bodies.cylinder.motion.velocity": "[null, null]", "loads[0].force": FORCE % (ratio * MU * P),
    }
    command = [f"{build}/abut", "run", "tests/verification/hertz_points.yaml", "--quiet", "-j", "1", "-o", folder]
    for path, value in settings.items():
        command += ["--set", f"{path}={value}"]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    with h5py.File(f"{folder}/results.h5") as file:
        c = file[sorted(k for k in file if k.startswith("frame"))[-1]]["contact_0"]
        order = np.argsort(c["position"][:, 0])
        return {name: c[name][:][order] for name in c}


def main():
    build, good = sys.argv[1], True
    for ratio in [float(r) for r in sys.argv[2:]] or [0.3, 0.6]:
        with tempfile.TemporaryDirectory() as folder:
            c = run(build, ratio, folder)
        x, area, force = c["position"][:, 0], c["area"], c["force"]
        part = np.sqrt(1 - ratio)
        exact = MU * np.array([load(b) - load(a) - (load(b, part) - load(a, part)) for a, b in zip(x - area / 2, x + area / 2)]) / area
        touches = force[:, 1] > 0
        sticks = touches & (abs(force[:, 0]) < 0.97 * MU * force[:, 1])
        stick, h = 0.5 * area[sticks].sum(), np.median(area)
        shear = np.sqrt(np.mean((c["shear"][touches] - exact[touches]) ** 2)) / (MU * P0)
        print(f"Q/(mu P) = {ratio}: Q {force[:, 0].sum():.1f} N; c/a {stick / A:.3f}, exact {part:.3f} (a cell is {h / A:.3f}); rms error of the shear {100 * shear:.1f} % of mu p0")
        for k in np.flatnonzero(touches):
            print(f"    x/a {x[k] / A:6.3f}  p {c['pressure'][k]:8.0f}  q {c['shear'][k]:7.0f}  exact {exact[k]:7.0f}  {'sticks' if sticks[k] else 'slips'}")
        good = good and abs(stick - part * A) < h and shear < 0.1
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
