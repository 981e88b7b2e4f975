"""The folders of a course: what the names in them tell of each submission. No submission is opened.

A folder, archive or URDF for each student, with or without a prefix (GitHub's `lab6-{login}/`); repositories of teams,
`{team}/Lab6/{student}`; nbgrader's `submitted/{login}/{assignment}/`.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterator
from dataclasses import replace
from functools import lru_cache

from grader.classroom.layouts import ENDINGS, PATTERNS, ClassFolder, ClassSubmission, files_below, is_submission, upload
from grader.classroom.listing import ClassListing
from grader.classroom.people import People
from grader.classroom.roster import Student, iso_time
from grader.errors import InputError
from grader.files.names import BUILD_FOLDERS, PACKAGE_FILES
from grader.names import folded
from grader.submission.labs import Belonging, LabFolders, lab_words
from grader.submission.students import is_part
from grader.text import enumerated, printable_path

_LAB = re.compile(r"lab-?[0-9]+-")
_ROBOT = re.compile(r"\.urdf$|xacro|urdf\b|/package\.xml$")
_MAX_NAMED = 10


def folders(folder: ClassFolder) -> Iterator[ClassSubmission]:
    """Yield one submission for each folder, archive or URDF, without the prefix of the assignment in its name."""
    folder.ignore((name for name in folder.children.folders if name in BUILD_FOLDERS), "is a build folder")
    parse, unfit, by_login = PATTERNS["folders"].fullmatch, list[str](), defaultdict[str, list[str]](list)
    for name in (
        *(f"{name}/" for name in folder.children.folders if name not in BUILD_FOLDERS),
        *folder.children.files,
    ):
        if entry := parse(name):
            by_login[entry["login"]].append(name)
        else:
            unfit.append(name)
    folder.ignore(unfit, "is not a folder, an archive or a URDF")
    prefix = _prefix([login for login, names in by_login.items() if names[0].endswith("/")] or by_login, folder)
    while by_login:  # of a large class not all is kept twice
        login, names = by_login.popitem()
        copies = sorted(filter(None, map(parse, names)), key=_order)
        owners: dict[str, list[str]] = {login: [copy.string.rstrip("/") for copy in copies]}
        if all(copy["upload"] for copy in copies) and not folder.people.knows(_without(prefix, login)):
            owners = defaultdict(list)  # Team (1) and Team (2) are two teams
            for copy in copies:
                owners[copy.string.removesuffix(copy["ending"])].append(copy.string.rstrip("/"))
        for owner, (*others, last) in owners.items():
            folder.ignore(others, f"is not graded: {printable_path(last)} counts")
            key = _without(prefix, owner)
            yield ClassSubmission(Student(key, login=key), 0, (folder.start + last,))


def _order(copy: re.Match[str]) -> tuple[int, int, str]:
    """Return the order of copies: by the browser's number, then a folder counts, then the best ending."""
    rank = 1 if copy["ending"] == "/" else -ENDINGS.index(copy["ending"].lower())
    return upload(copy), rank, copy.string


def _without(prefix: str, name: str) -> str:
    return name[len(prefix) :] if len(name) > len(prefix) and name.lower().startswith(prefix) else name


