"""The layouts of a class folder: what the names in it tell of each submission. No submission is opened.

- Canvas (canvas-lms, lib/content_zipper.rb): `{name}[_LATE]_{user id}_{upload}_{file}`, `[LATE_]anon_{5 letters}_...`;
  `..._text.html` is a text, `..._link.html` an address; a second `robot.urdf` is saved as `robot-1.urdf`.
- Moodle (mod/assign/classes/downloader.php): `{full name}_{participant id}_assignsubmission_{plugin}[_{file}]`.
- nbgrader: `submitted/{login}/{assignment}/`. Folders: a folder, archive or URDF for each student.
- Teams: `{team}/Lab6/{student}`.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import NamedTuple

from grader.classroom.listing import Children, ClassListing
from grader.classroom.people import People
from grader.classroom.roster import Student, iso_time
from grader.errors import InputError
from grader.files.names import BUILD_FOLDERS, PACKAGE_FILES
from grader.names import folded
from grader.submission.labs import Belonging, LabFolders, lab_words
from grader.submission.students import is_part
from grader.text import enumerated, printable_path

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
_ATTEMPT = re.compile(r"(?i:attempt|submission|try|versuch|abgabe)[ _-]?(?P<upload>[0-9]{1,6})")
_LAB = re.compile(r"lab-?[0-9]+-")
_ROBOT = re.compile(r"\.urdf$|xacro|urdf\b|/package\.xml$")
_MAX_NAMED, _MAX_ENTRIES, _MAX_FILES = 10, 300, 2_000


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

    `ignored` and `notes` collect lines for the user.
    """

    listing: ClassListing
    children: Children
    start: str
    name: str
    rubric_id: str
    labs: tuple[str, ...]
    assignment: str
    people: People
    is_explicit: bool
    ignored: list[str]
    notes: list[str]

    def ignore(self, names: Iterable[str], reason: str) -> None:
        """Say why some names are no submissions; the reason continues a sentence that begins with the name."""
        self.ignored.extend(f"{printable_path(self.start + name)} {reason}" for name in names)


def layout_of(folder: ClassFolder) -> str:
    """Return the layout that the names prove, else `folders`."""
    folders, files, _ = folder.children
    for layout, share in (("moodle", 1), ("canvas", 3)):
        fitting = {name for name in folders + files if _fits(layout, name)}
        others = sum(name not in fitting for name in [*folders, *filter(is_submission, files)])
        if fitting and len(fitting) >= share * others:
            return layout
    if course_of(folder) is not None:
        return "nbgrader"
    return "teams" if _team_labs(folder) else "folders"


def _fits(layout: str, name: str) -> bool:
    """Return whether a name is one of a layout. Canvas writes names in lower case, so capitals do not count."""
    if layout == "moodle":
        return _in_moodle(name) is not None
    return any(one["login"] or name[: one.start()] == name[: one.start()].lower() for one in _in_canvas(name))


def is_submission(name: str) -> bool:
    """Return whether a file has the ending of a submission."""
    return name.lower().endswith(ENDINGS)


def is_download(folder: ClassFolder) -> bool:
    """Return whether a folder is certainly a whole class as an LMS or nbgrader gives it, and no folder of a student."""
    names = [*folder.children.folders, *filter(is_submission, folder.children.files)]
    match layout_of(folder):
        case "canvas":  # a student may have pictures with such names
            users = {one[0] for name in names for one in list(_in_canvas(name))[-1:]}
            return "submissions" in folder.name.casefold() or len(users) > 1
        case "nbgrader":
            return _has_evidence(folder, course_of(folder) or "")
        case layout:
            return layout == "moodle"


def submissions_in(folder: ClassFolder, layout: str) -> list[ClassSubmission]:
    """Return the submissions in a folder, each with the student as far as names tell."""
    folder.ignored.extend(f"{printable_path(folder.start + name)} {reason}" for name, reason in folder.children.refused)
    finders = {"canvas": _canvas, "moodle": _moodle, "nbgrader": _nbgrader, "teams": _teams}
    return list(finders.get(layout, _folders)(folder))


def _in_canvas(name: str) -> Iterator[re.Match[str]]:
    """Yield how a name in Canvas can be read: as team and 7, or team_7 and 101, of team_7_101_555_lab6.zip."""
    for reading in PATTERNS["canvas"].finditer(name):
        if reading["login"] or _NAME_IN_CANVAS.fullmatch(name, 0, reading.start()):
            yield reading
            if reading["login"]:
                return


