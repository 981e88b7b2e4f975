"""A limit on processor time for a block, so that a slow input fails its test instead of delaying the others."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from time import process_time
from types import FrameType

# The limits separate linear time from quadratic time, which takes twenty seconds and more for a megabyte. A busy machine, and a
# process that holds the objects of five thousand tests, take three times as long as a quiet one.
BUSY = 2.5


class TooSlow(AssertionError):
    """The block has used up its processor time."""


@contextmanager
def processor_time(limit: float) -> Iterator[None]:
    """Fail if the block takes more than so many seconds; without timers in the system, only at its end.

    The seconds are those of an idle machine. A block that catches the exception fails at its end.
    """
    limit *= BUSY
    start = process_time()
    stopped = False
    if hasattr(signal, "setitimer") and current_thread() is main_thread():

        def stop(_number: int, _frame: FrameType | None) -> None:
            nonlocal stopped
            stopped = True
            raise TooSlow(f"more than {limit} s of processor time")

        before = signal.signal(signal.SIGVTALRM, stop)
        signal.setitimer(signal.ITIMER_VIRTUAL, limit)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_VIRTUAL, 0)
            signal.signal(signal.SIGVTALRM, before)
    else:
        yield
    if stopped or process_time() - start > limit:
        raise TooSlow(f"{process_time() - start:.1f} s of processor time, allowed are {limit} s")
