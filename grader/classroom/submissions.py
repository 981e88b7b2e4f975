"""The submissions of a class, one a student: each belongs to whom an id or a full name says, or is listed."""

import os
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

from grader.classroom.layouts import (
    PATTERNS,
    ClassFolder,
    ClassSubmission,
    is_download,
    is_submission,
    layout_of,
    submissions_in,
)
from grader.classroom.listing import Children, ClassListing, FolderListing, ZipListing
from grader.classroom.people import CERTAIN, Match, People
from grader.classroom.roster import Roster, Student, plain
from grader.errors import InputError
from grader.files.names import PACKAGE_FILES, ROBOT_ENDINGS
from grader.files.opening import archive_kind
from grader.files.reading import not_there, read_start
from grader.submission.labs import MAX_WRAPPERS
from grader.submission.students import is_part
from grader.text import enumerated, first_lines, printable, printable_path, shell_quoted

__all__ = ["ClassSubmission", "Intake", "read_class"]
LAYOUTS = ("auto", "folders", "canvas", "moodle", "teams", "nbgrader")
_MAX_LINES = 200
_MAX_CHECKED = 20  # entries of a class folder
# Words in the names of folders with what a course hands out: Lab6 resources, Handout (old); no other may be in them.
_COURSE = frozenset(
    "resource resources handout handouts solution solutions template templates starter skeleton material materials"
    " example examples instructions reference references rubric rubrics grading demo slides".split()
)
_OTHER = frozenset(
    "lab labs course class code file files folder for of the and to from old new sample model student students project"
    " assignment exercise task week ws workspace".split()
)
_MAX_NAMED = 10
_ANONYMOUS = (
    "this is an anonymous download: its submissions (anon_...) match no student. "
    "Canvas shows the names when the grades are posted: download again then"
)


class Intake(NamedTuple):
    """The submissions of a class, and its students, both in the order of their keys.

    A student without a submission is `absent`; one with several possible submissions is not, and none of these is
    graded. `unmatched` says of which submissions it is not certain whose they are, and how the roster assigns them;
    `notes` says what was chosen, `ignored` what in the folders is no submission.
    """

    layout: str
    submissions: tuple[ClassSubmission, ...]
    absent: tuple[Student, ...]
    students: tuple[Student, ...]
    unmatched: tuple[str, ...]
    notes: tuple[str, ...]
    ignored: tuple[str, ...]


def read_class(
    paths: Sequence[Path],
    roster: Roster | None,
    layout: str = "auto",
    assignment: str = "",
    rubric_id: str = "",
    folders: tuple[str, ...] = (),
) -> Intake:
    """Return the submissions in class folders or zips, the sections of one class; raises InputError if there are none.

    `assignment` is the one to grade in nbgrader; `rubric_id` is the name of the lab in names of folders, and `folders`
    are the names of its own (default: its id).
    """
    if layout not in LAYOUTS:
        raise InputError(f"there is no layout {layout!r}; the layouts are: {', '.join(LAYOUTS)}")
    people = People(roster.students if roster is not None else ())
    notes, ignored, listings = list(roster.notes if roster is not None else ()), list[str](), list[ClassListing]()
    found: list[ClassSubmission] = []
    layouts: dict[str, None] = {}
    for root, path in enumerate(paths):
        listings.append(listing := listing_of(path))
        top = ClassFolder(
            listing, listing.children(""), "", path.resolve().name, rubric_id, folders or tuple(filter(None, [rubric_id])),
            assignment, people, layout != "auto", ignored, notes,
        )  # fmt: skip
        folder = inner_class(_without_gradebooks(top))
        own = _layout(path, folder, layout)
        submissions = submissions_in(folder, own)
        if not submissions:
            example = "".join(f": {line}" for line in sorted(ignored)[:1])
            advice = f" (without --layout {layout} the layout is detected)" if layout != "auto" else ""
            raise InputError(f"there is no submission in {printable_path(path)}{example}{advice}")
        layouts[own] = None
        found += (one._replace(root=root) for one in submissions)
    names = [path.resolve().name if len(paths) > 1 else "" for path in paths]
    assigned = _Assignment(people, listings, names, has_roster=roster is not None)
    assigned.assign(found)
    return Intake(
        " and ".join(layouts),
        *assigned.result(),
        (*notes, *assigned.notes),
        tuple(first_lines(sorted(ignored), _MAX_LINES)),
    )


