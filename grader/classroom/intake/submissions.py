"""The submissions of a class, one a student, and whose each of them is.

They are in one or several folders or zips.

The names prove a layout. All files of a student are one submission, of several versions the last.
Submissions are matched with students by the roster's column `submission`, ids, names and groups.
"""

import os
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

from grader.base.errors import InputError
from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.text import enumerated, first_lines, printable_path, shell_quoted
from grader.classroom.intake.class_files import ClassListing, list_class
from grader.classroom.intake.layouts import (
    ClassFolder,
    NamedPath,
    NamedPaths,
    is_submission,
    list_submissions,
    names_in,
    nbgrader,
    read_name,
    teams,
)
from grader.classroom.roster.roster import GROUP, People, Roster, Student, plain
from grader.files.class_source import ClassZip
from grader.files.limits import PACKAGE_FILES
from grader.files.tree import parents
from grader.lab.submission.labs import MAX_WRAPPERS, LabFolders, is_part

_NUMBERED = on_use(r"(.+?)-[1-9][0-9]?((?:\.[A-Za-z][A-Za-z0-9]*)*(?:\.[A-Za-z0-9]*)?)", re.DOTALL)
_MAX_LINES = 200
_MAX_OWNERS = 10  # students to whom a submission may belong, in a message
_ANONYMOUS = (
    "this is an anonymous download: its submissions (anon_...) match no student. "
    "Canvas shows the names when the grades are posted: download again then"
)
_DOWNLOADS = ("canvas", "moodle", "blackboard")
_LAYOUTS = ("folders", "canvas", "moodle", "blackboard", "teams", "nbgrader")


class ClassSubmission(NamedTuple):
    """The submission of a student: one folder or file, or several files."""

    student: Student
    root: int  # the index of the class folder or zip
    paths: Strings  # below it
    names: Strings = ()  # the student's own of several files
    is_late: bool = False
    submitted: str = ""  # ISO 8601; empty if unknown


class Intake(NamedTuple):
    """The submissions of a class, and lines for the user."""

    layout: str
    submissions: list[ClassSubmission]  # in the order of the students' keys
    unclear: frozenset[str]  # keys of students with possible submissions of which none counts
    unmatched: tuple[
        str, ...
    ]  # submissions without a certain student, and which row of the roster assigns them
    notes: Strings  # what was chosen
    ignored: Strings  # what in the folders is no submission


def read_class(
    paths: Sequence[Path],
    roster: Roster | None,
    layout: str = "auto",
    assignment: str = "",
    rubric_id: str = "",
    folders: Strings = (),
    ignore: Sequence[str] = (),
    gradebook: Path | None = None,
) -> Intake:
    """Return the submissions in class folders or zips, the sections of one class.

    Raises InputError if there are none.

    `assignment` is the one to grade in nbgrader; `rubric_id` is the name of the lab in names of
    folders, and `folders` are the names of its own (default: its id). `ignore` names entries that
    are no student's, such as a template; so is the `gradebook` of the run.
    """
    if layout not in ("auto", *_LAYOUTS):
        raise InputError(
            f"there is no layout {layout!r}; the layouts are: auto, {', '.join(_LAYOUTS)}"
        )
    roots = list(zip(map(list_class, paths), _names_of_roots(paths), strict=True))
    owners = _Owners(roster, roots)
    if not folders and rubric_id:
        folders = (rubric_id,)
    labs = LabFolders(folders)
    submissions = []
    layouts: dict[str, None] = {}
    for root, (path, (listing, _)) in enumerate(zip(paths, roots, strict=True)):
        lab = assignment or rubric_id
        is_explicit = layout != "auto"
        top = ClassFolder(
            listing, listing.children(""), "", owners.people, labs, lab, is_explicit, owners.ignored
        )
        folder = _inner_class(_without_gradebook(top, path, gradebook))
        chosen = layout if is_explicit else _choose_layout(folder, path, assignment)
        some = list(
            _submissions_in(
                folder, _without_ignored(folder, _paths_in(folder, chosen), ignore), root
            )
        )
        if not some:
            example = f": {min(owners.ignored)}" if owners.ignored else ""
            raise InputError(f"there is no submission in {printable_path(path)}{example}")
        has_teams = is_explicit or chosen != "teams" or any(one.student.group for one in some)
        layouts[chosen if has_teams else "folders"] = None
        submissions += some
    owners.find(submissions)
    return owners.intake(" and ".join(layouts))


