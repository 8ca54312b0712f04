#!/usr/bin/env python3
"""Reads every header as text and reports each line that breaks a rule: rules.py <include folder>."""

import pathlib
import re
import sys

# Which folder may include which, directly; their own includes are allowed, too. "" is the top folder.
MAY_INCLUDE = {
    "": [],
    "core": [""],
    "geometry": ["core"],
    "seabed": ["geometry"],
    "raster": ["geometry"],
    "shadow": ["raster"],
    "filter": ["core"],
    "io": ["core"],
    "testing": ["io"],
    "sonar": ["seabed", "shadow", "filter"],
    "accuracy": ["sonar"],
}

UMBRELLA, ALL = "insonify.hpp", "all.hpp"
COLLECTIONS = {UMBRELLA, ALL, "compiled.hpp", "testing.hpp"}  # headers that only include others
NOT_IN_ALL = {
    ALL, "testing.hpp",
    "io/png.hpp", "core/thread_pool.hpp", "testing/compare.hpp", "testing/golden.hpp", "testing/catch2.hpp",
}

BANNED_HEADERS = {
    "iostream", "regex", "filesystem", "random", "ranges", "functional", "thread", "glm/glm.hpp", "glm/ext.hpp",
}
BANNED_UNLESS = {"thread": "core/thread_pool.hpp"}

# Macros of system headers, and functions whose last bit or meaning depends on the machine or on a macro.
BANNED_NAMES = {
    r"\b(near|far|small|interface|IN|OUT|ERROR|DOMAIN|OVERFLOW)\b": "is a macro in some system headers",
    r"\b(min|max)\b(?!\))": "is a macro in some system headers: write (std::min)(a, b)",
    r"\b(?:std|glm)::(?:a?(?:sin|cos|tan)h?|atan2|exp2?|expm1|log(?:2|10|1p)?|pow|hypot|cbrt|erfc?|[tl]gamma)\b":
        "differs between C libraries: use insonify::numeric",
    r"\bglm::(?:dot|cross|length|distance|normalize|determinant|inverse|mix|reflect)\b":
        "may be compiled to fused multiply-add: use insonify::numeric",
    r"\bglm::(?:perspective|ortho|frustum|lookAt)\w*\b": "depends on macros of the user",
}

# Headers without floating-point arithmetic; all others forbid fused multiply-add.
NO_ARITHMETIC = {
    UMBRELLA, ALL, "compiled.hpp", "fwd.hpp", "version.hpp", "config.hpp", "core/error.hpp", "core/executor.hpp", "core/detail/filled.hpp",
    "core/image.hpp", "core/image_view.hpp", "core/detail/int128.hpp", "core/detail/portable.hpp", "core/context.hpp", "core/detail/block_pool.hpp",
    "core/thread_pool.hpp", "core/detail/array_bytes.hpp", "core/detail/dynamic_array.hpp", "core/detail/uninitialized.hpp", "geometry/mesh.hpp", "shadow/detail/tile_casters.hpp", "io/file.hpp", "io/manifest.hpp", "io/png.hpp", "core/detail/file.hpp", "raster/framebuffer.hpp",
    "core/rect.hpp", "raster/draw_options.hpp", "raster/interpolatable.hpp", "seabed/models.hpp", "geometry/shared_mesh.hpp",
    "sonar/side_scan/record.hpp", "testing.hpp", "testing/catch2.hpp", "testing/golden.hpp",
}

MAX_LINES = 400


def allowed_from(folder):
    """The folders that `folder` may include, directly or not, and itself."""
    return {folder}.union(*map(allowed_from, MAY_INCLUDE[folder]))


def folder_of(header):
    """The top-level folder of a header; its subfolders follow the same rules."""
    return header.partition("/")[0] if "/" in header else ""


def code_of(text):
    """The text without comments and string literals, with the same line numbers."""
    pattern = r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"'
    return re.sub(pattern, lambda m: "\n" * m[0].count("\n"), text, flags=re.S)


