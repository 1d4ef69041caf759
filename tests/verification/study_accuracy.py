#!/usr/bin/python3
# cost: 900
"""The tables of docs/accuracy.md that set choices side by side: study_accuracy.py BUILD [--write] prints them; --write puts them into docs/accuracy.md.

Scenes of one body with every basis and transfer, scenes of two in contact with every basis, transfer and normal that makes sense: error, what the ledger is left with, seconds of processor time.
It fails where a run with a smooth basis does not end or makes energy, and where a body without stress does not fly through ten thousand cells unchanged."""
import math
import os
import sys
from concurrent.futures import ThreadPoolExecutor

from pages import finish, table
from runs import Runs, errors, figure

BASES = ["linear", "gimp", "bspline2", "bspline3", "cpdi"]
TRANSFERS = ["flip", "apic", "tpic", "{fmpm: 3}"]
NORMALS = ["average", "mass-gradient", "volume-gradient", "density-gradient", "geometric", "regression", "convex", "stiffer"]
PAGE = "docs/accuracy.md"
BEGIN, END = "<!-- made by study_accuracy.py: begin -->", "<!-- made by study_accuracy.py: end -->"
MADE = 1e-2  # of the energy that moves, as in the scenes' own ledgers: more than this is not made without an error
WRITE = "--write" in sys.argv
runs = Runs(sys.argv[1])
failures = runs.failures


def run(what, scene, bodies, basis, transfer, settings={}, contact=False):
    """Summary and history, or None: a linear basis may fail, every other is missed."""
    choices = {f"bodies.{body}.basis": basis for body in bodies} | {f"bodies.{body}.transfer": transfer for body in bodies}
    ran = runs.run(scene, {**choices, **settings}, may_fail=basis == "linear")
    if ran is None:
        return None
    rest = ran[0]["ledger"]["remainder"] / largest_energy(ran[1])
    if basis != "linear" and rest > MADE and what != "hertz":  # there splines make energy: the table says so
        failures.append(f"{what}, {basis}, {transfer}, {settings}: energy made, {100 * rest:.2g} %")
    return ran[0], ran[1], rest


def largest_energy(history):
    """The largest of what moves in a run, J: kinetic and strain energy, work of the weight or from outside."""
    return max(abs(history[name]).max() for name in ("kinetic", "strain", "potential", "external"))


def cells(summary, *values):
    """Values in per cent, then seconds."""
    return [figure(100 * abs(v)) for v in values] + [f"{summary['cpu_seconds']:.1f}"]


def rate(coarse, fine, refined):
    return f"{math.log(coarse / fine) / math.log(refined):.1f}" if coarse > 0 and fine > 0 else "-"


def manufactured(name, body, expect, basis, transfer, meshes, per_cell):
    """Errors of displacement on two meshes, the slope, the remainder on the finer one and its seconds. Domains of gimp that grow with the vortex's shear overlap: fixed there."""
    basis = "{gimp: fixed}" if (name, basis) == ("vortex", "gimp") else basis
    coarse, fine = (run(name, f"tests/verification/{name}.yaml", [body], basis, transfer, {"constants.cells": n, f"bodies.{body}.fill.per_cell": per_cell}) for n in meshes)
    if not coarse or not fine:
        return ["fails", "", "", ""]
    before, after = errors(coarse[0])[expect], errors(fine[0])[expect]
    return [figure(100 * after), rate(before, after, 2)] + cells(fine[0], fine[2])


def ring(basis, transfer):
    ran = run("ring", "tests/verification/ring.yaml", ["ring"], basis, transfer, {"constants.r": 0.6, "constants.w": "0.05*c/R", "constants.cells": 8})
    return cells(ran[0], errors(ran[0])["angular momentum"], errors(ran[0])["mean stress along x"], ran[2]) if ran else ["fails"] + [""] * 3


def self_weight(basis, transfer):
    ran = run("self-weight", "tests/verification/self_weight.yaml", ["column"], basis, transfer, {"constants.cells": 25})
    return cells(ran[0], errors(ran[0])["settlement"], errors(ran[0])["stress half-way"], ran[2]) if ran else ["fails"] + [""] * 3


def translation(basis, transfer):
    """The largest change of anything on a way of 10^4 cells, or the cell from which on the energy is off by 1e-6: flip keeps what no node sees, and it may grow."""
    settings = {"constants.end": "1e4*h", "grid.to": '["1e4*h+20*h", "6e3*h+20*h"]', "time": "{end: end}", "history": "{every: 100}"}
    choices = {"bodies.block.basis": basis, "bodies.block.transfer": transfer}
    ran = runs.run("tests/verification/translation.yaml", {**choices, **settings}, may_fail=transfer == "flip" or basis == "linear", keep=True)
    if not ran:
        return ["fails", ""]
    energy, seconds = ran[1]["energy"], f"{ran[0]['cpu_seconds']:.1f}"
    off = abs(energy / energy[0] - 1) > 1e-6
    if off.any() or ran[0]["outcome"] != "done":
        off[-1] = True
        if transfer != "flip" and basis != "linear":
            failures.append(f"translation, {basis}, {transfer}: energy off from {ran[1]['t'][off.argmax()]:.0f} s on")
        return [f"to cell {ran[1]['x'][off.argmax()] / 0.5:.0f}", seconds]
    worst = max(abs(e) for e in errors(ran[0]).values())
    if worst > 1e-8 and transfer != "flip":  # a hundred times what translation.yaml allows on a hundredth of the way
        failures.append(f"translation, {basis}, {transfer}: changed by {worst:.2g} on the way")
    return [f"{worst:.0e}", seconds]


