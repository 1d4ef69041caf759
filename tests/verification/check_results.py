#!/usr/bin/python3
"""Opens the results of a run as others do (meshio's XDMF time-series reader, h5py) and compares values, not only shapes.

    check_results.py DIR [--partial] [COLUMN=FIELD.COMPONENT:BODY:GATHER ...]

Every frame of results.xdmf and results_<body>.xdmf must say the same as results.h5, every dataset must have its unit and its components, times
must rise and be rows of history.csv. A body with elements must show them as such, with nodes that exist, counter-clockwise corners and the middles of the
sides between them (in the first frame); any other body one vertex a point. COLUMN=... compares a column of history.csv with a field, gathered over a body's points: mean, max, min or sum
(block_x=position.x:block:mean). --partial: the run was killed; there is no summary.json.
"""
import csv
import glob
import json
import os
import sys

import h5py
import meshio
import numpy

COMPONENTS = {"position": "x y z", "velocity": "x y z", "displacement": "x y z", "stress": "xx yy zz xy yz xz"}
TOPOLOGY = {"vertices", "connectivity"}
CORNERS = "corner0 corner1 corner2 corner3"
NODES = {"quad": CORNERS, "quad8": CORNERS + " middle01 middle12 middle23 middle30"}
problems = []


def check(holds, text):
    if not holds:
        problems.append(text)


def same(a, b):
    return numpy.array_equal(numpy.asarray(a, dtype=float), numpy.asarray(b, dtype=float), equal_nan=True)


def check_group(path, group):
    for name, data in group.items():
        if not isinstance(data, h5py.Dataset):
            continue
        check("unit" in data.attrs, f"{path}/{name} has no unit")
        names = data.attrs.get("components", b"").decode().split()
        width = data.shape[1] if data.ndim == 2 else 1
        check(len(names) == width, f"{path}/{name}: {width} components are named {names}")
        if name in COMPONENTS:
            check(names == COMPONENTS[name].split(), f"{path}/{name}: components are {names}")
    check({"position", "id", "body"} <= set(group), f"{path}: position, id or body is missing")
    check(len(set(group["id"][()])) == len(group["id"]) or path.endswith("/all"), f"{path}: an id stands twice")


def check_h5(file):
    """Frames in order; `all` is the bodies one after the other."""
    frames = sorted(file)
    check(frames == [f"frame_{k:06d}" for k in range(len(frames))], f"results.h5: frames are {frames[:3]} ...")
    check(len(frames) > 0, "results.h5 has no frame")
    times = [file[f].attrs["time"] for f in frames]
    check(all(a < b for a, b in zip(times, times[1:])), "times of the frames do not rise")
    for name in frames:
        frame = file[name]
        bodies = sorted((b for b in frame if b != "all" and len(frame[b]["body"])), key=lambda b: frame[b]["body"][0])
        for body in frame:
            check_group(f"{name}/{body}", frame[body])
        for field, data in frame["all"].items():
            if field in TOPOLOGY:
                continue
            parts = [frame[b][field][()] if field in frame[b] else numpy.full((len(frame[b]["id"]),) + data.shape[1:], numpy.nan) for b in bodies]
            if parts:
                check(same(data[()], numpy.concatenate(parts)), f"{name}/all/{field} is not its bodies' rows one after the other")
    return frames


def check_elements(path, block, points, stored):
    """Elements of the first frame: as in results.h5, with areas that are not turned over and middles that lie on their side of the element."""
    nodes = block.data
    check(block.type in NODES, f"{path}: elements are of type {block.type}")
    check(same(nodes, stored["connectivity"][()]), f"{path}: elements are not those of results.h5")
    check(stored["connectivity"].attrs["components"].decode() == NODES.get(block.type), f"{path}: connectivity has other components than {block.type}")
    if not (len(nodes) and 0 <= nodes.min() and nodes.max() < len(points)):
        check(False, f"{path}: elements have nodes that do not exist")
        return
    check(len(numpy.unique(nodes)) == len(points), f"{path}: some nodes belong to no element")
    x, y = points[nodes[:, :4], 0], points[nodes[:, :4], 1]
    area = 0.5 * ((x[:, 2] - x[:, 0]) * (y[:, 3] - y[:, 1]) - (x[:, 3] - x[:, 1]) * (y[:, 2] - y[:, 0]))
    check((area > 0).all(), f"{path}: corners of {int((area <= 0).sum())} elements do not go round counter-clockwise")
    for k in range(4, nodes.shape[1]):
        a, b, middle = (points[nodes[:, n]] for n in (k - 4, (k - 3) % 4, k))
        away = numpy.linalg.norm(middle - 0.5 * (a + b), axis=1)
        check((away < 0.26 * numpy.linalg.norm(b - a, axis=1)).all(), f"{path}: node {k} of an element is not near the middle of its side")


