#!/usr/bin/python3
"""The atlas: what accuracy costs, and where it ends, on six scenes: study_atlas.py BUILD [--write] [--only NAME] [--keep FOLDER]. With --write the tables go to docs/atlas.md and
the pictures to docs/atlas/. Runs that FOLDER holds from an earlier call are not made again. About ten minutes of processor time."""
import argparse
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile

from pages import table

HOUSE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BEGIN, END = "<!-- made by study_atlas.py, {}: begin -->", "<!-- made by study_atlas.py, {}: end -->"

SCENES = {  # scene, arguments of trade, quantities of extremes
    "bar": ("tests/verification/bar_1.yaml",
            ["--vary", "constants.cells=12,25,50", "--vary", "bodies.bar.basis=linear,gimp,bspline2", "--vary", "bodies.bar.update=usl,musl,usf"],
            '[{name: dt c/h, set: time.dt, value: "@*h/c", from: 0.2, to: 1.6, right_to: 0.8}, {name: speed, set: constants.v0, from: 1e-6, to: 1}]'),
    "impact": ("tests/verification/impact.yaml",
               ["--vary", "constants.cells=10,20,40,80", "--vary", "contact[0].algorithm=point-to-segment,multi-velocity", "--vary", "time.cfl=0.5,0.25"],
               "[{name: impedance ratio, set: constants.ratio, from: 1, to: 1e4}]"),
    "incline": ("cases/block_on_incline/scene.yaml",
                ["--vary", "contact[0].gap=none,distance", "--vary", "contact[0].normal=volume-gradient,average,stiffer", "--vary", "time.cfl=0.5,0.25"],
                "[{name: friction, set: constants.mu, from: 0.01, to: 1e4, rungs: 7}]"),
    "hertz": ("tests/verification/hertz.yaml", ["--vary", "constants.n=0.15,0.25,0.35", "--vary", "bodies.cylinder.mesh.type=q8r,q8", "--vary", "time.cfl=0.8,0.4"],
              "[{name: load, set: constants.P, from: 1e3, to: 1e6, rungs: 4, until: 0.2}]"),
    "beam": ("cases/block_on_beam/scene.yaml",
             ["--vary", "contact[0].algorithm=multi-velocity,point-to-segment", "--vary", "bodies.beam.mesh.type=q6,q8r,q8", "--vary", "bodies.block.basis=linear,gimp"],
             "[{name: dt, set: time.dt, from: 2e-4, to: 4e-3, scale: log, rungs: 5, until: 0.2, right_to: 1e-3}]"),
    "punch": ("tests/verification/punch.yaml",
              ["--vary", "constants.cells=2,4,8,16", "--vary", "bodies.ground.f_bar=false,cell,patch", "--vary", "contact[0].algorithm=multi-velocity,point-to-segment"],
              "[{name: nu, set: constants.nu, values: [0, 0.2, 0.3, 0.4, 0.49]}, {name: speed of the push, set: constants.push, from: 0.02, to: 1}, "
              "{name: way of the punch over B, set: constants.sink, from: 1e-4, to: 0.1}]"),
}


def words(settings):
    return ", ".join(f"{path.split('.')[-1]} {value}" for path, value in settings.items())


def run(command):
    done = subprocess.run(command, cwd=HOUSE, capture_output=True, text=True)
    return done.stdout, done.stderr.strip() if done.returncode else None


def trade(abut, name, scene, settings, folder, failures):
    command = ["trade", scene, *settings, "--path", "--tolerance", "0.02", "--seconds", "5"]
    said, wrong = run([abut, *command, "-q", "-o", folder])
    if wrong is not None:
        failures.append(f"trade of {name}: {wrong}")
        return ""
    with open(f"{folder}/trade.json") as stream:
        found = json.load(stream)
    made = [r for r in found["runs"] if r["outcome"] == "done"]
    front = sorted((r for r in made if r["front"]), key=lambda r: r["cpu_seconds"])
    rows = [[words(r["settings"]), f"{r['error']:.2g}", max(r["errors"], key=lambda k: r["errors"][k]), f"{r['cpu_seconds']:.2g}", f"{r['peak_bytes'] / 1e6:.0f}", f"{r['remainder']:+.1e}"]
            for r in front]
    end = [line.strip() for line in said.splitlines() if line.startswith("  The cheapest") or line.startswith("  No run")]
    given = [line.strip() for line in said.splitlines() if "given up" in line]
    text = f"    abut {shlex.join(command)}\n\n{len(made)} of {len(found['runs'])} combinations were run. The front:\n\n"
    text += table("", ["settings", "error", "of", "cpu, s", "MB", "ledger's remainder"], rows).lstrip("\n")
    return text + "\n" + "\n".join([*given, *end]) + f"\n\n![error against cost](atlas/{name}.svg)\n"


def extremes(abut, name, scene, quantities, folder, failures):
    command = ["extremes", scene, "--set", f"extremes={{vary: {quantities}, limit: 600}}"]
    said, wrong = run([abut, *command, "-q", "-o", folder])
    if wrong is not None:
        failures.append(f"extremes of {name}: {wrong}")
        return ""
    return f"    abut {shlex.join(command)}\n\n```\n{said.strip(chr(10))}\n```\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--only", choices=sorted(SCENES))
    parser.add_argument("--part", choices=["trade", "extremes"])
    parser.add_argument("--keep", default=os.environ.get("ABUT_SCRATCH") or tempfile.mkdtemp())
    options = parser.parse_args()
    abut, page, failures = os.path.realpath(f"{options.build}/abut"), os.path.join(HOUSE, "docs", "atlas.md"), []
    for name, (scene, settings, quantities) in SCENES.items():
        if options.only not in (None, name):
            continue
        for part, work, what in (("trade", trade, settings), ("extremes", extremes, quantities)):
            if options.part not in (None, part):
                continue
            folder = os.path.join(os.path.abspath(options.keep), f"{name}-{part}")
            text = work(abut, name, scene, what, folder, failures)
            print(text, flush=True)
            if not options.write or not text:
                continue
            if part == "trade":
                shutil.copy(f"{folder}/trade.svg", os.path.join(HOUSE, "docs", "atlas", f"{name}.svg"))
            with open(page) as stream:
                whole = stream.read()
            begin, end = BEGIN.format(f"{name} {part}"), END.format(f"{name} {part}")
            first, last = whole.index(begin) + len(begin), whole.index(end)
            with open(page, "w") as stream:
                stream.write(whole[:first] + "\n\n" + text.replace(os.path.abspath(options.keep), "results") + "\n" + whole[last:])
    for line in failures:
        print(f"FAILED: {line}", file=sys.stderr)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
