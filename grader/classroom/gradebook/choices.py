"""How often the usual deductions of a rubric were given in a class."""

import re
from collections import Counter
from decimal import Decimal
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric

_SEPARATOR = re.compile(r"\s*[;\n]\s*")  # of the comments in one


class ChoiceCount(NamedTuple):
    """A usual deduction of a criterion, its points below 0, and the number of students whose mark has its comment."""

    criterion: Criterion
    text: str
    points: Decimal
    students: int


def choice_counts(book: Gradebook, rubric: Rubric) -> tuple[ChoiceCount, ...]:
    """Return how often each usual deduction was given, in the order of the rubric."""
    criteria = [row for row in rubric.criteria if row.choices]
    counts = Counter(
        (str(name), text)
        for name, comment in (book.rows("SELECT criterion, comment FROM manual_mark") if criteria else ())
        for text in set(_SEPARATOR.split(comment.strip()))
    )
    return tuple(
        ChoiceCount(row, text, points, counts[row.id, text]) for row in criteria for text, points in row.choices.items()
    )
