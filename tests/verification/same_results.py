#!/usr/bin/python3
"""Do folders of results hold the same bits? same_results.py [--later] A B [A B ...]: every row of history.csv, every dataset and attribute of results.h5, the XDMF, and what the
summary says of the physics. --later: B begins later than A, as of a run that went on from a checkpoint in a folder of its own: its rows and frames are those of A's end."""
import glob
import json
import os
import sys

import h5py

SUMMARY = ("time", "steps", "ledger", "motion", "contacts", "expects", "columns", "outcome")


def values(path):
    found = {}

    def visit(group, name):
        for key in group.attrs:
            found[f"{name}@{key}"] = str(group.attrs[key])
        for key in group:
            item = group[key]
            if isinstance(item, h5py.Group):
                visit(item, f"{name}/{key}")
            else:
                found[f"{name}/{key}"] = (item.shape, item[...].tobytes())

    if os.path.exists(path):
        with h5py.File(path, "r") as file:
            visit(file, "")
    return found


def text(path):
    with open(path, "rb") as file:
        return file.read()


def differences(a, b, later):
    wrong = []
    rows = [text(f"{d}/history.csv").split(b"\n") for d in (a, b)]
    if later and (rows[0][0] != rows[1][0] or not 2 < len(rows[1]) < len(rows[0]) or rows[0][-len(rows[1]) + 1:] != rows[1][1:]):
        wrong.append("history.csv")
    if not later and rows[0] != rows[1]:
        wrong.append("history.csv")
    fields = [values(f"{d}/results.h5") for d in (a, b)]
    if later:
        frames = {k.split("/")[1].split("@")[0] for k in fields[1]}
        fields[0] = {k: v for k, v in fields[0].items() if k.split("/")[1].split("@")[0] in frames}
        fields = [{k: v for k, v in f.items() if "/vertices" not in k and "/connectivity" not in k} for f in fields]
    wrong += sorted(k for k in set(fields[0]) | set(fields[1]) if fields[0].get(k) != fields[1].get(k))
    if not later:
        files = [{os.path.basename(f): text(f) for f in glob.glob(f"{d}/*.xdmf")} for d in (a, b)]
        wrong += sorted(k for k in set(files[0]) | set(files[1]) if files[0].get(k) != files[1].get(k))
    summary = [json.loads(text(f"{d}/summary.json")) for d in (a, b)]
    wrong += [f"summary.json: {k}" for k in SUMMARY if summary[0][k] != summary[1][k]]
    return wrong


later = sys.argv[1] == "--later"
pairs = sys.argv[2 if later else 1:]
bad = 0
for a, b in zip(pairs[::2], pairs[1::2]):
    wrong = differences(a, b, later)
    if wrong:
        bad = 1
        print(f"{a} and {b}: {len(wrong)} differ: {wrong[:6]}")
sys.exit(bad)
