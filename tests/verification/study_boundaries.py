#!/usr/bin/env python3
"""What boundaries throw back: the tables of docs/boundaries.md. usage: study_boundaries.py BUILD [columns] [large] [oblique] [pulse]

columns  P and S pulses of 10 kPa down 20 m of ground, meshes and bases, dashpots at the foot: velocity of the echo over that of the pulse
large    the same with 300 kPa, where the ground is pressed together by 1.3 % and the foot moves by 0.06 m: the ways side by side, springs and fixed feet, against the exact
         answer of finite strain (column_waves.py)
oblique  P waves under four angles on strips of elements and of points
pulse    a line load on 4 x 4 m of ground against 14 x 14 and 36 x 36 m: surface waves, drift and return"""
import csv
import math
import subprocess
import sys
import tempfile
from math import exp
from pathlib import Path

from column_waves import Column, Law

HERE = Path(__file__).resolve().parent
E, NU, RHO = 20e6, 0.25, 1500.0
CP = math.sqrt(E * (1 - NU) / ((1 + NU) * (1 - 2 * NU) * RHO))
CS = math.sqrt(E / (2 * (1 + NU) * RHO))
G = E / (2 * (1 + NU))


def ground(law):
    return f"materials:\n  ground: {{model: {law}, E: {E}, nu: {NU}, density: {RHO}}}\n"


GROUND = ground("linear-elastic")


def run(build, text, folder, *more):
    scene = Path(folder) / "scene.yaml"
    scene.write_text(text)
    out = Path(folder) / "out"
    subprocess.run([f"{build}/abut", "run", scene, "--quiet", "-j", "1", "-o", out, *more], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(out / "history.csv", newline="") as stream:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(stream)]


# ---- columns ---------------------------------------------------------------------------------------------------------------


def column(way, wave, p, h, foot, height=20.0, law="linear-elastic"):
    """A column of one way to compute it: q4, q8, or a basis of points with what else is said of it: "linear nodes", "gimp apic nodes"."""
    across = 0 if wave == "P" else 1  # the direction that is held
    held = "[0, null]" if wave == "P" else "[null, 0]"
    cell = h
    lines = ["abut: 1", "title: a column", "space: plane-strain", "time: {end: %g, cfl: 0.8}" % (0.05 + 2.6 * 20 / (CP if wave == "P" else CS) + 0.2)]
    c, d = (CP, "y") if wave == "P" else (CS, "x")
    if way in ("q4", "q6", "q8", "q8r"):
        wide = 2 * h if way in ("q8", "q8r") else h
        n = round(height / wide)
        lines += [ground(law) + "bodies:\n  column:\n    method: finite-elements\n    material: ground",
                  f"    mesh: {{box: [[0, 0], [{wide}, {height}]], elements: [1, {n}], type: {way}}}",
                  f"    fix: [{{where: {{x: [0, {wide}]}}, velocity: {held}}}]"]
        if foot == "fixed":
            lines[-1] = lines[-1][:-1] + ", {where: {side: bottom}, velocity: [0, 0]}]"
    else:
        sides = "roller" if wave == "P" else "fixed"
        if wave == "S":
            raise ValueError("S on points: columns of points that shear are held by fix")
        lines += [f"grid: {{from: [0, {-16 * cell}], to: [{2 * cell}, {height + 8 * cell}], cell: {cell}, sides: {{left: {sides}, right: {sides}}}}}",
                  ground(law) + "bodies:\n  column:\n    method: material-points\n    material: ground",
                  f"    shape: {{box: [[0, 0], [{2 * cell}, {height}]]}}\n    fill: {{rule: regular, per_cell: 4}}\n    basis: {way.split()[0]}\n    transfer: {'apic' if 'apic' in way else 'flip'}"]
        if foot == "fixed":
            lines[4] = lines[4].replace(f"from: [0, {-16 * cell}]", "from: [0, 0]").replace("sides: {", "sides: {bottom: fixed, ")
    load = f'"{"-" if wave == "P" else ""}{p}*exp(-((t-0.05)/0.021)^2)"'
    lines.append("loads:\n  - {body: column, where: {side: top}, traction: " + (f"[0, {load}]" if wave == "P" else f"[{load}, 0]") + "}")
    if foot not in ("fixed", "free"):
        at = ", at: nodes" if way.endswith("nodes") else ""
        lines.append(f"boundaries:\n  - {{on: column, where: {{side: bottom}}, boundary: {foot}{at}}}")
    lines.append(f"monitors:\n  - {{name: top, body: column, value: velocity.{d}, at: [0, {height}]}}\n  - {{name: middle, body: column, value: velocity.{d}, where: {{y: [{height - 10.5}, {height - 9.5}]}}}}"
                 f"\n  - {{name: foot, body: column, value: displacement.{d}, at: [0, 0]}}")
    return "\n".join(lines) + "\n", c


