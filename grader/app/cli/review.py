"""grader mark and grader review.

A person grades by command, on a page in the browser, or in a spreadsheet.
"""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from grader.app.cli.options import (
    AnswersOption,
    ByOption,
    GradebookOption,
    NoBrowserOption,
    PortOption,
)
from grader.app.cli.streams import TERMINAL, warn
from grader.base.errors import InputError


def mark(
    gradebook: GradebookOption,
    student: Annotated[
        str,
        Argument(
            metavar="STUDENT",
            help="The id, login, email address or name.",
        ),
    ] = "",
    criterion: Annotated[
        str,
        Argument(
            metavar="CRITERION|grade|deadline",
            help="The id of the criterion; grade: the final mark; deadline: the student's own.",
        ),
    ] = "",
    points: Annotated[
        str,
        Argument(
            metavar="[POINTS|TIME|excused|-]",
            help="The points; with grade also excused; with deadline a time; - withdraws a mark.",
        ),
    ] = "",
    comment: Annotated[str, Option(metavar="TEXT", help="For the student.")] = "",
    missing: Annotated[
        bool, Option("--missing", help="All students without a submission.")
    ] = False,
    file: Annotated[
        Path | None, Option("--import", metavar="CSV", help="The marks of many students.")
    ] = None,
    by: ByOption = "",
) -> str:
    """Give a mark for a criterion or a submission, or another deadline.

    Use it for criteria that need manual grading, or to override a check. `grade` gives a final
    mark, which is the whole grade, also without a submission; `excused` in place of its points
    means that the student needs no grade. A comment without POINTS changes no points. The mark is
    appended to the file of --by in the folder marks/ of the gradebook: people may edit these files,
    and add files of their own. The latest mark counts, and `-` withdraws it.

    Examples:

      grader mark alice answer-floating-link 3.5

      grader mark alice lidar-frame -

      grader mark carol grade excused --comment "ill"

      grader mark alice deadline 2026-11-25

      grader mark --missing grade 0

      grader mark --import marks.csv
    """
    from grader.classroom.commands.manual_marks import give_mark, import_marks, mark_missing

    if file:
        if student or criterion or points or comment or missing:
            raise InputError("--import takes no argument and no other option but --by")
        return import_marks(gradebook, file, by, warn)
    row = {
        "student": student,
        "criterion": criterion,
        "points": points,
        "comment": comment,
        "by": by,
    }
    if missing:  # in place of the student
        return mark_missing(gradebook, {**row, "criterion": student, "points": criterion}, warn)
    return give_mark(gradebook, row, warn)


def review(
    gradebook: GradebookOption,
    criterion: Annotated[str, Option(metavar="ID", help="Only this criterion.")] = "",
    section: Annotated[
        str | None, Option(metavar="NAME", help="Only this section of the roster.")
    ] = None,
    anonymous: Annotated[
        bool, Option("--anonymous", help="Show no names, ids or paths of students.")
    ] = False,
    by: ByOption = "",
    answers: AnswersOption = None,
    sheet: Annotated[
        Path | None,
        Option(metavar="FILE", help="Write what needs manual grading into a new CSV file instead."),
    ] = None,
    port: PortOption = 0,
    no_browser: NoBrowserOption = False,
) -> str:
    """Grade what needs manual grading on a page in the browser.

    The command prints the address of the page, which works on this machine only, and opens it. An
    item is a criterion with the student's answer, the model answer of --answers, and the pictures,
    or with the robot and the lines of the file; students with the same answer are one item, and so
    are criteria of a student that are open for one reason. Each mark is saved immediately, in the
    file of --by in the folder marks/ of the gradebook. Marked items can be opened and marked again.
    Ctrl-C ends the review.

    With --sheet, no page is served: fill in the points in a spreadsheet, and record them with `mark
    --import FILE`.

    Examples:

      grader review --by Kim

      grader review --section A --anonymous

      grader review --sheet sheet.csv
    """
    from grader.classroom.gradebook.review_items import ReviewFilter
    from grader.classroom.review.review_server import review_in_browser
    from grader.classroom.review.review_session import ReviewSession, write_sheet

    if section is not None and not section.strip():
        raise InputError("--section is empty: name a section, or omit it to review all")
    session = ReviewSession(
        gradebook, ReviewFilter(criterion, section or ""), by, answers, is_anonymous=anonymous
    )
    if sheet:
        return write_sheet(session, sheet)
    return review_in_browser(session, port, TERMINAL, opens=not no_browser)
