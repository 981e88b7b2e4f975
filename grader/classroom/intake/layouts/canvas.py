"""Canvas' bulk download: all files side by side, each with its student's name and number in its own name.

canvas-lms, lib/content_zipper.rb: `{name}[_LATE]_{user id}_{attachment id}_{file}`, or `[LATE_]anon_{5 letters}_{attachment
id}_{file}` where students are anonymous; `..._text.html` is a text entry, `..._link.html` a web address. A file that is handed
in again under the same name is saved with `-1`, `-2` behind its stem (attachment.rb, make_unique_filename).
"""

import re
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

from grader.classroom.intake.layouts.layout import IgnoredFiles, SubmissionList, listed
from grader.classroom.intake.listing import Children
from grader.classroom.intake.names import ending_of
from grader.classroom.matching import is_word
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
    """One file of a download: whose it is, and what the student called it."""

    path: str
    name: str
    user: str
    maybe_users: tuple[str, ...]
    is_anonymous: bool
    is_late: bool
    attachment: int
    file: str


def fits(children: Children) -> bool:
    """Whether this is surely a download of Canvas: at least three in four of what could be submissions are named like it.

    Canvas writes names in lower case; a name with capitals speaks against it.
    """
    names = children.folders + children.files
    fitting = {name for name in names if _is_lower(_saved(name))}
    if not fitting:
        return False
    folders = set(children.folders)
    others = sum(1 for name in names if name not in fitting and (name in folders or ending_of(name)))
    return len(fitting) >= 3 * others


def find_submissions(children: Children, start: str, ignored: IgnoredFiles) -> SubmissionList:
    """The hand-ins of a download, one for each user. Folders count as files that someone has unpacked."""
    by_user: dict[tuple[bool, str], list[_CanvasFile]] = defaultdict(list)
    for name in (*children.folders, *children.files):
        saved = _saved(name)
        if saved is None:
            ignored.add(start + name, "is not named as Canvas names what was handed in")
        else:
            by_user[saved.is_anonymous, saved.user].append(saved)
    ignored.add_all((start + name, reason) for name, reason in children.refused)
    known = {user: _certain(saved, start, ignored) for user, saved in by_user.items()}
    shelf = listed(_hand_in(saved, start) for saved in known.values() if saved)
    contested = (_student(each) for user, saved in by_user.items() if not known[user] for each in saved)
    return replace(shelf, contested=tuple(dict.fromkeys(contested)))


def _certain(saved: list[_CanvasFile], start: str, ignored: IgnoredFiles) -> list[_CanvasFile]:
    """The files of a user without those that may be another user's.

    Users choose their names, and one may end in a number: `mallory_77` with the id 99 has a file `mallory_77_99_...`. Canvas writes
    one user's name in one way, so a name that can be read in two ways must be one that a file has which cannot.
    """
    if len({each.name for each in saved}) == 1:
        return saved
    certain = {each.name for each in saved if len(each.maybe_users) < 2}
    for each in saved:
        if each.name not in certain:
            ignored.add(start + each.path, f"may be of another user than {each.user}: its name can be read in two ways")
    return [each for each in saved if each.name in certain]


def _is_lower(saved: _CanvasFile | None) -> bool:
    return saved is not None and not any(letter.isupper() for letter in saved.name)


def _saved(name: str) -> _CanvasFile | None:
    if name.count("_") < 2:
        return None
    found = _NAME.fullmatch(name)
    if found is None or not all(is_word(letter) or letter == "-" for letter in found["name"] or ""):
        return None
    anonymous = found["anon"]
    return _CanvasFile(
        name,
        "anon" if anonymous else found["name"],
        anonymous or found["user"],
        tuple(_MAYBE_USER.findall(name)),
        anonymous is not None,
        bool(found["late_anon"] or found["late"]),
        int(found["attachment"] or 0),
        found["file"] or f"{found['page']}_entry.html",
    )


def _hand_in(saved: Iterable[_CanvasFile], start: str) -> ClassSubmission:
    last, earlier = _attempts(saved)
    first = min(
        last, key=lambda each: (len(each.maybe_users) > 1, each.name)
    )  # one that can be read in one way, if there is
    return ClassSubmission(
        _student(first),
        tuple(start + each.path for each in last),
        is_late=any(each.is_late for each in last),
        attempt=1 + max((len(each) for each in earlier), default=0),
        earlier=tuple(start + each.path for attempts in earlier for each in attempts),
        names=tuple(each.file for each in last),
    )


def _student(saved: _CanvasFile) -> Student:
    """Whose a file is; where its name can be read in several ways, with all the numbers that may be the user's."""
    is_certain = len(saved.maybe_users) < 2
    key = f"{saved.name}_{saved.user}"
    if saved.is_anonymous or not is_certain:
        return Student(key, maybe_canvas=() if is_certain else saved.maybe_users)
    return Student(key, canvas=saved.user)


def _attempts(saved: Iterable[_CanvasFile]) -> tuple[list[_CanvasFile], list[list[_CanvasFile]]]:
    """The files that count, and for each of them the earlier ones of that name, in order.

    `step-1.png` is a later `step.png` only where there is a `step.png`: without it, the number is the student's own.
    """
    given = sorted(saved, key=lambda each: (each.attachment, each.path))
    plain = {each.file for each in given}
    by_file: dict[str, list[_CanvasFile]] = defaultdict(list)
    for each in given:
        found = _REPEATED.fullmatch(each.file)
        first = f"{found['stem']}{found['ending']}" if found else each.file
        by_file[first if first in plain else each.file].append(each)
    last = [attempts[-1] for _, attempts in sorted(by_file.items())]
    return last, [attempts[:-1] for _, attempts in sorted(by_file.items()) if len(attempts) > 1]
