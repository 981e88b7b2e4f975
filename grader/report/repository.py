"""The place of a submission in a repository, by which reports name its files."""

import os
from contextlib import suppress
from pathlib import Path

from grader.base.source import Base
from grader.base.text import printable_path
from grader.report.writing import CHECKOUTS


def find_folder(path: str, inside: str | None) -> Path:
    """Return the folder that the paths of a single URDF start in, given the path in it."""
    return Path(path).parent.resolve().joinpath(*[".."] * (inside or "").count("/")).resolve()


def find_base(path: str, single: Path | None) -> Base:
    """Return where a submission is in its repository, and seen from the current folder.

    `single` is the folder in which paths of a single URDF start.
    """
    if path == "-":
        return Base(is_outside=True)
    return _base_in_repository(path, single)._replace(here=_seen_from_here(path, single))


def _seen_from_here(path: str, single: Path | None) -> str:
    """Return what comes before the paths of a submission in the current folder."""
    start = os.path.normpath(path)
    with suppress(OSError, ValueError):  # the current folder was deleted; another drive
        start = os.path.relpath(single or path)
    return "" if start == os.curdir else f"{printable_path(start)}/"


def _base_in_repository(path: str, single: Path | None) -> Base:
    named = Path(path)
    is_folder = named.is_dir()
    # A file keeps the name that was typed, even if that is a symlink; a folder is resolved.
    place = named.resolve() if is_folder else named.parent.resolve() / named.name
    root = _repository(place)
    if not root:
        return Base(is_outside=True)
    if is_folder or single:
        start = single or place
        if not start.is_relative_to(root):
            return Base(is_outside=True)
        folder = start.relative_to(root).as_posix()
        return Base("" if folder == "." else f"{folder}/")
    return Base(archive=place.relative_to(root).as_posix())


def _repository(place: Path) -> Path | None:
    """Return the root of a path's repository.

    This is the CI checkout, else the folder with .git, else the current folder.
    """
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
