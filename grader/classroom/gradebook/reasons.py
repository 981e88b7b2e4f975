"""Why submissions lost points, and why their points are undecided: counted over the newest submissions of a class."""

import json
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import chain

from grader.checks.manual import MANUAL_CHECKS
from grader.classroom.gradebook.failures import Failure
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.result import UNITS_PER_POINT
from grader.grading.rubric import Rubric

GRADED = "FROM grade WHERE verdict = 'graded' AND NOT is_excused AND rubric = ?"
_MARKS = "SELECT criterion, points FROM manual_mark WHERE student = ?"


def manual_units(book: Gradebook, student: int) -> dict[str, int]:
    """Return the manual marks of a student in ten-thousandths of a point; none for student 0."""
    return {str(name): int(points) for name, points in book.rows(_MARKS, student)} if student else {}


def failure_counts(book: Gradebook, rubric: Rubric) -> Counter[Failure]:
    """Return the failures and their counts, except where a manual mark gives all points."""
    found: Counter[Failure] = Counter()
    unmarked = book.rows(f"SELECT failures, count(*), 0 {GRADED} AND marks = 0 GROUP BY failures", rubric.sha256)
    marked = book.rows(f"SELECT failures, 1, id {GRADED} AND marks", rubric.sha256)
    for failures, count, student in chain(unmarked, marked):
        for failure in failures_in(failures, rubric, manual_units(book, student)):
            found[failure] += count
    return found


def failures_in(failures: str, rubric: Rubric, marks: Mapping[str, int]) -> Iterator[Failure]:
    """Yield the failures of a submission that are stored as JSON, except of extra credit, or where a mark gives all points."""
    for failure in map(Failure.from_json, json.loads(failures)):
        criterion = rubric.criteria[failure.position]
        is_full = marks.get(criterion.id) == int(criterion.points * UNITS_PER_POINT)
        if not (is_full or criterion.bonus):
            yield failure


def undecided_reasons(book: Gradebook, rubric: Rubric) -> tuple[tuple[str, int], ...]:
    """Return why automatic points need manual grading and how many submissions it affects, the most frequent reason first."""
    automatic = {row.position: row.id for row in rubric.criteria if row.check.function not in MANUAL_CHECKS}
    rows = book.rows(f"SELECT id, marks, undecided, statuses {GRADED} AND undecided <> '' AND pending", rubric.sha256)
    found: Counter[str] = Counter()
    for student, has_marks, reason, statuses in rows:
        marks = manual_units(book, student) if has_marks else {}
        found[reason] += any(statuses[index] == "?" and name not in marks for index, name in automatic.items())
    return tuple(sorted((+found).items(), key=lambda item: (-item[1], item[0])))
