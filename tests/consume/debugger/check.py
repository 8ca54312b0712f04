#!/usr/bin/env python3
"""Prints values of the library in gdb: check.py <project folder> <compiler...>; exits with 77 without gdb"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

PROGRAM = """
#include <insonify/core/image.hpp>
#include <insonify/geometry/transform.hpp>
int main() {
    insonify::image<float> picture(2, 1, 0.5f);
    insonify::image_view<float> view = picture.view();
    insonify::pose place{.position = {1, 2, 3}, .yaw = 3.14159265f / 2};
    return view.width() + static_cast<int>(place.scale) == 3 ? 0 : 1;
}
"""
EXPECTED = [
    "image of 2 x 1 float = {(0, 0) = 0.5, (1, 0) = 0.5}",
    "view of 2 x 1 float = {(0, 0) = 0.5, (1, 0) = 0.5}",
    "pose at (1, 2, 3) m, yaw 90 deg, pitch 0 deg, roll 0 deg, scale 1, burial 0",
]


def main():
    project, compiler = pathlib.Path(sys.argv[1]), sys.argv[2:]
    if shutil.which("gdb") is None:
        print("skipped: gdb not found")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        source, program = pathlib.Path(folder, "main.cpp"), pathlib.Path(folder, "main")
        source.write_text(PROGRAM)
        subprocess.run([*compiler, "-g", "-O0", source, "-o", program], check=True)
        commands = ["set startup-with-shell off", f"source {project}/tools/debug/insonify_gdb.py", "break main.cpp:9",
                    "run", "print picture", "print view", "print place"]
        arguments = [part for command in commands for part in ("-ex", command)]
        output = subprocess.run(["gdb", "-q", "-nx", "-batch", *arguments, program], capture_output=True, text=True).stdout
    missing = [line for line in EXPECTED if line not in output]
    if missing:
        sys.exit("\n".join(["not printed:", *missing, "but:", output]))


main()
