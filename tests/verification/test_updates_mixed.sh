#!/bin/bash
# cost: 3
# Bodies in contact may have updates of their own: one that strains first (usf, usavg) against one that does not (usl, musl). An impact of bars keeps its energy, force and speeds
# as well as where both have either, on two meshes, by both algorithms, and all of its momentum. test_updates_mixed.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
root=$(cd "$(dirname "$0")/../.." && pwd)
cd "${ABUT_SCRATCH:-$(mktemp -d)}" || exit 1
export ABUT=$build/abut SCENE=$root/tests/verification/impact.yaml
python3 - <<'PYTHON'
import json, os, subprocess, sys

missed = 0


def impact(cells, algorithm, first, second):
    """Of a run: what it makes (above 0) or loses of the energy, and its errors by the name of their expect."""
    more = {"constants.cells": cells, "constants.gap": 0.6, "contact[0].algorithm": algorithm, "bodies.a.update": first, "bodies.b.update": second}
    done = subprocess.run([os.environ["ABUT"], "run", os.environ["SCENE"], "--quiet", "-j", "1", "-o", "out", *(word for path, value in more.items() for word in ("--set", f"{path}={value}"))],
                          capture_output=True, text=True)
    if done.returncode:
        return None, {}
    summary = json.load(open("out/summary.json"))
    return summary["ledger"]["remainder"] / 5e-8, {e["name"]: e["error"] for e in summary["expects"]}


for cells, algorithms in (10, ("multi-velocity", "point-to-segment")), (20, ("multi-velocity",)):
    for algorithm in algorithms:
        same = {update: impact(cells, algorithm, update, update) for update in ("usl", "musl", "usf", "usavg")}
        for first, second in ("musl", "usf"), ("usf", "musl"), ("usavg", "musl"), ("usl", "usavg"):
            made, errors = impact(cells, algorithm, first, second)
            good = made is not None and min(same[first][0], same[second][0]) - 0.01 < made < 0 and errors["momentum kept"] < 1e-12
            good = good and all(errors[name] < 1.1 * max(same[first][1][name], same[second][1][name]) + 2e-3 for name in ("force", "speed of the first bar", "speed of the second bar"))
            missed += not good
            print(f"{'passed' if good else 'MISSED'}  {cells} cells, {algorithm}, {first} against {second}: {'broke off' if made is None else f'{100 * made:+.1f} % of the energy'}")
sys.exit(missed > 0)
PYTHON
