"""Match the submissions of a class with students: by the roster's column `submission`, ids, names and groups."""

import os
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from hashlib import sha256
from itertools import pairwise
from typing import NamedTuple

from grader.classroom.grouping import ClassSubmission
from grader.classroom.layouts import names_in
from grader.classroom.listing import ClassListing
from grader.classroom.people import GROUP, People
from grader.classroom.roster import Roster, Student, plain
from grader.files.tree import parents
from grader.text import enumerated, first_lines, printable_path

_MAX_LINES, _MAX_NAMED = 200, 10
_ANONYMOUS = (
    "this is an anonymous download: its submissions (anon_...) match no student. "
    "Canvas shows the names when the grades are posted: download again then"
)


class Intake(NamedTuple):
    """The submissions of a class in the order of their keys, and lines for the user.

    `unclear` are the keys of students with possible submissions of which none counts. `unmatched` says which
    submissions match no student for certain, and which row of the roster assigns them; `notes` says what was chosen,
    `ignored` what in the folders is no submission.
    """

    layout: str
    submissions: list[ClassSubmission]
    unclear: frozenset[str]
    unmatched: tuple[str, ...]
    notes: tuple[str, ...]
    ignored: tuple[str, ...]


class Owners:
    """The submission of each student, by the index on the roster; those that match none; those that are ambiguous."""

    def __init__(self, roster: Roster | None, roots: Sequence[tuple[ClassListing, str]]) -> None:
        self.people, self.roots = People(roster.students if roster is not None else ()), roots
        self.notes = [*roster.notes] if roster is not None else []
        self.ignored: list[str] = []
        self._has_roster = roster is not None
        self._owned: dict[int, ClassSubmission] = {}
        self._unclear: set[int] = set()
        self._visitors: list[ClassSubmission] = []
        self._unmatched: list[str] = []

    def find(self, found: Sequence[ClassSubmission]) -> None:
        """Assign all submissions: what a person has assigned decides, then ids and names, then groups."""
        if all(one.student.key.startswith("anon_") for one in found):
            self.notes.append(_ANONYMOUS)
            self._unclear.update(range(len(self.people.students)))
        if not self._has_roster:
            self._visitors = [*found]
            return
        self._assign(found)
        claims: dict[int, dict[ClassSubmission, int]] = defaultdict(dict)
        possible: dict[ClassSubmission, tuple[int, ...]] = {}
        for one in sorted(
            set(found).difference(self._owned.values()), key=lambda one: (one.student.key, one.root, one.paths)
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
        """Give each student the submission with the only best claim; return those given, and those equally good."""
        given, contested = set[ClassSubmission](), set[ClassSubmission]()
        for index, claimed in claims.items():
            best = min(claimed.values())
            first = [one for one, by in claimed.items() if by == best]
            if self.people.students[index].submission:
                continue
            if len(first) == 1:  # of a group's, the ids in its name are those of one member
                self._owned[index] = first[0]._replace(student=Student("")) if best == GROUP else first[0]
                given.add(first[0])
            else:
                self._unclear.add(index)
                contested.update(first)
        return given, contested - given

    def _holds_students(self, one: ClassSubmission) -> bool:
        """Return whether two students or more have submissions in a folder: it is a section, not a team's work."""
        inner = self.roots[one.root][0].children(one.paths[0], 1000)
        return sum(self.people.knows(found["login"]) for found in names_in(inner).values()) > 1

    def _assign(self, found: Iterable[ClassSubmission]) -> None:
        """Give students what the roster's column `submission` names."""
        wanted = {index: one for index, one in enumerate(self.people.students) if one.submission}
        places: dict[str, set[ClassSubmission]] = defaultdict(set)
        for one in found if wanted else ():
            for path in one.paths:
                places[self._shown(one, path)].add(one)
        for index, student in wanted.items():
            place = _plain_path(student.submission)
            named = [*(places.get(place) or self._at(place))]
            if len(named) == 1:
                self._owned[index] = named[0]
            else:
                self._unclear.add(index)
                self.notes.append(f"{student.key} has the submission {place!r} on the roster, which does not exist")

    def _at(self, place: str) -> Iterator[ClassSubmission]:
        """Yield what is at a place in the class folders, and no submission by itself."""
        for root, (listing, name) in enumerate(self.roots):
            path = place.removeprefix(f"{name}/") if len(self.roots) > 1 else place
            inner = (
                (listing.children(one.rpartition("/")[0]), one.rpartition("/")[2]) for one in (path, *parents(path))
            )
            is_here = len(self.roots) == 1 or path != place
            if is_here and all(part in children.folders + children.files for children, part in inner):  # no symlink
                yield ClassSubmission(Student(""), root, (path,))

    def _shown(self, one: ClassSubmission, path: str = "") -> str:
        """Return a path as a person can write it on the roster, of several class folders with the name of its own."""
        top = f"{self.roots[one.root][1]}/" if len(self.roots) > 1 else ""
        return _plain_path(top + (path or one.paths[0]))

    def _list(self, one: ClassSubmission, students: Sequence[int], *, is_contested: bool) -> None:
        """List a submission without an owner, and what assigns it; a contested one is not graded."""
        if not is_contested:
            self._visitors.append(one)
        keys = enumerated([self.people.students[index].key for index in students], _MAX_NAMED, "or")
        reason = f"may belong to {keys}" if students else "is not on the roster"
        reason += ", and so may another submission: none is graded" if is_contested else ""
        key, place = (_cell(text) for text in (printable_path(one.student.key), self._shown(one)))
        row = "" if is_contested else f", or add the row `{key},{place}` below `id,submission`"
        advice = f"write {place} in the column `submission` of its student{row}"
        self._unmatched.append(f"{self._shown(one)} {reason}; to assign it, {advice}")

    def intake(self, layout: str) -> Intake:
        """Return what was found, of a student on the roster only the LMS's name and ids: other names are anyone's."""
        students, found = self.people.students, list[ClassSubmission]()
        unclear = frozenset(students[index].key for index in self._unclear - self._owned.keys())
        while self._owned:  # of a large class not all is kept twice
            index, one = self._owned.popitem()
            name = "" if one.student.canvas else one.student.name
            own = one.student._replace(key=students[index].key, name=name, login="")
            found.append(one._replace(student=own))
        twice = {one for one, other in pairwise(sorted(one.student.key for one in self._visitors)) if one == other}
        taken = {plain(one.key) for one in students}
        for one in self._visitors:
            key, is_chosen = one.student.key, bool(one.student.canvas or one.student.aliases)
            if key in twice or not key.isprintable() or plain(key) in taken:
                key = _path_key(f"{self.roots[one.root][1]}/{one.paths[0]}" if len(self.roots) > 1 else one.paths[0])
            name = "" if is_chosen else one.student.name
            visitor = one.student._replace(key=key, name=name, aliases=(), is_on_roster=not self._has_roster)
            found.append(one if visitor == one.student else one._replace(student=visitor))
        found.sort(key=lambda one: one.student.key)
        ignored = first_lines(sorted(self.ignored), _MAX_LINES)
        return Intake(layout, found, unclear, tuple(sorted(self._unmatched)), tuple(self.notes), tuple(ignored))


def _plain_path(path: str) -> str:
    return " ".join(printable_path(path).split())


def _cell(text: str) -> str:
    """Return a text as a cell of a CSV file."""
    return '"' + text.replace('"', '""') + '"' if set(text) & set(',;"') else text


def _path_key(path: str) -> str:
    """Return the key of a submission whose name cannot be one: `./` begins no name that a student can give a folder."""
    return f"./{path}" if path.isprintable() else f"./{printable_path(path)}-{sha256(os.fsencode(path)).hexdigest()}"
