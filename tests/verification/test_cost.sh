#!/bin/bash
# cost: 4
# Pay only for the scene: a key that says no leaves plan and results as they are without it, and a feature that is on is seen in the plan. test_cost.sh BUILD
set -u
build=$(realpath "${1:?the build folder}")
here=$(cd "$(dirname "$0")" && pwd)
cd "${ABUT_SCRATCH:-$(mktemp -d)}" || exit 1
export PYTHONPATH=$here/../bench ABUT=$build/abut
python3 - <<'PYTHON'
import json, os, subprocess, sys
import cost_scenes

missed = 0


def history():
    """The rows of history.csv without the name of their stage, which only scenes with stages have."""
    rows = [line.split(",") for line in open("out/history.csv").read().splitlines()]
    kept = [k for k, name in enumerate(next(row for row in rows if row[0] == "t")) if name != "stage"]
    return [[row[k] for k in kept] if len(row) > kept[-1] else row for row in rows]


def abut(scene):
    """Plan of a scene, and the history and ledger that its run leaves."""
    cost_scenes.write(scene, "scene.yaml")
    plan = json.loads(subprocess.run([os.environ["ABUT"], "plan", "scene.yaml", "--json"], capture_output=True, text=True, check=True).stdout)
    subprocess.run([os.environ["ABUT"], "run", "scene.yaml", "--quiet", "-j", "1", "-o", "out"], check=True)
    summary = json.load(open("out/summary.json"))
    paid = [[(b["name"], b["bytes"], b["fields"], b["passes"]) for b in plan["bodies"]], [c["passes"] for c in plan["contacts"]], plan["boundary_passes"],
            [p["name"] for p in plan["plugins"]]]
    return paid, (history(), summary["ledger"], summary["motion"]), set(summary["phase_seconds"])


def must(what, good):
    global missed
    missed += not good
    print(f"{'passed' if good else 'MISSED'}  {what}")


for name, without, within in cost_scenes.switched_off(8, 12):
    plain, off = abut(without), abut(within)
    must(f"{name}: the same results", plain[1] == off[1])
    if "cells apart" not in name:  # bodies that may meet are watched
        must(f"{name}: the same arrays, passes and plugins", plain[0] == off[0])
        must(f"{name}: the same phases", plain[2] == off[2])
    else:
        must(f"{name}: the same arrays", plain[0][0] == off[0][0])

costly = {"von Mises that stays elastic", "body force, a formula of t, x, y", "`f_bar: cell`", "`transfer: apic`", "`basis: cpdi`", "multi-velocity, friction"}
for group, name, without, within in cost_scenes.switched_on(8, 12):
    if name in costly:
        costly.discard(name)
        must(f"{name}: the plan says what it pays for", abut(without)[0] != abut(within)[0])
must(f"rows that this test asks for are there {costly or ''}", not costly)
sys.exit(missed > 0)
PYTHON
