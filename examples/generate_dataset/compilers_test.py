#!/usr/bin/env python3
"""Builds generate_dataset with clang++ and compares its sets, file by file, with those of another build.

usage: compilers_test.py GENERATOR CMAKE
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SKIPPED = 77

SETS = {
    "sonar": "--recipe sonar --count 160 --seed 5",
    "objects": "--recipe sonar --count 52 --seed 6 --empty 0 --targets ship,plane,truncated_cone,wedge,tyre,pipe,boulder,"
               "crate,lobster_pot,cylinder,cube,cone,sphere",
    "slant_range": "--recipe published --mode slant_range --count 24 --seed 7",
    "ground_range": "--recipe published --mode ground_range --seabeds sand,mixed --count 12 --seed 8",
    "overhead": "--recipe published --count 8 --seed 9 --size 256",
}


def files_of(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def main():
    program, cmake = sys.argv[1:]
    if not shutil.which("clang++"):
        print("skipped: clang++ not found")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        subprocess.run([cmake, "-S", ROOT, "-B", scratch / "build", "-DCMAKE_BUILD_TYPE=Release",
                        "-DCMAKE_CXX_COMPILER=clang++", "-DINSONIFY_BUILD_TESTS=OFF"], check=True)
        subprocess.run([cmake, "--build", scratch / "build", "--target", "generate_dataset"], check=True)
        failed = False
        for name, options in SETS.items():
            sets = []
            for build, generator in (("this", program), ("clang", scratch / "build/examples/generate_dataset")):
                out = scratch / f"{name}_{build}"
                subprocess.run([generator, "--out", out, *options.split()], check=True, stdout=subprocess.DEVNULL)
                sets.append(files_of(out))
            ours, theirs = sets
            differing = sorted(str(path) for path in ours.keys() | theirs.keys() if ours.get(path) != theirs.get(path))
            print(f"{name}: {len(ours)} files, {len(differing)} of them different", *differing[:5], sep="\n    ")
            failed |= bool(differing)
    sys.exit(failed)


main()
