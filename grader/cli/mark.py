"""grader mark: a manual mark for one criterion, or for the whole submission."""

from typing import Annotated

import typer

from grader.cli.options import ByOption, GradebookOption
from grader.cli.output import warn


def mark(
    student: Annotated[str, typer.Argument(metavar="STUDENT", help="The student's key, login, email address or name.")],
    criterion: Annotated[
        str,
        typer.Argument(
            metavar="CRITERION|total", help="The id of the criterion, such as answer-floating-link, or total."
        ),
    ],
    gradebook: GradebookOption,
    points: Annotated[
        str | None, typer.Argument(metavar="[POINTS]", help="The points, or - to withdraw a mark.")
    ] = None,
    comment: Annotated[
        str, typer.Option(metavar="TEXT", help="For the student; #2 repeats comment 2 of --comments.")
    ] = "",
    excused: Annotated[bool, typer.Option("--excused", help="With total: the student needs no grade.")] = False,
    undo: Annotated[bool, typer.Option("--undo", help="Restore the mark before the newest one.")] = False,
    second: Annotated[
        bool, typer.Option("--second", help="Record a second opinion, which changes no grade; needs --by.")
    ] = False,
    comments: Annotated[bool, typer.Option("--comments", help="List the earlier comments of the criterion.")] = False,
    by: ByOption = "",
) -> str:
    """Give a manual mark for a criterion or the whole submission.

    Use it for criteria that need manual grading, or to override a check. `total` gives a final mark, also without a submission.
    A comment without POINTS changes no points. Later runs keep the mark. A later mark replaces it; the gradebook keeps both.

    Examples:

      grader mark alice answer-floating-link 3.5 --gradebook lab6.db

      grader mark alice lidar-frame 6 --gradebook lab6.db --comment "fixed it"

      grader mark alice lidar-frame - --gradebook lab6.db

      grader mark alice lidar-frame --undo --gradebook lab6.db

      grader mark bob total 0 --gradebook lab6.db --comment "no submission"

      grader mark carol total --excused --gradebook lab6.db --comment "ill"

      grader mark alice total --gradebook lab6.db --comment "see me in the lab"

      grader mark alice lidar-frame 3 --gradebook lab6.db --second --by Lee
    """
    from grader.usecases.manual_marks import MarkRequest, give_mark

    request = MarkRequest(student, criterion, points, comment, by, excused, undo, second, comments)
    return give_mark(gradebook, request, warn)
