"""Worker processes on this machine.

They are an executor as in `concurrent.futures` whose tasks end in any case.
"""

import errno
import gc
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError, Executor, Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from typing import Any

from pebble import CONSTS, ProcessExpired, ProcessPool

from grader.base.errors import GraderError, OutOfTime
from grader.base.processor_time import CAN_LIMIT, lift_processor_time, limit_processor_time
from grader.workers import forks

MAX_MEMORY = 2 * 1024**3  # bytes for each worker
NO_MEMORY = f"grading it needs more memory than a worker has (at most {MAX_MEMORY // 1024**3} GiB)"
_NOT_STARTED = (
    "the worker processes cannot be started: there may be too many processes, or too little memory"
)
_POOL_ENDED = "the worker processes ended"
# The exit codes of a worker that waited too long for the channel to its parent, or could not use
# it.
_EXIT_CHANNEL_LOST = (1, errno.EPIPE)
_EXIT_ENDED = 70  # the exit code of a worker that exited unexpectedly with exit code 0
# seconds to wait for the channel: a worker that is killed while it sends never releases it
_CHANNEL_TIMEOUT = 3.0
_CHECK_INTERVAL = 0.5  # seconds
# A task ends after this many times its limit of processor time, also if it waits for something.
_WAITING = 10 if CAN_LIMIT else 1
_EXIT_OUT_OF_TIME = -getattr(signal, "SIGXCPU", 0)
_MAX_IDLE = 30.0  # seconds beyond that in which a task must be completed
_MAX_END = 5.0  # seconds in which a pool must end
_MAX_TRIES = 3  # to submit a task to a pool, which may break at any moment


class WorkerError(GraderError):
    """Why a task has no result, as a message for a report.

    `is_own_fault` is False if another task may be the cause; `timeout` is the limit of processor
    time that it reached, 0 if it did not.
    """

    def __init__(self, reason: str, *, is_own_fault: bool = True, timeout: float = 0) -> None:
        super().__init__(reason)
        self.is_own_fault = is_own_fault
        self.timeout = timeout


def out_of_time(timeout: float) -> WorkerError:
    """Return the error for a task that used up its processor time."""
    return WorkerError(
        f"grading it took longer than {timeout:g} s of processor time (--timeout raises the limit)",
        timeout=timeout,
    )


