"""What a case does with its files before a command, as a person between two runs: `cp FROM TO`, `rm PATH`."""

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


STEPS: dict[str, Callable[..., None]] = {"cp": copy, "rm": remove}
