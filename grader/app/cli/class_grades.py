"""grader export, stats and diff.

The grades of a class for an LMS, their figures, and what changed between runs.
"""

from pathlib import Path
from typing import Annotated, Literal

import typer
from typer import Argument, Option

from grader.app.cli.options import FormatOption, GradebookOption, only_gradebook
from grader.app.cli.streams import TERMINAL, screen
from grader.classroom.lms.forms import FORMS
from grader.report.formats import OutputFormat
from grader.report.writing import write_stdout

_TARGETS = ("csv", *FORMS, "json", "html")


def _known_target(target: str) -> str:
    if target not in _TARGETS:
        raise typer.BadParameter(f"{target!r} is not one of {', '.join(map(repr, _TARGETS))}.")
    return target


def export(
    target: Annotated[
        str,
        Argument(
            metavar="|".join(_TARGETS), callback=_known_target, help="The format of the grades."
        ),
    ],
    gradebook: GradebookOption,
    into: Annotated[
        Path | None,
        Option(metavar="LMS-FILE", help="The gradebook or worksheet that the LMS exported."),
    ] = None,
    output: Annotated[
        Path | None,
        Option(
            metavar="FILE|DIR",
            help="The file to write (default: standard output); with html, the folder "
            "(default: the gradebook).",
        ),
    ] = None,
    strict: Annotated[
        bool,
        Option(
            "--strict",
            help="Write nothing if a row or student is unmatched, a mark or time is in doubt, "
            "or the LMS would refuse a grade.",
        ),
    ] = False,
    column: Annotated[
        str, Option(metavar="TITLE", help="The grade's column, if it is ambiguous.")
    ] = "",
    pending_as_zero: Annotated[
        bool,
        Option(
            "--pending-as-zero", help="Also export grades with points that need manual grading."
        ),
    ] = False,
    any_maximum: Annotated[
        bool,
        Option(
            "--any-maximum", help="Export points unchanged, even if the LMS has another maximum."
        ),
    ] = False,
    only: Annotated[bool, Option("--only", help="Omit the columns of other assignments.")] = False,
    students: Annotated[
        list[str] | None,
        Option(
            "--for",
            metavar="STUDENT",
            help="Release only the grades of this student (repeatable): an id, login or name.",
        ),
    ] = None,
    excel: Annotated[
        bool,
        Option(
            "--excel",
            help="Write CSV that Excel opens with a double click; a file .xlsx is a spreadsheet.",
        ),
    ] = False,
    feedback: Annotated[
        Path | None,
        Option(metavar="ZIP", help="Write each student's report into a zip for Moodle or Canvas."),
    ] = None,
    feedback_format: Annotated[
        Literal["html", "markdown"],
        Option(metavar="html|markdown", help="The format of these reports."),
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
        students=tuple(students or ()),
        excel=excel,
        feedback=feedback,
        feedback_format=feedback_format,
    )
    data, code = export_grades(request, TERMINAL)
    write_stdout(data)
    return code


def stats(
    gradebook: GradebookOption,
    verbose: Annotated[
        bool, Option("--verbose", help="Name all students who need attention (terminal).")
    ] = False,
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
        Argument(
            metavar="[GRADEBOOK] [GRADEBOOK]", help="A gradebook; of two, the older one first."
        ),
    ] = None,
    gradebook: Annotated[
        Path | None,
        Option(
            "--gradebook", metavar="FOLDER", help="The gradebook, in place of the first argument."
        ),
    ] = None,
    before: Annotated[
        int | None, Option(metavar="RUN", help="The number of the older run.")
    ] = None,
    after: Annotated[int | None, Option(metavar="RUN", help="The number of the newer run.")] = None,
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

    books = [gradebook, *(gradebooks or ())] if gradebook else gradebooks or [only_gradebook()]
    return compare(tuple(books), before, after, output_format, screen())
