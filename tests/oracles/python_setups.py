"""What Python does with a setup.py that the tests wrote: the arguments of setup(), or that it raises an error.

Each file runs in a process of its own, in the folder of a package, with a setup() that records its arguments.
"""

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from tests.command_line import HANG_TIMEOUT

_RUNNER = """
import ast, io, json, os, resource, sys, types

def run(text):
    recorded = []
    for name in ("setuptools", "distutils", "distutils.core"):
        module = sys.modules[name] = types.ModuleType(name)
        module.setup = lambda **kwargs: recorded.append(read(kwargs.get("data_files") or []))
        module.find_packages = lambda where=".", exclude=(), include=("*",): ["my_robot"]
    sys.stdout = printed = io.StringIO()
    resource.setrlimit(resource.RLIMIT_CPU, (2, 2))
    resource.setrlimit(resource.RLIMIT_AS, (2**30, 2**30))
    try:
        exec(compile(text, "setup.py", "exec"), {"__name__": "__main__", "__file__": "setup.py"})
    except SystemExit as end:
        if end.code:
            return None
    except BaseException:
        return None
    return recorded[-1] if recorded and not printed.getvalue() else None

def read(data_files):
    mapping = {}
    for entry in ast.literal_eval(repr(data_files)):  # as colcon does
        folder, files = entry if isinstance(entry, tuple) else ("", [entry])
        assert isinstance(files, list) and not os.path.isabs(folder)
        for file in files:
            assert not os.path.isabs(file) and os.path.isfile(file)
            mapping[os.path.normpath(os.path.join(folder, os.path.basename(file)))] = os.path.normpath(file)
    return mapping

for text in json.load(sys.stdin):
    reading, writing = os.pipe()
    if not os.fork():
        try:
            result = run(text)
        except BaseException:
            result = None
        os.write(writing, json.dumps(result).encode())
        os._exit(0)
    os.close(writing)
    with open(reading, "rb") as pipe:
        print(pipe.read().decode() or "null", file=sys.__stdout__)
    os.wait()
"""


class Ran(NamedTuple):
    """The files that a build installs, by their paths below the prefix; None if it fails."""

    installed: dict[str, str] | None


def run_all(folder: Path, texts: Sequence[str]) -> list[Ran]:
    """Run each text as the setup.py of the package in a folder."""
    done = subprocess.run(
        [sys.executable, "-B", "-W", "ignore", "-c", _RUNNER],
        input=json.dumps(list(texts)),
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
        timeout=HANG_TIMEOUT,
    )
    return [Ran(json.loads(line)) for line in done.stdout.splitlines()]