def echo(rows, c, p):
    """Largest velocity 10 m below the top, mean over 1 m, after the pulse has gone down through it, over that of the pulse; energy left over work done; displacement of the
    foot."""
    v = p / (RHO * c)
    gone = 0.05 + 10 / c + 0.09
    late = max(abs(row["middle"]) for row in rows if row["t"] > gone) / v
    left = (rows[-1]["kinetic"] + rows[-1]["strain"]) / rows[-1]["external"]
    return late, left, rows[-1]["foot"]


def columns(build, folder):
    print("| way | wave | elements or cells per metre | echo | without any (80 m) | energy left |\n| --- | --- | --- | --- | --- | --- |")
    for way, wave in [("q4", "P"), ("q4", "S"), ("q8", "P"), ("q8r", "S"), ("linear", "P"), ("gimp", "P"), ("cpdi", "P"), ("bspline2", "P"), ("gimp apic", "P"), ("bspline2 apic", "P"), ("bspline3 apic", "P")]:
        for h in (0.5, 0.25, 0.125):
            text, c = column(way, wave, 10e3, h, "viscous")
            late, left, _ = echo(run(build, text, folder), c, 10e3)
            text, _ = column(way, wave, 10e3, h, "free", 80.0)
            ripple, _, _ = echo(run(build, text, folder), c, 10e3)
            print(f"| {way} | {wave} | {1 / h:g} | {100 * late:.3f} % | {100 * ripple:.3f} % | {100 * max(left, 0):.4f} % |", flush=True)


PASSED, BACK = 0.05 + 10 / CP + 0.09, 0.05 + 50 / CP - 0.06  # s, 10 m below the top: the pulse has gone by; what came up comes down again
SPRINGS = "viscoelastic, r_b: 20"  # m


def exact(law, p, foot):
    return Column(Law(law, E, NU, RHO), 20.0, lambda t: p * exp(-(((t - 0.05) / 0.021) ** 2)), {"viscous": "viscous", "fixed": "fixed", SPRINGS: G / 40}[foot], 0.7, 4e-4)


def mean_velocity(answer):
    """Of the metre around 10 m below the top, as monitor `middle`; function of t."""
    places = [answer.velocity_at(9.5 + (i + 0.5) / 5) for i in range(5)]
    return lambda t: sum(velocity(t) for velocity in places) / 5


def against(build, folder, way, p, h, foot, answer, law="linear-elastic"):
    """Echo 10 m below the top, the exact one, the largest difference between the histories, all over p/(rho c); how far the foot's end is off the exact one, of it; energy left
    over work done."""
    rows = run(build, column(way, "P", p, h, foot, law=law)[0], folder)
    velocity, v = mean_velocity(answer), p / (RHO * CP)
    late = [(row["t"], -row["middle"], velocity(row["t"])) for row in rows if PASSED < row["t"] < BACK]
    end = answer.foot[min(int(rows[-1]["t"] / answer.time[1]), len(answer.foot) - 1)]
    return (max(abs(found) for _, found, _ in late) / v, max(abs(right) for _, _, right in late) / v, max(abs(found - right) for _, found, right in late) / v,
            -rows[-1]["foot"] / end - 1 if foot != "fixed" else 0.0, (rows[-1]["kinetic"] + rows[-1]["strain"]) / rows[-1]["external"])


LARGE = ("q4", "q8", "linear flip", "linear apic", "linear apic nodes", "gimp flip", "gimp apic", "gimp flip nodes", "gimp apic nodes", "cpdi flip", "cpdi apic", "bspline2 flip", "bspline2 apic")


def large(build, folder):
    print("| way | foot | echo: 4 | 8 | off the exact history: 4 | 8 | foot ends off by: 4 | 8 | energy left: 8 |\n" + "| --- " * 9 + "|")
    for foot in ("viscous", SPRINGS, "fixed"):
        answer = exact("linear-elastic", 300e3, foot)
        velocity, v = mean_velocity(answer), 300e3 / (RHO * CP)
        print(f"| exact | {foot} | {100 * max(abs(velocity(t)) for t in answer.time if PASSED < t < BACK) / v:.3f} % | | | | foot at {1e3 * answer.foot[int((0.25 + 52 / CP) / answer.time[1])]:.2f} mm | | |")
        for way in LARGE:
            if way.endswith("nodes") and (foot == "fixed" or way.startswith("gimp") and foot != "viscous"):
                continue  # springs at nodes without mass: refused
            both = []
            for h in (0.25, 0.125):
                try:
                    both.append(against(build, folder, way, 300e3, h, foot, answer))
                except subprocess.CalledProcessError:  # points leave the grid, where cells are crossed with a linear basis
                    both.append([math.nan] * 5)
            print(f"| {way} | {foot} | " + " | ".join(f"{100 * one[k]:.2f} %" for k in (0, 2, 3) for one in both) + f" | {100 * both[1][4]:.3f} % |", flush=True)


# ---- oblique -----------------------------------------------------------------------------------------------------------------


def oblique(build, folder):
    for waves in (5, 10):
        print(f"elements per c_p w: {waves}", flush=True)
        subprocess.run([HERE / "test_oblique.py", build, "--points", "--set", f"constants.waves={waves}"], check=False)


# ---- line load ----------------------------------------------------------------------------------------------------------------


