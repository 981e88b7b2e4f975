"""The Moodle layout, a bulk download: a folder for each participant, or all files side by side, unpacked or in a zip.

moodle, mod/assign/classes/downloader.php: `{full name}_{participant id}_assignsubmission_{plugin}/...`, in older versions with
a `_` after it, or `..._{plugin}_{file}` without folders. A team has its group's name and number, or no number. Where names are
hidden, the same word replaces each name, in the language of the site.

A folder with one archive or URDF in it, and nothing else, counts as that file: Canvas and students submit it without the folder,
and it has to get the same points.
"""

import re
from collections import defaultdict
from typing import NamedTuple

from grader.classroom.intake.layouts.layout import ClassFolder, Submissions
from grader.classroom.intake.listing import Children, ClassListing
from grader.classroom.intake.names import ending_of
from grader.classroom.students import ClassSubmission, Student

_NAME = re.compile(
    r"(?P<name>.+?)(?:_(?P<id>[0-9]{1,20}))?_assignsubmission_(?P<plugin>[a-z]+)_?(?P<file>.*)", re.DOTALL
)
_HIDDEN = frozenset({"Participant", "Teilnehmerin", "Participante", "Partecipante", "Deelnemer"})
_MAX_FILES = 2_000  # of one participant, if files and an online text have to be put side by side


class _MoodleFile(NamedTuple):
    """One file or folder of a download."""

    path: str
    name: str
    participant: str
    plugin: str
    file: str
    is_folder: bool


def is_layout(children: Children) -> bool:
    """Return whether this is a download of Moodle: at least half of the possible submissions are named like one."""
    fitting = sum(_parsed(name) is not None for names in (children.folders, children.files) for name in names)
    if not fitting:
        return False
    return 2 * fitting >= len(children.folders) + sum(1 for name in children.files if ending_of(name) or _parsed(name))


def find_submissions(folder: ClassFolder) -> Submissions:
    """Return the submissions of a download, one for each participant."""
    by_participant: dict[str, list[_MoodleFile]] = defaultdict(list)
    for names, is_folder in ((folder.children.folders, True), (folder.children.files, False)):
        for name in sorted(names):
            file = _parsed(name, is_folder=is_folder)
            if file is None:
                folder.ignored.add(folder.start + name, "is not named like a submission in Moodle")
            else:
                by_participant[file.participant or f"_{file.name}"].append(file)
    folder.ignored.add_all(folder.start, folder.children.refused)
    full_names = {file.name for files in by_participant.values() for file in files}
    are_hidden = full_names <= _HIDDEN or (len(full_names) == 1 and len(by_participant) > 1)
    return Submissions(
        _submission(folder, sorted(files, key=lambda file: (file.plugin != "file", file.path)), are_hidden=are_hidden)
        for files in by_participant.values()
    )


def _parsed(name: str, *, is_folder: bool = False) -> _MoodleFile | None:
    # Names and files are chosen by students: with two such words a name could belong to either of two participants.
    if name.count("_assignsubmission_") != 1:
        return None
    found = _NAME.fullmatch(name)
    if found is None:
        return None
    return _MoodleFile(name, found["name"], found["id"] or "", found["plugin"], found["file"], is_folder)


def _submission(folder: ClassFolder, files: list[_MoodleFile], *, are_hidden: bool) -> ClassSubmission:
    listing, start = folder.listing, folder.start
    if len(files) > 1:  # ignore empty folders
        files = [file for file in files if not file.is_folder or listing.first(start + file.path)] or files[:1]
    first = files[0]
    path = start + first.path
    key = f"{first.name}_{first.participant}" if first.participant else first.name
    student = Student(key, "" if are_hidden else first.name, moodle=first.participant)
    if len(files) == 1 and first.is_folder:
        return ClassSubmission(student, (_only_file(listing, path) or path,))
    names: dict[str, str] = {}
    for file in files:
        top, part = start + file.path, "" if file.plugin == "file" else f"{file.plugin}/"
        if file.is_folder:
            names |= {inner: part + inner[len(top) + 1 :] for inner in _files_below(listing, top)}
        else:
            names[top] = part + (file.file or file.path)
    if len(names) > _MAX_FILES:
        folder.ignored.add(path, f"has more than {_MAX_FILES} files: the files beside it were not read")
    if not names or len(names) > _MAX_FILES:
        return ClassSubmission(student, (path,))
    return ClassSubmission(student, tuple(names), names=tuple(names.values()))


def _only_file(listing: ClassListing, folder: str) -> str | None:
    """Return the one archive or URDF in a folder that contains nothing else."""
    children = listing.children(folder, _MAX_FILES)
    if children.folders or children.refused or len(children.files) != 1 or not ending_of(children.files[0]):
        return None
    return f"{folder}/{children.files[0]}"


def _files_below(listing: ClassListing, top: str) -> list[str]:
    """Return the files below a folder; if there are more than _MAX_FILES, more than that many of them."""
    folders, found = [top], list[str]()
    while folders and len(found) <= _MAX_FILES:
        folder = folders.pop()
        children = listing.children(folder, _MAX_FILES + 1)
        found += [f"{folder}/{name}" for name in children.files]
        folders += [f"{folder}/{name}" for name in children.folders]
    return sorted(found)
