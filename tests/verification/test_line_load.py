#!/usr/bin/env python3
"""A line load on 4 x 4 m of ground, of elements and of points, against a larger piece: waves along the surface and below leave through dashpots and springs; after a slow pulse dashpots alone have
drifted away and springs have come back. usage: test_line_load.py BUILD"""
import sys
import tempfile

sys.dont_write_bytecode = True
from study_boundaries import KINDS, PLACES, line_load  # noqa: E402


def main():
    build, wrong = sys.argv[1], []

    def hold(good, what):
        if not good:
            wrong.append(what)

    with tempfile.TemporaryDirectory() as folder:
        fast = line_load(build, folder, 0.03, 0.12, 0.125, 9, KINDS)
        slow = line_load(build, folder, 0.3, 0.8, 0.2, 24, KINDS)
    for way in ("", "points_"):
        for place in PLACES:
            dashpots, springs = way + "viscous", way + "viscoelastic"
            hold(fast[dashpots, place][0] < 0.6 * fast["fixed", place][0], f"fast, {place}, {dashpots}: dashpots come half as near as a fixed side")
            hold(slow[dashpots, place][1] > 0.3, f"slow, {place}, {dashpots}: dashpots alone drift")
            hold(slow[springs, place][1] < 0.02, f"slow, {place}, {springs}: springs come back")
            hold(slow[springs, place][0] < 0.6 * slow["fixed", place][0], f"slow, {place}, {springs}: springs come half as near as a fixed side")
    print("\n".join("MISSED " + line for line in wrong))
    sys.exit(1 if wrong else 0)


main()
