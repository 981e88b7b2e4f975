"""The report on a rubric's own reference solution."""

from grader.grading.grade import grade
from grader.grading.report import Report
from grader.grading.rubric import Rubric
from grader.submission.submission import open_submission


def grade_reference(rubric: Rubric) -> Report:
    """What the reference gets, the path of which is relative to the rubric's file; raises InputError where it cannot be read."""
    path = rubric.path.parent / rubric.reference
    return grade(rubric, open_submission(str(path), wanted=rubric.urdf, package=rubric.package))
