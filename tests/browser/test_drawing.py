"""Drawings in the browser: their colours in light mode, dark mode and print, and that they load nothing."""

from collections.abc import Callable

import pytest

from tests.browser.conftest import OpenPage
from tests.command_line import ROOT

pytestmark = pytest.mark.exhaustive

DRAWING = ROOT / "tests/corpus/reports/several-mistakes/expected/files/drawing.svg"
FILL = "name => getComputedStyle(document.querySelector(name)).fill"
LIGHT, DARK = "rgb(255, 255, 255)", "rgb(22, 25, 29)"


@pytest.mark.parametrize(("scheme", "paper"), [("light", LIGHT), ("dark", DARK)])
def test_drawing_follows_dark_mode_and_prints_on_white(
    open_pages: Callable[..., OpenPage], scheme: str, paper: str
) -> None:
    """The colours of the student's robot stay; nothing is requested and the console is empty."""
    opened = open_pages(DRAWING, color_scheme=scheme, viewport={"width": 600, "height": 900})
    page = opened.page
    assert page.evaluate(FILL, ".paper") == paper
    assert page.evaluate(FILL, "polygon[fill='#00ff00']") == "rgb(0, 255, 0)"
    page.emulate_media(media="print")
    assert page.evaluate(FILL, ".paper") == LIGHT
    opened.check()


def test_texts_are_inside_the_drawing_and_legible(open_pages: Callable[..., OpenPage]) -> None:
    """At a width of 600 pixels, in the font that the browser has: at least 11 pixels high, and none is cut off."""
    opened = open_pages(DRAWING, viewport={"width": 600, "height": 900})
    boxes = opened.page.evaluate(
        "[...document.querySelectorAll('text')].map(text => {const box = text.getBoundingClientRect();"
        "return [box.left, box.right, parseFloat(getComputedStyle(text).fontSize)]})"
    )
    assert len(boxes) > 40
    assert all(left >= 0 and right <= 600 and size >= 11 for left, right, size in boxes)
    opened.check()
