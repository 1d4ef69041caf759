#!/usr/bin/env python3
"""What dashpots throw back of a plane P wave, at four angles: the amplitudes of the reflected P and S, against verification.md; on elements and, at one angle (--points: at
all), on points. usage: test_oblique.py BUILD [--points] [--set X=Y ...]

The velocities at the middle of the top are (d + A_P d_P + A_S d_S) f, f the course of the incident wave: a straight line each, by least squares, and two equations."""
import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ANGLES = {20: (0.011942, -0.010817), 30: (0.016035, 0.008954), 45: (-0.013839, 0.070895), 60: (-0.133975, 0.133975)}
HOLD = 0.01
HERE = Path(__file__).resolve().parent
NU, E, RHO = 0.25, 20e6, 1500.0
CP = math.sqrt(E * (1 - NU) / ((1 + NU) * (1 - 2 * NU) * RHO))
CS = math.sqrt(E / (2 * (1 + NU) * RHO))


def wave(t):
    return -t * math.exp(0.5 - 0.5 * t * t)


def amplitudes(angle, history):
    theta = math.radians(angle)
    st, ct = math.sin(theta), math.cos(theta)
    sb = st * CS / CP
    cb = math.sqrt(1 - sb * sb)
    width = 4 / CP
    high = 2 * round(2 + 24 * width * CP / (8 * ct))
    middle = 4 * round(22 * width * CP / (16 * (1 - st)) + 0.5)
    past = 4 * width + (middle * st + high * ct) / CP
    with open(history, newline="") as stream:
        rows = [(float(row["t"]), float(row["vx"]), float(row["vy"])) for row in csv.DictReader(stream)]
    best = None
    for shift in range(-20, 21):  # the wave of the mesh comes a little late; amplitudes are wanted, not its time
        late = past + 0.01 * shift * width
        near = [(wave((t - late) / width), vx, vy) for t, vx, vy in rows if abs(t - late) < 4 * width]
        size = sum(f * f for f, _, _ in near)
        gx = sum(f * vx for f, vx, _ in near) / size
        gy = sum(f * vy for f, _, vy in near) / size
        rest = sum((vx - gx * f) ** 2 + (vy - gy * f) ** 2 for f, vx, vy in near)
        if best is None or rest < best[0]:
            best = (rest, gx / 1e-3, gy / 1e-3)
    if "-v" in sys.argv: print("rest", best)
    _, gx, gy = best  # st + st P + cb S = gx; ct - ct P + sb S = gy
    determinant = st * sb + ct * cb
    p = ((gx - st) * sb - (gy - ct) * cb) / determinant
    s = (st * (gy - ct) + ct * (gx - st)) / determinant
    return p, -s  # the table counts S the other way round


POINTS = ["--set", "bodies.strip={method: material-points, material: ground, shape: {box: [[0, 0], [wide, high]]}, basis: gimp, transfer: apic}",
          "--set", 'grid={from: ["-8*h", "-8*h"], to: ["wide+8*h", "high+8*h"], cell: h}']


def main():
    build, more = sys.argv[1], sys.argv[2:]
    every = "--points" in more
    more = [word for word in more if word != "--points"]
    missed = 0
    print("        angle  P measured  exact      S measured  exact")
    with tempfile.TemporaryDirectory() as folder:
        for way, settings, angles in (("elements", [], ANGLES), ("points", POINTS, ANGLES if every else [45])):
            for angle in angles:
                out = f"{folder}/{way}-{angle}"
                subprocess.run(
                    [f"{build}/abut", "run", HERE / "boundary_oblique.yaml", "--quiet", "-j", "1", "-o", out, "--set", f"constants.angle={angle}", *settings, *more],
                    check=True, stdout=subprocess.DEVNULL)
                p, s = amplitudes(angle, f"{out}/history.csv")
                p_exact, s_exact = ANGLES[angle]
                good = abs(p - p_exact) < HOLD and abs(s - s_exact) < HOLD
                missed += not good
                print(f"{way:8s} {angle:4d}  {p:10.6f}  {p_exact:9.6f}  {s:10.6f}  {s_exact:9.6f}  {'' if good else 'MISSED'}", flush=True)
    sys.exit(1 if missed else 0)


main()
