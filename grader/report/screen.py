"""Text as rich lays it out, for a terminal or a file."""

import io
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from grader.base.text import without_commands

if TYPE_CHECKING:
    from rich.console import Console

_MIN_WIDTH, _DEFAULT_WIDTH, _MAX_WIDTH = 40, 80, 500


def columns(terminal: int = _DEFAULT_WIDTH) -> int:
    """Return the width to draw for: that of the environment variable COLUMNS, or the terminal's."""
    given = os.environ.get("COLUMNS", "")
    if given.isdigit() and int(given) > 0:
        return max(_MIN_WIDTH, min(int(given), _MAX_WIDTH))
    return max(_MIN_WIDTH, terminal)


class Screen(NamedTuple):
    """The terminal or file of a report: its width in columns, its encoding, and whether it shows
    colours.
    """

    width: int
    encoding: str = "utf-8"
    is_terminal: bool = False


def draw(render: Callable[["Console"], None], screen: Screen | None = None) -> str:
    """Return what a renderer prints, as text for a screen; without one plain text for a file."""
    from rich.console import Console  # rich is not needed for JSON

    screen = screen or Screen(columns())
    buffer = _Buffer(screen.encoding)
    console = Console(
        file=buffer,
        force_terminal=screen.is_terminal,
        width=screen.width,
        height=24,  # nothing depends on it, but without it rich asks the terminal for each line
        highlight=False,
        markup=False,
        emoji=False,
        legacy_windows=False,
        no_color=True if os.environ.get("NO_COLOR") else None,
    )
    render(console)
    return without_commands(buffer.getvalue())


class _Buffer(io.StringIO):
    """A stream that collects output and reports the encoding of its destination."""

    def __init__(self, encoding: str) -> None:
        super().__init__()
        self._encoding = encoding

    @property
    def encoding(self) -> str:  # type: ignore[override]  # typeshed has it writable
        return self._encoding
