"""Runs of abut for studies: scenes with settings, what came out of them, and figures as tables show them."""
import csv
import itertools
import json
import os
import subprocess
import tempfile

import numpy as np


class Runs:
    """Runs scenes, each into a folder of its own; what fails is collected in `failures`."""

    def __init__(self, build, limit=900):
        self.abut = f"{build}/abut"
        self.scratch = os.environ.get("ABUT_SCRATCH") or tempfile.mkdtemp()
        self.limit = limit  # s, of one run
        self.failures = []
        self.count = itertools.count(1)  # runs may be asked for from several threads

    def run(self, scene, settings, may_fail=False, keep=False):
        """Summary and columns of the history of a run, and its folder; None where it does not end, but with `keep`, which takes what there is up to there."""
        folder = f"{self.scratch}/{next(self.count)}"
        command = [self.abut, "run", scene, "--quiet", "-j", "1", "-o", folder]
        for path, value in settings.items():
            command += ["--set", f"{path}={value}"]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=self.limit)
            reason = done.stderr.strip() if done.returncode else None
        except subprocess.TimeoutExpired:
            reason = f"does not end in {self.limit} s"
        if reason is not None:
            if not may_fail:
                self.failures.append(f"{' '.join(command)}: {reason}")
            if not keep or not os.path.exists(f"{folder}/summary.json"):
                return None
        with open(f"{folder}/summary.json") as stream:
            summary = json.load(stream)
        with open(f"{folder}/history.csv") as stream:
            rows = list(csv.DictReader(stream))
        return summary, {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}, folder


def errors(summary):
    """Errors of a run's expects by their names."""
    return {e["name"]: e["error"] for e in summary["expects"]}


def figure(value):
    return f"{value:.0f}" if abs(value) >= 99.5 else f"{value:.2g}"
