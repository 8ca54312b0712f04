#!/usr/bin/env python3
"""Follows the guide word for word: follow.py <project> <folder to work in> [options] [page...]

Pages are followed in the order of docs/guide/README.md, in one folder, from top to bottom:

- A block whose first line is a comment with a file's name, or whose fence has one, is written to that file.
- A block of `sh` is run by bash, with the compiler of $CXX. `sh skip` is not run: it installs, or needs a cluster.
- A block that quotes a file of the project, as in ```cpp examples/own_noise.cpp, is checked by tests/rules/excerpts.py.
- A block of `text` below one that was run is its output: each of its lines, in this order; `...` stands for anything.

Then the commands of the pages --commands are run, with the project's single_include/ and examples/.

`insonify/` in the folder is the project. `insonify/tools/generate` and `insonify/tools/merge` build what they run; the
programs that the options name run in their place. Without them, or without GoogleTest, blocks are skipped and listed.
"""

import argparse
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import time

FENCE = re.compile(r"^```(\S*) ?(.*?)\n(.*?)^```$", re.M | re.S)
FENCE_NAME = re.compile(r"\S+\.\w+")
FILE_NAME = re.compile(r"(?://|#) (\S+\.\w+|Makefile)\s*$")
LIMIT = 150 * 1000  # bytes of a picture


def pages_of(guide):
    """The pages in the order in which the index links them."""
    return list(dict.fromkeys(re.findall(r"\]\((\w+\.md)\)", (guide / "README.md").read_text())))


def differs(expected, output):
    """The first line that the output lacks, or None."""
    lines = iter(output.splitlines())
    for line in expected.splitlines():
        pattern = ".*".join(re.escape(part) for part in line.strip().split("..."))
        if not any(re.fullmatch(pattern, found.strip()) for found in lines):
            return line
    return None


class Guide:
    def __init__(self, project, folder, stand_ins):
        self.project, self.guide, self.folder, self.stand_ins = project, project / "docs/guide", folder, stand_ins
        self.faults, self.skipped, self.blocks = [], [], 0
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        (folder / "insonify").symlink_to(project, target_is_directory=True)

    def run(self, code):
        """The output of a shell block, None if it can't be run here; a failure is a fault."""
        if "-lgmock" in code and subprocess.run("echo '#include <gmock/gmock.h>' | ${CXX} -E -x c++ - >/dev/null 2>&1",
                                                shell=True).returncode != 0:
            return None
        for name, program in self.stand_ins.items():
            if name in code and not program:
                return None
            code = code.replace(name, shlex.quote(str(program)))
        code = re.sub(r"^g\+\+ ", f"{os.environ['CXX']} ", code, flags=re.M)
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", code], cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=1200)
        if done.returncode != 0:
            raise RuntimeError(f"exit status {done.returncode} of\n{code}\n{done.stdout[-3000:]}")
        return done.stdout

    def follow(self, page):
        text = (self.guide / page).read_text()
        output = None
        for fence in FENCE.finditer(text):
            language, flag, code = fence.groups()
            if (self.project / flag).is_file():
                continue
            where = f"{page}:{text.count(chr(10), 0, fence.start()) + 1}"
            name = FILE_NAME.match(code.split("\n", 1)[0])
            started = time.monotonic()
            try:
                if FENCE_NAME.fullmatch(flag):
                    (self.folder / flag).write_text(code)
                    self.blocks += 1
                elif language == "sh":
                    output = None if flag == "skip" else self.run(code)
                    if flag != "skip" and output is None:
                        self.skipped.append(where)
                    self.blocks += output is not None
                elif language == "text":
                    missing = None if output is None else differs(code, output)
                    if missing is not None:
                        raise RuntimeError(f"no line '{missing}' in\n{output}")
                elif name:
                    (self.folder / name[1]).write_text(code)
                    self.blocks += 1
                elif language == "cpp":
                    raise RuntimeError("a block of C++ has to begin with // and the name of its file")
            except (RuntimeError, subprocess.TimeoutExpired) as fault:
                self.faults.append(f"{where}: {fault}")
                print(f"{where}: FAULT", flush=True)
                return
            if time.monotonic() - started > 1:
                print(f"{where}: {time.monotonic() - started:.1f} s", flush=True)
        for picture in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text):
            path = self.guide / picture
            if not path.exists():
                self.faults.append(f"{page}: {picture} is missing; tools/pictures makes it")
            elif path.suffix == ".png" and path.stat().st_size > LIMIT:
                self.faults.append(f"{page}: {picture} has {path.stat().st_size} bytes, at most {LIMIT}")

    def run_commands(self, page):
        """Runs the shell blocks of a page that is followed in the checkout."""
        for name in ("single_include", "examples"):
            if not (self.folder / name).exists():
                (self.folder / name).symlink_to(self.project / name, target_is_directory=True)
        for language, flag, code in FENCE.findall((self.project / page).read_text()):
            if language != "sh" or flag == "skip":
                continue
            try:
                self.run(code)
                self.blocks += 1
            except (RuntimeError, subprocess.TimeoutExpired) as fault:
                self.faults.append(f"{page}: {fault}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("project", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--generate", help="the program generate_dataset")
    parser.add_argument("--merge", help="the program merge_dataset")
    parser.add_argument("--commands", action="append", default=[], help="another page whose blocks of `sh` are run")
    parser.add_argument("pages", nargs="*")
    given = parser.parse_args()
    os.environ.setdefault("CXX", "g++")
    guide = Guide(given.project.resolve(), given.folder.resolve(),
                  {f"insonify/tools/{name}": program and pathlib.Path(program).resolve()
                   for name, program in (("generate", given.generate), ("merge", given.merge))})
    pages = pages_of(guide.guide)
    for page in pages:
        if not given.pages or page in given.pages or page == pages[0]:
            guide.follow(page)
    for page in given.commands:
        guide.run_commands(page)
    for where in guide.skipped:
        print(f"{where}: skipped, the generator or GoogleTest is missing")
    print("\n".join(guide.faults + [f"{guide.blocks} blocks, {len(guide.faults)} faults"]))
    sys.exit(1 if guide.faults else 0)


main()
