"""The student's page in a browser: it fits every width, prints as a whole, and nothing runs or loads."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.browser.conftest import OpenPage
from tests.command_line import run
from tests.samples import SAMPLES

pytestmark = pytest.mark.exhaustive
Open = Callable[..., OpenPage]
BACKGROUND = "name => getComputedStyle(document.querySelector(name)).backgroundColor"


def write(folder: Path, *arguments: object) -> Path:
    """Write what a command prints to a file, and return that."""
    file = folder / "page.html"
    file.write_bytes(run((*arguments, "--format", "html")).stdout)
    return file


@pytest.fixture(scope="module")
def page(open_pages: Open, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Return the page of a robot with a wheel that turns the wrong way and a buried lidar."""
    file = write(tmp_path_factory.mktemp("page"), "grade", SAMPLES["several-mistakes"].path)
    opened = open_pages(file, viewport={"width": 1280, "height": 900})
    yield opened.page
    opened.check()


def test_number_of_a_failure_leads_to_the_picture(page: Any) -> None:
    """The three views stay beside the failures on a wide screen, and follow them on a narrow one."""
    page.locator("#criterion-lidar-frame .pin").first.click()
    assert page.url.endswith("#robot")
    assert (
        page.locator(".views svg").bounding_box()["x"]
        > page.locator(".report").bounding_box()["width"]
    )
    page.set_viewport_size({"width": 400, "height": 800})
    assert page.locator(".views svg").bounding_box()["x"] < 100
    page.set_viewport_size({"width": 1280, "height": 900})


SIZES = [(390, 844), (683, 768), (960, 1080), (1366, 768)]


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_the_first_screen_has_a_mistake_with_its_line(page: Any, width: int, height: int) -> None:
    """The first mistake, what it costs and its line are on the screen, beside or below the robot; the drawings are last."""
    page.set_viewport_size({"width": width, "height": height})
    page.evaluate("() => scrollTo(0, 0)")
    card = page.locator(".report .card").first
    for part in (card.locator("h3"), card.locator(".points"), card.locator(".where").first):
        box = part.bounding_box()
        assert box["y"] + box["height"] <= height
    canvas = page.locator("#space-canvas").bounding_box()
    assert canvas["height"] <= 0.45 * height + 1
    slider = page.locator("#space-joints input").first.bounding_box()
    assert slider["y"] + slider["height"] <= height
    if width < 992:
        last = page.locator(".report .card").last.bounding_box()
        assert page.locator(".views").bounding_box()["y"] > last["y"] + last["height"]
    page.set_viewport_size({"width": 1280, "height": 900})


def test_mistakes_are_numbered_by_cost(page: Any) -> None:
    """Down the page, the numbers of the picture follow each other."""
    numbers = [text.split()[-1] for text in page.locator(".report .card .pin").all_inner_texts()]
    assert numbers == [str(number) for number in range(1, len(numbers) + 1)]
    assert len(numbers) > 2


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_what_is_touched_has_24_pixels(page: Any, width: int, height: int) -> None:
    """Buttons, sliders, lists and numbers are at least 24 pixels high, as WCAG 2.2 asks (2.5.8)."""
    page.set_viewport_size({"width": width, "height": height})
    for target in page.locator("#robot button, #robot select, #robot input, .card .pin").all():
        if target.is_visible():
            assert target.bounding_box()["height"] >= 24
    page.set_viewport_size({"width": 1280, "height": 900})


@pytest.mark.usefixtures("shows_edits")
def test_new_text_is_copied(open_page: Open, tmp_path: Path) -> None:
    """The button of a hint copies the new lines."""
    allowed = {"permissions": ["clipboard-read", "clipboard-write"]}
    page = open_page(write(tmp_path, "grade", SAMPLES["axis-negated"].path), **allowed).page
    page.get_by_role("button", name="Copy the new text").first.click()
    page.get_by_role("button", name="Copied").wait_for()
    assert page.evaluate("() => navigator.clipboard.readText()").strip() == '<axis xyz="0 0 1"/>'


def test_dark_mode_and_print(page: Any) -> None:
    """Dark mode has another background; print has a white one, the picture first, and everything unfolded."""
    page.emulate_media(color_scheme="dark")
    assert page.evaluate(BACKGROUND, "body") == "rgb(13, 17, 23)"
    assert page.pdf()[:5] == b"%PDF-"
    page.emulate_media(media="print", color_scheme="dark")
    assert page.evaluate(BACKGROUND, "body") == "rgb(255, 255, 255)"
    assert page.evaluate(BACKGROUND, ".hint") == "rgb(218, 251, 225)"
    tops = [
        page.locator(f"{part} h2").first.bounding_box()["y"]
        for part in (".robot", ".report", ".all")
    ]
    assert tops == sorted(tops)
    assert page.locator("details td").first.is_visible()
    tables = page.locator(".all details table").evaluate_all(
        "tables => tables.map((one) => one.clientWidth / one.parentElement.clientWidth)"
    )
    assert min(tables) > 0.9
    page.emulate_media(media="screen", color_scheme="light")


@pytest.mark.parametrize("width", [360, 800, 1400])
def test_no_width_scrolls_sideways(page: Any, width: int) -> None:
    """A telephone, a small and a large window: nothing is wider than the page."""
    page.set_viewport_size({"width": width, "height": 800})
    assert page.evaluate("() => document.documentElement.scrollWidth") <= width
    for lines in page.locator(
        ".diff, .source"
    ).all():  # all of each line is visible, also what changes
        assert lines.evaluate("lines => lines.scrollWidth <= lines.clientWidth")
    page.set_viewport_size({"width": 1280, "height": 900})


def test_page_works_without_scripts(open_page: Open, tmp_path: Path) -> None:
    """Without JavaScript only the buttons that copy are missing."""
    file = write(tmp_path, "grade", SAMPLES["lidar-buried"].path)
    page = open_page(file, java_script_enabled=False).page
    assert page.locator("#criterion-lidar-frame").is_visible()
    assert page.locator(".views svg").is_visible()
    assert not page.locator("button.copy").first.is_visible()
