"""Whose each submission of a class is: a student's by an id or a full name, a visitor's, or nobody's for certain."""

import os
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from hashlib import sha256
from itertools import pairwise
from typing import NamedTuple

from grader.classroom.grouping import ClassSubmission
from grader.classroom.layouts import PATTERNS
from grader.classroom.listing import ClassListing
from grader.classroom.people import CERTAIN, GROUP, People
from grader.classroom.roster import Student, plain
from grader.text import enumerated, first_lines, printable_path

_MAX_LINES, _MAX_NAMED = 200, 10
_ANONYMOUS = (
    "this is an anonymous download: its submissions (anon_...) match no student. "
    "Canvas shows the names when the grades are posted: download again then"
)


class Intake(NamedTuple):
    """The submissions of a class in the order of their keys, and lines for the user.

    `unclear` are the keys of students with possible submissions of which none counts. `unmatched` says which
    submissions are certainly nobody's on the roster, and which row of it assigns them; `notes` says what was chosen,
    `ignored` what in the folders is no submission.
    """

    layout: str
    submissions: list[ClassSubmission]
    unclear: frozenset[str]
    unmatched: tuple[str, ...]
    notes: tuple[str, ...]
    ignored: tuple[str, ...]


class Owners:
    """Whose each submission is: a student's, by the index on the roster, a visitor's, or nobody's for certain."""

    def __init__(self, people: People, roots: Sequence[tuple[ClassListing, str]], *, has_roster: bool) -> None:
        self.people, self.roots, self._has_roster = people, roots, has_roster
        self.notes: list[str] = []
        self.ignored: list[str] = []
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
        claims: dict[int, list[tuple[int, ClassSubmission]]] = defaultdict(list)
        others: list[tuple[tuple[int, ...], ClassSubmission]] = []
        for one in sorted(set(found) - self._assigned(found), key=lambda one: (one.student.key, one.root, one.paths)):
            match = self.people.match(one.student)
            if match.rank == GROUP and self._holds_students(one):
                self._visit(one, "is named like a group, but contains submissions of several students")
            elif match.is_certain:
                for index in match.students:
                    claims[index].append((match.rank, one))
            else:
                others.append((match.students, one))
        self._decide(claims)
        for students, one in others:  # after the others: they make no other submission unclear
            self._visit(one, f"may belong to {self._keys(students)}" if students else "is not on the roster")
            self._unclear.update(students)

    def _decide(self, claims: Mapping[int, Sequence[tuple[int, ClassSubmission]]]) -> None:
        """Give each student the submission with the only best id; of several that are equally good, none is graded."""
        shared: set[ClassSubmission] = set()
        contested: dict[ClassSubmission, tuple[Sequence[ClassSubmission], list[int]]] = {}
        lost: dict[ClassSubmission, list[int]] = defaultdict(list)
        for index, claimed in claims.items():
            best = min(rank for rank, _ in claimed)
            first = [one for rank, one in claimed if rank == best]
            own = [one for rank, one in claimed if rank < GROUP] or first
            if index in self._owned or index in self._unclear:
                own = []
            elif len(first) == 1 and (best <= CERTAIN or len(own) == 1):
                own, self._owned[index] = first, first[0]
                if best == GROUP:  # the ids in its name are those of one member
                    shared.add(first[0])
                    self._owned[index] = first[0]._replace(student=Student(""))
            else:
                self._unclear.add(index)
                for one in own:
                    contested.setdefault(one, (own, []))[1].append(index)
            for _, one in claimed:
                if one not in own:
                    lost[one].append(index)
        for one, (several, members) in contested.items():
            names = enumerated([self._shown(other) for other in several], _MAX_NAMED)
            reason = f"may belong to {self._keys(members)}, and of {names} none is graded"
            self._list(one, reason, self._keys(members, "and"))
        for one in lost.keys() - contested.keys() - shared:
            self._visit(one, f"may belong to {self._keys(lost[one])}, who has another submission")

    def _visit(self, one: ClassSubmission, reason: str) -> None:
        self._visitors.append(one)
        self._list(one, reason)

    def _keys(self, students: Iterable[int], word: str = "or") -> str:
        return enumerated([self.people.students[index].key for index in students], _MAX_NAMED, word)

    def _assigned(self, found: Iterable[ClassSubmission]) -> set[ClassSubmission]:
        """Give students what the roster's column `submission` names, and return these submissions."""
        wanted = [(index, one) for index, one in enumerate(self.people.students) if one.submission]
        places: dict[str, list[ClassSubmission]] = defaultdict(list)
        for one in found if wanted else ():
            for place in {text for path in one.paths for text in (self._shown(one, path), _plain_path(path))}:
                places[place].append(one)
        for index, student in wanted:
            place = _plain_path(student.submission)
            named = places.get(place) or list(self._at(place))
            if len(named) == 1:
                self._owned[index] = named[0]
            else:
                self._unclear.add(index)
                why = "is in several class folders: begin it with the name of one" if named else "does not exist"
                self.notes.append(f"{student.key} has the submission {place!r} on the roster, which {why}")
        return set(self._owned.values())

    def _at(self, place: str) -> Iterator[ClassSubmission]:
        """Yield what is at a place in the class folders, and no submission by itself."""
        for root, (listing, name) in enumerate(self.roots):
            path = ""
            for part in place.removeprefix(f"{_plain_path(name)}/" if len(self.roots) > 1 else "").split("/"):
                inner = listing.children(path)
                same = [one for one in inner.folders + inner.files if _plain_path(one) == part]
                path = f"{path}/{same[0]}".lstrip("/") if len(same) == 1 else "\0"
            if "\0" not in path:
                yield ClassSubmission(Student(""), root, (path,))

    def _shown(self, one: ClassSubmission, path: str = "") -> str:
        """Return a path as a person can write it on the roster, of several class folders with the name of its own."""
        top = f"{self.roots[one.root][1]}/" if len(self.roots) > 1 else ""
        return _plain_path(top + (path or one.paths[0]))

    def _list(self, one: ClassSubmission, reason: str, student: str = "") -> None:
        """List a submission with what assigns it: a cell of the student's row, or a row of a visitor's own."""
        key, place = (_cell(text) for text in (printable_path(one.student.key), self._shown(one)))
        row = "" if student else f", or add the row `{key},{place}` below `id,submission`"
        advice = f"write {place} in the column `submission` of {student or 'its student'}{row}"
        self._unmatched.append(f"{self._shown(one)} {reason}; to assign it, {advice}")

    def _holds_students(self, one: ClassSubmission) -> bool:
        """Return whether two students or more have submissions in a folder: it is a section, not a team's work."""
        inner = self.roots[one.root][0].children(one.paths[0], 1000)
        found = map(PATTERNS["folders"].fullmatch, [*(f"{name}/" for name in inner.folders), *inner.files])
        return sum(self.people.knows_student(name["login"]) for name in found if name) > 1

    def intake(self, layout: str) -> Intake:
        """Return what was found, with the data of the roster, and the LMS's name and ids where it has none."""
        students, found = self.people.students, list[ClassSubmission]()
        unclear = frozenset(students[index].key for index in self._unclear - self._owned.keys())
        while self._owned:  # of a large class not all is kept twice
            index, one = self._owned.popitem()
            own, given = students[index], one.student
            name = own.name or ("" if given.canvas else given.name)
            more = own._replace(name=name, canvas=own.canvas or given.canvas, moodle=own.moodle or given.moodle)
            found.append(one._replace(student=own if more == own else more))
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
