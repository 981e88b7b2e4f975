"""The Canvas layout, a bulk download: all files side by side, each with its student's name and user id in its name.

canvas-lms, lib/content_zipper.rb: `{name}[_LATE]_{user id}_{attachment id}_{file}`, or `[LATE_]anon_{5 letters}_{attachment
id}_{file}` where students are anonymous; `..._text.html` is a text entry, `..._link.html` a web address. A file that is submitted
again under the same name is saved with `-1`, `-2` after its stem (attachment.rb, make_unique_filename).

If groups are graded as a whole, there is one submission for each group, with the group's name and the user id of one member
(app/models/abstract_assignment.rb, representatives).
"""

import re
from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from grader.classroom.intake.layouts.layout import ClassFolder, IgnoredFiles, Submissions
from grader.classroom.intake.listing import Children
from grader.classroom.intake.names import ending_of
from grader.classroom.matching import word_characters
from grader.classroom.students import ClassSubmission, Student

_NAME = re.compile(
    r"(?:(?P<late_anon>LATE_)?anon_(?P<anon>[1-9A-HJ-NP-Za-km-z]{5})|(?P<name>.*?)(?P<late>_LATE)?_(?P<user>[0-9]{1,20}))"
    r"_(?:(?P<attachment>[0-9]{1,20})_(?P<file>.+)|(?P<page>text|link)\.(?:html|url))",
    re.DOTALL,
)
_MAYBE_USER = re.compile(r"_([0-9]{1,20})(?=_[0-9]{1,20}_.)")
_REPEATED = re.compile(
    r"(?P<stem>.+?)(?:-(?P<number>[1-9]\d?))?(?P<ending>(?:\.[A-Za-z][A-Za-z0-9]*)*(?:\.[A-Za-z0-9]*)?)", re.DOTALL
)


class _CanvasFile(NamedTuple):
    """One file of a download: whose it is, and the student's own name of it."""

    path: str
    name: str
    user: str
    readings: tuple[tuple[str, str], ...]
    is_anonymous: bool
    is_late: bool
    attachment: int
    file: str

    @property
    def is_ambiguous(self) -> bool:
        """Return whether the name can be read in several ways."""
        return len(self.readings) > 1


def is_layout(children: Children) -> bool:
    """Return whether this is a download of Canvas: at least three in four possible submissions are named like one.

    Canvas writes names in lower case, so a name with capitals does not count.
    """
    names = children.folders + children.files
    fitting = {name for name in names if (file := _parsed(name)) and not any(map(str.isupper, file.name))}
    possible = children.folders + [name for name in children.files if ending_of(name)]
    return bool(fitting) and len(fitting) >= 3 * sum(name not in fitting for name in possible)


def is_class(children: Children, name: str) -> bool:
    """Return whether this is a download of several users, or of one user in a folder with the name of a download."""
    return is_layout(children) and ("submissions" in name.casefold() or count_certain(children) > 1)


def count_certain(children: Children) -> int:
    """Return how many users have archives, URDFs or folders: other files may be the pictures of one student."""
    names = children.folders + [name for name in children.files if ending_of(name)]
    return len({(file.is_anonymous, file.user) for name in names if (file := _parsed(name))})


def find_submissions(folder: ClassFolder) -> Submissions:
    """Return the submissions of a download, one for each user. Folders count as files that someone has unpacked."""
    start, ignored = folder.start, folder.ignored
    by_user: dict[tuple[bool, str], list[_CanvasFile]] = defaultdict(list)
    known = {entry.student.canvas for entry in folder.roster.entries} if folder.roster is not None else set[str]()
    for name in (*folder.children.folders, *folder.children.files):
        file = _parsed(name)
        if file is None:
            ignored.add(start + name, "is not named like a submission in Canvas")
        else:
            file = _settled(file, known)
            by_user[file.is_anonymous, file.user].append(file)
    ignored.add_all(start, folder.children.refused)
    certain = {user: _certain(files, start, ignored) for user, files in by_user.items()}
    contested = dict.fromkeys(
        _student(file, file.readings) for user, files in by_user.items() if not certain[user] for file in files
    )
    found = (_submission(files, start) for files in certain.values() if files)
    is_anonymous = all(anonymous for anonymous, _ in by_user)  # a student may be called anon_ab3xy
    return Submissions(found, contested=tuple(contested), is_anonymous=is_anonymous)


def _certain(files: list[_CanvasFile], start: str, ignored: IgnoredFiles) -> list[_CanvasFile]:
    """Return the files of a user without those that may be another user's.

    Users choose their names, and one may end in a number: `mallory_77` with the id 99 has a file `mallory_77_99_...`. Canvas writes
    one user's name in one way, so a name that can be read in two ways counts only if a file with an unambiguous name has it too.
    """
    if len({file.name for file in files}) == 1:
        return files
    names = {file.name for file in files if not file.is_ambiguous}
    for file in files:
        if file.name not in names:
            reason = f"may belong to another user than {file.user}: its name can be read in two ways"
            ignored.add(start + file.path, reason)
    return [file for file in files if file.name in names]


def _parsed(name: str) -> _CanvasFile | None:
    if name.count("_") < 2:
        return None
    found = _NAME.fullmatch(name)
    plain = (found["name"] or "").replace("-", "") if found is not None else ""
    if found is None or word_characters(plain) != plain:
        return None
    anonymous = found["anon"]
    return _CanvasFile(
        name,
        "anon" if anonymous else found["name"],
        anonymous or found["user"],
        () if anonymous else _readings(name) or ((found["name"], found["user"]),),
        anonymous is not None,
        bool(found["late_anon"] or found["late"]),
        int(found["attachment"] or 0),
        found["file"] or f"{found['page']}_entry.html",
    )


def _settled(file: _CanvasFile, known: set[str]) -> _CanvasFile:
    """Return a file as it must be read if only one of the numbers in its name is the user id of a student on the roster."""
    fitting = [reading for reading in file.readings if reading[1] in known]
    if not file.is_ambiguous or len(fitting) != 1:
        return file
    ((name, user),) = fitting
    is_late = file.path.startswith(f"{name}_LATE_{user}_")
    rest = file.path.removeprefix(f"{name}{'_LATE' if is_late else ''}_{user}_")
    attachment, _, own = rest.partition("_")
    return file._replace(
        name=name, user=user, readings=((name, user),), is_late=is_late, attachment=int(attachment), file=own
    )


def _readings(name: str) -> tuple[tuple[str, str], ...]:
    """Return each name and user id that a file name can be read as: team and 7, or team_7 and 101, of team_7_101_555_lab6.zip."""
    return tuple((name[: found.start()].removesuffix("_LATE"), found[1]) for found in _MAYBE_USER.finditer(name))


def _submission(files: Sequence[_CanvasFile], start: str) -> ClassSubmission:
    by_file = _attempts_by_file(files)
    last = [attempts[-1] for attempts in by_file]
    first = min(last, key=lambda file: (file.is_ambiguous, file.name))
    readings = dict.fromkeys(
        reading for file in files if file.is_ambiguous == first.is_ambiguous for reading in file.readings
    )
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