class Processes(Executor):
    """Worker processes.

    The future of a task that exceeds `timeout` seconds of processor time, or ends its worker,
    raises WorkerError.

    Another worker then replaces the one that ended. All of them end with the process that started
    them, however that ends. `memory` is the limit for each worker, in bytes; workers start with
    the modules `preload`.
    """

    def __init__(
        self,
        workers: int,
        timeout: float,
        memory: int = MAX_MEMORY,
        preload: Sequence[str] = (),
    ) -> None:
        self._workers = workers
        self._timeout = timeout
        self._memory = memory
        self._preload = preload
        CONSTS.sleep_unit = 0.02  # seconds; a pool ends after one of them
        self._context = forks.worker_context(preload)
        self._lock = threading.RLock()
        self._pending: dict[Future[Any], float] = {}  # with the timeout of each
        self._progress = 0.0  # when a task was completed, or submitted to an idle pool
        self._is_shut = threading.Event()
        self._pool = self._new_pool()
        self._watch = threading.Thread(target=self._watch_pool, daemon=True)
        self._watch.start()

    def submit(
        self, function: Callable[..., Any], /, *arguments: Any, **named: Any
    ) -> "Future[Any]":
        """Run a function in a worker."""
        return self.submit_within(self._timeout, function, arguments, named)

    def submit_within(
        self,
        timeout: float,
        function: Callable[..., Any],
        arguments: tuple[Any, ...],
        named: dict[str, Any],
    ) -> "Future[Any]":
        """Run a function in a worker with its own timeout, in seconds of processor time."""
        outer: Future[Any] = Future()
        with self._lock:
            forks.start_server(self._preload)  # again if it has ended
            for tries_left in reversed(range(_MAX_TRIES)):
                try:
                    self._replace_broken_pool()
                    task = (timeout, function, arguments, named)
                    inner = self._pool.schedule(_run_limited, task, {}, _WAITING * timeout)
                    break
                except (RuntimeError, OSError, BrokenProcessPool) as error:  # it broke just now
                    if not tries_left or self._is_shut.is_set():
                        raise WorkerError(_NOT_STARTED, is_own_fault=False) from error
                    time.sleep(_CHECK_INTERVAL)  # a fork server that could not fork is about to end
            self._progress = self._progress if self._pending else time.monotonic()
            self._pending[outer] = _WAITING * timeout
        inner.add_done_callback(lambda future: self._pass_on(future, outer, timeout))
        return outer

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the workers at once, whatever they do."""
        del cancel_futures
        self._is_shut.set()
        self._pool.stop()  # type: ignore[no-untyped-call]
        if wait:
            # Ctrl-C while the pool takes a task can leave one of its threads waiting forever; its
            # workers end before.
            ending = threading.Thread(target=self._pool.join, daemon=True)
            with suppress(RuntimeError):  # no thread can be started
                ending.start()
                ending.join(_MAX_END)
            self._watch.join()

    def _new_pool(self) -> ProcessPool:
        return ProcessPool(self._workers, 0, _start_worker, (self._memory,), self._context)

    def _watch_pool(self) -> None:
        """Replace a broken pool.

        It never completes a task whose worker ended while it sent, or before it began.
        """
        while not self._is_shut.wait(_CHECK_INTERVAL):
            with self._lock:
                if self._pending:
                    idle = time.monotonic() - self._progress
                    self._replace_broken_pool(
                        is_stuck=idle > max(self._pending.values()) + _MAX_IDLE
                    )

    def _replace_broken_pool(self, *, is_stuck: bool = False) -> None:
        if (self._pool.active and not is_stuck) or self._is_shut.is_set():
            return
        self._pool.stop()  # type: ignore[no-untyped-call]
        threading.Thread(
            target=self._pool.join, daemon=True
        ).start()  # ends the workers that are left
        self._pool = self._new_pool()
        for outer in tuple(self._pending):
            self._complete(outer, WorkerError(_POOL_ENDED, is_own_fault=False))

    def _pass_on(self, inner: "Future[Any]", outer: "Future[Any]", timeout: float) -> None:
        try:
            self._complete(outer, result=inner.result())
        except TimeoutError:
            self._complete(
                outer, WorkerError(f"grading it did not end within {_WAITING * timeout:g} s")
            )
        except ProcessExpired as error:
            if error.exitcode == _EXIT_OUT_OF_TIME:
                self._complete(outer, out_of_time(timeout))
                return
            is_own_fault = error.exitcode not in _EXIT_CHANNEL_LOST
            reason = f"the process that graded it {_exit_words(error.exitcode)}"
            self._complete(outer, WorkerError(reason, is_own_fault=is_own_fault))
        except (BrokenProcessPool, CancelledError):
            self._complete(outer, WorkerError(_POOL_ENDED, is_own_fault=False))
        except MemoryError:
            self._complete(outer, WorkerError(NO_MEMORY))
        except Exception as error:  # noqa: BLE001  the caller decides what to do with it
            self._complete(outer, error)

    def _complete(
        self, outer: "Future[Any]", error: Exception | None = None, *, result: Any = None
    ) -> None:
        """Complete a future, once."""
        with self._lock:
            if outer not in self._pending:
                return
            del self._pending[outer]
            self._progress = time.monotonic()
        if error is not None:
            outer.set_exception(error)
        else:
            outer.set_result(result)


def _run_limited(
    timeout: float,
    function: Callable[..., Any],
    arguments: tuple[Any, ...],
    named: dict[str, Any],
) -> Any:
    """Run a function in this worker within a limit of processor time."""
    limit_processor_time(timeout)
    try:
        return function(*arguments, **named)
    except OutOfTime:
        raise out_of_time(timeout) from None
    finally:
        lift_processor_time()


def processors() -> int:
    """Return the number of processors that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    if affinity is not None:
        return len(affinity(0))
    return os.cpu_count() or 1


def _start_worker(memory: int) -> None:
    """Prepare a worker process.

    Its memory is limited, it ignores Ctrl-C, and always ends with its parent.
    """
    leave = os._exit
    # pebble does not notice a worker that ends with exit code 0.
    os._exit = lambda status: leave(status or _EXIT_ENDED)
    CONSTS.channel_lock_timeout = _CHANNEL_TIMEOUT
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent process handles it
    with suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    gc.collect()
    gc.freeze()  # loaded modules are not garbage: do not examine them again
    gc.set_threshold(10_000, 10, 20)
    parent = multiprocessing.parent_process()
    with suppress(ImportError, AttributeError, OSError):
        import fcntl

        # Ask for a signal (SIGIO) when the pipe to the parent closes: a thread could not stop an
        # interpreter that is stuck.
        assert parent is not None
        fcntl.fcntl(parent.sentinel, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(
            parent.sentinel, fcntl.F_SETFL, fcntl.fcntl(parent.sentinel, fcntl.F_GETFL) | os.O_ASYNC
        )


def _exit_words(code: int) -> str:
    """Return how a worker ended, in words."""
    if code == _EXIT_ENDED:
        return "exited unexpectedly"
    if code < 0:
        return f"was ended by signal {-code}"
    return f"ended with exit code {code}"
