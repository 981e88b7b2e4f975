"""grader batch: a class against a rubric, into a gradebook."""

from contextlib import suppress
from pathlib import Path
from typing import Annotated, Literal, get_args

import typer

from grader.classroom.run import forks
from grader.cli.options import (
    AnswersOption,
    ClassVerboseOption,
    DueOption,
    FormatOption,
    GradebookOption,
    MaxSizeOption,
    PartOption,
    rubric_ids,
)
from grader.cli.terminal import TERMINAL
from grader.errors import GraderError
from grader.files.reading import URDF_LIMIT
from grader.report.formats import Format, OutputFormat

Layout = Literal["auto", "folders", "canvas", "moodle", "teams", "nbgrader"]
_PATH = "A folder with an entry for each student, or the zip of an LMS."
_ADD = "Add to the gradebook even if its class, assignment, roster or rubric is another one."
_RUBRIC = "The rubric: an id or a .toml file; default: that of the last run into the gradebook, else lab6."
_IGNORE = "A robot or package that the course handed out: not identical work; repeatable."
_TIMEOUT = "Time limit for each submission."


def batch(
    path: Annotated[Path, typer.Argument(metavar="PATH", help=_PATH)],
    gradebook: GradebookOption,
    rubric: Annotated[
        str | None, typer.Option(metavar="ID|FILE", help=_RUBRIC, show_default=False, autocompletion=rubric_ids)
    ] = None,
    part: PartOption = None,
    answers: AnswersOption = None,
    jobs: Annotated[
        int | None, typer.Option(metavar="N", min=1, help="Worker processes; default: one per processor.")
    ] = None,
    timeout: Annotated[float, typer.Option(metavar="SECONDS", min=0.1, help=_TIMEOUT)] = 60.0,
    roster: Annotated[Path | None, typer.Option(metavar="CSV", help="The students of the class, as CSV.")] = None,
    layout: Annotated[
        Layout, typer.Option(metavar="LAYOUT", help=f"Layout of PATH: {', '.join(get_args(Layout))}.")
    ] = "auto",
    assignment: Annotated[str, typer.Option(metavar="NAME", help="The assignment in the nbgrader layout.")] = "",
    reports: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write a report for each student into this folder.")
    ] = None,
    report_format: Annotated[
        list[Format] | None, typer.Option(metavar="FORMAT", help="Format of these reports; repeatable.")
    ] = None,
    csv: Annotated[Path | None, typer.Option(metavar="FILE", help="Also write the grades as CSV.")] = None,
    due: DueOption = None,
    force: Annotated[bool, typer.Option("--force", help="Grade unchanged submissions again.")] = False,
    add: Annotated[bool, typer.Option("--add", help=_ADD)] = False,
    cluster: Annotated[str | None, typer.Option(metavar="ADDRESS", help="A Dask cluster, as tcp://host:8786.")] = None,
    max_size: MaxSizeOption = URDF_LIMIT,
    ignore_file: Annotated[list[Path] | None, typer.Option(metavar="PATH", help=_IGNORE)] = None,
    verbose: ClassVerboseOption = False,
    output_format: FormatOption = OutputFormat.TERMINAL,
) -> str:
    """Grade a class into a gradebook, in parallel.

    Rerun the same command to resume, or to grade new and changed submissions. Submissions are isolated: a crash or
    timeout affects only its own submission. Exits 0 when every submission has a result, whatever the grades.

    Examples:

      grader batch submissions.zip --gradebook lab6.db --roster roster.csv

      grader batch class/ --gradebook lab6.db --reports reports --csv grades.csv

      grader batch section-b.zip --gradebook lab6.db --add

    Recipes:

      Resubmissions, a rubric fix, an interruption: rerun the same command.

      Late submissions: [late] in the rubric, --due, grader extend, or columns due and extension in the roster.

      Unmatched submissions: add the student's login, email address or LMS number to the roster file, and rerun.

      A student without a submission, or with a wrong result: grader mark.

      Teams: a column group in the roster.

      See https://urdf-grader.github.io/urdf-grader/grade-a-class.html for more.
    """
    options = locals()  # named like the fields of the request
    if cluster is None and path.exists() and not gradebook.exists():  # a class that is graded may need no workers
        with suppress(OSError):  # it is started again when it is needed
            forks.start_server()  # it loads what grades a submission, while this process loads what the class needs
    from grader.usecases.grade_class import ClassRequest, grade_class

    formats = tuple(report_format or [Format.TERMINAL])
    for kind in formats:
        if kind.needs == "identity":
            raise GraderError(f"{kind} is for one repository: use `grader grade` there")
    lists = {"part": tuple(part or ()), "ignore_file": tuple(ignore_file or ()), "report_format": formats}
    return grade_class(ClassRequest(**options | lists), TERMINAL)
