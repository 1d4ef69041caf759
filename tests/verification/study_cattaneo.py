#!/usr/bin/python3
"""Cattaneo 1938, Mindlin 1949: a cylinder is pressed on with P and then dragged with Q < mu P: it sticks within c = a sqrt(1 - Q/(mu P)) of the middle and slips
beyond. study_cattaneo.py BUILD [Q/(mu P) ...], at three places of the block in the grid, four points a cell; exit status 1 where the stick zone is off by more than a cell, two loads are not told apart
by at least half of what they differ, or the shear is off by more than a tenth of mu p0 in the mean.

Where a point slips its shear is mu p, and where it sticks what is left of mu p is mu p0 c/a sqrt(1 - (x/c)^2): Hertz' profile on the stick zone. c is that whose profile, in the mean over what
each point stands for and times any factor, fits what is left best by least squares. So c is known finer than points are apart; and as the factor is free it comes from where
the points slip and not from the sum of their forces, which is Q in any case: shear in proportion to the pressure, as without slip, would give c = a.

The block of hertz_points.yaml with nu = 0.49 (and f_bar): only bodies that are alike, or keep their volume against a rigid one, are pressed on without shear. Needs h5py and numpy."""
import subprocess
import sys
import tempfile

import numpy as np

E, NU, P, R, MU = 1e7, 0.49, 1e4, 1.0, 0.3
P0 = np.sqrt(P * E / (1 - NU**2) / np.pi / R)
A = np.sqrt(4 * P * R * (1 - NU**2) / np.pi / E)
TIMES = (8, 30)  # T, of the drag and at the end
PLACES = [(0.55, 0.25), (0.3, 0.5), (0.1, 0.25)]  # shift, aside
LOADS = [0.3, 0.6, 0.8]
CONTACT = "{bodies: [block, cylinder], algorithm: point-to-segment, passes: first, response: coulomb, recovery: 20, friction: %g}" % MU
FORCE = '["%g*0.5*(1 - cos(pi*min(max(t/(%g*T) - 1.5, 0), 1)))", "-P*0.5*(1 - cos(pi*min(t/(8*T), 1)))"]'


def load(z, part=1.0):
    """Force up to z of the pressure of Hertz, and of the one like it on `part` of its width."""
    a = part * A
    z = np.clip(z / a, -1, 1)
    return P0 * part * a * 0.5 * (z * np.sqrt(1 - z * z) + np.arcsin(z))


def means(x, width, part=1.0):
    """Mean of that pressure over what each point stands for."""
    return (load(x + width / 2, part) - load(x - width / 2, part)) / width


def run(build, ratio, place, per_cell, times, folder):
    """Contact points at the end, from left to right."""
    import h5py

    settings = {
        "constants.nu": NU, "constants.shift": place[0], "constants.aside": place[1], "bodies.block.fill": "{per_cell: %d}" % per_cell, "bodies.block.f_bar": "cell", "time.end": f"{times[1]}*T",
        "contact[0]": CONTACT, "bodies.cylinder.motion.velocity": "[null, null]", "loads[0].force": FORCE % (ratio * MU * P, times[0]),
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


def stick_zone(c):
    """c/a of the profile that fits best."""
    x, area, touches = c["position"][:, 0], c["area"], c["force"][:, 1] > 0
    left = np.where(touches, np.maximum(MU * c["pressure"] - c["shear"], 0), 0)
    best = (np.inf, 0.0)
    for part in np.arange(0.1, 1.3, 0.002):
        profile = means(x, area, part)
        factor = (left * profile * area).sum() / (profile * profile * area).sum()
        best = min(best, (((left - factor * profile) ** 2 * area).sum(), part))
    return best[1]


def measure(build, ratio, place, per_cell, times, show):
    """c/a, error of the shear over mu p0, distance of points over a."""
    with tempfile.TemporaryDirectory() as folder:
        c = run(build, ratio, place, per_cell, times, folder)
    x, area, force = c["position"][:, 0], c["area"], c["force"]
    touches, part = force[:, 1] > 0, np.sqrt(1 - ratio)
    exact = MU * (means(x, area) - means(x, area, part))
    if c["shear"][touches].sum() < 0:  # along the tangent (-normal.y, normal.x)
        c["shear"] = -c["shear"]
    shear = np.sqrt(np.mean((c["shear"][touches] - exact[touches]) ** 2)) / (MU * P0)
    stick, apart = stick_zone(c), np.median(area) / A
    print(f"shift {place[0]}, aside {place[1]}, Q/(mu P) = {ratio}: Q {abs(force[:, 0].sum()) / (MU * P):.3f} mu P; c/a {stick:.3f}, exact {part:.3f} (a cell is {apart:.3f}); "
          f"rms error of the shear {100 * shear:.1f} % of mu p0", flush=True)
    for k in np.flatnonzero(touches) if show else ():
        print(f"    x/a {x[k] / A:6.3f}  p {c['pressure'][k]:8.0f}  q {c['shear'][k]:7.0f}  exact {exact[k]:7.0f}")
    return stick, shear, apart


def hold(build, place, loads, per_cell=4, times=TIMES, show=False):
    """True where every load's stick zone is within a cell and no two are taken for each other."""
    got = [measure(build, ratio, place, per_cell, times, show) for ratio in sorted(loads)]
    exact = [np.sqrt(1 - ratio) for ratio in sorted(loads)]
    good = all(abs(stick - part) < apart and shear < 0.1 for (stick, shear, apart), part in zip(got, exact))
    return good and all(got[k][0] - got[k + 1][0] > 0.5 * (exact[k] - exact[k + 1]) for k in range(len(got) - 1))


def main():
    loads = [float(r) for r in sys.argv[2:]] or LOADS
    good = [hold(sys.argv[1], place, loads, show=True) for place in PLACES]
    sys.exit(0 if all(good) else 1)


if __name__ == "__main__":
    main()
