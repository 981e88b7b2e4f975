"""grader stats, diff and gradebook: what a gradebook holds, whose grade changed between runs, the marks of two."""

import io
import sys
from pathlib import Path
from typing import Annotated, Literal

import typer

from grader.classroom.gradebook.sections import Grouping
from grader.cli.options import ClassVerboseOption, Commands, DueOption, FormatOption, GradebookOption
from grader.cli.terminal import TERMINAL, screen
from grader.report.formats import OutputFormat
from grader.usecases.writing import write_stdout

_KEEP = "Whose marks count in every conflict: those of A or B."
_FIRST = "The gradebook, in place of the first argument."
_COMPARE = "Compare the sections, or the students of each marker."


def stats(
    gradebook: GradebookOption,
    compare: Annotated[Grouping | None, typer.Option(metavar="section|marker", help=_COMPARE)] = None,
    due: DueOption = None,
    verbose: ClassVerboseOption = False,
    output_format: FormatOption = OutputFormat.TERMINAL,
) -> str:
    """Show statistics of a class: grades, criteria, mistakes, fixes.

    Manual marks are included, late penalties are not; only the grades of the students in --format json include them.
    The share of a criterion is the mean share of its points that students earned. Its discrimination says whether
    students who earned the rest of the grade earned them, too: a correlation from -1 to 1. An edit is shown with the
    number of students who need it: it was tried on one of their robots.

    With --compare, the output compares the sections or markers of the roster instead: students, grades, late
    submissions, and the criteria that differ most. JSON has both.

    Examples:

      grader stats --gradebook lab6.db

      grader stats --gradebook lab6.db --format json

      grader stats --gradebook lab6.db --compare section

    Recipes:

      Who still needs attention, by name: --verbose.

      A criterion that most students fail: a low share, and the common mistakes.

      A criterion that is wrong: fix the rubric, and rerun `grader batch`.

      Prepare the next lecture: see the edits that would fix the most.
    """
    from grader.usecases.class_summary import SummaryRequest, class_statistics

    request = SummaryRequest(output_format, with_fixes=True, verbose=verbose, by=compare, due=due)
    return class_statistics(gradebook, request, TERMINAL)


def diff(
    gradebooks: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[GRADEBOOK] [GRADEBOOK]", help="A gradebook; of two, the older one first."),
    ] = None,
    gradebook: Annotated[Path | None, typer.Option("--gradebook", metavar="FILE", help=_FIRST)] = None,
    before: Annotated[int | None, typer.Option(metavar="RUN", help="The number of the older run.")] = None,
    after: Annotated[int | None, typer.Option(metavar="RUN", help="The number of the newer run.")] = None,
    output_format: FormatOption = OutputFormat.TERMINAL,
) -> str:
    """Show whose grade changed between two runs, and why.

    Compares the last two finished runs of a gradebook, or two gradebooks. A grade changes with the submission, the
    rubric, the grader or manual marks; marks that were given after the older run count as changes. If the rubric
    changed, the output says what changed for the criteria concerned. Grades include the late penalty. Runs count from
    1.

    Examples:

      grader diff lab6.db

      grader diff --gradebook lab6.db --before 3 --after 5

      grader diff before.db after.db --format json

    Recipes:

      What a rubric fix changed: rerun `grader batch`, then compare the last two runs.

      What a resubmission or a manual mark changed: the same command; each student has the reason.
    """
    from grader.usecases.two_gradebooks import DiffRequest
    from grader.usecases.two_gradebooks import diff as compare

    books = [gradebook, *(gradebooks or ())] if gradebook is not None else gradebooks or []
    return compare(DiffRequest(tuple(books), before, after), output_format, screen())


_HELP = """Merge the manual marks of two gradebooks.

Examples:

  grader gradebook merge lab6.db lab6-lee.db
"""
gradebook = Commands(help=_HELP, no_args_is_help=True)


@gradebook.callback()
def _group() -> None:
    """Make typer treat the only command of the group as a command."""


@gradebook.command("merge")
def merge(
    first: Annotated[Path, typer.Argument(metavar="A", help="The gradebook that gets the marks.")],
    second: Annotated[
        Path, typer.Argument(metavar="B", help="The gradebook whose marks are added; it does not change.")
    ],
    keep: Annotated[Literal["first", "second"] | None, typer.Option("--keep", help=_KEEP)] = None,
) -> int:
    """Add the manual marks of gradebook B to gradebook A.

    Use it if two people have graded in copies of one gradebook. Marks that only B has are added. It is a conflict if
    both gradebooks have new, different marks of the same criterion and student. The command then lists both marks and
    asks which one counts; A keeps both. Students are matched by their key, else by their ids.

    Exit codes: 0 everything is merged; 1 a conflict is not decided, or a student of B is not in A; 2 wrong usage.

    Examples:

      grader gradebook merge lab6.db lab6-lee.db

      grader gradebook merge lab6.db lab6-lee.db --keep first
    """
    from grader.usecases.two_gradebooks import merge_gradebooks

    if isinstance(sys.stdin, io.TextIOWrapper):
        sys.stdin.reconfigure(errors="backslashreplace")  # a terminal in another encoding
    text, code = merge_gradebooks(first, second, keep, TERMINAL)
    write_stdout(text)
    return code
