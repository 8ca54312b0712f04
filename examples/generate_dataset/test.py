#!/usr/bin/env python3
"""End-to-end tests of the generator, with valid and hostile input: test.py <generate_dataset> <merge_dataset>

INSONIFY_KILLS: number of runs that are killed midway (8).
"""

import ast
import csv
import errno
import hashlib
import json
import math
import os
import pathlib
import random
import re
import shutil
import struct
import signal
import subprocess
import sys
import tarfile
import tempfile
import time
import unittest
import zlib

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import programs
from programs import digest

GENERATOR, MERGE = sys.argv.pop(1), sys.argv.pop(1)
KILLS = int(os.environ.get("INSONIFY_KILLS", "8"))
SMALL = ["--recipe", "published", "--size", "96", "--count", "8", "--seed", "5", "--noise", "speckle:0.1,poisson:200"]


def with_recipe(options):
    """Options with `--recipe published` as the default: most tests need its inputs and modes."""
    return list(options) if "--recipe" in options else ["--recipe", "published", *options]


def run(*options, expect=0, program=GENERATOR, **environment):
    options = with_recipe(options) if program == GENERATOR else options
    return programs.run(program, *options, expect=expect, **environment)


def refusal(*options):
    """Output of a run that must be refused with exit code 1 or 2."""
    return programs.run(GENERATOR, *with_recipe(options), expect=(1, 2), seconds=20)


