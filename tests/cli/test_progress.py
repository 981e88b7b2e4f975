"""Progress of a class on a terminal of 80 columns: the count, the rate and the time left are complete from the start."""

import fcntl
import io
import os
import pty
import re
import struct
import sys
import termios
import time
from pathlib import Path

import pytest
from rich.console import Console
from rich.progress import Progress

from grader.cli import terminal
from grader.workers.progress import Progress as State
from tests.classroom.gradebooks import ENVIRONMENT, make_class
from tests.samples import ROOT


def on_terminal(*arguments: object) -> str:
    """Return what a command writes to a terminal of 80 columns and 24 lines, without control sequences."""
    child, terminal = pty.fork()
    if child == 0:
        os.chdir(ROOT)
        os.execve(
            sys.executable, [sys.executable, "-m", "grader", *map(str, arguments)], {**ENVIRONMENT, "TERM": "xterm"}
        )
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    written = b""
    while True:
        try:
            some = os.read(terminal, 65536)
        except OSError:  # the terminal of an ended process
            break
        if not some:
            break
        written += some
    os.close(terminal)
    os.waitpid(child, 0)
    return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", written.decode())


@pytest.mark.exhaustive
def test_the_total_is_known_from_the_start(tmp_path: Path) -> None:
    """It is the same for grading and reports, and no total is ever unknown."""
    make_class(tmp_path)
    options = (
        "--rubric",
        tmp_path / "small.toml",
        "--gradebook",
        tmp_path / "book",
        "--reports",
        tmp_path / "reports",
    )
    shown = on_terminal("batch", tmp_path / "class", *options)
    assert "/?" not in shown
    assert re.search(r"grading.* 0/4.* 0/s", shown)
    assert re.search(r"writing reports.* 0/4.* 0/s", shown)
    assert re.findall(r"/(\d+) ", shown) == ["4"] * len(re.findall(r"/\d+ ", shown))


@pytest.mark.parametrize("work", ["grading", "writing reports"])
def test_a_large_class_fits(work: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is cut off at 80 columns, and what is errored or unreadable is counted."""
    screen = io.StringIO()
    console = Console(file=screen, width=80, force_terminal=True, color_system=None, legacy_windows=False)
    bars = Progress(*terminal._bar().columns, console=console, auto_refresh=False, expand=True)
    monkeypatch.setattr(terminal, "_bar", lambda: bars)
    monkeypatch.setattr(sys, "stderr", type("Terminal", (io.StringIO,), {"isatty": lambda _: True})())
    monkeypatch.setattr(time, "monotonic", iter(range(0, 100_000, 100)).__next__)
    with terminal.show_class(work) as show:
        show(State(12345))
        show(State(12345, 7000, 4000, 120, 12))
        with console.capture() as captured:
            console.print(bars.get_renderable())
    line = captured.get()
    assert work in line
    assert re.search(r"11000/12345 \d+/s \S+ 12 errored, 120 unreadable", line), line
    assert "\u2026" not in line
