#!/usr/bin/env python3
"""Programs explain themselves by --help, and refuse an unknown option by name, writing no file: usage_test.py <program>...

What generate_dataset says is in its usage.txt, for tools/generate to say before it is built.
"""

import pathlib
import subprocess
import sys
import tempfile

faults = []
for program in sys.argv[1:]:
    with tempfile.TemporaryDirectory() as folder:
        run = lambda *words: subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, timeout=60)
        asked, wrong = run("--help"), run("--nonsense")
        name = pathlib.Path(program).name
        if asked.returncode != 0 or "Usage: " not in asked.stdout or asked.stderr:
            faults.append(f"{name} --help: {asked}")
        if name == "generate_dataset":
            stored = pathlib.Path(__file__).parent.parent / name / "usage.txt"
            if asked.stdout != stored.read_text():
                faults.append(f"{name} --help is not {stored}; write it there")
        if wrong.returncode != 2 or "--nonsense" not in wrong.stderr or wrong.stdout:
            faults.append(f"{name} --nonsense: {wrong}")
        if list(pathlib.Path(folder).iterdir()):
            faults.append(f"{name} writes files")
print("\n".join(faults) or f"{len(sys.argv) - 1} programs, no fault")
sys.exit(1 if faults else 0)
