"""Worker processes on this machine: an executor as in `concurrent.futures` whose tasks end in any case."""

import os
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError, Executor, Future
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from pebble import ProcessExpired, ProcessPool

from grader.classroom.run.worker_process import (
    EXIT_CHANNEL_BLOCKED,
    exit_words,
    start_server,
    start_worker,
    worker_context,
)
from grader.errors import GraderError

MAX_MEMORY = 2 * 1024**3  # bytes for each worker
NO_MEMORY = f"grading it needs more memory than a worker may use ({MAX_MEMORY // 1024**3} GiB)"
_POOL_ENDED = "the worker processes ended"
_CHECK_INTERVAL = 0.5  # seconds
_MAX_TRIES = 3  # to submit a task to a pool, which may break at any moment


class WorkerError(GraderError):
    """Why a task has no result, as a message for a report. `is_own_fault` is False if another task may be the cause."""

    def __init__(self, reason: str, *, is_own_fault: bool = True) -> None:
        super().__init__(reason)
        self.is_own_fault = is_own_fault


class Processes(Executor):
    """Worker processes. A task that takes longer than `timeout` seconds, or ends its worker, raises WorkerError from its future.

    Another worker then replaces the one that ended. All of them end with the process that started them, however that ends.
    `prepare` runs in each worker when it starts; the modules in `preload` are loaded once for all, where the system can fork.
    """

    def __init__(
        self,
        workers: int,
        timeout: float,
        prepare: Callable[[int], None],
        memory: int = MAX_MEMORY,
        preload: Sequence[str] = (),
    ) -> None:
        self._workers, self._timeout, self._prepare, self._memory = workers, timeout, prepare, memory
        self._context = worker_context(preload)
        self._lock = threading.RLock()
        self._pending: set[Future[Any]] = set()
        self._is_shut = threading.Event()
        self._has_begun = False
        self._pool = self._new_pool()
        self._watch = threading.Thread(target=self._watch_pool, daemon=True)
        self._watch.start()

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> "Future[Any]":
        """Run a function in a worker."""
        return self.submit_within(self._timeout, function, arguments, named)

    def submit_within(
        self, timeout: float, function: Callable[..., Any], arguments: tuple[Any, ...], named: dict[str, Any]
    ) -> "Future[Any]":
        """Run a function in a worker with its own timeout, in seconds."""
        outer: Future[Any] = Future()
        with self._lock:
            inner = self._schedule(timeout, function, arguments, named)
            self._pending.add(outer)
        inner.add_done_callback(lambda future: self._pass_on(future, outer, timeout))
        return outer

    def _schedule(
        self, timeout: float, function: Callable[..., Any], arguments: tuple[Any, ...], named: dict[str, Any]
    ) -> "Future[Any]":
        if not self._has_begun:
            self._has_begun = True
            start_server(self._context)
        for tries_left in reversed(range(_MAX_TRIES)):
            self._replace_broken_pool()
            try:
                return self._pool.schedule(function, arguments, named, timeout)
            except (RuntimeError, BrokenProcessPool):  # it broke just now
                if not tries_left or self._is_shut.is_set():
                    raise
        raise AssertionError

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the workers at once, whatever they do."""
        del cancel_futures
        self._is_shut.set()
        self._pool.stop()  # type: ignore[no-untyped-call]
        if wait:
            self._pool.join()
            self._watch.join()

    def _new_pool(self) -> ProcessPool:
        arguments = (self._prepare, self._memory)
        return ProcessPool(self._workers, initializer=start_worker, initargs=arguments, context=self._context)

    def _watch_pool(self) -> None:
        """Replace a broken pool: one breaks if a worker is killed while it sends, and then never completes its futures."""
        while not self._is_shut.wait(_CHECK_INTERVAL):
            with self._lock:
                if self._pending:
                    self._replace_broken_pool()

    def _replace_broken_pool(self) -> None:
        if self._pool.active or self._is_shut.is_set():
            return
        self._pool.stop()  # type: ignore[no-untyped-call]
        threading.Thread(target=self._pool.join, daemon=True).start()  # ends the workers that are left
        self._pool = self._new_pool()
        for outer in tuple(self._pending):
            self._complete(outer, WorkerError(_POOL_ENDED, is_own_fault=False))

    def _pass_on(self, inner: "Future[Any]", outer: "Future[Any]", timeout: float) -> None:
        try:
            self._complete(outer, result=inner.result())
        except TimeoutError:
            self._complete(
                outer, WorkerError(f"grading it took longer than {timeout:g} s (--timeout raises the limit)")
            )
        except ProcessExpired as error:
            is_own_fault = error.exitcode != EXIT_CHANNEL_BLOCKED
            reason = f"the process that graded it {exit_words(error.exitcode)}"
            self._complete(outer, WorkerError(reason, is_own_fault=is_own_fault))
        except (BrokenProcessPool, CancelledError):
            self._complete(outer, WorkerError(_POOL_ENDED, is_own_fault=False))
        except MemoryError:
            self._complete(outer, WorkerError(NO_MEMORY))
        except Exception as error:  # noqa: BLE001  the caller decides what to do with it
            self._complete(outer, error)

    def _complete(self, outer: "Future[Any]", error: Exception | None = None, *, result: Any = None) -> None:
        """Complete a future, once."""
        with self._lock:
            if outer not in self._pending:
                return
            self._pending.discard(outer)
        if error is not None:
            outer.set_exception(error)
        else:
            outer.set_result(result)


def processors() -> int:
    """Return the number of processors that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity is not None else os.cpu_count() or 1
