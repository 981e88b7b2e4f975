"""The statistics of a class on a terminal and as JSON, and what changed in its grades."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from grader.base.errors import InputError
from grader.base.text import first_lines
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.statistics import statistics
from grader.classroom.marks.gradebook_folder import RESULTS, batch_lock
from grader.classroom.results.results import Results, ResultsWriter, time_of_run
from grader.report.formats import OutputFormat
from grader.report.screen import Screen, draw
from grader.report.writing import Terminal, Warn

_MAX_LINES = 20


def warn_of_ignored(book: Gradebook, warn: Warn) -> None:
    """Print the marks that do not count, and the lines of results that are damaged."""
    if book.results.damage:
        warn(book.results.damage)
    for line in first_lines(book.marks.ignored, _MAX_LINES):
        warn(f"this mark does not count: {line}")


def record_run(folder: Path, warn: Warn) -> None:
    """Record the current grades as a run, so that `diff` compares with them.

    Nothing is recorded if the newest run has them.
    """
    try:
        with batch_lock(folder):
            append_run(Gradebook(folder))
    except InputError as error:
        warn(f"`grader diff` cannot compare with these grades: {error}")


def append_run(book: Gradebook) -> Results | None:
    """Append a run with the current grades, and return the results with it.

    It is None if there is no need, or no way.
    """
    now = book.run_with({one.student.key: book.run_grade(one) for one in book})
    if book.results.unfinished or book.is_outdated or now.has_equal_grades(book.run):
        return None
    with ResultsWriter(book.folder / RESULTS, book.results.end) as writer:
        writer.append(now._replace(run=book.results.next_run, time=time_of_run(), written=()).line)
        writer.sync()
    return Results(book.folder / RESULTS)


def rubric_review(gradebook: Path, terminal: Terminal) -> str:
    """Return what an instructor should look at before grades go out. Raises InputError."""
    from grader.classroom.gradebook.rubric_review import review_rubric
    from grader.classroom.reports.rubric_review_text import render_rubric_review

    book = Gradebook(gradebook)
    warn_of_ignored(book, terminal.warn)
    return render_rubric_review(review_rubric(book), terminal.screen().width)


def class_statistics(
    gradebook: Path, kind: OutputFormat, terminal: Terminal, *, verbose: bool
) -> str:
    """Return the statistics of a class. Raises InputError."""
    book = Gradebook(gradebook)
    warn_of_ignored(book, terminal.warn)
    if kind is OutputFormat.JSON:
        from grader.classroom.reports.class_json import render_class_json

        return render_class_json(book)
    from grader.classroom.reports.class_terminal import render_class

    return draw(partial(render_class, statistics(book, book), verbose=verbose), terminal.screen())


def compare(
    books: Sequence[Path],
    before: int | None,
    after: int | None,
    kind: OutputFormat,
    screen: Screen,
) -> str:
    """Return what changed between two runs of a gradebook, or two gradebooks. Raises InputError."""
    from grader.classroom.gradebook.grade_changes import changes, newest_changes, snapshot

    if len(books) > 2:
        raise InputError("name one gradebook, or two")
    if len(books) == 1 and before is None:
        old, new, changed = newest_changes(books[0], after)
    else:
        old = snapshot(books[0], before)
        new = snapshot(books[-1], after)
        changed = list(changes(old, new))
    if kind is OutputFormat.JSON:
        from grader.classroom.reports.class_json import render_changes_json

        return render_changes_json(changed, (old.run, new.run))
    from grader.classroom.reports.class_terminal import render_changes

    return draw(partial(render_changes, changed, old, new), screen)
