"""The class's page keeps its structure, whatever students are called and write, and says what `stats` says."""

import json
from pathlib import Path
from urllib.parse import unquote

import pytest

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.reports.class_reports import write_class_page
from grader.classroom.reports.class_words import percent
from tests.classroom.gradebooks import batch, grader, lab_text, write_submission
from tests.report.attacks import ATTACKS, make_attacked_class
from tests.report.class_pages import ClassPageReader

ELEMENTS = {
    "html",
    "head",
    "meta",
    "title",
    "style",
    "body",
    "script",
    "header",
    "main",
    "footer",
    "nav",
    "section",
    "article",
    "div",
    "figure",
    "h1",
    "h2",
    "h3",
    "p",
    "ul",
    "ol",
    "li",
    "a",
    "span",
    "strong",
    "code",
    "pre",
    "ins",
    "del",
    "kbd",
    "details",
    "summary",
    "table",
    "thead",
    "tbody",
    "tr",
    "th",
    "td",
    "form",
    "label",
    "input",
    "button",
    "svg",
    "g",
    "path",
    "rect",
    "text",
    "desc",
}


@pytest.mark.parametrize(
    ("share", "words"), [(0, "0%"), (0.001, "1%"), (0.5, "50%"), (0.999, "99%"), (1, "100%")]
)
def test_a_share_is_not_rounded_to_all_or_none(share: float, words: str) -> None:
    """Only all are 100 %, and only none 0 %."""
    assert percent(share) == words


@pytest.mark.parametrize(("others", "is_cut"), [(3, False), (4, True)])
def test_one_bar_does_not_flatten_the_others(others: int, is_cut: bool, tmp_path: Path) -> None:
    """A bar that is more than three times as high as the next one is cut, and the page says how high it would be."""
    sizes = ["1 1 2", *["1 1 1"] * others]
    for number, size in enumerate(sizes):
        write_submission(tmp_path / "class" / f"s{number}", size)
    (tmp_path / "roster.csv").write_text(
        "id\n" + "".join(f"s{number}\n" for number in range(len(sizes)))
    )
    (tmp_path / "small.toml").write_text(lab_text())
    assert batch(tmp_path).returncode == 0
    write_class_page(Gradebook(tmp_path / "book"), tmp_path, {})
    page = ClassPageReader(tmp_path / "index.html")
    heights = [
        int(height)
        for height in page.root.xpath("//ol[@class='chart']//rect/@height")
        if height != "0"
    ]
    assert sorted(heights) == [67 if is_cut else 33, 100]
    said = ["The bar of 5.5 to 6.6 is cut: it would be 2.7 times as high."] if is_cut else []
    assert page.texts("//section[@id='grades']/p") == said
    assert len(page.root.xpath("//*[@class='cut']")) == is_cut


@pytest.mark.slow
def test_text_of_students_stays_text(tmp_path: Path) -> None:
    """Names, ids, folders, robots, reasons and comments: no element, no address and no script comes from them."""
    pages = make_attacked_class(tmp_path, ATTACKS[:6]).pages
    page = ClassPageReader(pages / "index.html")
    assert {str(element.tag) for element in page.root.iter()} <= ELEMENTS
    assert {row["name"] for row in page.table("students")} >= {
        text for text in ATTACKS[:6] if text.isprintable()
    }
    links = [link for link in page.root.xpath("//a/@href") if not link.startswith("#")]
    assert {unquote(link) for link in links} == {file.name for file in pages.glob("*.html")} - {
        "index.html"
    }
    assert {link[1:] for link in page.root.xpath("//a/@href") if link.startswith("#")} <= set(
        page.root.xpath("//@id")
    )
    assert len(page.root.xpath("//script")) == 2
    assert any(ATTACKS[7][:20] in text for text in page.texts("//section[@id='look']//li"))
    for file in pages.glob("*.html"):
        assert "<script>document" not in file.read_text(encoding="utf-8")
        assert "\n::error" not in file.read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_page_says_what_stats_says(tmp_path: Path) -> None:
    """A thousand students in four teams: the same words and numbers, as many behind each, in half a megabyte."""
    for number, size in enumerate(("1 1 1", "1 1 2", "1 1 1", "1 1 3")):
        write_submission(tmp_path / "class" / f"team{number}", size)
    name = "Fernández-García {0}, María José"
    rows = [
        f'student{at:06},"{name.format(at)}",team{at % 4},{"AB"[at % 2]},{at % 3}'
        for at in range(1000)
    ]
    (tmp_path / "roster.csv").write_text("\n".join(("id,name,team,section,late", *rows)))
    (tmp_path / "small.toml").write_text(lab_text("percent_per_day = 10"))
    assert batch(tmp_path).returncode == 0
    book = tmp_path / "book"
    write_class_page(
        Gradebook(book),
        tmp_path,
        {f"student{at:06}": f"reports/student{at:06}" for at in range(1000)},
    )
    page, printed = (
        ClassPageReader(tmp_path / "index.html"),
        grader("stats", "--gradebook", book).stdout,
    )
    statistics = json.loads(grader("stats", "--gradebook", book, "--format", "json").stdout)[
        "statistics"
    ]
    lines = page.texts("//p[@class='counts']")
    assert printed.splitlines()[1 : 1 + len(lines)] == lines
    assert [line.split()[0] for line in lines] == ["1000", "Grades", "1000", "Section", "Section"]
    assert [int(count) for count in page.texts("//span[@class='bar-count']")] == statistics[
        "tenths"
    ]
    assert [len(page.members(f"grade-{tenth}")) for tenth in range(10)] == statistics["tenths"]
    assert sum(statistics["tenths"]) == len(page.members("filter-graded")) == 1000
    assert [len(page.members(f"filter-{words}")) for words in ("section A", "late")] == [500, 666]
    criteria = {row["criterion"].split()[0]: row for row in page.table("criteria")}
    for row in statistics["criteria"]:
        shown = criteria[row["id"]]
        assert (shown["passed"], shown["lost"]) == (
            str(row["passed"]),
            str(row["failed"] + row["skipped"]),
        )
        assert f"{row['id']} {shown['points']} {shown['passed']} {row['failed']}" in " ".join(
            printed.split()
        )
    mistakes = page.texts("//section[@id='mistakes']//li")
    assert mistakes == [
        f"{len(one['students'])} {one['criterion']}: {one['message']}"
        for one in statistics["mistakes"]
    ]
    assert [len(page.members(f"mistake-{at}")) for at in range(len(mistakes))] == [
        500
    ]  # both sizes are one mistake
    assert (tmp_path / "index.html").stat().st_size <= 500_000
    assert page.links()[0] == "reports/student000000.html"
