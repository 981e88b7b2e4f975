"""How worker processes start: forked from a server that loads the grader once.

The server loads it beside the command's own imports.
"""

import multiprocessing
import os
import signal
from collections.abc import Sequence
from typing import Any


def worker_context(preload: Sequence[str] = ()) -> Any:
    """Return the multiprocessing context.

    It is a fork server with the grader's modules, else it spawns processes.

    Args:
        preload: The modules that the server loads before it forks, late imports included.
    """
    os.environ.setdefault(
        "OPENBLAS_NUM_THREADS", "1"
    )  # each worker is one thread; there are enough of them
    # Python looks for modules in the current folder first, which may be a class's: nothing there
    # may be imported.
    os.environ["PYTHONSAFEPATH"] = "1"
    is_forked = "forkserver" in multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("forkserver" if is_forked else "spawn")
    if is_forked:
        context.set_forkserver_preload(list(preload))
    return context


def start_server(preload: Sequence[str] = ()) -> None:
    """Start the fork server with Ctrl-C blocked.

    Otherwise it would print a traceback of its own while it loads modules.
    """
    if worker_context(preload).get_start_method() == "forkserver":
        from multiprocessing import forkserver, resource_tracker

        resource_tracker.ensure_running()  # first, because it unblocks signals when it has started
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            forkserver.ensure_running()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
