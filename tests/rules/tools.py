#!/usr/bin/env python3
"""Every tool prints its usage, and names a wrong option before it installs or compiles anything: tools.py <project>

Compilers, package managers and the like are replaced by programs that leave a mark.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

COSTLY = ["apt-get", "c++", "clang++", "cmake", "doxygen", "dpkg-buildpackage", "em++", "g++", "make", "ninja", "sudo"]
# Words that a tool refuses, and what its message says beside them.
WRONG = [
    ("tools/generate", ["--out", "x", "--cuont", "3"], "--count"),
    ("tools/generate", ["--count", "3"], "--out"),
    ("tools/generate", ["cylinder"], "--help"),
    ("tools/generate", ["--out", "x", "-n", "3"], "--help"),
    ("tools/bench", ["speed"], "filters"),
    ("tools/bench", ["growth", "XL"], "2L"),
    ("tools/bench", ["filters", "two"], "threads"),
    ("tools/bench", ["--frame", "3"], "--frames"),
    ("tools/tradeoff", ["--pixel=64"], "--pixels"),
    ("tools/recognize", ["--real", "/nowhere"], "plane/"),
    ("tools/recognize", ["--real"], "plane/"),
    ("tools/recognize", ["--counts", "0,20", "--real", "/nowhere"], "comes first"),
    ("tools/recognize", ["--second-simulator", "--real", "/nowhere"], "comes first"),
    ("tools/merge", [], "FOLDER"),
    ("tools/test", ["--fast"], "--help"),
    ("tools/test", ["--ci", "--full"], "one of"),
    ("tools/slurm", ["0", "--", "--out", "x"], "SHARDS"),
    ("tools/slurm", ["2", "--", "--out", "x", "--sed", "4"], "--seed"),
    ("tools/playground", ["a.html", "b.html"], "b.html"),
]


def main():
    project = pathlib.Path(sys.argv[1]).resolve()
    tools = [f for f in sorted((project / "tools").rglob("*")) if f.is_file() and f.read_bytes().startswith(b"#!")]
    # debian/rules is run by dpkg; figures/ and doxygen/ are helpers of other tools
    tools = [f for f in tools if f.name != "rules" and f.parent.name not in ("figures", "doxygen")]
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        marks = pathlib.Path(folder, "marks")
        for name in COSTLY:
            program = pathlib.Path(folder, name)
            program.write_text(f"#!/bin/sh\necho {name} >>{marks}\nexit 1\n")
            program.chmod(0o755)
        around = dict(os.environ, PATH=f"{folder}:{os.environ['PATH']}")

        def run(tool, words):
            done = subprocess.run([tool, *words], cwd=folder, env=around, stdin=subprocess.DEVNULL, capture_output=True,
                                  text=True, timeout=60)
            if marks.exists():
                faults.append(f"{tool} {' '.join(words)}: runs {marks.read_text().split()}")
                marks.unlink()
            return done

        def refused(tool, words, *mentions):
            done = run(tool, words)
            lacking = [m for m in mentions if m not in done.stderr]
            if done.returncode != 2 or done.stdout or lacking:
                absent = f"no {lacking} in " if lacking else ""
                faults.append(f"{tool} {' '.join(words)}: status {done.returncode}, {absent}{done.stderr!r}, {done.stdout!r}")

        for tool in tools:
            for word in ("--help", "-h"):
                done = run(tool, [word])
                if done.returncode != 0 or tool.name not in done.stdout or done.stderr:
                    faults.append(f"{tool} {word}: status {done.returncode}, {done.stdout!r} {done.stderr!r}")
            refused(tool, ["--nonsense"], "--nonsense", "-h")
        for tool, words, mention in WRONG:
            refused(project / tool, words, mention)
    print("\n".join(faults + [f"{len(tools)} tools, {len(faults)} faults"]))
    sys.exit(1 if faults else 0)


main()
