"""grader review: manual grading, one item at a time."""

import io
import sys
from pathlib import Path
from typing import Annotated

import typer

from grader.cli.options import ByOption, GradebookOption
from grader.cli.output import TERMINAL
from grader.errors import InputError
from grader.usecases.writing import write_stdout


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
    anonymous: Annotated[bool, typer.Option("--anonymous", help="Show no names, keys or paths of students.")] = False,
    by: ByOption = "",
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

    Each item shows the student's answer beside the model answer, or the paths of the pictures. Type the points and a comment: 3.5
    the roots are missing. 3.5 #2 repeats comment 2. You can stop at any time: marks are kept, and the next review continues with
    the rest.

    With --second, you see no marks of others, and your marks change no grade. `grader stats` shows the agreement.

    With --html, you review on a page in the browser that shows the pictures. The command prints the address of the page, which works
    on this machine only. Ctrl-C ends the review.

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