def _prefix(names: Collection[str], folder: ClassFolder) -> str:
    """Return the prefix of the assignment: the rubric's id, `lab9-` of most names, or what precedes the most ids.

    One more folder cannot change what the others mean.
    """
    knows, own = folder.people.knows, f"{folder.rubric_id.lower()}-"
    known = sum(map(knows, names))
    if known == len(names):
        return ""
    if len(own) > 1 and any(_without(own, name) != name for name in names):
        return own
    labs = Counter(found[0] for name in names if (found := _LAB.match(name.lower())))
    dashes = ((name, dash.end()) for name in names for dash in re.finditer("-", name))
    before = Counter(name[:end].lower() for name, end in dashes if knows(name[end:]))
    for counts, least in ((labs, len(names) // 2), (before, max(1, known))):
        prefix, count = max(counts.items(), key=lambda item: (item[1], item[0]), default=("", 0))
        if count > least:
            return prefix
    return ""


def course_of(folder: ClassFolder) -> ClassFolder:
    """Return the folder of a course of nbgrader that holds those of the students: `submitted`, or itself."""
    if "submitted" not in folder.children.folders:
        return folder
    start = f"{folder.start}submitted"
    return replace(folder, children=folder.listing.children(start), start=f"{start}/", name="submitted")


def is_course(folder: ClassFolder) -> bool:
    """Return whether a folder `submitted` certainly is a course's: it holds the lab, or a submission with its time."""
    found = _assignments(folder) if folder.name == "submitted" else {}
    first = (f"{folder.start}{students[0]}/{name}/timestamp.txt" for name, students in found.items())
    return folded(folder.rubric_id) in map(folded, found) or any(folder.listing.start(path, 1) for path in first)


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
    found = _assignments(course)
    wanted = [folder.assignment] if folder.assignment else [name for name in found if name == folder.rubric_id]
    wanted = wanted or [name for name in found if folded(name) == folded(folder.rubric_id)] or list(found)
    if len(wanted) != 1 or wanted[0] not in found:
        named = enumerated([printable_path(name) for name in sorted(found)], _MAX_NAMED) or "none"
        raise InputError(f"name the assignment to grade with --assignment; there are: {named}")
    (name,) = wanted
    if others := [printable_path(other) for other in sorted(found) if other != name and not folder.assignment]:
        advice = f"to grade {enumerated(others, _MAX_NAMED)}, add --assignment"
        folder.notes.append(f"the assignment {printable_path(name)} is graded; {advice}")
    without = {*course.children.folders}.difference(found[name])
    course.ignore(without, f"has no submission for the assignment {printable_path(name)}")
    course.ignore(course.children.files, "is not a student's folder")
    for student in found[name]:
        path = f"{course.start}{student}/{name}"
        time = iso_time(folder.listing.start(f"{path}/timestamp.txt", 100).decode("utf-8", "replace"))
        has_zone = re.search(r"Z\Z|[+-][0-9:]+\Z", time[len("2026-09-01") :])
        submitted = f"{time}Z" if time and not has_zone else time  # in UTC
        yield ClassSubmission(Student(student, login=student), 0, (path,), submitted=submitted)


def teams(folder: ClassFolder) -> Iterator[ClassSubmission]:
    """Yield the submissions of the students in lab folders, and of the teams without one."""
    labs = dict(team_labs(folder))
    rest = [name for name in folder.children.folders if name not in labs.values()]
    if "" in labs.values():  # the repository of one team
        folder.ignore([*rest, *folder.children.files], "is outside the folder of the lab")
    else:
        yield from folders(replace(folder, children=folder.children._replace(folders=rest)))
    for lab, team in labs.items():
        inner = folder.listing.children(lab)
        members = replace(folder, start=f"{lab}/", people=People(()), rubric_id="")
        parts = _parts(folder, inner.folders, team)
        members.ignore(parts, "is named like a part of a submission")
        kept = inner._replace(folders=[name for name in inner.folders if name not in parts])
        for found in folders(replace(members, children=kept)):
            name = found.student.login
            yield found._replace(student=Student(f"{team}/{name}" if team else name, name, login=name, group=team))


def team_labs(folder: ClassFolder) -> Iterator[tuple[str, str]]:
    """Yield the lab folders with students' folders, each with its team; without a team those of one repository.

    A folder of a student stays whole, unless the user has named the layout.
    """
    if folder.is_explicit and (own := _labs_below(folder, "")):
        yield from ((lab, "") for lab in own)
        return
    for team in sorted(folder.children.folders):
        if folder.is_explicit or not folder.people.knows_student(team):
            yield from ((lab, team) for lab in _labs_below(folder, team))


def _labs_below(folder: ClassFolder, team: str) -> list[str]:
    """Return a team's folders of the lab that hold students'; not an only one's if the robot is in another lab's."""
    top, (names, _) = (folder.start + team).rstrip("/"), _names_of(folder.labs)
    below = folder.listing.children(top, 1000).folders
    labs = [f"{top}/{name}".lstrip("/") for name in below if names.is_lab(name)]
    labs = [lab for lab in labs if _holds_students(folder, lab, team)]
    if (
        team
        and [len(folder.listing.children(lab).folders) for lab in labs] == [1]
        and not _has_robot(folder.listing, labs[0])
    ):
        others = [name for name in below if names.belonging(f"{name}/") is Belonging.OTHER_LAB]
        if any(_has_robot(folder.listing, f"{top}/{name}") for name in others if not names.is_project(f"{name}/")):
            return []
    return labs


def _holds_students(folder: ClassFolder, lab: str, team: str) -> bool:
    """Return whether the folders in a lab's are those of students, and not the parts of one submission."""
    inner = folder.listing.children(lab, 1000)
    parts = _parts(folder, inner.folders, team)
    names = [f"{name}/" for name in inner.folders] + list(filter(is_submission, inner.files))
    if not PACKAGE_FILES.isdisjoint(inner.files) or not names or (parts and not folder.is_explicit):
        return False
    known = sum(folder.people.knows(PATTERNS["folders"].sub(r"\g<login>", name), team) for name in names)
    if known and known >= min(len(names), 2):
        return True
    if folder.is_explicit:
        return len(parts) < len(inner.folders)
    tops = [f"{lab}/{name}" for name in inner.folders]
    is_package = any(folder.listing.has(f"{top}/package.xml") for top in tops)
    return not is_package and sum(_has_robot(folder.listing, top) for top in tops) > 1


def _parts(folder: ClassFolder, names: Collection[str], team: str) -> list[str]:
    """Return the names in a lab's folder that are those of parts of a submission, and not of students."""
    _, words = _names_of(folder.labs)
    return [name for name in names if is_part(name, words) and not folder.people.knows(name, team)]


@lru_cache(maxsize=1)
def _names_of(labs: tuple[str, ...]) -> tuple[LabFolders, frozenset[str]]:
    """Return the names of the lab's folders, and the words in them."""
    return LabFolders(labs), frozenset(word for lab in labs for word in lab_words(lab))


def _has_robot(listing: ClassListing, top: str) -> bool:
    return any(_ROBOT.search(path.lower()) for path in files_below(listing, top))
