"""grader mark: a manual mark for one criterion of a submission."""

from typing import Annotated

import typer

from grader.cli.options import ByOption, GradebookOption
from grader.cli.output import warn


def mark(
    submission: Annotated[
        str, typer.Argument(metavar="SUBMISSION", help="The student's key, login, email address or name.")
    ],
    criterion: Annotated[
        str, typer.Argument(metavar="CRITERION", help="The id of the criterion, such as answer-floating-link.")
    ],
    points: Annotated[str, typer.Argument(metavar="POINTS", help="The points, or - to withdraw a mark.")],
    gradebook: GradebookOption,
    comment: Annotated[str, typer.Option(metavar="TEXT", help="A reason, which the student reads.")] = "",
    by: ByOption = "",
) -> str:
    """Give a manual mark for one criterion of a submission.

    Use it for criteria that need manual grading, or to override a check. Later runs keep the mark. A later mark replaces it;
    the gradebook keeps both.

    Examples:

      grader mark alice answer-floating-link 3.5 --gradebook lab6.db

      grader mark alice lidar-frame 6 --gradebook lab6.db --comment "fixed it"

      grader mark alice lidar-frame - --gradebook lab6.db
    """
    from grader.usecases.manual_marks import give_mark

    return give_mark(gradebook, submission, criterion, points, by, comment, warn) + "\n"
