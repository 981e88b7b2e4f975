"""Text as rich lays it out, for a terminal or a file."""

import io
import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.text import without_commands

if TYPE_CHECKING:
    from rich.console import Console

_RANDOM_ID = on_use("\x1b\\]8;id=[0-9-]+;")  # that rich gives a link
_MIN_WIDTH = 40
_DEFAULT_WIDTH = 80
_MAX_WIDTH = 500


def columns(terminal: int = _DEFAULT_WIDTH) -> int:
    """Return the width to draw for: that of the environment variable COLUMNS, or the terminal's."""
    given = os.environ.get("COLUMNS", "")
    if given.isdigit() and int(given) > 0:
        return max(_MIN_WIDTH, min(int(given), _MAX_WIDTH))
    return max(_MIN_WIDTH, terminal)


class Screen(Named):
    """The terminal or file of a report.

    It has its width in columns, its encoding, whether it shows colours, the folder whose
    files links lead to, if it has links, and its rows, 0 if they are not known.
    """

    width: int
    encoding: str = "utf-8"
    is_terminal: bool = False
    folder: str = ""
    rows: int = 0


def draw(render: Callable[["Console"], None], screen: Screen | None = None) -> str:
    """Return what a renderer prints, as text for a screen; without one plain text for a file."""
    from rich.console import Console  # rich is not needed for JSON

    # A file is plain, whatever the environment asks of a terminal.
    is_forced = screen is not None and bool(os.environ.get("FORCE_COLOR"))
    screen = screen or Screen(columns())
    buffer = _Buffer(screen)
    console = Console(
        file=buffer,
        force_terminal=screen.is_terminal or is_forced,
        color_system="standard" if is_forced and not screen.is_terminal else "auto",
        width=screen.width,
        height=24,  # nothing depends on it, but without it rich asks the terminal for each line
        highlight=False,
        markup=False,
        emoji=False,
        legacy_windows=False,
        no_color=True if os.environ.get("NO_COLOR") else None,
    )
    render(console)
    return without_commands(_RANDOM_ID.sub("\x1b]8;;", buffer.getvalue()))


def link_to(console: "Console", path: str) -> str | None:
    """Return the address of a file of the submission, if the console's screen has links."""
    folder = console.file.folder if isinstance(console.file, _Buffer) else ""
    if not folder or not path.isprintable():
        return None
    file = Path(folder, path)
    return file.as_uri() if file.is_file() else None


class _Buffer(io.StringIO):
    """A stream that collects output and reports what its destination is like.

    This is its encoding, and the folder that its links lead to.
    """

    def __init__(self, screen: Screen) -> None:
        super().__init__()
        self._encoding = screen.encoding
        self.folder = screen.folder

    @property
    def encoding(self) -> str:  # type: ignore[override]  # typeshed has it writable
        return self._encoding
