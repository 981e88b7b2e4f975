"""The location of a submission in the repository around it: reports for a repository give paths from its root."""

import os
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from grader.usecases.targets import CHECKOUTS

if TYPE_CHECKING:
    from grader.report.locations import Base


def base_of(path: str, *, is_single: bool) -> "Base":
    """Return where a submission is in its repository; `is_single` if it is one URDF, whose paths start in its folder."""
    from grader.report.locations import Base

    if path == "-":
        return Base(is_outside=True)
    named = Path(path)
    is_folder = named.is_dir()
    # A file keeps the name that was typed, even if that is a symlink; a folder is resolved.
    place = named.resolve() if is_folder else named.parent.resolve() / named.name
    root = _repository(place)
    if root is None:
        return Base(is_outside=True)
    if is_folder or is_single:
        folder = (place if is_folder else place.parent).relative_to(root).as_posix()
        return Base("" if folder == "." else f"{folder}/")
    return Base(archive=place.relative_to(root).as_posix())


def _repository(place: Path) -> Path | None:
    """Return the root of a path's repository: the CI system's checkout, else the folder with .git, else the current folder."""
    around = [place, *place.parents]
    for name in CHECKOUTS:
        checkout = Path(os.environ.get(name) or os.sep).resolve()
        if checkout in around[:-1]:  # the last is the root of the file system
            return checkout
    for folder in around:
        if (folder / ".git").exists():
            return folder
    with suppress(OSError):  # the current folder may have been deleted
        here = Path.cwd()
        return here if here in around else None
    return None
