#!/usr/bin/python3
"""Drives every scene of this folder to its extremes and puts what comes out into docs/stability.md: write_docs.py BUILD [NAME ...]

With names, only those scenes are driven anew; what others gave in an earlier call is taken from BUILD/tests/stability, and run where it is not there. Runs that are there already,
of the same scene and program, are not run again, so a second call takes no time."""
import glob
import json
import os
import shutil
import subprocess
import sys

here = os.path.dirname(os.path.abspath(__file__))
root = os.path.dirname(os.path.dirname(here))
sys.path.insert(0, os.path.join(os.path.dirname(here), "verification"))
import pages  # noqa: E402

build, names = sys.argv[1], sys.argv[2:]
parts, rows, failed = [], {"yes": 0, "not yet": 0, "no": 0}, []
os.chdir(root)
for scene in sorted(glob.glob("tests/stability/*.yaml")):
    if "\nextremes:" not in open(scene).read():
        continue
    name = os.path.basename(scene).removesuffix(".yaml")
    folder = os.path.join(build, "tests", "stability", name)
    if not names or name in names or not os.path.exists(folder + "/extremes.json"):
        done = subprocess.run([build + "/abut", "extremes", scene, "-o", folder, "-j", "1", "--quiet"], capture_output=True, text=True)
        if done.returncode != 0:
            failed.append(f"{scene}: exit {done.returncode}: {done.stderr.strip()}")
            continue
        with open(folder + "/table.txt", "w") as stream:
            stream.write(done.stdout)
    found = json.load(open(folder + "/extremes.json"))
    text = open(folder + "/table.txt").read()
    table = [line for line in text.splitlines() if line.startswith("|")]
    for i, q in enumerate(found["quantities"]):  # the terminal's table cuts long names off
        cells = table[2 + i].split(" | ")
        assert q["name"].startswith(cells[0][2:].removesuffix("...")), (q["name"], cells[0])
        table[2 + i] = " | ".join(["| " + q["name"]] + cells[1:])
    parts.append(f"### {found['title']}\n\n    abut extremes {scene}\n\n" + "\n".join(table) + "\n")
    notes = [line.strip() for line in text.splitlines() if "does not go one way" in line]
    for q in found["quantities"]:
        verdict = "yes" if q["holds"] else "not yet" if q["open"] else "no"
        rows[verdict] += 1
        if verdict == "not yet":
            notes.append(f"{q['name']} does not hold yet: {q['open']}")
        if verdict == "no":
            failed.append(f"{scene}: {q['name']} does not hold: {q['fault']}")
        if q["holds"] and q["open"]:
            failed.append(f"{scene}: {q['name']} holds now: take `open` away from it")
    if notes:
        parts.append("\n".join("- " + note for note in notes) + "\n")
    if found["map"]:
        shutil.copy(folder + "/map.svg", f"docs/stability_{name.split('.')[0]}.svg")
        parts.append(f"![{found['title']}](stability_{name.split('.')[0]}.svg)\n")
head = f"{sum(rows.values())} rows: {rows['yes']} hold, {rows['not yet']} do not yet, and say so" + (f", {rows['no']} do not" if rows["no"] else "") + ".\n"
pages.finish("\n".join([head] + parts), failed, "docs/stability.md", "<!-- made by tests/stability/write_docs.py: begin -->", "<!-- made by tests/stability/write_docs.py: end -->", True)
