"""grader mark: what a person says of one criterion of one submission."""

from typing import Annotated

import typer

from grader.cli.options import GradebookOption
from grader.cli.output import complain, emit

ByOption = Annotated[str, typer.Option("--by", metavar="NAME", help="Your name, for reports; default: none.")]


def mark(
    submission: Annotated[str, typer.Argument(metavar="SUBMISSION", help="A student's key, login, address or name.")],
    criterion: Annotated[str, typer.Argument(metavar="CRITERION", help="Its id, such as answer-floating-link.")],
    points: Annotated[str, typer.Argument(metavar="POINTS", help="The points, or - to take a mark back.")],
    gradebook: GradebookOption,
    comment: Annotated[str, typer.Option(metavar="TEXT", help="Why; the student reads it.")] = "",
    by: ByOption = "",
) -> int:
    """Give points for one criterion of one submission by hand.

    That is for what waits for a person, or in place of what the check says. A mark stays, whatever is graded again; a later one goes before it, and all are kept.

    Examples:

      grader mark alice answer-floating-link 3.5 --gradebook lab6.db

      grader mark alice lidar-frame 6 --gradebook lab6.db --comment "mended it"

      grader mark alice lidar-frame - --gradebook lab6.db
    """
    from grader.classroom.gradebook.gradebook import Gradebook
    from grader.classroom.gradebook.grades import Grades
    from grader.classroom.gradebook.marks import criterion_of, read_points
    from grader.classroom.gradebook.marks import mark as add_mark
    from grader.report.points import points_words
    from grader.report.review import mark_words
    from grader.text import printable

    with Gradebook(gradebook) as book:
        standings = Grades(book)
        standing = standings.find(submission)
        asked = criterion_of(
            standings.rubric(standing.rubric) if standing.rubric else standings.newest_rubric(), criterion
        )
        before = add_mark(book, standing, asked, read_points(points, asked), by, comment)
        now = standings.find(standing.student.key)
    waits = f"; waiting for a person: {points_words(now.pending)}" if now.pending else ""
    emit(printable(f"{now.student.key}: {points_words(now.score)} of {points_words(now.out_of)} points{waits}") + "\n")
    if before is not None and before.points is not None:
        complain(f"this replaces the newest mark of {asked.id}: {mark_words(before)}")
    return 0