def listing_of(path: Path) -> ClassListing:
    """Return the listing of a class folder or zip; raises InputError if it is neither."""
    shown = printable_path(path)
    try:
        if path.is_dir():
            return FolderListing(path)
        exists = os.path.lexists(path)
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read {shown}: {error}") from None
    if not exists:
        raise not_there(path)
    if archive_kind(read_start(path, 512)) != "zip":
        raise InputError(
            f"{shown} is neither a folder nor a zip: name the folder that holds the class's submissions"
            " (`grader grade` grades a single one)"
        )
    return ZipListing(path)


def _without_gradebooks(folder: ClassFolder) -> ClassFolder:
    """Return a folder without the gradebooks in it, which are no submissions."""
    books = [name for name in folder.children.folders if folder.listing.is_gradebook(name)]
    folder.ignore(books, "is a gradebook")
    kept = [name for name in folder.children.folders if name not in books] if books else folder.children.folders
    return replace(folder, children=folder.children._replace(folders=kept))


def inner_class(folder: ClassFolder) -> ClassFolder:
    """Return the folder that contains the submissions.

    A download may be in folders that contain nothing else. In a zip, it can be any folder that contains all files,
    unless it is itself a submission.
    """
    around, inner = [folder], _only_folder(folder)
    while inner is not None and len(around) <= MAX_WRAPPERS and not is_download(inner):
        around.append(inner)
        inner = _only_folder(inner)
    if inner is not None and is_download(inner):
        for outer in around:
            outer.ignore(outer.children.files, "is beside the folder of the download")
        return inner
    only = _only_folder(folder) if isinstance(folder.listing, ZipListing) and not folder.children.files else None
    return folder if only is None or _is_one_submission(only.children) else only


def _only_folder(folder: ClassFolder) -> ClassFolder | None:
    """Return the only folder in a folder without other submissions; None if there is none, or it is a student's."""
    folders, files, _ = folder.children
    if len(folders) != 1 or folders[0] == "submitted" or any(map(is_submission, files)):
        return None
    if layout_of(folder) != "folders" or folder.people.knows_student(folders[0]):
        return None
    start = f"{folder.start}{folders[0]}"
    return replace(folder, children=folder.listing.children(start), start=f"{start}/", name=folders[0])


def _is_one_submission(children: Children) -> bool:
    several = children.folders + list(filter(is_submission, children.files))
    is_package = not PACKAGE_FILES.isdisjoint(children.files) or any(map(is_part, children.folders))
    return (
        is_package
        or not several
        or several == [name for name in children.files if name.lower().endswith(ROBOT_ENDINGS)][:1]
    )


def _layout(path: Path, folder: ClassFolder, layout: str) -> str:
    """Return the layout of a class folder. Raises InputError if it does not fit the folder, or what the user named."""
    shown = printable_path(path)
    if not any(folder.children):
        raise InputError(f"{shown} is empty: name the folder that holds the class's submissions")
    chosen = layout_of(folder) if layout == "auto" else layout
    if folder.assignment and chosen != "nbgrader":
        raise InputError(
            f"--assignment is only for the layout nbgrader, and {shown} has the layout {chosen}: remove it, or add"
            " --layout nbgrader"
        )
    if layout == "auto" and chosen == "folders" and "package.xml" in folder.children.files:
        raise InputError(
            f"{shown} is one submission and not a class: it contains a package.xml "
            f"(grade it with `grader grade {shell_quoted(path)}`)"
        )
    if layout == "auto" and chosen == "folders":
        _refuse_downloads(path, folder)
    return chosen


def _refuse_downloads(path: Path, folder: ClassFolder) -> None:
    """Say which entries of a small class folder are downloads of a whole class; raises InputError if there are no others."""
    names = [
        name
        for name in [*folder.children.folders, *filter(is_submission, folder.children.files)]
        if not _is_of_course(name)
    ]
    found: dict[str, str] = {}
    for name in sorted(names) if len(names) <= _MAX_CHECKED and path.is_dir() else ():
        with suppress(InputError, OSError, ValueError):
            listing = listing_of(path / name)
            inner = inner_class(
                replace(folder, listing=listing, children=listing.children(""), start="", name=name, ignored=[])
            )
            if (
                is_download(inner)
                and not folder.people.knows(name)
                and len(submissions_in(inner, layout_of(inner))) > 1
            ):
                found[name] = (
                    f"{printable_path(path / name)} is a download of a whole class: grade it with `grader batch {shell_quoted(path / name)}`"
                )
    if found and len(found) == len(names):
        raise InputError(f"{next(iter(found.values()))}; if it is the submission of one student, add --layout folders")
    folder.notes.extend(f"{line}; here it is graded as the submission of one student" for line in found.values())


