"""The Moodle layout, a bulk download: a folder for each participant, or all files side by side, unpacked or in a zip.

moodle, mod/assign/classes/downloader.php: `{full name}_{participant id}_assignsubmission_{plugin}/...`, in older
versions with a `_` after it, or `..._{plugin}_{file}` without folders. A team has its group's name and number, or no
number. Where names are hidden, the same word replaces each name, in the language of the site.

A folder with one archive or URDF in it, and nothing else, counts as that file: Canvas and students submit it without
the folder, and it has to get the same points.
"""

import re
from collections import defaultdict

from grader.classroom.intake.attempts import first_of
from grader.classroom.intake.layouts.layout import ClassFolder, Submissions
from grader.classroom.intake.names import ending_of
from grader.classroom.listing import Children, ClassListing
from grader.classroom.students import ClassSubmission, Student

# Jane Doe_123_assignsubmission_file, ..._file_, ..._file_robot.urdf; Team A_assignsubmission_onlinetext
_NAME = re.compile(
    r"(?P<name>.+?)(?:_(?P<id>[0-9]{1,20}))?_assignsubmission_(?P<plugin>[a-z]+)_?(?P<file>.*)", re.DOTALL
)
_HIDDEN = frozenset({"Participant", "Teilnehmerin", "Participante", "Partecipante", "Deelnemer"})
_MAX_FILES = 2_000  # of one participant, if files and an online text have to be put side by side


def is_layout(children: Children) -> bool:
    """Return whether this is a download of Moodle: at least half of the possible submissions are named like one."""
    fitting = {name for name in children.folders + children.files if _parse(name)}
    possible = children.folders + [name for name in children.files if ending_of(name) or name in fitting]
    return bool(fitting) and 2 * len(fitting) >= len(possible)


def find_submissions(folder: ClassFolder) -> Submissions:
    """Return the submissions of a download, one for each participant."""
    folders = frozenset(folder.children.folders)
    by_participant: dict[str, list[re.Match[str]]] = defaultdict(list)
    for name in (*sorted(folders), *sorted(folder.children.files)):
        file = _parse(name)
        if file is None:
            folder.ignored.add(folder.start + name, "is not named like a submission in Moodle")
        else:
            by_participant[file["id"] or f"_{file['name']}"].append(file)
    folder.ignored.add_all(folder.start, folder.children.refused)
    full_names = {file["name"] for files in by_participant.values() for file in files}
    are_hidden = full_names <= _HIDDEN or (len(full_names) == 1 and len(by_participant) > 1)
    return Submissions(_submission(folder, files, folders, are_hidden=are_hidden) for files in by_participant.values())


def _parse(name: str) -> re.Match[str] | None:
    # Names and files are chosen by students: with two such words a name could belong to either of two participants.
    return _NAME.fullmatch(name) if name.count("_assignsubmission_") == 1 else None


def _submission(
    folder: ClassFolder, files: list[re.Match[str]], folders: frozenset[str], *, are_hidden: bool
) -> ClassSubmission:
    listing, start = folder.listing, folder.start
    files = sorted(files, key=lambda file: (file["plugin"] != "file", file.string))
    if len(files) > 1:  # ignore empty folders
        files = [
            file for file in files if file.string not in folders or first_of(listing, start + file.string)
        ] or files[:1]
    first = files[0]
    path, name, participant = start + first.string, first["name"], first["id"] or ""
    key = f"{name}_{participant}" if participant else name
    student = Student(key, "" if are_hidden else name, moodle=participant)
    if len(files) == 1 and first.string in folders:
        return ClassSubmission(student, (_only_file(listing, path) or path,))
    names: dict[str, str] = {}
    for file in files:
        top, part = start + file.string, "" if file["plugin"] == "file" else f"{file['plugin']}/"
        if file.string in folders:
            names |= {inner: part + inner[len(top) + 1 :] for inner in _files_below(listing, top)}
        else:
            names[top] = part + (file["file"] or file.string)
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
