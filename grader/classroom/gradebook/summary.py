"""The summary of a class, for the terminal, the JSON and the class's page."""

from collections import Counter
from typing import NamedTuple

from grader.classroom.gradebook.agreement import Agreement, agreement
from grader.classroom.gradebook.attention import Attention, attention
from grader.classroom.gradebook.evidence_only import count_evidence_only
from grader.classroom.gradebook.fixes import CommonFix, common_fixes
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.identical import IdenticalWork, identical_work
from grader.classroom.gradebook.late_totals import LateTotals, late_totals
from grader.classroom.gradebook.statistics import ClassStatistics, statistics
from grader.grading.rubric import Rubric


class ClassSummary(NamedTuple):
    """The figures of a class under the newest rubric.

    `fixes` is empty unless requested. `evidence_only` counts the submissions with pictures or documents, but no `URDF`,
    or no `package`.
    """

    rubric: Rubric
    statistics: ClassStatistics
    fixes: tuple[CommonFix, ...]
    attention: Attention
    identical: tuple[IdenticalWork, ...]
    evidence_only: Counter[str]
    agreement: Agreement
    late: LateTotals


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
    )
