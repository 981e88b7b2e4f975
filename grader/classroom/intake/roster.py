"""Who is in the class, and who of them has handed something in: by what is surely theirs, never by a guess."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from grader.classroom.intake.names import canvas_name, canvas_names, plain_group, plain_name, plain_word, surname
from grader.classroom.students import HandIn, Student
from grader.submission.files import printable_path

_SEVERAL = -1


@dataclass(frozen=True, slots=True)
class Entry:
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


class Match(NamedTuple):
    """Who a hand-in is of: the place in the entries, or None. `step` says how it was found, the surest being 0.

    `doubt` says in words why nobody was taken although somebody might be meant.
    """

    place: int | None
    step: int = 0
    doubt: str = ""


class Roster:
    """The students of a class, in the order of the file; `notes` says what in it was not understood."""

    def __init__(self, entries: Iterable[Entry], notes: tuple[str, ...] = ()) -> None:
        self.entries = tuple(entries)
        self.notes = notes
        self._by_key = {entry.student.key: index for index, entry in enumerate(self.entries)}
        # From the surest to the least sure: numbers of LMSs, own names, local parts of addresses, forms of full names.
        self._canvas: dict[str, int] = {}
        self._moodle: dict[str, int] = {}
        self._words: dict[str, int] = {}
        self._local_parts: dict[str, int] = {}
        self._canvas_names: dict[str, int] = {}
        self._names: dict[str, int] = {}
        self._surnames: dict[str, int] = {}
        self._groups: dict[str, list[int]] = {}
        for index, entry in enumerate(self.entries):
            self._enter(index, entry)

    @property
    def students(self) -> tuple[Student, ...]:
        """The students, in the order of the file."""
        return tuple(entry.student for entry in self.entries)

    def entry(self, key: str) -> Entry | None:
        """The row of the student with this key."""
        index = self._by_key.get(key)
        return None if index is None else self.entries[index]

    def find(self, name: str = "", *, canvas: str = "", moodle: str = "") -> Student | None:
        """The one student whom a number, key, login, address or full name belongs to; None where it is nobody's, or several'."""
        index = self.match(Student(name, name, canvas=canvas, moodle=moodle)).place
        return None if index is None else self.entries[index].student

    def knows(self, name: str) -> bool:
        """Whether a name is that of somebody in the roster."""
        return self.match(Student(name)).place is not None

    def knows_surname(self, name: str) -> bool:
        """Whether a name is that of somebody in the roster, or the surname of just one of them."""
        return self.match(Student(name), surnames=True).place is not None

    def knows_hand_in(self, name: str) -> bool:
        """Whether a name is that of somebody in the roster, or of a group."""
        return self.knows(name) or bool(self.members(Student(name)))

    def members(self, team: Student) -> Sequence[int]:
        """The places of those whose group is called exactly like a hand-in, by its key or its name; none where there is no such group."""
        return self._groups.get(plain_group(team.key)) or self._groups.get(plain_group(team.name)) or ()

    def match(self, student: Student, *, surnames: bool = False) -> Match:
        """Whom a hand-in belongs to, given what its name says of them.

        The first step at which anything is found decides. Where two students share what is found there, or where it
        belongs to one whose number in the LMS is another, nobody is taken.
        """
        for step, index in enumerate(self._found(student, surnames=surnames)):
            if index is None:
                continue
            if index == _SEVERAL:
                return Match(None, step, "could be of several in the roster")
            other = self.entries[index].student
            if _differ(student.canvas, other.canvas) or _differ(student.moodle, other.moodle):
                return Match(None, step, f"has the name of {other.key}, but another number")
            return Match(index, step)
        return Match(None)

    def complete(self, index: int, hand_in: HandIn) -> HandIn:
        """A hand-in of one in the roster: with all that both say. Where the roster speaks of time, its word counts."""
        entry, said = self.entries[index], hand_in.student
        own = entry.student
        return replace(
            hand_in,
            student=replace(
                own,
                name=own.name or said.name,
                login=own.login or said.login,
                canvas=own.canvas or said.canvas,
                moodle=own.moodle or said.moodle,
            ),
            is_late=hand_in.is_late if entry.is_late is None else entry.is_late,
            submitted=entry.submitted or hand_in.submitted,
        )

    def _found(self, student: Student, *, surnames: bool) -> Iterable[int | None]:
        key, name = student.key, student.name
        yield self._canvas.get(student.canvas)
        yield self._moodle.get(student.moodle)
        words = dict.fromkeys(plain_word(word) for word in (key, student.login, name if surnames else "") if word)
        yield _only(self._words.get(word) for word in words)
        yield _only(self._local_parts.get(word) for word in words)
        in_canvas = key.removesuffix(f"_{student.canvas}") if student.canvas else ""
        yield self._canvas_names.get(canvas_name(in_canvas)) if in_canvas else None
        yield _only(self._names.get(plain_name(word)) for word in (name, key) if word)
        yield self._surnames.get(plain_name(name or key)) if surnames else None

    def _enter(self, index: int, entry: Entry) -> None:
        student = entry.student
        if group := plain_group(entry.section):
            self._groups.setdefault(group, []).append(index)
        local_part, at, _ = student.email.partition("@")
        words = (student.key, student.login, student.sis, student.email, *entry.aliases)
        for table, keys in (
            (self._canvas, (student.canvas,)),
            (self._moodle, (student.moodle,)),
            (self._words, {plain_word(word) for word in words}),
            (self._local_parts, (plain_word(local_part) if at else "",)),
            (self._canvas_names, set(canvas_names(student.name))),
            (self._names, {plain_name(student.name), plain_name(printable_path(student.name))}),
            (self._surnames, (surname(student.name),)),
        ):
            for key in keys:
                if key and table.setdefault(key, index) != index:
                    table[key] = _SEVERAL


def _only(found: Iterable[int | None]) -> int | None:
    indices = {index for index in found if index is not None}
    return indices.pop() if len(indices) == 1 else _SEVERAL if indices else None


def _differ(left: str, right: str) -> bool:
    return bool(left and right and left != right)
