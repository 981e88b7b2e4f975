"""The class's page in a browser: sort, search, show a group, and go to a student's page and back."""

import shutil
from collections.abc import Callable
from itertools import takewhile
from pathlib import Path

import pytest
from pypdf import PdfReader

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.reports.class_reports import write_class_page
from tests.browser.conftest import OpenPage
from tests.classroom.gradebooks import batch, lab_text, make_class, write_submission
from tests.samples import ROOT

pytestmark = pytest.mark.exhaustive
Open = Callable[..., OpenPage]


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the pages of a small class."""
    top = tmp_path_factory.mktemp("class")
    make_class(top)
    done = batch(top, "--reports", top / "pages", "--report-format", "html")
    assert done.returncode == 0, done.stderr
    return top / "pages"


def names(opened: OpenPage) -> list[str]:
    """Return the names that the table of students shows, from the top."""
    found: list[str] = opened.page.locator("#students tbody tr:not([hidden]) th").all_inner_texts()
    return found


def test_sort_search_and_groups(open_page: Open, pages: Path) -> None:
    """With the pointer and with keys; the state is in the address, so that "back" restores it."""
    opened = open_page(pages / "index.html")
    page = opened.page
    assert names(opened) == [
        "Anna Ek",
        "Dora Fi",
        "Ben Oh",
        "Ben Oh",
        "Cleo Ray",
    ]  # by the family name
    grade = page.locator("#students th[data-column=grade]")
    grade.get_by_role("button").click()
    assert (names(opened)[0], names(opened)[-1], grade.get_attribute("aria-sort")) == (
        "Ben Oh",
        "Cleo Ray",
        "ascending",
    )
    grade.get_by_role("button").press("Enter")
    assert (names(opened)[0], grade.get_attribute("aria-sort")) == ("Anna Ek", "descending")
    assert page.locator("#students th[aria-sort]").count() == 1
    page.keyboard.press("/")
    page.keyboard.type("BEN")
    assert names(opened) == ["Ben Oh", "Ben Oh"]
    assert page.get_by_role("status").inner_text() == "2 of 5 students"
    page.locator("#find").fill("tall oh")
    assert names(opened) == ["Ben Oh"]
    page.keyboard.press("Escape")
    assert (names(opened), page.evaluate("document.activeElement.id")) == (["Ben Oh"], "shown")
    page.keyboard.press("Escape")
    assert (len(names(opened)), page.locator("#find").input_value()) == (5, "")
    bar = page.locator("[data-group=grade-5] button")
    bar.click()
    assert names(opened) == ["Anna Ek", "Ben Oh"]
    assert page.get_by_role("status").inner_text() == "2 of 5 students: a grade of 5.5 to 6.6"
    assert bar.get_attribute("aria-pressed") == "true"
    page.locator("[data-group=criterion-box] button").press("Enter")
    assert page.get_by_role("status").inner_text() == "1 of 5 students: lost points in box"
    page.locator("#students").get_by_role("link", name="Ben Oh").click()
    page.wait_for_url("**/emil.html")
    assert "Ben Oh" not in page.url
    page.go_back()
    page.wait_for_url("**/index.html#*")
    assert names(opened) == ["Ben Oh"]
    page.go_back()
    assert page.get_by_role("status").inner_text() == "2 of 5 students: a grade of 5.5 to 6.6"
    page.get_by_role("button", name="Show all").click()
    page.locator("[data-group=mistake-0] button").click()
    assert names(opened) == ["Ben Oh"]
    assert page.evaluate("document.activeElement.id") == "shown"
    assert all(request.startswith(pages.as_uri()) for request in opened.requests)


# Each is what a grader types, and the names that it finds.
SEARCHES = {
    "weiss": ["Weiß, Karl"],
    "Weiß": ["Weiß, Karl"],
    "mueller": ["Mueller, Bo", "Müller, Anna"],
    "Müller": ["Mueller, Bo", "Müller, Anna"],
    "muller": ["Müller, Anna"],
    "oneil": ["O'Neil, Sean"],
    "o’neil": ["O'Neil, Sean"],
    "lukas": ["Łukasiewicz, Ewa"],
    "soren": ["Sørensen, Åse"],
    "samuel ng": ["Nguyễn, Samuel"],
    "late": ["Müller, Anna", "Weiß, Karl"],
    "ROBOT-a": ["O'Neil, Sean"],
}


def test_names_are_found_as_they_are_typed(open_page: Open, tmp_path: Path) -> None:
    """Without accents, apostrophes and umlauts, or with two letters for one; `late` finds the late."""
    people = (
        "Müller, Anna",
        "Mueller, Bo",
        "Weiß, Karl",
        "O'Neil, Sean",
        "Łukasiewicz, Ewa",
        "Sørensen, Åse",
        "Nguyễn, Samuel",
    )
    rows = [
        f'robot-{"hgfaedc"[number]},"{name}",{int(name in SEARCHES["late"])}'
        for number, name in enumerate(people)
    ]
    (tmp_path / "roster.csv").write_text("\n".join(("id,name,late", *rows)), encoding="utf-8")
    (tmp_path / "small.toml").write_text(lab_text("percent_per_day = 10\n"), encoding="utf-8")
    for row in rows:
        folder = tmp_path / "class" / row.partition(",")[0]
        folder.mkdir(parents=True)
        shutil.copy(ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf", folder)
    assert (
        batch(tmp_path, "--reports", tmp_path / "pages", "--report-format", "html").returncode == 0
    )
    opened = open_page(tmp_path / "pages" / "index.html")
    assert names(opened)[:3] == ["Łukasiewicz, Ewa", "Mueller, Bo", "Müller, Anna"]
    found = {}
    for typed in SEARCHES:
        opened.page.keyboard.press("/")
        opened.page.keyboard.press("Control+A")
        opened.page.keyboard.type(typed)
        found[typed] = names(opened)
        opened.page.keyboard.press("Escape")
    assert found == SEARCHES


def test_names_come_first_in_a_search(open_page: Open, tmp_path: Path) -> None:
    """A name finds its student, and not all who lost points in a criterion with that word; without a name it finds those."""
    for key, size in (("box", "1 1 1"), ("ash", "1 1 2"), ("birch", "1 1 3")):
        write_submission(tmp_path / "class" / key, size)
    (tmp_path / "roster.csv").write_text("id,name\nbox,Bo Box\nash,Ada Ash\nbirch,Ben Birch\n")
    (tmp_path / "small.toml").write_text(lab_text())
    assert (
        batch(tmp_path, "--reports", tmp_path / "pages", "--report-format", "html").returncode == 0
    )
    opened = open_page(tmp_path / "pages" / "index.html")
    opened.page.locator("#find").fill("box")
    assert names(opened) == ["Bo Box"]
    assert (
        opened.page.get_by_role("status").inner_text()
        == "1 of 3 students by name; 2 more elsewhere in the table"
    )
    opened.page.locator("#find").fill("tall")
    assert sorted(names(opened)) == ["Ada Ash", "Ben Birch"]
    chips = opened.page.locator(".chips button")
    assert chips.all_inner_texts() == ["Graded 3", "Needs manual grading 3"]
    boxes = [box for chip in chips.all() if (box := chip.bounding_box()) is not None]
    assert boxes[1]["x"] - boxes[0]["x"] - boxes[0]["width"] > 5


@pytest.mark.parametrize("width", [1366, 1000, 683, 400])
def test_every_part_fits(open_page: Open, tmp_path: Path, width: int) -> None:
    """A long file name breaks, no code is cut off, and name and grade of a student are in view, below the headings."""
    make_class(tmp_path)
    (tmp_path / "class/finn").mkdir()
    (tmp_path / "class/finn" / f"{'unbreakable_file_name' * 8}.rar").write_bytes(b"Rar!")
    wrong = f'<robot name="r"><link name="base"/><link name="{"a_long_name_" * 9}"/></robot>'
    for key in ("gina", "hugo"):
        (tmp_path / f"class/{key}.urdf").write_text(wrong, encoding="utf-8")
    done = batch(tmp_path, "--reports", tmp_path / "pages", "--report-format", "html")
    assert done.returncode == 0, done.stderr
    page = open_page(
        tmp_path / "pages" / "index.html", viewport={"width": width, "height": 700}
    ).page
    page.evaluate("for (const one of document.querySelectorAll('details')) one.open = true")
    assert page.evaluate("document.documentElement.scrollWidth") == width
    cut = "[...document.querySelectorAll('pre, th, td, p, li')].filter((one) => one.scrollWidth > one.clientWidth + 1)"
    assert page.evaluate(f"{cut}.map((one) => one.textContent)") == []
    shown = (
        "row => [...row.children].filter((one) => getComputedStyle(one).display !== 'none').length"
    )
    if width >= 900:  # below, each student is a block
        cells = {row.evaluate(shown) for row in page.locator("#students tr:not([hidden])").all()}
        assert len(cells) == 1, cells
    grade = page.locator("#students td.grade").last
    grade.evaluate("cell => cell.parentElement.scrollIntoView()")
    head, box = page.locator("#students thead th").first.bounding_box(), grade.bounding_box()
    assert head is not None and head["y"] < 60
    assert box is not None and box["x"] + box["width"] <= width
    rows = page.locator("#criteria tbody tr").evaluate_all(
        "rows => rows.map((row) => row.offsetHeight)"
    )
    assert max(rows) < 130


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_narrow_screens_and_print(open_page: Open, pages: Path, scheme: str) -> None:
    """No part is wider than the screen, and the table of a print has all rows."""
    opened = open_page(
        pages / "index.html", viewport={"width": 360, "height": 700}, color_scheme=scheme
    )
    assert opened.page.evaluate("document.documentElement.scrollWidth") == 360
    opened.page.emulate_media(media="print")
    assert not opened.page.locator(".tools").is_visible()
    assert opened.page.locator("#students tbody tr").last.is_visible()


def test_without_javascript(browser: object, pages: Path) -> None:
    """The table is complete and sorted by name, and there is no button that does nothing."""
    context = browser.new_context(java_script_enabled=False)  # type: ignore[attr-defined]
    page = context.new_page()
    page.goto((pages / "index.html").as_uri())
    assert page.locator("#students tbody tr:visible").count() == 5
    assert page.locator("button:visible, input:visible").count() == 0
    context.close()


def test_a_class_of_a_thousand(open_page: Open, tmp_path: Path) -> None:
    """Every row is sorted and searched; of many the first 200 are shown until all are asked for."""
    for number, size in enumerate(("1 1 1", "1 1 2", "1 1 1", "1 1 1")):
        write_submission(tmp_path / "class" / f"team{number}", size)
    (tmp_path / "class/team2/robot.urdf").write_text("<robot/>")
    rows = [f"s{number:04},team{number % 4},{'AB'[number % 2]}" for number in range(1000)]
    (tmp_path / "roster.csv").write_text("\n".join(("id,team,section", *rows)))
    (tmp_path / "small.toml").write_text(lab_text())
    assert batch(tmp_path).returncode == 0
    write_class_page(Gradebook(tmp_path / "book"), tmp_path, {})
    opened = open_page(tmp_path / "index.html")
    assert len(names(opened)) == 200
    opened.page.locator("#students th[data-column=grade] button").click()
    assert names(opened)[:3] == ["s0002", "s0006", "s0010"]
    opened.page.locator("#find").fill("99 loads")
    assert names(opened) == ["s0990", "s0994", "s0998"]
    opened.page.locator("[data-group=criterion-loads] button").click()
    opened.page.locator("#find").fill("")
    assert (
        opened.page.get_by_role("status").inner_text()
        == "250 of 1000 students: lost points in loads"
    )
    assert len(names(opened)) == 200
    opened.page.locator("#more").click()
    assert len(names(opened)) == 250
    opened.page.keyboard.press("Escape")
    assert len(names(opened)) == 1000
    opened.page.pdf(path=tmp_path / "printed.pdf")
    printed = (page.extract_text() for page in PdfReader(tmp_path / "printed.pdf").pages)
    table = [*takewhile(lambda page: "Equal work" not in page, printed)]
    assert len(table) > 9
    assert all("lost points in" in page for page in table)
    opened.page.locator("[data-group='filter-section B'] button").click()
    assert opened.page.get_by_role("status").inner_text() == "500 of 1000 students: section B"


def test_robots_are_shown_as_the_table_is(open_page: Open, tmp_path: Path) -> None:
    """Filtered and sorted with it, those of equal work framed; a click opens the page of a student."""
    make_class(tmp_path)
    write_submission(tmp_path / "class" / "dora", "1 1 2")
    done = batch(tmp_path, "--reports", tmp_path / "pages", "--report-format", "html")
    assert done.returncode == 0, done.stderr
    opened = open_page(tmp_path / "pages" / "index.html")
    page = opened.page

    def robots() -> list[str]:
        found: list[str] = page.locator("#stills li").all_inner_texts()
        return [text.strip() for text in found]

    def rows() -> list[str]:
        return [text.partition(",")[0].partition(" (")[0] for text in robots()]

    assert rows() == names(opened)
    framed = page.locator("#stills .equal").all_inner_texts()
    assert framed == [
        text for text in robots() if "(equal work 1)" in text or "(equal work 2)" in text
    ]
    assert framed
    assert page.locator("#stills path").count() > 6
    page.locator("#students th[data-column=grade] button").click()
    assert rows() == names(opened)
    page.locator("#find").fill("dora")
    assert rows() == names(opened) == ["Dora Fi"]
    page.locator("#stills a").click()
    page.wait_for_url("**/dora.html")
