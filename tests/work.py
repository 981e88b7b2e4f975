"""Limits for tests of costs: the calls that a block makes, the same number on every machine, busy or not."""

import signal
import sys
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from types import FrameType
from typing import Any

# Work inside of a built-in function, such as a search with a pattern, is one call. It can only hang.
_HANG_SECONDS = 120.0


class TooMuchWork(AssertionError):
    """The block has made more calls than allowed, or it hangs."""


class Work:
    """The number of calls that a block has made so far, of functions in Python and built-in ones."""

    calls = 0


@contextmanager
def limited_work(limit: int = sys.maxsize, of: Collection[str] = ()) -> Iterator[Work]:
    """Fail as soon as a block has made more calls than allowed, of any functions or of built-in ones with these names.

    The limits in the tests are ten times what was counted: they separate linear work from quadratic work. A block that catches
    the exception fails at its end.
    """
    work = Work()

    def count(_frame: FrameType, event: str, function: Any) -> None:
        if event in ("call", "c_call") and (
            not of or (event == "c_call" and function.__name__ in of)
        ):
            work.calls += 1
            if work.calls > limit:
                raise TooMuchWork(f"more than {limit} calls were made")

    before = sys.getprofile()
    with hang_limit():
        sys.setprofile(count)
        try:
            yield work
        finally:
            sys.setprofile(before)
    if work.calls > limit:
        raise TooMuchWork(f"more than {limit} calls were made")


class Steps:
    """The lines that a block has executed so far, one that is a loop each time."""

    steps = 0


@contextmanager
def counted_work() -> Iterator[Steps]:
    """Count the lines that a block executes: also those of loops in one line, which make no call."""
    counted = Steps()

    def count(_frame: FrameType, event: str, _argument: Any) -> Any:
        if event in ("line", "call"):
            counted.steps += 1
        return count

    before = sys.gettrace()
    with hang_limit():
        sys.settrace(count)
        try:
            yield counted
        finally:
            sys.settrace(before)


@contextmanager
def hang_limit(seconds: float = _HANG_SECONDS) -> Iterator[None]:
    """End a block that takes more processor time, and fail."""
    if not hasattr(signal, "setitimer") or current_thread() is not main_thread():
        yield
        return

    def stop(_number: int, _frame: FrameType | None) -> None:
        raise TooMuchWork(f"it hangs: more than {seconds:g} s of processor time")

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
