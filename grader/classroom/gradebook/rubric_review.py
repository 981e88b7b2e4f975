"""What a rubric did to a class, before grades go out.

It finds criteria that all students pass or fail, or that need manual grading, and equal robots with
different points.
"""

from collections.abc import Sequence
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.statistics import ClassStatistics, CriterionFigures, statistics
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.lab.checks.manual import MANUAL_CHECKS

_MIN_DECIDED = 3  # of fewer submissions nothing is said
_Criteria = Sequence[CriterionFigures]


class _UnlikeGrades(NamedTuple):
    """Students with equal robots and unlike grades.

    It has their automatic points of the robot, and the criteria that differ.
    """

    students: Sequence[str]
    equal: str  # what is equal: "the same file"
    criteria: Sequence[str]


class RubricReview(NamedTuple):
    """What an instructor should look at before grades go out.

    `figures` has those of the class, for how many passed, failed or are open.
    """

    figures: ClassStatistics
    submissions: int  # that were graded
    all_pass: _Criteria
    all_fail: _Criteria
    errored: _Criteria
    undecided: _Criteria  # those that need manual grading most first
    unlike: Sequence[_UnlikeGrades]


def _automatic(figures: ClassStatistics) -> list[CriterionFigures]:
    """Return the criteria that a program decides, and that are not adjusted."""
    rows = []
    for row in figures.criteria:
        is_manual = row.criterion.check.function in MANUAL_CHECKS
        if not is_manual and not row.criterion.adjustment:
            rows.append(row)
    return rows


def review_rubric(book: Gradebook) -> RubricReview:
    """Return what stands out in the results of a class."""
    grades = [grade for grade in book if grade.stored and not grade.is_gone]
    figures = statistics(book, grades)
    automatic = _automatic(figures)
    passing = []
    failing = []
    for row in automatic:
        counts = row.counts
        if counts["decided"] < _MIN_DECIDED:
            continue
        if counts["passed"] == counts["decided"]:
            passing.append(row)
        elif counts["failed"] and not counts["passed"]:
            failing.append(row)
    undecided = [row for row in automatic if row.counts["pending"]]
    errored = [row for row in automatic if row.counts["errored"]]
    return RubricReview(
        figures=figures,
        submissions=len(grades),
        all_pass=passing,
        all_fail=failing,
        errored=errored,
        undecided=sorted(undecided, key=lambda row: -row.counts["pending"]),
        unlike=_unlike_grades(book, figures, grades),
    )


def _unlike_grades(
    book: Gradebook, figures: ClassStatistics, grades: Sequence[StudentGrade]
) -> list[_UnlikeGrades]:
    """Return the groups of students whose robots are equal, but not their criteria.

    The criteria are those of the robot.
    """
    of_robot = [row.id for row in book.criteria if row.check.is_of_robot]
    by_key = {grade.student.key: grade for grade in grades}
    unlike = []
    for work in figures.equal:
        if work.equal not in ("the same file", "the same robot"):
            continue
        stored = [by_key[key].stored for key in work.students if key in by_key]
        results = [one.results for one in stored if one]
        different = []
        for name in of_robot:
            statuses = {one[name][1] for one in results if name in one}
            if len(statuses) > 1:
                different.append(name)
        if different:
            unlike.append(_UnlikeGrades(work.students, work.equal, tuple(different)))
    return unlike
