"""How rough the pressure of a body of points is, from the last frame of results.h5 (fields stress and volume)."""
import numpy as np


def roughness(folder, body, cell, corner):
    """(within, between). The pressure of a cell of the grid is the mean over its points, by volume. within: root mean square of what points differ from their cell's;
    between, the checkerboard: of (p00 - p10 - p01 + p11)/4 over all squares of four cells with points; both by the root mean square of the cells' pressures.
    A smooth pressure leaves about h |grad p|/4 and h^2 p_xy/4 there; a full checkerboard has between = 1."""
    import h5py

    with h5py.File(f"{folder}/results.h5") as file:
        last = file[sorted(name for name in file if name.startswith("frame_"))[-1]][body]
        x, stress, volume = last["position"][:][:, :2], last["stress"][:], last["volume"][:].ravel()
    p = -stress[:, :3].sum(axis=1) / 3
    cells = {}
    for point, key in enumerate(map(tuple, np.floor((x - corner) / cell).astype(int))):
        cells.setdefault(key, []).append(point)
    mean = {key: np.average(p[points], weights=volume[points]) for key, points in cells.items()}
    within = [p[point] - mean[key] for key, points in cells.items() for point in points]
    between = [(mean[i, j] - mean[i + 1, j] - mean[i, j + 1] + mean[i + 1, j + 1]) / 4 for i, j in mean
               if {(i + 1, j), (i, j + 1), (i + 1, j + 1)} <= mean.keys()]
    size = np.sqrt(np.mean(np.square(list(mean.values()))))
    return tuple(float(np.sqrt(np.mean(np.square(values))) / size) for values in (within, between))
