"""The page of a class, beside the students' reports."""

from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import suppress
from datetime import datetime
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.hints import CommonFix
from grader.classroom.gradebook.summary import summary_of
from grader.report.formats import Format
from grader.text import without_commands
from grader.usecases.report_names import CLASS_PAGE
from grader.usecases.saves import address
from grader.usecases.writing import save

_MAX_TRIED = 3  # students whose submissions may have changed since they were graded


def write_class_page(
    executor: Executor, book: Path, folder: Path, names: dict[str, str], deadline: datetime | None
) -> None:
    """Write the page into the folder of the students' pages. Students whose submissions were removed have no link."""
    from grader.report.pages.class_page import MAX_DRAWINGS, render_class_page  # late: they import jinja2

    with Gradebook(book) as opened:
        grades = Grades(opened, deadline)
        summary = summary_of(grades, with_fixes=True)
        there = {grade.student.key: grade for grade in grades.all() if grade.student.key in names and not grade.is_gone}
        links = {key: address(f"{names[key]}.{Format.HTML.ending}") for key in there}
        examples = {
            fix: sorted((key for key in fix.students if key in there), key=lambda key: -there[key].score)[:_MAX_TRIED]
            for fix in summary.fixes[:MAX_DRAWINGS]
        }
        drawings = _drawings(executor, book, examples)
        page = render_class_page(summary, grades, links, drawings)
    save(folder / CLASS_PAGE, without_commands(page))


def _drawings(executor: Executor, book: Path, examples: Mapping[CommonFix, Sequence[str]]) -> dict[str, str]:
    """Return a picture of a robot that needs each edit, as SVG, by action; none if no robot can be read any more.

    `examples` are students who need the edit, the highest score first.
    """
    tasks = {fix.action: executor.submit(_draw, str(book), keys, fix.criteria) for fix, keys in examples.items()}
    found = {}
    for action, task in tasks.items():
        with suppress(Exception):  # a crash affects only this picture
            found[action] = task.result()
    return found


def _draw(book: str, keys: Collection[str], criteria: Collection[str]) -> str:
    """Return a picture of the first student's robot that can be read; empty if there is none."""
    from grader.report.pages.class_page import thumbnail

    with Gradebook(Path(book)) as opened:
        grades = Grades(opened)
        for key in keys:
            with suppress(Exception):  # a robot that cannot be drawn: the next one may be
                if drawn := thumbnail(grades.report(grades.find(key)), criteria):
                    return drawn
    return ""
