#!/usr/bin/env python3
"""Runs the experiment on sets of a few chips: test.py <recognize> <ping_simulator>"""

import pathlib
import re
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
from programs import run

RECOGNIZE, SIMULATOR = sys.argv.pop(1), sys.argv.pop(1)
QUICK = ["--seeds", 2, "--sizes", "12,24", "--synthetic-test", "8,8,8", "--recipes", "overhead,slant_range"]


class Recognition(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = pathlib.Path(cls.scratch.name)
        for seed, name, counts in (1, "test", "4,3,3"), (2, "own", "7,9,10"), (4, "another", "3,3,3"), (5, "references", "2,2,2"):
            run(SIMULATOR, "--out", cls.folder / name, "--seed", seed, "--counts", counts)

    def report(self, name, *options, test="test"):
        out = self.folder / name
        run(RECOGNIZE, "--out", out, "--test", self.folder / test, "--own", self.folder / "own",
            "--references", self.folder / "references", *QUICK, *options)
        self.assertTrue((out / "confusion.svg").read_text().endswith("</svg>\n"))
        return (out / "report.md").read_text()

    def test_the_report_holds_every_run_and_does_not_depend_on_threads(self):
        report = self.report("a", "--threads", 1)
        self.assertEqual(report, self.report("b", "--threads", 3))
        rows = [row.split(" | ") for row in report.splitlines() if re.match(r"\|.* \| (12|24) \|", row)]
        self.assertEqual([row[1] for row in rows], ["12", "24"] * 3)
        for row in rows:
            mean, lowest, highest = map(float, re.match(r"(\S+) ± \S+ \((\S+) to (\S+)\)", row[3]).groups())
            self.assertTrue(0 <= lowest <= mean <= highest <= 1, row)
        percentages = [list(map(float, re.findall(r"(\S+) %", row))) for row in report.splitlines() if row.count("%") == 3]
        self.assertEqual(len(percentages), 18)
        for row in percentages:
            self.assertAlmostEqual(sum(row), 100, delta=0.2)

    def test_the_test_set_has_no_part_in_training(self):
        own = [[row.split(" | ")[2] for row in self.report(f"on_{test}", test=test).splitlines()
                if row.startswith("|") and " ± " in row]
               for test in ("test", "another")]
        self.assertEqual(own[0], own[1])

    def test_impossible_options_are_refused_with_a_reason(self):
        self.assertIn("holds no PNG", run(RECOGNIZE, "--out", self.folder / "c", "--test", self.folder,
                                           "--recipes", "slant_range", expect=1))
        for reason, *options in (
            ("--sizes: --own has 7 of class cylinder, 79 are needed", "--own", self.folder / "own", "--recipes", "none",
             "--sizes", 300),
            ("is the test set", "--own", self.folder / "test", "--recipes", "slant_range"),
            ("needs --references", "--recipes", "overhead"),
        ):
            self.assertIn(reason, run(RECOGNIZE, "--out", self.folder / "c", "--test", self.folder / "test", *options, expect=1))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
