"""Limits for tests of costs: the lines of Python that a block executes, the same number on every machine, busy or not."""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from types import FrameType
from typing import Any

# Work inside of a built-in function, such as a search with a pattern, is one line. It can only hang.
_HANG_SECONDS = 60.0


class TooMuchWork(AssertionError):
    """The block has executed more lines than allowed, or it hangs."""


class Work:
    """The number of lines that a block has executed so far."""

    lines = 0


@contextmanager
def limited_work(limit: int = sys.maxsize) -> Iterator[Work]:
    """Fail as soon as the functions that a block calls have executed more lines than allowed.

    The limits in the tests are about three times what was counted: they separate linear work from quadratic work. A block that
    catches the exception fails at its end.
    """
    work = Work()

    def count(_frame: FrameType, event: str, _argument: Any) -> Any:
        work.lines += event == "line"
        if work.lines > limit:
            raise TooMuchWork(f"more than {limit} lines were executed")
        return count

    before = sys.gettrace()
    with _hang_limit():
        sys.settrace(count)
        try:
            yield work
        finally:
            sys.settrace(before)
    if work.lines > limit:
        raise TooMuchWork(f"more than {limit} lines were executed")


@contextmanager
def _hang_limit() -> Iterator[None]:
    if not hasattr(signal, "setitimer") or current_thread() is not main_thread():
        yield
        return

    def stop(_number: int, _frame: FrameType | None) -> None:
        raise TooMuchWork(f"it hangs: more than {_HANG_SECONDS} s of processor time")

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, _HANG_SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