def block(name, size, h, sides, at):
    """A quarter plane of size x size m of elements under a line load at its upper left corner (x = at), cut off by `sides`."""
    n = round(size / h)
    fix = f"{{where: {{side: left}}, velocity: [0, null]}}"
    boundary = ""
    if sides == "fixed":
        fix += f", {{where: {{side: bottom}}, velocity: [0, 0]}}, {{where: {{side: right}}, velocity: [0, null]}}"
    elif sides:
        boundary = "".join(f"  - {{on: {name}, where: {{side: {side}}}, boundary: {sides}}}\n" for side in ("bottom", "right"))
    body = (f"  {name}:\n    method: finite-elements\n    material: ground\n    mesh: {{box: [[{at}, {4 - size}], [{at + size}, 4]], elements: [{n}, {n}], type: q4}}\n"
            f"    fix: [{fix}]\n")
    return body, boundary


PLACES = {"A": (0, 4), "B": (2, 4), "C": (4, 4), "D": (0, 2), "E": (4, 2), "F": (0, 0)}


def line_load(build, folder, duration, end, h, large_size, kinds):
    a, t0, wide = 0.21 * duration, 0.5 * duration, h * math.floor(0.2 / h + 1e-9)
    names = {"large": ("viscous", large_size), **{k: (v, 4) for k, v in kinds.items()}}
    bodies = loads = boundaries = monitors = grid = ""
    for i, (name, (sides, size)) in enumerate(names.items()):
        at = 40 * i
        body, boundary = block(name, size, h, sides, at)
        points = name.startswith("points")
        if points:  # both halves, in cells of 2 h, so that points stand as far apart as nodes
            cell, others = 2 * h, [40 * k for k, other in enumerate(names) if other.startswith("points")]
            grid = f"grid: {{from: [{others[0] - 4 - 4 * cell}, {-4 * cell}], to: [{others[-1] + 4 + 4 * cell}, {4 + 4 * cell}], cell: {cell}}}\n"
            body = f"  {name}: {{method: material-points, material: ground, shape: {{box: [[{at - 4}, 0], [{at + 4}, 4]]}}, basis: gimp, transfer: apic}}\n"
            boundary += f"  - {{on: {name}, where: {{side: left}}, boundary: {sides}}}\n"
        bodies, boundaries = bodies + body, boundaries + boundary
        loads += f'  - {{body: {name}, where: {{side: top, x: [{at - wide * points}, {at + wide}]}}, traction: [0, "-1e4*exp(-((t-{t0})/{a})^2)"]}}\n'
        for place, (x, y) in PLACES.items():
            for d in "xy":
                monitors += f"  - {{name: {name}_{place}_{d}, body: {name}, value: displacement.{d}, at: [{at + x}, {y}]}}\n"
    text = (f"abut: 1\ntitle: line load\nspace: plane-strain\ntime: {{end: {end}, cfl: 0.9}}\n" + grid + GROUND + "bodies:\n" + bodies + "loads:\n" + loads + "boundaries:\n" + boundaries
            + "monitors:\n" + monitors)
    rows = run(build, text, folder)
    print("| place | " + " | ".join(f"{k}: error | at the end" for k in kinds) + " | large: peak | at the end |\n" + "| --- " * (2 * len(kinds) + 3) + "|")
    found = {}
    for place in PLACES:
        peak = max(math.hypot(row[f"large_{place}_x"], row[f"large_{place}_y"]) for row in rows)
        cells = []
        for name in kinds:
            rms = math.sqrt(sum((row[f"{name}_{place}_{d}"] - row[f"large_{place}_{d}"]) ** 2 for row in rows for d in "xy") / len(rows))
            last = math.hypot(rows[-1][f"{name}_{place}_x"], rows[-1][f"{name}_{place}_y"])
            found[name, place] = rms / peak, last / peak
            cells += [f"{100 * rms / peak:.1f} %", f"{100 * last / peak:.1f} %"]
        last = math.hypot(rows[-1][f"large_{place}_x"], rows[-1][f"large_{place}_y"])
        print(f"| {place} | " + " | ".join(cells) + f" | {peak:.3g} m | {100 * last / peak:.1f} % |", flush=True)
    return found


KINDS = {"fixed": "fixed", "viscous": "viscous", "viscoelastic": "viscoelastic, r_b: 4", "points_viscous": "viscous", "points_viscoelastic": "viscoelastic, r_b: 4"}


def pulse(build, folder):
    print("pulse of 0.03 s:")
    line_load(build, folder, 0.03, 0.2, 0.1, 14, KINDS)
    print("pulse of 0.3 s:")
    line_load(build, folder, 0.3, 0.8, 0.2, 36, KINDS)


def main():
    build, wanted = sys.argv[1], sys.argv[2:] or ["columns", "large", "oblique", "pulse"]
    with tempfile.TemporaryDirectory() as folder:
        for name in wanted:
            print(f"\n{name}\n", flush=True)
            {"columns": columns, "large": large, "oblique": oblique, "pulse": pulse}[name](build, folder)


if __name__ == "__main__":
    main()
