#!/usr/bin/env python3
"""tools/completion.bash offers each option of the generator, and completes as bash would: completion.py <project folder>"""

import pathlib
import re
import subprocess
import sys

project = pathlib.Path(sys.argv[1])
script = project / "tools/completion.bash"


def completed(*words):
    """What bash offers behind these words."""
    ask = (f"source {script}; COMP_WORDS=(generate_dataset {' '.join(map(repr, words))}); COMP_CWORD={len(words)}; "
           "_insonify_generate; printf '%s\\n' \"${COMPREPLY[@]}\"")
    return subprocess.run(["bash", "-c", ask], check=True, capture_output=True, text=True).stdout.split()


source = (project / "examples/generate_dataset/options.cpp").read_text()
names = re.findall(r'(?:add_(?:option|flag)\(|set_config\()\s*"([^"]+)"', source)
options = {name for names_of_one in names for name in names_of_one.split(",")} | {"--help"}
offered = set(completed("--"))
faults = [f"{name} is not offered" for name in sorted(options - offered)]
faults += [f"{name} is no option" for name in sorted(offered - options)]
for words, expected in {("--recipe", "p"): ["published"], ("--seabeds", "mud,ro"): ["mud,rock"],
                        ("--see",): ["--seed"]}.items():
    if completed(*words) != expected:
        faults.append(f"{' '.join(words)}: {completed(*words)}, expected {expected}")
if len(options) < 30:
    faults.append(f"found {len(options)} options in options.cpp")
sys.exit("\n".join(faults) or 0)
