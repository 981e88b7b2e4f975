"""Manual grading in a browser: by keys alone, with hostile submissions, and while somebody else grades as well."""

import re
import shutil
from collections.abc import Callable, Iterator
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.browser.conftest import OpenPage
from tests.checks.submissions import png
from tests.classroom.gradebooks import batch, grader, lab_text, urdf, write_submission
from tests.review_server import Review, marks_in, rows_of, running

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = pytest.mark.exhaustive
Open = Callable[..., OpenPage]
KEYS = ("ash", "birch", "cedar", "dogwood", "elm")


@pytest.fixture(scope="module")
def graded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a class of five, with a picture each; in cedar's zip it is in a folder, and dogwood's is a script."""
    top = tmp_path_factory.mktemp("review")
    for key in KEYS:
        write_submission(top / "class" / key)
        (top / "class" / key / "screen.png").write_bytes(png(640, 400))
    (top / "class" / "dogwood" / "screen.png").write_text(
        "<svg xmlns='http://www.w3.org/2000/svg' onload='alert(1)'/>"
    )
    (top / "class" / "birch" / "screen 2.png").write_bytes(png(300, 200))
    packed = shutil.make_archive(str(top / "cedar"), "zip", top / "class", "cedar")
    shutil.rmtree(top / "class" / "cedar")
    shutil.move(packed, top / "class")
    return graded_in(top)


def graded_in(top: Path, roster: str = "id,name\nash,Ash Ek\n", text: str = "") -> Path:
    """Grade the class in a folder and return the gradebook."""
    (top / "roster.csv").write_text(roster)
    (top / "small.toml").write_text(text or lab_text())
    done = batch(top)
    assert done.returncode == 0, done.stderr
    return top / "book"


@pytest.fixture
def book(graded: Path, tmp_path: Path) -> Path:
    """Return a copy of the gradebook of the class of five."""
    return Path(shutil.copytree(graded.parent, tmp_path / "copy"), "book")


@pytest.fixture(scope="module")
def chosen_class(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a class of two whose essay has usual deductions."""
    top = tmp_path_factory.mktemp("chosen")
    for key in KEYS[:2]:
        write_submission(top / "class" / key)
    head, tail = lab_text().split('check = "answered"', 1)
    choices = 'choices = { "no reason" = -2, "too short" = -0.5 }'
    return graded_in(top, text=f'{head}{choices}\ncheck = "answered"{tail}')


@pytest.fixture
def chosen(chosen_class: Path, tmp_path: Path) -> Path:
    """Return a copy of the gradebook of the class with usual deductions."""
    return Path(shutil.copytree(chosen_class.parent, tmp_path / "copy"), "book")


@pytest.fixture
def review(book: Path) -> Iterator[Review]:
    """Yield a review of ten items."""
    with running(book) as review:
        yield review


def press(page: "Page", keys: str, then: str = "") -> None:
    """Press keys one after the other, and wait for the page whose address ends so; a word in quotes is typed."""
    for key in re.findall(r"'[^']*'|\S+", keys):
        if key.startswith("'"):
            page.keyboard.type(key.strip("'"))
        else:
            page.keyboard.press(key)
    if then:
        page.wait_for_url(f"**/{then}")
        page.wait_for_selector("html")


def rest(page: "Page") -> None:
    """Wait until a page has the list of students, which it asks for after each item: then the server may end."""
    page.wait_for_load_state("networkidle")


def test_a_damaged_pdf_does_not_keep_the_keys(tmp_path: Path, open_pages: Open) -> None:
    """A viewer that takes the focus, as that of Chromium does for a PDF that it cannot show, gives it back."""
    birch = tmp_path / "class" / "birch"
    write_submission(birch)
    (birch / "screen.png").unlink()
    (birch / "screen.pdf").write_bytes(b"%PDF-1.4\n1 0 obj\n<<")
    book = graded_in(tmp_path, "id\nbirch\n")
    with running(book) as review:
        page = open_pages(f"{review.url}2").page
        for details in page.locator("details.document:not([open])").all():
            details.evaluate("details => { details.open = true; }")
        assert page.locator("iframe").count() == 1
        page.mouse.move(0, 0)
        page.locator("iframe").evaluate("frame => frame.focus()")
        page.wait_for_function("() => !(document.activeElement instanceof HTMLIFrameElement)")
        press(page, "1 Enter", "end")
        page.close()


