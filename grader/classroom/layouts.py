"""The downloads of Canvas and Moodle: what the names in them tell of each submission. No submission is opened.

- Canvas (canvas-lms, lib/content_zipper.rb): `{name}[_LATE]_{user id}_{upload}_{file}`, `[LATE_]anon_{5 letters}_...`;
  `..._text.html` is a text, `..._link.html` an address; a second `robot.urdf` is saved as `robot-1.urdf`.
- Moodle (mod/assign/classes/downloader.php): `{full name}_{participant id}_assignsubmission_{plugin}[_{file}]`.
"""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from grader.classroom.listing import Children, ClassListing
from grader.classroom.people import People
from grader.classroom.roster import Student
from grader.text import printable_path

# The files that are submissions. Of two that differ in the ending only, the first of these counts, before it a folder.
ENDINGS = (".zip", ".gz", ".tgz", ".bz2", ".xz", ".tar", ".7z", ".rar", ".urdf.xacro", ".urdf", ".xacro")
_ID = r"[1-9][0-9]{0,19}"  # Canvas writes no leading zeros
PATTERNS = {
    "folders": re.compile(
        # alice/, alice.urdf; a browser saves further copies as alice (1).zip and alice.tar (1).gz
        r"(?P<login>.+?)(?i:\.tar(?=[ .(]))?(?: ?\((?P<upload>[0-9]{1,4})\))?"
        rf"(?P<ending>/|(?i:{'|'.join(map(re.escape, ENDINGS))}))",
        re.DOTALL,
    ),
    "canvas": re.compile(
        rf"(?:(?<!\A)(?P<late>_LATE)?_(?P<canvas>{_ID})|\A(?:LATE_)?(?P<login>anon_[1-9A-HJ-NP-Za-km-z]{{5}}))"
        rf"(?=_(?:(?P<upload>{_ID})_(?P<file>.+)|(?:text|link)\.(?:html|url))\Z)",
        re.DOTALL,
    ),
    "moodle": re.compile(
        r"(?P<name>.+?)(?:_(?P<moodle>[0-9]{1,20}))?_assignsubmission_(?P<plugin>[a-z]+)_?(?P<file>.*)", re.DOTALL
    ),
}
_NAME_IN_CANVAS = re.compile(r"[^\x00-,./:-@[-^`{-\x7f\s]+")
_NUMBERED = re.compile(r"(.+?)-[1-9][0-9]?((?:\.[A-Za-z][A-Za-z0-9]*)*(?:\.[A-Za-z0-9]*)?)", re.DOTALL)
# Canvas numbers the uploads of all courses in order: a number far below the others' is part of a student's name.
_MAX_GROWTH = 1000
_MAX_FILES = 2_000  # of one participant, if files and an online text have to be put side by side


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


@dataclass(frozen=True, slots=True)
class ClassFolder:
    """A folder of submissions: its path in the listing (empty or with a slash), its name, and what the user has said.

    `labs` are the names of the lab's own folders. `ignored` and `notes` collect lines for the user.
    """

    listing: ClassListing
    children: Children
    start: str
    name: str
    people: People
    rubric_id: str
    labs: tuple[str, ...]
    assignment: str
    is_explicit: bool
    ignored: list[str]
    notes: list[str]

    @property
    def entries(self) -> list[str]:
        """The names in it that may be submissions."""
        return [*self.children.folders, *filter(is_submission, self.children.files)]

    def ignore(self, names: Iterable[str], reason: str) -> None:
        """Say why some names are no submissions; the reason continues a sentence that begins with the name."""
        self.ignored.extend(f"{printable_path(self.start + name)} {reason}" for name in names)


def is_submission(name: str) -> bool:
    """Return whether a file has the ending of a submission."""
    return name.lower().endswith(ENDINGS)


def in_canvas(name: str) -> list[re.Match[str]]:
    """Return how a name in Canvas can be read: as team and 7, or team_7 and 101, of team_7_101_555_lab6.zip."""
    found = PATTERNS["canvas"].finditer(name)
    possible = [one for one in found if one["login"] or _NAME_IN_CANVAS.fullmatch(name, 0, one.start())]
    return possible[:1] if possible and possible[0]["login"] else possible


