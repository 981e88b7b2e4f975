"""The queue of a review: its items as the gradebook has them now, those of a filter, and students one by one."""

import json
from dataclasses import replace
from typing import NamedTuple

from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import (
    QueuedMember,
    QueuedResult,
    ReviewScope,
    newest_of,
    queued_results,
)
from grader.classroom.review.items import AMONG, QueuedItem, review_items, student_numbers
from grader.classroom.review.own_marks import OwnMarks
from grader.classroom.students import Student

ITEM_STATES = {
    "": "all",
    "unmarked": "unmarked",
    "answered": "with something to read",
    "empty": "without an answer",
    "marked": "marked in this review",
}
_MAX_KEPT = 8  # items in memory


class ReviewFilter(NamedTuple):
    """Which items of a review are shown: of a criterion, of a section, and of a state, one of ITEM_STATES."""

    criterion: str = ""
    section: str = ""
    state: str = ""


class ReviewQueue:
    """The items of a review. `split` are the positions of those whose students are marked one by one."""

    def __init__(self, grades: Grades, scope: ReviewScope, own: OwnMarks) -> None:
        self._grades, self._scope, self._own = grades, scope, own
        self.numbers = student_numbers(grades.book) if scope.anonymous else {}
        self.items = review_items(grades, scope, self.numbers)
        self.filter, self.split = ReviewFilter(), set[int]()
        sections = grades.book.rows("SELECT key, section FROM student")
        self._sections = {str(key): str(section) for key, section in sections}
        self._state: object = None  # of the gradebook and the filter when `_read_items` were read
        self._read_items: dict[int, QueuedResult | None] = {}

    @property
    def sections(self) -> list[str]:
        """The sections of the students in the queue."""
        return sorted({self._sections.get(key, "") for item in self.items for key, _ in item.students} - {""})

    @property
    def students(self) -> list[Student]:
        """The students in the queue; none if they are anonymous."""
        keys = {key for item in self.items for key, _ in item.students} if not self._scope.anonymous else ()
        return [student for student in self._grades.book.students() if student.key in keys]

    def listed(self) -> list[int]:
        """Return the positions of the items that the filter lets through, of a split item those of its students."""
        return [position for position in range(len(self.items)) if self.is_listed(position)]

    def is_listed(self, position: int) -> bool:
        """Return whether the filter lets an item through."""
        item, wanted = self.items[position], self.filter
        is_there = position not in self.split if item.whole is None else item.whole in self.split
        keys = self.keys(item)
        is_own = any((item.criterion, key) in self._own.newest for key in keys)
        states = ("", "marked" if is_own else "unmarked", "answered" if item.content else "empty")
        return is_there and wanted.state in states and wanted.criterion in ("", item.criterion) and bool(keys)

    def keys(self, item: QueuedItem) -> list[str]:
        """Return the students of an item in the section of the filter."""
        return [key for key, _ in item.students if self.filter.section in ("", self._sections.get(key, ""))]

    def item_at(self, position: int) -> QueuedResult | None:
        """Return an item in its current state; None beyond the queue, or if it is no longer graded.

        Students whose result has changed are not in an item of several, nor are those that others have marked.
        """
        book = self._grades.book
        state = book.first("PRAGMA data_version"), book.connection.total_changes, self.filter
        if state != self._state or len(self._read_items) > _MAX_KEPT:
            self._state, self._read_items = state, {}
        if position not in self._read_items:
            inside = 0 <= position < len(self.items)
            self._read_items[position] = self._read(self.items[position]) if inside else None
        return self._read_items[position]

    def _read(self, queued: QueuedItem) -> QueuedResult | None:
        """Return an item as the gradebook has it now; only of the first student the whole result is read."""
        criterion, results, book = queued.criterion, dict(queued.students), self._grades.book
        found = [
            QueuedMember(grade, newest_of(book, grade, criterion, self._scope), self.numbers.get(grade.student.key))
            for grade in list(self._grades.where(AMONG, json.dumps(self.keys(queued))))
            if len(results) == 1 or grade.result == results[grade.student.key]
        ]
        found.sort(key=lambda one: one.number or 0)
        shown = [one for one in found if one.is_open or self._own.has(criterion, one)] or found
        items = [
            item for one in shown[:1] for item in queued_results(self._grades, one.grade, (criterion,), self._scope)
        ]
        return next((replace(item, first=shown[0], others=tuple(shown[1:])) for item in items), None)