def test_ten_items_by_keys_alone(review: Review, open_page: Open, book: Path) -> None:
    """All are in the file: typed points, all, half, none, comments, back, another mark, a withdrawn one."""
    page = open_page(f"{review.url}1").page
    press(page, "'3.5' c 'the roots are missing' Enter", "2")
    press(page, "f Enter", "3")
    press(page, "h c 'half of it' Enter", "4")
    press(page, "0 Enter", "5")
    press(page, "n", "6")
    press(page, "b", "5")
    press(page, "4 Enter", "6")
    press(page, "1 Enter", "7")
    press(page, "b", "6")
    assert "1 point by Kim" in page.locator(".marked").inner_text()
    press(page, "h Enter", "7")
    press(page, "1 Enter", "8")
    press(page, "b", "7")
    press(page, "'-' Enter", "8")
    for number in (9, 10):
        press(page, "1 Enter", str(number))
    press(page, "0 c 'a script' Enter", "end")
    assert page.locator("h1").inner_text() == "1 mark still needed"
    assert rows_of(book) == ["3.5", "4", "2", "0", "4", "1", "0.5", "1", "-", "1", "1", "0"]
    assert marks_in(book) == [
        ("ash", "essay", "3.5", "the roots are missing"),
        ("ash", "picture", "0.5", ""),
        ("birch", "essay", "4", ""),
        ("cedar", "essay", "2", "half of it"),
        ("cedar", "picture", "1", ""),
        ("dogwood", "essay", "0", ""),
        ("dogwood", "picture", "1", ""),
        ("elm", "essay", "4", ""),
        ("elm", "picture", "0", "a script"),
    ]
    press(page, "b", "10")
    page.go_back()
    page.get_by_role("button", name="Show what is left").click()
    page.wait_for_url("**/7")


def test_pictures(review: Review, open_page: Open) -> None:
    """Every picture is shown, those in archives as well, and enlarged by a key; a script under the name of a picture is not."""
    opened = open_page(f"{review.url}7")
    page = opened.page
    sizes = "[...document.querySelectorAll('figure img')].map(i => [i.complete, i.naturalWidth, i.naturalHeight])"
    assert page.evaluate(sizes) == [[True, 300, 200], [True, 640, 400]]
    press(page, "z")
    assert page.locator("#large").is_visible()
    assert page.locator("#large-words").inner_text() == "1 of 2: screen 2.png"
    press(page, "ArrowRight")
    assert page.locator("#large-words").inner_text() == "2 of 2: screen.png"
    press(page, "z")
    assert page.locator("#large-picture").bounding_box()["width"] == 640
    press(page, "z")
    assert not page.locator("#large").is_visible()
    page.goto(f"{review.url}8")
    assert page.evaluate(sizes) == [[True, 640, 400]]
    page.goto(f"{review.url}9")
    assert page.locator("img:visible").count() == 0
    assert "Not shown: screen.png: it is not a PNG" in page.locator(".not-shown").inner_text()
    assert not [request for request in opened.requests if "/9/picture" in request]


def test_somebody_else_marks_meanwhile(review: Review, open_page: Open, book: Path) -> None:
    """The page shows the newer mark, and the person keeps or replaces it."""
    page = open_page(f"{review.url}1").page
    for key, name in (("ash", "1"), ("birch", "2")):
        done = grader(
            "mark",
            key,
            "essay",
            "1",
            "--by",
            "Lee",
            "--comment",
            "<b>seen</b>",
            "--gradebook",
            book,
        )
        assert done.returncode == 0
        press(page, "4 Enter")
        page.wait_for_function(
            "() => document.getElementById('error').textContent.includes('has changed')"
        )
        assert (page.locator("#points").input_value(), page.locator(".marked").count()) == ("4", 1)
        press(page, "Enter")
        page.wait_for_selector("#newer:visible")
        assert "1 point by Lee at 20" in page.locator("#newer").inner_text()
        assert page.locator("#newer-text").inner_text().endswith(": <b>seen</b>")
        assert page.evaluate("document.activeElement.id") == "keep"
        press(page, "k" if name == "1" else "r", str(int(name) + 1))
    assert [row[:3] for row in marks_in(book)] == [("ash", "essay", "1"), ("birch", "essay", "4")]