def pgm(path, maxval=255, name="P5"):
    """Writes a picture of 40 x 40 with many gray values."""
    size = 2 if maxval > 255 else 1
    samples = b"".join((maxval * (x * y % 97) // 97).to_bytes(size, "big") for y in range(40) for x in range(40))
    path.write_bytes(b"P5 40 40 %d\n" % maxval + samples)
    return path


def read_png(data):
    """Gray values of an unfiltered PNG of 8 or 16 bits; verifies the checksum of each chunk."""
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    at, packed, kinds = 8, b"", []
    while at < len(data):
        size, = struct.unpack(">I", data[at:at + 4])
        kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0] == zlib.crc32(kind + body)
        kinds.append(kind)
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    assert kinds[0] == b"IHDR" and kinds[-1] == b"IEND" and color == 0
    raw, stride = zlib.decompress(packed), 1 + width * depth // 8
    assert len(raw) == stride * height and not any(raw[::stride])
    rows = b"".join(raw[y * stride + 1:(y + 1) * stride] for y in range(height))
    return list(rows) if depth == 8 else list(struct.unpack(f">{width * height}H", rows))


def read_npy(data):
    """Values of a float32 array in NumPy's format 1.0."""
    assert data[:8] == b"\x93NUMPY\x01\x00"
    size, = struct.unpack("<H", data[8:10])
    header = ast.literal_eval(data[10:10 + size].decode("latin1"))
    assert (10 + size) % 64 == 0 and data[9 + size:10 + size] == b"\n"
    assert header["descr"] == "<f4" and header["fortran_order"] is False
    height, width = header["shape"]
    assert len(data) == 10 + size + 4 * width * height
    return list(struct.unpack(f"<{width * height}f", data[10 + size:]))


class Generator(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)

    def test_bytes_do_not_depend_on_threads(self):
        for threads in 1, 2, 8:
            run("--out", self.folder / f"t{threads}", "--threads", threads, *SMALL)
        self.assertEqual(digest(self.folder / "t1"), digest(self.folder / "t2"))
        self.assertEqual(digest(self.folder / "t1"), digest(self.folder / "t8"))

    def test_ranges_made_separately_equal_one_run(self):
        run("--out", self.folder / "whole", *SMALL)
        for first, count in (5, 3), (0, 2), (2, 3):
            run("--out", self.folder / "parts", *SMALL, "--first", first, "--count", count)
        self.assertEqual(digest(self.folder / "whole"), digest(self.folder / "parts"))

    def test_all_formats_hold_the_same_picture(self):
        out, formats = self.folder / "a", "webdataset,npy,png16,pfm"
        run("--out", out, *SMALL, "--format", formats, "--threads", 2)
        run("--out", self.folder / "b", *SMALL, "--format", formats, "--threads", 1)
        self.assertEqual(digest(out), digest(self.folder / "b"))
        self.assertIn("0 faults", run("--out", out, *SMALL, "--format", formats, "--verify"))
        for row in csv.DictReader((out / "manifest.csv").read_text().splitlines()):
            values = read_npy((out / row["npy"]).read_bytes())
            picture = read_png((out / row["file"]).read_bytes())
            deep = read_png((out / row["png16"]).read_bytes())
            level = (out / row["pfm"]).read_bytes()
            self.assertTrue(level.startswith(b"Pf\n96 96\n-1"))
            rows = struct.unpack(f"<{96 * 96}f", level[-4 * 96 * 96:])
            self.assertEqual(values, [v for y in reversed(range(96)) for v in rows[96 * y:96 * y + 96]])
            for value, eight, sixteen in zip(values, picture, deep, strict=True):
                value = min(max(value, 0.0), 1.0)
                self.assertLessEqual(abs(value * 255 - eight), 0.5001)
                self.assertLessEqual(abs(value * 65535 - sixteen), 0.51)

    def test_tar_files_are_a_webdataset(self):
        out = self.folder / "a"
        options = ["--out", out, "--size", 16, "--count", 30, "--first", 985, "--format", "webdataset,npy"]
        run(*options)
        categories = {c["id"]: c["name"] for c in json.loads((out / "annotations.json").read_text())["categories"]}
        extensions = [".png", ".cls", ".target_mask.png", ".shadow_mask.png", ".seabed_mask.png", ".npy", ".json"]
        self.assertEqual(sorted(path.name for path in (out / "webdataset").iterdir()), ["000000.tar", "000001.tar"])
        index = 985
        for path in sorted((out / "webdataset").iterdir()):
            with tarfile.open(path, "r:") as tar:
                members = tar.getmembers()
                # Readers of a stream need the members of a sample next to one another.
                self.assertEqual(len(members) % len(extensions), 0)
                for at in range(0, len(members), len(extensions)):
                    sample = members[at:at + len(extensions)]
                    self.assertEqual([m.name for m in sample], [f"{index:09}{e}" for e in extensions])
                    bytes_of = {m.name[9:]: tar.extractfile(m).read() for m in sample}
                    record = json.loads(bytes_of[".json"])
                    self.assertEqual(record["id"], index)
                    self.assertEqual(categories[int(bytes_of[".cls"])], record["parameters"]["class"])
                    for entry, extension in zip(record["files"], [e for e in extensions if e not in (".cls", ".json")],
                                                strict=True):
                        self.assertEqual(hashlib.sha256(bytes_of[extension]).hexdigest(), entry["sha256"])
                    self.assertTrue(all(m.isreg() and m.mtime == 0 and m.uid == 0 for m in sample))
                    index += 1
            self.assertEqual(path.stat().st_size % 512, 0)
        self.assertEqual(index, 985 + 30)
        subprocess.run(["sha256sum", "--quiet", "-c", "SHA256SUMS"], cwd=out, check=True)
        tar = out / "webdataset" / "000001.tar"
        tar.write_bytes(tar.read_bytes()[:-1024])
        self.assertIn("webdataset/000001.tar: SHA-256 is", run(*options, "--verify", expect=1))
        run(*options)
        self.assertIn(" 0 faults", run(*options, "--verify"))

    def test_a_set_has_a_readme(self):
        out = self.folder / "a"
        run("--out", out, *SMALL, "--reference", pgm(self.folder / "r|f.pgm"))
        card = (out / "README.md").read_text()
        for text in ("8 images of 96 x 96 pixels", "seed 5", "insonify ", "| class | cone 2, cube 2, cylinder 2, sphere 2 |",
                     "| noise | [\"speckle:0.1\",\"poisson:200\"] |".replace("[", "\\["), "r\\|f.pgm", "| altitude_m | 8 |"):
            self.assertIn(text, card)
        for image in re.findall(r"!\[[^]]*\]\(([^)]*)\)", card):
            self.assertTrue((out / image).exists(), image)
        self.assertIn("README.md", (out / "SHA256SUMS").read_text())

    def test_shards_of_the_sonar_recipe_are_joined(self):
        options = ["--recipe", "sonar", "--count", 6, "--size", 64]
        run("--out", self.folder / "whole", *options)
        for k in range(2):
            run("--out", self.folder / "a", *options, "--shard", f"{k}/2")
        run(self.folder / "a", "--preview", program=MERGE)
        (self.folder / "a" / "preview.html").unlink()
        self.assertEqual(digest(self.folder / "whole"), digest(self.folder / "a"))
        # A job that is queued once more changes nothing.
        self.assertIn("is joined and has the images of shard 1", run("--out", self.folder / "a", *options, "--shard", "1/2"))
        self.assertEqual(digest(self.folder / "whole"), digest(self.folder / "a"))

    def test_a_killed_run_continues_to_the_same_bytes(self):
        run("--out", self.folder / "whole", *SMALL)
        whole = digest(self.folder / "whole")
        chance, killed = random.Random(1), self.folder / "killed"
        for number in range(KILLS):
            process = subprocess.Popen([GENERATOR, "--out", killed, *SMALL, "--threads", "2"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(chance.uniform(0.0, 0.25))
            process.kill()
            process.wait()
            for record in (killed / "records").rglob("*.json"):
                for file in json.loads(record.read_text())["files"]:
                    self.assertEqual(hashlib.sha256((killed / file["path"]).read_bytes()).hexdigest(), file["sha256"])
            if number % 8 == 7:
                run("--out", killed, *SMALL)
                self.assertEqual(whole, digest(killed))
                shutil.rmtree(killed)

    def test_an_interrupted_run_keeps_finished_images(self):
        options = ["--out", self.folder / "a", "--size", "256", "--count", "400"]
        process = subprocess.Popen([GENERATOR, *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while not list((self.folder / "a").rglob("records/*/*.json")) and process.poll() is None:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertIn("continues from here", errors)
        listed = json.loads((self.folder / "a" / "annotations.json").read_text())["images"]
        self.assertGreater(len(listed), 0)
        self.assertLess(len(listed), 400)
        for image in listed:
            self.assertTrue((self.folder / "a" / image["file_name"]).exists())

    def test_a_run_that_is_stopped_before_its_first_image_says_how_to_go_on(self):
        out = self.folder / "a"
        process = subprocess.Popen([GENERATOR, "--out", out, "--recipe", "published", "--size", "2048", "--count", "400"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while not (out / "config.json").exists() and process.poll() is None:
            time.sleep(0.001)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("continues from here", errors)
        self.assertIn("holds no images yet", run(out, program=MERGE, expect=1))

    def test_annotations_are_consistent_coco(self):
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
        rows = list(csv.reader((self.folder / "a" / "manifest.csv").read_text().splitlines()))
        self.assertEqual(len(rows), 9)
        self.assertEqual({len(row) for row in rows}, {len(rows[0])})

    def test_a_mesh_is_a_class_and_a_heightmap_a_seabed(self):
        (self.folder / "tetra.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
        heights = bytes(min(255, 100 + x % 7) for y in range(200) for x in range(200))
        (self.folder / "map.pgm").write_bytes(b"P5 200 200 255\n" + heights)
        run("--out", self.folder / "a", "--size", 64, "--count", 4, "--targets", "cube", "--mesh",
            f"tetra={self.folder / 'tetra.obj'}", "--heightmap", self.folder / "map.pgm", "--heightmap-spacing", 0.1,
            "--heightmap-scale", 0.2)
        self.assertEqual(len(list((self.folder / "a" / "images" / "tetra").rglob("*.png"))), 2)

    def test_a_mesh_without_faces_or_area_is_refused(self):
        mesh = self.folder / "m.obj"
        for text, reason in (("# nothing\n", "has no face"), ("v 1 1 1\nv 1 1 1\nv 2 2 2\nf 1 2 3\n", "have no area")):
            mesh.write_text(text)
            self.assertIn(reason, refusal("--out", self.folder / "a", "--mesh", f"wreck={mesh}"))
        self.assertFalse((self.folder / "a").exists())

    def read_labels(self, folder):
        """Rows of the manifest, with the boxes of target and shadow."""
        coco = json.loads((folder / "annotations.json").read_text())
        kinds = {c["id"]: c["supercategory"] for c in coco["categories"]}
        boxes = {(a["image_id"], kinds[a["category_id"]]): a["bbox"] for a in coco["annotations"]}
        for row in csv.DictReader((folder / "manifest.csv").read_text().splitlines()):
            values = {name: float(value) if name.endswith(("_m", "_deg", "_per_pixel")) and value else value
                      for name, value in row.items()}
            index = int(row["index"])
            yield values, boxes.get((index, "target")), boxes.get((index, "shadow"))

    def test_a_mesh_in_map_coordinates_is_refused(self):
        mesh = self.folder / "m.obj"
        mesh.write_text("v 500000 5400000 0\nv 500002 5400000 0\nv 500000 5400002 0\nv 500000 5400000 2\n"
                        "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
        self.assertIn("move it to the origin", refusal("--out", self.folder / "a", "--mesh", f"wreck={mesh}"))

    def test_labels_of_every_mode_match_closed_forms(self):
        # A sphere resting on level sand: the closed forms depend on its radius r and the height z of its centre.
        checked = {}
        for mode in "overhead", "ground_range", "slant_range":
            run("--out", self.folder / mode, "--mode", mode, "--chip", 6, "--pixels", 256, "--count", 12, "--seed", 2,
                "--targets", "sphere", "--seabeds", "sand", "--tilt", 0, "--burial", 0, "--aspect", 1, "--noise", "none",
                "--altitude", "4:8", "--target-size", "0.5:0.8",
                *(("--grazing", "14:25") if mode == "overhead" else ("--distance", "2:5")))
            for v, target, shadow in self.read_labels(self.folder / mode):
                pixel, r, z = v["metres_per_pixel"], v["target_size_m"] / 2, v["target_z_m"]
                a, x, slant = v["altitude_m"], v["ground_range_m"], mode == "slant_range"
                self.assertAlmostEqual(pixel, 6 / 256, places=3 if mode == "overhead" else 6)
                if mode == "overhead":  # tangents of the sphere from the light and from the camera
                    grazing = math.radians(v["grazing_deg"])
                    tip = x + z / math.tan(grazing) + r / math.sin(grazing)
                    first = -a * math.tan(math.atan2(-x, a - z) + math.asin(r / math.hypot(x, a - z)))
                else:
                    distance = math.hypot(x, a - z)
                    touching = math.atan2(a - z, x) - math.asin(r / distance)
                    tip = a / math.sin(touching) if slant else a / math.tan(touching)
                    # In ground range, the nearest visible point is on the side of the sphere.
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
                # Sand is rough by 4 mm, which moves the end of the shadow by some pixels.
                rough = 3 * 0.004 / math.tan(math.radians(v["grazing_deg"])) / pixel
                end = (tip - v["left_edge_m"]) / pixel
                self.assertAlmostEqual(shadow[0] + shadow[2], end, delta=1.5 + rough, msg=f"{mode} {v}")
                self.assertAlmostEqual(v["shadow_measured_m"], v["shadow_m"], delta=(2 + rough) * pixel)
                checked[mode] = checked.get(mode, 0) + 1
        for mode in "overhead", "ground_range", "slant_range":
            self.assertGreaterEqual(checked.get(mode, 0), 4, mode)

    def test_along_counts_from_below_for_a_camera_and_from_the_first_ping_for_a_sonar(self):
        for mode in "overhead", "slant_range":
            out = self.folder / mode
            run("--out", out, "--mode", mode, "--pixels", 64, "--count", 4, "--seabeds", "mud", "--aspects", "random",
                "--place", "anywhere")
            for v, target, _ in self.read_labels(out):
                top = (target[1] + target[3] / 2) / 64
                self.assertAlmostEqual(float(v["along"]), 1 - top if mode == "overhead" else top, delta=0.1)

    def test_shadows_that_are_not_there_have_no_length(self):
        # Targets of a few centimetres between rocks, and buried cones whose base the light reaches beyond the tip.
        run("--out", self.folder / "a", "--mode", "slant_range", "--pixels", 64, "--count", 24, "--seabeds", "rock,ripples",
            "--target-size", "0.05:0.1")
        run("--out", self.folder / "b", "--pixels", 64, "--count", 4, "--targets", "cone", "--grazing", 75, "--burial", 0.3)
        rows = self.read_manifest(self.folder / "a") + self.read_manifest(self.folder / "b")
        hidden = [row for row in rows if row["shadow_area_px"] == "0"]
        self.assertTrue(hidden)
        self.assertEqual({float(row["shadow_measured_m"]) for row in hidden}, {0})
        self.assertTrue(all(float(row["shadow_m"]) >= 0 for row in rows))

    def test_a_buried_wing_casts_no_shadow(self):
        # The far wing of this aeroplane lies below the datum.
        run("--out", self.folder / "a", "--recipe", "sonar", "--size", 96, "--seed", 5, "--first", 105, "--count", 1)
        row, = self.read_manifest(self.folder / "a")
        pixel = float(row["chip_m"]) / 96
        self.assertEqual((row["class"], row["shadow_is_cut"]), ("plane", "false"))
        self.assertGreater(float(row["shadow_m"]), 0)
        self.assertAlmostEqual(float(row["shadow_m"]), float(row["shadow_measured_m"]), delta=pixel)

    def test_every_mode_has_masks_and_bytes_that_do_not_depend_on_threads(self):
        for mode in "ground_range", "slant_range":
            options = ["--mode", mode, "--pixels", 64, "--count", 6, "--seabeds", "mixed,rock"]
            run("--out", self.folder / f"{mode}1", "--threads", 1, *options)
            run("--out", self.folder / f"{mode}3", "--threads", 3, *options)
            self.assertEqual(digest(self.folder / f"{mode}1"), digest(self.folder / f"{mode}3"))
            for kind in "target", "shadow", "seabed":
                self.assertEqual(len(list((self.folder / f"{mode}1" / "masks").rglob(f"*_{kind}.png"))), 6)

    def read_manifest(self, folder):
        return list(csv.DictReader((folder / "manifest.csv").read_text().splitlines()))

    def test_a_dry_run_prints_a_summary_and_writes_nothing(self):
        out = self.folder / "a"
        text = run("--out", out, *SMALL, "--dry-run")
        self.assertIn("8 images of 96 x 96 pixels, recipe published, seed 5", text)
        self.assertIn("classes: cone 2, cube 2, cylinder 2, sphere 2", text)
        self.assertRegex(text, r"about \d[\d.]* [kM]B, ")
        self.assertFalse(out.exists())
        text = run("--out", out, "--recipe", "sonar", "--per-class", "ship=3,empty=9", "--dry-run", "--shard", "1/3")
        self.assertIn("4 images of 128 x 128 pixels", text)
        self.assertIn("classes: empty 4", text)

    def test_the_sonar_recipe_has_empty_images_and_labels_targets(self):
        out = self.folder / "a"
        options = ["--recipe", "sonar", "--pixels", 64, "--count", 24]
        run("--out", out, *options, "--threads", 1)
        run("--out", self.folder / "b", *options, "--threads", 3)
        self.assertEqual(digest(out), digest(self.folder / "b"))
        self.assertIn("24 images checked, 0 faults", run("--out", out, *options, "--verify"))
        rows = self.read_manifest(out)
        self.assertEqual([row["class"] for row in rows].count("empty"), 9)
        self.assertEqual({row["class"] for row in rows}, {"ship", "plane", "empty"})
        coco = json.loads((out / "annotations.json").read_text())
        names = {category["id"]: category["name"] for category in coco["categories"]}
        self.assertEqual(sorted(names.values()), ["clutter", "plane", "shadow", "ship"])
        for row in rows:
            found = [names[a["category_id"]] for a in coco["annotations"] if a["image_id"] == int(row["index"])]
            if row["class"] == "empty":
                self.assertFalse({"ship", "plane"} & set(found))
                self.assertEqual(row["target_area_px"], "0")
            else:
                self.assertIn(row["class"], found)
                self.assertGreaterEqual(float(row["visible_share"]), 0.1)
                self.assertIn(row["target_is_cut"], ("true", "false"))
            # Every sampled value is in the row.
            for column in ("sonar", "display", "looks", "noise_floor", "tone_drift_db", "survey_grazing_deg", "port", "beam_rad",
                           "feature_m", "first_range_m", "rig_yaw_rad", "noise_seed"):
                self.assertNotEqual(row[column], "", column)

    def test_ships_are_buried_and_lines_run_along_aeroplanes(self):
        run("--recipe", "sonar", "--out", self.folder / "a", "--pixels", 16, "--visible-share", 0, "--seed", 4,
            "--per-class", "ship=60,plane=60")
        rows = self.read_manifest(self.folder / "a")
        buried = {kind: sum(float(row["t1_burial"]) > 0 for row in rows if row["class"] == kind) for kind in ("ship", "plane")}
        self.assertGreater(buried["ship"], 45)
        self.assertLess(buried["plane"], 15)
        inspected = [row for row in rows if row["t1_along_line"] == "true"]
        self.assertGreater(sum(row["class"] == "plane" for row in inspected), 25)
        for row in inspected:
            step = math.pi / 2 if row["class"] == "plane" else math.pi
            off = (float(row["t1_yaw_rad"]) - float(row["rig_yaw_rad"]) - math.pi / 2) / step
            self.assertLess(abs(off - round(off)) * step, 0.301)

    def test_other_objects_stand_upright_unless_they_have_sunk_in(self):
        run("--recipe", "sonar", "--out", self.folder / "a", "--pixels", 16, "--visible-share", 0, "--seed", 4,
            "--per-class", "cylinder=40,cube=40,crate=40")
        poses = [(float(row["t1_burial"]), abs(float(row["t1_roll_rad"]))) for row in self.read_manifest(self.folder / "a")]
        upright = [roll for burial, roll in poses if burial == 0]
        self.assertTrue(40 < len(upright) < 80, len(upright))
        self.assertLessEqual(max(upright), 0.05)
        self.assertLessEqual(max(burial for burial, _ in poses), 0.3)
        self.assertGreater(max(roll for _, roll in poses), 0.15)

    def test_chips_of_small_objects_have_room_for_shadows(self):
        run("--recipe", "sonar", "--out", self.folder / "a", "--pixels", 16, "--visible-share", 0, "--per-class",
            "cylinder=20,tyre=20,ship=20")
        for row in self.read_manifest(self.folder / "a"):
            fill = float(row["fill"])
            low, high = (0.7, 1.35) if row["class"] == "ship" else (0.1, 0.4)
            self.assertTrue(low <= fill <= high, (row["class"], fill))
            self.assertGreater(float(row["chip_m"]), float(row["t1_length_m"]) * (0.3 if row["class"] == "ship" else 1.2))

    def test_gain_slopes_up_and_down_by_up_to_8_decibels(self):
        run("--recipe", "sonar", "--out", self.folder / "a", "--pixels", 16, "--visible-share", 0, "--count", 120)
        slopes = [float(row["gain_slope_db"]) for row in self.read_manifest(self.folder / "a")]
        sizes = sorted(map(abs, slopes))
        self.assertGreaterEqual(sizes[0], 0.2)
        self.assertLessEqual(sizes[-1], 8)
        self.assertGreater(sum(size > 1.6 for size in sizes), 35)  # 44 % expected: uniform in the logarithm
        for rising in (True, False):
            self.assertGreater(sum((slope > 0) == rising for slope in slopes), 40)

    def test_per_class_counts_are_exact(self):
        counts = {"truncated_cone": 3, "empty": 2, "crate": 1}
        run("--recipe", "sonar", "--out", self.folder / "a", "--pixels", 32, "--visible-share", 0, "--per-class",
            ",".join(f"{name}={count}" for name, count in counts.items()))
        rows = self.read_manifest(self.folder / "a")
        self.assertEqual({name: [row["class"] for row in rows].count(name) for name in counts}, counts)
        self.assertIn("is not CLASS=COUNT", refusal("--recipe", "sonar", "--out", "x", "--per-class", "submarine=3"))
        self.assertIn("is not CLASS=COUNT", refusal("--recipe", "sonar", "--out", "x", "--per-class", "ship=0"))
        self.assertIn("'ship' appears twice",
                      refusal("--recipe", "sonar", "--out", "x", "--per-class", "ship=1,plane=1,ship=2"))
        self.assertIn("is not CLASS=COUNT", refusal("--out", "x", "--targets", "cube", "--per-class", "cone=3"))

    def test_options_of_the_other_recipe_are_refused(self):
        for option, value in (("--mode", "overhead"), ("--mesh-up", "z"), ("--heightmap-spacing", 1),
                              ("--heightmap-scale", 1)):
            self.assertIn(f"{option}: belongs to --recipe published",
                          refusal("--recipe", "sonar", "--out", "x", option, value))
        self.assertIn("belongs to --recipe sonar", refusal("--out", "x", "--empty", "0.5"))

    def test_options_without_the_one_that_they_describe_are_refused(self):
        for option, value, needed in (("--mesh-up", "z", "--mesh"), ("--heightmap-spacing", 1, "--heightmap"),
                                      ("--heightmap-scale", 1, "--heightmap"), ("--match", "whole", "--reference")):
            self.assertIn(f"{option}: needs {needed}", refusal("--out", "x", "--recipe", "published", option, value))
        (self.folder / "map.pgm").write_bytes(b"P5 2 2 255\n\0\1\2\3")
        self.assertIn("--heightmap: has no effect; add heightmap to --seabeds",
                      refusal("--out", "x", "--recipe", "published", "--heightmap", self.folder / "map.pgm", "--seabeds", "mud"))

    def test_targets_of_the_other_recipe_are_refused(self):
        self.assertIn("belongs to --recipe sonar", refusal("--out", "x", "--targets", "ship"))

    def test_options_of_other_modes_are_refused(self):
        for mode, options in (("overhead", ("--distance", "--beam")),
                              ("slant_range", ("--grazing", "--intensity", "--sky")),
                              ("ground_range", ("--grazing", "--intensity", "--sky"))):
            for option in options:
                self.assertIn(f"{option}: has no effect in --mode {mode}",
                              refusal("--out", "x", "--mode", mode, option, 3))
        self.assertIn("--chip: '0' must be above 0 in --mode slant_range",
                      refusal("--out", "x", "--mode", "slant_range", "--chip", 0))
        # Lines of a plan may have any mode.
        plan = self.folder / "plan.csv"
        plan.write_text("index,class,mode,chip_m\n0,cube,slant_range,4\n1,cube,overhead,4\n")
        run("--out", self.folder / "a", "--plan", plan, "--size", 32, "--distance", 3, "--grazing", 20)
        slant, overhead = self.read_manifest(self.folder / "a")
        self.assertEqual((slant["distance"], slant["light_deg"]), ("3.0", ""))
        self.assertEqual((overhead["distance"], overhead["light_deg"]), ("", "20.0"))

    def test_masked_matching_keeps_shadows_dark(self):
        reference = pgm(self.folder / "r.pgm")
        dark = {}
        for match in ("masked", "whole"):
            out = self.folder / match
            run("--out", out, "--mode", "slant_range", "--pixels", 96, "--count", 4, "--reference", reference, "--match",
                match)
            dark[match] = self.gray_of_shadows(out)
        self.assertLess(dark["masked"], dark["whole"])

    def test_many_shadows_stay_dark(self):
        # The reference has all gray values from 0 to 255 equally often: its darkest twentieth ends at 12.
        (self.folder / "ramp.pgm").write_bytes(b"P5 256 16 255\n" + bytes(range(256)) * 16)
        for seabed in "rock", "ripples":
            run("--out", self.folder / seabed, "--size", 96, "--count", 4, "--seabeds", seabed, "--noise", "none", "--chip", 8,
                "--reference", self.folder / "ramp.pgm")
            self.assertLess(self.gray_of_shadows(self.folder / seabed), 10, seabed)

    def test_targets_cut_by_the_edge_are_marked(self):
        for mode in "overhead", "ground_range", "slant_range":
            out = self.folder / mode
            run("--out", out, "--mode", mode, "--place", "anywhere", "--chip", 4, "--size", 64, "--count", 24, "--seabeds", "sand",
                "--noise", "none", "--targets", "cylinder")
            boxes, marks = {}, set()
            for values, target, _ in self.read_labels(out):
                at_edge = target is None or min(target[:2]) == 0 or target[0] + target[2] == 64 or target[1] + target[3] == 64
                marks.add(values["target_is_cut"])
                if values["target_is_cut"] == "false":
                    self.assertIsNotNone(target)
                    # A whole target may touch the last pixel, and glints may spread by one.
                    inner = target[0] > 0 and target[1] > 0 and target[0] + target[2] < 64 and target[1] + target[3] < 64
                    boxes.setdefault("whole", []).append(inner)
                else:
                    boxes.setdefault("cut", []).append(at_edge)
            self.assertEqual(marks, {"true", "false"}, mode)
            for kind, right in boxes.items():
                self.assertGreaterEqual(sum(right), 0.8 * len(right), f"{mode} {kind} {right}")

    def gray_of_shadows(self, folder):
        """Mean gray value of the targets' shadows."""
        inside = []
        for picture in sorted((folder / "images").rglob("*.png")):
            mask = folder / "masks" / picture.parent.name / f"{picture.stem}_shadow.png"
            inside += [gray for gray, is_dark in zip(read_png(picture.read_bytes()), read_png(mask.read_bytes())) if is_dark]
        return sum(inside) / len(inside)

    def test_options_from_a_config_file(self):
        (self.folder / "set.toml").write_text('size = 64\ncount = 2\nseed = 9\ntargets = ["cone"]\n')
        run("--config", self.folder / "set.toml", "--out", self.folder / "a")
        self.assertEqual(len(list((self.folder / "a" / "images" / "cone").rglob("*.png"))), 2)

    def test_invalid_options_are_refused_with_a_reason(self):
        def refused(text, *options, expect=2):
            self.assertIn(text, run(*options, expect=expect))
        out = ["--out", self.folder / "a"]
        refused("--out is required")
        refused("--sead is not an option; did you mean --seed?", *out, "--sead", 3)
        refused("--nonsense is not an option", "--nonsense")
        refused("tank", *out, "--targets", "tank")
        refused("lava", *out, "--seabeds", "lava")
        refused("'fog' is not one of", *out, "--noise", "fog")
        refused("low is above high", *out, "--altitude", "6:4")
        refused("neither a number nor a range", *out, "--grazing", "steep")
        refused("must lie within", *out, "--grazing", "0")
        refused("needs a side-scan mode", *out, "--noise", "seabed")
        refused("sideways", *out, "--mode", "sideways")
        refused("is not CLASS=FILE", *out, "--mesh", "wreck.obj")
        refused("--count: '-1' is not a whole number", *out, "--count", "-1")
        refused("from 1 to 1000000000", *out, "--count", 10**12)
        refused("--first: '-1'", *out, "--first", "-1")
        refused("ids have nine digits", *out, "--first", 10**9 - 1, "--count", 2)
        refused("--seed: '-1'", *out, "--seed", "-1")
        refused("neither a number nor a range", *out, "--altitude", "nan")
        refused("--heightmap-scale: '1e38'", *out, "--heightmap-scale", "1e38")
        refused("--intensity: 'inf'", *out, "--intensity", "inf")
        refused("--chip: 10000 m from an --altitude", *out, "--chip", "10000", "--altitude", "0.01")
        refused("--distance: 1000 times an --altitude", *out, "--mode", "slant_range", "--distance", 1000, "--altitude",
                "1000")
        refused("appears twice", *out, "--targets", "cylinder,cylinder,cube")
        for taken in "shadow", "empty", "cylinder", "Cube":
            refused(f"the class {taken} is taken", *out, "--mesh", f"{taken}=f.obj")
        refused("the class wreck is taken", *out, "--mesh", "wreck=f.obj", "--mesh", "wreck=g.obj")
        for name in 'a,b', 'a"b', "a/b", "", "..", "a b":
            refused("is not CLASS=FILE", *out, "--mesh", f"{name}=f.obj")
        refused("does not exist", *out, "--reference", self.folder / "nowhere")
        refused("--out: an empty name is not a folder", "--out", "")
        self.assertFalse((self.folder / "a").exists())
        (self.folder / "other").mkdir()
        (self.folder / "other" / "thesis.txt").write_text("mine")
        refused("is not empty", "--out", self.folder / "other", expect=1)
        run(*out, *SMALL)
        refused("seed was 5, is 6", *out, *SMALL, "--seed", "6", expect=1)
        # The library's names of arguments are replaced by options.
        refused("pings in the beam (--beam, --chip, --size)", "--out", self.folder / "b", "--mode", "slant_range",
                "--beam", 20, "--chip", 0.5, "--size", 4096, "--count", 1, expect=1)

    def test_a_config_file_holds_only_options(self):
        config, out = self.folder / "set.toml", self.folder / "a"
        for text, reason in ((b"size = 64\nfoo = 3\n", "set.toml: line 2: 'foo' is not an option"),
                             (b"[scene]\nsize = 64\n", "line 1: '[scene]' is a section"),
                             (b"size = 64\nhello\n", "line 2: 'hello' is not `option = value`"),
                             (b"\x7fELF\x02\x01\0\0\n", "line 1: this is not a text file"),
                             (b"count = -1\n", "--count: '-1'"), (b"count =\n", "'count' has no value"),
                             (b"targets = [\n\"cone\",\n]\n", "begin the list on this line"),
                             (b"out = my sets/a\n", "line 1: 'out': put a value with blanks in quotes"),
                             (b"targets = [\"cone\",\n\"cube\"\n", "line 2: ']' is missing"),
                             (b"targets = [\"cone\"", "line 1: ']' is missing")):
            config.write_bytes(text)
            self.assertIn(reason, refusal("--config", config, "--out", out))
            self.assertFalse(out.exists())
        config.write_text('# a set\nsize = 64  # small\ncount = 2\ntargets = ["cone",  # first\n  "cube"] # both\n')
        run("--config", config, "--out", out)
        self.assertEqual(len(digest(out / "images")), 2)

    def test_a_config_file_names_folders_with_blanks_in_quotes(self):
        config = self.folder / "set.toml"
        config.write_text(f'size = 32\ncount = 1\nout = "{self.folder}/my sets"\n')
        run("--config", config)
        self.assertEqual(len(digest(self.folder / "my sets" / "images")), 1)

    @unittest.skipUnless(hasattr(os, "mkfifo"), "needs pipes")
    def test_folders_pipes_and_devices_are_refused_as_input(self):
        os.mkfifo(self.folder / "pipe")
        for path in self.folder / "pipe", "/dev/zero":
            for option in ("--reference", "--heightmap", "--config"):
                self.assertIn("is a folder, pipe or device", refusal("--out", self.folder / "a", option, path))
            self.assertIn("is a folder, pipe or device", refusal("--out", self.folder / "a", "--mesh", f"a={path}"))
        with open(self.folder / "large.pgm", "wb") as file:
            file.truncate(2 << 20)
        self.assertIn("raise --input-limit", refusal("--out", self.folder / "a", "--input-limit", 1, "--reference",
                                                     self.folder / "large.pgm"))
        (self.folder / "empty").mkdir()
        (self.folder / "empty" / "notes.txt").write_text("none yet")
        self.assertIn("holds no PNG", refusal("--out", self.folder / "a", "--reference", self.folder / "empty"))
        self.assertFalse((self.folder / "a").exists())

    def test_picture_formats_are_recognized_by_content(self):
        # 16 bits under a name that is not .pgm.
        images = set()
        for name in "x.pgm", "x.PGM", "x", "x.png":
            path = pgm(self.folder / name, 65535)
            run("--out", self.folder / f"set_{name}", *SMALL, "--reference", path)
            images.add(json.dumps(digest(self.folder / f"set_{name}" / "images")))
        self.assertEqual(len(images), 1)
        (self.folder / "p6.jpg").write_bytes(b"P6 2 2 65535\n" + bytes(range(24)))
        run("--out", self.folder / "color", *SMALL, "--reference", self.folder / "p6.jpg")
        (self.folder / "bomb.png").write_bytes(
            b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + struct.pack(">IIBBBBBI", 1 << 30, 1 << 30, 8, 0, 0, 0, 0, 0))
        self.assertIn("more pixels than can be read",
                      refusal("--out", self.folder / "a", "--reference", self.folder / "bomb.png"))
        # A file of 86 bytes whose chunk claims 1.2 GB, which must not be allocated.
        torn = pathlib.Path(__file__).parents[2] / "tests" / "fuzz" / "corpus" / "picture" / "huge_chunk.png"
        self.assertIn("ends within a chunk", refusal("--out", self.folder / "a", "--reference", torn))
        # A Huffman table of 257 symbols, which makes stb_image 2.27 write beyond an array.
        torn = torn.with_name("huffman_symbols.jpg")
        self.assertIn("more than 256 symbols", refusal("--out", self.folder / "a", "--reference", torn))
        (self.folder / "not.png").write_text("hello")
        self.assertIn("is not a PNG", refusal("--out", self.folder / "a", "--reference", self.folder / "not.png"))

    def test_heights_are_bounded(self):
        heights = b"".join(struct.pack("<f", 1e30) for _ in range(16))
        (self.folder / "map.pfm").write_bytes(b"Pf\n4 4\n-1.0\n" + heights)
        self.assertIn("--heightmap-scale", refusal("--out", self.folder / "a", "--heightmap", self.folder / "map.pfm"))

    def test_a_file_that_cannot_be_written_is_named(self):
        run("--out", self.folder / "a", *SMALL, "--count", "1")
        (self.folder / "a" / "annotations.json").unlink()
        (self.folder / "a" / "annotations.json").mkdir()
        self.assertIn("annotations.json", run("--out", self.folder / "a", *SMALL, expect=1))

    def test_the_folder_holds_a_million_images_in_order(self):
        options = ["--size", 32, "--count", 3, "--targets", "cube", "--seabeds", "sand"]
        run("--out", self.folder / "a", *options, "--first", 999_999)
        run("--out", self.folder / "a", *options, "--first", 999_999_000)
        names = sorted(path.relative_to(self.folder / "a" / "images").as_posix()
                       for path in (self.folder / "a" / "images").rglob("*.png"))
        self.assertEqual(names, ["cube/000999/000999999.png", "cube/001000/001000000.png", "cube/001000/001000001.png",
                                 *(f"cube/999999/{i}.png" for i in (999999000, 999999001, 999999002))])
        with open(self.folder / "a" / "manifest.csv", newline="") as file:
            self.assertEqual([row["file"] for row in csv.DictReader(file)], [f"images/{name}" for name in names])

    def test_the_manifest_has_every_file_and_parameter(self):
        references = self.folder / "references"
        references.mkdir()
        pgm(references / 'a,"b".pgm')
        out = self.folder / "a"
        run("--out", out, "--mode", "slant_range", "--pixels", 64, "--count", 12, "--reference", references)
        with open(out / "manifest.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 12)
        for row in rows:
            self.assertEqual(row["reference_name"], 'a,"b".pgm')
            for of in "file", "target_mask", "shadow_mask", "seabed_mask":
                data = (out / row[of]).read_bytes()
                self.assertEqual((len(data), hashlib.sha256(data).hexdigest()),
                                 (int(row[f"{of}_bytes"]), row[f"{of}_sha256"]))
            self.assertIn(row["side"], ("port", "starboard"))
            self.assertTrue(0.2 <= float(row["beam_deg"]) <= 0.5)
            self.assertTrue(0.003 <= float(row["noise_floor"]) <= 0.03)
            self.assertEqual(row["ripple_wavelength_m"] != "", row["seabed"] == "ripples")
            # The rig is at the target's distance across the track, and at most a chip away along it.
            away = math.hypot(float(row["rig_x_m"]) - float(row["target_x_m"]),
                              float(row["rig_y_m"]) - float(row["target_y_m"]))
            self.assertAlmostEqual(away, float(row["ground_range_m"]), delta=3)
        self.assertEqual({path.relative_to(out).as_posix() for path in out.rglob("*.png")},
                         {row[of] for row in rows for of in ("file", "target_mask", "shadow_mask", "seabed_mask")})
        for line in (out / "SHA256SUMS").read_text().splitlines():
            sum_, name = line.split()
            self.assertEqual(hashlib.sha256((out / name).read_bytes()).hexdigest(), sum_)

    def test_the_display_can_be_that_of_a_given_sonar(self):
        def pictures(name):
            return {path: sum_ for path, sum_ in digest(self.folder / name).items() if path.startswith("images/")}
        options = "--mode", "slant_range", "--pixels", 48, "--count", 4, "--noise", "none", "--format", "npy", "--white", 8
        values = {}
        for display in "amplitude", "power", "decibels":
            run("--out", self.folder / display, *options, "--display", display)
            rows = self.read_manifest(self.folder / display)
            values[display] = [v for row in rows for v in read_npy((self.folder / display / row["npy"]).read_bytes())]
            self.assertEqual({row["display"] for row in rows}, {display})
            self.assertEqual({row["white"] for row in rows}, {"8.0"})
            self.assertEqual({row["display_range_db"] for row in rows}, {"40.0" if display == "decibels" else ""})
        self.assertGreater(len(set(values["power"])), 1000)
        for power, amplitude, decibels in zip(values["power"], values["amplitude"], values["decibels"]):
            self.assertAlmostEqual(amplitude, math.sqrt(power), delta=1e-6)
            if power < 1:
                self.assertAlmostEqual(decibels, max(0, 1 + math.log10(max(power, 1e-9)) / 4), delta=1e-5)
        run("--out", self.folder / "plain", *options)
        self.assertEqual(pictures("plain"), pictures("amplitude"))
        run("--out", self.folder / "again", "--plan", self.folder / "decibels/manifest.csv")
        self.assertEqual(pictures("again"), pictures("decibels"))

        run("--recipe", "sonar", "--out", self.folder / "sonar", "--pixels", 32, "--count", 6, "--visible-share", 0,
            "--display", "decibels", "--display-range", "30:35", "--white", 4)
        for row in self.read_manifest(self.folder / "sonar"):
            self.assertEqual((row["display"], float(row["white"])), ("decibels", 4))
            self.assertTrue(30 <= float(row["display_range_db"]) <= 35)
        side_scan = "--out", "x", "--mode", "slant_range"
        self.assertIn("--display: needs a side-scan mode", refusal("--out", "x", "--display", "power"))
        self.assertIn("needs --display decibels", refusal(*side_scan, "--display-range", 30))
        self.assertIn("--white: '0' must lie within", refusal(*side_scan, "--white", 0))

    def test_a_folder_whose_first_run_was_killed_early_is_accepted(self):
        run("--out", self.folder / "whole", *SMALL)
        out = self.folder / "killed"
        leftover = out / ".partial/all/somewhere-1-0"
        leftover.parent.mkdir(parents=True)
        leftover.write_text("{")
        run("--out", out, *SMALL)
        self.assertEqual(digest(self.folder / "whole"), digest(out))

    def test_a_run_repairs_damaged_files(self):
        out, chance = self.folder / "a", random.Random(3)
        run("--out", out, *SMALL)
        whole = digest(out)
        def flipped(data):
            at = chance.randrange(len(data))
            return data[:at] + bytes([data[at] ^ 1 << chance.randrange(8)]) + data[at + 1:]
        for damage in (None, lambda data: data[:len(data) // 2], lambda data: bytes(len(data)), flipped, lambda data: b"",
                       lambda data: b"{}\n"):
            for name in chance.sample(sorted(set(whole) - {"config.json"}), 12):
                if damage is None:
                    (out / name).unlink()
                else:
                    (out / name).write_bytes(damage((out / name).read_bytes()))
            self.assertIn("repairs them", run("--out", out, *SMALL, "--verify", expect=1))
            run("--out", out, *SMALL)
            self.assertEqual(whole, digest(out))
            self.assertIn("8 images checked, 0 faults", run("--out", out, *SMALL, "--verify"))
        (out / "config.json").write_text("{")
        self.assertIn("config.json: is damaged", run("--out", out, *SMALL, expect=1))

    def test_a_damaged_record_is_named(self):
        out = self.folder / "a"
        run("--out", out, *SMALL)
        for text in "{}", "", '{"id": 7', "null\n":
            (out / "records" / "000000" / "000000007.json").write_text(text)
            self.assertRegex(run("--out", out, *SMALL, "--count", 4, expect=1), "000000007.json: is truncated or altered")

    def test_verify_compares_masks_with_annotations(self):
        # A record with a valid checksum that contradicts the mask.
        out = self.folder / "a"
        run("--out", out, *SMALL)
        path = out / "records" / "000000" / "000000002.json"
        record = json.loads(path.read_text())
        counts = record["annotations"][0]["segmentation"]["counts"]
        counts[0], counts[-1] = counts[0] + 1, counts[-1] - 1
        del record["sha256"]
        text = json.dumps(record, separators=(",", ":"))[:-1]
        path.write_text(f'{text},"sha256":"{hashlib.sha256(text.encode()).hexdigest()}"}}\n')
        self.assertIn("is not what the annotation says", run("--out", out, *SMALL, "--verify", expect=1))

    def test_inputs_are_pinned_by_content(self):
        options = ["--out", self.folder / "a", *SMALL, "--reference", self.folder / "r.pgm"]
        before = hashlib.sha256(pgm(self.folder / "r.pgm").read_bytes()).hexdigest()
        run(*options)
        (self.folder / "moved").mkdir()
        (self.folder / "r.pgm").rename(self.folder / "moved" / "r.pgm")
        options[-1] = self.folder / "moved" / "r.pgm"
        self.assertIn("0 of them new", run(*options))
        after = hashlib.sha256(pgm(self.folder / "moved" / "r.pgm", 254).read_bytes()).hexdigest()
        self.assertRegex(run(*options, expect=1), f"--reference r.pgm was .*{before}.*, is .*{after}")
        pgm(self.folder / "moved" / "r.pgm")
        config = self.folder / "a" / "config.json"
        config.write_text(config.read_text().replace('"version": "insonify ', '"version": "insonify 9'))
        self.assertRegex(run(*options, expect=1), r'version was "insonify 9[\d.]+", is "insonify \d')

    @unittest.skipUnless(sys.platform == "linux", "needs file names that are not UTF-8")
    def test_inputs_may_have_names_that_are_not_utf_8(self):
        picture, mesh = os.fsencode(self.folder) + b"/b\xfcld.pgm", os.fsencode(self.folder) + b"/wr\xe4ck.obj"
        os.rename(pgm(self.folder / "r.pgm"), picture)
        with open(mesh, "w") as file:
            file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
        command = [GENERATOR, *with_recipe(SMALL), "--reference", picture, "--mesh", b"wreck=" + mesh, "--out"]
        first = subprocess.run([*command, self.folder / "a"], capture_output=True, timeout=300)
        self.assertEqual(first.returncode, 0, first.stderr)
        again = subprocess.run([*command, self.folder / "a"], capture_output=True, timeout=300)
        self.assertIn(b"0 of them new", again.stdout, again.stderr)
        replayed = subprocess.run([GENERATOR, "--plan", self.folder / "a" / "manifest.csv", "--reference", picture,
                                   "--mesh", b"wreck=" + mesh, "--out", self.folder / "b"], capture_output=True,
                                  timeout=300)
        self.assertEqual(replayed.returncode, 0, replayed.stderr)
        self.assertEqual(digest(self.folder / "a" / "images"), digest(self.folder / "b" / "images"))

    def test_a_billion_images_start_at_once(self):
        process = subprocess.Popen([GENERATOR, "--out", self.folder / "a", "--size", "32", "--count", "1000000000"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not list((self.folder / "a").rglob("records/*/*.json")) and process.poll() is None:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        process.returncode = 130  # already reaped
        _, status, usage = os.wait4(process.pid, 0)
        self.assertEqual(os.waitstatus_to_exitcode(status), 130)
        self.assertLess(usage.ru_maxrss, 300 << 10)


@unittest.skipUnless(shutil.which("cc") and sys.platform == "linux", "needs a C compiler and a preloaded library")
class FailingCalls(unittest.TestCase):
    """The generator on a system where some calls fail."""

    SHIM = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdlib.h>
static int left(const char* name) { const char* text = getenv(name); return text ? atoi(text) : 1 << 30; }
static int refuse_lock(int command) { return command == F_SETLK && left("SHIM_LOCK") != 1 << 30; }
int fcntl(int file, int command, ...) {
    va_list list; va_start(list, command); void* argument = va_arg(list, void*); va_end(list);
    if (refuse_lock(command)) { errno = left("SHIM_LOCK"); return -1; }
    return ((int (*)(int, int, ...))dlsym(RTLD_NEXT, "fcntl"))(file, command, argument);
}
int fcntl64(int file, int command, ...) {
    va_list list; va_start(list, command); void* argument = va_arg(list, void*); va_end(list);
    if (refuse_lock(command)) { errno = left("SHIM_LOCK"); return -1; }
    return ((int (*)(int, int, ...))dlsym(RTLD_NEXT, "fcntl"))(file, command, argument);
}
int fsync(int file) {
    static int calls = 0;
    if (__sync_fetch_and_add(&calls, 1) >= left("SHIM_SYNCS")) { errno = ENOSPC; return -1; }
    return ((int (*)(int))dlsym(RTLD_NEXT, "fsync"))(file);
}
int rename(const char* from, const char* to) {
    static int calls = 0;
    if (__sync_fetch_and_add(&calls, 1) >= left("SHIM_RENAMES")) { errno = EROFS; return -1; }
    return ((int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename"))(from, to);
}
int pthread_create(pthread_t* t, const pthread_attr_t* a, void* (*f)(void*), void* x) {
    static int calls = 0;
    if (__sync_fetch_and_add(&calls, 1) >= left("SHIM_THREADS")) return EAGAIN;
    return ((int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*))dlsym(RTLD_NEXT, "pthread_create"))(
        t, a, f, x);
}
"""

    @classmethod
    def setUpClass(cls):
        cls.home = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.home.cleanup)
        source, cls.shim = pathlib.Path(cls.home.name) / "shim.c", pathlib.Path(cls.home.name) / "shim.so"
        source.write_text(cls.SHIM)
        subprocess.run(["cc", "-shared", "-fPIC", "-o", cls.shim, source, "-ldl"], check=True)
        run("--out", pathlib.Path(cls.home.name) / "whole", *SMALL)
        cls.whole = digest(pathlib.Path(cls.home.name) / "whole")

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)

    def preloaded(self, *options, expect=0, **limits):
        return run(*options, expect=expect, LD_PRELOAD=str(self.shim),
                   **{f"SHIM_{name.upper()}": str(value) for name, value in limits.items()})

    def test_runs_with_fewer_threads_if_some_cannot_start(self):
        for threads in 0, 3, 20:
            out = self.folder / str(threads)
            self.assertIn("--threads 64: the system started",
                          self.preloaded("--out", out, *SMALL, "--threads", 64, threads=threads))
            self.assertEqual(self.whole, digest(out))

    def test_a_failed_lock_is_reported_with_the_reason(self):
        self.assertIn("another generator is running",
                      self.preloaded("--out", self.folder / "a", *SMALL, expect=1, lock=errno.EAGAIN))
        for reason in errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS:
            text = self.preloaded("--out", self.folder / str(reason), *SMALL, lock=reason)
            self.assertIn(f"no file locks here ({os.strerror(reason)})", text)
            self.assertEqual(self.whole, digest(self.folder / str(reason)))

    def test_concurrent_runs_without_locks_leave_the_same_bytes(self):
        environment = os.environ | {"LD_PRELOAD": str(self.shim), "SHIM_LOCK": str(errno.ENOLCK)}
        for round_ in range(max(4, KILLS // 4)):
            out = self.folder / str(round_)
            processes = [subprocess.Popen([GENERATOR, "--out", out, *SMALL], env=environment, stderr=subprocess.PIPE,
                                          stdout=subprocess.DEVNULL, text=True) for _ in range(4)]
            for process in processes:
                _, errors = process.communicate(timeout=300)
                self.assertEqual(process.returncode, 0, errors)
            self.assertEqual(self.whole, digest(out))

    @unittest.skipIf(os.name != "posix" or os.geteuid() == 0, "needs a user who is not root")
    def test_a_read_only_folder_is_named(self):
        (self.folder / "a").mkdir(mode=0o500)
        self.assertIn("Permission denied", run("--out", self.folder / "a", *SMALL, expect=1))

    def test_a_failing_disk_is_named_and_the_next_run_continues(self):
        for calls in 0, 1, 5, 12, 30, 45:
            for limit, reason in (("syncs", errno.ENOSPC), ("renames", errno.EROFS)):
                out = self.folder / f"{limit}{calls}"
                result = self.preloaded("--out", out, *SMALL, "--threads", 2, expect=None, **{limit: calls})
                if limit == "syncs":
                    self.assertIn(os.strerror(reason), result)
                run("--out", out, *SMALL)
                self.assertEqual(self.whole, digest(out))


class Shards(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)
        run("--out", self.folder / "whole", *SMALL)
        self.whole = digest(self.folder / "whole")

    def test_concurrent_shards_in_one_folder_equal_one_run(self):
        out = self.folder / "a"
        processes = [subprocess.Popen([GENERATOR, "--out", out, *SMALL, "--shard", f"{k}/3"], stdout=subprocess.DEVNULL)
                     for k in (2, 0, 1)]
        self.assertEqual([process.wait() for process in processes], [0] * 3)
        run("--out", out, *SMALL, "--shard", "1/3")  # submitted again
        run(out, program=MERGE)
        self.assertEqual(self.whole, digest(out))

    @unittest.skipUnless(shutil.which("parallel"), "needs GNU parallel")
    def test_the_documented_gnu_parallel_command(self):
        page = pathlib.Path(__file__).parents[2] / "docs" / "dataset.md"
        line = re.search(r"^parallel .*\n.*merge_dataset set$", page.read_text(), re.MULTILINE)[0]
        line = line.replace("--count 1000000", " ".join(SMALL)).replace("/64", "/4").replace("seq 0 63", "seq 0 3")
        for name, program in ("generate_dataset", GENERATOR), ("merge_dataset", MERGE):
            (self.folder / name).symlink_to(pathlib.Path(program).resolve())
        result = subprocess.run(["bash", "-c", line], cwd=self.folder, capture_output=True, text=True, timeout=300,
                                env=os.environ | {"PATH": f"{self.folder}:{os.environ['PATH']}"})
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.whole, digest(self.folder / "set"))

    def test_shards_in_separate_folders_are_joined(self):
        for k in range(8):
            run("--out", self.folder / f"s{k}", *SMALL, "--shard", f"{k}/8")
            self.assertEqual(len(list((self.folder / f"s{k}" / "images").rglob("*.png"))), 1)
        folders = [self.folder / f"s{k}" for k in range(8)]
        text = run(self.folder / "a", *folders[:3], *folders[4:7], program=MERGE, expect=1)
        self.assertIn("2 of 8 images are missing", text)
        self.assertIn("shard 3/8 lacks 1 of its images, such as 000000003", text)
        self.assertIn("no: holds no data set", run(self.folder / "b", folders[0], self.folder / "no", program=MERGE, expect=1))
        self.assertFalse((self.folder / "b").exists())
        self.assertFalse((self.folder / "a" / "annotations.json").exists())
        image = next((self.folder / "s3" / "images").rglob("*.png"))
        good = image.read_bytes()
        image.write_bytes(good[:-1])
        self.assertIn("run the shard again", run(self.folder / "a", *folders, program=MERGE, expect=1))
        image.write_bytes(good)
        run(self.folder / "a", *folders, program=MERGE)
        self.assertEqual(self.whole, digest(self.folder / "a"))

    def test_a_merge_names_shards_whose_files_are_missing_or_short(self):
        for k in range(2):
            run("--out", self.folder / "a", *SMALL, "--shard", f"{k}/2")
        next((self.folder / "a" / "images").rglob("000000001.png")).unlink()
        (self.folder / "a" / "masks" / "000000" / "000000006_target.png").write_bytes(b"")
        text = run(self.folder / "a", program=MERGE, expect=1)
        self.assertIn("2 of 8 images are missing or damaged", text)
        self.assertIn("shard 0/2 lacks 1 of its images, such as 000000001", text)
        self.assertIn("shard 1/2 lacks 1 of its images, such as 000000006", text)
        for k in range(2):
            run("--out", self.folder / "a", *SMALL, "--shard", f"{k}/2")
        run(self.folder / "a", program=MERGE)
        self.assertEqual(self.whole, digest(self.folder / "a"))

    def test_images_of_a_set_with_another_seed_are_named(self):
        for seed, k in (5, 0), (6, 1):
            run("--out", self.folder / f"s{seed}", *SMALL, "--seed", seed, "--shard", f"{k}/2")
        shutil.copytree(self.folder / "s6" / "records", self.folder / "s5" / "records", dirs_exist_ok=True)
        for name in "images", "masks":
            shutil.copytree(self.folder / "s6" / name, self.folder / "s5" / name, dirs_exist_ok=True)
        self.assertIn("shard 1/2 lacks 4 of its images", run(self.folder / "s5", program=MERGE, expect=1))
        (self.folder / "s5" / "shards.json").unlink()
        self.assertIn("is of another set, with seed 6 instead of 5", run(self.folder / "s5", program=MERGE, expect=1))
        faults = run("--out", self.folder / "s5", *SMALL, "--verify", expect=1)
        self.assertEqual(faults.count("is of another set, with seed 6 instead of 5"), 4)
        run("--out", self.folder / "s5", *SMALL)
        self.assertEqual(self.whole, digest(self.folder / "s5"))

    def test_a_hostile_shard_writes_nothing_outside_the_folder(self):
        run("--out", self.folder / "a", *SMALL)
        record = self.folder / "a" / "records" / "000000" / "000000000.json"
        (self.folder / "a" / "evil").write_text("evil")
        text = record.read_text()
        text = text[:text.rindex(',"sha256"')].replace(json.loads(text)["files"][0]["path"], "images/../evil")
        record.write_text(f'{text},"sha256":"{hashlib.sha256(text.encode()).hexdigest()}"}}\n')
        self.assertIn("which is not a path of a data set",
                      run(self.folder / "joined", self.folder / "a", program=MERGE, expect=1))
        self.assertFalse((self.folder / "joined" / "evil").exists())
        for text in "{", "[]", "{}", '{"targets": 3, "meshes": []}':
            (self.folder / "a" / "config.json").write_text(text)
            self.assertIn("is damaged", run(self.folder / "a", program=MERGE, expect=1))

    def test_the_shard_number_comes_from_the_job_array(self):
        out = ["--out", self.folder / "a", *SMALL, "--shard"]
        run(*out, "3", SLURM_ARRAY_TASK_ID="0")
        run(*out, "3", JOB_COMPLETION_INDEX="2")
        run(*out, "1/3", SLURM_ARRAY_TASK_ID="0")
        run(self.folder / "a", program=MERGE)
        self.assertEqual(self.whole, digest(self.folder / "a"))
        self.assertIn("SLURM_ARRAY_TASK_ID is 3, but 3 shards count from 0 to 2",
                      run(*out, "3", expect=2, SLURM_ARRAY_TASK_ID="3"))
        self.assertIn("neither SLURM_ARRAY_TASK_ID nor JOB_COMPLETION_INDEX is set", run(*out, "3", expect=2))
        self.assertIn("to choose one", run(*out, "3", expect=2, SLURM_ARRAY_TASK_ID="0", JOB_COMPLETION_INDEX="1"))
        for text in "3/3", "-1/3", "1/0", "a/3", "1/", "/", "1.5/3", "0/9":
            self.assertIn("--shard: ", run(*out, text, expect=2))

    def test_the_number_of_shards_is_pinned(self):
        run("--out", self.folder / "a", *SMALL, "--shard", "0/3")
        self.assertIn("shards was 3, is 4", run("--out", self.folder / "a", *SMALL, "--shard", "0/4", expect=1))
        self.assertIn("count was 8, is 6",
                      run("--out", self.folder / "a", *SMALL, "--count", 6, "--shard", "0/3", expect=1))
        self.assertIn("is made in shards", run("--out", self.folder / "a", *SMALL, expect=1))
        self.assertIn("seed was 5, is 6",
                      run("--out", self.folder / "a", *SMALL, "--seed", 6, "--shard", "1/3", expect=1))

    def test_a_killed_shard_can_be_run_again(self):
        chance, out = random.Random(7), self.folder / "a"
        for k in range(3):
            for _ in range(max(1, KILLS // 3)):
                process = subprocess.Popen([GENERATOR, "--out", out, *SMALL, "--shard", f"{k}/3"],
                                           stdout=subprocess.DEVNULL)
                time.sleep(chance.uniform(0.0, 0.2))
                process.kill()
                process.wait()
        for k in range(3):
            run("--out", out, *SMALL, "--shard", f"{k}/3")
        run(out, program=MERGE)
        self.assertEqual(self.whole, digest(out))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
