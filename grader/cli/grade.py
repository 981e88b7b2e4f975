"""grader grade: one submission against a rubric."""

from typing import Annotated

import typer

from grader.cli.options import DEFAULT_RUBRIC, MaxSizeOption, RubricOption
from grader.cli.suggestions import part_ids, save_formats
from grader.files.reading import URDF_LIMIT
from grader.report.formats import Format
from grader.usecases.github import refusals_told
from grader.usecases.grade import Wanted, grade_once, read_saves


def grade(
    path: Annotated[
        str,
        typer.Argument(
            metavar="PATH", help="A .urdf file, a package, a workspace, a repository, a .zip or .tar.gz, or -."
        ),
    ],
    rubric: RubricOption = DEFAULT_RUBRIC,
    expect_rubric: Annotated[
        str | None, typer.Option(metavar="SHA256", help="Refuse a rubric with another hash (see grader rubric show).")
    ] = None,
    part: Annotated[
        list[str] | None,
        typer.Option(metavar="ID", help="Grade only this part; repeatable.", autocompletion=part_ids),
    ] = None,
    output_format: Annotated[
        Format,
        typer.Option("--format", metavar="FORMAT", help=f"What is printed: {', '.join(Format)}."),
    ] = Format.TERMINAL,
    save_as: Annotated[
        list[str] | None,
        typer.Option(
            "--save",
            metavar="FORMAT=FILE",
            help="Also write a report to a file; repeatable.",
            autocompletion=save_formats,
        ),
    ] = None,
    fail_under: Annotated[
        str | None, typer.Option(metavar="N|N%", help="Exit 0 from this score on, in points or percent.")
    ] = None,
    max_size: MaxSizeOption = URDF_LIMIT,
    answers: Annotated[
        bool, typer.Option("--answers", help="Also show model answers, in terminal, markdown and json.")
    ] = False,
    is_watched: Annotated[
        bool, typer.Option("--watch", help="Grade again whenever a file changes, until Ctrl-C.")
    ] = False,
) -> int:
    """Grade one submission: what is wrong, where, and how to mend it.

    Exit codes: 0 every criterion that can be decided passed (or the score reaches --fail-under); 1 not so; 2 nothing was
    graded; 3 a fault of the grader itself.

    Examples:

      grader grade my_robot.urdf

      grader grade src/my_robot --watch

      grader grade . --format json --fail-under 80%

      grader grade lab6.zip --save markdown=report.md --save junit=report.xml
    """
    with refusals_told():
        wanted = Wanted(
            path,
            rubric,
            expect_rubric,
            tuple(part or ()),
            output_format,
            read_saves(save_as or ()),
            fail_under,
            max_size,
            answers,
        )
        if is_watched:
            from grader.usecases.watch import watch

            return watch(wanted)
        return grade_once(wanted)[1]
