"""The layouts of a class: what the names in a folder or zip tell of each submission. No submission is opened.

- folders: a folder, archive or URDF for each student, with or without a prefix (GitHub's `lab6-{login}/`).
- Canvas (canvas-lms, lib/content_zipper.rb): `{name}[_LATE]_{user id}_{upload}_{file}`, `[LATE_]anon_{5 letters}_...`;
  `..._text.html` is a text, `..._link.html` an address; a second `robot.urdf` is saved as `robot-1.urdf`.
- Moodle (mod/assign/classes/downloader.php): `{full name}_{participant id}_assignsubmission_{plugin}[_{file}]`.
"""

import re
import sys
from collections import Counter
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

from grader.classroom.listing import ClassListing
from grader.classroom.people import People
from grader.files.children import Children
from grader.files.names import BUILD_FOLDERS
from grader.submission.labs import LabFolders
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
    "canvas": re.compile(  # the name is before it
        rf"(?:(?<!\A)(?P<late>_LATE)?_(?P<canvas>{_ID})|\A(?:LATE_)?(?P<login>anon_[1-9A-HJ-NP-Za-km-z]{{5}}))"
        rf"(?=_(?:(?P<upload>{_ID})_(?P<file>.+)|(?:text|link)\.(?:html|url))\Z)",
        re.DOTALL,
    ),
    "moodle": re.compile(  # not if two participants could have chosen it
        r"(?!.*_assignsubmission_.*_assignsubmission_)(?P<name>.+?)(?:_(?P<moodle>[0-9]{1,20}))?"
        r"_assignsubmission_(?:file(?![a-z])|(?P<plugin>[a-z]+))_?(?P<file>.*)",
        re.DOTALL,
    ),
}
_NAME_IN_CANVAS = re.compile(r"[^\x00-,./:-@[-^`{-\x7f\s]+")
# Canvas numbers the uploads of all courses in order: a number far below the others' is part of a student's name.
_MAX_GROWTH = 1000


class Entry(NamedTuple):
    """A name in a class folder, and what its layout tells; a folder ends in a slash in the layout `folders`."""

    path: str
    name: str = ""
    canvas: str = ""
    moodle: str = ""
    login: str = ""
    upload: str = ""
    late: str = ""
    plugin: str = ""
    file: str = ""
    ending: str = ""

    @property
    def owner(self) -> str:
        """What tells whose it is. Two numbers of Canvas are two readings of a name."""
        if " " in self.canvas:
            return f"{self.canvas} {self.name}"
        return self.canvas or (f"/{self.moodle}" if self.moodle else self.name)

    @property
    def order(self) -> tuple[int, int, str]:
        """The order of copies: by the number, then a folder counts, then the best ending."""
        rank = 1 if self.ending == "/" else -ENDINGS.index(self.ending.lower()) if self.ending else 0
        return int(self.upload or 0), rank, self.path


@dataclass(frozen=True, slots=True)
class ClassFolder:
    """A folder of submissions: its path in the listing (empty or with a slash), its name, and what the user has said.

    `labs` tells the lab's own folders, `lab_words` are the words of their names. `ignored` collects lines for the user.
    """

    listing: ClassListing
    children: Children
    start: str
    name: str
    people: People
    rubric_id: str
    labs: LabFolders
    lab_words: frozenset[str]
    assignment: str
    is_explicit: bool
    ignored: list[str]

    @property
    def entries(self) -> list[str]:
        """The names in it that may be submissions."""
        return [*self.children.folders, *filter(is_submission, self.children.files)]

    def inside(self, name: str) -> "ClassFolder":
        """Return a folder in it."""
        start = f"{self.start}{name}"
        return replace(self, children=self.listing.children(start), start=f"{start}/", name=name)

    def ignore(self, names: Iterable[str], reason: str = "") -> None:
        """Say why some names are no submissions; the reason continues a sentence that begins with the name."""
        for name in names:
            is_other = name in self.children.files and not is_submission(name)
            why = "is not a folder, an archive or a URDF" if is_other else "is not named like a submission"
            self.ignored.append(f"{printable_path(self.start + name)} {reason or why}")

    def list_refused(self) -> None:
        """Say which names are not read, such as symlinks."""
        for name, reason in self.children.refused:
            self.ignore([name], reason)


