"""grader export: everyone's current grades, for a spreadsheet or an LMS."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from grader.cli.options import DueOption, GradebookOption
from grader.cli.output import complain, emit
from grader.errors import GraderError
from grader.text import printable_path
from grader.usecases.writing import is_output, is_same, not_over, refuse_links, save_bytes

if TYPE_CHECKING:
    from grader.classroom.gradebook.grades import Grades


class Target(StrEnum):
    """Where grades go."""

    CSV = "csv"
    CANVAS = "canvas"
    MOODLE = "moodle"
    JSON = "json"


def export(
    target: Annotated[Target, typer.Argument(metavar="csv|canvas|moodle|json", help="Where the grades go.")],
    gradebook: GradebookOption,
    into: Annotated[
        Path | None, typer.Option(metavar="LMS-FILE", help="The gradebook or worksheet, as the LMS has exported it.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Where it is written; standard output if not told.")
    ] = None,
    strict: Annotated[
        bool, typer.Option("--strict", help="Write nothing if a row has no match, on either side.")
    ] = False,
    due: DueOption = None,
    column: Annotated[str, typer.Option(metavar="TITLE", help="The column of the grade, if it is not plain.")] = "",
    feedback_column: Annotated[str, typer.Option(metavar="TITLE", help="The column of the feedback, in Moodle.")] = "",
    pending_as_zero: Annotated[
        bool, typer.Option("--pending-as-zero", help="Also give grades of which points still wait for a person.")
    ] = False,
    any_maximum: Annotated[
        bool,
        typer.Option("--any-maximum", help="Write the points as they are, though the LMS counts to another maximum."),
    ] = False,
) -> int:
    """Write everyone's grade, for a spreadsheet, Canvas or Moodle.

    That is the checks' points with the marks by hand, less what being late costs. For Canvas and Moodle fill a file that the LMS has exported: only the cells of the grade (and Moodle's feedback) change,
    and rows without a grade are left out, so that no grade that is there is lost. The maximum there has to be the rubric's.
    Exits 1 if --strict finds no match.

    Examples:

      grader export csv --gradebook lab6.db --output grades.csv

      grader export canvas --gradebook lab6.db --into canvas.csv > upload.csv
    """
    from grader.classroom.gradebook.gradebook import Gradebook
    from grader.classroom.gradebook.grades import Grades
    from grader.classroom.gradebook.lateness import read_time

    if (into is None) == (target in (Target.CANVAS, Target.MOODLE)):
        raise GraderError(
            f"export {target.value} fills a file that the LMS has exported: name it with --into"
            if into is None
            else f"export {target.value} fills no file: leave --into out"
        )
    if output is not None:
        not_over(output, gradebook)
    if into is not None and (is_output(into) if output is None else is_same(output, into)):
        raise GraderError(
            f"cannot write {printable_path(into)}: --into reads it, and rows without a grade would be lost; name another file"
        )
    with Gradebook(gradebook) as book:
        classes = {run.source for run in book.runs()}
        if output is not None:
            refuse_links(output, tuple(classes))
        standings = Grades(book, read_time(due) if due else None)
        if into is None:
            data = _plain(target, standings)
        else:
            from grader.usecases.export import Filling, fill, preflight_lines

            filling = Filling(into, column, feedback_column, pending_as_zero, any_maximum)
            filled = fill(target is Target.MOODLE, standings, filling)
            for line in preflight_lines(filled.preflight):
                complain(line)
            if strict and not filled.preflight.matches:
                complain("nothing was written: --strict, and not everything has a match")
                return 1
            data = filled.data
    if output is None:
        emit(data)
    else:
        save_bytes(output, data, tuple(classes))
    return 0


def _plain(target: Target, standings: "Grades") -> bytes:
    if target is Target.CSV:
        from grader.usecases.export import grades_csv

        return grades_csv(standings).encode()
    from grader.cli.class_text import class_text
    from grader.cli.options import ClassFormat

    return class_text(standings, ClassFormat.JSON).encode()
