"""--watch: do something now and whenever a watched file changes, until Ctrl-C."""

import gc
import math
import os
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import current_thread, main_thread
from time import time_ns
from typing import TypeVar

from rich.console import Console
from rich.text import Text

from grader.base.errors import GraderError, InputError, MachineError, OutOfTime, RubricError
from grader.base.processor_time import lift_processor_time, limit_processor_time
from grader.base.text import printable_path
from grader.files.folder import read_folder
from grader.report.screen import Screen, draw
from grader.report.writers.terminal_page import Page
from grader.report.writing import Terminal

_POLL = 0.2  # seconds between two looks, at least
_TICKS = 20_000_000  # nanoseconds that the clock of a file system may be behind
_SHARE = 10  # a look at many files is followed by a pause of this many times its own time
_OF_FOLDER = 3  # numbers in the stamp of a folder; that of a file ends with the time of its change
_CLEAR = "\x1b[H\x1b[2J"
_ROWS_OF_WATCH, _LAST_ROWS = 2, 2  # the rule and the row of the cursor; of a report, the score
_MIN_ROWS = 8  # of a report on any terminal
_Stamps = dict[str, tuple[int, ...] | None]
_Result = TypeVar("_Result")


def refuse_watching(path: str, output_format: str) -> None:
    """Raise GraderError for what cannot be watched: standard input, another format."""
    if path in ("", "-"):
        raise GraderError("--watch takes a file or folder: standard input is read only once")
    if output_format != "terminal":
        raise GraderError(
            "--watch prints in the format terminal only: use --save "
            f"{output_format}=FILE instead of --format"
        )


def repeat_on_change(
    watched: Sequence[Path],
    own_paths: Collection[Path],
    terminal: Terminal,
    seconds: float,
    work: Callable[[], tuple[_Result, Sequence[Path]]],
    show: Callable[[_Result], None],
) -> None:
    """Work now and after every change, until Ctrl-C, which raises KeyboardInterrupt.

    A file that cannot be read, or takes too long, is reported, and the work is done again after the
    next change.

    Args:
        watched: The files and folders, the first of which is named.
        own_paths: The files that are written, whose changes do not count.
        terminal: Where it is said what is watched.
        seconds: The processor time that the work may take each time.
        work: Returns a result, and the files that were read besides, which are watched as well.
        show: Shows the result; what it raises ends the watch.
    """
    gc.enable()  # unlike other commands, this one may run for hours
    terminal.warn(f"watching {printable_path(watched[0])}; stop with Ctrl-C")
    for besides in changes(watched, frozenset(map(os.path.realpath, own_paths))):
        try:
            with limited_time(seconds):
                result, read = work()
        except (InputError, MachineError, RubricError) as error:
            if terminal.screen().is_terminal:
                show_round("", terminal)
            for line in str(error).split("\n"):
                terminal.warn(line)
            continue
        besides[:] = read
        show(result)


@contextmanager
def limited_time(seconds: float) -> Iterator[None]:
    """Limit the processor time of what follows, in the main thread. Raises InputError."""
    if current_thread() is not main_thread():
        yield
        return
    try:
        limit_processor_time(seconds)
        yield
    except OutOfTime as error:
        raise InputError(str(error)) from None
    finally:
        lift_processor_time()


def show_round(
    text: str,
    terminal: Terminal,
    changed: Sequence[str] = (),
    *,
    is_first: bool = False,
    is_whole: bool = False,
) -> None:
    """Show a report, then what changed, below a rule with the time but for the first report.

    A terminal is cleared, and what does not fit is omitted before the last rows of the report if
    it need not be shown whole: the first mistake and what changed are on the screen.
    """
    screen = terminal.screen()
    end = (
        _drawn_rows([Text(), *(Text(line, "bold") for line in changed)], screen) if changed else ""
    )
    if not screen.is_terminal:
        terminal.print(("" if is_first else _rule("", screen)) + text + end)
        return
    if screen.rows and not is_whole:
        text = _fitted(text, screen.rows - len(end.splitlines()) - _ROWS_OF_WATCH, screen)
    terminal.print(_CLEAR + _rule("Ctrl-C ends ", screen) + text + end)


