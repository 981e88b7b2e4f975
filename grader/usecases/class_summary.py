"""The summary of a class: marks, statistics, and who needs attention."""

from dataclasses import dataclass
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.sections import Grouping, compare_sections
from grader.classroom.gradebook.summary import summary_of
from grader.classroom.lateness import read_time
from grader.report.formats import OutputFormat
from grader.report.screen import Screen, draw
from grader.usecases.class_hints import HintOptions, search_class_hints
from grader.usecases.terminal import Terminal, Warn

if TYPE_CHECKING:
    from grader.classroom.run.progress import Progress
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


@dataclass(frozen=True, slots=True)
class SummaryRequest:
    """The summary of a class: its format, and for `stats` the groups to compare, and the deadline.

    `with_fixes` shows the edits that would gain points, which takes a search for hints; `verbose` names all students
    who need attention.
    """

    kind: OutputFormat
    with_fixes: bool = False
    verbose: bool = False
    by: Grouping | None = None
    due: str | None = None


def class_statistics(gradebook: Path, request: SummaryRequest, terminal: Terminal) -> str:
    """Return the summary of a gradebook's class with the edits that would gain points, or a comparison of groups.

    As JSON, it has both. Raises InputError.
    """
    with Gradebook(gradebook) as book:
        grades = Grades(book, read_deadline(request.due))
        warn_of_due(request.due, grades.newest_rubric(), terminal.warn)
        if request.by is not None and request.kind is not OutputFormat.JSON:
            from grader.report.sections import render_sections

            return draw(partial(render_sections, compare_sections(grades, request.by)), terminal.screen())
        search_class_hints(book, HintOptions(), terminal, reports=False, statistics=True)
        return class_summary(grades, request, terminal.screen())


def class_summary(
    grades: Grades, request: SummaryRequest, screen: Screen | None = None, done: "Progress | None" = None
) -> str:
    """Return the summary; `done` counts what a batch has just done. Raises InputError if nothing was graded."""
    summary = summary_of(grades, with_fixes=request.with_fixes)
    if request.kind is OutputFormat.JSON:
        from grader.report.class_json import ClassReport, render_class_json

        comparison = compare_sections(grades, request.by) if request.by is not None else None
        return render_class_json(ClassReport(summary, grades, done, comparison))
    from grader.report.class_summary import render_class

    return draw(partial(render_class, summary, verbose=request.verbose), screen)
