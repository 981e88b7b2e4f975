"""Write the class's page beside the pages of its students."""

from datetime import datetime
from pathlib import Path
from urllib.parse import quote

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.summary import summary_of
from grader.report.formats import Format
from grader.text import without_commands
from grader.usecases.report_names import CLASS_PAGE
from grader.usecases.writing import save

_MAX_ATTENTION = 100  # students who are named


def write_class_page(book: Path, folder: Path, names: dict[str, str], due: datetime | None) -> None:
    """Write the page into the folder of the students' pages. A submission that is gone has no link."""
    from grader.report.pages.class_page import render_class_page  # late: only pages need a library of templates

    with Gradebook(book) as opened:
        grades = Grades(opened, due)
        summary = summary_of(grades, with_fixes=True, listed=_MAX_ATTENTION)
        links = {
            grade.student.key: quote(f"{names[grade.student.key]}.{Format.HTML.ending}")
            for grade in grades.all()
            if grade.student.key in names and not grade.is_gone
        }
        page = render_class_page(summary, grades, links, {})
    save(folder / CLASS_PAGE, without_commands(page))
