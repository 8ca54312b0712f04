#!/usr/bin/env python3
"""Checks the library against macros, with the compiler that the arguments call: macros.py <include folder> <command...>.

poison  every header compiles where others have defined the macros of <windows.h>, <math.h> and old toolkits
leak    the library defines no macro but INSONIFY_*
"""

import pathlib
import re
import subprocess
import sys

FUNCTION_LIKE = ["min", "max"]
OBJECT_LIKE = ["near", "far", "small", "interface", "ERROR", "DOMAIN", "OVERFLOW", "IN", "OUT"]


def compiled(command, text, *options):
    """The compiler's output for `text`; exits with its message where compilation fails."""
    run = subprocess.run([*command, *options, "-x", "c++", "-"], input=text, capture_output=True, text=True)
    if run.returncode:
        sys.exit(run.stderr)
    return run.stdout


def includes(headers):
    """Include lines, each guarded, since headers that are optional are among them."""
    return "".join(f"#if __has_include(<{h}>)\n#include <{h}>\n#endif\n" for h in headers)


def macros(command, text):
    return set(re.findall(r"^#define (\w+)", compiled(command, text, "-dM", "-E"), flags=re.M))


def main():
    root, command = pathlib.Path(sys.argv[1]), sys.argv[2:]
    texts = {path.relative_to(root).as_posix(): path.read_text() for path in sorted(root.rglob("*.hpp"))}
    ours = "".join(f"#include <{h}>\n" for h in texts)
    named = {name for text in texts.values() for name in re.findall(r"^\s*#\s*include <(.+)>", text, flags=re.M)}
    others = includes(sorted(named - texts.keys()))

    poison = "".join(f"#define {name}(a, b) poisoned by {name}\n" for name in FUNCTION_LIKE)
    poison += "".join(f"#define {name} poisoned by {name}\n" for name in OBJECT_LIKE)
    # Some of the C library's own headers use names of this list, and undefine them first.
    poison = "".join(f"#undef {name}\n" for name in FUNCTION_LIKE + OBJECT_LIKE) + poison
    compiled(command, others + poison + ours, "-fsyntax-only")
    print(f"{len(texts)} headers compile under {len(FUNCTION_LIKE + OBJECT_LIKE)} poisoned names")

    leaked = sorted(name for name in macros(command, others + ours) - macros(command, others)
                    if not name.startswith("INSONIFY_"))
    sys.exit(f"macros that leak: {' '.join(leaked)}" if leaked else 0)


main()