class _Assignment:
    """Whose each submission is: of students by their index on the roster, of others, or of nobody for certain."""

    def __init__(
        self, people: People, listings: Sequence[ClassListing], names: Sequence[str], *, has_roster: bool
    ) -> None:
        self._people, self._listings, self._names, self._has_roster = people, listings, names, has_roster
        self._owned: dict[int, ClassSubmission] = {}
        self._visitors: list[ClassSubmission] = []
        self._contested: set[int] = set()
        self._unmatched: list[str] = []
        self.notes: list[str] = []
        self.ignored: list[str] = []
        self._is_anonymous = False

    def assign(self, found: Sequence[ClassSubmission]) -> None:
        """Assign all submissions: what a person has assigned decides, then ids and names, then groups."""
        self._is_anonymous = all(one.student.key.startswith("anon_") for one in found)
        if self._is_anonymous:
            self.notes.append(_ANONYMOUS)
        claims: dict[int, list[tuple[int, ClassSubmission]]] = defaultdict(list)
        groups: dict[tuple[int, ...], list[ClassSubmission]] = defaultdict(list)
        others: list[tuple[tuple[int, ...], ClassSubmission]] = []
        taken = self._assign_by_hand(found)
        rest = (one for one in found if one not in taken)
        for one in sorted(rest, key=lambda one: (one.student.key, one.root, one.paths)):
            match = Match(()) if self._is_anonymous else self._people.match(one.student)
            if match.is_group:
                groups[match.students].append(one)
            elif len(match.students) == 1 and not one.student.aliases:
                claims[match.students[0]].append((match.rank, one))
            else:
                others.append((match.students, one))
        for index, claimed in claims.items():
            self._decide(index, sorted(claimed, key=lambda pair: pair[0]))
        for members, named in groups.items():
            self._share(members, named)
        for indices, one in others:
            keys = [self._people.students[index].key for index in indices]
            may = f"may belong to {enumerated(keys, _MAX_NAMED, 'or')}" if keys else "matches no student on the roster"
            self._visit(one, may)
            self._contested.update(indices)

    def _assign_by_hand(self, found: Sequence[ClassSubmission]) -> list[ClassSubmission]:
        """Give students what the roster's column `submission` names, and return these submissions."""
        wanted = {index: one.submission for index, one in enumerate(self._people.students) if one.submission}
        places: dict[str, ClassSubmission] = {}
        for one in found if wanted else ():
            places |= {self._shown(one.root, path): one for path in one.paths}
        taken: list[ClassSubmission] = []
        for index, text in wanted.items():
            place = " ".join(text.split())
            if named := places.get(place) or next(self._below(place), None):
                self._owned[index] = named
                taken.append(named)
            else:
                self._contested.add(index)
                key = self._people.students[index].key
                self.notes.append(
                    f"{key} has the submission {printable_path(place)} on the roster, which does not exist"
                )
        return taken

    def _below(self, place: str) -> Iterator[ClassSubmission]:
        """Yield what is at a place in the class folders that is no submission by itself."""
        for root, (listing, name) in enumerate(zip(self._listings, self._names, strict=True)):
            path = ""
            for part in place.removeprefix(f"{name}/" if name else "").split("/"):
                inner = listing.children(path)
                same = [one for one in inner.folders + inner.files if " ".join(printable_path(one).split()) == part]
                path = f"{path}/{same[0]}".lstrip("/") if len(same) == 1 else ""
                if not path:
                    break
            if path:
                yield ClassSubmission(Student(""), root, (path,))

    def _shown(self, root: int, path: str) -> str:
        """Return a path as a person can write it on the roster, of several class folders with the name of its own."""
        return " ".join(printable_path(f"{self._names[root]}/{path}".lstrip("/")).split())

    def _visit(self, one: ClassSubmission, reason: str) -> None:
        """Add a submission of nobody on the roster, unless it is the course's own."""
        if _is_of_course(one.paths[0]):
            place = self._shown(one.root, one.paths[0])
            if self._has_roster:
                self.ignored.append(f"{place} is of the course, not of a student")
                return
            self.notes.append(f"{place} may be a template of the course: graded like a student's")
        self._visitors.append(one)
        self._list(one, reason, one.student.key)

    def _list(self, one: ClassSubmission, reason: str, key: str) -> None:
        if self._has_roster and not self._is_anonymous:
            place = self._shown(one.root, one.paths[0])
            cell = '"' + place.replace('"', '""') + '"' if re.search('[,;"]', place) else place
            advice = f"the roster assigns it with `{printable(key)},{cell}` in the columns id,submission"
            self._unmatched.append(f"{place} {reason}: {advice}")

    def _decide(self, index: int, several: Sequence[tuple[int, ClassSubmission]]) -> None:
        """Give a student the submission with the only best id; if there is none, none of them is graded."""
        key = self._people.students[index].key
        (rank, first), *others = several
        is_assigned = index in self._owned or index in self._contested
        if not is_assigned and (not others or (rank <= CERTAIN and others[0][0] > rank)):
            self._owned[index] = first
        elif not is_assigned:
            self._contested.add(index)
            names = enumerated([self._shown(one.root, one.paths[0]) for _, one in several], _MAX_NAMED)
            for _, one in several:
                self._list(one, f"may belong to {key}, of {names} none is graded", key)
            return
        for _, one in several[0 if is_assigned else 1 :]:
            self._visit(one, f"may belong to {key}, who has another submission")

    def _share(self, members: Iterable[int], several: Sequence[ClassSubmission]) -> None:
        """Let the only submission of a group count for each member without another one; that of a section for nobody."""
        without = [index for index in members if index not in self._owned and index not in self._contested]
        alone = [one for one in several if not self._holds_students(one)]
        names = enumerated([self._shown(one.root, one.paths[0]) for one in alone], _MAX_NAMED)
        for one in several:
            if one not in alone:
                self._visit(one, "is named like a group, but contains submissions of several students")
            elif not without:
                self._visit(one, "is named like a group whose members all have other submissions")
            elif len(alone) > 1:
                self._list(one, f"is named like a group, of {names} none is graded", one.student.key)
                self._contested.update(without)
            else:
                self._owned |= dict.fromkeys(without, one)

    def _holds_students(self, one: ClassSubmission) -> bool:
        """Return whether two students or more have submissions in a folder: it is a section, not a team's work."""
        inner = self._listings[one.root].children(one.paths[0], 1000)
        names = [f"{name}/" for name in inner.folders] + inner.files
        found = filter(None, map(PATTERNS["folders"].fullmatch, names))
        return sum(self._people.knows_student(name["login"]) for name in found) > 1

    def result(self) -> tuple[tuple[ClassSubmission, ...], tuple[Student, ...], tuple[Student, ...], tuple[str, ...]]:
        """Return the submissions, the absent students, all students, and what is unmatched."""
        students = list(self._people.students)
        submissions: list[ClassSubmission] = []
        for index, one in self._owned.items():
            own, given = students[index], one.student
            students[index] = own = own._replace(
                name=own.name or ("" if given.canvas else given.name),
                canvas=own.canvas or given.canvas,
                moodle=own.moodle or given.moodle,
            )
            is_late = one.is_late if own.is_late is None else own.is_late
            submissions.append(one._replace(student=own, is_late=is_late, submitted=own.submitted or one.submitted))
        absent = [
            one for index, one in enumerate(students) if index not in self._owned and index not in self._contested
        ]
        taken = {plain(one.key) for one in students}
        counts = Counter(one.student.key for one in self._visitors)
        for one in self._visitors:
            key = one.student.key
            if counts[key] > 1 or not key.isprintable() or plain(key) in taken:
                key = _path_key(f"{self._names[one.root]}/{one.paths[0]}".lstrip("/"))
            name = "" if one.student.canvas else one.student.name
            submissions.append(
                one._replace(student=one.student._replace(key=key, name=name, is_on_roster=not self._has_roster))
            )
        students += [one.student for one in submissions[len(self._owned) :]]
        submissions.sort(key=lambda one: one.student.key)
        students.sort(key=lambda one: one.key)
        return tuple(submissions), () if self._is_anonymous else tuple(absent), tuple(students), tuple(self._unmatched)


def _is_of_course(path: str) -> bool:
    """Return whether a name has a word of the course's own folders, and no word that could be a student's."""
    words = {*re.findall(r"[^\W\d_]+", path.rpartition("/")[2].partition(".")[0].casefold())}
    return bool(words & _COURSE) and words <= _COURSE | _OTHER


def _path_key(path: str) -> str:
    """Return the key of a submission whose name cannot be one: `./` begins no name that a student can give a folder."""
    if path.isprintable():
        return f"./{path}"
    return f"./{printable_path(path)}-{sha256(os.fsencode(path)).hexdigest()}"
