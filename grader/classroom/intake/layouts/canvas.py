"""The Canvas layout, a bulk download: all files side by side, each with its student's name and user id in its name.

canvas-lms, lib/content_zipper.rb: `{name}[_LATE]_{user id}_{attachment id}_{file}`, or `[LATE_]anon_{5
letters}_{attachment id}_{file}` where students are anonymous; `..._text.html` is a text entry, `..._link.html` a web
address. A file that is submitted again under the same name is saved with `-1`, `-2` after its stem (attachment.rb,
make_unique_filename).

If groups are graded as a whole, there is one submission for each group, with the group's name and the user id of one
member (app/models/abstract_assignment.rb, representatives).
"""

import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from grader.classroom.intake.layouts.layout import ClassFolder, IgnoredFiles, Submissions
from grader.classroom.intake.names import ending_of
from grader.classroom.listing import Children
from grader.classroom.matching import word_characters
from grader.classroom.students import ClassSubmission, Student

_ID = r"[1-9][0-9]{0,19}"  # Canvas writes no leading zeros
# _678_robot.urdf, else _text.html
_REST = rf"_(?:(?P<attachment>{_ID})_(?P<file>.+)|(?P<page>text|link)\.(?:html|url))"
# LATE_anon_7kQzB_678_robot.urdf: five letters of base 58, which has no 0, I, O and l
_ANONYMOUS = re.compile(r"(?P<late>LATE_)?anon_(?P<user>[1-9A-HJ-NP-Za-km-z]{5})" + _REST, re.DOTALL)
# the part after the name in doejane_LATE_12345_678_robot.urdf: a file of the student may look the same, `_readings`
_USER = re.compile(rf"(?P<late>_LATE)?_(?P<user>{_ID})(?={_REST}\Z)", re.DOTALL)
# Canvas numbers the uploads of all courses in order: a number far below the others' is part of a name that a student
# chose.
_MAX_GROWTH = 1000
_REPEATED = re.compile(
    # robot, or robot-2 for the third upload
    r"(?P<stem>.+?)(?:-(?P<number>[1-9]\d?))?"
    # .urdf.xacro, .7z: only the last part may begin with a digit, so lab-1.2.urdf has no number
    r"(?P<ending>(?:\.[A-Za-z][A-Za-z0-9]*)*(?:\.[A-Za-z0-9]*)?)",
    re.DOTALL,
)


class _CanvasFile(NamedTuple):
    """A file of a download: whose it is, and the student's name of it; `readings` are the names and ids it may mean."""

    path: str
    name: str
    user: str
    is_anonymous: bool
    is_late: bool
    attachment: int
    file: str
    readings: tuple[tuple[str, str], ...] = ()

    @property
    def is_ambiguous(self) -> bool:
        """Return whether the name can be read in several ways."""
        return len(self.readings) > 1


def is_layout(children: Children) -> bool:
    """Return whether this is a download of Canvas: at least three in four possible submissions are named like one.

    Canvas writes names in lower case, so a name with capitals does not count.
    """
    names = children.folders + children.files
    fitting = {name for name in names if any(not any(map(str.isupper, file.name)) for file in _readings(name))}
    possible = children.folders + [name for name in children.files if ending_of(name)]
    return bool(fitting) and len(fitting) >= 3 * sum(name not in fitting for name in possible)


def is_class(children: Children, name: str) -> bool:
    """Return whether this is a download of several users, or of one user in a folder with the name of a download."""
    return is_layout(children) and ("submissions" in name.casefold() or count_certain(children) > 1)


def count_certain(children: Children) -> int:
    """Return how many users have archives, URDFs or folders: other files may be the pictures of one student."""
    names = children.folders + [name for name in children.files if ending_of(name)]
    return len({(file.is_anonymous, file.user) for name in names for file in _readings(name)[-1:]})


