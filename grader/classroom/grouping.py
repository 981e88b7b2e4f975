"""The submissions in a class folder: all files of a student, and of several versions the last."""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from grader.classroom.layouts import ClassFolder, Entry, is_submission
from grader.classroom.listing import ClassListing
from grader.classroom.roster import Student
from grader.text import printable_path

_NUMBERED = re.compile(r"(.+?)-[1-9][0-9]?((?:\.[A-Za-z][A-Za-z0-9]*)*(?:\.[A-Za-z0-9]*)?)", re.DOTALL)


class ClassSubmission(NamedTuple):
    """The submission of a student: one folder or file, or several files with the student's own `names` of them.

    `paths` are relative to the class folder or zip with the index `root`; `submitted` is ISO 8601, empty if unknown.
    """

    student: Student
    root: int
    paths: tuple[str, ...]
    names: tuple[str, ...] = ()
    is_late: bool = False
    submitted: str = ""


def one_each(folder: ClassFolder, entries: Iterable[Entry], root: int) -> Iterator[ClassSubmission]:
    """Yield one submission for each student whom the file names identify."""
    of_student: dict[tuple[Student, str], list[Entry]] = defaultdict(list)
    for entry in entries:
        of_student[entry.student, entry.name].append(entry)
    folders = frozenset(folder.children.folders)
    while of_student:  # of a large class not all is kept twice
        (student, _), own = of_student.popitem()
        kept = _last_versions(folder, own)
        is_late, submitted = any(one.is_late for one in kept), kept[0].submitted
        yield ClassSubmission(student, root, *_files(folder, kept, folders), is_late, submitted)


def _last_versions(folder: ClassFolder, entries: Sequence[Entry]) -> list[Entry]:
    """Return the last upload of each file: `robot-1.urdf` is a later `robot.urdf` only if there is a `robot.urdf`."""
    own = {entry.file for entry in entries}
    versions: dict[tuple[str, str], list[Entry]] = defaultdict(list)
    for entry in entries:
        numbered = _NUMBERED.fullmatch(entry.file) if entry.upload else None
        first = numbered[1] + numbered[2] if numbered else ""
        versions[entry.plugin, first if first in own else entry.file].append(entry)
    kept = []
    for _, copies in sorted(versions.items()):
        *others, last = sorted(copies, key=lambda entry: entry.order)
        folder.ignore((other.path for other in others), f"is not graded: {printable_path(last.path)} counts")
        kept.append(last)
    return kept


def _files(
    folder: ClassFolder, kept: Sequence[Entry], folders: frozenset[str]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the paths of a student's files, or of the folder, and the own names of files.

    An empty folder, such as that of an empty text, counts only if there is nothing else.
    """
    named, full = dict[str, str](), list[str]()
    tops = {folder.start + one.path: one for one in kept}
    for top, one in tops.items() if len(kept) > 1 else ():
        part = f"{one.plugin}/" if one.plugin else ""
        paths = _files_below(folder.listing, top) if one.path in folders else [top]
        named |= {path: part + (path[len(top) + 1 :] or one.file or one.path) for path in paths}
        full += [top] * bool(paths)
    if len(full) > 1:
        return tuple(named), tuple(named.values())
    top = next(iter(full or tops))
    only = tops[top]
    if only.path not in folders:
        return (top,), (only.file,) if only.file else ()
    return (top if only.ending or only.upload else _only_file(folder.listing, top),), ()


def _only_file(listing: ClassListing, top: str) -> str:
    """Return the archive or URDF that is alone in a folder, as in Canvas; else the folder."""
    inner = listing.children(top, 9)
    names = inner.files if not (inner.folders or inner.refused) else []
    return f"{top}/{names[0]}" if len(names) == 1 and is_submission(names[0]) else top


def _files_below(listing: ClassListing, top: str) -> list[str]:
    """Return the paths of the files below a folder, in order."""
    found, folders = list[str](), [top]
    for here in folders:
        children = listing.children(here)
        found += [f"{here}/{name}" for name in children.files]
        folders += [f"{here}/{name}" for name in children.folders]
    return sorted(found)
