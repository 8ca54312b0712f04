#!/usr/bin/env python3
"""Memory and rate stay constant over many chips in one process: endurance_test.py <generate_dataset>

INSONIFY_CHIPS: number of chips (2000; tools/test --full: 100000). INSONIFY_CHIP_SIZE: their pixels a side (32). Processor
time, not wall-clock time, is measured for each hundredth of the set. Other programs only increase it, so the 20th
percentiles are compared. Below 20000 chips the rate is printed and not checked.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import time

GENERATOR = sys.argv[1]
COUNT = int(os.environ.get("INSONIFY_CHIPS", "2000"))
SIZE = os.environ.get("INSONIFY_CHIP_SIZE", "32")
PARTS = 100


def observed(process):
    """Processor seconds and resident megabytes of a running process."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    seconds = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return seconds, int(fields[21]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def watch(out):
    options = ["--recipe", "published", "--mode", "slant_range", "--count", str(COUNT), "--size", SIZE, "--threads", "1"]
    process = subprocess.Popen([GENERATOR, "--out", out, *options], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    seen, begun = [], time.monotonic()
    for part in range(1, PARTS):
        index = part * COUNT // PARTS
        record = out / "records" / f"{index // 1000:06}" / f"{index:09}.json"
        while not record.exists() and process.poll() is None:
            time.sleep(0.01)
        if process.poll() is not None:
            break
        seen.append((index, *observed(process)))
    _, errors = process.communicate()
    assert process.returncode == 0, errors.decode()
    assert len(seen) == PARTS - 1, "the set was made faster than it could be watched: raise INSONIFY_CHIPS"
    return seen, time.monotonic() - begun


def lower_fifth(values):
    return sorted(values)[len(values) // 5]


def main():
    if not sys.platform.startswith("linux"):
        print("skipped: /proc not found")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        seen, seconds = watch(pathlib.Path(folder) / "set")
    milliseconds = [1000 * (b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(seen, seen[1:])]
    memory = [megabytes for _, _, megabytes in seen]
    tenth = len(milliseconds) // 10
    early, late = lower_fifth(milliseconds[:len(milliseconds) // 2]), lower_fifth(milliseconds[len(milliseconds) // 2:])
    # The first tenth is a warm-up; the maximum memory is measured after it.
    before, after = memory[tenth], max(memory[tenth:])
    print(f"{COUNT} chips of {SIZE} pixels in {seconds:.0f} s, {seen[-1][1]:.0f} s of a core: {early:.2f} ms a chip in "
          f"the first half, {late:.2f} in the second; {before:.1f} MB after a tenth, {after:.1f} at most from there on")
    assert after <= 1.05 * before, "memory grows"
    if COUNT >= 20000:
        assert abs(late - early) <= 0.05 * early, "the rate changes"


if __name__ == "__main__":
    main()
