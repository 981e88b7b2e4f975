"""grader mark and grader review: manual grading by command, or one item at a time."""

import io
import sys
from pathlib import Path
from typing import Annotated

import typer

from grader.cli.options import AnswersOption, ByOption, GradebookOption
from grader.cli.terminal import TERMINAL, warn
from grader.errors import InputError
from grader.usecases.writing import write_stdout


_CRITERION = "The id of the criterion; total: the whole submission; deadline: the student's own."
_POINTS = "The points; with total also excused; with deadline a time; - withdraws a mark."


def mark(
    gradebook: GradebookOption,
    student: Annotated[str, typer.Argument(metavar="STUDENT", help="The id, login, email address or name.")] = "",
    criterion: Annotated[str, typer.Argument(metavar="CRITERION|total|deadline", help=_CRITERION)] = "",
    points: Annotated[str, typer.Argument(metavar="[POINTS|TIME|excused|-]", help=_POINTS)] = "",
    comment: Annotated[str, typer.Option(metavar="TEXT", help="For the student.")] = "",
    missing: Annotated[bool, typer.Option("--missing", help="All who submitted nothing, not STUDENT.")] = False,
    file: Annotated[Path | None, typer.Option("--import", metavar="CSV", help="The marks of many students.")] = None,
    by: ByOption = "",
) -> str:
    """Give a mark for a criterion or the whole submission, or another deadline.

    Use it for criteria that need manual grading, or to override a check. `total` gives a final mark, which is the whole
    grade, also without a submission; `excused` in place of its points means that the student needs no grade. A comment without POINTS
    changes no points. The mark is appended to the file of --by in the folder marks/ of the gradebook: people may edit these files, and add
    files of their own. The latest mark counts, and `-` withdraws it.

    Examples:

      grader mark alice answer-floating-link 3.5 --gradebook lab6-grades

      grader mark alice lidar-frame 6 --gradebook lab6-grades --comment "fixed it" --by Kim

      grader mark alice lidar-frame - --gradebook lab6-grades

      grader mark carol total excused --gradebook lab6-grades --comment "ill"

      grader mark alice deadline 2026-11-25 --gradebook lab6-grades

      grader mark --missing total 0 --gradebook lab6-grades

      grader mark --import marks.csv --gradebook lab6-grades
    """
    from grader.usecases.manual_marks import MarkRequest, give_mark, import_marks, mark_missing

    if file is not None:
        if student or criterion or points or comment or missing:
            raise InputError("--import takes no argument and no other option but --by")
        return import_marks(gradebook, file, by)
    if missing:  # in place of the student
        return mark_missing(gradebook, MarkRequest("", student, criterion, comment, by))
    return give_mark(gradebook, MarkRequest(student, criterion, points, comment, by), warn)


def review(
    gradebook: GradebookOption,
    criterion: Annotated[str, typer.Option(metavar="ID", help="Only this criterion.")] = "",
    section: Annotated[str | None, typer.Option(metavar="NAME", help="Only this section of the roster.")] = None,
    mine: Annotated[
        bool, typer.Option("--mine", help="Only students whose marker in the roster is the name of --by.")
    ] = False,
    second: Annotated[
        bool, typer.Option("--second", help="Give second opinions, which change no grade; needs --by.")
    ] = False,
    anonymous: Annotated[bool, typer.Option("--anonymous", help="Show no names, ids or paths of students.")] = False,
    by: ByOption = "",
    answers: AnswersOption = None,
    pictures: Annotated[
        Path | None, typer.Option(metavar="DIR", help="First write all pictures into this folder.")
    ] = None,
    html: Annotated[bool, typer.Option("--html", help="Grade on a page in the browser.")] = False,
    port: Annotated[
        int,
        typer.Option(
            metavar="N", min=0, max=65535, show_default=False, help="The port of the page; default: any free port."
        ),
    ] = 0,
) -> int:
    """Grade what needs manual grading, one item at a time.

    Each item shows the student's answer beside the model answer, or the paths of the pictures. The gradebook keeps the
    model answers of --answers, also of batch. Type the points and a
    comment: 3.5 the roots are missing. 3.5 #2 repeats comment 2. You can stop at any time: marks are kept, and the next
    review continues with the rest.

    With --second, you see no marks of others, and your marks change no grade. `grader stats` shows the agreement.

    With --html, you review on a page in the browser that shows the pictures. The command prints the address of the
    page, which works on this machine only. Ctrl-C ends the review.

    Examples:

      grader review --gradebook lab6.db --html

      grader review --gradebook lab6.db

      grader review --gradebook lab6.db --criterion answer-floating-link

      grader review --gradebook lab6.db --pictures pictures

      grader review --gradebook lab6.db --section A --anonymous

      grader review --gradebook lab6.db --mine --by Kim

      grader review --gradebook lab6.db --second --by Lee
    """
    from grader.classroom.gradebook.manual_queue import ReviewScope

    if section is not None and not section.strip():
        raise InputError("--section is empty: name a section, or omit it to review all")
    if answers is not None:
        from grader.usecases.class_inputs import keep_answers

        keep_answers(gradebook, answers)
    scope = ReviewScope(criterion, by, section or "", mine, second, anonymous)
    if html:
        from grader.usecases.review_page import review_in_browser

        if pictures is not None:
            raise InputError("--pictures cannot be used with --html, which shows the pictures on the page")
        write_stdout(review_in_browser(gradebook, scope, port, TERMINAL))
        return 0
    if port:
        raise InputError("--port needs --html")
    from grader.usecases.review import review as review_all

    if isinstance(sys.stdin, io.TextIOWrapper):
        sys.stdin.reconfigure(errors="backslashreplace")  # a terminal in another encoding
    write_stdout(review_all(gradebook, scope, pictures, TERMINAL))
    return 0
