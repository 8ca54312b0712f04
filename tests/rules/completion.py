#!/usr/bin/env python3
"""tools/completion.bash offers each option of the programs, and completes as bash would: completion.py <project folder>

The options are those of the sources, and those that --help of a tool lists.
"""

import pathlib
import re
import shlex
import subprocess
import sys

project = pathlib.Path(sys.argv[1])
script = project / "tools/completion.bash"


def completed(*words, program="generate_dataset", function="_insonify_generate"):
    """The words that bash offers after these."""
    ask = (f"source {shlex.quote(str(script))}; COMP_WORDS=({program} {' '.join(map(repr, words))}); COMP_CWORD={len(words)}; "
           f"{function}; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
    return subprocess.run(["bash", "-c", ask], check=True, capture_output=True, text=True).stdout.split()


def options_in(path):
    """The options that a program's source declares, by CLI11 or argparse, or that a script compares with."""
    names = re.findall(r'(?:add_(?:option|flag|argument)\(|set_config\()\s*"([^"]+)"', (project / path).read_text())
    return {name for names_of_one in names for name in names_of_one.split(",") if name.startswith("--")} | {"--help"}


def differences(program, options, offered):
    return ([f"{program}: {name} is not offered" for name in sorted(options - offered)] +
            [f"{program}: {name} is not an option" for name in sorted(offered - options)])


options = options_in("examples/generate_dataset/options.cpp")
faults = differences("generate_dataset", options, set(completed("--")))
for tool, path, more in (("merge", "examples/generate_dataset/merge.cpp", set()),
                         ("bench", "tests/benchmarks/peers/main.cpp", {"--install"}),
                         ("tradeoff", "tests/benchmarks/tradeoff/main.cpp", set()),
                         ("mutants", "tools/mutants", set())):
    offered = set(completed("--", program=f"tools/{tool}", function="_insonify_tool"))
    faults += differences(tool, options_in(path) | more, offered)
for tool in ("generate", "merge", "bench", "tradeoff", "mutants", "recognize", "test", "compile_cost", "amalgamate"):
    listed = subprocess.run([project / "tools" / tool, "--help"], check=True, capture_output=True, text=True).stdout
    function = "_insonify_generate" if tool == "generate" else "_insonify_tool"
    faults += differences(f"{tool} --help", set(re.findall(r"--[a-z][a-z-]*", listed)) | {"--help"},
                          set(completed("--", program=f"tools/{tool}", function=function)))
for words, expected in {("--recipe", "p"): ["published"], ("--seabeds", "mud,ro"): ["mud,rock"],
                        ("--see",): ["--seed"]}.items():
    if completed(*words) != expected:
        faults.append(f"{' '.join(words)}: {completed(*words)}, expected {expected}")
if len(options) < 30:
    faults.append(f"found {len(options)} options in options.cpp")
sys.exit("\n".join(faults) or 0)
