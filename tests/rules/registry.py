#!/usr/bin/env python3
"""Checks that a new label is one line: registry.py <include folder> <command to compile...>.

Appends a sediment and a type of relief to a copy of the registry, one row each, and runs a program that uses them. Then
counts the headers that list the library's labels: the registry alone.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROWS = {
    "INSONIFY_RELIEF_TYPES": 'ROW(reef, "reef", 0.7f, {2, 3, 0})',
    "INSONIFY_SEDIMENTS": 'ROW(shells, "shells", -2.0f, 0.014f, -8.0f, 2.5f, 0, {})',
}

PROGRAM = """
#include <insonify/insonify.hpp>
#include <insonify/sonar/speckle.hpp>
#include <cstdio>
namespace in = insonify;
namespace sb = insonify::seabed;

int main() {
    const in::scene scene;
    const in::seabed_speckle speckle;
    const auto reef = sb::index_of(sb::type::reef), shells = sb::index_of(sb::type::shells);
    const bool right =
        sb::properties_of(sb::type::reef).name == "reef" && scene.bottom[reef].reflectivity == 0.7f &&
        speckle.bottom[reef].looks == 2 && sb::sediment_of("shells") == in::sediment::shells &&
        sb::sediment_of_phi(-2.1f) == in::sediment::shells && sb::type_of(in::sediment::shells) == sb::type::shells &&
        sb::only_type(sb::bottom_of(in::sediment::shells)) == sb::type::shells && speckle.bottom[shells].texture == 2.5f &&
        scene.bottom[shells].reflectivity > scene.bottom[sb::index_of(sb::type::medium_sand)].reflectivity &&
        static_cast<int>(sb::user_type(0)) == 64;
    std::puts(right ? "the new rows work" : "the new rows lack a property");
    return right ? 0 : 1;
}
"""


def with_row(text, macro, row):
    """The registry's text with one more row at the end of a list."""
    rows = re.search(rf"#define {macro}\(ROW\)(?:.*\\\n)+.*", text)
    return text[:rows.end()] + " \\\n    " + row + text[rows.end():]


def main():
    root, command = pathlib.Path(sys.argv[1]), sys.argv[2:]
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / "include"
        shutil.copytree(root, copy)
        registry = copy / "insonify/seabed/registry.hpp"
        text = registry.read_text()
        for macro, row in ROWS.items():
            text = with_row(text, macro, row)
        registry.write_text(text)
        program = pathlib.Path(folder) / "program"
        command = [option.replace(f"-I{root}", f"-I{copy}") for option in command]
        subprocess.run([*command, "-x", "c++", "-", "-o", str(program)], input=PROGRAM, text=True, check=True)
        subprocess.run([str(program)], check=True)

    names = re.findall(r"ROW\((\w+), \"", (root / "insonify/seabed/registry.hpp").read_text())
    listing = [path.relative_to(root).as_posix() for path in sorted(root.rglob("*.hpp"))
               if all(re.search(rf"\b{name}\b", path.read_text()) for name in names)]
    print(f"{len(names)} labels, listed in {', '.join(listing)}")
    sys.exit(listing != ["insonify/seabed/registry.hpp"])


main()
