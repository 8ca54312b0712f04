#!/usr/bin/env python3
"""Tests recognize_real on synthetic pictures in place of real images: real_test.py <recognize_real>"""

import functools
import pathlib
import random
import re
import sys
import tempfile
import unittest
import xml.dom.minidom

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import programs

RECOGNIZE = sys.argv.pop(1)
run = functools.partial(programs.run, RECOGNIZE)
QUICK = ["--seeds", 2, "--counts", "0,4,12"]


def picture(path, kind, seed, noise=30, size=48):
    """A bright bar (a ship), a bright cross (a plane) or nothing, on noise."""
    dice = random.Random(f"{kind} {seed}")
    x0, y0 = dice.randrange(14, 34), dice.randrange(14, 34)
    def gray(x, y):
        bar, across = abs(x - x0) < 3 and abs(y - y0) < 12, abs(y - y0) < 3 and abs(x - x0) < 12
        shape = bar if kind == "ship" else (bar or across) if kind == "plane" else False
        return max(0, min(255, int(dice.gauss(90, noise)) + 110 * shape))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"P5 %d %d 255\n" % (size, size) + bytes(gray(x, y) for y in range(size) for x in range(size)))


class Real(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        for i in range(14):
            for kind in "plane", "ship", "seafloor":
                picture(cls.folder / "real" / kind / f"{i}.pgm", kind, i)
                folder = "empty" if kind == "seafloor" else kind
                picture(cls.folder / "set/images" / folder / "000000" / f"{i}.pgm", kind, i + 100)
                picture(cls.folder / "rough/images" / folder / "000000" / f"{i}.pgm", kind, i + 200, noise=3)

    def report(self, name, *options):
        out = self.folder / name
        run("--out", out, "--real", self.folder / "real", *QUICK, *options)
        for plot in "roc", "curves", "three":
            text = (out / f"{plot}.svg").read_text()
            xml.dom.minidom.parseString(text)
            self.assertNotIn("nan", text)
        return (out / "real.md").read_text()

    def rows(self, report):
        return {cells[1]: [float(cell.split()[0]) for cell in (cells[2], cells[3], cells[5])]
                for line in report.splitlines() if (cells := [cell.strip() for cell in line.split("|")])[0] == ""
                and len(cells) > 5 and re.match(r"\d|generated", cells[1])}

    def test_similar_generated_images_train_as_well_as_real_ones(self):
        report = self.report("a", "--generated", self.folder / "set")
        rows = self.rows(report)
        self.assertEqual(list(rows), ["generated alone", "4 real", "4 real and generated", "12 real", "12 real and generated"])
        self.assertGreater(rows["generated alone"][0], 0.97)
        self.assertGreater(rows["generated alone"][2], 0.8)  # planes from ships, too
        self.assertGreater(rows["12 real"][0], 0.9)
        # Not separable from the real images; with other noise, separable.
        apart = [float(re.search(r"area of (\S+?)\.$", text, re.M)[1])
                 for text in (report, self.report("b", "--generated", self.folder / "rough"))]
        self.assertLess(apart[0], 0.8)
        self.assertGreater(apart[1], 0.95)

    def test_the_report_does_not_depend_on_threads_or_on_a_set(self):
        one = self.report("c", "--threads", 1)
        self.assertEqual(one, self.report("d", "--threads", 3))
        self.assertEqual(list(self.rows(one)), ["4 real", "12 real"])
        self.assertNotIn("tells generated from real", one)

    def test_invalid_options_are_refused_with_a_reason(self):
        self.assertIn("holds no picture", run("--out", self.folder / "e", "--real", self.folder, expect=1))
        self.assertIn("must remain for testing", run("--out", self.folder / "e", "--real", self.folder / "real", "--counts", 28, expect=1))
        self.assertIn("is odd", run("--out", self.folder / "e", "--real", self.folder / "real", "--counts", 3, expect=2))


if __name__ == "__main__":
    unittest.main()