def _choose_layout(folder: ClassFolder, path: Path, assignment: str) -> str:
    """Return the layout of a class folder; raise InputError for a single submission."""
    if assignment:
        return "nbgrader"
    layout = _prove_layout(folder)
    if layout == "teams" and "package.xml" in folder.children.files:
        what = (
            f"{printable_path(path)} is one submission and not a class: it contains a package.xml"
        )
        raise InputError(f"{what} (grade it with `grader grade {shell_quoted(path)}`)")
    return layout


def _names_of_roots(paths: Sequence[Path]) -> list[str]:
    """Return a name for each class folder, if necessary with the folder around it.

    Raises InputError.
    """
    for count in (1, 2):
        names = ["/".join(path.resolve().parts[-count:]) for path in paths]
        if len(set(names)) == len(names):
            return names
    raise InputError(
        "the class folders have the same names: rename one, so that the roster can name them"
    )


def _paths_in(folder: ClassFolder, layout: str) -> NamedPaths:
    """Yield the paths of submissions in a class folder with a layout."""
    if layout == "teams":
        return teams(folder)
    if layout == "nbgrader":
        return nbgrader(folder)
    return list_submissions(folder, layout)


def _without_ignored(
    folder: ClassFolder, entries: Iterable[NamedPath], ignore: Sequence[str]
) -> NamedPaths:
    """Yield the entries without those of which a folder or the student has a name to be ignored."""
    names = {*map(plain, ignore)}
    for one in entries:
        if names.isdisjoint(
            map(plain, (*one.path.split("/"), one.student.login, one.student.name))
        ):
            yield one
        else:
            folder.ignore([one.path], "has a name to be ignored")


def _without_gradebook(folder: ClassFolder, path: Path, gradebook: Path | None) -> ClassFolder:
    """Return the class folder at a path without the gradebook of the run, if it is in it.

    A student may submit a folder that looks like one.
    """
    if not gradebook or gradebook.resolve().parent != path.resolve():
        return folder
    own_folders = [name for name in folder.children.folders if name == gradebook.resolve().name]
    folder.ignore(own_folders, "is the gradebook")
    others = [name for name in folder.children.folders if name not in own_folders]
    return replace(folder, children=folder.children._replace(folders=others))


def _prove_layout(folder: ClassFolder) -> str:
    """Return the layout that the names prove, else `teams`, which may be plain folders."""
    for layout, share in (("moodle", 1), ("blackboard", 1), ("canvas", 3)):
        fitting = set()
        for name in folder.names:
            if any(entry.is_written_by(layout) for entry in read_name(name, layout)):
                fitting.add(name)
        others = sum(name not in fitting for name in folder.entries)
        if fitting and len(fitting) >= share * others:
            return layout
    if "submitted" in folder.children.folders and folder.inside("submitted").children.folders:
        return "nbgrader"
    return "teams"


def _inner_class(folder: ClassFolder) -> ClassFolder:
    """Return the folder that contains the submissions.

    A download may be in folders that contain nothing else. In a zip, it can be any folder that
    contains all submissions, unless it is itself one.
    """
    around = [folder]
    is_zip = isinstance(folder.listing, ClassZip)
    while len(around) <= MAX_WRAPPERS and (name := _only_folder(around[-1])):
        around.append(around[-1].inside(name))
        if _prove_layout(around[-1]) in ([*_DOWNLOADS, "nbgrader"] if is_zip else _DOWNLOADS):
            return around[-1]
    if len(around) == 1 or folder.children.files or not is_zip:
        return folder
    folders, files, _ = around[1].children
    is_package = not PACKAGE_FILES.isdisjoint(files) or any(map(is_part, folders))
    if is_package or len(around[1].entries) <= 1:
        return folder
    return around[1]


