"""What a case does with its files before a command, as a person between two runs: `cp FROM TO`, `rm PATH`, `edit PATH OLD NEW`."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path


def copy(here: Path, source: str, target: str) -> None:
    """Copy a file, or the content of a folder into another."""
    (here / target).parent.mkdir(parents=True, exist_ok=True)
    if (here / source).is_dir():
        shutil.copytree(here / source, here / target, symlinks=True, dirs_exist_ok=True)
    else:
        shutil.copyfile(here / source, here / target)


def remove(here: Path, path: str) -> None:
    """Remove a file or a folder."""
    if (here / path).is_dir() and not (here / path).is_symlink():
        shutil.rmtree(here / path)
    else:
        (here / path).unlink()


def edit(here: Path, path: str, old: str, new: str) -> None:
    """Replace what a regular expression finds in a file, at least once."""
    text, count = re.subn(old, new, (here / path).read_text(encoding="utf-8"))
    assert count
    (here / path).write_text(text, encoding="utf-8")


STEPS: dict[str, Callable[..., None]] = {"cp": copy, "rm": remove, "edit": edit}
