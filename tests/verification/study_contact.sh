#!/bin/bash
# cost: 150
# Contact on several meshes with the rates of convergence, and what the classical form of contact and other updates do to the same impact. It prints; it fails only
# where the default gets worse with a finer mesh. study_contact.sh BUILD
set -eu
build=${1:?the build folder}
scratch=${ABUT_SCRATCH:-$(mktemp -d)}
python3 - "$build/abut" "$scratch" <<'PYTHON'
import csv
import json
import math
import subprocess
import sys

abut, scratch = sys.argv[1:]
number = 0


def run(scene, *settings):
    """errors by the name of the expect, and the last row of the history; None where the run failed."""
    global number
    number += 1
    folder = f"{scratch}/{number}"
    command = [abut, "run", f"tests/verification/{scene}.yaml", "--quiet", "-j", "1", "-o", folder]
    for setting in settings:
        command += ["--set", setting]
    if subprocess.run(command, capture_output=True).returncode != 0:
        return None
    with open(f"{folder}/summary.json") as stream:
        expects = json.load(stream)["expects"]
    with open(f"{folder}/history.csv") as stream:
        rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
    return {e["name"]: e for e in expects}, rows[-1]


def rates(errors):
    return "  ".join("    -" if b == 0 or a == 0 else f"{math.log2(a / b):5.2f}" for a, b in zip(errors, errors[1:]))


worse = 0


def ladder(title, scene, meshes, names, *settings):
    global worse
    print(f"\n{title}\n{'':40}" + "".join(f"{m.split('=')[1]:>10}" for m in meshes) + "   rates of halving")
    runs = [run(scene, m, *settings) for m in meshes]
    for name in names:
        errors = [math.nan if r is None or r[0][name]["error"] is None else r[0][name]["error"] for r in runs]
        print(f"{name:40}" + "".join(f"{e:10.2e}" for e in errors) + "   " + rates(errors))
        if not errors[-1] <= max(errors[0], runs[-1][0][name]["tolerance"]):
            worse += 1
            print(f"{'':40}worse on the finest mesh than on the coarsest")


cells = ["constants.cells=20", "constants.cells=40", "constants.cells=80", "constants.cells=160"]
gates = ["force begins when the surfaces meet", "force", "duration", "impulse", "speed of the first bar", "energy kept", "ledger closes"]
for ratio in (1, 10):
    ladder(f"impact of two bars, impedances 1 to {ratio}; errors for cells in a bar", "impact", cells, gates, f"constants.ratio={ratio}")
ladder("impact of two bars, grid moved by 0.37 of a cell", "impact", cells, gates, "constants.shift=0.37")
discs = [f"constants.cells={n}" for n in (8, 16, 32, 64)]
ladder("two discs; errors for cells in a radius against the finest", "discs", discs, ["duration", "exit speed of the left disc", "impulse", "largest force", "energy kept", "ledger closes"])
ladder("cylinder that rolls; errors for the cell", "cylinder.slow", [f"constants.h={h}" for h in (0.125, 0.0625, 0.03125)], ["acceleration", "rate of spin", "way"], "constants.mu=0.3")

print("\nimpact of two equal bars, 40 cells: contact, basis, update")
print(f"{'':34}{'acts at gap':>12}{'force':>9}{'duration':>10}{'impulse':>9}{'energy':>10}")
for gap in ("distance", "none"):
    for basis in ("gimp", "linear"):
        for update in ("musl", "usf", "usl"):
            name = f"{'gap' if gap == 'distance' else 'velocity only'}, {basis}, {update}"
            done = run("impact", "constants.cells=40", f"contact[0].gap={gap}", *(f"bodies.{b}.{k}={v}" for b in "ab" for k, v in (("basis", basis), ("update", update))))
            if done is None:
                print(f"{name:34}  the run blew up")
                continue
            expects, last = done
            begin = expects["force begins when the surfaces meet"]
            acts = math.nan if begin["value"] is None else (begin["reference"] - begin["value"]) / 25
            force, time, impulse = (expects[k]["value"] / expects[k]["reference"] for k in ("force", "duration", "impulse"))
            print(f"{name:34}{acts:10.2f} h{force:9.3f}{2 * time:10.3f}{impulse:9.3f}{float(last['energy']) / expects['energy kept']['reference']:10.3f}")
sys.exit(f"{worse} worse" if worse else 0)
PYTHON
