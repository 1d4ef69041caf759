#!/bin/bash
# cost: 45
# Coupling leaks nothing and knows no order: the impact of two bars with elements of 1/8 to 8 cells, bodies swapped, the grid moved
# under them, both finders, every type of element. Force, duration, energy and momentum are held each time.
# test_coupling.sh BUILD: half of them; with ABUT_ALL=yes (tests/run --all) all
set -eu
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
/usr/bin/env python3 - "$build/abut" "$scratch" <<'PYTHON'
import json
import os
import subprocess
import sys

abut, scratch = sys.argv[1:]
CELLS = 40
ALL = os.environ.get("ABUT_ALL", "no") != "no"
runs = wrong = 0


def run(scene, *settings, cells=CELLS):
    global runs
    runs += 1
    command = [abut, "run", f"tests/verification/{scene}.yaml", "--quiet", "-j", "1", "-o", f"{scratch}/{runs}", "--set", f"constants.cells={cells}", "--set", "time.cfl=0.9"]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    with open(f"{scratch}/{runs}/summary.json") as stream:
        return json.load(stream)


def hold(title, summary, size):
    """The coarser of cell and element resolves the wave: errors of duration and energy grow with it, the force hardly does, and nothing gets through."""
    global wrong
    coarse = max(size, 1)
    bound = {"force begins when the surfaces meet": 0.1, "force": 0.01 if coarse < 8 else 0.025, "duration": 0.015 + 0.006 * coarse,
             "speed of the second bar": 0.02 + 0.008 * coarse, "energy kept": 0.02 + 0.007 * coarse, "momentum kept": 1e-12, "no penetration": 2e-3}
    error = {e["name"]: e["error"] for e in summary["expects"]}
    bad = [name for name, most in bound.items() if error[name] is None or not error[name] <= most]
    made = summary["ledger"]["remainder"] / summary["ledger"]["start"]["kinetic"]
    if made > 1e-4:
        bad.append(f"energy made {made:.2g}")
    print(f"{title:58}" + "  ".join(f"{name.split()[0]} {error[name]:.1e}" for name in bound) + ("" if not bad else f"   WRONG: {', '.join(bad)}"))
    wrong += bool(bad)


for finder in ("multi-velocity", "point-to-segment"):
    algorithm = f"contact[0].algorithm={finder}"
    for scene in ("impact_mpm_fe", "impact_fe_mpm", "impact_fe_fe"):
        for size in (0.25, 0.5, 1, 2, 4, 8) if ALL else (0.25, 2, 8):
            if size == 0.25 and scene != "impact_mpm_fe":
                continue
            hold(f"{scene} {finder} elements of {size} cells", run(scene, algorithm, f"constants.size={size}"), size)
    hold(f"impact_mpm_fe {finder} elements of 1/8, 20 cells", run("impact_mpm_fe", algorithm, "constants.size=0.125", cells=CELLS // 2), 2)
    hold(f"impact_mpm_fe {finder} grid moved by 0.37", run("impact_mpm_fe", algorithm, "constants.shift=0.37"), 1)
    hold(f"impact_fe_fe {finder} grid moved by 0.37", run("impact_fe_fe", algorithm, "constants.shift=0.37"), 1)
    for element in ("q4r", "q6", "q8", "q8r"):
        if ALL:
            hold(f"impact_mpm_fe {finder} {element}", run("impact_mpm_fe", algorithm, f"bodies.b.mesh.type={element}"), 1)
        hold(f"impact_mpm_fe {finder} {element} 1:10", run("impact_mpm_fe", algorithm, f"bodies.b.mesh.type={element}", "constants.ratio=10"), 2)
print(f"{runs} runs, {wrong} wrong")
sys.exit(1 if wrong else 0)
PYTHON
