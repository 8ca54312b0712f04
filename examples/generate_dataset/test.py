#!/usr/bin/env python3
"""Runs the generator as a user would, and worse: test.py <generate_dataset>"""

import hashlib
import csv
import json
import math
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest

GENERATOR = sys.argv.pop(1)
SMALL = ["--size", "96", "--count", "8", "--seed", "5", "--noise", "speckle:0.1,poisson:200"]


def run(*options, expect=0):
    result = subprocess.run([GENERATOR, *map(str, options)], capture_output=True, text=True, timeout=300)
    assert result.returncode == expect, f"exit {result.returncode}, expected {expect}:\n{result.stdout}{result.stderr}"
    return result.stdout + result.stderr


def digest(folder):
    """What every file of a data set holds, by its path."""
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(pathlib.Path(folder).rglob("*")) if path.is_file() and path.name != ".lock"}


class Generator(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)

    def test_the_same_bytes_for_any_number_of_threads(self):
        for threads in 1, 2, 8:
            run("--out", self.folder / f"t{threads}", "--threads", threads, *SMALL)
        self.assertEqual(digest(self.folder / "t1"), digest(self.folder / "t2"))
        self.assertEqual(digest(self.folder / "t1"), digest(self.folder / "t8"))

    def test_ranges_made_one_by_one_are_the_whole(self):
        run("--out", self.folder / "whole", *SMALL)
        for first, count in (5, 3), (0, 2), (2, 3):
            run("--out", self.folder / "parts", *SMALL, "--first", first, "--count", count)
        self.assertEqual(digest(self.folder / "whole"), digest(self.folder / "parts"))

    def test_a_killed_run_goes_on_to_the_same_bytes(self):
        run("--out", self.folder / "whole", *SMALL)
        chance = random.Random(1)
        for _ in range(8):
            process = subprocess.Popen([GENERATOR, "--out", self.folder / "killed", *SMALL, "--threads", "2"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(chance.uniform(0.0, 0.25))
            process.kill()
            process.wait()
            for record in (self.folder / "killed" / "records").glob("*.json"):
                image = self.folder / "killed" / json.loads(record.read_text())["file"]
                self.assertTrue(image.read_bytes().endswith(b"IEND\xaeB`\x82"))
        run("--out", self.folder / "killed", *SMALL)
        self.assertEqual(digest(self.folder / "whole"), digest(self.folder / "killed"))

    def test_an_interrupted_run_keeps_what_is_finished(self):
        options = ["--out", self.folder / "a", "--size", "256", "--count", "400"]
        process = subprocess.Popen([GENERATOR, *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while not list((self.folder / "a").glob("records/*.json")) and process.poll() is None:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertIn("goes on from here", errors)
        listed = json.loads((self.folder / "a" / "annotations.json").read_text())["images"]
        self.assertGreater(len(listed), 0)
        self.assertLess(len(listed), 400)
        for image in listed:
            self.assertTrue((self.folder / "a" / image["file_name"]).exists())

    def test_annotations_are_coco_that_adds_up(self):
        run("--out", self.folder / "a", *SMALL)
        coco = json.loads((self.folder / "a" / "annotations.json").read_text())
        self.assertEqual([c["name"] for c in coco["categories"]], ["cylinder", "cube", "cone", "sphere", "shadow"])
        self.assertEqual(len(coco["images"]), 8)
        self.assertEqual(len({a["id"] for a in coco["annotations"]}), len(coco["annotations"]))
        self.assertGreaterEqual(len(coco["annotations"]), 12)
        for a in coco["annotations"]:
            height, width = a["segmentation"]["size"]
            counts = a["segmentation"]["counts"]
            self.assertEqual(sum(counts), width * height)
            self.assertEqual(sum(counts[1::2]), a["area"])
            inside, at = [], 0
            for i, count in enumerate(counts):
                if i % 2:
                    inside += range(at, at + count)
                at += count
            xs, ys = [p // height for p in inside], [p % height for p in inside]
            self.assertEqual(a["bbox"], [min(xs), min(ys), max(xs) - min(xs) + 1, max(ys) - min(ys) + 1])
        rows = (self.folder / "a" / "manifest.csv").read_text().splitlines()
        self.assertEqual(len(rows), 9)
        self.assertEqual({len(row.split(",")) for row in rows}, {len(rows[0].split(","))})

    def test_a_mesh_is_a_class_and_a_heightmap_a_seabed(self):
        (self.folder / "tetra.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
        heights = bytes(min(255, 100 + x % 7) for y in range(200) for x in range(200))
        (self.folder / "map.pgm").write_bytes(b"P5 200 200 255\n" + heights)
        run("--out", self.folder / "a", "--size", 64, "--count", 4, "--targets", "cube", "--mesh",
            f"tetra={self.folder / 'tetra.obj'}", "--heightmap", self.folder / "map.pgm", "--heightmap-spacing", 0.1,
            "--heightmap-scale", 0.2)
        self.assertEqual(len(list((self.folder / "a" / "images" / "tetra").glob("*.png"))), 2)

    def read_labels(self, folder):
        """The manifest's rows, with the boxes of the target and of its shadow."""
        coco = json.loads((folder / "annotations.json").read_text())
        kinds = {c["id"]: c["supercategory"] for c in coco["categories"]}
        boxes = {(a["image_id"], kinds[a["category_id"]]): a["bbox"] for a in coco["annotations"]}
        for row in csv.DictReader((folder / "manifest.csv").read_text().splitlines()):
            values = {name: value if name in ("file", "class", "seabed", "mode", "shadow_is_cut") else float(value)
                      for name, value in row.items()}
            index = int(row["index"])
            yield values, boxes.get((index, "target")), boxes.get((index, "shadow"))

    def test_labels_of_every_mode_say_what_closed_forms_say(self):
        # A sphere that lies on level sand: r, and z, the height of its middle, are all there is to know.
        checked = {}
        for mode in "overhead", "ground_range", "slant_range":
            run("--out", self.folder / mode, "--mode", mode, "--chip", 6, "--pixels", 256, "--count", 12, "--seed", 2,
                "--targets", "sphere", "--seabeds", "sand", "--tilt", 0, "--burial", 0, "--aspect", 1, "--noise", "none",
                "--altitude", "4:8", "--distance", "2:5", "--target-size", "0.5:0.8", "--grazing", "14:25")
            for v, target, shadow in self.read_labels(self.folder / mode):
                pixel, r, z = v["metres_per_pixel"], v["target_size_m"] / 2, v["target_z_m"]
                a, x, slant = v["altitude_m"], v["ground_range_m"], mode == "slant_range"
                self.assertAlmostEqual(pixel, 6 / 256, places=3 if mode == "overhead" else 6)
                if mode == "overhead":  # the light's ray that touches the sphere, and the camera's
                    grazing = math.radians(v["grazing_deg"])
                    tip = x + z / math.tan(grazing) + r / math.sin(grazing)
                    first = -a * math.tan(math.atan2(-x, a - z) + math.asin(r / math.hypot(x, a - z)))
                else:
                    distance = math.hypot(x, a - z)
                    touching = math.atan2(a - z, x) - math.asin(r / distance)
                    tip = a / math.sin(touching) if slant else a / math.tan(touching)
                    # In a map, the nearest point that is seen is that of the sphere's own side.
                    first = distance - r if slant else x - r
                    self.assertAlmostEqual(v["grazing_deg"], math.degrees(math.atan2(a, x)), places=4)
                    self.assertAlmostEqual(v["slant_range_m"], math.hypot(a, x), places=4)
                column = (first - v["left_edge_m"]) / pixel
                self.assertAlmostEqual(target[0], column, delta=2, msg=f"{mode} {v}")
                middle = target[1] + target[3] / 2
                self.assertTrue(0.4 * 256 < middle < 0.6 * 256)
                self.assertAlmostEqual(target[0], 256 / 3, delta=40)
                if v["shadow_is_cut"] == "true":
                    continue
                # Sand is rough, by 4 mm: so many pixels more or less where its shadow ends.
                rough = 3 * 0.004 / math.tan(math.radians(v["grazing_deg"])) / pixel
                end = (tip - v["left_edge_m"]) / pixel
                self.assertAlmostEqual(shadow[0] + shadow[2], end, delta=1.5 + rough, msg=f"{mode} {v}")
                self.assertAlmostEqual(v["shadow_measured_m"], v["shadow_m"], delta=(2 + rough) * pixel)
                checked[mode] = checked.get(mode, 0) + 1
        for mode in "overhead", "ground_range", "slant_range":
            self.assertGreaterEqual(checked.get(mode, 0), 4, mode)

    def test_every_mode_has_masks_and_the_same_bytes_for_any_number_of_threads(self):
        for mode in "ground_range", "slant_range":
            options = ["--mode", mode, "--pixels", 64, "--count", 6, "--seabeds", "mixed,rock"]
            run("--out", self.folder / f"{mode}1", "--threads", 1, *options)
            run("--out", self.folder / f"{mode}3", "--threads", 3, *options)
            self.assertEqual(digest(self.folder / f"{mode}1"), digest(self.folder / f"{mode}3"))
            for kind in "target", "shadow", "seabed":
                self.assertEqual(len(list((self.folder / f"{mode}1" / "masks").glob(f"*_{kind}.png"))), 6)

    def test_options_come_from_a_file_too(self):
        (self.folder / "set.toml").write_text('size = 64\ncount = 2\nseed = 9\ntargets = ["cone"]\n')
        run("--config", self.folder / "set.toml", "--out", self.folder / "a")
        self.assertEqual(len(list((self.folder / "a" / "images" / "cone").glob("*.png"))), 2)

    def test_what_cannot_be_is_refused_with_a_reason(self):
        def refused(text, *options, expect=2):
            self.assertIn(text, run(*options, expect=expect))
        out = ["--out", self.folder / "a"]
        refused("--out is required")
        refused("tank", *out, "--targets", "tank")
        refused("lava", *out, "--seabeds", "lava")
        refused("'fog' is not one of", *out, "--noise", "fog")
        refused("low is above high", *out, "--altitude", "6:4")
        refused("neither a number nor a range", *out, "--grazing", "steep")
        refused("must lie within", *out, "--grazing", "0")
        refused("for the sonar's modes", *out, "--noise", "seabed")
        refused("sideways", *out, "--mode", "sideways")
        refused("is not CLASS=FILE", *out, "--mesh", "wreck.obj")
        refused("does not exist", *out, "--reference", self.folder / "nowhere")
        self.assertFalse((self.folder / "a").exists())
        (self.folder / "other").mkdir()
        (self.folder / "other" / "thesis.txt").write_text("mine")
        refused("is not empty", "--out", self.folder / "other", expect=1)
        run(*out, *SMALL)
        refused("seed was 5, is 6", *out, *SMALL, "--seed", "6", expect=1)

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs a full disk")
    def test_a_file_that_cannot_be_written_is_named(self):
        run("--out", self.folder / "a", *SMALL, "--count", "1")
        (self.folder / "a" / "annotations.json").unlink()
        (self.folder / "a" / "annotations.json").mkdir()
        self.assertIn("annotations.json", run("--out", self.folder / "a", *SMALL, expect=1))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
