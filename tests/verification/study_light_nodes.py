#!/usr/bin/env python3
"""The longest stable step of a block on the linear basis at frozen points, dt c/h, where nodes with less than 0.15 of a full node's mass go by their neighbours
(mpm/light_nodes.c): worst over the block's place on the grid in both directions, with 1 .. 8 points per direction, nu 0 and 0.45. The least of each is COURANT in
mpm/kernel_linear.c; less than that is missed. Without ties (second column) there is no limit. study_light_nodes.py BUILD"""
import os
import re
import sys

os.environ["OMP_NUM_THREADS"] = "1"
import numpy as np  # noqa: E402

LIGHT = 0.15
ROUND = [(1, 0), (-1, 0), (0, 1), (0, -1)], [(1, 1), (-1, -1), (1, -1), (-1, 1)]


def limit(cells, per, place, nu, tied):
    count = cells + 5
    mass = np.zeros(count * count)
    stiffness = np.zeros((2 * count * count,) * 2)
    ratio = nu / (1 - nu)
    law = np.array([[1, ratio, 0], [ratio, 1, 0], [0, 0, (1 - ratio) / 2]])
    width = 1.0 / per
    for x in 2 + place[0] + (np.arange(cells * per) + 0.5) * width:
        for y in 2 + place[1] + (np.arange(cells * per) + 0.5) * width:
            i, j = int(x), int(y)
            a, b = x - i, y - j
            nodes = [j * count + i, j * count + i + 1, (j + 1) * count + i, (j + 1) * count + i + 1]
            slope = [(-(1 - b), -(1 - a)), (1 - b, -a), (-b, 1 - a), (b, a)]
            strain = np.zeros((3, 8))
            for k, value in enumerate([(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b]):
                mass[nodes[k]] += width * width * value
                strain[0, 2 * k] = strain[2, 2 * k + 1] = slope[k][0]
                strain[1, 2 * k + 1] = strain[2, 2 * k] = slope[k][1]
            dofs = np.array([[2 * n, 2 * n + 1] for n in nodes]).ravel()
            stiffness[np.ix_(dofs, dofs)] += width * width * strain.T @ law @ strain
    ties = np.eye(count * count)
    heavy = mass >= LIGHT
    for node in np.nonzero((mass > 0) & ~heavy)[0] if tied else []:
        for directions in ROUND:
            lines = []
            for dx, dy in directions:
                near, far = node + dy * count + dx, node + 2 * (dy * count + dx)
                if 0 <= far < count * count and heavy[near] and heavy[far]:
                    lines.append((near, far))
            if lines:
                break
        ties[node, node] = 0
        for near, far in lines:
            ties[node, near] += 2 / len(lines)
            ties[node, far] -= 1 / len(lines)
    lumped = ties.T @ mass
    both = np.kron(ties, np.eye(2))
    keep = np.nonzero(lumped > 0)[0]
    dofs = np.array([[2 * n, 2 * n + 1] for n in keep]).ravel()
    root = np.sqrt(np.repeat(lumped[keep], 2))
    matrix = (both.T @ stiffness @ both)[np.ix_(dofs, dofs)] / np.outer(root, root)
    return 2 / np.sqrt(np.linalg.eigvalsh(matrix)[-1])


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(here, "../../mpm/kernel_linear.c"), encoding="utf-8") as source:
        courant = [float(x) for x in re.search(r"#define COURANT ([0-9., ]+)", source.read()).group(1).split(",")]
    missed = 0
    print("points per direction   tied   not tied   stepped by")
    for per in range(1, 9):
        offsets = np.arange(0, 1, 0.04 if per < 6 else 0.1) + 1e-6
        places = [(a, b) for a in offsets for b in (a, 0.37)]
        tied = min(limit(4, per, p, nu, True) for p in places for nu in (0, 0.45))
        alone = min(limit(4, per, p, 0, False) for p in places[::5])
        print(f"{per:20d}   {tied:.3f}   {alone:8.3f}   {courant[per - 1]:.3f}")
        missed += courant[per - 1] > tied + 5e-4
    sys.exit(missed > 0)


main()
