"""Grade a submission from Python: see docs/python.md."""

import os
from collections.abc import Iterable
from pathlib import Path

from grader.app.hints_and_fix import add_hints
from grader.lab.grading.grade import grade as grade_opened
from grader.lab.grading.report import Report
from grader.lab.rubric.rubric import Rubric, load_rubric
from grader.lab.rubric.rubric_files import DEFAULT_RUBRIC
from grader.lab.submission.opening import open_submission


def grade(
    path: str | Path, rubric: str | Path | Rubric = DEFAULT_RUBRIC, *, parts: Iterable[str] = ()
) -> Report:
    """Grade one submission: a URDF, a package, a workspace, a repository or an archive.

    Nothing of it is executed.

    Args:
        path: The file or folder; `-` for a URDF on standard input.
        rubric: The id of a rubric that comes with the grader, the path of a rubric, or a loaded
            one.
        parts: The id or ids of the parts to grade; default: all that the submission can meet.

    Returns:
        The report that `grader grade` prints, with its hints.

    Raises:
        GraderError: The submission cannot be read, or the rubric is broken.

    >>> report = grade("rubrics/arm/arm.urdf", "arm")
    >>> report.score, report.max_score, report.pending
    (Decimal('100'), Decimal('100'), Decimal('0'))
    """
    loaded = rubric if isinstance(rubric, Rubric) else load_rubric(rubric)
    chosen = tuple(loaded.part(name).id for name in ((parts,) if isinstance(parts, str) else parts))
    submission = open_submission(os.fsdecode(path), loaded.lab, with_neighbours=True)
    report = grade_opened(loaded, submission, chosen)
    return add_hints(report, submission, None, lambda _: None, is_fixed=False)[0]