def find_submissions(folder: ClassFolder) -> Submissions:
    """Return the submissions of a download, one for each user. Folders count as files that someone has unpacked."""
    start, ignored = folder.start, folder.ignored
    by_user: dict[tuple[bool, str], list[_CanvasFile]] = defaultdict(list)
    found = {name: _readings(name) for name in (*folder.children.folders, *folder.children.files)}
    clear = [readings[0] for readings in found.values() if len(readings) == 1]
    names = {file.user: file.name for file in clear}
    first = min((file.attachment for file in clear if file.attachment), default=0)
    for name, readings in found.items():
        if readings:
            file = _last_reading(readings, names, first)
            by_user[file.is_anonymous, file.user].append(file)
        else:
            ignored.add(start + name, "is not named like a submission in Canvas")
    ignored.add_all(start, folder.children.refused)
    certain = {user: _certain(files, start, ignored) for user, files in by_user.items()}
    contested = dict.fromkeys(
        _student(file, file.readings) for user, files in by_user.items() if not certain[user] for file in files
    )
    submissions = (_submission(files, start) for files in certain.values() if files)
    is_anonymous = all(anonymous for anonymous, _ in by_user)  # a student may be called anon_ab3xy
    return Submissions(submissions, contested=tuple(contested), is_anonymous=is_anonymous)


def _certain(files: list[_CanvasFile], start: str, ignored: IgnoredFiles) -> list[_CanvasFile]:
    """Return the files of a user without those that may be another user's, if the user has others.

    Users choose their names, and one may end in a number: `mallory_77` with the id 99 has a file `mallory_77_99_...`.
    """
    clear = [file for file in files if not file.is_ambiguous]
    for file in files if clear else ():
        if file.is_ambiguous:
            reason = f"may belong to another user than {file.user}: its name can be read in two ways"
            ignored.add(start + file.path, reason)
    return clear or files


def _readings(path: str) -> list[_CanvasFile]:
    """Return how a file name can be read: as team and 7, or team_7 and 101, of team_7_101_555_lab6.zip."""
    if found := _ANONYMOUS.fullmatch(path):
        return [_read(path, "anon", found)._replace(is_anonymous=True)]
    return [
        _read(path, name, found)
        for found in _USER.finditer(path)
        if word_characters(plain := (name := path[: found.start()]).replace("-", "")) == plain
    ]


def _read(path: str, name: str, found: re.Match[str]) -> _CanvasFile:
    own = found["file"] or f"{found['page']}_entry.html"
    return _CanvasFile(path, name, found["user"], False, bool(found["late"]), int(found["attachment"] or 0), own)


def _last_reading(readings: Sequence[_CanvasFile], names: Mapping[str, str], first: int) -> _CanvasFile:
    """Return a file in its last possible reading: its number is no part of a name that a user chose.

    Canvas writes one user's name in one way: `names` are those in names that can be read in one way only. They cannot
    rule out the last reading, because its user may have changed the name between two downloads. `first` is the smallest
    number of an upload in these. A roster rules nothing out, because a student may be missing on it.
    """
    possible = [
        file
        for file in readings
        if (file is readings[-1] or names.get(file.user, file.name) == file.name)
        and not 0 < file.attachment * _MAX_GROWTH < first
    ] or readings
    return possible[-1]._replace(
        readings=() if possible[-1].is_anonymous else tuple((file.name, file.user) for file in possible)
    )


def _submission(files: Sequence[_CanvasFile], start: str) -> ClassSubmission:
    by_file = _attempts_by_file(files)
    last = [attempts[-1] for attempts in by_file]
    first = min(last, key=lambda file: file.name)
    readings = dict.fromkeys(reading for file in files for reading in file.readings)
    return ClassSubmission(
        _student(first, tuple(readings)),
        tuple(start + file.path for file in last),
        is_late=any(file.is_late for file in last),
        attempt=max(map(len, by_file)),
        earlier=tuple(start + file.path for attempts in by_file for file in attempts[:-1]),
        names=tuple(file.file for file in last),
    )


def _student(file: _CanvasFile, readings: tuple[tuple[str, str], ...]) -> Student:
    """Return whose a file is; if its name is ambiguous, without a user id."""
    canvas = "" if file.is_anonymous or file.is_ambiguous else file.user
    return Student(f"{file.name}_{file.user}", canvas=canvas, readings=readings)


def _attempts_by_file(files: Iterable[_CanvasFile]) -> list[list[_CanvasFile]]:
    """Return the attempts at each file, in order, sorted by the file's name.

    `step-1.png` is a later `step.png` only if there is a `step.png`: without it, the number is the student's own.
    """
    given = sorted(files, key=lambda file: (file.attachment, file.path))
    names = {file.file for file in given}
    by_file: dict[str, list[_CanvasFile]] = defaultdict(list)
    for file in given:
        found = _REPEATED.fullmatch(file.file)
        first = f"{found['stem']}{found['ending']}" if found else file.file
        by_file[first if first in names else file.file].append(file)
    return [attempts for _, attempts in sorted(by_file.items())]
