"""The marks of one review, each of which can be undone."""

from collections.abc import Iterable
from decimal import Decimal
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.manual_queue import QueuedResult, ReviewScope, newest_of
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


class GivenMark(NamedTuple):
    """A mark of a review: the position of its item, its criterion, and the mark `before` it of each student."""

    position: int
    criterion: str
    before: dict[str, Mark | None]


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

    def has(self, item: QueuedResult) -> bool:
        """Return whether this review has marked a student of an item."""
        return any((item.result.criterion.id, one.grade.student.key) in self.newest for one in item.members)

    def mark(self, position: int, item: QueuedResult, points: Decimal, comment: str, shown: int | None) -> None:
        """Mark the students of an item who do not already have this mark, see ReviewSession.mark."""
        shown = item.newest if shown is None else shown
        criterion, by = item.result.criterion.id, self._scope.by
        entry = Entry("second" if self._scope.second else "points", points, comment)
        marks = {}
        with writing(self._book):
            for one in item.members:
                newest = newest_of(self._book, one.grade, criterion, self._scope)
                if newest is None or newest.id > shown or newest.entry != entry:
                    mark = add_mark(self._book, one.grade, criterion, entry, by, shown=shown)
                    marks[one.grade.student.key] = mark
        if marks:
            before = {key: mark.before for key, mark in marks.items()}
            self._given.append(GivenMark(position, criterion, before))
        self.newest |= {(criterion, key): mark.id for key, mark in marks.items()}

    def pop(self, position: int) -> GivenMark:
        """Remove and return the newest mark of the item at a position, else of the review, to undo it."""
        here = [index for index, given in enumerate(self._given) if given.position == position]
        return self._given.pop(here[-1] if here else -1)

    def undo(self, given: GivenMark, item: QueuedResult) -> Mark | None:
        """Add an entry for each student that restores the mark before, or withdraws the mark; return what counts now.

        Raises NewerMarkError if a student has a newer mark, which stays.
        """
        newer = None
        for one in item.members:
            key = one.grade.student.key
            if key in given.before:
                try:
                    self._restore(one, given.before[key])
                except NewerMarkError as error:
                    self.forget(given.criterion, [key])
                    newer = error
        gone = given.before.keys() - {one.grade.student.key for one in item.members}
        self.forget(given.criterion, gone)  # results that have changed since keep their marks
        if newer is not None:
            raise newer
        return next(iter(given.before.values()))

    def _restore(self, one: QueuedResult, before: Mark | None) -> None:
        key, criterion = one.grade.student.key, one.result.criterion.id
        mark = before or (WITHDRAWN_SECOND if self._scope.second else WITHDRAWN)
        shown = self.newest[criterion, key]
        added = restore_mark(self._book, one.grade, criterion, mark, self._scope.by, shown=shown)
        self.newest[criterion, key] = added.id
        if not any(other.criterion == criterion and key in other.before for other in self._given):
            self.forget(criterion, [key])

    def forget(self, criterion: str, keys: Iterable[str]) -> None:
        """Forget the marks of students: they can no longer be undone."""
        for key in keys:
            del self.newest[criterion, key]
            for given in self._given:
                if given.criterion == criterion:
                    given.before.pop(key, None)
        self._given = [given for given in self._given if given.before]