def one_body(basis, transfer):
    return [basis, transfer, *manufactured("vortex", "ring", "displacement and back again", basis, transfer, (8, 16), 9),
            *manufactured("mms", "square", "displacement along x", basis, transfer, (16, 32), 4)[:2],
            *manufactured("mms", "square", "displacement along x", basis, transfer, (16, 32), 16), *ring(basis, transfer), *self_weight(basis, transfer), *translation(basis, transfer)]


def impact(basis, transfer, settings):
    ran = run("impact", "tests/verification/impact.yaml", ["a", "b"], basis, transfer, settings)
    e = errors(ran[0]) if ran else None
    return cells(ran[0], e["force"], e["duration"], e["speed of the second bar"], ran[2]) if ran else ["fails"] + [""] * 4


def incline(basis, transfer, settings):
    ran = run("incline", "cases/block_on_incline/scene.yaml", ["block", "plane"], basis, transfer, {"output": "{}", **settings})
    e = errors(ran[0]) if ran else None
    return cells(ran[0], e["acceleration over the second half"], e["friction force"], ran[2]) if ran else ["fails"] + [""] * 3


def cylinder(basis, transfer, settings):
    ran = run("cylinder", "tests/verification/cylinder.slow.yaml", ["cylinder", "plane"], basis, transfer, {"constants.h": 0.03125, **settings})
    e = errors(ran[0]) if ran else None
    return cells(ran[0], e["acceleration"], e["rate of spin"], ran[2]) if ran else ["fails"] + [""] * 3


def discs(basis, transfer, settings):
    ran = run("discs", "tests/verification/discs.yaml", ["left", "right"], basis, transfer, {"constants.cells": 16, **settings})
    e = errors(ran[0]) if ran else None
    return cells(ran[0], e["duration"], e["exit speed of the left disc"], e["largest force"], ran[2]) if ran else ["fails"] + [""] * 4


def hertz(basis, transfer):
    ran = run("hertz", "tests/verification/hertz_points.yaml", ["block"], basis, transfer)
    e = errors(ran[0]) if ran else None
    return [basis, transfer] + (cells(ran[0], e["peak pressure"], e["half width of contact"], ran[2]) if ran else ["fails"] + [""] * 3)


def contact_row(basis, transfer, normal):
    settings = {"contact[0].normal": normal} if normal != "average" else {}
    return [basis, transfer, normal, *impact(basis, transfer, settings), *incline(basis, transfer, settings), *cylinder(basis, transfer, settings), *discs(basis, transfer, settings)]


if __name__ == "__main__":
    pool = ThreadPoolExecutor(os.cpu_count())
    rows = pool.map(lambda choice: one_body(*choice), [(basis, transfer) for basis in BASES for transfer in TRANSFERS])
    text = table("One body. Errors and remainder of the ledger in per cent (of the largest energy that moves); s: seconds of processor time. Vortex and manufactured solution (vortex.yaml, mms.yaml): error of the "
                 "displacement and its slope; the vortex on 8 and 16 cells with 9 points a cell, the other on 16 and 32 with 4 and with 16. Ring (ring.yaml, R/h = 8): angular momentum lost in a turn, mean stress. Column under its own weight (self_weight.yaml, 25 cells): "
                 "settlement, stress half-way. Translation: a free block through 10^4 cells, the largest change of anything, or the cell up to which the energy is kept to 1e-6.",
                 ["basis", "transfer", "vortex", "slope", "remainder", "s", "mms, 4 a cell", "slope", "mms, 16 a cell", "slope", "remainder", "s", "ring: spin", "stress", "remainder", "s", "weight: settlement", "stress", "remainder", "s",
                  "translation", "s"], rows)
    choices = [(basis, transfer, "average") for basis in BASES for transfer in ("flip", "apic")] + [(basis, "flip", normal) for basis in ("gimp",) for normal in NORMALS[1:]]
    text += "\n" + table("Two bodies, multi-velocity contact with gap. Errors and remainder in per cent; seconds. Impact of bars (impact.yaml, 80 cells): force, duration, speed after. Block on an incline "
                         "(cases/block_on_incline): acceleration, friction force. Cylinder that rolls (cylinder.slow.yaml, R/h = 16): acceleration, spin. Discs (discs.yaml, R/h = 16) against 64: duration, exit speed, largest force.",
                         ["basis", "transfer", "normal", "impact: force", "duration", "speed", "remainder", "s", "incline: acceleration", "friction", "remainder", "s", "cylinder: acceleration", "spin", "remainder",
                          "s", "discs: duration", "exit", "largest force", "remainder", "s"], pool.map(lambda choice: contact_row(*choice), choices))
    text += "\n" + table("Rigid cylinder pressed into a block whose outline carries points, point-to-segment (hertz_points.yaml, a/h = 4): peak pressure and remainder in per cent, half width in per cent of a cell.",
                         ["basis", "transfer", "peak pressure", "half width", "remainder", "s"],
                         pool.map(lambda choice: hertz(*choice), [(basis, transfer) for basis in BASES for transfer in ("flip", "apic")]))
    finish(text, failures, PAGE, BEGIN, END, WRITE)
