"""The page of a class, beside the students' reports."""

from pathlib import Path

from grader.classroom.grades import Class
from grader.classroom.statistics import statistics
from grader.report.formats import Format
from grader.report.pages.class_page import render_class_page
from grader.text import without_commands
from grader.usecases.report_names import CLASS_PAGE
from grader.usecases.saves import address
from grader.usecases.writing import save


def write_class_page(book: Class, folder: Path, names: dict[str, str]) -> None:
    """Write the page into the folder of the students' pages, by their names; a student without a page has no link."""
    grades = list(book)
    links = {key: address(f"{name}.{Format.HTML.ending}") for key, name in names.items()}
    page = render_class_page(book, grades, statistics(book, grades), links)
    save(folder / CLASS_PAGE, without_commands(page))
