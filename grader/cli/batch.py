"""grader batch: a whole class against a rubric, into a gradebook."""

from pathlib import Path
from typing import Annotated

import typer

from grader.cli.options import (
    DEFAULT_RUBRIC,
    ClassFormat,
    DueOption,
    FormatOption,
    GradebookOption,
    Layout,
    MaxSizeOption,
    RubricOption,
)
from grader.errors import GraderError
from grader.files.reading import URDF_LIMIT
from grader.report.formats import Format


def batch(
    path: Annotated[
        Path, typer.Argument(metavar="PATH", help="A folder with a child for each student, or an LMS's zip.")
    ],
    gradebook: GradebookOption,
    rubric: RubricOption = DEFAULT_RUBRIC,
    jobs: Annotated[
        int | None, typer.Option(metavar="N", min=1, help="Worker processes; one a processor if not told.")
    ] = None,
    timeout: Annotated[float, typer.Option(metavar="SECONDS", min=0.1, help="The longest that one may take.")] = 60.0,
    roster: Annotated[Path | None, typer.Option(metavar="CSV", help="Who is in the class.")] = None,
    layout: Annotated[
        Layout, typer.Option(metavar="LAYOUT", help=f"How PATH is laid out: {', '.join(Layout)}.")
    ] = Layout.AUTO,
    assignment: Annotated[str, typer.Option(metavar="NAME", help="The assignment, in nbgrader's layout.")] = "",
    reports: Annotated[Path | None, typer.Option(metavar="DIR", help="Write a report for each student here.")] = None,
    report_format: Annotated[
        list[Format] | None, typer.Option(metavar="FORMAT", help="The format of these; repeatable.")
    ] = None,
    csv: Annotated[Path | None, typer.Option(metavar="FILE", help="Also write the grades as CSV.")] = None,
    due: DueOption = None,
    force: Annotated[bool, typer.Option("--force", help="Grade all again, also what has not changed.")] = False,
    add: Annotated[
        bool, typer.Option("--add", help="Add to the gradebook, even if it is of another class, assignment or rubric.")
    ] = False,
    cluster: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Grade on a Dask cluster: tcp://host:8786.")
    ] = None,
    max_size: MaxSizeOption = URDF_LIMIT,
    output_format: FormatOption = ClassFormat.TERMINAL,
) -> int:
    """Grade a whole class into a gradebook, many at a time.

    A second time only what is new or changed is graded. Exits 0 when every submission has a result, whatever the marks. One that cannot be read, hangs or breaks the grader costs
    nobody else anything, and is listed.

    Examples:

      grader batch submissions.zip --gradebook lab6.db --roster roster.csv

      grader batch class/ --gradebook lab6.db --reports reports --csv grades.csv
    """
    from grader.usecases.grade_class import Wanted, grade_class  # what grades a class is loaded only for one

    for kind in report_format or ():
        if kind.needs == "identity":
            raise GraderError(f"{kind} is the result of one repository: `grader grade` writes it there")
    output = Wanted(reports, tuple(report_format or [Format.TERMINAL]), csv, output_format)
    grade_class(
        path,
        gradebook,
        rubric,
        output,
        jobs=jobs,
        timeout=timeout,
        roster=roster,
        layout=layout.value,
        assignment=assignment,
        due=due,
        force=force,
        cluster=cluster,
        add=add,
        max_size=max_size,
    )
    return 0
