#!/usr/bin/python3
# cost: 150
"""The tables of docs/accuracy.md about locking: study_locking.py BUILD [--write] prints them; --write puts them into docs/accuracy.md.

Cook's membrane and a thick tube of points (cook_points.yaml, tube_points.yaml), a pressed block carried across cells, a vibrating block that flies, and a block that turns
twenty times (pressed_carried.yaml, vibrating_block.yaml, rotation.yaml), without f_bar, with cells and with patches. It fails where a run does not end, where f_bar is
off by more than 3 % at nu = 0.4999, and where its pressure is rougher than in test_locking.py."""
import math
import os
import sys

from pages import finish, table
from pressures import roughness
from runs import Runs, errors, figure

WRITE = "--write" in sys.argv
PAGE = "docs/accuracy.md"
BEGIN, END = "<!-- made by study_locking.py: begin -->", "<!-- made by study_locking.py: end -->"
WAYS = ("false", "cell", "patch")
runs = Runs(os.path.realpath(sys.argv[1]))
failures = runs.failures


def run(scene, body, f_bar, settings):
    return runs.run(f"tests/verification/{scene}.yaml", {f"bodies.{body}.f_bar": f_bar, **settings})


def percent(value):
    return figure(100 * value)


def cook_rows():
    rows = []
    for nu, basis, cells in [("0.4999", "gimp", 8), ("0.4999", "gimp", 16), ("0.4999", "linear", 16), ("0.4999", "bspline2", 12), ("0.4999", "bspline3", 12),
                             ("1/3", "gimp", 16), ("1/3", "gimp", 32)]:
        reference = {"1/3": {"constants.rise": 21.5246, "constants.along": 0.862, "constants.up": 0.126, "constants.ramp": 3000}}.get(nu, {})
        for f_bar in WAYS:
            ran = run("cook_points", "panel", f_bar, {"constants.n": cells, "bodies.panel.basis": basis, "materials.m.nu": nu, **reference})
            if not ran:
                continue
            summary, history, folder = ran
            off = math.copysign(errors(summary)["middle of the right side"], history["middle"][-1])
            within, between = roughness(folder, "panel", 48 / cells, (0, -2 * 48 / cells))
            rows.append([nu, basis, str(cells), f_bar, percent(off), figure(within) if within > 1e-10 else "0", figure(between), f"{summary['cpu_seconds']:.1f}"])
            if f_bar != "false" and nu != "1/3" and (basis != "linear" or f_bar == "patch") and (abs(off) > 0.03 or within > 0.01 or between > 0.25):
                failures.append(f"cook, {basis}, {cells} cells, {f_bar}: {rows[-1]}")
    return rows


def tube_rows():
    rows = []
    for nu, cells in [("0.4999", 4), ("0.4999", 8), ("0.3", 4), ("0.3", 8)]:
        for f_bar in WAYS:
            ran = run("tube_points", "tube", f_bar, {"constants.n": cells, "constants.nu": nu})
            if not ran:
                continue
            summary, history, folder = ran
            found, work = errors(summary), summary["expects"][0]
            rows.append([nu, str(cells), f_bar, percent(work["value"] / work["reference"] - 1), percent(found["u at b"]), percent(found["u everywhere"]),
                         percent(found["pressure"]), f"{summary['cpu_seconds']:.1f}"])
            # on 4 cells the rim is off by 1 to 6 %, by the place of the tube in the grid
            if f_bar != "false" and cells > 4 and max(found["u at a"], found["u at b"], found["work of the pressure is that of u at a"]) > 0.03:
                failures.append(f"tube, {cells} cells, {f_bar}: {rows[-1]}")
    return rows


def motion_rows():
    rows = []
    for f_bar in WAYS:
        row = [f_bar]
        for basis in ("linear", "gimp", "bspline2"):
            ran = run("pressed_carried", "block", f_bar, {"bodies.block.basis": basis})
            row.append(percent(errors(ran[0])["pressure"]) if ran else "")
        for cells in (8, 16, 32):
            ran = run("vibrating_block", "block", f_bar, {"constants.n": cells})
            row.append(percent(errors(ran[0])["ledger closes"]) if ran else "")
        ran = run("rotation", "block", f_bar, {"constants.turns": 20})
        row.append(percent(1 - ran[1]["rate"][-1]) if ran else "")
        rows.append(row)
    return rows


text = "\n".join([
    table("Cook's membrane: displacement of the middle of the right side off in per cent; roughness of the pressure within cells and between them (the checkerboard), as parts of its size; seconds of processor time.",
          ["nu", "basis", "cells along", "f_bar", "off", "within", "between", "s"], cook_rows()),
    table("Thick tube, GIMP, on a grid that does not fit it: displacement of the bore (by the work of the pressure), of the rim, and root mean square over all points, off in per cent; pressure off, in per cent of its size.",
          ["nu", "cells in the wall", "f_bar", "bore", "rim", "everywhere", "pressure", "s"], tube_rows()),
    table("Motion: error of the pressure of a pressed block that is carried across 60 cells, in per cent, by basis; largest remainder of a block of 8, 16 and 32 cells that vibrates (nu = 0.499) while it flies, in per cent of its vibration; rate of rotation that an elastic block (apic, gimp, nu = 0.3) has lost after 20 turns, in per cent.",
          ["f_bar", "carried, linear", "gimp", "bspline2", "remainder, 8", "16", "32", "slower after 20 turns"], motion_rows())])
finish(text, failures, PAGE, BEGIN, END, WRITE)
