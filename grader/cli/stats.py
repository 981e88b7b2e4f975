"""grader stats: statistics of a class."""

from typing import Annotated, Literal

import typer

from grader.cli.options import ClassVerboseOption, DueOption, FormatOption, GradebookOption
from grader.cli.output import screen, warn
from grader.report.formats import OutputFormat

_BY = "Compare the sections, or the students of each marker."


def stats(
    gradebook: GradebookOption,
    by: Annotated[Literal["section", "marker"] | None, typer.Option(metavar="section|marker", help=_BY)] = None,
    due: DueOption = None,
    verbose: ClassVerboseOption = False,
    output_format: FormatOption = OutputFormat.TERMINAL,
) -> str:
    """Show statistics of a class: grades, criteria, mistakes, fixes.

    Manual marks are included, late penalties are not; only the totals of the students in --format json include them. The share of
    a criterion is the mean share of its points that students earned; its discrimination is the correlation of its points with the
    rest of the grade. An edit is shown with the number of students who need it: it was tried on one of their robots.

    With --by, the output compares the sections or markers of the roster instead: students, grades, late submissions, and the
    criteria that differ most. JSON has both.

    Examples:

      grader stats --gradebook lab6.db

      grader stats --gradebook lab6.db --format json

      grader stats --gradebook lab6.db --by section

    Recipes:

      Who still needs attention, by name: --verbose.

      A criterion that most students fail: a low share, and the common mistakes.

      A criterion that is wrong: "Regrade after a rubric fix" in docs/grade-a-class.md.

      Prepare the next lecture: see the edits that would fix the most.
    """
    from grader.cli.progress import progress_display
    from grader.usecases.class_summary import class_statistics

    return class_statistics(gradebook, by, due, output_format, screen(), progress_display, warn, verbose=verbose)
