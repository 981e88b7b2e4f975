"""The class's page keeps its structure, whatever students are called and write."""

from dataclasses import replace
from pathlib import Path
from random import Random
from urllib.parse import unquote

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.run_writer import save_student
from grader.classroom.gradebook.stored import Enrolment
from grader.classroom.gradebook.summary import summary_of
from grader.classroom.students import Student
from grader.grading.rubric import load_rubric
from grader.report.pages.class_page import render_class_page
from grader.text import without_commands
from tests.classroom.gradebooks import graded_as, lab, record_run
from tests.report.class_pages import ClassPageReader
from tests.report.hostile_class import CORPUS, export_hostile_class

ELEMENTS = {
    "html", "head", "meta", "title", "style", "body", "script", "header", "main", "footer", "nav", "section", "article", "div",
    "figure", "h1", "h2", "h3", "p", "ul", "ol", "li", "a", "span", "strong", "code", "pre", "ins", "del", "kbd", "details",
    "summary", "table", "thead", "tbody", "tr", "th", "td", "form", "label", "input", "button", "svg", "g", "path", "rect",
    "text", "desc",
}  # fmt: skip


def test_text_of_students_stays_text(tmp_path: Path) -> None:
    """Names, ids, folders, robots, reasons and comments: no element, no address and no script comes from them."""
    pages = export_hostile_class(tmp_path)
    page = ClassPageReader(pages / "index.html")
    assert {str(element.tag) for element in page.root.iter()} <= ELEMENTS
    assert {row["name"] for row in page.table("students")} >= set(map(without_commands, CORPUS))
    links = [link for link in page.root.xpath("//a/@href") if not link.startswith("#")]
    assert {unquote(link) for link in links} == {file.name for file in pages.glob("*.html")} - {"index.html"}
    assert {link[1:] for link in page.root.xpath("//a/@href") if link.startswith("#")} <= set(page.root.xpath("//@id"))
    assert len(page.root.xpath("//script")) == 2
    assert any(CORPUS[1] in text for text in page.texts("//section[@id='look']//li"))
    for file in pages.glob("*.html"):
        assert "<script>document" not in file.read_text(encoding="utf-8")
        assert "\n::error" not in file.read_text(encoding="utf-8")


def test_a_thousand_students_of_lab6_take_half_a_megabyte(tmp_path: Path) -> None:
    """With names, ids, links, late penalties, and mistakes in every criterion."""
    dice = Random(1).random
    rubric = replace(load_rubric("lab6"), late=lab("percent_per_day = 10\n").late)
    keys = [f"student{number:06}" for number in range(1000)]
    with Gradebook(tmp_path / "book.db", create=True) as book:
        signs = ["".join("f" if dice() < 0.2 else "p" for _ in rubric.criteria[:-3]) + "???" for _ in range(40)]
        record_run(book, rubric, [graded_as(rubric, key, signs[number % 40]) for number, key in enumerate(keys)])
        with book.transaction():
            for number, key in enumerate(keys):
                name = f"Fernández-García {number}, María José"
                save_student(book, Student(key, name), Enrolment(number, days_late=number % 3))
        grades = Grades(book)
        text = render_class_page(summary_of(grades, with_fixes=True), grades, {key: f"{key}.html" for key in keys}, {})
    assert text.count("María José</a>") >= 1000
    assert len(text.encode()) <= 500_000