def _canvas(folder: ClassFolder) -> Iterator[ClassSubmission]:
    """Yield one submission for each user id; a file whose name can be read in several ways is certainly nobody's."""
    readings = {name: list(_in_canvas(name)) for name in folder.children.folders + folder.children.files}
    first = min((_upload(one[0]) for one in readings.values() if len(one) == 1 and _upload(one[0])), default=0)
    by_owner: dict[tuple[str, ...], list[re.Match[str]]] = defaultdict(list)
    for name, found in readings.items():
        possible = [one for one in found if not 0 < _upload(one) * _MAX_GROWTH < first] or found
        users = [one["login"] or one["canvas"] for one in possible]
        for last in possible[-1:]:
            by_owner[(*users, name[: last.start()]) if len(users) > 1 else (users[0],)].append(last)
    folder.ignore((name for name, found in readings.items() if not found), "is not named like a submission in Canvas")
    for (user, *others), files in by_owner.items():
        names = sorted({file.string[: file.start()] for file in files})
        kept = _last_versions(folder, files)
        canvas = user if user.isdecimal() and not others else ""
        key = user if files[0]["login"] else f"{names[0]}_{files[0]['canvas']}"
        yield ClassSubmission(
            Student(
                key, names[0] if len(names) == 1 else "", canvas=canvas, aliases=(user, *others[:-1]) if others else ()
            ),
            0,
            tuple(folder.start + file.string for file in kept),
            tuple(map(_own_name, kept)),
            any(file["late"] or file.string.startswith("LATE_anon_") for file in kept),
        )


def _upload(reading: re.Match[str]) -> int:
    return int(reading["upload"] or 0)


def _own_name(file: re.Match[str]) -> str:
    return file["file"] or "text_entry.html"


def _last_versions(folder: ClassFolder, files: Sequence[re.Match[str]]) -> list[re.Match[str]]:
    """Return the last upload of each file: `robot-1.urdf` is a later `robot.urdf` only if there is a `robot.urdf`."""
    own = {file["file"] for file in files}
    last: dict[str, re.Match[str]] = {}
    for file in sorted(files, key=lambda file: (_upload(file), file.string)):
        numbered = _NUMBERED.fullmatch(file["file"] or "")
        first = numbered[1] + numbered[2] if numbered else ""
        name = first if first in own else _own_name(file)
        if name in last:
            folder.ignore([last[name].string], f"is an earlier attempt: {printable_path(file.string)} counts")
        last[name] = file
    return [file for _, file in sorted(last.items())]


def _in_moodle(name: str) -> re.Match[str] | None:
    """Return the parts of a name in Moodle; None if two participants could have chosen it."""
    return PATTERNS["moodle"].fullmatch(name) if name.count("_assignsubmission_") == 1 else None


def _moodle(folder: ClassFolder) -> Iterator[ClassSubmission]:
    """Yield one submission for each participant, or group without a number. Hidden names are the same word."""
    by_owner: dict[str, list[re.Match[str]]] = defaultdict(list)
    for name in sorted(folder.children.folders + folder.children.files):
        if found := _in_moodle(name):
            by_owner[found["moodle"] or f"_{found['name']}"].append(found)
        else:
            folder.ignore([name], "is not named like a submission in Moodle")
    are_hidden = len({file["name"] for files in by_owner.values() for file in files}) == 1 < len(by_owner)
    for files in by_owner.values():
        name, number = files[0]["name"], files[0]["moodle"] or ""
        student = Student(f"{name}_{number}" if number else name, "" if are_hidden else name, moodle=number)
        yield ClassSubmission(student, 0, *_files_in_moodle(folder, files))


