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

from grader.app.cli import streams
from grader.workers.queue import Progress as State
from tests.classroom.gradebooks import ENVIRONMENT, make_class
from tests.cli.terminals import needs_terminal
from tests.samples import ROOT

pytestmark = pytest.mark.slow


def on_terminal(*arguments: object) -> str:
    """Return what a command writes to a terminal of 80 columns and 24 lines, without control sequences."""
    child, terminal = pty.fork()
    if child == 0:
        os.chdir(ROOT)
        os.execve(
            sys.executable,
            [sys.executable, "-m", "grader", *map(str, arguments)],
            {**ENVIRONMENT, "TERM": "xterm"},
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
@needs_terminal
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
    assert re.search(r"grading: 0 of 4\r", shown)
    assert re.search(r"writing reports: 0 of 4\r", shown)
    assert {*re.findall(r" of (\d+)[,\r]", shown)} == {"4"}


@pytest.mark.parametrize("work", ["grading", "writing reports"])
def test_a_large_class_fits(work: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is cut off at 80 columns, what is errored or unreadable is counted, and the line is removed at the end."""
    screen = type("Terminal", (io.StringIO,), {"isatty": lambda _: True})()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr(time, "monotonic", iter(range(0, 100_000, 100)).__next__)
    with streams.show_class(work) as show:
        show(State(12345))
        show(State(12345, 7000, 4000, 120, 12))
    *_, first, _, line, blank, end = screen.getvalue().split("\r")
    assert first == f"{work}: 0 of 12345"
    assert re.fullmatch(
        rf"{work}: 11000 of 12345, \d+/s, \d+ s left \(12 errored, 120 unreadable\)", line
    )
    assert len(line) < 80
    assert (blank, end) == (" " * len(line), "")
