"""The summary of a class: who needs attention, how many are late or have only evidence, how two graders agree."""

import json
from collections import Counter
from collections.abc import Mapping
from decimal import Decimal
from typing import NamedTuple

from grader.classroom.gradebook.agreement import Agreement, agreement
from grader.classroom.gradebook.attention import Attention, attention
from grader.classroom.gradebook.criterion_statistics import ChoiceCount, choice_counts
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.hints import CommonFix, common_fixes
from grader.classroom.gradebook.identical import IdenticalWork, identical_work
from grader.classroom.gradebook.statistics import ClassStatistics, statistics
from grader.files.names import ROBOT_ENDINGS
from grader.grading.record import graded_submission_from
from grader.grading.rubric import Rubric
from grader.text import named

_QUERY = "SELECT result, urdf, files FROM grade WHERE verdict = 'graded' AND rubric = ? AND NOT is_gone"


def count_evidence_only(book: Gradebook, rubric: Rubric) -> Counter[str]:
    """Return how many submissions have evidence, but no `URDF`, or one but no `package`, that this rubric grades."""
    needed = {"URDF": ("urdf", "robot"), "package": ("package",)}
    subjects = {row.check.subject for row in rubric.criteria}
    graded = {kind for kind, names in needed.items() if subjects.intersection(names)}
    package = {row.position for row in rubric.criteria if row.check.subject == "package"}
    # A record takes long to read, so those of most classes are not: with a URDF and a package of the lab, or a URDF on
    # its own.
    found = [
        result
        for result, urdf, files in list(book.rows(_QUERY, rubric.sha256))
        if not urdf or not (_is_single(files) or package - book.outcomes(result).keys())
    ]
    lacking = (graded_submission_from(book.record(result)).lacks[:1] for result in found)
    return Counter(kind for kinds in lacking for kind in kinds if kind in graded)


def _is_single(files: str) -> bool:
    paths = json.loads(files)[0]
    return len(paths) == 1 and paths[0].lower().endswith(ROBOT_ENDINGS)


_MAYBE_LATE = (
    "result IS NOT NULL AND final IS NULL AND NOT is_excused AND (is_late OR submitted <> '' OR days_late > 0)"
)
_TIMES = "SELECT is_late OR submitted <> '' OR days_late IS NOT NULL, roster_entry FROM grade WHERE result IS NOT NULL"


class LateTotals(NamedTuple):
    """How many submissions are late, the points that they lose in total, and the least and the most that one loses.

    `unknown` counts the submissions if a deadline has no effect, because nothing says of any of them when it was
    submitted.
    """

    students: int
    lost: Decimal
    least: Decimal
    most: Decimal
    unknown: int = 0


def late_totals(grades: Grades) -> LateTotals:
    """Return the totals of a gradebook, without students who have a final mark or an excuse: they lose nothing."""
    lost = [-grade.late.points for grade in grades.where(_MAYBE_LATE) if grade.late.days]
    zero = Decimal(0)
    unknown = _count_undated(grades) if grades.has_deadline else 0
    return LateTotals(len(lost), sum(lost, zero), min(lost, default=zero), max(lost, default=zero), unknown)


def _count_undated(grades: Grades) -> int:
    """Return how many submissions there are; 0 if it is known of one when it was submitted, or whether it is late."""
    rows = list(grades.book.rows(_TIMES))
    is_known = any(has_time or (entry and json.loads(entry).get("is_late") is not None) for has_time, entry in rows)
    return 0 if is_known else len(rows)


class ClassSummary(NamedTuple):
    """The figures of a class under the newest rubric.

    `fixes` is empty unless requested. `evidence_only` counts the submissions with pictures or documents, but no `URDF`,
    or no `package`. `names` has the name and key of each student, by key.
    """

    rubric: Rubric
    statistics: ClassStatistics
    fixes: tuple[CommonFix, ...]
    attention: Attention
    identical: tuple[IdenticalWork, ...]
    evidence_only: Counter[str]
    agreement: Agreement
    late: LateTotals
    choices: tuple[ChoiceCount, ...]
    names: Mapping[str, str]


def summary_of(grades: Grades, *, with_fixes: bool) -> ClassSummary:
    """Return the summary of a gradebook; raises InputError if nothing was graded.

    `with_fixes` includes the edits that would gain points, as far as hints have been searched.
    """
    book, rubric = grades.book, grades.newest_rubric()
    return ClassSummary(
        rubric,
        statistics(book, rubric),
        common_fixes(book, rubric) if with_fixes else (),
        attention(grades),
        tuple(identical_work(book)),
        count_evidence_only(book, rubric),
        agreement(book, rubric),
        late_totals(grades),
        choice_counts(book, rubric),
        {student.key: named(student.key, student.name) for student in book.students()},
    )
