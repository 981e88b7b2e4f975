"""How two graders agree on the criteria that both have marked."""

from decimal import Decimal
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.result import points_from_units
from grader.grading.rubric import Rubric

MAX_DIFFERENCES = 5


# A second opinion on an earlier submission, or of the person who gave the mark, is not compared.
_PAIRS = """
SELECT key, criterion, manual_mark.points, second_mark.points FROM second_mark
JOIN manual_mark USING (student, criterion)
JOIN result AS marked ON marked.id = manual_mark.result AND marked.digest = second_mark.digest
JOIN student ON student.id = second_mark.student
WHERE second_mark.points IS NOT NULL AND second_mark.grader_name <> manual_mark.grader_name
ORDER BY key, criterion, second_mark.id
"""


class MarkedTwice(NamedTuple):
    """A criterion of a student with the points of both graders, and the criterion's maximum."""

    key: str
    criterion: str
    first: Decimal
    second: Decimal
    max_points: Decimal

    @property
    def difference(self) -> Decimal:
        """The difference in percent of the maximum."""
        return 100 * abs(self.first - self.second) / self.max_points


class Agreement(NamedTuple):
    """How many items were marked twice, how many of them equally, and the mean difference in percent of the maximum.

    `largest` are the largest differences.
    """

    items: int
    same: int
    mean_difference_percent: float
    largest: tuple[MarkedTwice, ...]


def agreement(book: Gradebook, rubric: Rubric) -> Agreement:
    """Return the agreement on the criteria of a rubric that have points."""
    maxima = {criterion.id: criterion.points for criterion in rubric.criteria if criterion.points}
    items = [
        MarkedTwice(str(key), name, points_from_units(first), points_from_units(second), maxima[name])
        for key, name, first, second in book.rows(_PAIRS)
        if name in maxima
    ]
    apart = sorted((item for item in items if item.difference), key=lambda item: -item.difference)
    mean = float(sum((item.difference for item in items), Decimal(0)) / len(items)) if items else 0.0
    return Agreement(len(items), len(items) - len(apart), mean, tuple(apart[:MAX_DIFFERENCES]))