def check_xdmf(path, group, file, frames, partial):
    with meshio.xdmf.TimeSeriesReader(path) as reader:
        points, cells = reader.read_points_cells()
        check(same(points, file[frames[0]][group]["position"][()]), f"{path}: points are not those of the first frame")
        check(len(cells) == 1, f"{path}: cells are of {len(cells)} kinds")
        if "connectivity" in file[frames[0]][group]:
            check_elements(path, cells[0], points, file[frames[0]][group])
        else:
            check(cells[0].type == "vertex" and len(cells[0].data) == len(points), f"{path}: not one vertex a point")
            check(same(cells[0].data[:, 0], numpy.arange(len(points))), f"{path}: vertices are not 0, 1, 2 ...")
        check(reader.num_steps == len(frames) or (partial and len(frames) - 1 <= reader.num_steps), f"{path}: {reader.num_steps} of {len(frames)} frames")
        for k in range(min(reader.num_steps, len(frames))):
            time, data, _ = reader.read_data(k)
            stored = file[frames[k]][group]
            check(time == file[frames[k]].attrs["time"], f"{path}: frame {k} has time {time}")
            check(set(data) == set(stored) - TOPOLOGY, f"{path}: frame {k} has {sorted(data)}")
            for name, values in data.items():
                check(values.shape == stored[name].shape and same(values, stored[name][()]), f"{path}: frame {k}: {name} differs from results.h5")


def read_history(path):
    with open(path, newline="") as stream:
        text = stream.read()
    text = text[: text.rfind("\n") + 1]  # a killed run may have left part of a row
    rows = list(csv.reader(text.splitlines()))
    return rows[0], [[float(v) for v in row] for row in rows[1:]]


def check_column(wanted, header, rows, file, frames):
    column, what = wanted.split("=", 1)
    value, body, gather = what.split(":")
    field, _, component = value.partition(".")
    by_step = {int(row[1]): row[header.index(column)] for row in rows}
    for name in frames:
        data = file[name][body][field]
        values = data[()] if data.ndim == 1 else data[()][:, data.attrs["components"].decode().split().index(component)]
        found = getattr(numpy, gather)(values)
        step = int(file[name].attrs["step"])
        if step in by_step:
            size = max(abs(by_step[step]), abs(values).max())
            check(abs(found - by_step[step]) <= 1e-12 * size, f"{name}: {gather} of {value} is {found}, history.csv has {by_step[step]}")


def main():
    arguments = [a for a in sys.argv[1:] if a != "--partial"]
    partial = "--partial" in sys.argv
    folder = arguments[0]
    header, rows = read_history(os.path.join(folder, "history.csv"))
    check(header[:3] == ["t", "step", "dt"], f"history.csv begins with {header[:3]}")
    check(all(len(row) == len(header) for row in rows), "history.csv: a row has another length than the header")
    steps = {int(row[1]): row[0] for row in rows}
    with h5py.File(os.path.join(folder, "results.h5"), "r") as file:
        frames = check_h5(file)
        for name in frames:
            step, time = int(file[name].attrs["step"]), file[name].attrs["time"]
            check(step not in steps or steps[step] == time, f"{name}: step {step} is at another time in history.csv")
        check_xdmf(os.path.join(folder, "results.xdmf"), "all", file, frames, partial)
        shown = {os.path.basename(p)[8:-5] for p in glob.glob(os.path.join(folder, "results_*.xdmf"))}
        bodies = set(file[frames[0]]) - {"all"}
        wanted = {b for b in bodies if len(bodies) > 1 or "connectivity" in file[frames[0]][b]}
        check(shown == wanted, f"bodies with a file of their own are {sorted(shown)}, not {sorted(wanted)}")
        for path in sorted(glob.glob(os.path.join(folder, "results_*.xdmf"))):
            check_xdmf(path, os.path.basename(path)[8:-5], file, frames, partial)
        for wanted in arguments[1:]:
            check_column(wanted, header, rows, file, frames)
    if not partial:
        with open(os.path.join(folder, "summary.json")) as stream:
            summary = json.load(stream)
        check([c["name"] for c in summary["columns"]] == header, "summary.json: columns are not those of history.csv")
        check(summary["frames"] == len(frames), "summary.json: another number of frames")
    for problem in problems[:20]:
        print(problem)
    print(f"{folder}: {len(frames)} frames, {len(rows)} rows, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
