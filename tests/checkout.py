"""A copy of the files of the project, as a clone has them."""

import shutil
from pathlib import Path

from tests.command_line import ROOT

_LEFT_OUT = (
    ".git",
    ".venv",
    "__pycache__",
    ".hypothesis",
    ".pytest_cache",
    ".mypy_cache",
    ".ruff_cache",
    ".coverage*",
    "*.egg-info",
)


def checkout(folder: Path) -> Path:
    """Copy the files of the project to a folder that does not exist; return it."""
    shutil.copytree(ROOT, folder, ignore=shutil.ignore_patterns(*_LEFT_OUT))
    return folder
