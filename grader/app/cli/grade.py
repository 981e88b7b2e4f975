"""grader grade: one submission against a rubric."""

import os
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from grader.app.cli.options import (
    AnswersOption,
    ArgOption,
    MaxSizeOption,
    PartOption,
    RubricOption,
    SaveOption,
)
from grader.app.cli.streams import TERMINAL, screen, warn, write_stderr
from grader.app.commands.grade_submission import grade_and_save
from grader.app.grading import GradeRequest, GradeRun
from grader.base.errors import GraderError
from grader.files.reading import URDF_LIMIT
from grader.lab.rubric.hint_levels import HintLevel
from grader.lab.rubric.rubric_files import DEFAULT_RUBRIC
from grader.report.formats import Format, render
from grader.report.writing import write_stdout


def grade(
    path: Annotated[
        str,
        Argument(
            metavar="[PATH]",
            help="A .urdf file, package, workspace, repository, .zip or .tar.gz, or - for "
            "standard input.",
            show_default="the current folder",
        ),
    ] = ".",
    rubric: RubricOption = DEFAULT_RUBRIC,
    expect_rubric: Annotated[
        str | None,
        Option(
            metavar="SHA256", help="Refuse a rubric with another hash (see grader rubric show)."
        ),
    ] = None,
    part: PartOption = None,
    output_format: Annotated[
        Format,
        Option("--format", metavar="FORMAT", help=f"Output format: {', '.join(Format)}."),
    ] = Format.TERMINAL,
    save: SaveOption = None,
    fail_under: Annotated[
        str | None,
        Option(metavar="N|N%", help="Exit 0 if the score reaches this, in points or percent."),
    ] = None,
    max_size: MaxSizeOption = URDF_LIMIT,
    arg: ArgOption = None,
    answers: AnswersOption = None,
    verbose: Annotated[
        bool, Option("--verbose", help="Also show what passed, answers and notes (terminal).")
    ] = False,
    hints: Annotated[
        HintLevel | None,
        Option(metavar="LEVEL", help="Maximum detail of hints: none, place, cause or edit."),
    ] = None,
    fix: Annotated[
        Path | None,
        Option(
            metavar="FILE|FOLDER",
            help="Write the graded file with all proven edits to a file; of a folder or an "
            "archive, the changed files to a folder.",
        ),
    ] = None,
    watch: Annotated[
        bool,
        Option(
            "--watch",
            help="Grade again after every change, until Ctrl-C; grader view shows the robot.",
        ),
    ] = False,
) -> int:
    """Grade a submission against a rubric.

    The report explains every lost point with file and line.

    Exit codes: 0 all automatic criteria passed (or the score reaches --fail-under); 1 otherwise; 2
    nothing was graded; 3 a check is faulty.

    Examples:

      grader grade

      grader grade my_robot.urdf

      grader grade src/my_robot --watch

      grader grade . --format json --fail-under 80%

      grader grade lab6.zip --save markdown=report.md --save junit=report.xml
    """
    request = GradeRequest(
        path=path,
        rubric=rubric,
        expect_rubric=expect_rubric,
        part=part,
        output_format=output_format,
        save=save,
        fail_under=fail_under,
        max_size=max_size,
        arg=arg,
        answers=answers,
        verbose=verbose,
        hints=hints,
        fix=fix,
        watch=watch,
    )
    try:
        if request.watch:
            from grader.app.commands.watch import watch as grade_on_change

            grade_on_change(request, TERMINAL)
        return _grade_once(request)
    except GraderError as error:
        if _is_github_job():
            from grader.app.commands.github import (
                publish_refusal,  # late: most runs are no such job
            )

            publish_refusal(str(error), write_stderr, warn)
        raise


def _grade_once(request: GradeRequest) -> int:
    """Grade, and print the report; in a job of GitHub Actions also publish it.

    Return the exit code.
    """

    def show(run: GradeRun) -> None:
        text = render(
            run.report,
            request.output_format,
            run.base,
            screen(run.base.here),
            verbose=request.verbose,
        )
        write_stdout(
            text
            if request.output_format.needs == "console"
            else text.encode("utf-8", "backslashreplace")
        )

    run = grade_and_save(request, warn, show)
    if _is_github_job():
        from grader.app.commands.github import publish_report  # late: most runs are no such job

        annotate = write_stderr if request.output_format is not Format.GITHUB else None
        publish_report(run.report, run.base, annotate, warn)
    elif run.reason:
        warn(run.reason)
    return run.exit_code


def _is_github_job() -> bool:
    """Return whether this process runs in a job of GitHub Actions."""
    return os.environ.get("GITHUB_ACTIONS") == "true"
