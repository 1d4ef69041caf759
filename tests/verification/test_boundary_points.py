#!/usr/bin/env python3
"""Boundary plugins on material points: P and S pulses down a column of 20 m leave by dashpots at its foot, by every basis, at points and at nodes, written as a boundary and as a
side of the grid; ground that begins with its weight stays at rest between them; the same bits on two threads and behind a restart. usage: test_boundary_points.py BUILD"""
import csv
import subprocess
import sys
import tempfile
from math import exp
from pathlib import Path

COLUMN = """
abut: 1
title: A pulse leaves a column of points
constants: {{h: 0.5, w: {w}, c: {c}, p: 1e3}}
time: {{end: {end}, dt: "0.4*h/200"}}
grid: {{from: [{left}], to: [{right}, 21], cell: h{sides}}}
checkpoint: {{steps: 200}}
materials:
  ground: {{model: linear-elastic, E: "2000*200^2*5/6", nu: 0.25, density: 2000}}
bodies:
  column: {{method: material-points, material: ground, shape: {{box: [[0, 0], [1, 20]]}}}}
loads:
  - {{body: column, where: {{side: top}}, traction: [{load}]}}
boundaries: {boundaries}
monitors:
  - {{name: v, body: column, at: [0.5, 10], value: velocity.{axis}}}
  - {{name: v_max, body: column, value: velocity.{axis}, over: max}}
"""
PULSE = '"-p*exp(-((t-2.3*w)/w)^2)"'
FOOT = "{on: column, where: {side: bottom}, boundary: viscous}"
P = dict(c=200, w=0.035, end=0.36, axis="y", load=f"0, {PULSE}", left="0, -2", right=1, sides=", sides: {left: roller, right: roller}", boundaries=f"[{FOOT}]")
# sides that let a shear wave pass: nothing moves along y
S = dict(c=115.47, w=0.06, end=0.6, axis="x", load=f"{PULSE}, 0", left="-1, -2", right=2, sides="",
         boundaries=f"[{FOOT}, {{on: column, where: {{side: left}}, boundary: slide-plugin}}, {{on: column, where: {{side: right}}, boundary: slide-plugin}}]")
SIDE = dict(P, left="0, 0", sides=", sides: {left: roller, right: roller, bottom: {boundary: viscous}}", boundaries="[]")

ECHO = [  # scene, settings, largest echo at cells of 0.5 and 0.25 m
    ("P gimp", P, {}, 0.005),
    ("P gimp at nodes", P, {"boundaries[0].at": "nodes"}, 0.005),
    ("P gimp as a side", SIDE, {}, 0.005),
    ("P gimp usl", P, {"bodies.column.update": "usl"}, 0.002),
    ("P gimp usf", P, {"bodies.column.update": "usf"}, 0.005),
    ("P linear", P, {"bodies.column.basis": "linear"}, 0.005),
    ("P cpdi", P, {"bodies.column.basis": "cpdi"}, 0.005),
    ("P bspline2", P, {"bodies.column.basis": "bspline2"}, 0.01),
    ("S gimp", S, {}, 0.005),
    ("S linear", S, {"bodies.column.basis": "linear"}, 0.005),
]

REST = """
abut: 1
title: Ground that begins in equilibrium stays in it between absorbing sides
gravity: [0, -9.81]
time: {end: 0.2, cfl: 0.5}
grid: {from: [0, 0], to: [8, 7], cell: 0.5, sides: {left: {boundary: viscous}, right: {boundary: viscous}, bottom: {boundary: viscous}}}
materials:
  ground: {model: linear-elastic, E: 20e6, nu: 0.25, density: 2000}
bodies:
  ground: {method: material-points, material: ground, shape: {box: [[0, 0], [8, 5]]}, initial: {stress: K0}}
monitors:
  - {name: v, body: ground, value: speed, over: max}
"""


def run(build, scene, out, *more):
    subprocess.run([f"{build}/abut", "run", scene, "--quiet", "--plugin-path", f"{build}/tests/plugins", "-o", out, *more], check=True, stdout=subprocess.DEVNULL)
    with open(f"{out}/history.csv", newline="") as stream:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(stream)]


def main():
    build, missed = sys.argv[1], 0

    def say(name, good, text):
        nonlocal missed
        missed += not good
        print(f"{name:20s} {text}{'' if good else '  MISSED'}")

    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.yaml"
        for name, words, settings, most in ECHO:
            scene.write_text(COLUMN.format(**words))
            sets = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
            for h in (0.5, 0.25):
                rows = run(build, scene, f"{folder}/out", "-j", "1", "--set", f"constants.h={h}", *sets)
                passed = 10 / words["c"] + 5.3 * words["w"]
                peak = 1e3 / 2000 / words["c"]
                direct = max(abs(r["v"]) for r in rows) / peak
                echo = max(abs(r["v"]) for r in rows if r["t"] > passed) / peak
                last = rows[-1]
                put = max(r["external"] for r in rows)
                left = (last["kinetic"] + last["strain"]) / put
                closes = max(abs(r["remainder"]) for r in rows) / put
                good = echo < most and abs(direct - 1) < 0.02 and left < 0.002 and closes < 0.01
                say(f"{name} {h}", good, f"direct {direct:.4f} echo {100 * echo:.3f} % left {100 * left:.3f} % ledger {100 * closes:.3f} %")
        scene.write_text(COLUMN.format(**P) + "  - {name: given, boundary: 0, value: impulse.y}\n  - {name: momentum, body: column, value: momentum.y}\n"
                         "  - {name: work, boundary: 0, value: work}\n  - {name: dashpot, boundary: 0, value: work.dashpot}\n")
        whole = Path(f"{folder}/whole")
        rows = run(build, scene, whole, "-j", "1")
        put = sum(r["dt"] * 1e3 * exp(-((r["t"] - 0.5 * r["dt"] - 2.3 * 0.035) / 0.035) ** 2) for r in rows if r["step"] > 0)  # N s, the load's
        last = rows[-1]
        say("momentum", abs(last["given"] - put - last["momentum"]) < 1e-10 * put, f"load {-put:.6f} + dashpots {last['given']:.6f} = {last['momentum']:.6f} N s")
        say("work", abs(last["work"] + last["dashpot"]) < 0.01 * last["dashpot"] and all(b["dashpot"] >= a["dashpot"] for a, b in zip(rows, rows[1:])),
            f"{last['work']:.6f} J, of dashpots {last['dashpot']:.6f} J, which only take")
        run(build, scene, f"{folder}/two", "-j", "2")
        say("two threads", (whole / "history.csv").read_bytes() == Path(f"{folder}/two/history.csv").read_bytes(), "history to the last bit")
        part = Path(f"{folder}/part")
        run(build, scene, part, "-j", "1", "--set", "time.end=0.25")
        run(build, scene, part, "-j", "1", "--restart", f"{part}/checkpoint.previous.abut")
        say("restart", (whole / "history.csv").read_bytes() == (part / "history.csv").read_bytes(), "history to the last bit")
        scene.write_text(REST)
        for basis in ("gimp", "linear", "cpdi"):
            rows = run(build, scene, f"{folder}/rest", "-j", "1", "--set", f"bodies.ground.basis={basis}")
            fastest = max(r["v"] for r in rows)
            say(f"rest, {basis}", fastest < 1e-12, f"{fastest:.1e} m/s")
    sys.exit(1 if missed else 0)


main()
