"""A folder as a tree of files: nothing outside of it is read, whatever its links point to."""

import os
import stat
from functools import partial
from pathlib import Path

from grader.errors import InputError
from grader.submission.files import printable_path, read_capped, read_start
from grader.submission.tree import (
    BUILT,
    IGNORED,
    MOST_FILES,
    File,
    Tree,
    clean,
    is_generated,
    is_ignored,
    make_tree,
    too_many,
)

_MOST_GENERATED = 10_000


def read_folder(folder: Path) -> Tree:
    """The files of a folder. Raises InputError where it cannot be read or holds far too many.

    Left out, and named: links that lead out of it, and what is neither file nor folder. Left out in silence: folders of
    builds and tools, virtual environments, hidden files.
    """
    top = os.path.realpath(folder)
    files: list[File] = []
    folders: list[str] = []
    left_out: list[str] = []
    generated: list[str] = []
    entered: set[str] = set()
    waiting = [""]
    count = 0
    while waiting:
        where = waiting.pop()
        for entry in _entries(folder / where, is_top=not where):
            count += 1
            if count > MOST_FILES:
                raise too_many(printable_path(folder))
            path = f"{where}/{entry.name}" if where else entry.name
            shown = clean(path)
            if entry.name in IGNORED or is_ignored(shown):
                generated += _generated(folder, path) if entry.name in BUILT else ()
                continue
            real = os.path.realpath(entry.path)
            if entry.is_symlink() and not real.startswith(top + os.sep):
                left_out.append(f"{shown} is a link that leads out of the submission, and was not followed")
            elif entry.is_dir():
                if real not in entered and not os.path.lexists(entry.path + "/pyvenv.cfg"):
                    entered.add(real)
                    folders.append(shown)
                    waiting.append(path)
            elif entry.is_file():
                files.append(File(shown, _size(entry), partial(_read, Path(entry.path))))
            else:
                left_out.append(f"{shown} is not a regular file, and was not read")
    return make_tree(
        printable_path(folder.resolve().name or "submission"), files, folders, sorted(left_out), sorted(generated)
    )


def _generated(folder: Path, path: str) -> list[str]:
    """URDFs below a folder that a build has made: named in the report, never read."""
    found: list[str] = []
    seen = 0
    for where, folders, names in os.walk(folder / path):
        folders.sort()
        seen += len(names)
        if seen > _MOST_GENERATED:
            break
        found += [clean(os.path.relpath(f"{where}/{name}", folder)) for name in names if is_generated("build/" + name)]
    return found


def single_file(path: Path) -> File:
    """One file outside of any tree; its path is its name."""
    return File(printable_path(path.name), 0, partial(_read, path))


def _read(path: Path, limit: int, *, first: bool = False) -> bytes:
    return read_start(path, limit) if first else read_capped(path, limit)


def _entries(folder: Path, *, is_top: bool) -> list["os.DirEntry[str]"]:
    try:
        with os.scandir(folder) as found:
            return sorted(found, key=lambda each: each.name)
    except OSError as error:
        if is_top:
            raise InputError(f"cannot read {printable_path(folder)}: {error.strerror}") from None
        return []


def _size(entry: "os.DirEntry[str]") -> int:
    try:
        status = entry.stat()
    except OSError:
        return 0
    return status.st_size if stat.S_ISREG(status.st_mode) else 0
