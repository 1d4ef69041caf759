"""Opens the results of a run in ParaView and compares what it shows with results.h5. Run by pvpython: check_results_paraview.py DIR [killed]

killed: a run that was killed between a frame and the line that tells of it leaves one frame more than the .xdmf knows."""
import os
import sys

import h5py
import numpy
from paraview.simple import OpenDataFile, Delete
from paraview import servermanager
from vtkmodules.util.numpy_support import vtk_to_numpy

problems = []
KILLED = sys.argv[2:] == ["killed"]


def leaves(data):
    """The data sets in a tree of blocks."""
    if data is None:
        return []
    if hasattr(data, "GetNumberOfBlocks"):
        return [leaf for k in range(data.GetNumberOfBlocks()) for leaf in leaves(data.GetBlock(k))]
    return [data]


def compare(where, name, array, stored):
    values = vtk_to_numpy(array)
    if values.shape != stored.shape or not numpy.array_equal(values.astype(float), stored.astype(float), equal_nan=True):
        problems.append(f"{where}: {name} {values.shape} differs from results.h5 {stored.shape}")


def check_cells(where, data, points, connectivity):
    """One vertex a point, or the elements of results.h5 (nodes of a mesh never leave, so the first frame's are those of all)."""
    if connectivity is None:
        if data.GetNumberOfCells() != points:
            problems.append(f"{where} has {data.GetNumberOfCells()} vertices")
        return
    wanted = connectivity[()]
    kind = {4: 9, 8: 23}[wanted.shape[1]]  # VTK_QUAD, VTK_QUADRATIC_QUAD
    if data.GetNumberOfCells() != len(wanted) or any(data.GetCellType(c) != kind for c in range(len(wanted))):
        problems.append(f"{where}: shows {data.GetNumberOfCells()} cells, or other ones than the {len(wanted)} elements of results.h5")
        return
    for c, nodes in enumerate(wanted):
        cell = data.GetCell(c)  # the same object at every call
        if [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())] != list(nodes):
            problems.append(f"{where}: element {c} has other nodes than in results.h5")
            return


def check(path, group, file):
    source = OpenDataFile(path)
    frames = sorted(file)
    times = list(source.TimestepValues)
    stored_times = [file[f].attrs["time"] for f in frames]
    if KILLED and len(stored_times) == len(times) + 1:
        stored_times.pop()
    if not numpy.array_equal(times, stored_times):
        problems.append(f"{path}: times are {times}, results.h5 has {stored_times}")
        return
    for name, time in zip(frames, times):
        source.UpdatePipeline(time)
        found = [d for d in leaves(servermanager.Fetch(source)) if d.GetNumberOfPoints() > 0]
        stored = file[name][group]
        if len(found) != (1 if len(stored["id"]) else 0):
            problems.append(f"{path}: {name} shows {len(found)} clouds of points")
            continue
        for data in found:
            compare(f"{path}: {name}", "position", data.GetPoints().GetData(), stored["position"][()])
            check_cells(f"{path}: {name}", data, len(stored["id"]), file[frames[0]][group].get("connectivity"))
            arrays = {data.GetPointData().GetArrayName(k) for k in range(data.GetPointData().GetNumberOfArrays())}
            for field in stored:
                if field in ("vertices", "connectivity"):
                    continue
                if field not in arrays:
                    problems.append(f"{path}: {name} lacks {field}; there are {sorted(arrays)}")
                else:
                    compare(f"{path}: {name}", field, data.GetPointData().GetArray(field), stored[field][()])
    Delete(source)


folder = sys.argv[1]
with h5py.File(os.path.join(folder, "results.h5"), "r") as results:
    check(os.path.join(folder, "results.xdmf"), "all", results)
    for entry in sorted(os.listdir(folder)):
        if entry.startswith("results_") and entry.endswith(".xdmf"):
            check(os.path.join(folder, entry), entry[8:-5], results)
for problem in problems[:20]:
    print(problem)
print(f"{folder}: ParaView, {len(problems)} problems")
sys.exit(1 if problems else 0)
