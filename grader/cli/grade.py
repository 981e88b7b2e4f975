"""grader grade: one submission against a rubric."""

from decimal import Decimal, InvalidOperation
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from grader.cli.formats import Format, render
from grader.cli.options import DEFAULT_RUBRIC
from grader.cli.output import complain, emit, save
from grader.errors import GraderError
from grader.submission.files import URDF_LIMIT

if TYPE_CHECKING:
    from grader.grading.report import Report


def grade(
    path: Annotated[
        str,
        typer.Argument(
            metavar="PATH", help="A .urdf file, a package, a workspace, a repository, a .zip or .tar.gz, or -."
        ),
    ],
    rubric: Annotated[str, typer.Option(metavar="ID|FILE", help="The rubric: an id or a .toml file.")] = DEFAULT_RUBRIC,
    part: Annotated[list[str] | None, typer.Option(metavar="ID", help="Grade only this part; repeatable.")] = None,
    output_format: Annotated[Format, typer.Option("--format", help="The format on standard output.")] = Format.TERMINAL,
    save_as: Annotated[
        list[str] | None,
        typer.Option("--save", metavar="FORMAT=FILE", help="Also write a report to a file; repeatable."),
    ] = None,
    fail_under: Annotated[
        str | None, typer.Option(metavar="N|N%", help="Exit 0 from this score on, in points or percent.")
    ] = None,
    max_size: Annotated[int, typer.Option(metavar="BYTES", min=1, help="The largest URDF that is read.")] = URDF_LIMIT,
) -> int:
    """Grade one submission and say what is wrong with it, where, and how to mend it.

    Exit codes: 0 every criterion that can be decided passed (or the score reaches --fail-under); 1 not so; 2 nothing was
    graded; 3 a fault of the grader itself.

    Examples:

      grader grade my_robot.urdf

      grader grade . --format json --fail-under 80%
    """
    from grader.grading.grade import grade as grade_submission
    from grader.grading.rubric import load_rubric
    from grader.report.text import printable
    from grader.submission.submission import open_submission

    saves = [_split_save(each) for each in save_as or []]
    threshold = _Threshold(fail_under) if fail_under is not None else None
    rules = load_rubric(rubric)
    for name in part or []:
        rules.part(name)
    submission = open_submission(path, wanted=rules.urdf, package=rules.package, limit=max_size)
    report = grade_submission(rules, submission, part or [])
    for result in report.results:
        if result.traceback:
            complain(printable(f"{result.criterion.id}: {result.traceback.strip().splitlines()[-1]}"))
    for kind, file in saves:
        save(file, render(report, kind, to_file=True))
    emit(render(report, output_format, to_file=False))
    return _exit_code(report, threshold)


class _Threshold:
    """The score from which on a run counts as passed: points, or percent of what can be earned."""

    def __init__(self, text: str) -> None:
        self.is_percent = text.endswith("%")
        try:
            self.value = Decimal(text.removesuffix("%"))
        except InvalidOperation:
            self.value = Decimal("NaN")
        if not self.value.is_finite() or self.value < 0:
            raise GraderError(f"--fail-under takes points or a percentage such as 80%, not {text!r}")

    def reached(self, score: Decimal, most: Decimal) -> bool:
        return score * 100 >= self.value * most if self.is_percent else score >= self.value


def _exit_code(report: "Report", threshold: _Threshold | None) -> int:
    if report.counts("errored"):
        return 3
    if threshold is not None:
        return 0 if threshold.reached(report.score, report.max_score) else 1
    return 1 if report.counts("failed", "skipped") else 0


def _split_save(text: str) -> tuple[Format, Path]:
    kind, equals, file = text.partition("=")
    if kind not in list(Format) or not equals or file in ("", "-"):
        raise GraderError(f"--save takes FORMAT=FILE with one of the formats {', '.join(Format)}, not {text!r}")
    return Format(kind), Path(file)