def include_faults(header, included):
    if included.startswith("insonify/"):
        target = included.removeprefix("insonify/")
        if header not in COLLECTIONS and folder_of(target) not in allowed_from(folder_of(header)):
            yield f"{folder_of(header)} may not include {folder_of(target) or target}"
    elif included in BANNED_HEADERS and BANNED_UNLESS.get(included) != header or included.startswith("glm/gtx/"):
        yield f"<{included}> is banned in library headers"


def line_faults(header, line):
    include = re.match(r"\s*#\s*include\s*(\S+)", line)
    if include:
        if not include[1].startswith("<"):
            yield f"include as <insonify/...>, not {include[1]}"
        yield from include_faults(header, include[1].strip("<>"))
        return
    for pattern, reason in BANNED_NAMES.items():
        for name in re.finditer(pattern, line):
            yield f"{name[0]} {reason}"
    if re.search(r"(?<!using )\bnamespace insonify\b(?! \{$|$)", line):
        yield "write `namespace insonify {` and `inline namespace INSONIFY_ABI {` on two lines"


def faults(header, path):
    data = path.read_bytes()
    if folder_of(header) not in MAY_INCLUDE:
        yield 1, f"unknown folder {folder_of(header)}"
        return
    for number, line in enumerate(data.split(b"\n"), 1):
        if not line.isascii():
            yield number, "not ASCII"
    text = data.decode("ascii", "replace")
    lines = text.splitlines()
    if not re.match(r"// \S", lines[0]):
        yield 1, "the first line must be a comment on the purpose of the file"
    if "#pragma once" not in lines:
        yield 1, "no #pragma once"
    brackets = [line for line in lines if re.fullmatch("INSONIFY_ARITHMETIC_(BEGIN|END)", line)]
    if brackets != ([] if header in NO_ARITHMETIC else ["INSONIFY_ARITHMETIC_BEGIN", "INSONIFY_ARITHMETIC_END"]):
        yield len(lines), "INSONIFY_ARITHMETIC_BEGIN and _END must enclose floating-point arithmetic, and nothing else"
    opened = [i for i, line in enumerate(lines) if line == "namespace insonify {"]
    if any(not lines[i + 1].startswith("inline namespace INSONIFY_ABI {") for i in opened):
        yield opened[0] + 1, "`inline namespace INSONIFY_ABI {` must follow"
    spaces = []  # open namespaces
    for number, line in enumerate(lines, 1):
        if re.match(r"\}  // namespace", line):
            spaces.pop()
        elif space := re.match(r"(?:inline )?namespace (.+) \{$", line):
            if any(re.search("FLAGS|ONCE", outer) for outer in spaces):
                yield number, "INSONIFY_FLAGS and INSONIFY_ONCE must be the innermost namespaces"
            spaces.append(space[1])
    if len(lines) > MAX_LINES:
        yield len(lines), f"{len(lines)} lines, at most {MAX_LINES}: one concept per file"
    for number, (line, code) in enumerate(zip(lines, code_of(text).splitlines()), 1):
        yield from ((number, fault) for fault in line_faults(header, line if "#include" in line else code))


def list_faults(root, headers):
    lists = "".join((root / name).read_text() for name in (UMBRELLA, ALL, "seabed/models.hpp"))
    listed = set(re.findall(r"^#include <insonify/(.+)>", lists, flags=re.M))
    public = {header for header in headers if "/detail/" not in header}
    for header in sorted(public - NOT_IN_ALL - listed):
        yield f"{ALL}: {header} is missing"
    for header in sorted(listed & NOT_IN_ALL):
        yield f"{ALL}: {header} does not belong there"


def main():
    root = pathlib.Path(sys.argv[1]) / "insonify"
    headers = {path.relative_to(root).as_posix(): path for path in sorted(root.rglob("*.hpp"))}
    found = [f"{header}:{number}: {fault}" for header, path in headers.items() for number, fault in faults(header, path)]
    found += list_faults(root, headers)
    print("\n".join(found + [f"{len(headers)} headers, {len(found)} faults"]))
    sys.exit(1 if found else 0)


main()
