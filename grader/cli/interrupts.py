"""Ctrl-C ends a command without messages of the interpreter."""

import signal
import sys
from _thread import interrupt_main
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Timer, main_thread
from types import FrameType

_DELAY = 0.01  # seconds


@contextmanager
def quiet_interrupts() -> Iterator[None]:
    """Ctrl-C raises KeyboardInterrupt as always, but Python prints nothing about what it interrupts.

    It can arrive where Python cannot raise an exception (a finalizer, a callback of an import): there Python would print the
    KeyboardInterrupt and go on, so it is raised again afterwards. Files that the interrupted code leaves open are no mistake.
    """
    before = signal.getsignal(signal.SIGINT)
    if before is not signal.default_int_handler:  # ignored, as after nohup, or somebody else's
        yield
        return
    arrived: list[int] = []

    def interrupt(number: int, frame: FrameType | None) -> None:
        arrived.append(number)
        signal.default_int_handler(number, frame)

    def ignored(found: "sys.UnraisableHookArgs") -> None:
        if issubclass(found.exc_type, KeyboardInterrupt):
            Timer(_DELAY, _interrupt).start()  # not here: an exception in a hook is printed, too
        elif not (arrived and issubclass(found.exc_type, ResourceWarning)):
            hook(found)

    hook, sys.unraisablehook = sys.unraisablehook, ignored
    signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        sys.unraisablehook = hook


def _interrupt() -> None:
    """Interrupt the main thread, also while it waits."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(main_thread().ident or 0, signal.SIGINT)
    else:  # Windows
        interrupt_main()
