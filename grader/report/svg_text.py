"""Lines of text in SVG. Their width depends on the viewer's font, so it is estimated with a wide font."""

from functools import lru_cache
from typing import Any
from unicodedata import east_asian_width

from grader.report.svg_elements import put
from grader.text import printable

SIZE = 12.0  # pixels
LINE = 15.0  # from one line to the next
_NARROW, _WIDE = frozenset(" .,:;'|!ijlt()[]fr-"), frozenset("mwMW@%")
_MAX_LINES = 3
_MAX_LENGTH = 1000  # characters: more do not fit into three lines


def put_lines(group: Any, left: float, top: float, width: float, text: str, most: int = _MAX_LINES) -> float:
    """Add a text in lines, the first of them at `top`; return the position of the next line."""
    lines = wrapped(text, width, most)
    paragraph = put(group, "text")
    for number, line in enumerate(lines):
        put(paragraph, "tspan", "", {"x": left, "y": top + number * LINE}, line)
    return top + len(lines) * LINE


def wrapped(text: str, width: float, most: int = _MAX_LINES) -> list[str]:
    """Return a text in at most some lines of a width in pixels; the last one ends with "..." if words are missing."""
    lines: list[str] = []
    line = ""
    for word in printable(text[:_MAX_LENGTH]).split():
        longer = f"{line} {word}" if line else word
        if line and text_width(longer) > width:
            if len(lines) == most - 1:
                return [*lines, _shortened(line, width)]
            lines.append(line)
            longer = word
        line = cut(longer, width)
    return [*lines, line] if line else lines


def cut(text: str, width: float) -> str:
    """Return a text, cut with "..." if it is wider."""
    return text if text_width(text) <= width else _shortened(text, width)


def _shortened(text: str, width: float) -> str:
    while text and text_width(text) > width - SIZE:
        text = text[:-1]
    return f"{text.rstrip(' .,;:')}..."


def text_width(text: str) -> float:
    """Return the estimated width of a text in DejaVu Sans, which is wider than most fonts."""
    return SIZE * sum(map(_letter_width, text))


@lru_cache(maxsize=1024)
def _letter_width(letter: str) -> float:
    if letter in _NARROW:
        return 0.38
    if east_asian_width(letter) in "WF" or letter in _WIDE:
        return 1.0
    return 0.72 if letter.isupper() else 0.62