def _rule(words: str, screen: Screen) -> str:
    """Return a rule with the time."""
    rule = f"-- {time.strftime('%H:%M:%S')} {words}".ljust(screen.width, "-")
    return _drawn_rows([Text(rule, "dim")], screen)


def _fitted(text: str, room: int, screen: Screen) -> str:
    """Return the first and last rows of a report, if it has more rows than there is room for."""
    rows = text.splitlines(keepends=True)
    excess = len(rows) - max(room, _MIN_ROWS) + 1
    if excess <= 1:
        return text
    last = rows[-_LAST_ROWS:]
    words = f"... {excess} more rows without --watch, or with --verbose"
    first = rows[: len(rows) - _LAST_ROWS - excess]
    return "".join([*first, _drawn_rows([Text(words, "dim")], screen), *last])


def _drawn_rows(rows: list[Text], screen: Screen) -> str:
    """Return rows of text as the screen shows them."""

    def print_rows(console: Console) -> None:
        page = Page(console, [])
        for row in rows:
            page.inset(row, indent=0)
        page.print()

    return draw(print_rows, screen)


def changes(
    watched: Sequence[Path],
    own_paths: Collection[str] = (),
    poll: float = _POLL,
    wait: Callable[[float], object] | None = None,
) -> Iterator[list[Path]]:
    """Yield at once and after every change of the watched files and folders, without end.

    What is yielded is a list for the files that were read besides, which are watched from then on.

    Args:
        watched: The files and folders.
        own_paths: The real paths of files that do not count: the reports that are written.
        poll: The seconds between two looks, at least.
        wait: Waits for some seconds; if it returns true, the next look counts as a change.
    """
    besides: list[Path] = []
    seen = None
    before = {}
    looks = [math.inf]  # the times of the last two
    is_asked: object = False
    while True:
        start = time.monotonic()
        began = time_ns() - _TICKS
        now = _stamps([*watched, *besides], own_paths)
        looks = [looks[-1], time.monotonic() - start]
        pause = max(poll, _SHARE * min(looks))  # a look that a busy machine interrupts is longer
        # What changed since the last look may be half written.
        if is_asked or seen is None or before == now != seen:
            yield besides
            seen = {**_stamps_before(began, _stamps(besides, own_paths)), **now}
        before = now
        is_asked = (wait or time.sleep)(pause)


def _stamps_before(began: int, stamps: _Stamps) -> _Stamps:
    """Return stamps, but None for what changed since a time in nanoseconds.

    Whether the change was read is not known.
    """
    known = dict(stamps)
    for path, stamp in stamps.items():
        if stamp is not None and len(stamp) > _OF_FOLDER and stamp[-1] >= began:
            known[path] = None
    return known


def _stamps(paths: Iterable[Path], own_paths: Collection[str] = ()) -> _Stamps:
    """Return what identifies each file and its content.

    Of a folder, it is that of each file and folder that a grading looks at.
    """
    stamps: _Stamps = {}
    for path in paths:
        names: Iterable[str] = ()
        try:
            tree = read_folder(path) if path.is_dir() else None
            names = (*tree.files, *tree.folders) if tree else ()
        except (InputError, MachineError) as error:
            stamps[str(error)] = None
        files = (path, *(path / name for name in names))
        stamps |= {
            str(file): _stamp(file) for file in files if os.path.realpath(file) not in own_paths
        }
    return stamps


def _stamp(path: Path) -> tuple[int, ...] | None:
    with suppress(OSError, ValueError):
        status = path.stat()
        known = status.st_dev, status.st_ino, status.st_mode
        # A folder changes with each report that is written into it.
        if path.is_dir():
            return known
        return (*known, status.st_size, status.st_mtime_ns, status.st_ctime_ns)
    return None
