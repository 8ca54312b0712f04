#!/usr/bin/env python3
"""Compares chips with closed forms, and checks that the simulator uses the library only to write files.

test.py <ping_simulator>
"""

import csv
import functools
import math
import pathlib
import re
import statistics
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import programs
from programs import digest

SIMULATOR = sys.argv.pop(1)
run = functools.partial(programs.run, SIMULATOR)
CHIP, PIXELS = 5, 128


def read_png(path):
    """Rows of 8-bit gray values."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
            assert (depth, color) == (8, 0), path
        packed += body if kind == b"IDAT" else b""
        at += 12 + length
    raw, rows, above = zlib.decompress(packed), [], [0] * width
    for y in range(height):
        line = raw[y * (width + 1):(y + 1) * (width + 1)]
        row = []
        for x, value in enumerate(line[1:]):
            left, up, corner = row[x - 1] if x else 0, above[x], above[x - 1] if x else 0
            guess = left + up - corner
            nearest = min((left, up, corner), key=lambda v: abs(guess - v))
            row.append(value + (0, left, up, (left + up) // 2, nearest)[line[0]] & 255)
        rows.append(row)
        above = row
    return rows


def chips(folder):
    """The manifest's rows, each with its intensities: 1 is the mean of level bottom."""
    for row in csv.DictReader((folder / "manifest.csv").read_text().splitlines()):
        v = {name: value if name in ("file", "class", "seabed") else float(value) for name, value in row.items()}
        back = [(v["white"] * (gray / 255) ** (1 / v["gamma"])) ** 2 for gray in range(256)]
        yield v, [[back[gray] for gray in line] for line in read_png(folder / v["file"])]


class Simulator(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)

    def test_the_library_only_writes_files(self):
        here = pathlib.Path(__file__).parent
        shared = "../common/option_values.hpp", "../common/refusal.hpp"  # parse command lines; checked as well
        for source in [*here.glob("*.[ch]pp"), *(here / name for name in shared)]:
            for header in re.findall(r'#include [<"](.*)[>"]', source.read_text()):
                if header.startswith(("insonify", "..")) and header not in shared:
                    self.assertIn(header, ("insonify/io/png.hpp", "insonify/io/manifest.hpp"), source)

    def test_the_same_bytes_for_any_number_of_threads(self):
        for threads in 1, 3:
            run("--out", self.folder / f"t{threads}", "--counts", "1,2,1", "--pixels", 32, "--threads", threads)
        self.assertEqual(digest(self.folder / "t1"), digest(self.folder / "t3"))
        self.assertEqual(len(list((self.folder / "t1").glob("images/cube/*.png"))), 2)

    def test_echoes_and_shadows_of_spheres_match_closed_forms(self):
        run("--out", self.folder / "a", "--counts", "0,0,10", "--seabeds", "flat", "--seed", 4)
        bottoms, ends = [], 0
        for v, intensity in chips(self.folder / "a"):
            a, x, z, r = v["altitude_m"], v["ground_range_m"], v["height_m"], v["size_m"] / 2
            distance = math.hypot(x, a - z)
            touching = math.atan2(a - z, x) - math.asin(r / distance)
            column = lambda slant: (slant - v["left_edge_m"]) / CHIP * PIXELS
            middle = PIXELS - 1 - int(v["along_m"] / CHIP * PIXELS)
            # The beam fills in shadows narrower than itself; half of the sphere's width is wide enough.
            mean = lambda left, right: statistics.fmean(
                intensity[y][i] for y in range(middle - 2, middle + 3) for i in range(round(left), round(right)))
            first, tip = column(distance - r), column(a / math.sin(touching))
            level = statistics.fmean(intensity[y][i] for y in (*range(20), *range(108, 128)) for i in range(PIXELS))
            bottoms += [intensity[y][i] for y in range(20) for i in range(PIXELS)]
            self.assertAlmostEqual(level, 1, delta=0.15, msg=v)
            self.assertGreater(mean(first - 1, first + 5), 2 * level, v)
            self.assertLess(mean(first - 12, first - 4), 1.6 * level, v)
            if v["beam_deg"] * math.pi / 180 * distance < r:
                dark = mean(column(distance) + 3, min(tip - 2, PIXELS))
                self.assertLess(dark, 0.35 * level, v)
                if tip < PIXELS - 10:
                    ends += 1
                    self.assertGreater(mean(tip + 3, tip + 10), 2 * dark, v)
        self.assertGreater(ends, 0)
        # Two samples are averaged to a pixel, and the pulse makes them alike: between one look and two.
        index = statistics.pvariance(bottoms) / statistics.fmean(bottoms) ** 2
        self.assertTrue(0.45 < index < 1, index)

    def test_invalid_options_are_refused_with_a_reason(self):
        self.assertIn("--out is required", run(expect=2))
        self.assertIn("'nan' is not a number", run("--out", self.folder / "a", "--chip", "nan", expect=2))

    def test_a_smaller_set_leaves_no_chip_of_a_larger_one(self):
        for counts in "2,2,2", "1,2,1":
            run("--out", self.folder / "a", "--counts", counts, "--pixels", 16)
        (self.folder / "a" / "images" / "cube" / "notes.png").touch()
        run("--out", self.folder / "a", "--counts", "1,1,1", "--pixels", 16)
        listed = {row["file"] for row in csv.DictReader((self.folder / "a" / "manifest.csv").read_text().splitlines())}
        kept = {str(path.relative_to(self.folder / "a")) for path in (self.folder / "a" / "images").rglob("*.png")}
        self.assertEqual(kept, listed | {"images/cube/notes.png"})

    @unittest.skipUnless(sys.platform == "linux", "needs a limit of the address space")
    def test_draws_with_fewer_threads_if_some_cannot_start(self):
        def limit():
            import resource
            resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
        done = subprocess.run([SIMULATOR, "--out", self.folder / "a", "--counts", "2,1,1", "--pixels", "16",
                               "--threads", "1024"], capture_output=True, timeout=120, preexec_fn=limit)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
