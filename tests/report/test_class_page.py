"""The class's page keeps its structure, whatever students are called and write."""

from pathlib import Path
from urllib.parse import unquote

from grader.text import without_commands
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
    assert len(page.root.xpath("//script")) == 2
    assert any(CORPUS[1] in text for text in page.texts("//section[@id='look']//li"))
    for file in pages.glob("*.html"):
        assert "<script>document" not in file.read_text(encoding="utf-8")
        assert "\n::error" not in file.read_text(encoding="utf-8")
