"""A copy of the files of the project, as a clone has them."""

import shutil
from collections.abc import Iterable
from fnmatch import fnmatch
from pathlib import Path

from tests.command_line import ROOT


def _lines(folder: Path) -> list[str]:
    """Return the patterns of the .gitignore of a folder, if it has one."""
    file = folder / ".gitignore"
    if not file.is_file():
        return []
    lines = file.read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def _left_out(folder: str, names: Iterable[str]) -> list[str]:
    """Return the names in a folder that git does not have.

    Other tests may create and remove such files meanwhile: the caches of Python, Hypothesis and coverage, builds, outputs.
    """
    everywhere = [line for line in _lines(ROOT) if not line.startswith("/")]
    patterns = [".git", *(line.strip("/") for line in (*everywhere, *_lines(Path(folder))))]
    return [name for name in names if any(fnmatch(name, pattern) for pattern in patterns)]


def checkout(folder: Path) -> Path:
    """Copy the files of the project to a folder that does not exist; return it."""
    shutil.copytree(ROOT, folder, ignore=_left_out)
    return folder
