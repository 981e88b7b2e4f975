"""Whose each submission of a class is: a student's by an id or a full name, a visitor's, or nobody's for certain."""

import os
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from hashlib import sha256
from typing import NamedTuple

from grader.classroom.grouping import ClassSubmission
from grader.classroom.layouts import PATTERNS
from grader.classroom.listing import ClassListing
from grader.classroom.people import CERTAIN, People
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
    submissions: tuple[ClassSubmission, ...]
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
        claims: dict[int, list[tuple[int, ClassSubmission]]] = defaultdict(list)
        groups: dict[tuple[int, ...], list[ClassSubmission]] = defaultdict(list)
        others: list[tuple[tuple[int, ...], ClassSubmission]] = []
        taken = self._assigned(found)
        for one in sorted(found, key=lambda one: (one.student.key, one.root, one.paths)) if self._has_roster else ():
            match = self.people.match(one.student)
            if one in taken:
                continue
            if match.is_group:
                groups[match.students].append(one)
            elif match.only is not None:
                claims[match.only].append((match.rank, one))
            else:
                others.append((match.students, one))
        self._visitors += () if self._has_roster else found
        for index, claimed in claims.items():
            self._decide(index, sorted(claimed, key=lambda claim: claim[0]))
        for members, named in groups.items():
            self._share(members, named)
        for students, one in others:
            keys = [self.people.students[index].key for index in students]
            self._visit(one, f"may belong to {enumerated(keys, _MAX_NAMED, 'or')}" if keys else "is not on the roster")
            self._unclear.update(students)

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

    def _visit(self, one: ClassSubmission, reason: str) -> None:
        self._visitors.append(one)
        self._list(one, reason)

    def _list(self, one: ClassSubmission, reason: str, student: str = "") -> None:
        """List a submission with what assigns it: a cell of the student's row, or a row of a visitor's own."""
        key, place = (_cell(text) for text in (printable_path(one.student.key), self._shown(one)))
        row = "" if student else f", or add the row `{key},{place}` below `id,submission`"
        advice = f"write {place} in the column `submission` of {student or 'its student'}{row}"
        self._unmatched.append(f"{self._shown(one)} {reason}; to assign it, {advice}")

    def _decide(self, index: int, claims: Sequence[tuple[int, ClassSubmission]]) -> None:
        """Give a student the submission with the only best id; if there is none, none of them is graded."""
        key = self.people.students[index].key
        (rank, first), *others = claims
        if index in self._owned or index in self._unclear:
            others = list(claims)
        elif not others or (rank <= CERTAIN and others[0][0] > rank):
            self._owned[index] = first
        else:
            self._reject([one for _, one in claims], f"may belong to {key}", [index], key)
            return
        for _, one in others:
            self._visit(one, f"may belong to {key}, who has another submission")

    def _reject(
        self, several: Sequence[ClassSubmission], reason: str, students: Iterable[int], student: str = ""
    ) -> None:
        names = enumerated([self._shown(one) for one in several], _MAX_NAMED)
        for one in several:
            self._list(one, f"{reason}, and of {names} none is graded", student)
        self._unclear.update(students)

    def _share(self, members: Iterable[int], named: Sequence[ClassSubmission]) -> None:
        """Let the only submission of a group count for each member without another; that of a section for nobody."""
        without = [index for index in members if index not in self._owned and index not in self._unclear]
        alone = [one for one in named if not self._holds_students(one)]
        for one in named:
            if one not in alone:
                self._visit(one, "is named like a group, but contains submissions of several students")
            elif not without:
                self._visit(one, "is named like a group whose members all have other submissions")
        if without and len(alone) > 1:
            self._reject(alone, "is named like a group", without)
        elif alone:
            self._owned |= dict.fromkeys(without, alone[0]._replace(student=Student("")))  # the ids are one member's

    def _holds_students(self, one: ClassSubmission) -> bool:
        """Return whether two students or more have submissions in a folder: it is a section, not a team's work."""
        inner = self.roots[one.root][0].children(one.paths[0], 1000)
        found = map(PATTERNS["folders"].fullmatch, [*(f"{name}/" for name in inner.folders), *inner.files])
        return sum(self.people.knows_student(name["login"]) for name in found if name) > 1

    def intake(self, layout: str) -> Intake:
        """Return what was found, with the data of the roster, and the LMS's name and ids where it has none."""
        students, found = self.people.students, list[ClassSubmission]()
        for index, one in self._owned.items():
            own, given = students[index], one.student
            name = own.name or ("" if given.canvas else given.name)
            own = own._replace(name=name, canvas=own.canvas or given.canvas, moodle=own.moodle or given.moodle)
            found.append(one._replace(student=own))
        counts = Counter(one.student.key for one in self._visitors)
        taken = {plain(one.key) for one in students}
        for one in self._visitors:
            key, is_chosen = one.student.key, bool(one.student.canvas or one.student.aliases)
            if counts[key] > 1 or not key.isprintable() or plain(key) in taken:
                key = _path_key(f"{self.roots[one.root][1]}/{one.paths[0]}" if len(self.roots) > 1 else one.paths[0])
            visitor = one.student._replace(
                key=key, name="" if is_chosen else one.student.name, aliases=(), is_on_roster=not self._has_roster
            )
            found.append(one if visitor == one.student else one._replace(student=visitor))
        return Intake(
            layout,
            tuple(sorted(found, key=lambda one: one.student.key)),
            frozenset(students[index].key for index in self._unclear - self._owned.keys()),
            tuple(self._unmatched),
            tuple(self.notes),
            tuple(first_lines(sorted(self.ignored), _MAX_LINES)),
        )


def _plain_path(path: str) -> str:
    return " ".join(printable_path(path).split())


def _cell(text: str) -> str:
    """Return a text as a cell of a CSV file."""
    return '"' + text.replace('"', '""') + '"' if set(text) & set(',;"') else text


def _path_key(path: str) -> str:
    """Return the key of a submission whose name cannot be one: `./` begins no name that a student can give a folder."""
    if path.isprintable():
        return f"./{path}"
    return f"./{printable_path(path)}-{sha256(os.fsencode(path)).hexdigest()}"
