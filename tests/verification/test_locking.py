#!/usr/bin/python3
# cost: 22
"""Locking, and what f_bar does about it: test_locking.py BUILD. Cook's membrane and a thick tube of points, nearly incompressible and not, with and without; how rough
their pressures are; a pressed block carried across cells; a vibrating block on two meshes; a block without stress that flies; runs close
to the critical step. Tables of more: study_locking.py."""
import os
import sys

from pressures import roughness
from runs import Runs, errors

here = os.path.dirname(os.path.abspath(__file__))
runs = Runs(os.path.realpath(sys.argv[1]))
missed = 0
try:
    import h5py  # noqa: F401
except ImportError:
    print("python3-h5py is not there")
    sys.exit(77)


def run(scene, body, f_bar, settings={}, may_fail=False):
    return runs.run(f"{here}/{scene}.yaml", {f"bodies.{body}.f_bar": f_bar, **settings}, may_fail)


def hold(label, value, sign, limit):
    global missed
    good = value <= limit if sign == "<=" else value > limit
    missed += not good
    print(f"{label:70} {value:9.2e} {sign:2} {limit:.0e}{'' if good else '  MISSED'}")


def cook(label, f_bar, settings, limit, within, between, sign="<=", cells=12):
    settings = {"constants.n": cells, **settings}
    ran = run("cook_points", "panel", f_bar, settings)
    if ran:
        h = 48 / cells
        rough = roughness(ran[2], "panel", h, (0, -2 * h))
        hold(f"cook {label}: middle of the right side", errors(ran[0])["middle of the right side"], sign, limit)
        hold(f"cook {label}: pressure within cells", rough[0], sign, within)
        hold(f"cook {label}: pressure between cells", rough[1], "<=", between)


def tube(label, f_bar, settings, limit, pressure, sign="<="):
    ran = run("tube_points", "tube", f_bar, {"constants.n": 4, **settings})
    if ran:
        found = errors(ran[0])
        hold(f"tube {label}: u at a by the work there", found["work of the pressure is that of u at a"], sign, limit)
        hold(f"tube {label}: u everywhere", found["u everywhere"], sign, limit)
        hold(f"tube {label}: pressure", found["pressure"], sign, pressure)


# Locked without; with, 1 % on 12 cells and 2 % on 8, on any smooth basis. What is left between cells is next to the corner of the clamp, where the pressure has no bound.
cook("without", "false", {}, 0.3, 1, 10, ">")
cook("patch", "patch", {}, 1e-2, 1e-2, 0.1)
cook("patch, 8 cells", "patch", {}, 2e-2, 1e-2, 0.15, cells=8)
cook("cell, 8 cells", "cell", {}, 2e-2, 1e-2, 0.25, cells=8)
cook("patch, 8 cells, quadratic splines", "patch", {"bodies.panel.basis": "bspline2"}, 2e-2, 1e-2, 0.2, cells=8)
third = {"materials.m.nu": "1/3", "constants.rise": 21.5246, "constants.along": 0.862, "constants.up": 0.126, "constants.ramp": 3000}
cook("without, nu = 1/3, 16 cells", "false", third, 1e-2, 0.3, 0.1, cells=16)
cook("patch, nu = 1/3, 16 cells", "patch", third, 3e-2, 0.1, 0.1, cells=16)
tube("without", "false", {}, 0.2, 1, ">")
tube("cell", "cell", {}, 3e-2, 0.1)
tube("patch, nu = 0.3", "patch", {"constants.nu": 0.3}, 3e-2, 3e-2)

# Where points of a pressed body cross cells: the linear basis loses the pressure, patches lessen that, smooth bases need nothing.
crossing = {}
for basis in ("linear", "gimp", "bspline2"):
    for f_bar in ("false", "patch"):
        ran = run("pressed_carried", "block", f_bar, {"bodies.block.basis": basis})
        if ran:
            crossing[basis, f_bar] = errors(ran[0])["pressure"]
if len(crossing) == 6:
    hold("carried, linear, without: pressure", crossing["linear", "false"], ">", 1)
    hold("carried, linear, patch against without: pressure", crossing["linear", "patch"] / crossing["linear", "false"], "<=", 0.5)
    hold("carried, gimp, patch: pressure", crossing["gimp", "patch"], "<=", 2e-3)
    hold("carried, bspline2, patch: pressure", crossing["bspline2", "patch"], "<=", 2e-3)

# Energy: what is lost falls with the mesh. Motion without strain stays without stress (turning: tests/unit/test_rotation.c).
lost = {}
for n in (8, 16):
    ran = run("vibrating_block", "block", "patch", {"constants.n": n})
    if ran:
        lost[n] = errors(ran[0])["ledger closes"]
if len(lost) == 2:
    hold("vibrating, patch, 8 cells: remainder", lost[8], "<=", 1e-2)
    hold("vibrating, patch, 16 cells: remainder against 8", lost[16] / lost[8], "<=", 0.5)
ran = run("translation", "block", "patch")
if ran:
    hold("block without stress carried 100 cells: largest error", max(errors(ran[0]).values()), "<=", 1e-10)

# As long steps as without: at 0.95 of the critical one no more energy goes astray.
for basis in ("gimp", "bspline2", "bspline3"):
    near = {}
    for f_bar in ("false", "patch"):
        ran = run("vibrating_block", "block", f_bar, {"constants.n": 8, "time.cfl": 0.95, "constants.vx": 0, "bodies.block.basis": basis}, may_fail=True)
        near[f_bar] = errors(ran[0])["ledger closes"] if ran else 1e300
    hold(f"at 0.95 of the critical step, {basis}: remainder", near["patch"], "<=", 3e-2)
    hold(f"at 0.95 of the critical step, {basis}: remainder against without", near["patch"] / near["false"], "<=", 1)

for line in runs.failures:
    print(f"FAILED: {line}")
print(f"{missed} missed")
sys.exit(1 if missed or runs.failures else 0)
