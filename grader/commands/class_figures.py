"""The statistics of a class on a terminal and as JSON, and what changed in its grades."""

from functools import partial
from pathlib import Path

from grader.classroom.gradebook import Gradebook
from grader.classroom.gradebook_folder import RESULTS, check_gradebook
from grader.classroom.results import Results
from grader.classroom.statistics import statistics
from grader.commands.writing import Terminal, Warn
from grader.errors import InputError
from grader.report.formats import OutputFormat
from grader.report.screen import Screen, draw
from grader.text import first_lines

_MAX_LINES = 20


def warn_of_ignored(book: Gradebook, warn: Warn) -> None:
    """Print the marks that do not count, and the lines of results that are damaged."""
    if book.results.damage:
        warn(book.results.damage)
    for line in first_lines(book.marks.ignored, _MAX_LINES):
        warn(f"this mark does not count: {line}")


def class_statistics(gradebook: Path, kind: OutputFormat, terminal: Terminal, *, verbose: bool) -> str:
    """Return the statistics of a class. Raises InputError."""
    book = Gradebook(gradebook)
    warn_of_ignored(book, terminal.warn)
    if kind is OutputFormat.JSON:
        from grader.report.class_json import render_class_json

        return render_class_json(book)
    from grader.report.class_terminal import render_class

    return draw(partial(render_class, statistics(book, book), verbose=verbose), terminal.screen())


def compare(books: tuple[Path, ...], before: int | None, after: int | None, kind: OutputFormat, screen: Screen) -> str:
    """Return what changed between two runs of a gradebook, or two gradebooks. Raises InputError."""
    from grader.classroom.grade_changes import changes, snapshot

    if len(books) not in (1, 2):
        raise InputError("name one gradebook, or two")
    if len(books) == 1 and before is None:
        check_gradebook(books[0])
        before = (after or len(Results(books[0] / RESULTS).runs)) - 1
        if before < 1:
            raise InputError(f"{books[0]} has one run: grade the class again, and compare then")
    old, new = snapshot(books[0], before), snapshot(books[-1], after)
    found, runs = [*changes(old, new)], (old.run, new.run)
    if kind is OutputFormat.JSON:
        from grader.report.class_json import render_changes_json

        return render_changes_json(found, runs)
    from grader.report.class_terminal import render_changes

    return draw(partial(render_changes, found, runs), screen)
