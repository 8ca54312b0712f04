#!/usr/bin/env python3
"""The README's program is examples/hello_sonar.cpp, verbatim: readme.py <project folder>"""

import pathlib
import sys

project = pathlib.Path(sys.argv[1])
program = (project / "examples/hello_sonar.cpp").read_text()
if f"```cpp\n{program}```" not in (project / "README.md").read_text():
    sys.exit("README.md does not show examples/hello_sonar.cpp as it is")
