"""Drawings in the browser: they load nothing, and their texts are legible."""

from collections.abc import Callable

import pytest

from tests.browser.conftest import OpenPage
from tests.command_line import ROOT

pytestmark = pytest.mark.exhaustive

DRAWING = ROOT / "tests/corpus/reports/several-mistakes/expected/files/drawing.svg"


def test_texts_are_inside_the_drawing_and_legible(open_pages: Callable[..., OpenPage]) -> None:
    """At a width of 600 pixels, in the font that the browser has: at least 11 pixels high, and none is cut off."""
    opened = open_pages(DRAWING, viewport={"width": 600, "height": 900})
    boxes = opened.page.evaluate(
        "[...document.querySelectorAll('text')].map(text => {const box = text.getBoundingClientRect();"
        "return [box.left, box.right, parseFloat(getComputedStyle(text).fontSize)]})"
    )
    assert len(boxes) > 25
    assert all(left >= 0 and right <= 600 and size >= 11 for left, right, size in boxes)
    opened.check()
