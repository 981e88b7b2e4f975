"""What ends a command early.

This is Ctrl-C, without the interpreter's messages, and limits of processor time and memory.

Everything that reads a student's files counts its own work. The outer limits are for work that is
not counted.
"""

import os
import signal
import sys
from _thread import interrupt_main
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path
from threading import Timer, current_thread, main_thread
from types import FrameType

from grader.base.errors import GraderError, OutOfTime
from grader.base.processor_time import lift_processor_time, limit_processor_time

_DELAY = 0.01  # seconds until an interrupt is repeated
_MEMORY = 2 * 1024**3  # bytes more than at the start


@contextmanager
def quiet_interrupts() -> Iterator[None]:
    """Let Python print nothing about what Ctrl-C interrupts.

    It raises KeyboardInterrupt as always.
    It can arrive where Python cannot raise an exception (a finalizer, a callback of an import):
    there Python would print the KeyboardInterrupt and go on, so it is raised again afterwards.
    Files that the interrupted code leaves open are no mistake.
    """
    before = signal.getsignal(signal.SIGINT)
    if before is not signal.default_int_handler:  # ignored, as after nohup, or somebody else's
        yield
        return
    arrived = []
    is_in_hook = False

    def interrupt(number: int, frame: FrameType | None) -> None:
        arrived.append(number)
        if is_in_hook:  # the machine is so busy that the repeated one is early
            Timer(_DELAY, _interrupt).start()
        else:
            signal.default_int_handler(number, frame)

    def ignored(unraisable: "sys.UnraisableHookArgs") -> None:
        nonlocal is_in_hook
        if issubclass(unraisable.exc_type, KeyboardInterrupt):
            is_in_hook = True
            Timer(_DELAY, _interrupt).start()  # not here: an exception in a hook is printed, too
            is_in_hook = False
        elif issubclass(unraisable.exc_type, OutOfTime):
            pass  # it is raised again
        elif not (arrived and issubclass(unraisable.exc_type, ResourceWarning)):
            hook(unraisable)

    hook = sys.unraisablehook
    sys.unraisablehook = ignored
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


@contextmanager
def outer_limits(seconds: float) -> Iterator[None]:
    """Limit the processor time and the memory of what follows. Raises GraderError."""
    if (
        sys.platform == "win32"
        or find_spec("resource") is None
        or current_thread() is not main_thread()
    ):
        yield
        return
    import resource

    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # each thread reserves memory
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    memory = _size() + _MEMORY
    try:
        limit_processor_time(seconds)
        with suppress(ValueError, OSError):  # one that is lower already stays
            limit = memory if soft == resource.RLIM_INFINITY else min(soft, memory)
            resource.setrlimit(resource.RLIMIT_AS, (limit, hard))
        yield
    except OutOfTime as error:
        raise GraderError(str(error)) from None
    except MemoryError:
        raise GraderError(f"this needs more than {_MEMORY // 1024**2} MiB of memory") from None
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
        lift_processor_time()


def _size() -> int:
    """Return the address space that this process uses; 0 where the system does not tell."""
    with suppress(OSError, ValueError):
        return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * os.sysconf(
            "SC_PAGE_SIZE"
        )
    return 0
