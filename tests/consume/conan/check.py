#!/usr/bin/env python3
"""Runs the Conan recipe and its test_package: check.py <project folder> <folder of GLM's headers> <compiler>

GLM is packaged from the given headers, so nothing is downloaded. Exits with 77 if Conan 2 is missing.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

VERSIONS = ["1.0.1", "cci.20230113"]  # the recipe has to take the first
GLM = '''
from conan import ConanFile
from conan.tools.files import copy


class Glm(ConanFile):
    name = "glm"
    package_type = "header-library"

    def package(self):
        copy(self, "glm/*", {headers!r}, self.package_folder + "/include")

    def package_info(self):
        self.cpp_info.bindirs = self.cpp_info.libdirs = []
'''


def main():
    project, glm, compiler = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    if not shutil.which("conan") or b"version 2" not in subprocess.check_output(["conan", "--version"]):
        print("skipped: Conan 2 not found")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        os.environ.update(CONAN_HOME=folder + "/home", CXX=compiler)

        def conan(*arguments):
            return subprocess.run(["conan", *arguments], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

        def create(standard):
            return conan("create", project / "tools/packaging/conan", "--no-remote", "--build=missing",
                         "-s", f"compiler.cppstd={standard}", "-s", "build_type=Debug",
                         "-c", f"tools.cmake.cmake_layout:test_folder={folder}/test")

        recipe = pathlib.Path(folder, "glm.py")
        recipe.write_text(GLM.format(headers=glm))
        for command in [["profile", "detect"]] + [["export", recipe, "--version", version] for version in VERSIONS]:
            conan(*command).check_returncode()

        made = create(20)
        print(made.stdout)
        if made.returncode or "glm/[>=0.9.9 <2]: glm/1.0.1" not in made.stdout:
            sys.exit("conan create failed, or took another version of GLM than 1.0.1")
        refused = create(17)
        if not refused.returncode or "lower than the required C++ standard (20)" not in refused.stdout:
            sys.exit(f"C++17 is not refused:\n{refused.stdout}")


main()