def canvas(folder: ClassFolder) -> Iterator[ClassSubmission]:
    """Yield one submission for each user id; a file whose name can be read in several ways is certainly nobody's."""
    readings = {name: in_canvas(name) for name in folder.children.folders + folder.children.files}
    folder.ignore((name for name, found in readings.items() if not found), "is not named like a submission in Canvas")
    first = min((upload(one[0]) for one in readings.values() if len(one) == 1 and one[0]["upload"]), default=0)
    by_owner: dict[tuple[str, ...], list[re.Match[str]]] = defaultdict(list)
    for name, found in readings.items():
        possible = [one for one in found if not 0 < upload(one) * _MAX_GROWTH < first] or found
        users = [one["login"] or one["canvas"] for one in possible]
        for last in possible[-1:]:
            by_owner[(*users, name[: last.start()]) if len(users) > 1 else (users[0],)].append(last)
    for (user, *others), files in by_owner.items():
        names = sorted({file.string[: file.start()] for file in files})
        kept = _last_versions(folder, files)
        student = Student(
            user if files[0]["login"] else f"{names[0]}_{files[0]['canvas']}",
            names[0] if len(names) == 1 else "",
            canvas=user if user.isdecimal() and not others else "",
            aliases=(user, *others[:-1]) if others else (),
        )
        is_late = any(file["late"] or file.string.startswith("LATE_anon_") for file in kept)
        paths = tuple(folder.start + file.string for file in kept)
        yield ClassSubmission(student, 0, paths, tuple(map(_own_name, kept)), is_late)


def upload(entry: re.Match[str]) -> int:
    """Return the number of an upload or copy; 0 if it has none."""
    return int(entry["upload"] or 0)


def _own_name(file: re.Match[str]) -> str:
    return file["file"] or "text_entry.html"


def _last_versions(folder: ClassFolder, files: Sequence[re.Match[str]]) -> list[re.Match[str]]:
    """Return the last upload of each file: `robot-1.urdf` is a later `robot.urdf` only if there is a `robot.urdf`."""
    own = {file["file"] for file in files}
    last: dict[str, re.Match[str]] = {}
    for file in sorted(files, key=lambda file: (upload(file), file.string)):
        numbered = _NUMBERED.fullmatch(file["file"] or "")
        first = numbered[1] + numbered[2] if numbered else ""
        name = first if first in own else _own_name(file)
        if name in last:
            folder.ignore([last[name].string], f"is an earlier attempt: {printable_path(file.string)} counts")
        last[name] = file
    return [file for _, file in sorted(last.items())]


def in_moodle(name: str) -> re.Match[str] | None:
    """Return the parts of a name in Moodle; None if two participants could have chosen it."""
    return PATTERNS["moodle"].fullmatch(name) if name.count("_assignsubmission_") == 1 else None


def moodle(folder: ClassFolder) -> Iterator[ClassSubmission]:
    """Yield one submission for each participant, or group without a number. Hidden names are the same word."""
    found = {name: in_moodle(name) for name in sorted(folder.children.folders + folder.children.files)}
    folder.ignore((name for name, one in found.items() if one is None), "is not named like a submission in Moodle")
    by_owner: dict[str, list[re.Match[str]]] = defaultdict(list)
    for one in filter(None, found.values()):
        by_owner[one["moodle"] or f"_{one['name']}"].append(one)
    are_hidden = len({one["name"] for one in found.values() if one}) == 1 < len(by_owner)
    folders = frozenset(folder.children.folders)
    for files in by_owner.values():
        name, number = files[0]["name"], files[0]["moodle"] or ""
        student = Student(f"{name}_{number}" if number else name, "" if are_hidden else name, moodle=number)
        yield ClassSubmission(student, 0, *_files_in_moodle(folder, files, folders))


def _files_in_moodle(
    folder: ClassFolder, files: Sequence[re.Match[str]], folders: frozenset[str]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the paths of a participant's files, or of their folder, and their names if these are beside a text.

    A folder with one archive or URDF in it, and nothing else, counts as that file, as in Canvas.
    """
    if len(files) == 1 and files[0].string in folders:  # nearly always
        top = folder.start + files[0].string
        inner = folder.listing.children(top, 9)
        is_file = len(inner.files) == 1 and not (inner.folders or inner.refused) and is_submission(inner.files[0])
        return (f"{top}/{inner.files[0]}" if is_file else top,), ()
    named: dict[str, dict[str, str]] = {}
    for file in sorted(files, key=lambda file: (file["plugin"] != "file", file.string)):
        top, part = folder.start + file.string, "" if file["plugin"] == "file" else f"{file['plugin']}/"
        own = {top: part + (file["file"] or file.string)}
        if file.string in folders:
            below = files_below(folder.listing, top, _MAX_FILES)
            own = {path: part + path[len(top) + 1 :] for path in sorted(below)}
        named[top] = own
    first = next((top for top, own in named.items() if own), min(named))
    every = {path: name for own in named.values() for path, name in own.items()}
    if first not in every and every == named[first]:  # one folder
        is_file = len(every) == 1 and all(path.rpartition("/")[0] == first and is_submission(path) for path in every)
        return tuple(every) if is_file else (first,), ()
    return tuple(every), tuple(every.values())


def files_below(listing: ClassListing, top: str, most: int = 300) -> Iterator[str]:
    """Yield the paths of the files below a folder, those in it first; of more than `most` some more than that."""
    folders, count = [top], 0
    for here in folders:
        children = listing.children(here, _MAX_FILES + 1)
        yield from (f"{here}/{name}" for name in children.files)
        folders += [f"{here}/{name}" for name in sorted(children.folders)]
        count += len(children.files)
        if count + len(folders) > most:
            break
