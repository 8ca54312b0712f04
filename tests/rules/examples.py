#!/usr/bin/env python3
"""Checks the programs that show the library's extension points: examples.py <examples folder>.

Each has 40 lines at most and uses neither `detail::` nor `decltype`.
"""

import pathlib
import re
import sys

PROGRAMS = [
    "unit_test_fixture", "own_shaders", "depth_only", "lit_points", "own_shadow_policy", "own_noise", "own_seabed",
    "own_target", "many_targets", "survey_rows",
]
MAX_LINES = 40
BANNED = {r"\bdetail::": "uses the library's internals", r"\bdecltype\b": "has to spell out a type"}


def faults(path):
    lines = path.read_text().splitlines()
    if len(lines) > MAX_LINES:
        yield f"{len(lines)} lines, at most {MAX_LINES}"
    for number, line in enumerate(lines, 1):
        for pattern, reason in BANNED.items():
            if re.search(pattern, line):
                yield f"line {number} {reason}"


def main():
    folder = pathlib.Path(sys.argv[1])
    found = [f"{name}.cpp: {fault}" for name in PROGRAMS for fault in faults(folder / f"{name}.cpp")]
    print("\n".join(found + [f"{len(PROGRAMS)} programs, {len(found)} faults"]))
    sys.exit(1 if found else 0)


main()
