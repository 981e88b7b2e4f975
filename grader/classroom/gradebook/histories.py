"""Compare the manual marks of two gradebooks: the entries of each item in both, and which items are in conflict."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.marks import Entry, Mark, mark_of
from grader.classroom.gradebook.stored import STUDENT_COLUMNS
from grader.classroom.matching import LMS_IDS, Clue, People, clues_of
from grader.classroom.students import Student

_IDS = (*LMS_IDS, Clue.EXACT_ID)


class StoredMark(NamedTuple):
    """An entry with its author for the audit. Ids and results differ between gradebooks; `identity` is the rest."""

    mark: Mark
    author: str

    @property
    def identity(self) -> tuple[Entry, str, str, str]:
        """What is the same in both gradebooks: entry, author, name in reports, time."""
        return self.mark.entry, self.author, self.mark.by, self.mark.at


History = tuple[StoredMark, ...]


@dataclass(frozen=True, slots=True)
class MergeItem:
    """A criterion of a student, or the whole submission, with its entries in both gradebooks.

    `student` is the id in the first gradebook.
    """

    student: int
    key: str
    criterion: str
    first: History
    second: History

    @property
    def new(self) -> History:
        """The entries of the second gradebook that the first one lacks."""
        return _missing(self.second, self.first)

    @property
    def newest(self) -> tuple[StoredMark | None, StoredMark | None]:
        """The newest mark in each gradebook."""
        return _newest(self.first), _newest(self.second)

    @property
    def is_conflict(self) -> bool:
        """Return whether both gradebooks have entries that the other one lacks, and different marks count."""
        has_both = _newest(self.new) and _newest(_missing(self.first, self.second))
        return bool(has_both) and not self.has_same_mark

    @property
    def has_same_mark(self) -> bool:
        """Return whether the same points and comment count in both."""
        return _state(self.newest[0]) == _state(self.newest[1])

    @property
    def counts(self) -> StoredMark | None:
        """The mark that must count after a merge without conflict: of the gradebook with all entries of the other."""
        first, second = self.newest
        return second if _newest(self.new) and not self.has_same_mark else first


class UnmatchedStudent(NamedTuple):
    """A student of the second gradebook whom the first one lacks, and the number of entries."""

    key: str
    entries: int


class MarkComparison(NamedTuple):
    """The items of which the first gradebook lacks entries of the second, and the students who are not matched."""

    items: tuple[MergeItem, ...]
    unmatched: tuple[UnmatchedStudent, ...]


def compare_marks(first: Gradebook, second: Gradebook) -> MarkComparison:
    """Return what a merge of the second gradebook's marks into the first one has to do."""
    students, others = _students(first), _students(second)
    own, theirs = _histories(first), _histories(second)
    marked = {student for student, _ in theirs}
    matched = _match_students(students, {number: others[number] for number in others if number in marked})
    items = [
        MergeItem(number, students[number].key, criterion, own[number, criterion], history)
        for (student, criterion), history in list(theirs.items())
        if (number := matched.get(student)) is not None
    ]
    counts = Counter(student for (student, _), history in theirs.items() for _ in history)
    unmatched = [UnmatchedStudent(others[number].key, counts[number]) for number in sorted(marked - matched.keys())]
    found = sorted((item for item in items if item.new), key=lambda item: (item.key, item.criterion))
    return MarkComparison(tuple(found), tuple(sorted(unmatched)))


def is_newest(entry: StoredMark, history: History) -> bool:
    """Return whether the newest mark of a history has the same points and comment as an entry."""
    return _state(_newest(history)) == _state(entry)


def _match_students(students: dict[int, Student], others: dict[int, Student]) -> dict[int, int]:
    """Return the ids of the students in the first gradebook, by those in the second: the same key, else the same ids.

    A student who matches several, or whose LMS number differs, is not included.
    """
    numbers = list(students)
    people = People(map(clues_of, students.values()))
    places = {student.key: place for place, student in enumerate(students.values())}
    found: dict[int, int] = {}
    by_ids: dict[int, int] = {}
    for number, student in others.items():
        place = places.get(student.key)
        only = people.find(clues_of(student), _IDS, None if place is None else (place,)).only
        if only is not None:
            (by_ids if place is None else found)[number] = numbers[only]
    claims = Counter((*found.values(), *by_ids.values()))
    return found | {number: student for number, student in by_ids.items() if claims[student] == 1}


def _students(book: Gradebook) -> dict[int, Student]:
    rows = book.rows(f"SELECT id, {', '.join(STUDENT_COLUMNS)} FROM student ORDER BY key")
    return {number: Student(*values) for number, *values in rows}


def _histories(book: Gradebook) -> "defaultdict[tuple[int, str], History]":
    found: defaultdict[tuple[int, str], History] = defaultdict(tuple)
    for row in book.records("SELECT * FROM mark ORDER BY id"):
        found[row["student"], row["criterion"]] += (StoredMark(mark_of(row), row["author"]),)
    return found


def _missing(entries: Iterable[StoredMark], others: Iterable[StoredMark]) -> History:
    """Return the entries that others lack. Equal entries are counted: two are not the same as one."""
    known = Counter(entry.identity for entry in others)
    missing = []
    for entry in entries:
        if known[entry.identity]:
            known[entry.identity] -= 1
        else:
            missing.append(entry)
    return tuple(missing)


def _newest(history: Sequence[StoredMark]) -> StoredMark | None:
    """Return the newest mark; second opinions are not marks."""
    return next((entry for entry in reversed(history) if entry.mark.entry.kind != "second"), None)


def _state(entry: StoredMark | None) -> Entry | None:
    """Return what counts: None if there is no mark, or it is withdrawn."""
    return None if entry is None or entry.mark.entry.kind == "withdrawn" else entry.mark.entry