def _only_folder(folder: ClassFolder) -> str:
    """Return the only folder in a folder without other submissions.

    It is empty if there is none, or it is a student's.
    """
    name, *others = folder.entries or [""]
    is_student = (
        name not in folder.children.folders or name == "submitted" or folder.people.knows(name)
    )
    return "" if others or is_student else name


def _submissions_in(
    folder: ClassFolder, entries: Iterable[NamedPath], root: int
) -> Iterator[ClassSubmission]:
    """Yield one submission for each student whom the file names identify."""
    of_student = defaultdict(list)
    for entry in entries:
        of_student[entry.student, entry.name].append(entry)
    folders = frozenset(folder.children.folders)
    older = list[tuple[str, str]]()  # each with the path that counts
    while of_student:  # of a large class not all is kept twice
        (student, _), own_entries = of_student.popitem()
        kept = _last_versions(folder, own_entries, older)
        is_late = any(one.is_late for one in kept)
        submitted = kept[0].submitted
        yield ClassSubmission(
            student, root, *_paths_and_names(folder, kept, folders), is_late, submitted
        )
    _list_older(folder, sorted(older))


def _list_older(folder: ClassFolder, older: Sequence[tuple[str, str]]) -> None:
    """Say in one line which paths are not graded, because later ones, beside each, count."""
    if not older:
        return
    path, last = older[0]
    if len(older) == 1:
        folder.ignore([path], f"is not graded: {printable_path(last)} counts")
        return
    example = f"{printable_path(folder.start + path)}, for which {printable_path(last)} counts"
    folder.ignored.append(f"{len(older)} earlier files are not graded, such as {example}")


def _last_versions(
    folder: ClassFolder, entries: Sequence[NamedPath], older: list[tuple[str, str]]
) -> list[NamedPath]:
    """Return the last upload of each file, and add the paths of earlier ones to `older`.

    `robot-1.urdf` is a later `robot.urdf` only if there is a `robot.urdf`.
    """
    own_files = {entry.file for entry in entries}
    versions = defaultdict(list)
    for entry in entries:
        numbered = _NUMBERED.fullmatch(entry.file) if entry.upload else None
        first = numbered[1] + numbered[2] if numbered else ""
        versions[entry.plugin, first if first in own_files else entry.file].append(entry)
    kept = []
    for _, copies in sorted(versions.items()):
        *others, last = sorted(copies, key=lambda entry: entry.order)
        for other in others:
            if other.upload < last.upload:
                older.append((other.path, last.path))
            else:
                folder.ignore([other.path], f"is not graded: {printable_path(last.path)} counts")
        kept.append(last)
    return kept


def _paths_and_names(
    folder: ClassFolder, kept: Sequence[NamedPath], folders: frozenset[str]
) -> tuple[Strings, Strings]:
    """Return the paths of a student's files, or of the folder, and the own names of files.

    An empty folder, such as that of an empty text, counts only if there is nothing else.
    """
    named = dict[str, str]()
    full = []
    tops = {folder.start + one.path: one for one in kept}
    for top, one in tops.items() if len(kept) > 1 else ():
        part = f"{one.plugin}/" if one.plugin else ""
        paths = _files_below(folder.listing, top) if one.path in folders else [top]
        named |= {path: part + (path[len(top) + 1 :] or one.file or one.path) for path in paths}
        if paths:
            full.append(top)
    if len(full) > 1:
        return tuple(named), tuple(named.values())
    top = next(iter(full or tops))
    only = tops[top]
    if only.path not in folders:
        return (top,), (only.file,) if only.file else ()
    return (top if only.ending or only.upload else _only_file(folder.listing, top),), ()


def _only_file(listing: ClassListing, top: str) -> str:
    """Return the archive or URDF that is alone in a folder, as in Canvas; else the folder."""
    inner = listing.children(top, 9)
    names = inner.files if not (inner.folders or inner.refused) else []
    if len(names) == 1 and is_submission(names[0]):
        return f"{top}/{names[0]}"
    return top


