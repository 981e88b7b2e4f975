"""The layouts of a class: what the names in a folder or zip say about each submission.

No submission is opened.

- folders: a folder, archive or URDF for each student, with or without a prefix (GitHub's
  `lab6-{login}/`).
- Canvas (canvas-lms, lib/content_zipper.rb): `{name}[_LATE]_{user id}_{upload}_{file}`,
  `[LATE_]anon_{5 letters}_...`; `..._text.html` is a text, `..._link.html` an address; a second
  `robot.urdf` is saved as `robot-1.urdf`.
- Moodle (mod/assign/classes/downloader.php): `{full name}_{participant
  id}_assignsubmission_{plugin}[_{file}]`.
- Blackboard (Learn, "Download Assignment Files"): `{assignment}_{user
  name}_attempt_{time}_{file}`, and a text `..._{time}.txt` with what the student has written.
- Students' folders further down: nbgrader's `submitted/{student}/{lab}`, and
  `{team}/Lab6/{student}`.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from datetime import datetime
from typing import NamedTuple

from grader.base.errors import InputError
from grader.base.names import folded
from grader.base.patterns import on_use
from grader.base.text import enumerated, printable_path
from grader.classroom.intake.class_files import ClassListing
from grader.classroom.roster.roster import People, Student, iso_time
from grader.files.class_source import Children
from grader.files.limits import BUILD_FOLDERS, PACKAGE_FILES
from grader.lab.submission.labs import LabFolders, is_part, lab_words

# The files that are submissions.
_ENDINGS = (
    ".zip",
    ".gz",
    ".tgz",
    ".bz2",
    ".xz",
    ".tar",
    ".7z",
    ".rar",
    ".urdf.xacro",
    ".urdf",
    ".xacro",
)
_ID = r"[1-9][0-9]{0,19}"  # Canvas writes no leading zeros
_PATTERNS = {
    "folders": re.compile(
        # alice/, alice.urdf; a browser saves further copies as alice (1).zip and alice.tar (1).gz
        r"(?P<login>.+?)(?i:\.tar(?=[ .(]))?(?: ?\((?P<upload>[0-9]{1,4})\))?"
        rf"(?P<ending>/|(?i:{'|'.join(map(re.escape, _ENDINGS))}))",
        re.DOTALL,
    ),
    "canvas": re.compile(  # the name is before it
        rf"(?:(?<!\A)(?P<late>_LATE)?_(?P<canvas>{_ID})|\A(?:LATE_)?(?P<login>anon_[1-9A-HJ-NP-Za-km-z]{{5}}))"
        rf"(?=_(?:(?P<upload>{_ID})_(?P<file>.+)|(?:text|link)\.(?:html|url))\Z)",
        re.DOTALL,
    ),
    "moodle": re.compile(  # not if two participants could have chosen it
        r"\A(?!.*_assignsubmission_.*_assignsubmission_)(?P<name>.+?)(?:_(?P<moodle>[0-9]{1,20}))?"
        r"_assignsubmission_(?:file(?![a-z])|(?P<plugin>[a-z]+))_?(?P<file>.*)\Z",
        re.DOTALL,
    ),
    "blackboard": re.compile(
        r"\A.*_(?P<login>[^_]+)_attempt_(?P<date>[0-9]{4}-[0-9]{2}-[0-9]{2})-"
        r"(?P<hour>[0-9]{2})-(?P<minute>[0-9]{2})-(?P<second>[0-9]{2})_(?P<file>.+)\Z",
        re.DOTALL,
    ),
}
_COMMENT = on_use(r"_attempt_[0-9-]{19}\.txt\Z")  # Blackboard's, beside each submission
# Canvas numbers the uploads of all courses in order: a number far below the others' is part of a
# student's name.
_MAX_GROWTH = 1000
_NAME_IN_CANVAS = on_use(r"[^\x00-,./:-@[-^`{-\x7f\s]*")
_MAX_ASSIGNMENTS = 10  # that a message names
_MAX_TIME = 100  # bytes


class NamedPath(NamedTuple):
    """A path in a class folder, and what its name tells of the student and the file."""

    path: str
    student: Student
    name: str = ""  # of the student or team, in the file's name
    upload: int = 0  # later ones have higher numbers
    ending: str = ""  # a slash for a folder
    plugin: str = ""  # of Moodle
    file: str = ""  # the student's own name of it
    is_late: bool = False
    submitted: str = ""  # ISO 8601

    @property
    def order(self) -> tuple[int, bool, str]:
        """The order of copies: by the number, then a folder counts."""
        return self.upload, self.ending == "/", self.path

    def is_written_by(self, lms: str) -> bool:
        """Return whether an LMS may have written the name.

        Canvas writes those of students in lower case.
        """
        return lms != "canvas" or self.student.name == self.student.name.lower()


NamedPaths = Iterator[NamedPath]


@dataclass(frozen=True, slots=True)
class ClassFolder:
    """A folder of submissions."""

    listing: ClassListing
    children: Children  # what is in it
    start: str  # its path in the listing: empty, or with a slash at the end
    people: People
    labs: LabFolders  # tells which folders are those of the lab
    lab: str  # the assignment, or the id of the rubric
    is_explicit: bool  # whether the user has named the layout
    ignored: list[str]  # collects lines for the user

    @property
    def names(self) -> list[str]:
        """All names in it."""
        return self.children.folders + self.children.files

    @property
    def entries(self) -> list[str]:
        """The names in it that may be submissions."""
        return [*self.children.folders, *filter(is_submission, self.children.files)]

    def inside(self, name: str) -> "ClassFolder":
        """Return a folder in it."""
        start = f"{self.start}{name}"
        return replace(self, children=self.listing.children(start), start=f"{start}/")

    def ignore(self, names: Iterable[str], reason: str = "is not named like a submission") -> None:
        """Say why some names are no submissions.

        The reason continues a sentence that begins with the name.
        """
        self.ignored.extend(f"{printable_path(self.start + name)} {reason}" for name in names)

    def list_refused(self) -> None:
        """Say which names are not read, such as symlinks."""
        for name, reason in self.children.refused:
            self.ignore([name], reason)


def is_submission(name: str) -> bool:
    """Return whether a file has the ending of a submission."""
    return name.lower().endswith(_ENDINGS)


def read_name(name: str, layout: str) -> list[NamedPath]:
    """Return how a name can be read.

    In Canvas, team_7_101_555_lab6.zip is of team and 7, or of team_7 and 101.
    """
    matches = [_read_path(one) for one in _PATTERNS[layout].finditer(name)]
    is_known = layout in ("moodle", "blackboard") or bool(
        matches and not matches[0].student.name
    )  # an anonymous student's
    if is_known:
        return matches[:1]
    return [one for one in matches if _NAME_IN_CANVAS.fullmatch(one.student.name)]


def _read_path(match: re.Match[str]) -> NamedPath:
    text = match.groupdict(default="")
    if "date" in text:
        return _read_attempt(match.string, text)
    name = text.get("name", match.string[: match.start()])
    canvas = text.get("canvas", "")
    moodle = text.get("moodle", "")
    key = text.get("login") or "_".join(filter(None, (name, canvas, moodle)))
    student = Student(key, name, canvas=canvas, moodle=moodle)
    if "plugin" in text:
        return NamedPath(match.string, student, plugin=text["plugin"], file=text["file"])
    return NamedPath(
        match.string,
        student,
        upload=int(text["upload"] or 0),
        file=text["file"] or "text_entry.html",
        is_late=bool(text["late"]) or match[0].startswith("LATE"),
    )


def _read_attempt(path: str, text: Mapping[str, str]) -> NamedPath:
    """Return what the parts of a name of Blackboard tell."""
    time = ":".join(text[unit] for unit in ("hour", "minute", "second"))
    submitted = f"{text['date']}T{time}"
    upload = int(re.sub("[^0-9]", "", submitted))
    student = Student(text["login"], login=text["login"])
    return NamedPath(path, student, upload=upload, file=text["file"], submitted=submitted)


def list_submissions(folder: ClassFolder, layout: str) -> NamedPaths:
    """Yield the submissions by their names.

    `aliases` are the numbers of which one is the user's.
    """
    folder.list_refused()
    if layout == "folders":
        yield from _folders(folder)
        return
    readings = {name: read_name(name, layout) for name in folder.names}
    nameless = [name for name, entries in readings.items() if not entries]
    folder.ignore(name for name in nameless if not _COMMENT.search(name))
    certain = [entries[0].upload for entries in readings.values() if len(entries) == 1]
    first = min(filter(None, certain), default=0)
    for entries in readings.values():
        possible = [
            entry for entry in entries if not 0 < entry.upload * _MAX_GROWTH < first
        ] or entries
        if not possible:
            continue
        last = possible[-1]
        if len(possible) == 1:
            yield last
        else:
            users = tuple(entry.student.canvas for entry in possible)
            yield last._replace(student=last.student._replace(canvas="", aliases=users))


def names_in(children: Children) -> dict[str, re.Match[str]]:
    """Return the names of the layout `folders` in a folder, each with what it tells.

    A folder ends in a slash.
    """
    folders = [f"{name}/" for name in children.folders if name not in BUILD_FOLDERS]
    matches = {}
    for name in folders + children.files:
        match = _PATTERNS["folders"].fullmatch(name)
        if match:
            matches[name] = match
    return matches


def _folders(folder: ClassFolder) -> NamedPaths:
    """Yield each folder, archive and URDF, without the prefix of the assignment in its name."""
    read = names_in(folder.children)
    folder.ignore(name for name in folder.names if not {name, f"{name}/"} & read.keys())
    logins = {match["login"] for match in read.values()}
    first_uploads = {match["login"] for match in read.values() if not match["upload"]}
    prefix = _prefix(logins, folder)
    for name, match in read.items():
        login = match["login"]
        ending = match["ending"]
        upload = int(match["upload"] or 0)
        is_known = login in first_uploads or folder.people.knows(_without(prefix, login))
        if upload and not is_known:
            login = name.removesuffix(ending)  # Team (1) and Team (2) are two teams
        student = _without(prefix, login)
        yield NamedPath(name.rstrip("/"), Student(student, login=student), login, upload, ending)


def _without(prefix: str, name: str) -> str:
    if len(name) > len(prefix) and name.lower().startswith(prefix):
        return name[len(prefix) :]
    return name


def _prefix(names: Collection[str], folder: ClassFolder) -> str:
    """Return the prefix of the assignment.

    This is the rubric's id, or what precedes the ids of most students.
    """
    knows = folder.people.knows
    own_prefix = f"{folder.lab.lower()}-"
    known = sum(map(knows, names))
    if (
        known < len(names)
        and len(own_prefix) > 1
        and any(_without(own_prefix, name) != name for name in names)
    ):
        return own_prefix
    dashes = ((name, dash.end()) for name in names for dash in re.finditer("-", name))
    before = Counter(name[:end].lower() for name, end in dashes if knows(name[end:]))
    prefix, count = max(before.items(), key=lambda item: (item[1], item[0]), default=("", 0))
    return prefix if count > max(1, known) else ""


def _students_by_assignment(folder: ClassFolder) -> dict[str, list[str]]:
    """Return the students with a folder for each assignment, by its name."""
    students_by_name = defaultdict(list)
    for student in sorted(folder.children.folders):
        for name in folder.listing.children(folder.start + student).folders:
            students_by_name[name].append(student)
    return students_by_name


def nbgrader(course: ClassFolder) -> NamedPaths:
    """Yield the submissions for one assignment with their times.

    Raises InputError if there is none of its name.
    """
    folder = course.inside("submitted") if "submitted" in course.children.folders else course
    students_by_name = _students_by_assignment(folder)
    if folder.lab in students_by_name:
        wanted = [folder.lab]
    else:
        wanted = [name for name in students_by_name if folded(name) == folded(folder.lab)]
    if len(wanted) != 1:
        named = (
            enumerated(map(printable_path, sorted(students_by_name)), _MAX_ASSIGNMENTS) or "none"
        )
        raise InputError(f"name the assignment to grade with --assignment; there are: {named}")
    lab = wanted[0]
    folder.ignore(
        {*folder.children.folders}.difference(students_by_name[lab]),
        f"has no submission for {printable_path(lab)}",
    )
    folder.ignore(folder.children.files)
    folder.list_refused()
    for student in students_by_name[lab]:
        path = f"{folder.start}{student}/{lab}"
        time = _read_time(folder, path)
        yield NamedPath(
            path.removeprefix(course.start),
            Student(student, login=student),
            ending="/",
            submitted=time,
        )


def _read_time(folder: ClassFolder, path: str) -> str:
    """Return the time, in UTC, in the file beside an assignment; empty if there is none."""
    try:
        data = folder.listing.read(f"{path}/timestamp.txt", _MAX_TIME)
    except InputError:
        return ""
    time = iso_time(data.decode("utf-8", "replace"))
    if time and datetime.fromisoformat(time).tzinfo is None:
        return f"{time}Z"
    return time


def teams(folder: ClassFolder) -> NamedPaths:
    """Yield the submissions of the students in lab folders.

    All other submissions are yielded as a whole.
    """
    whole = []
    for team in sorted(folder.children.folders):
        if students := list(_student_paths(folder.inside(team), team)):
            yield from students
        else:
            whole.append(team)
    yield from list_submissions(
        replace(folder, children=folder.children._replace(folders=whole)), "folders"
    )


def _student_paths(top: ClassFolder, team: str) -> NamedPaths:
    """Yield the submissions of the students in the lab folders of a team."""
    for lab in filter(top.labs.is_lab, top.children.folders):
        below = top.inside(lab)
        names = _students(below, team, lab_words(lab))
        if not names:
            continue
        others = {*below.children.folders}.difference(names)
        below.ignore(others, "is named like a part of a submission")
        folders = [name for name in below.children.folders if name in names]
        children = below.children._replace(folders=folders)
        inner = replace(below, children=children, people=People(()), lab="")
        for entry in list_submissions(inner, "folders"):
            name = entry.student.login
            path = f"{team}/{lab}/{entry.path}"
            student = Student(f"{team}/{name}", name, login=name, group=team)
            yield entry._replace(path=path, student=student)


def _students(lab: ClassFolder, team: str, words: Collection[str]) -> set[str]:
    """Return the names in a lab's folder that are those of students; none if it is one submission.

    Members of the team on the roster are certain, and with them others; without a roster several
    folders of which none is a package or has the name of a part. The folder of the only member
    alone stays with the rest of the repository.
    """
    people = lab.people
    folders = lab.children.folders
    known = set()
    for name, match in names_in(lab.children).items():
        if people.knows(match["login"], team):
            known.add(name.rstrip("/"))
    others = {name for name in folders if name not in known and not is_part(name, words)}
    is_alone = bool(known) and len(lab.entries) == 1 == len(people.members(team))
    if is_alone or not PACKAGE_FILES.isdisjoint(lab.children.files):
        return set()
    if lab.is_explicit or known:
        return known | others
    are_alike = 1 < len(others) == len(folders)
    if people.students or not are_alike:
        return set()
    is_package = any(lab.listing.has(f"{lab.start}{name}/package.xml") for name in folders)
    return set() if is_package else others
