#!/usr/bin/python3
# cost: 30
"""Stick zone of a dragged cylinder, after Cattaneo and Mindlin, at three loads, with a short drag: within a cell, and no load taken for another.
test_cattaneo.py BUILD. More places and a longer drag: study_cattaneo.py."""
import os
import sys

try:
    import h5py  # noqa: F401
except ImportError:
    print("python3-h5py is not there")
    sys.exit(77)
from study_cattaneo import LOADS, PLACES, hold

sys.exit(0 if hold(os.path.realpath(sys.argv[1]), PLACES[0], LOADS, times=(6, 18)) else 1)
