"""grader export, stats and diff.

The grades of a class for an LMS, their figures, and what changed between runs.
"""

from pathlib import Path
from typing import Annotated, Literal

import typer

from grader.app.cli.options import FormatOption, GradebookOption, only_gradebook
from grader.app.cli.streams import TERMINAL, screen
from grader.classroom.lms.forms import FORMS
from grader.report.formats import OutputFormat
from grader.report.writing import write_stdout

_TARGETS = ("csv", *FORMS, "json", "html")
_INTO = "The gradebook or worksheet that the LMS exported."
_OUTPUT = (
    "The file to write (default: standard output); with html, the folder (default: the gradebook)."
)
_STRICT = (
    "Write nothing if a row or student is unmatched, a mark or time is in doubt, or the LMS "
    "would refuse a grade."
)
_PENDING = "Also export grades with points that need manual grading."
_MAXIMUM = "Export points unchanged, even if the LMS has another maximum."
_ONLY = "Omit the columns of other assignments."
_EXCEL = "Write CSV that Excel opens with a double click; a file .xlsx is a spreadsheet."
_FEEDBACK = "Write each student's report into a zip for Moodle or Canvas."


def _known_target(target: str) -> str:
    if target not in _TARGETS:
        raise typer.BadParameter(f"{target!r} is not one of {', '.join(map(repr, _TARGETS))}.")
    return target


def export(
    target: Annotated[
        str,
        typer.Argument(
            metavar="|".join(_TARGETS), callback=_known_target, help="The format of the grades."
        ),
    ],
    gradebook: GradebookOption,
    into: Annotated[Path | None, typer.Option(metavar="LMS-FILE", help=_INTO)] = None,
    output: Annotated[Path | None, typer.Option(metavar="FILE|DIR", help=_OUTPUT)] = None,
    strict: Annotated[bool, typer.Option("--strict", help=_STRICT)] = False,
    column: Annotated[
        str, typer.Option(metavar="TITLE", help="The grade's column, if it is ambiguous.")
    ] = "",
    pending_as_zero: Annotated[bool, typer.Option("--pending-as-zero", help=_PENDING)] = False,
    any_maximum: Annotated[bool, typer.Option("--any-maximum", help=_MAXIMUM)] = False,
    only: Annotated[bool, typer.Option("--only", help=_ONLY)] = False,
    excel: Annotated[bool, typer.Option("--excel", help=_EXCEL)] = False,
    feedback: Annotated[Path | None, typer.Option(metavar="ZIP", help=_FEEDBACK)] = None,
    feedback_format: Annotated[
        Literal["html", "markdown"],
        typer.Option(metavar="html|markdown", help="The format of these reports."),
    ] = "html",
) -> int:
    """Export the grades for a spreadsheet, an LMS or a browser.

    A grade is the final mark of `grader mark STUDENT grade`, else the sum of automatic points and
    manual marks minus the late penalty. For Canvas, Moodle, Blackboard and Brightspace, give the
    file that the LMS exported with --into. Only the grade cells (and Moodle's feedback) change.
    Rows without a grade are omitted, so that the import overwrites no other grade. The maximum in
    the file must be the rubric's. Exits 1 if --strict writes nothing. With html, the folder
    contains a page for each student, and the class's page index.html, which is for graders only.

    Examples:

      grader export csv --excel --output grades.csv

      grader export canvas --into lms.csv > upload.csv

      grader export moodle --feedback feedback.zip

    Recipes:

      Publish in Canvas: --into and --only, then import the file. "Upload Submissions" takes the zip
    of --feedback.

      Publish in Moodle: --into, then "Upload grading worksheet".

      Feedback in Moodle: --feedback, then "Upload multiple feedback files in a zip".
    """
    from grader.classroom.commands.export_grades import ExportRequest
    from grader.classroom.commands.export_grades import export as export_grades

    request = ExportRequest(
        target=target,
        gradebook=gradebook,
        into=into,
        output=output,
        strict=strict,
        column=column,
        pending_as_zero=pending_as_zero,
        any_maximum=any_maximum,
        only=only,
        excel=excel,
        feedback=feedback,
        feedback_format=feedback_format,
    )
    data, code = export_grades(request, TERMINAL)
    write_stdout(data)
    return code


_FIRST = "The gradebook, in place of the first argument."
_VERBOSE = "Name all students who need attention (terminal)."


def stats(
    gradebook: GradebookOption,
    verbose: Annotated[bool, typer.Option("--verbose", help=_VERBOSE)] = False,
    output_format: FormatOption = OutputFormat.TERMINAL,
) -> str:
    """Show statistics of a class: grades, mistakes, equal work.

    A grade is the one that is published: after marks, adjustments and the late penalty. The share
    of a criterion is the mean share of its points that students earned.

    Examples:

      grader stats

      grader stats --format json

    Recipes:

      Who still needs attention, by name: --verbose.

      A criterion that is wrong: fix the rubric, and rerun `grader batch --rubric FILE`.
    """
    from grader.classroom.reports.class_figures import class_statistics

    return class_statistics(gradebook, output_format, TERMINAL, verbose=verbose)


def diff(
    gradebooks: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[GRADEBOOK] [GRADEBOOK]", help="A gradebook; of two, the older one first."
        ),
    ] = None,
    gradebook: Annotated[
        Path | None, typer.Option("--gradebook", metavar="FOLDER", help=_FIRST)
    ] = None,
    before: Annotated[
        int | None, typer.Option(metavar="RUN", help="The number of the older run.")
    ] = None,
    after: Annotated[
        int | None, typer.Option(metavar="RUN", help="The number of the newer run.")
    ] = None,
    output_format: FormatOption = OutputFormat.TERMINAL,
) -> str:
    """Show whose grade changed between two runs, and why.

    Compares the current grades with the newest run that had other ones, or two gradebooks. A grade
    changes with the submission, the rubric, the grader, marks, the roster or the deadline. It is
    provisional while something needs manual grading. Runs count from 1.

    Examples:

      grader diff

      grader diff --before 3 --after 5

      grader diff lab6-monday lab6-grades --format json

    Recipes:

      Whose grade a new rubric changes: rerun `grader batch --rubric FILE`, then compare.

      What changed since the grades were published: --before with the number of that run.
    """
    from grader.classroom.reports.class_figures import compare

    if gradebook is not None:
        books = [gradebook, *(gradebooks or ())]
    else:
        books = gradebooks or [only_gradebook()]
    return compare(tuple(books), before, after, output_format, screen())
