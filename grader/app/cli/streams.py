"""What the commands print on: standard output, and standard error with the progress of a batch."""

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from grader.base.text import without_commands
from grader.report.screen import Screen, columns
from grader.report.writing import Terminal, write_stdout

if TYPE_CHECKING:
    from grader.workers.queue import Progress

_VTE_WITH_LINKS = 5000  # the library of GNOME Terminal and others
# Terminals with links, by TERM or TERM_PROGRAM.
_TERMINALS = ("kitty", "alacritty", "foot", "ghostty", "iTerm.app", "WezTerm", "vscode", "Hyper")
_LINE_SECONDS = 10.0
_TERMINAL_SECONDS = 0.1


def screen(here: str | None = None) -> Screen:
    """Return the size and encoding of standard output, and whether it is a terminal.

    `here` is what comes before the paths of a report in the current folder, to which links may
    lead.
    """
    out = sys.stdout
    is_terminal = out is not None and out.isatty()
    width = columns()
    rows = 0
    if is_terminal:
        with suppress(OSError):
            size = os.get_terminal_size(out.fileno())
            width = columns(size.columns)
            rows = size.lines
    if os.environ.get("TERM") == "dumb":  # it has lines, and no commands: it cannot be cleared
        is_terminal = False
    encoding = (out.encoding if out is not None else "") or "utf-8"
    is_forced = bool(os.environ.get("FORCE_HYPERLINK"))
    if here is None or not (is_forced or (is_terminal and _shows_links())):
        return Screen(width, encoding, is_terminal, rows=rows)
    return Screen(width, encoding, is_terminal, str(Path(here).resolve()), rows)


def _shows_links() -> bool:
    """Return whether the terminal is known to show links (OSC 8): others may print them."""
    version = os.environ.get("VTE_VERSION", "")
    if version.isdigit() and int(version) >= _VTE_WITH_LINKS:
        return True
    if any(os.environ.get(name) for name in ("WT_SESSION", "KONSOLE_VERSION", "KITTY_WINDOW_ID")):
        return True
    kind = os.environ.get("TERM", "").removeprefix("xterm-")
    return kind in _TERMINALS or os.environ.get("TERM_PROGRAM") in _TERMINALS


def warn(message: str) -> None:
    """Write a line to standard error."""
    write_stderr(without_commands(f"grader: {message}") + "\n")


def pass_on(data: bytes) -> None:
    """Write bytes of another program to standard error, as they are."""
    if sys.stderr is not None:
        with suppress(OSError):
            sys.stderr.buffer.write(data)
            sys.stderr.flush()


def write_stderr(text: str) -> None:
    """Write to standard error, if it is open."""
    if sys.stderr is not None:
        with suppress(OSError):
            sys.stderr.write(text)
            sys.stderr.flush()


@contextmanager
def show_class(work: str) -> Iterator[Callable[["Progress"], None]]:
    """Show the progress of a pass over a class, whose work is named.

    Yields the function that receives it. It is one line that changes on a terminal, else a line
    every ten seconds.
    """
    began = last_line = time.monotonic()
    is_terminal = sys.stderr is not None and sys.stderr.isatty()
    pause = _TERMINAL_SECONDS if is_terminal else _LINE_SECONDS
    width = 0

    def replace(text: str) -> None:
        nonlocal width
        write_stderr(without_commands(f"\r{' ' * width}\r{text}"))
        width = len(text)

    def show(progress: "Progress") -> None:
        nonlocal last_line
        now = time.monotonic()
        if now - last_line > pause or (is_terminal and not progress.done):
            last_line = now
            text = _progress_line(progress, now - began)
            if is_terminal:
                replace(f"{work}: {text}"[: columns() - 1])
            else:
                warn(text)

    try:
        yield show
    finally:
        if width:
            replace("")


def _progress_line(progress: "Progress", seconds: float) -> str:
    if not (progress.done and seconds):  # nothing tells the time left
        return f"{progress.done} of {progress.total}"
    rate = progress.done / seconds
    left = (progress.total - progress.done) / rate
    kinds = (progress.errored, "errored"), (progress.unreadable, "unreadable")
    texts = [f"{count} {kind}" for count, kind in kinds if count]
    counts = ", ".join([*texts, progress.note] if progress.note else texts)
    time_left = f"{left:.0f} s" if left < 100 else f"{left / 60:.0f} min"
    return (
        f"{progress.done} of {progress.total}, {rate:.0f}/s, {time_left} "
        f"left{f' ({counts})' if counts else ''}"
    )


TERMINAL = Terminal(write_stdout, warn, screen, show_class)
