"""The layouts of a class: what the names in a folder or zip say about each submission. No submission is opened.

- folders: a folder, archive or URDF for each student, with or without a prefix (GitHub's `lab6-{login}/`).
- Canvas (canvas-lms, lib/content_zipper.rb): `{name}[_LATE]_{user id}_{upload}_{file}`, `[LATE_]anon_{5 letters}_...`;
  `..._text.html` is a text, `..._link.html` an address; a second `robot.urdf` is saved as `robot-1.urdf`.
- Moodle (mod/assign/classes/downloader.php): `{full name}_{participant id}_assignsubmission_{plugin}[_{file}]`.
"""

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

from grader.classroom.listing import ClassListing
from grader.classroom.people import People
from grader.classroom.roster import Student
from grader.files.children import Children
from grader.files.names import BUILD_FOLDERS
from grader.submission.labs import LabFolders
from grader.text import printable_path

# The files that are submissions.
ENDINGS = (".zip", ".gz", ".tgz", ".bz2", ".xz", ".tar", ".7z", ".rar", ".urdf.xacro", ".urdf", ".xacro")
_ID = r"[1-9][0-9]{0,19}"  # Canvas writes no leading zeros
PATTERNS = {
    "folders": re.compile(
        # alice/, alice.urdf; a browser saves further copies as alice (1).zip and alice.tar (1).gz
        r"(?P<login>.+?)(?i:\.tar(?=[ .(]))?(?: ?\((?P<upload>[0-9]{1,4})\))?"
        rf"(?P<ending>/|(?i:{'|'.join(map(re.escape, ENDINGS))}))",
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
}
# Canvas numbers the uploads of all courses in order: a number far below the others' is part of a student's name.
_MAX_GROWTH = 1000
_NAME_IN_CANVAS = re.compile(r"[^\x00-,./:-@[-^`{-\x7f\s]*")


class Entry(NamedTuple):
    """A path in a class folder, and what its `name` tells of the student and the file; a folder ends in a slash."""

    path: str
    student: Student
    name: str = ""
    upload: int = 0
    ending: str = ""
    plugin: str = ""
    file: str = ""
    is_late: bool = False
    submitted: str = ""

    @property
    def order(self) -> tuple[int, bool, str]:
        """The order of copies: by the number, then a folder counts."""
        return self.upload, self.ending == "/", self.path

    def is_written_by(self, lms: str) -> bool:
        """Return whether an LMS may have written the name: Canvas writes those of students in lower case."""
        return lms == "moodle" or self.student.name == self.student.name.lower()


@dataclass(frozen=True, slots=True)
class ClassFolder:
    """A folder of submissions: its path in the listing (empty or with a slash), the names in it, and the course's.

    `labs` tells the folders of the lab; `ignored` collects lines for the user.
    """

    listing: ClassListing
    children: Children
    start: str
    people: People
    labs: LabFolders
    lab: str
    is_explicit: bool
    ignored: list[str]

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
        """Say why some names are no submissions; the reason continues a sentence that begins with the name."""
        self.ignored.extend(f"{printable_path(self.start + name)} {reason}" for name in names)

    def list_refused(self) -> None:
        """Say which names are not read, such as symlinks."""
        for name, reason in self.children.refused:
            self.ignore([name], reason)


def is_submission(name: str) -> bool:
    """Return whether a file has the ending of a submission."""
    return name.lower().endswith(ENDINGS)


def readings_of(name: str, layout: str) -> list[Entry]:
    """Return how a name can be read: in Canvas as team and 7, or team_7 and 101, of team_7_101_555_lab6.zip."""
    found = [_entry(one) for one in PATTERNS[layout].finditer(name)]
    is_known = layout == "moodle" or bool(found and not found[0].student.name)  # an anonymous student's
    return found[:1] if is_known else [one for one in found if _NAME_IN_CANVAS.fullmatch(one.student.name)]


def _entry(found: re.Match[str]) -> Entry:
    text = {"name": found.string[: found.start()], **dict.fromkeys(("canvas", "moodle", "login"), "")}
    text |= found.groupdict(default="")
    name, canvas, moodle = text["name"], text["canvas"], text["moodle"]
    key = text["login"] or "_".join(filter(None, (name, canvas, moodle)))
    student = Student(key, name, canvas=canvas, moodle=moodle)
    if "plugin" in text:
        return Entry(found.string, student, plugin=text["plugin"], file=text["file"])
    upload, is_late = int(text["upload"] or 0), bool(text["late"]) or found[0].startswith("LATE")
    return Entry(found.string, student, upload=upload, file=text["file"] or "text_entry.html", is_late=is_late)


def entries_of(folder: ClassFolder, layout: str) -> Iterator[Entry]:
    """Yield the submissions by their names; `aliases` are the numbers of which one is the user's."""
    folder.list_refused()
    if layout == "folders":
        yield from _folders(folder)
        return
    readings = {name: readings_of(name, layout) for name in folder.names}
    folder.ignore(name for name, found in readings.items() if not found)
    first = min((found[0].upload for found in readings.values() if len(found) == 1 and found[0].upload), default=0)
    for found in readings.values():
        possible = [one for one in found if not 0 < one.upload * _MAX_GROWTH < first] or found
        for one in possible[-1:]:
            users = tuple(other.student.canvas for other in possible)
            student = one.student._replace(canvas="", aliases=users) if len(users) > 1 else one.student
            yield one._replace(student=student)


def names_in(children: Children) -> dict[str, re.Match[str]]:
    """Return the names of the layout `folders` in a folder, each with what it tells; a folder ends in a slash."""
    names = [f"{name}/" for name in children.folders if name not in BUILD_FOLDERS] + children.files
    return {name: found for name in names if (found := PATTERNS["folders"].fullmatch(name))}


def _folders(folder: ClassFolder) -> Iterator[Entry]:
    """Yield each folder, archive and URDF, without the prefix of the assignment in its name."""
    read = names_in(folder.children)
    folder.ignore(name for name in folder.names if not {name, f"{name}/"} & read.keys())
    logins = {found["login"] for found in read.values()}
    prefix, tops = _prefix(logins, folder), {found["login"] for found in read.values() if not found["upload"]}
    for name, found in read.items():
        login, upload = found["login"], int(found["upload"] or 0)
        if upload and login not in tops and not folder.people.knows(_without(prefix, login)):
            login = name.removesuffix(found["ending"])  # Team (1) and Team (2) are two teams
        own = _without(prefix, login)
        yield Entry(name.rstrip("/"), Student(own, login=own), login, upload, found["ending"])


def _without(prefix: str, name: str) -> str:
    return name[len(prefix) :] if len(name) > len(prefix) and name.lower().startswith(prefix) else name


def _prefix(names: Collection[str], folder: ClassFolder) -> str:
    """Return the prefix of the assignment: the rubric's id, or what precedes the ids of most students."""
    knows, own = folder.people.knows, f"{folder.lab.lower()}-"
    known = sum(map(knows, names))
    if known < len(names) and len(own) > 1 and any(_without(own, name) != name for name in names):
        return own
    dashes = ((name, dash.end()) for name in names for dash in re.finditer("-", name))
    before = Counter(name[:end].lower() for name, end in dashes if knows(name[end:]))
    prefix, count = max(before.items(), key=lambda item: (item[1], item[0]), default=("", 0))
    return prefix if count > max(1, known) else ""