def _files_in_moodle(folder: ClassFolder, files: Sequence[re.Match[str]]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the paths of a participant's files, or of their folder, and their names if these are beside a text.

    A folder with one archive or URDF in it, and nothing else, counts as that file, as in Canvas.
    """
    named: dict[str, dict[str, str]] = {}
    for file in sorted(files, key=lambda file: (file["plugin"] != "file", file.string)):
        top, part = folder.start + file.string, "" if file["plugin"] == "file" else f"{file['plugin']}/"
        if file.string in folder.children.folders:
            below = _files_below(folder.listing, top, 2 if len(files) == 1 else _MAX_FILES)
            named[top] = {path: part + path[len(top) + 1 :] for path in below}
        else:
            named[top] = {top: part + (file["file"] or file.string)}
    first = next((top for top, inner in named.items() if inner), min(named))
    every = {path: name for inner in named.values() for path, name in inner.items()}
    if first not in every and every == named[first]:  # one folder
        is_file = len(every) == 1 and all(
            path.count("/") == first.count("/") + 1 and is_submission(path) for path in every
        )
        return tuple(every) if is_file else (first,), ()
    if len(every) > _MAX_FILES:
        folder.ignored.append(
            f"{printable_path(first)} has more than {_MAX_FILES} files: those beside it were not read"
        )
        return (first,), ()
    return tuple(every), tuple(every.values())


def _files_below(listing: ClassListing, top: str, most: int) -> list[str]:
    """Return the paths of the files below a folder; of more than `most` some more than that."""
    folders, found = [top], list[str]()
    for here in folders:
        children = listing.children(here, _MAX_FILES + 1)
        found += [f"{here}/{name}" for name in sorted(children.files)]
        folders += [f"{here}/{name}" for name in sorted(children.folders)]
        if len(found) + len(folders) > most:
            break
    return sorted(found)


def _folders(folder: ClassFolder) -> Iterator[ClassSubmission]:
    """Yield one submission for each folder, archive or URDF, without the prefix of the assignment in its name."""
    folder.ignore((name for name in folder.children.folders if name in BUILD_FOLDERS), "is a build folder")
    entries = [f"{name}/" for name in folder.children.folders if name not in BUILD_FOLDERS] + folder.children.files
    parts = {name: found for name in entries if (found := PATTERNS["folders"].fullmatch(name))}
    folder.ignore((name for name in entries if name not in parts), "is not a folder, an archive or a URDF")
    prefix = _prefix(
        {found["login"] for found in parts.values() if found["ending"] == "/"}
        or {found["login"] for found in parts.values()},
        folder,
    )
    plain = {found["login"] for found in parts.values() if not found["upload"]}
    by_owner: dict[str, list[re.Match[str]]] = defaultdict(list)
    for name, found in parts.items():
        login = found["login"]
        is_copy = found["upload"] and login not in plain and not folder.people.knows(_without(prefix, login))
        by_owner[name.removesuffix(found["ending"]) if is_copy else login].append(found)
    for owner, copies in by_owner.items():
        *others, last = sorted(copies, key=_order)
        folder.ignore(
            (other.string.rstrip("/") for other in others),
            f"is not graded: {printable_path(last.string.rstrip('/'))} counts",
        )
        login = _without(prefix, owner)
        path = folder.start + last.string.rstrip("/")
        path = _last_attempt(folder, path) if last["ending"] == "/" else path
        yield ClassSubmission(Student(login, login=login), 0, (path,))


def _order(copy: re.Match[str]) -> tuple[int, int, str]:
    """Return the order of copies: by the browser's number, then a folder counts, then the best ending."""
    is_folder = copy["ending"] == "/"
    return _upload(copy), 1 if is_folder else -ENDINGS.index(copy["ending"].lower()), copy.string


def _last_attempt(folder: ClassFolder, path: str) -> str:
    """Return the last attempt in a folder that contains nothing else, or the folder."""
    inner = folder.listing.children(path, 1000)
    names = [f"{name}/" for name in inner.folders] + inner.files
    found = [
        (int(one[1]), name)
        for name in names
        if (one := _ATTEMPT.match(name)) and (name.endswith("/") or is_submission(name))
    ]
    if not found or len(found) < len(names) or inner.refused:
        return path
    *earlier, last = sorted(found)
    if earlier:
        folder.notes.append(f"{printable_path(path)} has {len(found)} attempts, of which {last[1].rstrip('/')} counts")
    return f"{path}/{last[1].rstrip('/')}"


def _without(prefix: str, name: str) -> str:
    return name[len(prefix) :] if len(name) > len(prefix) and name.lower().startswith(prefix) else name


def _prefix(names: Iterable[str], folder: ClassFolder) -> str:
    """Return the prefix of the assignment: the rubric's id, or `lab` and a number, or what precedes most known names.

    One more folder cannot change what the others mean.
    """
    names, knows = list(names), folder.people.knows
    own = f"{folder.rubric_id.lower()}-"
    known = sum(map(knows, names))
    if not names or known == len(names):
        return ""
    if len(own) > 1 and any(_without(own, name) != name for name in names):
        return own
    counts = Counter(found[0] for name in names if (found := _LAB.match(name.lower())))
    for prefix, count in counts.most_common(1):
        if count * 2 > len(names):
            return prefix
    counts = Counter(
        name[: index + 1].lower()
        for name in names
        for index, letter in enumerate(name)
        if letter == "-" and knows(name[index + 1 :])
    )
    prefix, count = max(counts.items(), key=lambda item: (item[1], item[0]), default=("", 0))
    return prefix if count > max(1, known) else ""


def course_of(folder: ClassFolder) -> str | None:
    """Return where a course of nbgrader has the students' folders: below `submitted`, or here; None if it is none."""
    if "submitted" in folder.children.folders:
        return f"{folder.start}submitted/" if _assignments(folder.listing, f"{folder.start}submitted/") else None
    return folder.start if folder.name == "submitted" and _has_evidence(folder, folder.start) else None


def _has_evidence(folder: ClassFolder, start: str) -> bool:
    """Return whether there is a submission with a timestamp, or for the lab."""
    found = _assignments(folder.listing, start)
    stamps = (folder.listing.children(f"{start}{students[0]}/{name}").files for name, students in found.items())
    return folded(folder.rubric_id) in map(folded, found) or any("timestamp.txt" in names for names in stamps)


def _assignments(listing: ClassListing, start: str) -> dict[str, list[str]]:
    """Return the students with a submission for each assignment."""
    found: dict[str, list[str]] = defaultdict(list)
    for student in sorted(listing.children(start.rstrip("/")).folders):
        for name in listing.children(start + student).folders:
            found[name].append(student)
    return found


def _nbgrader(folder: ClassFolder) -> Iterator[ClassSubmission]:
    """Yield the submissions for one assignment with their times; raises InputError if it is not clear which one."""
    start = course_of(folder) or folder.start
    found = _assignments(folder.listing, start)
    name = _assignment(found, folder)
    others = [printable_path(other) for other in sorted(found) if other != name]
    if others and not folder.assignment:
        folder.notes.append(
            f"the assignment {printable_path(name)} is graded; to grade {enumerated(others, _MAX_NAMED)}, add --assignment"
        )
    course = replace(folder, start=start)
    children = folder.listing.children(start.rstrip("/"))
    course.ignore(
        sorted({*children.folders} - {*found[name]}), f"has no submission for the assignment {printable_path(name)}"
    )
    course.ignore(children.files, "is not a student's folder")
    stamps = folder.listing.starts([f"{start}{student}/{name}/timestamp.txt" for student in found[name]], 100)
    for student in found[name]:
        path = f"{start}{student}/{name}"
        time = _utc_time(stamps.get(f"{path}/timestamp.txt", b"").decode("utf-8", "replace"))
        yield ClassSubmission(Student(student, login=student), 0, (path,), submitted=time)


def _utc_time(text: str) -> str:
    """Return a time as ISO 8601 in UTC; one without a zone is in UTC. Empty if it is none."""
    try:
        time = datetime.fromisoformat(iso_time(text))
        time = time.replace(tzinfo=UTC) if time.tzinfo is None else time.astimezone(UTC)
    except (ValueError, OverflowError):  # OverflowError for a time in the year 1
        return ""
    return time.isoformat(timespec="seconds").replace("+00:00", "Z")


def _assignment(found: dict[str, list[str]], folder: ClassFolder) -> str:
    """Return the assignment to grade: the named one, that of the lab, or the only one."""
    named = ", ".join(printable_path(name) for name in sorted(found)[:_MAX_NAMED]) or "none"
    if folder.assignment:
        if folder.assignment in found:
            return folder.assignment
        raise InputError(
            f"there is no submission for the assignment {printable_path(folder.assignment)}; there are: {named}"
        )
    for names in (
        [name for name in found if name == folder.rubric_id],
        [name for name in found if folded(name) == folded(folder.rubric_id)],
        list(found),
    ):
        if len(names) == 1:
            return names[0]
    raise InputError(f"name the assignment to grade with --assignment; there are: {named}")


def _teams(folder: ClassFolder) -> Iterator[ClassSubmission]:
    """Yield the submissions of the students in lab folders, and of the teams without one."""
    labs = _team_labs(folder)
    lab_names, words = LabFolders(folder.labs), {word for lab in folder.labs for word in lab_words(lab)}
    rest = [name for name in folder.children.folders if name not in labs.values()]
    without = [name for name in rest if not folder.people.knows(name) and not _has_work(folder, name, lab_names)]
    folder.ignore(without, "has no folder of a lab and no robot")
    if "" in labs.values():  # the repository of one team
        folder.ignore(
            (name for name in [*rest, *folder.children.files] if name not in without),
            "is outside the folder of the lab",
        )
    else:
        kept = [name for name in rest if name not in without]
        yield from _folders(replace(folder, children=folder.children._replace(folders=kept)))
    for lab, team in labs.items():
        inner = folder.listing.children(lab)
        parts = [name for name in inner.folders if is_part(name, words) and not folder.people.knows(name, team)]
        members = replace(
            folder, start=f"{lab}/", rubric_id="", people=People(()),
            children=inner._replace(folders=[name for name in inner.folders if name not in parts]),
        )  # fmt: skip
        members.ignore(parts, "is named like a part of a submission")
        for found in _folders(members):
            name = found.student.login
            yield found._replace(student=Student(f"{team}/{name}" if team else name, name, login=name, group=team))


def _has_work(folder: ClassFolder, team: str, labs: LabFolders) -> bool:
    """Return whether a repository holds a folder of any lab, a robot or an archive."""
    names = (team, *folder.listing.children(folder.start + team, 1000).folders)
    below = _files_below(folder.listing, folder.start + team, _MAX_ENTRIES)
    is_lab = any(labs.belonging(f"{name}/") is not Belonging.NO_LAB for name in names)
    return is_lab or any(_ROBOT.search(path.lower()) or is_submission(path) for path in below)


def _team_labs(folder: ClassFolder) -> dict[str, str]:
    """Return the lab folders with students' folders, each with its team; without a team those of one repository."""
    if folder.is_explicit and (own := _labs_below(folder, "")):
        return dict.fromkeys(own, "")
    teams = [
        team for team in sorted(folder.children.folders) if folder.is_explicit or not folder.people.knows_student(team)
    ]
    return {lab: team for team in teams for lab in _labs_below(folder, team)}


def _labs_below(folder: ClassFolder, team: str) -> list[str]:
    """Return a team's folders of the lab that hold students', but not the only one's if the robot is elsewhere."""
    top, names = folder.start + team, LabFolders(folder.labs)
    labs = [
        f"{top}/{name}".lstrip("/")
        for name in folder.listing.children(top.rstrip("/"), 1000).folders
        if names.is_lab(name)
    ]
    labs = [lab for lab in labs if _holds_students(folder, lab, team)]
    is_alone = team and [len(folder.listing.children(lab).folders) for lab in labs] == [1]
    return [] if is_alone and not _has_robot(folder.listing, labs[0]) and _has_robot(folder.listing, top) else labs


def _has_robot(listing: ClassListing, top: str) -> bool:
    return any(_ROBOT.search(path.lower()) for path in _files_below(listing, top, _MAX_ENTRIES))


def _holds_students(folder: ClassFolder, lab: str, team: str) -> bool:
    """Return whether the folders in a lab's are those of students, and not the parts of one submission."""
    inner, words = folder.listing.children(lab, 1000), {word for own in folder.labs for word in lab_words(own)}
    parts = [name for name in inner.folders if is_part(name, words) and not folder.people.knows(name, team)]
    names = inner.folders + [name for name in inner.files if is_submission(name)]
    if not PACKAGE_FILES.isdisjoint(inner.files) or not names or (parts and not folder.is_explicit):
        return False
    known = sum(folder.people.knows(PATTERNS["folders"].sub(r"\g<login>", name), team) for name in names)
    if known and known >= min(len(names), 2):
        return True
    if folder.is_explicit:
        return len(parts) < len(inner.folders)
    below = {name: _files_below(folder.listing, f"{lab}/{name}", _MAX_ENTRIES) for name in inner.folders}
    robots = [name for name, paths in below.items() if any(_ROBOT.search(path.lower()) for path in paths)]
    return len(robots) > 1 and not any(f"{lab}/{name}/package.xml" in paths for name, paths in below.items())
