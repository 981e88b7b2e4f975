"""Who is in the class, and who of them has handed something in: by what is surely theirs, never by a guess."""

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import NamedTuple

from grader.classroom.matching import OF_FOLDERS, OF_TEAM_FOLDERS, Clue, People, claims_of, clues_of, plain_group
from grader.classroom.students import ClassSubmission, Student


@dataclass(frozen=True, slots=True)
class RosterEntry:
    """One row of a roster. `due` and `submitted` are ISO 8601; what the roster does not say is empty or None.

    `section` is the group or team that hands in together, or else the section: nobody tells the two apart but by a hand-in.
    `aliases` are further names that are as good as a login, such as one at GitHub beside one at the university.
    """

    student: Student
    section: str = ""
    due: str = ""
    extension_days: float = 0.0
    submitted: str = ""
    is_late: bool | None = None
    days_late: float | None = None
    aliases: tuple[str, ...] = ()


class RosterMatch(NamedTuple):
    """Whose submission it is: the position in the entries, or None. `clue` says how it was found.

    `doubt` says in words why nobody was taken although somebody might be meant, and `several` has the positions of those who might be.
    """

    place: int | None
    clue: Clue = Clue.SURNAME
    doubt: str = ""
    several: tuple[int, ...] = ()


class Roster:
    """The students of a class, in the order of the file; `notes` says what in it was not understood.

    `assignments` has Canvas' ids of the assignments that the file has columns for.
    """

    def __init__(
        self, entries: Iterable[RosterEntry], notes: tuple[str, ...] = (), assignments: Iterable[str] = ()
    ) -> None:
        self.entries = tuple(entries)
        self.notes = notes
        self.assignments = frozenset(assignments)
        self._by_key = {entry.student.key: index for index, entry in enumerate(self.entries)}
        self._people = People(clues_of(entry.student, entry.aliases) for entry in self.entries)
        self._groups: dict[str, list[int]] = {}
        for index, entry in enumerate(self.entries):
            if group := plain_group(entry.section):
                self._groups.setdefault(group, []).append(index)

    def with_lms_numbers(self, students: Iterable[Student]) -> "Roster":
        """The roster with the numbers by which an LMS knows these students, by key, where it does not say them itself."""
        known = {each.key: each for each in students if each.canvas or each.moodle}
        return Roster(
            (_knowing(each, known.get(each.student.key)) for each in self.entries), self.notes, self.assignments
        )

    @property
    def students(self) -> tuple[Student, ...]:
        """The students, in the order of the file."""
        return tuple(entry.student for entry in self.entries)

    def entry(self, key: str) -> RosterEntry | None:
        """The row of the student with this key."""
        index = self._by_key.get(key)
        return None if index is None else self.entries[index]

    def knows(self, name: str) -> bool:
        """Whether a name is that of one student in the roster."""
        return self.match(Student(name)).place is not None

    def knows_surname(self, name: str) -> bool:
        """Whether a name is that of one student in the roster, or the surname of one."""
        return self._people.find(claims_of(Student(name)), OF_TEAM_FOLDERS).only is not None

    def knows_submission(self, name: str) -> bool:
        """Whether a name is that of one student in the roster, or of a group."""
        return self.knows(name) or bool(self.members(Student(name)))

    def members(self, team: Student) -> Sequence[int]:
        """The positions of those whose group is named like a submission, by its key or its name.

        What lies in a team's folder is named by the team: it counts for no group.
        """
        if team.team:
            return ()
        return self._groups.get(plain_group(team.key)) or self._groups.get(plain_group(team.name)) or ()

    def candidates(self, student: Student) -> tuple[int, ...]:
        """The positions of everybody whom the number or name of a submission may mean."""
        return self._people.find(claims_of(student)).people

    def match(self, student: Student) -> RosterMatch:
        """Whose a submission is, given what its name says.

        What lies in a team's folder can only be of a student whose group is that team: anybody in the team may have named it.
        """
        claims = claims_of(student)
        group = self._groups.get(plain_group(student.team), ()) if student.team else None
        found = self._people.find(claims, OF_TEAM_FOLDERS if student.team else OF_FOLDERS, group)
        if found.only is not None:
            return RosterMatch(found.only, found.clue)
        if found.people:
            return RosterMatch(None, found.clue, doubt="may be of several in the roster", several=found.people)
        if found.contradicted:
            other = self.entries[found.contradicted[0]].student
            return RosterMatch(None, found.clue, doubt=f"has the name of {other.key}, but another number")
        elsewhere = self._people.find(claims, OF_TEAM_FOLDERS).people if student.team else ()
        if elsewhere:
            entry = self.entries[elsewhere[0]]
            group_words = (
                f"whose group is {entry.section!r}"
                if entry.section
                else "who has no group in the roster (its column group names the team folders)"
            )
            return RosterMatch(None, found.clue, doubt=f"is named like {entry.student.key}, {group_words}")
        return RosterMatch(None)

    def complete(self, index: int, hand_in: ClassSubmission) -> ClassSubmission:
        """The submission of a student in the roster, with the name and numbers that an LMS gives. Times in the roster count first."""
        entry, said = self.entries[index], hand_in.student
        own = entry.student
        return replace(
            hand_in,
            student=replace(
                own,
                name=own.name or said.name,
                canvas=own.canvas or said.canvas,
                moodle=own.moodle or said.moodle,
            ),
            is_late=hand_in.is_late if entry.is_late is None else entry.is_late,
            submitted=entry.submitted or hand_in.submitted,
        )


def _knowing(entry: RosterEntry, known: Student | None) -> RosterEntry:
    if known is None:
        return entry
    own = entry.student
    numbered = replace(own, canvas=own.canvas or known.canvas, moodle=own.moodle or known.moodle)
    return replace(entry, student=numbered)


def entry_to_json(entry: RosterEntry) -> str:
    """A row of a roster as a gradebook keeps it."""
    return json.dumps(asdict(entry), sort_keys=True)


def roster_from_json(entries: Iterable[str]) -> Roster | None:
    """The roster that a gradebook has kept; None where there is none."""
    rows = [entry_from_json(each) for each in entries]
    return Roster(rows) if rows else None


def entry_from_json(text: str) -> RosterEntry:
    """A row of a roster that a gradebook has kept."""
    row = json.loads(text)
    student = {**row["student"], "maybe_canvas": ()}
    return RosterEntry(**{**row, "student": Student(**student), "aliases": tuple(row["aliases"])})