def test_mistakes_are_said_and_nothing_is_lost(review: Review, open_page: Open, book: Path) -> None:
    """Invalid points, leaving what is not saved, also if it was changed after the warning, and the help."""
    page = open_page(f"{review.url}1").page
    error = page.locator("#error")
    for typed, why in (
        ("", "Enter the points first."),
        ("9", "essay is worth 0 to 4 points, not 9"),
    ):
        press(page, f"{typed} Enter")
        page.wait_for_function(
            "why => document.getElementById('error').textContent.includes(why)", arg=why
        )
        assert page.evaluate("document.activeElement.id") == "points"
    press(page, "n")
    assert error.inner_text() == "Not saved. Do the same again to leave without saving."
    press(page, "f n")
    assert page.locator("#points").input_value() == "4"
    press(page, "c 'good' Escape n")
    assert page.locator("#comment").input_value() == "good"
    assert error.inner_text() == "Not saved. Do the same again to leave without saving."
    press(page, "n", "2")
    press(page, "?")
    assert page.locator("#help").is_visible()
    press(page, "Escape b", "1")
    press(page, "'1/2'")
    assert page.locator("#points").input_value() == "1/2"
    assert marks_in(book) == []


def test_the_page_fits(review: Review, open_page: Open) -> None:
    """On a laptop, on a small screen and enlarged to 400 %, in both colour schemes, nothing is cut off sideways."""
    for width, height, scheme in ((1280, 800, "light"), (800, 600, "dark"), (320, 480, "light")):
        page = open_page(
            f"{review.url}7", viewport={"width": width, "height": height}, color_scheme=scheme
        ).page
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert page.locator("#points").is_visible()
        assert page.evaluate("document.activeElement.id") == "points"
        unnamed = "[...document.querySelectorAll('input, textarea')].filter(field => !field.labels.length).length"
        assert page.evaluate(unnamed) == 0


def test_fast_typing_saves_every_mark_where_it_belongs(open_page: Open, tmp_path: Path) -> None:
    """Sixty items at 10 ms a key, without a look at the page: each item has its own points, and none is lost."""
    top = tmp_path / "fast"
    for number in range(60):
        write_submission(top / "class" / f"s{number:03}")
    book = graded_in(top, "id\n" + "".join(f"s{number:03}\n" for number in range(60)))
    wanted = [Decimal(number % 41) / 10 for number in range(60)]
    with running(book, "essay") as review:
        page = open_page(f"{review.url}1").page
        page.keyboard.type("".join(f"{points}\n" for points in wanted), delay=10)
        page.wait_for_url("**/end")
        rest(page)
    assert [(key, float(points)) for key, _, points, _ in marks_in(book)] == [
        (f"s{number:03}", float(points)) for number, points in enumerate(wanted)
    ]


def test_keys_after_a_refused_mark_are_discarded(
    review: Review, open_page: Open, book: Path
) -> None:
    """Keys typed for the next item are discarded if it is not shown: the page says so, and nothing is saved for either item."""
    page = open_page(f"{review.url}1").page
    held: list[Any] = []  # the answer to the first mark comes after all keys
    page.route("**/1", lambda route: route.continue_() if held else held.append(route))
    with page.expect_request("**/1"):
        page.keyboard.type("9\n2\n")
    while not held:
        page.wait_for_timeout(10)
    held[0].continue_()
    page.wait_for_function(
        "() => document.getElementById('error').textContent.endsWith('is discarded.')"
    )
    assert page.locator("#points").input_value() == "9"
    assert page.url.endswith("/1")
    assert marks_in(book) == []
    page.keyboard.type("3\n1\n")
    page.wait_for_url("**/3")
    assert [row[:3] for row in marks_in(book)] == [("ash", "essay", "3"), ("birch", "essay", "1")]


