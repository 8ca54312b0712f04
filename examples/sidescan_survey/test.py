#!/usr/bin/env python3
"""Runs a small survey and reads its files back: test.py <sidescan_survey>"""

import csv
import functools
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import programs
from programs import digest

SURVEY = sys.argv.pop(1)
run = functools.partial(programs.run, SURVEY)
RANGE, BINS = 20, 256
SMALL = ["--length", "15", "--width", "20", "--between", "20", "--range", RANGE, "--bins", BINS, "--page", "100",
         "--turn-rate", "30", "--altitude", "4", "--altitude-change", "1", "--seed", "4"]


def read_pgm(path):
    """Rows of numbers."""
    data = path.read_bytes()
    magic, size, largest, pixels = data.split(b"\n", 3)
    width, height = map(int, size.split())
    depth = 2 if int(largest) > 255 else 1
    assert magic == b"P5" and len(pixels) == width * height * depth, path
    row = width * depth
    return [[int.from_bytes(pixels[y * row + x:y * row + x + depth], "big") for x in range(0, row, depth)]
            for y in range(height)]


class Survey(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)

    def test_the_same_bytes_for_any_number_of_threads(self):
        for threads in 1, 3:
            run("--out", self.folder / f"t{threads}", "--threads", threads, *SMALL)
        self.assertEqual(digest(self.folder / "t1"), digest(self.folder / "t3"))

    def test_waterfall_labels_and_navigation_agree(self):
        run("--out", self.folder, *SMALL)
        track = list(csv.DictReader((self.folder / "navigation.csv").read_text().splitlines()))
        image = read_pgm(self.folder / "waterfall.pgm")
        targets = read_pgm(self.folder / "targets.pgm")
        shadows = read_pgm(self.folder / "shadows.pgm")
        seabed = read_pgm(self.folder / "seabed.pgm")
        for rows in image, targets, shadows, seabed:
            self.assertEqual((len(rows), len(rows[0])), (len(track), 2 * BINS))
        self.assertGreater(len({round(float(p["heading_deg"])) for p in track}), 20)  # it turns

        # The first return comes from the bottom below, on both sides; relief and targets may come earlier.
        late = 0
        for row, ping in zip(seabed, track):
            expected = float(ping["altitude_over_bottom_m"]) / RANGE * BINS
            starboard = next(b for b in range(BINS) if row[BINS + b] != 255)
            port = next(b for b in range(BINS) if row[BINS - 1 - b] != 255)
            self.assertAlmostEqual(port, starboard, delta=3)
            self.assertLess(starboard, expected + 1)
            late += expected - starboard > 4
        self.assertLess(late, len(track) / 10)
        for row, ping in zip(image, track):  # dark before it
            quiet = int(0.8 * float(ping["altitude_over_bottom_m"]) / RANGE * BINS)
            self.assertLess(sum(row[BINS - quiet:BINS + quiet]) / (2 * quiet), 12)

    def test_contacts_match_the_labels_and_the_expected_shadows(self):
        run("--out", self.folder, *SMALL, "--length", "40", "--targets", "1", "--bottom", "ripples+mud", "--heave", "0")
        targets = read_pgm(self.folder / "targets.pgm")
        contacts = list(csv.DictReader((self.folder / "contacts.csv").read_text().splitlines()))
        self.assertGreater(len(contacts), 8)
        self.assertEqual({c["side"] for c in contacts}, {"port", "starboard"})
        checked = set()
        for c in contacts:
            first, last = int(c["first_bin"]), int(c["last_bin"])
            number, area = int(c["target"]), 0
            for y in range(int(c["first_ping"]), int(c["last_ping"]) + 1):
                side = targets[y][BINS:] if c["side"] == "starboard" else targets[y][BINS - 1::-1]
                found = [b for b, i in enumerate(side) if i == number]
                area += len(found)
                self.assertTrue(all(first <= b <= last for b in found))
            self.assertEqual(area, int(c["target_px"]))
            cut = int(c["shadow_end_bin"]) == BINS - 1
            if cut:
                self.assertEqual(c["shadow_is_cut"], "true")
            if last == BINS - 1 or c["first_ping"] == "0" or int(c["last_ping"]) == len(targets) - 1:
                self.assertEqual(c["target_is_cut"], "true", c)
            # An uncut shadow far from nadir ends at the tip of the vertex that casts farthest, for any shape and heading of
            # the target; the tolerance is for the bottom's relief.
            if c["shadow_is_cut"] == "false" and c["target_is_cut"] == "false" and float(c["grazing_deg"]) < 35:
                self.assertAlmostEqual(float(c["shadow_measured_m"]), float(c["shadow_theory_m"]),
                                       delta=0.1 * float(c["shadow_theory_m"]) + 0.12, msg=c)
                checked.add(c["class"])
        self.assertEqual(checked, {"cylinder", "cube", "cone", "sphere"})
        self.assertIn("true", {c["shadow_is_cut"] for c in contacts})

    @unittest.skipUnless(pathlib.Path("/dev/full").exists(), "needs /dev/full")
    def test_a_full_disk_is_reported(self):
        for name in "waterfall.pgm", "targets.pgm", "shadows.pgm", "seabed.pgm", "navigation.csv", "contacts.csv":
            out = self.folder / name.replace(".", "_")
            out.mkdir()
            (out / name).symlink_to("/dev/full")
            self.assertIn(f"{name}: can't be written", run("--out", out, *SMALL, expect=1))

    def test_a_longer_track_takes_no_more_memory(self):
        def peak_memory(length):
            code = ("import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL);"
                    "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")
            options = ["--out", self.folder / f"l{length}", "--length", length, "--width", 0, "--range", RANGE, "--bins",
                       128, "--page", 64, "--altitude-change", 0, "--threads", 1]
            return int(subprocess.run([sys.executable, "-c", code, SURVEY, *map(str, options)], capture_output=True,
                                      text=True, check=True).stdout)
        short, long = peak_memory(60), peak_memory(600)
        self.assertLess(long, 1.25 * short)

    def test_waypoints_come_from_a_file_and_invalid_ones_are_refused(self):
        (self.folder / "points.csv").write_text("# x,y\n0,0\n0,10\n8,10\n")
        out = ["--out", self.folder / "a", "--range", RANGE, "--bins", BINS, "--turn-rate", 60]
        run(*out, "--waypoints", self.folder / "points.csv")
        track = list(csv.DictReader((self.folder / "a" / "navigation.csv").read_text().splitlines()))
        self.assertLess(abs(float(track[-1]["x_m"]) - 8), 2.5)
        self.assertLess(abs(float(track[-1]["y_m"]) - 10), 2.5)
        # A hair west of north is a heading of 0, not 360.
        (self.folder / "points.csv").write_text("0,0\n-1e-7,10\n")
        run(*out, "--waypoints", self.folder / "points.csv")
        north = csv.DictReader((self.folder / "a" / "navigation.csv").read_text().splitlines())
        self.assertEqual({ping["heading_deg"] for ping in north}, {"0.000"})
        (self.folder / "points.csv").write_text("here,there\n")
        self.assertIn("is not x,y", run(*out, "--waypoints", self.folder / "points.csv", expect=1))
        for text in "0,0\n1,2,3\n", "0,0\nnan,1\n", "0,0\n1e9,1\n", "0,0\n1;1\n", "0,0\n1\n2,2\n":
            (self.folder / "points.csv").write_text(text)
            self.assertIn("line 2 is not x,y", run(*out, "--waypoints", self.folder / "points.csv", expect=1))
        self.assertIn("does not exist", run(*out, "--waypoints", self.folder / "nowhere", expect=1))
        self.assertIn("a folder, pipe or device", run(*out, "--waypoints", "/dev/zero", expect=1))
        self.assertIn("lava", run(*out, "--bottom", "lava", expect=2))
        for option in "--width", "--speed", "--ping-rate", "--length", "--beam", "--turn-rate", "--targets":
            self.assertIn("'nan' is not a number", run(*out, option, "nan", expect=2, seconds=20))
        self.assertIn("--altitude: 1 m", run(*out, "--altitude", 1, expect=2))
        self.assertIn("--out: an empty name is not a folder", run("--out", "", expect=2))
        self.assertIn("points.csv' is not a folder", run("--out", self.folder / "points.csv", expect=2))

    def test_steps_longer_than_the_turning_circle_reach_the_end(self):
        said = run("--out", self.folder, *SMALL, "--length", 63, "--width", 0, "--speed", 2, "--ping-rate", 0.2,
                   "--turn-rate", 90, seconds=60)
        self.assertNotIn("not reached", said)
        track = list(csv.DictReader((self.folder / "navigation.csv").read_text().splitlines()))
        self.assertLess(abs(float(track[-1]["y_m"]) - 63), 10)

    def test_waypoints_within_the_turning_circle_are_named(self):
        (self.folder / "points.csv").write_text("0,0\n12,3\n-3,14\n")
        out = "--out", self.folder / "a", *SMALL, "--waypoints", self.folder / "points.csv"
        self.assertIn("1 of 3 waypoints lie within the turning circle", run(*out, "--turn-rate", 6))
        self.assertNotIn("waypoints", run(*out, "--turn-rate", 60))

    def test_no_shadow_is_shorter_than_nothing(self):
        run("--out", self.folder, "--length", 12, "--width", 20, "--between", 10, "--range", 15, "--bins", 130,
            "--altitude", 4, "--bottom", "sand+rock", "--seed", 3)  # the range ends before the top of the last target
        contacts = list(csv.DictReader((self.folder / "contacts.csv").read_text().splitlines()))
        self.assertIn("true", {contact["target_is_cut"] for contact in contacts})
        self.assertGreaterEqual(min(float(contact["shadow_measured_m"]) for contact in contacts), 0)

    def test_a_shorter_survey_leaves_no_page_of_a_longer_one(self):
        run("--out", self.folder, *SMALL, "--page", 32)
        run("--out", self.folder, *SMALL, "--page", 64)
        pings = len((self.folder / "navigation.csv").read_text().splitlines()) - 1
        self.assertEqual(len(list((self.folder / "pages").glob("page_????.png"))), -(-pings // 64))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
