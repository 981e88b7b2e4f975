"""Moodle's bulk download: a folder for each participant, or all files side by side, unpacked or in a zip.

moodle, mod/assign/classes/downloader.php: `{full name}_{participant id}_assignsubmission_{plugin}/...`, in older versions with
a `_` behind it, or `..._{plugin}_{file}` without folders. A team has its group's name and number, or no number. Where names are
hidden, the same word stands for each name, in the language of the site.

A folder with one archive or URDF in it, and nothing else, is no more than that file: Canvas and a student would give it without
the folder, and it has to get the same points.
"""

import re
from collections import defaultdict
from typing import NamedTuple

from grader.classroom.intake.layouts.layout import IgnoredFiles, SubmissionList, listed
from grader.classroom.intake.listing import Children, Listing
from grader.classroom.intake.names import ending_of
from grader.classroom.students import ClassSubmission, Student

_NAME = re.compile(
    r"(?P<name>.+?)(?:_(?P<id>[0-9]{1,20}))?_assignsubmission_(?P<plugin>[a-z]+)_?(?P<file>.*)", re.DOTALL
)
_HIDDEN = frozenset({"Participant", "Teilnehmerin", "Participante", "Partecipante", "Deelnemer"})
_MAX_FILES = 2_000  # of one participant, where files and a text have to be put side by side


class _MoodleFile(NamedTuple):
    """One file or folder of a download."""

    path: str
    name: str
    participant: str
    plugin: str
    file: str


def fits(children: Children) -> bool:
    """Whether this is surely a download of Moodle: at least half of what could be submissions is named like it."""
    fitting = sum(_saved(name) is not None for names in (children.folders, children.files) for name in names)
    if not fitting:
        return False
    return 2 * fitting >= len(children.folders) + sum(1 for name in children.files if ending_of(name) or _saved(name))


def find_submissions(listing: Listing, children: Children, start: str, ignored: IgnoredFiles) -> SubmissionList:
    """The hand-ins of a download, one for each participant."""
    folders, files = set(children.folders), children.files
    by_participant: dict[str, list[_MoodleFile]] = defaultdict(list)
    for name in (*sorted(folders), *sorted(files)):
        saved = _saved(name)
        if saved is None:
            ignored.add(start + name, "is not named as Moodle names what was handed in")
        else:
            by_participant[saved.participant or f"_{saved.name}"].append(saved)
    ignored.add_all((start + name, reason) for name, reason in children.refused)
    names = {saved.name for each in by_participant.values() for saved in each}
    are_hidden = names <= _HIDDEN or (len(names) == 1 and len(by_participant) > 1)
    return listed(
        _hand_in(listing, sorted(saved, key=_files_first), start, folders, ignored, are_hidden=are_hidden)
        for saved in by_participant.values()
    )


def _saved(name: str) -> _MoodleFile | None:
    if (
        name.count("_assignsubmission_") != 1
    ):  # twice, it could be of two participants: names and files are the students' own
        return None
    found = _NAME.fullmatch(name)
    return _MoodleFile(name, found["name"], found["id"] or "", found["plugin"], found["file"]) if found else None


def _files_first(saved: _MoodleFile) -> tuple[bool, str]:
    return saved.plugin != "file", saved.path


def _hand_in(
    listing: Listing,
    saved: list[_MoodleFile],
    start: str,
    folders: set[str],
    ignored: IgnoredFiles,
    *,
    are_hidden: bool,
) -> ClassSubmission:
    if len(saved) > 1:  # an empty folder is no part of a hand-in
        saved = [each for each in saved if each.path not in folders or listing.first(start + each.path)] or saved[:1]
    who = saved[0]
    key = f"{who.name}_{who.participant}" if who.participant else who.name
    student = Student(key, "" if are_hidden else who.name, moodle=who.participant)
    if len(saved) == 1 and who.path in folders:
        return ClassSubmission(student, (_lone_file(listing, start + who.path) or start + who.path,))
    named: dict[str, str] = {}
    for each in saved:
        named |= _side_by_side(listing, each, start, is_folder=each.path in folders)
    if len(named) > _MAX_FILES:
        ignored.add(start + who.path, f"has more than {_MAX_FILES} files: what stands beside it was not read")
    if not named or len(named) > _MAX_FILES:
        return ClassSubmission(student, (start + who.path,))
    return ClassSubmission(student, tuple(named), names=tuple(named.values()))


def _lone_file(listing: Listing, folder: str) -> str | None:
    """The one archive or URDF in a folder that holds nothing else."""
    children = listing.children(folder, _MAX_FILES)
    if children.folders or children.refused or len(children.files) != 1 or not ending_of(children.files[0]):
        return None
    return f"{folder}/{children.files[0]}"


def _side_by_side(listing: Listing, saved: _MoodleFile, start: str, *, is_folder: bool) -> dict[str, str]:
    """The files of one part of a hand-in by path, each with the name that it has among the others."""
    folder = "" if saved.plugin == "file" else f"{saved.plugin}/"
    if not is_folder:
        return {start + saved.path: folder + (saved.file or saved.path)}
    top = start + saved.path
    return {path: folder + path[len(top) + 1 :] for path in _files_below(listing, top)}


def _files_below(listing: Listing, top: str) -> list[str]:
    """The files below a folder; where there are more than there may be, more than that many of them."""
    waiting, found = [top], list[str]()
    while waiting and len(found) <= _MAX_FILES:
        where = waiting.pop()
        children = listing.children(where, _MAX_FILES + 1)
        found += [f"{where}/{name}" for name in children.files]
        waiting += [f"{where}/{name}" for name in children.folders]
    return sorted(found)
