#!/usr/bin/env python3
"""Programs print their usage for --help, name an unknown option, and write no file: usage_test.py <program>...

usage.txt of generate_dataset holds its help, which tools/generate prints before the program is built.
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
