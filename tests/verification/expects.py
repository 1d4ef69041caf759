"""Prints the expects of a summary.json, one a line: passed or MISSED, name, value, reference, error, tolerance."""
import json
import sys


def number(value):
    return "none" if value is None else f"{value:.6g}"


with open(sys.argv[1]) as stream:
    summary = json.load(stream)
for expect in summary["expects"]:
    print(
        "passed" if expect["pass"] else "MISSED",
        f"{expect['name']}: {number(expect['value'])}, reference {number(expect['reference'])},",
        f"error {number(expect['error'])} of {number(expect['tolerance'])}",
    )
