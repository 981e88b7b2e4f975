"""What setuptools installs when a setup.py is run; many are run by one process, which has setuptools already."""

import os
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from grader.files.names import ignored_part
from tests.command_line import HANG_TIMEOUT

# Runs the setup.py in each folder of those on the command line, in a process of its own that has setuptools already; below the
# folder's `installed`, so that a file with an absolute path is written nowhere else. The output is in its `output`.
_BUILDER = """
import os, runpy, sys, traceback
import setuptools, setuptools.command.egg_info, setuptools.dist, distutils.command.install_data

for top in sys.argv[1:]:
    child = os.fork()
    if not child:
        code = 1
        with open(f"{top}/output", "w") as output:
            os.dup2(output.fileno(), 1)
            os.dup2(output.fileno(), 2)
        os.chdir(f"{top}/my_robot")
        sys.path[0] = os.getcwd()
        install = ["--quiet", "install_data", "--root", f"{top}/installed", "--install-dir", f"{top}/installed/prefix"]
        sys.argv = ["setup.py", *install]
        try:
            runpy.run_path("setup.py", run_name="__main__")
            code = 0
        except SystemExit as end:
            print(end.code, file=sys.stderr)
            code = end.code if isinstance(end.code, int) else end.code is not None
        except BaseException:
            traceback.print_exc()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""
# The message of install_data without data files; `setup.py install` does not call it then.
_NOTHING = "TypeError: 'NoneType' object is not iterable"


class Build(NamedTuple):
    """The result of running the setup.py of a package: the source of each installed file, or the text of the error."""

    installed: dict[str, str]
    error: str


def build_all(folders: Iterable[Path]) -> list[tuple[int, str]]:
    """Install the data files of the package in `my_robot` of each folder; return the exit codes and what is printed."""
    listed = list(folders)
    done = subprocess.run(
        [sys.executable, "-B", "-W", "ignore", "-c", _BUILDER, *map(str, listed)],
        env={name: value for name, value in os.environ.items() if not name.startswith(("MY_", "SETUPTOOLS_"))},
        capture_output=True,
        text=True,
        check=True,
        timeout=HANG_TIMEOUT,
    )
    codes = map(int, done.stdout.split())
    return [(code, (folder / "output").read_text("utf-8")) for folder, code in zip(listed, codes, strict=True)]


def build_of(folder: Path, sources: dict[str, str], code: int, output: str) -> Build:
    """Return what was installed in a folder; `sources` are the paths of the package's files by their texts."""
    root = folder / "installed"
    installed = {
        os.path.relpath(path, root / "prefix")
        if path.is_relative_to(root / "prefix")
        else f"/{path.relative_to(root)}": path
        for path in root.rglob("*")
        if path.is_file()
    }
    texts = {target: path.read_text(encoding="utf-8") for target, path in installed.items()}
    return Build(
        {target: sources[text] for target, text in texts.items() if not ignored_part(sources[text])},
        f"status {code}: {output}" if code and _NOTHING not in output else "",
    )
