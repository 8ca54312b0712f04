#!/usr/bin/env python3
"""All packages have the version of version.hpp: version.py <project folder>"""

import pathlib
import re
import sys

project = pathlib.Path(sys.argv[1])
version = ".".join(re.findall(r"#define INSONIFY_VERSION_[A-Z]+ (\d+)", (project / "include/insonify/version.hpp").read_text()))
PLACES = {
    "CITATION.cff": r"^version: (.*)$",
    "CHANGELOG.md": r"^## \[([\d.]+)\]",
    "tools/packaging/debian/changelog": r"^insonify \((.*?)\)",
    "tools/packaging/vcpkg/insonify/vcpkg.json": r'"version": "(.*?)"',
    "tools/packaging/conan/conanfile.py": r'^    version = "(.*?)"',
}
faults = []
for path, pattern in PLACES.items():
    found = re.search(pattern, (project / path).read_text(), re.M)
    if not found or found[1] != version:
        faults.append(f"{path}: {found[1] if found else 'no version'}, version.hpp has {version}")
sys.exit("\n".join(faults) or 0)
