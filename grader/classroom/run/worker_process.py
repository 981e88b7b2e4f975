"""The start and end of worker processes: from a fork server that has loaded everything once, and with their parent."""

import multiprocessing
import os
import signal
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from pebble import CONSTS

EXIT_CHANNEL_BLOCKED = 1  # the exit code of a worker that waited too long for the channel to its parent
EXIT_ENDED = 70  # the exit code of a worker that was ended at work with exit code 0
_CHANNEL_TIMEOUT = 3.0  # seconds to wait for the channel: a worker that is killed while it sends never releases it


def worker_context(preload: Sequence[str]) -> Any:
    """Return the multiprocessing context of workers: a fork server with the `preload` modules, else spawned processes."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # each worker is one thread; there are enough of them
    # Python looks for modules in the current folder first, which may be a class's: nothing there may be imported.
    os.environ["PYTHONSAFEPATH"] = "1"
    is_forked = "forkserver" in multiprocessing.get_all_start_methods()
    context: Any = multiprocessing.get_context("forkserver" if is_forked else "spawn")
    if is_forked and preload:
        context.set_forkserver_preload([*preload, "grader.classroom.run.fork_server"])
    return context


def start_server(context: Any) -> None:
    """Start the fork server with Ctrl-C blocked: while it loads modules it would print a traceback."""
    if context.get_start_method() == "forkserver":
        from multiprocessing import forkserver, resource_tracker

        resource_tracker.ensure_running()  # first, because it unblocks signals when it has started
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            forkserver.ensure_running()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


def start_worker(prepare: Callable[[int], None], memory: int) -> None:
    """Prepare a worker process; from now on it ends with its parent, whatever it does."""
    leave = os._exit
    # pebble does not notice a worker that ends with exit code 0.
    os._exit = lambda status: leave(status or EXIT_ENDED)
    CONSTS.channel_lock_timeout = _CHANNEL_TIMEOUT
    prepare(memory)
    parent = multiprocessing.parent_process()
    with suppress(ImportError, AttributeError, OSError):
        import fcntl

        # Ask for a signal (SIGIO) when the pipe to the parent closes: a thread could not stop an interpreter that is stuck.
        assert parent is not None
        fcntl.fcntl(parent.sentinel, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(parent.sentinel, fcntl.F_SETFL, fcntl.fcntl(parent.sentinel, fcntl.F_GETFL) | os.O_ASYNC)


def exit_words(code: int) -> str:
    """Return how a worker ended, in words."""
    if code == EXIT_ENDED:
        return "exited unexpectedly"
    return f"was ended by signal {-code}" if code < 0 else f"ended with exit code {code}"
