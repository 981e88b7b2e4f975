"""Students' folders further down: nbgrader's `submitted/{student}/{lab}`, and `{team}/Lab6/{student}`."""

from collections import defaultdict
from collections.abc import Collection, Iterator
from dataclasses import replace

from grader.classroom.layouts import ClassFolder, Entry, entries_of, names_in
from grader.classroom.people import People
from grader.classroom.roster import Student, iso_time
from grader.errors import InputError
from grader.files.names import PACKAGE_FILES
from grader.names import folded
from grader.submission.labs import is_part, lab_words
from grader.text import enumerated, printable_path

_MAX_NAMED = 10
_MAX_TIME = 100  # bytes
_LOCAL_TIME = len("2026-09-01T10:00:00")


def nbgrader(course: ClassFolder) -> Iterator[Entry]:
    """Yield the submissions for one assignment with their times; raises InputError if there is none of its name."""
    folder = course.inside("submitted") if "submitted" in course.children.folders else course
    found: dict[str, list[str]] = defaultdict(list)
    for student in sorted(folder.children.folders):
        for name in folder.listing.children(folder.start + student).folders:
            found[name].append(student)
    wanted = [folder.lab] if folder.lab in found else [name for name in found if folded(name) == folded(folder.lab)]
    if len(wanted) != 1:
        named = enumerated([printable_path(name) for name in sorted(found)], _MAX_NAMED) or "none"
        raise InputError(f"name the assignment to grade with --assignment; there are: {named}")
    lab = wanted[0]
    folder.ignore({*folder.children.folders}.difference(found[lab]), f"has no submission for {printable_path(lab)}")
    folder.ignore(folder.children.files)
    folder.list_refused()
    for student in found[lab]:
        path = f"{folder.start}{student}/{lab}"
        time = _time_of(folder, path)
        yield Entry(path.removeprefix(course.start), Student(student, login=student), ending="/", submitted=time)


def _time_of(folder: ClassFolder, path: str) -> str:
    """Return the time, in UTC, in the file beside an assignment; empty if there is none."""
    try:
        data = folder.listing.read(f"{path}/timestamp.txt", _MAX_TIME)
    except InputError:
        return ""
    time = iso_time(data.decode("utf-8", "replace"))
    return f"{time}Z" if len(time) == _LOCAL_TIME else time


def teams(folder: ClassFolder) -> Iterator[Entry]:
    """Yield the submissions of the students in lab folders, and all other submissions as a whole."""
    whole = []
    for team in sorted(folder.children.folders):
        if students := list(_of_students(folder.inside(team), team)):
            yield from students
        else:
            whole.append(team)
    yield from entries_of(replace(folder, children=folder.children._replace(folders=whole)), "folders")


def _of_students(top: ClassFolder, team: str) -> Iterator[Entry]:
    """Yield the submissions of the students in the lab folders of a team."""
    for lab in filter(top.labs.is_lab, top.children.folders):
        below = top.inside(lab)
        if names := _students(below, team, lab_words(lab)):
            others = {*below.children.folders}.difference(names)
            below.ignore(others, "is named like a part of a submission")
            children = below.children._replace(folders=[name for name in below.children.folders if name in names])
            for entry in entries_of(replace(below, children=children, people=People(()), lab=""), "folders"):
                name, path = entry.student.login, f"{team}/{lab}/{entry.path}"
                yield entry._replace(path=path, student=Student(f"{team}/{name}", name, login=name, group=team))


def _students(lab: ClassFolder, team: str, words: Collection[str]) -> set[str]:
    """Return the names in a lab's folder that are those of students; none if it is one submission.

    Members of the team on the roster are certain, and with them others; without a roster several folders of which none
    is a package or has the name of a part. The folder of the only member alone stays with the rest of the repository.
    """
    people, folders = lab.people, lab.children.folders
    read = names_in(lab.children).items()
    known = {name.rstrip("/") for name, found in read if people.knows(found["login"], team)}
    others = {name for name in folders if name not in known and not is_part(name, words)}
    is_package = any(lab.listing.has(f"{lab.start}{name}/package.xml") for name in folders)
    are_students = not (people.students or is_package) and 1 < len(others) == len(folders)
    if not (lab.is_explicit or known or are_students):
        return set()
    is_alone = bool(known) and len(lab.entries) == 1 == len(people.members(team))
    return set() if is_alone or not PACKAGE_FILES.isdisjoint(lab.children.files) else known | others