def is_submission(name: str) -> bool:
    """Return whether a file has the ending of a submission."""
    return name.lower().endswith(ENDINGS)


def readings_of(name: str, layout: str) -> list[Entry]:
    """Return how a name can be read: in Canvas as team and 7, or team_7 and 101, of team_7_101_555_lab6.zip."""
    if layout == "moodle":
        return [_entry(found) for found in [PATTERNS["moodle"].fullmatch(name)] if found]
    found = [_entry(one, name=name[: one.start()], file="text_entry.html") for one in PATTERNS["canvas"].finditer(name)]
    if found and found[0].login:
        return [found[0]._replace(name=found[0].login, late="LATE" if name.startswith("LATE") else "")]
    return [one for one in found if _NAME_IN_CANVAS.fullmatch(one.name)]


def _entry(found: re.Match[str], **known: str) -> Entry:
    return Entry(found.string, **known | {group: text for group, text in found.groupdict().items() if text})


def entries_of(folder: ClassFolder, layout: str) -> Iterator[Entry]:
    """Yield the submissions by their names: in Canvas with all ids that a name may have."""
    if layout == "folders":
        yield from _folders(folder)
        return
    readings = {name: readings_of(name, layout) for name in folder.children.folders + folder.children.files}
    folder.ignore(name for name, found in readings.items() if not found)
    first = min((found[0].order[0] for found in readings.values() if len(found) == 1 and found[0].upload), default=0)
    for found in readings.values():
        possible = [one for one in found if not 0 < one.order[0] * _MAX_GROWTH < first] or found
        yield from (one._replace(canvas=" ".join(it.canvas for it in possible)) for one in possible[-1:])


def _folders(folder: ClassFolder) -> Iterator[Entry]:
    """Yield each folder, archive and URDF, without the prefix of the assignment in its name."""
    parse, (folders, files, _) = PATTERNS["folders"].fullmatch, folder.children
    folder.ignore(BUILD_FOLDERS.intersection(folders))
    folder.ignore(name for name in files if not parse(name))
    names = [*(f"{name}/" for name in folders if name not in BUILD_FOLDERS), *filter(parse, files)]
    tops = {found["login"] for found in map(parse, names) if found and not found["upload"]}
    prefix = _prefix({found["login"] for found in map(parse, names) if found}, folder)
    for found in filter(None, map(parse, names)):
        name, ending = found["login"], sys.intern(found["ending"])
        if found["upload"] and name not in tops and not folder.people.knows(_without(prefix, name)):
            name = found.string.removesuffix(ending)  # Team (1) and Team (2) are two teams
        path = found.string.rstrip("/")
        yield Entry(path, name, login=_without(prefix, name), upload=found["upload"] or "", ending=ending)


def _without(prefix: str, name: str) -> str:
    return name[len(prefix) :] if len(name) > len(prefix) and name.lower().startswith(prefix) else name


def _prefix(names: Collection[str], folder: ClassFolder) -> str:
    """Return the prefix of the assignment: the rubric's id, or what precedes the ids of most students."""
    knows, own = folder.people.knows, f"{folder.rubric_id.lower()}-"
    known = sum(map(knows, names))
    if known < len(names) and len(own) > 1 and any(_without(own, name) != name for name in names):
        return own
    dashes = ((name, dash.end()) for name in names for dash in re.finditer("-", name))
    before = Counter(name[:end].lower() for name, end in dashes if knows(name[end:]))
    prefix, count = max(before.items(), key=lambda item: (item[1], item[0]), default=("", 0))
    return prefix if count > max(1, known) else ""