def test_deductions(open_page: Open, chosen: Path) -> None:
    """A key gives the points and the comment, and takes both back; free comments stay."""
    with running(chosen, "essay") as review:
        page = open_page(f"{review.url}1").page
        press(page, "c 'see me' Alt+1 Alt+2")
        assert page.locator("#points").input_value() == "1.5"
        assert page.locator("#comment").input_value() == "too short; no reason; see me"
        press(page, "p 3 Alt+2")
        assert page.locator("#points").input_value() == "3.5"
        page.locator("[data-choice='2']").click()
        page.locator("[data-choice='2']").click()
        assert page.locator("#comment").input_value() == "no reason; see me"
        press(page, "p 2")
        assert page.locator("[data-choice][aria-pressed=true]").all_inner_texts() == [
            "Alt+1 no reason (-2)"
        ]
        press(page, "Enter", "2")
        rest(page)
    assert marks_in(chosen) == [("ash", "essay", "2", "no reason; see me")]


@pytest.fixture(scope="module")
def open_class(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a class of two in which a size is open, so that two criteria are; in that of ash it is known."""
    top = tmp_path_factory.mktemp("open")
    for key in KEYS[:2]:
        write_submission(top / "class" / key)
    unknown = urdf("$(env SIDE) 1 1").replace(
        "<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" '
    )
    (top / "class" / "birch" / "robot.urdf").unlink()
    (top / "class" / "birch" / "robot.urdf.xacro").write_text(unknown)
    return graded_in(top, "id,name\nash,Ash Ek\nbirch,Änne Birch\n")


@pytest.fixture
def opened(open_class: Path, tmp_path: Path) -> Path:
    """Return a copy of the gradebook of the class with an open size."""
    return Path(shutil.copytree(open_class.parent, tmp_path / "copy"), "book")


def test_points_for_all_are_shared(open_page: Open, opened: Path) -> None:
    """In proportion, and the sum stays; points that are typed for one criterion change the sum."""
    with running(opened) as review:
        page = open_page(f"{review.url}1").page
        fields = page.locator("[data-most]")
        each = "[...document.querySelectorAll('[data-most]')].map(field => field.value)"
        assert fields.evaluate_all("all => all.map(field => field.dataset.most)") == [
            "3",
            "2.5",
            "0.5",
        ]
        press(page, "f")
        assert page.evaluate(each) == ["3", "2.5", "0.5"]
        press(page, "Control+a '4'")
        assert page.evaluate(each) == ["2", "1.67", "0.33"]
        fields.nth(1).fill("2,5")
        assert page.locator("#points").input_value() == "4.83"
        press(page, "Shift+Enter")
        page.wait_for_url("**/5")
        assert page.locator("h1").inner_text() == "Änne Birch (birch)"
        rest(page)
    assert marks_in(opened) == [
        ("birch", "box", "2.5", ""),
        ("birch", "loads", "2", ""),
        ("birch", "tall", "0.33", ""),
    ]


def test_the_list_of_students(open_page: Open, opened: Path) -> None:
    """It is searched without accents, opens an item, and shows what is left; on a small screen a button opens it."""
    with running(opened) as review:
        page = open_page(f"{review.url}1").page
        rows = page.locator("#people-list button")
        rows.nth(1).wait_for()
        assert rows.all_inner_texts() == ["Ash Ek (ash)\n2 left", "Änne Birch (birch)\n5 left"]
        press(page, "/ 'ash'")
        assert rows.all_inner_texts() == ["Ash Ek (ash)\n2 left"]
        press(page, "Enter", "4")
        page.locator("#find").fill("anne")
        assert rows.all_inner_texts() == ["Änne Birch (birch)\n5 left"]
        page.locator("#find").fill("")
        page.locator("#points").focus()
        press(page, "f Enter", "5")
        page.wait_for_function(
            "() => document.getElementById('people-list').innerText.includes('1 left')"
        )
        small = open_page(f"{review.url}1", viewport={"width": 400, "height": 700}).page
        assert not small.locator("#people").is_visible()
        small.get_by_role("button", name="Students").click()
        small.locator("#people-list button").first.click()
        small.wait_for_url("**/6")
        assert not small.locator("#people").is_visible()
        rest(page)
        rest(small)


def test_a_server_that_has_ended_saves_nothing(open_pages: Open, opened: Path) -> None:
    """The page says so, keeps what was typed, and says how to go on."""
    with running(opened) as review:
        page = open_pages(f"{review.url}1").page
        page.wait_for_selector("#people-list button", state="attached")
    press(page, "f c 'good' Enter")
    page.wait_for_function(
        "() => document.getElementById('error').textContent.includes('not saved')"
    )
    assert (
        page.locator("#error")
        .inner_text()
        .startswith("The server has ended: run `grader review` again")
    )
    assert page.locator("#comment").input_value() == "good"
    assert page.locator("#points").input_value() == "6"
    page.close()
    assert marks_in(opened) == []


def test_filters(review: Review, open_page: Open) -> None:
    """A list shows one question."""
    page = open_page(f"{review.url}1").page
    page.locator("[data-filter=criterion]").select_option("picture")
    page.wait_for_url("**/6")
    assert page.locator(".place").inner_text().strip() == "1 of 5"


def test_one_column_below_900_pixels(review: Review, open_page: Open) -> None:
    """The answer has the width of the window, and the points stay visible while it scrolls."""
    for width in (400, 683, 890):
        page = open_page(f"{review.url}7", viewport={"width": width, "height": 500}).page
        for place in (0, 200):
            page.evaluate("place => scrollTo(0, place)", place)
            box, points = (
                page.locator("#found-title").bounding_box(),
                page.locator("#points").bounding_box(),
            )
            assert box is not None and box["width"] > width - 40
            assert points is not None and 0 < points["y"] < 500 - points["height"]
            assert page.evaluate("scrollY") == place


def test_a_similar_answer_gets_the_mark_if_it_is_ticked(tmp_path: Path, open_page: Open) -> None:
    """The box beside the other answer is empty at first; what is ticked is saved with the mark."""
    for key, end in (("ash", "roots"), ("birch", "Roots!"), ("cedar", "trees")):
        answer = f"Nothing joins the link to another one, so that there are two {end}"
        write_submission(tmp_path / "class" / key, answer=answer)
    book = graded_in(tmp_path)
    with running(book, "essay") as review:
        page = open_page(f"{review.url}1").page
        boxes = page.locator("[data-similar]")
        assert [boxes.count(), boxes.nth(0).is_checked()] == [2, False]
        boxes.nth(0).check()
        page.fill("#points", "3")
        page.press("#points", "Enter")
        page.wait_for_url(re.compile("/3$"))
    assert [mark[:3] for mark in marks_in(book)] == [
        ("ash", "essay", "3"),
        ("birch", "essay", "3"),
    ]


def test_robot_of_each_item_is_shown_in_space(open_page: Open, opened: Path) -> None:
    """An item that replaces the page has its own robot, or none; keys on the canvas are no keys of the review."""
    with running(opened) as review:
        page = open_page(f"{review.url}1").page
        assert page.locator("#space-canvas").is_visible()
        page.locator("#space-canvas").focus()
        zoom = page.evaluate("() => RobotView.camera.zoom")
        press(page, "-")
        assert page.evaluate("() => RobotView.camera.zoom") > zoom
        assert page.locator("#points").input_value() == ""
        shows = page.locator("#space-ghost").get_attribute("aria-pressed")
        page.locator("#points").focus()
        press(page, "g")
        assert page.locator("#space-ghost").get_attribute("aria-pressed") != shows
        press(page, "n", "4")
        assert page.locator("#space-canvas").is_visible()
        while page.locator("#form").count():
            press(page, "n")
            rest(page)
        assert page.evaluate("() => RobotView") is None
        page.goto(f"{review.url}1")
        assert page.locator("#space-canvas").is_visible()
        assert (
            page.evaluate("() => RobotView.poses().size")
            == page.locator("#space-links option").count() - 1
        )
        rest(page)
