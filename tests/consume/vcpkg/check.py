#!/usr/bin/env python3
"""Installs the vcpkg port and builds a consumer in both forms: check.py <project folder> <folder of GLM's headers> <compiler>

GLM is a port of the given headers, so nothing is downloaded. Exits with 77 if VCPKG_ROOT names no vcpkg.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

GLM = """
set(VCPKG_BUILD_TYPE release)
file(COPY "{headers}/glm" DESTINATION "${{CURRENT_PACKAGES_DIR}}/include")
file(WRITE "${{CURRENT_PACKAGES_DIR}}/share/glm/copyright" "MIT")
"""


def main():
    project, glm, compiler = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    root = pathlib.Path(os.environ.get("VCPKG_ROOT", "/nonexistent"))
    if not (root / "vcpkg").exists():
        print("skipped: no vcpkg in VCPKG_ROOT")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        # Most systems have no glm.pc: this one's must not be found.
        os.environ.update(CXX=compiler, VCPKG_FORCE_SYSTEM_BINARIES="1", VCPKG_DISABLE_METRICS="1",
                          PKG_CONFIG_LIBDIR=str(folder / "none"))
        port = folder / "ports/glm"
        port.mkdir(parents=True)
        (port / "portfile.cmake").write_text(GLM.format(headers=glm))
        (port / "vcpkg.json").write_text(json.dumps({"name": "glm", "version": "1.0.1"}))

        install = subprocess.run(
            [root / "vcpkg", "install", "insonify", "--classic", "--binarysource=clear", "--enforce-port-checks",
             f"--overlay-ports={project}/tools/packaging/vcpkg", f"--overlay-ports={port}",
             *(f"--x-{name}-root={folder}/{name}" for name in ("install", "buildtrees", "packages"))],
            text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        print(install.stdout)
        if install.returncode or "warning" in install.stdout or "insonify::compiled" not in install.stdout:
            sys.exit("vcpkg install failed, warned, or printed no usage")

        build = folder / "build"
        subprocess.run(["cmake", "-S", project / "tools/packaging/conan/test_package", "-B", build, "-DCMAKE_BUILD_TYPE=Debug",
                        f"-DCMAKE_TOOLCHAIN_FILE={root}/scripts/buildsystems/vcpkg.cmake", "-DVCPKG_MANIFEST_MODE=OFF",
                        f"-DVCPKG_INSTALLED_DIR={folder}/install"], check=True)
        found = [line for line in (build / "CMakeCache.txt").read_text().splitlines() if line.startswith("insonify_DIR")]
        if str(folder) not in found[0]:
            sys.exit(f"another installed package was found: {found}")
        subprocess.run(["cmake", "--build", build], check=True)
        for form in "headers", "compiled":
            subprocess.run([build / form], check=True)


main()
