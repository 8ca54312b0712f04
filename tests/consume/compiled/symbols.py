#!/usr/bin/env python3
"""Checks the symbols of a program linked from units with different flags: symbols.py <program>

No public type's name holds the flags of a unit. Functions of the library that were compiled with assertions, or with
instructions that not every x86-64 has, hold them. The standard library's templates are not the library's functions:
std::vector<float> of a unit is shared by a whole program, whatever the library does.
"""

import re
import subprocess
import sys

FLAGS = r"built\w*"
PUBLIC = (r"image<|image_view<|scene\b|frame<|mesh\b|overhead\b|pose\b|labels\b|rgb<|bottom_tone\b|"
          r"seabed::(?:any|ripples|rock|mud|flat|patches)\b")
NEWER = re.compile(r"\s+[0-9a-f]+:\s+(?:v[a-z]\w+|andn|bzhi|mulx|rorx|sarx|shlx|shrx|[lt]zcnt|blsr)\s")
ASSERTION = "__assert_fail"
BY_COMPILER = re.compile(r"::(~?\w+)(?:<.*>)?::~?\1\(|::operator=\(")  # constructors, destructors and copies


def functions(program):
    """Mangled name and instructions of each function of the library."""
    listing = subprocess.run(["objdump", "-d", "--no-show-raw-insn", program], capture_output=True, text=True, check=True)
    for text in listing.stdout.split("\n\n"):
        name = re.match(r"[0-9a-f]+ <(\S*insonify\S*)>:\n", text)
        if name:
            yield name[1], text


def demangled(names):
    text = subprocess.run(["c++filt"], input="\n".join(names), capture_output=True, text=True, check=True).stdout
    return dict(zip(names, text.splitlines()))


def belongs_to_library(function):
    """Whether the name itself is in the namespace insonify, not only an argument or a template argument."""
    text = re.sub(r"operator(?:<=>|<<|<=|<|->|>>|>=|>)", "operator", function)
    while re.search(r"<[^<>]*>", text):
        text = re.sub(r"<[^<>]*>", "", text)
    return re.search(r"(?:^|[\s*&])insonify::", text.split("(")[0]) is not None


def main():
    code = dict(functions(sys.argv[1]))
    names = demangled(list(code))
    own = {n: d for n, d in names.items() if belongs_to_library(d)}
    faults = [f"flags in a type: {d}" for d in own.values() if re.search(rf"insonify::\w+::{FLAGS}::(?:{PUBLIC})", d)]
    for name, d in own.items():
        if re.search(rf"::{FLAGS}::|\[abi:{FLAGS}\]", d) or "::compiled::" in d or BY_COMPILER.search(d):
            continue
        if ASSERTION in code[name] or any(map(NEWER.match, code[name].splitlines())):
            faults.append(f"no flags in a function: {d}")
    print(f"{len(own)} functions of the library, {len(faults)} faults", *faults[:20], sep="\n")
    sys.exit(1 if faults or len(own) < 50 else 0)


main()
