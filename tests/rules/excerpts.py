#!/usr/bin/env python3
"""Checks that quotes of the project in its pages are verbatim: excerpts.py <project>

A fence that names a file, as in ```cpp include/insonify/core/rect.hpp, holds parts of it: each run of lines without a blank
line occurs word for word in the file. A line `// ...` stands for what is left out. A fence that names a program of examples/
holds all of it.
"""

import pathlib
import re
import sys

FENCE = re.compile(r"^```cpp ((?:include|examples)/\S+)\n(.*?)^```$", re.M | re.S)
CUT = re.compile(r"^\s*// \.\.\.\n|^\n", re.M)


def faults(project, page):
    text = page.read_text()
    for fence in FENCE.finditer(text):
        name, quoted = fence.groups()
        where = f"{page.relative_to(project)}:{text.count(chr(10), 0, fence.start()) + 1}"
        if not (project / name).exists():
            yield f"{where}: {name} does not exist"
            continue
        source = (project / name).read_text()
        if name.startswith("examples/"):
            if quoted != source:
                yield f"{where}: differs from {name}"
            continue
        for part in filter(None, CUT.split(quoted)):
            if "\n" + part not in source:
                yield f"{where}: not in {name}:\n{part}"


def main():
    project = pathlib.Path(sys.argv[1]).resolve()
    pages = [project / "README.md", *sorted((project / "docs").rglob("*.md"))]
    quotes = sum(len(FENCE.findall(page.read_text())) for page in pages)
    found = [fault for page in pages for fault in faults(project, page)]
    print("\n".join(found + [f"{quotes} excerpts, {len(found)} faults"]))
    sys.exit(1 if found or not quotes else 0)


main()
