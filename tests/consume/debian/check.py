#!/usr/bin/env python3
"""Builds the Debian packages and a program against their contents: check.py <project folder> <compiler...>

Exits with 77 if dpkg-buildpackage or debhelper is missing.
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

FILES = ["usr/include/insonify/insonify.hpp", "usr/share/cmake/insonify/insonifyConfig.cmake",
         "usr/share/pkgconfig/insonify.pc", "usr/share/doc/libinsonify-dev/copyright"]


def main():
    project, compiler = pathlib.Path(sys.argv[1]), sys.argv[2:]
    if not (shutil.which("dpkg-buildpackage") and shutil.which("dh")):
        print("skipped: dpkg-buildpackage or debhelper not found")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([project / "tools/packaging/debian/build", folder], check=True)
        made = {path.suffix for path in pathlib.Path(folder).iterdir()}
        if not {".dsc", ".deb", ".xz"} <= made:
            sys.exit(f"made {sorted(made)}")
        stage = pathlib.Path(folder, "stage")
        subprocess.run(["dpkg-deb", "-x", next(pathlib.Path(folder).glob("*.deb")), stage], check=True)
        missing = [name for name in FILES if not (stage / name).exists()]
        if missing:
            sys.exit(f"not in the package: {missing}")
        subprocess.run([*compiler, "-std=c++20", "-fsyntax-only", f"-I{stage}/usr/include",
                        project / "tests/consume/app.cpp"], check=True)


main()