def _files_below(listing: ClassListing, top: str) -> list[str]:
    """Return the paths of the files below a folder, in order."""
    files = []
    folders = [top]
    for here in folders:
        children = listing.children(here)
        files += [f"{here}/{name}" for name in children.files]
        folders += [f"{here}/{name}" for name in children.folders]
    return sorted(files)


class _Owners:
    """The submission of each student, by the index on the roster.

    Those that match none are apart, and so are those that are ambiguous.
    """

    def __init__(self, roster: Roster | None, roots: Sequence[tuple[ClassListing, str]]) -> None:
        self.people = People(roster.students if roster else ())
        self.roots = roots
        self.notes = list(roster.notes) if roster else []
        self.ignored: list[str] = []
        self._has_roster = roster is not None
        self._owned: dict[int, ClassSubmission] = {}
        self._unclear: set[int] = set()
        self._visitors: list[ClassSubmission] = []
        self._unmatched: list[str] = []

    def find(self, submissions: Sequence[ClassSubmission]) -> None:
        """Assign all submissions.

        What a person has assigned decides, then ids and names, then groups.
        """
        if all(one.student.key.startswith("anon_") for one in submissions):
            self.notes.append(_ANONYMOUS)
            self._unclear.update(range(len(self.people.students)))
        if not self._has_roster:
            self._visitors = list(submissions)
            return
        self._assign(submissions)
        claims: dict[int, dict[ClassSubmission, int]] = defaultdict(dict)
        possible = {}
        for one in sorted(
            set(submissions).difference(self._owned.values()),
            key=lambda one: (one.student.key, one.root, one.paths),
        ):
            match = self.people.match(one.student)
            possible[one] = match.students
            owners = () if match.by == GROUP and self._holds_students(one) else match.owners
            for index in owners:
                claims[index][one] = match.by
            if not owners:
                self._unclear.update(match.students)
        given, contested = self._decide(claims)
        for one, students in possible.items():
            if one not in given:
                self._list(one, students, is_contested=one in contested)

    def _decide(
        self, claims: Mapping[int, Mapping[ClassSubmission, int]]
    ) -> tuple[set[ClassSubmission], set[ClassSubmission]]:
        """Give each student the submission with the only best claim.

        Return those given, and those equally good.
        """
        given = set()
        contested = set()
        for index, claimed in claims.items():
            best = min(claimed.values())
            first = [one for one, by in claimed.items() if by == best]
            if self.people.students[index].submission:
                continue
            if len(first) == 1:  # of a group's, the ids in its name are those of one member
                self._owned[index] = (
                    first[0]._replace(student=Student("")) if best == GROUP else first[0]
                )
                given.add(first[0])
            else:
                self._unclear.add(index)
                contested.update(first)
        return given, contested - given

    def _holds_students(self, one: ClassSubmission) -> bool:
        """Return whether two students or more have submissions in a folder.

        It then is a section, not a team's work.
        """
        inner = self.roots[one.root][0].children(one.paths[0], 1000)
        return sum(self.people.knows(match["login"]) for match in names_in(inner).values()) > 1

    def _assign(self, submissions: Iterable[ClassSubmission]) -> None:
        """Give students what the roster's column `submission` names."""
        wanted = {index: one for index, one in enumerate(self.people.students) if one.submission}
        places = defaultdict(set)
        for one in submissions if wanted else ():
            for path in one.paths:
                places[self._shown(one, path)].add(one)
        for index, student in wanted.items():
            place = _plain_path(student.submission)
            named = list(places.get(place) or self._at(place))
            if len(named) == 1:
                self._owned[index] = named[0]
            else:
                self._unclear.add(index)
                self.notes.append(
                    f"{student.key} has the submission {place!r} on the roster, which does "
                    "not exist"
                )

    def _at(self, place: str) -> Iterator[ClassSubmission]:
        """Yield what is at a place in the class folders, and no submission by itself."""
        for root, (listing, name) in enumerate(self.roots):
            path = place
            if len(self.roots) > 1:
                path = place.removeprefix(f"{name}/")
                if path == place:
                    continue
            if all(_is_listed(listing, part) for part in (path, *parents(path))):
                yield ClassSubmission(Student(""), root, (path,))

    def _shown(self, one: ClassSubmission, path: str = "") -> str:
        """Return a path as a person can write it on the roster.

        Of several class folders, it begins with the name of its own.
        """
        return _plain_path(self._path(one, path or one.paths[0]))

    def _path(self, submission: ClassSubmission, path: str) -> str:
        """Return a path with the name of its class folder if there are several."""
        if len(self.roots) == 1:
            return path
        return f"{self.roots[submission.root][1]}/{path}"

    def _list(self, one: ClassSubmission, students: Sequence[int], *, is_contested: bool) -> None:
        """List a submission without an owner, and what assigns it.

        A contested one is not graded.
        """
        if not is_contested:
            self._visitors.append(one)
        keys = enumerated(
            [self.people.students[index].key for index in students], _MAX_OWNERS, "or"
        )
        reason = f"may belong to {keys}" if students else "is not on the roster"
        reason += ", and so may another submission: none is graded" if is_contested else ""
        key, place = (
            _csv_cell(text) for text in (printable_path(one.student.key), self._shown(one))
        )
        row = "" if is_contested else f", or add the row `{key},{place}` below `id,submission`"
        advice = f"write {place} in the column `submission` of its student{row}"
        self._unmatched.append(f"{self._shown(one)} {reason}; to assign it, {advice}")

    def _submissions_of_visitors(self) -> Iterator[ClassSubmission]:
        """Yield the submissions that nobody on the roster owns, each with a key of its own."""
        counts = Counter(visitor.student.key for visitor in self._visitors)
        taken = {plain(student.key) for student in self.people.students}
        for submission in self._visitors:
            key = submission.student.key
            if counts[key] > 1 or not key.isprintable() or plain(key) in taken:
                key = _path_key(self._path(submission, submission.paths[0]))
            visitor = self._visitor(submission.student, key)
            if visitor == submission.student:
                yield submission
            else:
                yield submission._replace(student=visitor)

    def intake(self, layout: str) -> Intake:
        """Return what was found.

        Of a student on the roster, it has only the LMS's name and ids: other names are anyone's.
        """
        students = self.people.students
        unclear = frozenset(students[index].key for index in self._unclear - self._owned.keys())
        submissions = []
        while self._owned:  # of a large class not all is kept twice
            index, submission = self._owned.popitem()
            claim = submission.student
            name = "" if claim.canvas else claim.name
            owner = claim._replace(key=students[index].key, name=name, login="")
            submissions.append(submission._replace(student=owner))
        submissions += self._submissions_of_visitors()
        submissions.sort(key=lambda submission: submission.student.key)
        unmatched = sorted(self._unmatched)
        ignored = first_lines(sorted(self.ignored), _MAX_LINES)
        return Intake(
            layout, submissions, unclear, tuple(unmatched), tuple(self.notes), tuple(ignored)
        )

    def _visitor(self, claim: Student, key: str) -> Student:
        """Return the student of a submission that nobody on the roster owns.

        The student may have chosen the name where Canvas has an id.
        """
        has_lms_id = bool(claim.canvas or claim.aliases)
        name = "" if has_lms_id else claim.name
        return claim._replace(key=key, name=name, aliases=(), is_on_roster=not self._has_roster)


def _is_listed(listing: ClassListing, path: str) -> bool:
    """Return whether a path is a file or a folder, and no symlink."""
    top, _, name = path.rpartition("/")
    children = listing.children(top)
    return name in children.folders or name in children.files


def _plain_path(path: str) -> str:
    return " ".join(printable_path(path).split())


def _csv_cell(text: str) -> str:
    """Return a text as a cell of a CSV file."""
    if set(text) & set(',;"'):
        return '"' + text.replace('"', '""') + '"'
    return text


def _path_key(path: str) -> str:
    """Return the key of a submission whose name cannot be one.

    `./` begins no name that a student can give a folder.
    """
    if path.isprintable():
        return f"./{path}"
    return f"./{printable_path(path)}-{sha256(os.fsencode(path)).hexdigest()}"
