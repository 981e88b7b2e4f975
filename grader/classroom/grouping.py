"""The submissions in a class folder: the names that one owner has, and of several versions the last."""

import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grader.classroom.layouts import ClassFolder, Entry, entries_of, is_submission
from grader.classroom.listing import ClassListing
from grader.classroom.roster import Student, iso_time
from grader.errors import InputError
from grader.names import folded
from grader.text import enumerated, printable_path

_NUMBERED = re.compile(r"(.+?)-[1-9][0-9]?((?:\.[A-Za-z][A-Za-z0-9]*)*(?:\.[A-Za-z0-9]*)?)", re.DOTALL)
_MAX_FILES = 200_000  # of one participant; a zip has no more
_MAX_NAMED = 10
_MAX_TIME = 100  # bytes
_LOCAL_TIME = len("2026-09-01T10:00:00")


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


def one_each(folder: ClassFolder, layout: str) -> Iterator[ClassSubmission]:
    """Yield one submission for each owner. In Moodle, hidden names are the same word."""
    by_owner: dict[str, list[Entry]] = defaultdict(list)
    folder.list_refused()
    for entry in entries_of(folder, layout):
        by_owner[entry.owner].append(entry)
    are_hidden = layout == "moodle" and len(by_owner) > 1 == len(
        {one.name for some in by_owner.values() for one in some}
    )
    below = frozenset(folder.children.folders)
    while by_owner:  # of a large class not all is kept twice
        _, entries = by_owner.popitem()
        (name, *others), kept = sorted({entry.name for entry in entries}), _last_versions(folder, entries)
        login, canvas, number = entries[0].login, entries[0].canvas.split(), entries[0].moodle
        student = Student(
            login or "_".join(filter(None, (name, *canvas[-1:], number))),
            "" if others or login or are_hidden else name,
            login=login if layout == "folders" else "",
            canvas=canvas[0] if len(canvas) == 1 else "",
            moodle=number,
            aliases=tuple(canvas) if len(canvas) > 1 else (),
        )
        yield ClassSubmission(student, 0, *_files(folder, kept, below), any(entry.late for entry in kept))


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
    folder: ClassFolder, kept: Sequence[Entry], below: frozenset[str]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the paths of a student's files, or of the folder, and the own names of files."""
    listing, start = folder.listing, folder.start
    if len(kept) > 1:  # without empty folders, such as that of an empty text
        full = [one for one in kept if one.path not in below or any(files_below(listing, start + one.path))]
        kept = full or kept[:1]
    first, top = kept[0], start + kept[0].path
    if len(kept) == 1:
        if first.path not in below:
            return (top,), tuple(filter(None, [first.file]))
        return (top if first.ending or first.upload else _only_file(listing, top),), ()
    named: dict[str, str] = {}
    for entry in kept:
        top, part = start + entry.path, f"{entry.plugin}/" if entry.plugin else ""
        paths = sorted(files_below(listing, top, _MAX_FILES)) if entry.path in below else [top]
        named |= {path: part + (path[len(top) + 1 :] or entry.file or entry.path) for path in paths}
    return tuple(named), tuple(named.values())


def _only_file(listing: ClassListing, top: str) -> str:
    """Return the archive or URDF that is alone in a folder, as in Canvas; else the folder."""
    inner = listing.children(top, 9)
    names = inner.files if not (inner.folders or inner.refused) else []
    return f"{top}/{names[0]}" if len(names) == 1 and is_submission(names[0]) else top


def files_below(listing: ClassListing, top: str, most: int = 300) -> Iterator[str]:
    """Yield the paths of the files below a folder, those in it first; of more than `most` some more than that."""
    every, count = [top], 0
    for here in every:
        children = listing.children(here, most + 1)
        yield from (f"{here}/{name}" for name in children.files)
        every += [f"{here}/{name}" for name in sorted(children.folders)]
        count += len(children.files)
        if count + len(every) > most:
            break


def course_of(folder: ClassFolder) -> ClassFolder:
    """Return the folder of a course of nbgrader that holds those of the students: `submitted`, or itself."""
    return folder.inside("submitted") if "submitted" in folder.children.folders else folder


def is_course(folder: ClassFolder) -> bool:
    """Return whether students' folders in `submitted` have one of the lab."""
    course = course_of(folder)
    return course.name == "submitted" and folded(folder.rubric_id) in map(folded, _assignments(course))


def _assignments(folder: ClassFolder) -> dict[str, list[str]]:
    """Return the students with a submission for each assignment."""
    found: dict[str, list[str]] = defaultdict(list)
    for student in sorted(folder.children.folders):
        for name in folder.listing.children(folder.start + student).folders:
            found[name].append(student)
    return found


def nbgrader(folder: ClassFolder) -> Iterator[ClassSubmission]:
    """Yield the submissions for one assignment with their times; raises InputError if it is not clear which one."""
    course = course_of(folder)
    found, lab = _assignments(course), folder.assignment or folder.rubric_id
    wanted = [lab] if lab in found else [name for name in found if folded(name) == folded(lab)]
    if len(wanted) != 1 and (len(found) != 1 or folder.assignment):
        named = enumerated([printable_path(name) for name in sorted(found)], _MAX_NAMED) or "none"
        raise InputError(f"name the assignment to grade with --assignment; there are: {named}")
    (name,) = wanted or found
    course.ignore({*course.children.folders}.difference(found[name]), f"has no submission for {printable_path(name)}")
    course.ignore(course.children.files)
    course.list_refused()
    for student in found[name]:
        path = f"{course.start}{student}/{name}"
        yield ClassSubmission(Student(student, login=student), 0, (path,), submitted=_time_of(folder.listing, path))


def _time_of(listing: ClassListing, path: str) -> str:
    """Return the time, in UTC, in the file beside an assignment; empty if there is none."""
    try:
        time = iso_time(listing.read(f"{path}/timestamp.txt", _MAX_TIME).decode("utf-8", "replace"))
    except InputError:
        return ""
    return f"{time}Z" if len(time) == _LOCAL_TIME else time
