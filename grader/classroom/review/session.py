"""A review: one person goes through the items that need manual grading. Each mark is saved immediately."""

import json
from dataclasses import replace
from decimal import Decimal

from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import (
    EVERYTHING,
    QueuedMember,
    QueuedResult,
    ReviewScope,
    manual_grading_queue,
    newest_of,
    numbered_comments,
    queued_results,
    reusable_comments,
)
from grader.classroom.gradebook.marks import Mark
from grader.classroom.review.filter import ITEM_STATES, ReviewFilter
from grader.classroom.review.items import AMONG, QueuedItem, review_items, student_numbers
from grader.classroom.review.own_marks import OwnMarks
from grader.classroom.students import Student
from grader.classroom.typed_names import criterion_of
from grader.errors import InputError
from grader.grading.rubric import Rubric

MAX_COMMENTS = 9  # one key each
_MAX_KEPT = 8  # items in memory
_NOT_GRADED = "this criterion is no longer graded for this student"


class ReviewSession:
    """The queue of a review and the place in it. Items that it marked stay; what others mark meanwhile is skipped.

    `item` is the current item, None at the end of the queue.
    """

    def __init__(self, grades: Grades, scope: ReviewScope = EVERYTHING) -> None:
        self.criteria = grades.newest_rubric().criteria
        for is_wrong, option in ((scope.mine, "--mine"), (scope.second, "--second")):
            if is_wrong and not scope.by:
                raise InputError(f"{option} needs --by, your name")
        if scope.criterion:
            criterion_of(grades.newest_rubric(), scope.criterion)
        self.scope, self._grades = scope, grades
        self.filter = ReviewFilter()
        self._numbers = student_numbers(grades.book) if scope.anonymous else {}
        self.queue = review_items(grades, scope, self._numbers)
        sections = grades.book.rows("SELECT key, section FROM student")
        self._sections = {str(key): str(section) for key, section in sections}
        self._split: set[int] = set()  # the positions of the items whose students are marked one by one
        self.own = OwnMarks(grades.book, scope)
        self._comments: dict[str, list[str]] = {}  # of each criterion, in the order of their keys
        self._state: object = None  # of the gradebook and the filter when `_items` were read
        self._items: dict[int, QueuedResult | None] = {}
        self.item: QueuedResult | None = None
        self.start()

    @property
    def marked(self) -> int:
        """The number of results that this review has marked."""
        return len(self.own.newest)

    @property
    def left(self) -> int:
        """The number of results that need manual grading."""
        return len(manual_grading_queue(self._grades, self.scope))

    @property
    def is_own(self) -> bool:
        """Return whether this review has marked the current item."""
        item = self.item
        return item is not None and any(self.own.has(item.result.criterion.id, one) for one in item.members)

    @property
    def sections(self) -> list[str]:
        """The sections of the students in the queue."""
        return sorted({self._sections.get(key, "") for item in self.queue for key, _ in item.students} - {""})

    @property
    def students(self) -> list[Student]:
        """The students in the queue; none if they are anonymous."""
        keys = {key for item in self.queue for key, _ in item.students} if not self.scope.anonymous else ()
        return [student for student in self._grades.book.students() if student.key in keys]

    def listed(self) -> list[int]:
        """Return the positions of the items that the filter lets through, of a split item those of its students."""
        return [position for position in range(len(self.queue)) if self._is_listed(position)]

    def _is_listed(self, position: int) -> bool:
        item, wanted = self.queue[position], self.filter
        is_there = position not in self._split if item.whole is None else item.whole in self._split
        keys = self._keys(item)
        is_own = any((item.criterion, key) in self.own.newest for key in keys)
        is_in = ITEM_STATES[wanted.state][1](item.content, is_own)
        return is_there and is_in and wanted.criterion in ("", item.criterion) and bool(keys)

    def _keys(self, item: QueuedItem) -> list[str]:
        """Return the students of an item in the section of the filter."""
        return [key for key, _ in item.students if self.filter.section in ("", self._sections.get(key, ""))]

    def start(self) -> None:
        """Go to the first item that is shown, or to the end."""
        self.position = -1
        self.next()

    def show_only(self, wanted: ReviewFilter) -> None:
        """Show the items that a filter lets through, from the first one. Raises InputError for an unknown value."""
        known = {item.criterion for item in self.queue}
        if {wanted.criterion, wanted.section} - {"", *known, *self.sections}:
            raise InputError("nothing in this review has this question or section")
        self.filter = wanted
        self.start()

    def go(self, position: int) -> None:
        """Go to a position in the queue, also to a marked item; beyond the last one to the end.

        In place of an item that is split it goes to its first student.
        """
        position += position in self._split
        self.item = self.item_at(position)
        self.position = position if 0 <= position < len(self.queue) else len(self.queue)

    def item_at(self, position: int) -> QueuedResult | None:
        """Return an item in its current state; None beyond the queue, or if it is no longer graded.

        Students whose result has changed are not in an item of several, nor are those that others have marked.
        """
        book = self._grades.book
        state = book.first("PRAGMA data_version"), book.connection.total_changes, self.filter
        if state != self._state or len(self._items) > _MAX_KEPT:
            self._state, self._items = state, {}
        if position not in self._items:
            inside = 0 <= position < len(self.queue)
            self._items[position] = self._read(self.queue[position]) if inside else None
        return self._items[position]

    def _read(self, queued: QueuedItem) -> QueuedResult | None:
        """Return an item as the gradebook has it now; only of the first student the whole result is read."""
        criterion, results, book = queued.criterion, dict(queued.students), self._grades.book
        found = [
            QueuedMember(grade, newest_of(book, grade, criterion, self.scope), self._numbers.get(grade.student.key))
            for grade in list(self._grades.where(AMONG, json.dumps(self._keys(queued))))
            if len(results) == 1 or grade.result == results[grade.student.key]
        ]
        found.sort(key=lambda one: one.number or 0)
        shown = [one for one in found if one.is_open or self.own.has(criterion, one)] or found
        items = [
            item for one in shown[:1] for item in queued_results(self._grades, one.grade, (criterion,), self.scope)
        ]
        return next((replace(item, first=shown[0], others=tuple(shown[1:])) for item in items), None)

    def current_item(self) -> QueuedResult:
        """Return the current item; raise InputError if it is no longer graded."""
        if self.item is None:
            raise InputError(_NOT_GRADED)
        return self.item

    def next(self) -> None:
        """Go to the next item that is not marked by others, or to the end."""
        if not any(self._is_shown(position) for position in range(self.position + 1, len(self.queue))):
            self.go(len(self.queue))

    def stay(self) -> None:
        """Go to the current item if it is still open, else to the next one."""
        self.position -= 1
        self.next()

    def back(self) -> bool:
        """Go to the previous item that is not marked by others; return whether there is one."""
        start = self.position
        if any(self._is_shown(position) for position in range(start - 1, -1, -1)):
            return True
        self.go(start)
        return False

    def _is_shown(self, position: int) -> bool:
        """Go to an item and return whether it is open, or marked by this review, and the filter lets it through."""
        if not self._is_listed(position):
            return False
        self.go(position)
        return self.item is not None and (self.item.is_open or self.is_own)

    def split(self) -> bool:
        """Show the students of the current item one by one, from the first; return whether it has several."""
        if not self.current_item().others:
            return False
        self._split.add(self.position)
        self.next()
        return True

    def find(self, name: str) -> None:
        """Go to an item of a student: one with something to read, of the current criterion if possible.

        Raises InputError.
        """
        numbered = {str(number): key for key, number in self._numbers.items()}
        if self.scope.anonymous and name not in numbered:
            raise InputError(f"there is no submission {name!r}: type the number of one")
        key = numbered.get(name) or self._grades.find(name).student.key
        here = self.queue[self.position].criterion if self.item is not None else ""
        found = [position for position in self.listed() if key in self._keys(self.queue[position])]
        if not found:
            where = " under this filter" if any(self.filter) else ""
            raise InputError(f"there is nothing to grade for {name!r}{where}")
        start = self.position
        for at in sorted(found, key=lambda at: (not self.queue[at].content, self.queue[at].criterion != here, at)):
            self.go(at)
            if self.item is not None and key in (one.grade.student.key for one in self.item.members):
                return
        self.go(start)
        raise InputError(f"everything of {name!r} is marked by others")

    def mark(self, points: Decimal, comment: str, shown: int | None = None) -> None:
        """Mark all students of the current item, unless they already have this mark.

        `shown` is the newest mark that the person has seen, by default that of the item. Raises NewerMarkError if there
        is a newer one, and InputError.
        """
        self.own.mark(self.position, self.current_item(), points, comment, shown)

    def undo(self) -> Mark | None:
        """Undo the newest mark of the current item, else of the review; go to its item, return the mark that counts.

        Raises NewerMarkError if there is a newer mark, InputError, also if the item is no longer graded, and IndexError
        if there is nothing to undo.
        """
        given = self.own.pop(self.position)
        if not given.before.keys() <= set(self._keys(self.queue[given.position])):
            self.filter = ReviewFilter()
        self.go(given.position)
        if self.item is None:
            self.own.forget(given.criterion, given.before)
            self.stay()
            raise InputError(f"not undone: {_NOT_GRADED}")
        try:
            return self.own.undo(given)
        finally:
            self.go(given.position)

    def rubric_of(self, item: QueuedResult) -> Rubric:
        """Return the rubric that an item was graded with."""
        return self._grades.rubric(item.grade.rubric)

    def comments(self) -> list[str]:
        """Return earlier comments for the criterion of the current item, the most frequent first.

        A comment keeps its position during the review, because its key is its position.
        """
        criterion = self.queue[self.position].criterion
        found = reusable_comments(self._grades.book, criterion, MAX_COMMENTS, second=self.scope.second)
        choices = {text for row in self.criteria if row.id == criterion for text in row.choices}  # have their own keys
        found = [comment for comment in found if comment not in choices]
        before = self._comments.get(criterion, [])
        new = iter([comment for comment in found if comment not in before])
        places = [comment if comment in found else next(new, "") for comment in before]
        self._comments[criterion] = [*filter(None, places), *new]
        return self._comments[criterion]

    def numbered_comments(self) -> dict[int, str]:
        """Return all earlier comments for the criterion of the current item, by their numbers, which never change."""
        criterion = self.queue[self.position].criterion
        return numbered_comments(self._grades.book, criterion, second=self.scope.second)
