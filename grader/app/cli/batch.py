"""grader batch: a class against a rubric, into a gradebook."""

import os
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Literal, get_args

from typer import Argument, Option

from grader.app.cli.options import (
    RUBRIC_VARIABLE,
    AnswersOption,
    ArgOption,
    FormatOption,
    PartOption,
)
from grader.app.cli.streams import TERMINAL
from grader.base.errors import GraderError
from grader.classroom.run.preloading import PRELOAD
from grader.lab.rubric.rubric_files import DEFAULT_RUBRIC
from grader.report.formats import Format, OutputFormat
from grader.workers import forks

Layout = Literal["auto", "folders", "canvas", "moodle", "blackboard", "teams", "nbgrader"]


def batch(
    paths: Annotated[
        list[Path] | None,
        Argument(
            metavar="PATH...",
            help="A folder with an entry for each student, or the zip of an LMS; name those of "
            "all sections.",
        ),
    ] = None,
    gradebook: Annotated[
        Path | None,
        Option(
            metavar="FOLDER",
            help="The gradebook, a folder; default: ID-grades, with the rubric's id.",
            show_default=False,
        ),
    ] = None,
    rubric: Annotated[
        str | None,
        Option(
            metavar="ID|FILE",
            help="The rubric: an id or a .toml file; default: that of the last run, "
            "else GRADER_RUBRIC, else lab6.",
            show_default=False,
        ),
    ] = None,
    part: PartOption = None,
    answers: AnswersOption = None,
    arg: ArgOption = None,
    jobs: Annotated[
        int | None,
        Option(metavar="N", min=1, help="Worker processes; default: one per processor."),
    ] = None,
    timeout: Annotated[
        float,
        Option(metavar="SECONDS", min=0.1, help="Limit of processor time for each submission."),
    ] = 20.0,
    roster: Annotated[
        Path | None, Option(metavar="CSV", help="The students of the class, as CSV.")
    ] = None,
    layout: Annotated[
        Layout | None,
        Option(metavar="LAYOUT", help=f"Layout of PATH: {', '.join(get_args(Layout))}."),
    ] = None,
    assignment: Annotated[
        str | None, Option(metavar="NAME", help="The assignment in the nbgrader layout.")
    ] = None,
    report_format: Annotated[
        list[Format] | None,
        Option(metavar="FORMAT", help="Write a report for each student; repeatable."),
    ] = None,
    reports: Annotated[
        Path | None,
        Option(metavar="DIR", help="The folder of the reports; default: reports in the gradebook."),
    ] = None,
    due: Annotated[
        str | None,
        Option(metavar="TIME", help="The deadline, such as 2026-11-20T23:59+01:00."),
    ] = None,
    force: Annotated[bool, Option("--force", help="Grade unchanged submissions again.")] = False,
    cluster: Annotated[
        str | None, Option(metavar="ADDRESS", help="A Dask cluster, as tcp://host:8786.")
    ] = None,
    max_size: Annotated[
        int | None, Option(metavar="BYTES", min=1, help="Maximum size of a URDF.")
    ] = None,
    ignore: Annotated[
        list[str] | None,
        Option(
            metavar="NAME",
            help="An entry of PATH that is no student's, such as template; repeatable.",
        ),
    ] = None,
    ignore_file: Annotated[
        list[Path] | None,
        Option(metavar="PATH", help="A starter file, excluded from equal work; repeatable."),
    ] = None,
    verbose: Annotated[bool, Option("--verbose", help="List all students.")] = False,
    output_format: FormatOption = OutputFormat.TERMINAL,
) -> str:
    """Grade a class into a gradebook, in parallel.

    A gradebook is a folder of plain files: grades.csv has the grades, marks/ the manual marks.
    Rerun the command to resume, or to grade new and changed submissions: it needs no PATH and no
    option again. Submissions are isolated: a crash or timeout affects only its own submission.
    Exits 0 when every submission has a result, whatever the grades.

    Examples:

      grader batch submissions.zip --roster roster.csv

      grader batch section-a section-b --report-format html

    Recipes:

      Resubmissions, a rubric fix, an interruption: rerun the same command.

      Late submissions: [late] in the rubric, --due, grader mark STUDENT deadline, columns due and
    extension.

      Unmatched submissions: add the row that the message prints to the roster, and rerun.

      A student without a submission, or with a wrong result: grader mark.

      Teams: a column group in the roster.

      See https://urdf-grader.github.io/urdf-grader/grade-a-class.html for more.
    """
    if cluster is None and paths:  # a class that is graded may need no workers
        with suppress(OSError):  # it is started again when it is needed
            # it loads what grades a submission, while this process loads what the class needs
            forks.start_server(PRELOAD)
    from grader.classroom.commands.grade_class import ClassRequest, grade_class

    for kind in report_format or ():
        if kind.needs == "identity":
            raise GraderError(f"{kind} is for one repository: use `grader grade` there")
    request = ClassRequest(
        paths=paths,
        gradebook=gradebook,
        rubric=rubric,
        part=part,
        answers=answers,
        arg=arg,
        jobs=jobs,
        timeout=timeout,
        roster=roster,
        layout=layout,
        assignment=assignment,
        report_format=report_format,
        reports=reports,
        due=due,
        force=force,
        cluster=cluster,
        max_size=max_size,
        ignore=ignore,
        ignore_file=ignore_file,
        verbose=verbose,
        output_format=output_format,
        usual_rubric=os.environ.get(RUBRIC_VARIABLE) or DEFAULT_RUBRIC,
    )
    return grade_class(request, TERMINAL)
