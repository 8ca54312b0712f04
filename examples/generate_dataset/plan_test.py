#!/usr/bin/env python3
"""Tests of --plan: sets made again from their manifest, tables of targets, and malformed tables.

plan_test.py <generate_dataset> <merge_dataset>
"""

import csv
import fnmatch
import functools
import hashlib
import io
import json
import math
import pathlib
import random
import re
import struct
import sys
import tempfile
import unittest
import zlib

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import programs

GENERATOR, MERGE = sys.argv.pop(1), sys.argv.pop(1)
PUBLISHED = pathlib.Path(__file__).resolve().parents[3] / "shared/reference/published_pipeline"
NAMES_OF_PLAN = (".lock", "config.json", "README.md", "SHA256SUMS")  # files that name the plan of a set
run = functools.partial(programs.run, GENERATOR)
merge = functools.partial(programs.run, MERGE)
refusal = functools.partial(programs.run, GENERATOR, expect=(1, 2), seconds=60)
digest = functools.partial(programs.digest, leave_out=NAMES_OF_PLAN)


def manifest(folder):
    with open(folder / "manifest.csv", newline="") as file:
        return list(csv.DictReader(file))


def png16(path, width, height, value):
    """A 16-bit gray PNG of `value(x, y)`."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    rows = b"".join(b"\0" + b"".join(struct.pack(">H", value(x, y)) for x in range(width)) for y in range(height))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
    return path


class Plans(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def table(self, text):
        path = self.folder / "t.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def replay(self, name, *options, inputs=()):
        """Makes a set, and again from its manifest alone: all bytes agree."""
        first = self.folder / name
        run("--out", first, *options, *inputs)
        self.replay_of(first, *inputs)
        return first

    def replay_of(self, first, *inputs):
        again = first.with_name(first.name + "_again")
        run("--out", again, "--plan", first / "manifest.csv", *inputs)
        self.assertEqual(digest(first), digest(again))

    def test_a_manifest_reproduces_a_set_of_the_sonar_recipe(self):
        first = self.replay("a", "--count", 12, "--size", 64, "--seed", 3, "--targets", "tyre,ship,cylinder", "--format", "npy")
        self.assertEqual({row["recipe"] for row in manifest(first)}, {"sonar"})
        self.replay("b", "--size", 48, "--per-class", "crate=2,empty=1,plane=2", "--first", 1, "--count", 4)
        # The largest pixels, and streaks of a kilometre.
        coarse = self.replay("c", "--size", 16, "--seed", 3, "--empty", 0.3, "--first", 30, "--count", 8)
        self.assertGreater(max(float(row["streak_length_m"]) for row in manifest(coarse)), 1000)

    def test_a_manifest_reproduces_a_set_of_the_published_recipe(self):
        self.replay("a", "--recipe", "published", "--size", 64, "--count", 8, "--seed", 18446744073709551615, "--noise",
                    "gaussian:0.02,speckle:0.1", "--seabeds", "mixed,mud", "--colormap", "copper", "--chip", 7)
        for mode in "slant_range", "ground_range":
            self.replay(mode, "--recipe", "published", "--mode", mode, "--count", 5, "--pixels", 48, "--place", "anywhere")
        self.replay("demo", "--recipe", "published", "--demo", "--size", 32)

    def test_a_manifest_with_input_files_reproduces_the_set(self):
        (self.folder / "tetra.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
        for name in "a", "b":
            (self.folder / f"{name},1.pgm").write_bytes(b"P5 16 16 255\n" + bytes(random.Random(name).randbytes(256)))
        heights = png16(self.folder / "map.png", 300, 300, lambda x, y: 40 * x)
        inputs = ["--mesh", f"tetra={self.folder / 'tetra.obj'}", "--reference", self.folder / "a,1.pgm", "--reference",
                  self.folder / "b,1.pgm", "--heightmap", heights, "--heightmap-spacing", 0.1, "--mesh-up", "z"]
        first = self.replay("a", "--recipe", "published", "--size", 64, "--count", 12, "--seabeds", "heightmap,sand",
                            inputs=inputs)
        rows = manifest(first)
        self.assertEqual({row["reference_name"] for row in rows}, {"a,1.pgm", "b,1.pgm"})
        self.assertIn("tetra", {row["class"] for row in rows})
        # References are found by name in any order; without them the plan is refused.
        swapped = inputs[:2] + ["--reference", self.folder / "b,1.pgm", "--reference", self.folder / "a,1.pgm"] + inputs[6:]
        run("--out", self.folder / "s", "--plan", first / "manifest.csv", *swapped)
        for row in rows:
            self.assertEqual((first / row["file"]).read_bytes(), (self.folder / "s" / row["file"]).read_bytes())
        self.assertIn("column reference_name has", refusal("--out", self.folder / "x", "--plan", first / "manifest.csv",
                                                           *(inputs[:2] + inputs[6:])))
        self.assertFalse((self.folder / "x").exists())
        self.assertIn("column heightmap_spacing_m has '0.1'", refusal("--out", self.folder / "x", "--plan",
                                                                      first / "manifest.csv", *inputs, "--heightmap-spacing", 1))

    def test_a_shuffled_subset_of_lines_makes_those_images(self):
        for recipe in "sonar", "published":
            first, again = self.folder / recipe, self.folder / (recipe + "_again")
            run("--out", first, "--recipe", recipe, "--count", 12, "--size", 48)
            rows = manifest(first)
            kept = rows[1::2] + rows[4:5]
            random.Random(1).shuffle(kept)
            columns = sorted(rows[0], key=lambda name: hashlib.sha256(name.encode()).digest())  # columns may have any order
            text = io.StringIO()
            writer = csv.DictWriter(text, columns, lineterminator="\n", quoting=csv.QUOTE_ALL)
            writer.writeheader()
            writer.writerows(kept)
            run("--out", again, "--plan", self.table(text.getvalue()))
            remade = manifest(again)
            self.assertEqual([int(row["index"]) for row in remade], sorted(int(row["index"]) for row in kept))
            for row in remade:
                self.assertEqual(row, rows[int(row["index"])])
                for of in "file", "target_mask", "shadow_mask", "seabed_mask":
                    self.assertEqual((first / row[of]).read_bytes(), (again / row[of]).read_bytes())
            # The same in shards.
            shards = self.folder / (recipe + "_shards")
            run("--out", shards, "--plan", self.table(text.getvalue()), "--shard", "0/2")
            self.assertIn("shard 1/2 lacks", merge(shards, expect=1))
            run("--out", shards, "--plan", self.table(text.getvalue()), "--shard", "1/2")
            merge(shards)
            self.assertEqual(digest(shards), digest(again))
            self.assertIn("0 faults", run("--out", shards, "--plan", self.table(text.getvalue()), "--verify"))

    def test_a_class_that_an_edited_line_brings_is_a_category(self):
        for recipe, before, after in ("published", "cylinder", "sphere"), ("sonar", "ship", "crate"):
            first, again = self.folder / recipe, self.folder / (recipe + "_again")
            run("--out", first, "--recipe", recipe, "--targets", before, "--count", 2, "--size", 32)
            text = (first / "manifest.csv").read_text().replace(f",{before},", f",{after},", 1)
            text = text.replace(f",{before},", f",{after},") if recipe == "sonar" else text
            text = text.replace(f"{after};clutter", f"{before};shadow;clutter")
            run("--out", again, "--plan", self.table(text))
            names = [c["name"] for c in json.loads((again / "annotations.json").read_text())["categories"]]
            self.assertIn(after, names)
            self.assertEqual(len(names), len(set(names)))

    def test_a_line_without_a_seabed_has_that_of_the_set_without_a_plan(self):
        run("--out", self.folder / "a", "--recipe", "published", "--count", 12, "--size", 32)
        seabeds = {row["index"]: row["seabed"] for row in manifest(self.folder / "a")}
        run("--out", self.folder / "b", "--recipe", "published", "--size", 32, "--plan",
            self.table("index,class\n2,cube\n5,cube\n9,cube\n"))
        self.assertEqual([row["seabed"] for row in manifest(self.folder / "b")], [seabeds[i] for i in ("2", "5", "9")])

    def test_each_line_has_the_defaults_of_its_own_mode(self):
        for modes in ("slant_range", "overhead"), ("overhead", "ground_range"):
            out = self.folder / modes[0]
            lines = "".join(f"{i},cube,mud,{mode}\n" for i, mode in enumerate(modes * 3))
            run("--out", out, "--recipe", "published", "--size", 32, "--display", "power", "--plan",
                self.table("index,class,seabed,mode\n" + lines))
            self.replay_of(out)
            for row in manifest(out):
                is_overhead = row["mode"] == "overhead"
                self.assertEqual(row["noise"], "speckle:0.1" if is_overhead else "seabed")
                self.assertEqual(float(row["chip_m"]), 0 if is_overhead else 5)
                self.assertTrue((3.5 if is_overhead else 3) <= float(row["altitude_m"]) <= (5 if is_overhead else 10))
                self.assertEqual(row["display"], "" if is_overhead else "power")
        self.assertIn("line 2: column noise has '', expected a chain without seabed", refusal(
            "--out", self.folder / "x", "--recipe", "published", "--noise", "seabed", "--plan",
            self.table("index,class,mode\n0,cube,overhead\n1,cube,slant_range\n")))

    def test_the_data_card_has_the_sizes_and_seeds_of_the_lines(self):
        run("--out", self.folder / "a", "--recipe", "published", "--count", 2, "--size", 32, "--seed", 7)
        said = run("--out", self.folder / "b", "--plan", self.folder / "a/manifest.csv")
        card = (self.folder / "b/README.md").read_text()
        for text in said, card:
            self.assertIn("2 images of 32 x 32 pixels", text)
            self.assertIn("seed 7", text)

    def test_a_given_value_does_not_change_others(self):
        out = ["--recipe", "sonar", "--count", 4, "--size", 32, "--visible-share", 0]
        run("--out", self.folder / "a", *out)
        rows = manifest(self.folder / "a")
        text = "index,class,looks\n" + "".join(f"{row['index']},{row['class']},3\n" for row in rows)
        run("--out", self.folder / "b", "--plan", self.table(text), "--size", 32, "--visible-share", 0)
        for before, after in zip(rows, manifest(self.folder / "b")):
            self.assertEqual(after["looks"], "3")
            for column in "chip_m", "sonar", "altitude_m", "seabed_seed", "white", "turn", "t1_length_m":
                self.assertEqual(before[column], after[column], column)

    def test_a_given_range_decides_noise_beam_and_grain(self):
        pictures = set()
        for share in 0.03, 1:
            text = ("index,class,seabed,chip_m,sonar,first_range_m,altitude_m,range_share\n"
                    f"0,empty,sand,5,side_scan_1800,30,4,{share}\n1,empty,ripples,5,synthetic_aperture,60,9,{share}\n")
            out = self.folder / f"share_{share}"
            run("--out", out, "--recipe", "sonar", "--plan", self.table(text), "--size", 32)
            pictures.add(tuple(row["file_sha256"] for row in manifest(out)))
        self.assertEqual(len(pictures), 1)

    def test_every_target_is_shown_at_every_aspect_on_every_seabed(self):
        targets = self.table('id,shape,length,width,height,orientation\r\n7,cylinder,2,0.5,0.6,0\r\n"9",cube , 1,0.8,0.7,45\r\n')
        out = self.folder / "a"
        run("--out", out, "--recipe", "published", "--plan", targets, "--aspects", "0:90:270", "--seabeds", "mud,sand", "--size",
            64, "--tilt", 0, "--burial", 0)
        rows = manifest(out)
        self.assertEqual(len(rows), 2 * 4 * 2)
        views = {(row["target_id"], row["seabed"], round(float(row["aspect_deg"]), 2) % 360) for row in rows}
        self.assertEqual(views, {(target, seabed, (first + aspect) % 360) for target, first in (("7", 0), ("9", 45))
                                 for seabed in ("mud", "sand") for aspect in (0, 90, 180, 270)})
        for row in rows:
            size = [float(row[name]) for name in ("length_m", "width_m", "height_m")]
            self.assertEqual(size, [2, 0.5, 0.6] if row["target_id"] == "7" else [1, 0.8, 0.7])
            if row["seabed"] == "sand":
                self.assertAlmostEqual(float(row["target_height_m"]), size[2], delta=0.03)
        # Removing a line does not change the other targets.
        run("--out", self.folder / "b", "--recipe", "published", "--plan",
            self.table("id,shape,height,width,length\n9,2,0.7,0.8,1\n"), "--aspects", "45,135", "--seabeds", "sand", "--size", 64)
        self.assertEqual(len(manifest(self.folder / "b")), 2)

    def test_the_sonar_recipe_shows_a_target_at_every_aspect(self):
        out = self.folder / "a"
        run("--out", out, "--plan", self.table("id,class,length,height\n1,ship,40,9\n2,cube,1,2\n"), "--aspects", "0:120:240",
            "--seabeds", "sand,ripples", "--size", 48)
        rows = manifest(out)
        self.assertEqual(len(rows), 12)
        for name in "t1_form", "t1_damage", "t1_width_m":
            self.assertEqual(len({row[name] for row in rows if row["target_id"] == "1"}), 1, name)
        self.assertEqual({row["t1_height_m"] for row in rows}, {"9.0", "2.0"})
        for i, row in enumerate(rows):
            self.assertAlmostEqual(math.cos(math.radians(float(row["aspect_deg"]) - 120 * (i % 3))), 1, places=4)
            self.assertEqual(row["seabed"], ("sand", "ripples")[i // 3 % 2])
        self.replay_of(out)

    def test_the_published_recipe_shows_every_target_at_every_aspect(self):
        out = self.folder / "a"
        run("--out", out, "--recipe", "published", "--targets", "cube,cone", "--seabeds", "mud", "--aspects", "0:120:240",
            "--count", 8, "--size", 48)
        rows = manifest(out)
        seen = {}
        for row in rows:
            seen.setdefault(row["target_id"], []).append((row["target_size_m"], row["class"], round(float(row["aspect_deg"]))))
        self.assertEqual([len(views) for views in seen.values()], [3, 3, 1, 1])
        for views in seen.values():
            self.assertEqual(len({view[:2] for view in views}), 1)
        self.assertEqual([view[2] % 360 for view in seen["1"]], [0, 120, 240])
        self.assertEqual(len({views[0][0] for views in seen.values()}), 4)
        # The default is every tenth degree.
        run("--out", self.folder / "b", "--recipe", "published", "--targets", "cube", "--seabeds", "mud", "--count", 3, "--size", 32)
        self.assertEqual([round(float(row["aspect_deg"])) % 360 for row in manifest(self.folder / "b")], [0, 10, 20])
        run("--out", self.folder / "c", "--recipe", "published", "--aspects", "random", "--count", 3, "--size", 32)
        self.assertEqual({row["target_id"] for row in manifest(self.folder / "c")}, {""})

    def test_per_class_counts_are_exact_in_the_published_recipe(self):
        counts = {"cylinder": 5, "cube": 3, "sphere": 4}
        run("--recipe", "published", "--out", self.folder / "a", "--size", 32, "--aspects", "0:90:90", "--per-class",
            ",".join(f"{name}={count}" for name, count in counts.items()))
        rows = manifest(self.folder / "a")
        self.assertEqual({name: [row["class"] for row in rows].count(name) for name in counts}, counts)
        self.assertGreater(len({row["seabed"] for row in rows if row["class"] == "cylinder"}), 2)
        self.replay_of(self.folder / "a")

    def test_the_published_table_is_a_plan(self):
        # Number, group, number within it, shape, length, width, height, their mean, orientation, and a comma at the end.
        path = PUBLISHED / "target_table.csv"
        text = path.read_text() if path.exists() else "1,0,0,1,0.53,1.72,1.947,1.21,0,\n2,0,1,2,0.67,0.82,1.23,0.88,90,\n"
        out = self.folder / "a"
        run("--out", out, "--plan", self.table(text), "--aspects", "0:10:350", "--seabeds", "mud", "--size", 32, "--first", 30,
            "--count", 12, "--tilt", 0)
        rows, lines = manifest(out), [line.split(",") for line in text.splitlines()]
        self.assertEqual(len(rows), 12)
        for row in rows:
            target, aspect = divmod(int(row["index"]), 36)
            self.assertEqual(row["recipe"], "published")
            self.assertEqual(row["target_id"], lines[target][0])
            self.assertEqual(row["class"], ("", "cylinder", "cube", "sphere", "cone")[int(lines[target][3])])
            self.assertEqual([float(row[n]) for n in ("length_m", "width_m", "height_m")], [float(v) for v in lines[target][4:7]])
            self.assertAlmostEqual((float(row["aspect_deg"]) - 10 * aspect - float(lines[target][8]) + 180) % 360, 180, places=3)
        run("--out", self.folder / "b", "--plan", self.table("4,3,0.5,0.6,0.7,0.59,10,\n"), "--size", 32, "--count", 2)
        self.assertEqual({row["class"] for row in manifest(self.folder / "b")}, {"sphere"})

    def test_a_malformed_plan_is_refused_with_line_column_and_value(self):
        head = "index,class,white,has_clutter\n"
        for text, *said in (
                ("", "is empty"),
                ("index,class\n", "no other line"),
                ("index,white\n0,3\n", "line 1: has no column class"),
                ("index,class,class\n0,ship,ship\n", "line 1: names the column 'class' twice"),
                ("index;class\n0;ship\n", "separate cells by commas"),
                ("1,2,3\n", "line 1", "3 cells, all numbers"),
                (head + "0,ship,4\n", "line 2", "column has_clutter is missing"),
                (head + "0,ship,4,true,5\n", "line 2", "'5' is too many"),
                (head + "\n0,ship,nan,true\n", "line 3: column white has 'nan', expected a number"),
                (head + "0,ship,1e400,true\n", "column white has '1e400'"),
                (head + "0,ship,inf,true\n", "column white has 'inf'"),
                (head + "0,ship,-1,true\n", "column white has '-1', expected a number from 0.001"),
                (head + "0,ship,3 metres,true\n", "column white has '3 metres'"),
                (head + "0,ship,3,yes\n", "line 2: column has_clutter has 'yes', expected true or false"),
                (head + "0,submarine,3,true\n", "line 2: column class has 'submarine'"),
                (head + "0,../../x,3,true\n", "line 2: column class has '../../x'"),
                (head + "0,,3,true\n", "line 2: column class has ''"),
                (head + ",ship,3,true\n", "line 2: column index has ''"),
                (head + "1.5,ship,3,true\n", "line 2: column index has '1.5'"),
                (head + "-1,ship,3,true\n", "line 2: column index has '-1'"),
                (head + "1000000000,ship,3,true\n", "line 2: column index has '1000000000'"),
                (head + "5,ship,3,true\n4,ship,3,true\n5,ship,3,true\n", "line 4: column index has '5'", "a value that line 2 does not have"),
                ("id,shape\n1,ship\n1,ship\n", "line 3: column target_id has '1'", "a value that line 2 does not have"),
                ("id,shape\n1,7\n", "line 2: column class has '7', expected a whole number from 1 to 4"),
                (head + '0,"ship,3,true\n', "line 2, column 2: opens a quote that is never closed"),
                (head + '0,"ship"s,3,true\n', "line 2, column 2: goes on after the closing quote"),
                (head + '0,sh"ip,3,true\n', "line 2, column 2: has a quote within a cell"),
                (b"index,class\n0,ship\x00\n", "line 2, column 2: holds a control character"),
                (b"index,class\r0,ship\r", "line 1, column 2: has a carriage return"),
                ("index,class,lenght\n0,ship,4\n", "has no column 'lenght'"),
                ("index,class,looks\n0,ship,2.5\n", "line 2", "column looks has '2.5'"),
                ("index,class,looks\n0,ship,1e9\n", "line 2: column looks has '1e9'"),
                ("index,class,seabed\n0,ship,lava\n", "line 2: column seabed has 'lava', expected one of sand"),
                ("index,class,recipe\n0,ship,cooking\n", "line 2: column recipe has 'cooking'"),
                ("index,class,recipe\n0,ship,sonar\n1,cube,published\n", "line 3: column recipe has 'published'"),
                ("index,class,t1_kind\n0,ship,plane\n", "line 2: column t1_kind has 'plane'"),
                ("index,class,size_px\n0,ship,1000000\n", "line 2: column size_px has '1000000'"),
                ("index,class,seed\n0,ship,18446744073709551616\n", "line 2: column seed"),
                ("index,class,recipe,chip_m,mode\n0,cube,published,0,slant_range\n", "line 2: column chip_m has '0'"),
                ("index,class,recipe,noise\n0,cube,published,fog:3\n", "line 2: column noise has 'fog:3'"),
                ("index,class,recipe,height_m\n0,cube,published,-2\n", "line 2: column height_m has '-2'")):
            message = refusal("--out", self.folder / "x", "--plan", self.table(text))
            for words in ("t.csv", *said):
                self.assertIn(words, message, text)
            self.assertFalse((self.folder / "x").exists(), text)  # a refused plan leaves no folder

    def test_a_value_outside_its_limits_is_refused_before_anything_is_written(self):
        for column, value in (("looks", 65), ("looks_drawn", 0), ("texture", -1), ("tone_drift_db", 31), ("tone_drift_db", -1),
                              ("tone_streaks_db", 31), ("tone_patches_db", -31), ("patch_share", 0), ("gain_error_db", 61),
                              ("gain_error_px", 0.5), ("gain_slope_db", -61), ("banding_drift_db", -1), ("banding_px", 0),
                              ("banding_jitter_db", 61), ("noise_floor", -1), ("volume", -1), ("correlation_across_px", 17),
                              ("correlation_along_px", 17), ("depth_over_altitude", 0), ("display_range_factor", 0),
                              ("exponent", 5), ("black_share", 0.5), ("white_share", 0.5), ("steepness", 0.6), ("swell", 0.6),
                              ("disorder", 0.4), ("feature_px", 0), ("streak_px", 0), ("streak_ratio", -1), ("ping_stretch", 0),
                              ("survey_grazing_deg", 90), ("t1_length_m", 0.005), ("t2_pitch_rad", 2000)):
            said = refusal("--out", self.folder / "a", "--plan", self.table(f"index,class,{column}\n0,ship,{value}\n"))
            self.assertIn(f"line 2: column {column} has '{value}', expected a", said)
            self.assertFalse((self.folder / "a").exists())

    def test_a_target_is_cut_by_the_sides_of_the_picture(self):
        # Rows of 2 / 32 m around their pings: the picture begins at -1 / 32 m and ends at 2 - 1 / 32 m.
        lines = [f"{i},sphere,32,2,2,0.5,{along / 2},0,0,1,sand\n" for i, along in enumerate((0.23, 0.21, 1.71, 1.73))]
        run("--out", self.folder / "a", "--plan",
            self.table("index,class,size_px,chip_m,track_m,t1_length_m,t1_along,t1_burial,t1_scour,targets,seabed\n" +
                       "".join(lines)))
        self.assertEqual([row["target_is_cut"] for row in manifest(self.folder / "a")], ["false", "true", "false", "true"])

    def test_debris_lies_along_its_wreck(self):
        # Rows and columns of the same length, wrecks at any angle to the track.
        head = ("index,class,targets,t1_length_m,t1_damage,t1_across,t1_along,rig_yaw_rad,t1_yaw_rad,port,ground_range,turn,chip_m,"
                "track_m,first_range_m,altitude_m,has_debris,debris,has_clutter\n")
        seen = [(port, rig, yaw) for port in ("false", "true") for rig in (0, 2) for yaw in (0.4, 1.5, 2.6, 5.6)]
        lines = [f"{i},ship,1,20,0.1,0.5,0.5,{rig},{yaw},{port},true,0,40,40,60,20,true,80,false\n"
                 for i, (port, rig, yaw) in enumerate(seen)]
        run("--out", self.folder / "a", "--plan", self.table(head + "".join(lines)))
        boxes = json.loads((self.folder / "a/annotations.json").read_text())
        debris = {c["id"] for c in boxes["categories"] if c["name"] == "clutter"}
        for row in manifest(self.folder / "a"):
            heading = float(row["t1_yaw_rad"]) - float(row["rig_yaw_rad"])
            hull = math.cos(heading) * (-1 if row["port"] == "true" else 1), math.sin(heading)
            along, across = 0, 0
            for b in boxes["annotations"]:
                if b["image_id"] == int(row["index"]) and b["category_id"] in debris:
                    x, y, width, height = b["bbox"]
                    x, y = x + (width - 128) / 2, y + (height - 128) / 2
                    along, across = along + (x * hull[0] + y * hull[1]) ** 2, across + (y * hull[0] - x * hull[1]) ** 2
            self.assertGreater(along, 1.5 * across, row["index"])

    def test_values_at_their_limits_are_drawn(self):
        for i, (kind, column, value) in enumerate((("ship", "t1_across", -1), ("plane", "t1_length_m", 0.01), ("tyre", "chip_m", 0.01),
                                                   ("tyre", "fill", 100), ("ship", "clutter_size_m", 0.0002))):
            run("--out", self.folder / str(i), "--size", 32, "--plan",
                self.table(f"index,class,{column},trawls,debris,has_debris\n0,{kind},{value},2,40,true\n"))
        for column, value in ("pulse_m", 100), ("texture", 0.009):
            self.assertIn(f"line 2: column {column} has '{value}', expected ", refusal(
                "--out", self.folder / column, "--plan", self.table(f"index,class,chip_m,{column}\n0,tyre,5,{value}\n")))

    def test_chips_of_centimetres_have_bottoms_of_every_type(self):
        types = "mixed", "mud", "ripples", "rock", "sand"
        lines = [f"{i},sphere,64,0.03,0.01,2.3,1,{seabed}\n" for i, seabed in enumerate(types)]
        run("--out", self.folder / "a", "--plan",
            self.table("index,class,size_px,chip_m,t1_length_m,feature_px,trawls,seabed\n" + "".join(lines)))
        self.assertEqual(tuple(row["seabed"] for row in manifest(self.folder / "a")), types)

    def test_options_that_contradict_the_plan_are_refused(self):
        plan = ["--out", self.folder / "x", "--plan", self.table("index,class,seabed\n0,cube,sand\n")]
        self.assertIn("column index", refusal(*plan, "--aspects", "0:10:350"))
        self.assertIn("column seabed", refusal(*plan, "--seabeds", "mud"))
        self.assertIn("cannot be combined with --plan", refusal(*plan, "--per-class", "cube=3"))
        self.assertIn("are more than the 1 of the plan", refusal(*plan, "--count", 2))
        self.assertIn("--first: 1 is not below 1", refusal(*plan, "--first", 1))
        self.assertIn("does not exist", refusal("--out", self.folder / "x", "--plan", self.folder / "no.csv"))
        sized = "index,class,size_px,chip_m\n0,cube,32,5\n1,cube,{},\n"
        self.assertIn("--size: the plan has a column size_px; remove either",
                      refusal("--out", self.folder / "x", "--plan", self.table(sized.format(48)), "--size", 64))
        # Options are for lines without a value.
        run("--out", self.folder / "y", "--recipe", "published", "--plan", self.table(sized.format("")), "--size", 64,
            "--chip", 10)
        self.assertEqual([(row["size_px"], float(row["chip_m"])) for row in manifest(self.folder / "y")],
                         [("32", 5), ("64", 10)])
        for aspects in "0:10", "0:0:350", "10:10:0", "a", "0:nan:9", "", "0,", "720":
            self.assertIn("is not first:step:last",
                          refusal("--out", self.folder / "x", "--recipe", "published", f"--aspects={aspects},"), aspects)

    def test_another_plan_is_another_configuration(self):
        run("--out", self.folder / "a", "--plan", self.table("index,class\n0,cube\n"), "--size", 32)
        self.assertIn("--plan", refusal("--out", self.folder / "a", "--plan", self.table("index,class\n0,cone\n"), "--size", 32))

    def test_each_column_is_documented(self):
        docs = (pathlib.Path(__file__).resolve().parents[2] / "docs/dataset.md").read_text()
        words = set(re.findall(r"`([^`\n]+)`", docs))
        for recipe in "sonar", "published":
            out = self.folder / recipe
            run("--out", out, "--recipe", recipe, "--count", 1, "--size", 32, "--format", "npy,pfm,png16")
            with open(out / "manifest.csv", newline="") as file:
                for column in next(csv.reader(file)):
                    column = re.sub("_bytes$|_sha256$", "", column)
                    self.assertTrue(any(fnmatch.fnmatch(column, word) for word in words), f"{column} is not in docs/dataset.md")

    def test_heights_are_read_from_a_16_bit_png(self):
        # Waves lower than one step of 8 bits, which would quantize to a plane.
        ramp = png16(self.folder / "ramp.png", 64, 64, lambda x, y: 60 * (x // 3 % 2))
        plain = png16(self.folder / "plain.png", 64, 64, lambda x, y: 0)
        pictures = {}
        for path in ramp, plain:
            out = self.folder / path.stem
            run("--out", out, "--recipe", "published", "--heightmap", path, "--heightmap-spacing", 0.2, "--heightmap-scale", 500,
                "--targets", "cube", "--count", 1, "--size", 64, "--noise", "none")
            pictures[path.stem] = next((out / "images").rglob("*.png")).read_bytes()
        self.assertNotEqual(pictures["ramp"], pictures["plain"])
        real = PUBLISHED / "sandripple_heightmap.png"
        if real.exists():
            run("--out", self.folder / "real", "--recipe", "published", "--heightmap", real, "--heightmap-scale", 0.3, "--count", 1,
                "--size", 64)


if __name__ == "__main__":
    unittest.main()
