"""The summary of a class: marks, statistics, and who needs attention."""

from datetime import datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.lateness import read_time
from grader.classroom.gradebook.sections import Comparison, Grouping, compare
from grader.classroom.gradebook.summary import summary_of
from grader.report.formats import OutputFormat
from grader.report.screen import Screen, draw
from grader.usecases import Warn
from grader.usecases.class_hints import HintOptions, ProgressDisplay, search_class_hints

if TYPE_CHECKING:
    from grader.classroom.run.batch import Progress
    from grader.grading.rubric import Rubric


def read_deadline(text: str | None) -> datetime | None:
    """Return the time that `--due` gives. Raises InputError."""
    return read_time(text) if text else None


def warn_of_due(due: str | None, rubric: "Rubric", warn: Warn) -> None:
    """Say that `--due` changes no grade if the rubric has no late penalty."""
    if due and rubric.late is None:
        warn(
            f"--due has no effect on grades, because the rubric {rubric.id} has no [late]: only the days late are shown"
        )


def class_statistics(
    gradebook: Path,
    by: Grouping | None,
    due: str | None,
    kind: OutputFormat,
    screen: Screen,
    progress: ProgressDisplay,
    warn: Warn,
    *,
    verbose: bool = False,
) -> str:
    """Return the summary of a gradebook's class with the edits that would gain points, or a comparison of groups.

    As JSON, it has both. Raises InputError.
    """
    with Gradebook(gradebook) as book:
        grades = Grades(book, read_deadline(due))
        warn_of_due(due, grades.newest_rubric(), warn)
        comparison = compare(grades, by) if by is not None else None
        if comparison is not None and kind is not OutputFormat.JSON:
            from grader.report.sections import render_sections

            return draw(partial(render_sections, comparison), screen)
        search_class_hints(book, HintOptions(), progress, warn, reports=False, statistics=True)
        return class_summary(grades, kind, screen, with_fixes=True, verbose=verbose, comparison=comparison)


def class_summary(
    grades: Grades,
    kind: OutputFormat,
    screen: Screen | None = None,
    done: "Progress | None" = None,
    *,
    with_fixes: bool = False,
    verbose: bool = False,
    comparison: Comparison | None = None,
) -> str:
    """Return the summary; `done` counts what a batch has just done. Raises InputError if nothing was graded.

    `with_fixes` shows the edits that would gain points, which takes a search for hints; `verbose` names all students who need
    attention; `comparison` is added to JSON.
    """
    summary = summary_of(grades, with_fixes=with_fixes)
    if kind is OutputFormat.JSON:
        from grader.report.class_json import render_class_json

        run = None
        if done is not None:
            run = {"total": done.total, "graded": done.graded, "unchanged": done.unchanged, "errored": done.errored}
        return render_class_json(summary, grades, run, comparison)
    from grader.report.class_summary import render_class

    return draw(partial(render_class, summary, verbose=verbose), screen)
