"""A review: one person grades the items that need manual grading. Each mark is saved immediately."""

from decimal import Decimal
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import (
    EVERYTHING,
    QueuedResult,
    ReviewScope,
    manual_grading_queue,
    newest_of,
    numbered_comments,
    queued_result,
    reusable_comments,
)
from grader.classroom.gradebook.marks import (
    WITHDRAWN,
    WITHDRAWN_SECOND,
    Entry,
    Mark,
    NewerMarkError,
    add_mark,
    restore_mark,
)
from grader.classroom.typed_names import criterion_of
from grader.errors import InputError
from grader.files.reading import sha256_of
from grader.grading.rubric import Rubric

MAX_COMMENTS = 9  # one key each
_NOT_GRADED = "this criterion is no longer graded for this student"


class _Given(NamedTuple):
    """A mark of this review: the position of its item in the queue, and the mark that was the newest before."""

    position: int
    before: Mark | None


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
        self._numbers = student_numbers(grades.book) if scope.anonymous else {}
        order = {criterion.id: criterion.position for criterion in self.criteria}
        queue = manual_grading_queue(grades, scope)
        self.queue = tuple(sorted(queue, key=lambda one: (order[one.criterion], self._numbers.get(one.key, 0))))
        self._given: list[_Given] = []
        self._own: dict[int, int] = {}  # the newest mark of this review, by the position of its item
        self._comments: dict[str, list[str]] = {}  # of each criterion, in the order of their keys
        self.item: QueuedResult | None = None
        self.start()

    @property
    def marked(self) -> int:
        """The number of items that this review has marked."""
        return len(self._own)

    @property
    def left(self) -> int:
        """The number of items that need manual grading."""
        return len(manual_grading_queue(self._grades, self.scope))

    @property
    def is_own(self) -> bool:
        """Return whether this review has marked the current item."""
        return self.position in self._own

    @property
    def can_undo(self) -> bool:
        """Return whether a mark of this review can be undone."""
        return bool(self._given)

    def start(self) -> None:
        """Go to the first item that is not marked by others, or to the end."""
        self.position = -1
        self.next()

    def go(self, position: int) -> None:
        """Go to a position in the queue, also to a marked item; beyond the last one to the end."""
        self.item = self.item_at(position)
        self.position = position if 0 <= position < len(self.queue) else len(self.queue)

    def item_at(self, position: int) -> QueuedResult | None:
        """Return an item in its current state; None beyond the queue, or if it is no longer graded."""
        inside = 0 <= position < len(self.queue)
        if not inside:
            return None
        number = self._numbers.get(self.queue[position].key)
        return queued_result(self._grades, self.queue[position], self.scope, number)

    def current_item(self) -> QueuedResult:
        """Return the current item; raise InputError if it is no longer graded."""
        if self.item is None:
            raise InputError(_NOT_GRADED)
        return self.item

    def next(self) -> None:
        """Go to the next item that is not marked by others, or to the end."""
        for position in range(self.position + 1, len(self.queue)):
            if self._is_shown(position):
                return
        self.go(len(self.queue))

    def back(self) -> bool:
        """Go to the previous item that is not marked by others; return whether there is one."""
        start = self.position
        if any(self._is_shown(position) for position in range(start - 1, -1, -1)):
            return True
        self.go(start)
        return False

    def _is_shown(self, position: int) -> bool:
        """Go to an item and return whether it is open, or marked by this review."""
        self.go(position)
        return self.item is not None and (self.item.is_open or self.is_own)

    def mark(self, points: Decimal, comment: str, shown: int | None = None) -> None:
        """Mark the current item, unless it already has this mark.

        `shown` is the newest mark that the person has seen, by default that of the item. Raises NewerMarkError if there
        is a newer one, and InputError.
        """
        item = self.current_item()
        shown = item.newest if shown is None else shown
        book, criterion = self._grades.book, item.result.criterion
        newest = newest_of(book, item.grade, criterion.id, self.scope)
        entry = Entry("second" if self.scope.second else "points", points, comment)
        if newest is not None and (newest.id, newest.entry) == (shown, entry):
            return
        added = add_mark(book, item.grade, criterion.id, entry, self.scope.by, shown=shown)
        self._given.append(_Given(self.position, added.before))
        self._own[self.position] = added.id

    def undo(self) -> Mark | None:
        """Undo the newest mark of the current item, else of the review; go to its item, return the mark that counts.

        Adds an entry that restores the mark before it, or withdraws the mark. Raises NewerMarkError if there is a newer
        mark, InputError, also if the item is no longer graded, and IndexError if there is nothing to undo.
        """
        here = self.position
        own = [index for index, given in enumerate(self._given) if given.position == here]
        index = own[-1] if own else len(self._given) - 1
        given = self._given[index]
        self.go(given.position)
        item = self.item
        if item is None:
            self._forget(given.position)
            self.position = here - 1
            self.next()
            raise InputError(f"not undone: {_NOT_GRADED}")
        withdrawn = WITHDRAWN_SECOND if self.scope.second else WITHDRAWN
        try:
            added = restore_mark(
                self._grades.book, item.grade, item.result.criterion.id, given.before or withdrawn, self.scope.by,
                shown=self._own[given.position],
            )  # fmt: skip
        except NewerMarkError:
            self._forget(given.position)
            raise
        del self._given[index]
        self._own[given.position] = added.id
        if all(other.position != given.position for other in self._given):
            self._forget(given.position)
        self.go(given.position)
        return given.before

    def _forget(self, position: int) -> None:
        """Forget the marks of this review for an item: they can no longer be undone."""
        self._given = [given for given in self._given if given.position != position]
        del self._own[position]

    def rubric_of(self, item: QueuedResult) -> Rubric:
        """Return the rubric that an item was graded with."""
        return self._grades.rubric(item.grade.rubric)

    def comments(self) -> list[str]:
        """Return earlier comments for the criterion of the current item, the most frequent first.

        A comment keeps its position during the review, because its key is its position.
        """
        criterion = self.queue[self.position].criterion
        found = reusable_comments(self._grades.book, criterion, MAX_COMMENTS, second=self.scope.second)
        before = self._comments.get(criterion, [])
        new = iter([comment for comment in found if comment not in before])
        places = [comment if comment in found else next(new, "") for comment in before]
        self._comments[criterion] = [*filter(None, places), *new]
        return self._comments[criterion]

    def numbered_comments(self) -> dict[int, str]:
        """Return all earlier comments for the criterion of the current item, by their numbers, which never change."""
        criterion = self.queue[self.position].criterion
        return numbered_comments(self._grades.book, criterion, second=self.scope.second)


def student_numbers(book: Gradebook) -> dict[str, int]:
    """Return a number for each student with a submission, in an order that says nothing about names."""
    keys = [str(key) for (key,) in book.rows("SELECT key FROM grade WHERE result IS NOT NULL")]
    return {key: number for number, key in enumerate(sorted(keys, key=lambda key: sha256_of(key.encode())), 1)}
