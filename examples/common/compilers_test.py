#!/usr/bin/env python3
"""Builds programs with clang++ and compares what they write, file by file, with what another build writes.

usage: compilers_test.py CMAKE PROGRAM...
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SKIPPED = 77

RUNS = [
    ("generate_dataset", "--recipe sonar --count 160 --seed 5"),
    ("generate_dataset", "--recipe sonar --count 52 --seed 6 --empty 0 --targets ship,plane,truncated_cone,wedge,tyre,pipe,"
                         "boulder,crate,lobster_pot,cylinder,cube,cone,sphere"),
    ("generate_dataset", "--recipe published --mode slant_range --count 24 --seed 7"),
    ("generate_dataset", "--recipe published --mode ground_range --seabeds sand,mixed --count 12 --seed 8"),
    ("generate_dataset", "--recipe published --count 8 --seed 9 --size 256"),
    ("sidescan_survey", "--length 40 --width 20 --between 20 --range 20 --bins 256 --page 100 --turn-rate 30 --seed 4"),
    ("ping_simulator", "--counts 2 2 2 --pixels 64"),
]


def files_of(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def main():
    cmake, *given = sys.argv[1:]
    programs = {pathlib.Path(path).stem: path for path in given}
    if not shutil.which("clang++"):
        print("skipped: clang++ not found")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        subprocess.run([cmake, "-S", ROOT, "-B", scratch / "build", "-DCMAKE_BUILD_TYPE=Release",
                        "-DCMAKE_CXX_COMPILER=clang++", "-DINSONIFY_BUILD_TESTS=OFF"], check=True)
        subprocess.run([cmake, "--build", scratch / "build", "--target", *programs], check=True)
        failed = False
        for run, (name, options) in enumerate(RUNS):
            written = []
            for build, program in (("this", programs[name]), ("clang", scratch / "build/examples" / name)):
                out = scratch / f"{run}_{build}"
                subprocess.run([program, "--out", out, *options.split()], check=True, stdout=subprocess.DEVNULL)
                written.append(files_of(out))
            ours, theirs = written
            differing = sorted(str(path) for path in ours.keys() | theirs.keys() if ours.get(path) != theirs.get(path))
            print(f"{name} {options}: {len(ours)} files, {len(differing)} of them different", *differing[:5], sep="\n    ")
            failed |= bool(differing) or not ours
    sys.exit(failed)


main()
