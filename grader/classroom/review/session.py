"""A review: one person goes through the items that need manual grading. Each mark is saved immediately."""

from decimal import Decimal

from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import (
    EVERYTHING,
    QueuedResult,
    ReviewScope,
    manual_grading_queue,
    numbered_comments,
    reusable_comments,
)
from grader.classroom.gradebook.marks import Mark
from grader.classroom.review.own_marks import OwnMarks
from grader.classroom.review.queue import ReviewFilter, ReviewQueue
from grader.classroom.typed_names import criterion_of
from grader.errors import InputError
from grader.grading.rubric import Rubric

MAX_COMMENTS = 9  # one key each
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
        self.own = OwnMarks(grades.book, scope)
        self.queue = ReviewQueue(grades, scope, self.own)
        self._comments: dict[str, list[str]] = {}  # of each criterion, in the order of their keys
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

    def start(self) -> None:
        """Go to the first item that is shown, or to the end."""
        self.position = -1
        self.next()

    def show_only(self, wanted: ReviewFilter) -> None:
        """Show the items that a filter lets through, from the first one. Raises InputError for an unknown value."""
        known = {item.criterion for item in self.queue.items}
        if {wanted.criterion, wanted.section} - {"", *known, *self.queue.sections}:
            raise InputError("this review has no such question or section")
        self.queue.filter = wanted
        self.start()

    def go(self, position: int) -> None:
        """Go to a position in the queue, also to a marked item; beyond the last one to the end.

        In place of an item that is split it goes to its first student.
        """
        position += position in self.queue.split
        self.item = self.queue.item_at(position)
        self.position = position if 0 <= position < len(self.queue.items) else len(self.queue.items)

    def current_item(self) -> QueuedResult:
        """Return the current item; raise InputError if it is no longer graded."""
        if self.item is None:
            raise InputError(_NOT_GRADED)
        return self.item

    def next(self) -> None:
        """Go to the next item that is not marked by others, or to the end."""
        if not any(self._is_shown(position) for position in range(self.position + 1, len(self.queue.items))):
            self.go(len(self.queue.items))

    def stay(self) -> None:
        """Go to the current item if it is still open, else to the next one."""
        self.position -= 1
        self.next()

    def back(self) -> None:
        """Go to the previous item that is not marked by others; raise InputError if there is none."""
        start = self.position
        if not any(self._is_shown(position) for position in range(start - 1, -1, -1)):
            self.go(start)
            raise InputError("this is the first item")

    def _is_shown(self, position: int) -> bool:
        """Go to an item and return whether it is open, or marked by this review, and the filter lets it through."""
        if not self.queue.is_listed(position):
            return False
        self.go(position)
        return self.item is not None and (self.item.is_open or self.is_own)

    def split(self) -> None:
        """Show the students of the current item one by one, from the first; raise InputError if it has only one."""
        if not self.current_item().others:
            raise InputError("this item has one student only")
        self.queue.split.add(self.position)
        self.next()

    def find(self, name: str) -> None:
        """Go to an item of a student: one with something to read, of the current criterion if possible.

        Raises InputError.
        """
        queue = self.queue
        numbered = {str(number): key for key, number in queue.numbers.items()}
        if self.scope.anonymous and name not in numbered:
            raise InputError(f"there is no submission {name!r}: type the number of one")
        key = numbered.get(name) or self._grades.find(name).student.key
        here = queue.items[self.position].criterion if self.item is not None else ""
        found = [position for position in queue.listed() if key in queue.keys(queue.items[position])]
        if not found:
            where = " under this filter" if any(queue.filter) else ""
            raise InputError(f"there is nothing to grade for {name!r}{where}")
        start = self.position
        for at in sorted(found, key=lambda at: (not queue.items[at].content, queue.items[at].criterion != here, at)):
            self.go(at)
            if self.item is not None and key in (one.grade.student.key for one in self.item.members):
                return
        self.go(start)
        raise InputError(f"others have already marked {name!r}")

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
        if not given.before.keys() <= set(self.queue.keys(self.queue.items[given.position])):
            self.queue.filter = ReviewFilter()
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
        criterion = self.queue.items[self.position].criterion
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
        criterion = self.queue.items[self.position].criterion
        return numbered_comments(self._grades.book, criterion, second=self.scope.second)
