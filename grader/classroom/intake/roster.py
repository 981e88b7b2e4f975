"""The roster of a class, and which of its students a submission belongs to: only certain or unambiguous matches."""

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import NamedTuple

from grader.classroom.matching import OF_FOLDERS, OF_TEAM_FOLDERS, Clue, Clues, People, claims_of, clues_of, plain_group
from grader.classroom.students import ClassSubmission, Student

_MAX_WAYS = 4


@dataclass(frozen=True, slots=True)
class RosterEntry:
    """One row of a roster. `due` and `submitted` are ISO 8601; what the roster does not say is empty or None.

    Without a `group`, the `section` may be a team that submits together: only a submission shows which of the two it
    is. `marker` is the person who grades the student manually. `aliases` are additional logins, such as the one at
    GitHub. Gradebooks store entries as JSON with these field names.
    """

    student: Student
    section: str = ""
    due: str = ""
    extension_days: float = 0.0
    submitted: str = ""
    is_late: bool | None = None
    days_late: float | None = None
    aliases: tuple[str, ...] = ()
    group: str = ""
    marker: str = ""

    @property
    def team(self) -> str:
        """The group, else the section, which may be a team."""
        return self.group or self.section


class RosterMatch(NamedTuple):
    """The student of a submission: the position in the entries, or None. `clue` says how the match was found.

    `doubt` says why an ambiguous submission is left unassigned; `several` are the positions of the students that it may
    belong to.
    """

    position: int | None
    clue: Clue = Clue.SURNAME
    doubt: str = ""
    several: tuple[int, ...] = ()


class Roster:
    """The students of a class, in the order of the file; `notes` says which cells were not understood.

    `assignments` has Canvas' ids of the assignments that the file has columns for, `groups` the positions of the
    students in each group, by its normalised name.
    """

    def __init__(
        self, entries: Iterable[RosterEntry], notes: tuple[str, ...] = (), assignments: Iterable[str] = ()
    ) -> None:
        self.entries = tuple(entries)
        self.notes = notes
        self.assignments = frozenset(assignments)
        self._by_key = {entry.student.key: entry for entry in self.entries}
        self._people = People(clues_of(entry.student, entry.aliases) for entry in self.entries)
        self.groups: dict[str, list[int]] = {}
        for index, entry in enumerate(self.entries):
            if group := plain_group(entry.team):
                self.groups.setdefault(group, []).append(index)

    def with_lms_numbers(self, students: Iterable[Student]) -> "Roster":
        """Return the roster with the LMS ids of these students, by key, where it has none itself."""
        known = {student.key: student for student in students}
        entries = (
            replace(entry, student=_with_numbers(entry.student, known.get(entry.student.key, entry.student)))
            for entry in self.entries
        )
        return Roster(entries, self.notes, self.assignments)

    @property
    def clues(self) -> Sequence[Clues]:
        """The clues of each student, in the order of the entries."""
        return self._people.clues

    @property
    def students(self) -> tuple[Student, ...]:
        """The students, in the order of the file."""
        return tuple(entry.student for entry in self.entries)

    def entry(self, key: str) -> RosterEntry | None:
        """Return the row of the student with this key."""
        return self._by_key.get(key)

    def knows(self, name: str) -> bool:
        """Return whether a name is that of one student on the roster."""
        return self.match(Student(name)).position is not None

    def knows_surname(self, name: str) -> bool:
        """Return whether a name is that of one student on the roster, or the surname of one."""
        return self._people.find(claims_of(Student(name)), OF_TEAM_FOLDERS).only is not None

    def knows_submission(self, name: str) -> bool:
        """Return whether a name is that of one student on the roster, or of a group."""
        return self.knows(name) or bool(self.members(Student(name)))

    def members(self, team: Student) -> Sequence[int]:
        """Return the indices of the students whose group is named like a submission, by its key or name.

        A submission in a team's folder was named by the team, and counts for no group.
        """
        if team.team:
            return ()
        return self.groups.get(plain_group(team.key)) or self.groups.get(plain_group(team.name)) or ()

    def candidates(self, student: Student) -> tuple[int, ...]:
        """Return the indices of all students that the id or name of a submission may mean."""
        return self._people.find(claims_of(student)).people

    def match(self, student: Student) -> RosterMatch:
        """Return the student of a submission, given the student that its name identifies.

        A submission in a team's folder can only be of a student in that group: anybody in the team may have named it.
        """
        claims = claims_of(student)
        if student.readings and not student.canvas:
            ways = " or ".join(f"of {name} with the id {number}" for name, number in student.readings[:_MAX_WAYS])
            return RosterMatch(None, doubt=f"may be {ways}", several=self._people.find(claims, (Clue.CANVAS,)).people)
        group = self.groups.get(plain_group(student.team), ()) if student.team else None
        found = self._people.find(claims, OF_TEAM_FOLDERS if student.team else OF_FOLDERS, group)
        if found.only is not None:
            return RosterMatch(found.only, found.clue)
        if found.people:
            doubt = "is ambiguous: it matches several students on the roster"
            return RosterMatch(None, found.clue, doubt, found.people)
        if found.contradicted:
            other = self.entries[found.contradicted[0]].student
            return RosterMatch(None, found.clue, f"has the name of {other.key}, but another number")
        elsewhere = self._people.find(claims, OF_TEAM_FOLDERS).people if student.team else ()
        if elsewhere:
            entry = self.entries[elsewhere[0]]
            no_group = "who has no group on the roster (its column group names the team folders)"
            group_words = f"whose group is {entry.team!r}" if entry.team else no_group
            return RosterMatch(None, found.clue, f"is named like {entry.student.key}, {group_words}")
        return RosterMatch(None)

    def complete(self, index: int, submission: ClassSubmission) -> ClassSubmission:
        """Return a student's submission with the data of the roster, and the LMS's name and ids where it has none."""
        entry = self.entries[index]
        student = _with_numbers(entry.student, submission.student)
        return replace(
            submission,
            student=replace(student, name=student.name or submission.student.name),
            is_late=submission.is_late if entry.is_late is None else entry.is_late,
            submitted=entry.submitted or submission.submitted,
        )


def _with_numbers(student: Student, other: Student) -> Student:
    return replace(student, canvas=student.canvas or other.canvas, moodle=student.moodle or other.moodle)


def entry_to_json(entry: RosterEntry) -> str:
    """Return a row of a roster as a gradebook stores it."""
    return json.dumps(asdict(entry), sort_keys=True)


def roster_from_json(entries: Iterable[str]) -> Roster | None:
    """Return the roster that a gradebook has stored; None if there is none."""
    rows = list(map(entry_from_json, entries))
    return Roster(rows) if rows else None


def entry_from_json(text: str) -> RosterEntry:
    """Return a row of a roster that a gradebook has stored."""
    row = json.loads(text)
    student = Student(**{**row["student"], "readings": ()})  # only the file of a submission has any
    return RosterEntry(**{**row, "student": student, "aliases": tuple(row["aliases"])})
