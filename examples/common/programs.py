"""Runs programs and compares what they write, for the tests of examples."""

import hashlib
import os
import pathlib
import subprocess


def run(program, *options, expect=(0,), seconds=300, **environment):
    """Output and errors of a run that must end with one of the exit codes `expect`; None allows any."""
    done = subprocess.run([program, *map(str, options)], capture_output=True, text=True, timeout=seconds,
                          env=os.environ | environment)
    codes = (expect,) if isinstance(expect, int) else expect
    assert codes is None or done.returncode in codes, \
        f"exit {done.returncode}, expected {expect}:\n{done.stdout}{done.stderr}"
    return done.stdout + done.stderr


def digest(folder, leave_out=(".lock",)):
    """SHA-256 of every file in a folder, by path, except files of these names."""
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(pathlib.Path(folder).rglob("*")) if path.is_file() and path.name not in leave_out}
