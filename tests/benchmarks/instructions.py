#!/usr/bin/env python3
"""Counts the instructions of pieces of work and compares them with recorded counts.

    instructions.py PROGRAM RECORD [--record]

Valgrind counts each piece executed once and twice; the difference is the piece, the same on every machine with AVX2 and
under any load. RECORD has a line `name count` for each. A count more than 3 % above its record fails; --record writes RECORD.
"""

import pathlib
import re
import subprocess
import sys

TOLERANCE = 1.03


def instructions(program, name, times):
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, name, str(times)]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", ran.stderr).group(1))


def main():
    program, record = sys.argv[1], pathlib.Path(sys.argv[2])
    names = subprocess.run([program, "names"], capture_output=True, text=True, check=True).stdout.split()
    counts = {name: instructions(program, name, 2) - instructions(program, name, 1) for name in names}
    if "--record" in sys.argv:
        record.write_text("".join(f"{name} {count}\n" for name, count in counts.items()))
        return
    before = {name: int(count) for name, count in (line.split() for line in record.read_text().splitlines())}
    more = []
    for name, count in counts.items():
        limit = before.get(name, 0) * TOLERANCE
        print(f"{name:16} {count:12} {count / before.get(name, count):6.3f} x of the record")
        if count > limit:
            more.append(name)
    if more:
        sys.exit(f"More instructions than recorded: {', '.join(more)}. --record accepts the new counts.")


main()
