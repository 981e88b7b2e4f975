"""The marks of one review, each of which can be undone."""

from collections.abc import Iterable
from decimal import Decimal
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.manual_queue import QueuedMember, QueuedResult, ReviewScope, newest_of
from grader.classroom.gradebook.marks import (
    WITHDRAWN,
    WITHDRAWN_SECOND,
    Entry,
    Mark,
    NewerMarkError,
    add_mark,
    restore_mark,
    writing,
)
from grader.classroom.gradebook.student_grade import StudentGrade


class GivenMark(NamedTuple):
    """A mark of a review: the position of its item, its criterion, and the students by key, with the marks `before`."""

    position: int
    criterion: str
    before: dict[str, tuple[StudentGrade, Mark | None]]


class OwnMarks:
    """The marks that a review has given. `newest` are the ids of the newest ones, by criterion and student."""

    def __init__(self, book: Gradebook, scope: ReviewScope) -> None:
        self._book, self._scope = book, scope
        self._given: list[GivenMark] = []
        self.newest: dict[tuple[str, str], int] = {}

    @property
    def can_undo(self) -> bool:
        """Return whether there is a mark to undo."""
        return bool(self._given)

    def has(self, criterion: str, member: QueuedMember) -> bool:
        """Return whether a student's newest mark is of this review."""
        own = self.newest.get((criterion, member.grade.student.key))
        return own is not None and member.mark is not None and own == member.mark.id

    def mark(self, position: int, item: QueuedResult, points: Decimal, comment: str, shown: int | None) -> None:
        """Mark the students of an item who do not already have this mark, see ReviewSession.mark."""
        shown = item.newest if shown is None else shown
        criterion = item.result.criterion.id
        entry = Entry("second" if self._scope.second else "points", points, comment)
        found = [(one.grade, newest_of(self._book, one.grade, criterion, self._scope)) for one in item.members]
        # By age, so that of several marks that were not shown each is confirmed.
        found.sort(key=lambda pair: pair[1].id if pair[1] is not None else 0)
        before: dict[str, tuple[StudentGrade, Mark | None]] = {}
        newest: dict[tuple[str, str], int] = {}
        with writing(self._book):
            for grade, mark in found:
                if mark is None or mark.id > shown or mark.entry != entry:
                    added = add_mark(self._book, grade, criterion, entry, self._scope.by, shown=shown)
                    before[grade.student.key] = grade, added.before
                    newest[criterion, grade.student.key] = added.id
        self._given += [GivenMark(position, criterion, before)] * bool(before)
        self.newest |= newest

    def pop(self, position: int) -> GivenMark:
        """Remove and return the newest mark of the item at a position, else of the review, to undo it.

        A later mark of one of its students goes first.
        """
        at = next((at for at, one in reversed([*enumerate(self._given)]) if one.position == position), -1)
        chosen = self._given[at]
        for later in reversed(self._given):
            if later.criterion == chosen.criterion and later.before.keys() & chosen.before.keys():
                self._given.remove(later)
                return later
        raise AssertionError("a mark has its own students")

    def undo(self, given: GivenMark) -> Mark | None:
        """Add an entry for each student that restores the mark before, or withdraws the mark; return what counts now.

        That is None if it differs between the students. Raises NewerMarkError if a student has a newer mark, which
        stays.
        """
        newer = None
        for key, (grade, before) in given.before.items():
            mark = before or (WITHDRAWN_SECOND if self._scope.second else WITHDRAWN)
            shown = self.newest[given.criterion, key]
            try:
                added = restore_mark(self._book, grade, given.criterion, mark, self._scope.by, shown=shown)
            except NewerMarkError as error:
                self.forget(given.criterion, [key])
                newer = error
                continue
            self.newest[given.criterion, key] = added.id
            if not any(one.criterion == given.criterion and key in one.before for one in self._given):
                self.forget(given.criterion, [key])
        if newer is not None:
            raise newer
        first, *others = (before for _, before in given.before.values())
        return first if all(one == first for one in others) else None

    def forget(self, criterion: str, keys: Iterable[str]) -> None:
        """Forget the marks of students: they can no longer be undone."""
        for key in list(keys):
            self.newest.pop((criterion, key), None)
            for given in self._given:
                if given.criterion == criterion:
                    given.before.pop(key, None)
        self._given = [given for given in self._given if given.before]
