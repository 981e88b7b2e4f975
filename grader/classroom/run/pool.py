"""Processes that do the work, on this machine: an executor as in `concurrent.futures` whose tasks end, whatever they do."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError, Executor, Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from typing import Any

from pebble import CONSTS, ProcessExpired, ProcessPool

from grader.errors import GraderError

MEMORY = 2 * 1024**3  # bytes that one worker may have
NO_MEMORY = f"grading it needs more memory than a worker may have ({MEMORY // 1024**3} GiB)"
_WATCHED = 0.5  # seconds between two looks at whether the pool still lives
_TRIES = 3  # to have work taken by a pool, which may break at any moment
_SPEAKING = 3.0  # seconds that a worker waits for its turn to speak, which one that was ended in its own turn keeps
_MUTE = 1  # the exit code of a worker that had to wait longer
_LEFT = 70  # the exit code of a worker that was ended in the midst of its work as if all were well


class WorkerError(GraderError):
    """Work that came to nothing, and why, in words for a report. It may have been the fault of what ran beside it."""

    def __init__(self, reason: str, *, is_own_fault: bool = True) -> None:
        super().__init__(reason)
        self.is_own_fault = is_own_fault


class Processes(Executor):
    """Worker processes. What takes longer than `timeout` seconds, or ends its worker, raises WorkerError from its future.

    Another worker then takes the place of the one that ended. All of them end with the process that has started them, however
    that ends. `prepare` is run in each at its start; `preload` names the modules that are loaded once for all of them, where
    the system can fork.
    """

    def __init__(
        self,
        workers: int,
        timeout: float,
        prepare: Callable[[int], None],
        memory: int = MEMORY,
        preload: Sequence[str] = (),
    ) -> None:
        self._workers, self._timeout, self._prepare, self._memory = workers, timeout, prepare, memory
        self._context = _context(preload)
        self._lock = threading.RLock()
        self._promised: set[Future[Any]] = set()
        self._is_shut = threading.Event()
        self._has_begun = False
        self._pool = self._new_pool()
        self._watch = threading.Thread(target=self._watch_pool, daemon=True)
        self._watch.start()

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> "Future[Any]":
        """Have a function run in a worker."""
        return self.submit_within(self._timeout, function, arguments, named)

    def submit_within(
        self, timeout: float, function: Callable[..., Any], arguments: tuple[Any, ...], named: dict[str, Any]
    ) -> "Future[Any]":
        """Have a function run in a worker for at most so many seconds, whatever the others may take."""
        done: Future[Any] = Future()
        with self._lock:
            inner = self._scheduled(timeout, function, arguments, named)
            self._promised.add(done)
        inner.add_done_callback(lambda future: self._pass_on(future, done, timeout))
        return done

    def _scheduled(
        self, timeout: float, function: Callable[..., Any], arguments: tuple[Any, ...], named: dict[str, Any]
    ) -> "Future[Any]":
        if not self._has_begun:
            self._has_begun = True
            _start_server(self._context)
        for left in reversed(range(_TRIES)):
            self._mend()
            try:
                return self._pool.schedule(function, arguments, named, timeout)
            except (RuntimeError, BrokenProcessPool):  # it broke just now
                if not left or self._is_shut.is_set():
                    raise
        raise AssertionError

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the workers: at once, whatever they do."""
        del cancel_futures
        self._is_shut.set()
        self._end()
        if wait:
            self._pool.join()
            self._watch.join()

    def _new_pool(self) -> ProcessPool:
        return ProcessPool(
            self._workers, initializer=_begin, initargs=(self._prepare, self._memory), context=self._context
        )

    def _end(self) -> None:
        self._pool.stop()  # type: ignore[no-untyped-call]

    def _watch_pool(self) -> None:
        """A pool can break where a worker is ended in the midst of speaking, and then forgets what it had promised."""
        while not self._is_shut.wait(_WATCHED):
            with self._lock:
                if self._promised:
                    self._mend()

    def _mend(self) -> None:
        """Take a new pool for one that is broken; what was in it is lost."""
        if self._pool.active or self._is_shut.is_set():
            return
        self._end()
        threading.Thread(target=self._pool.join, daemon=True).start()  # which ends what is left of it
        self._pool = self._new_pool()
        for done in tuple(self._promised):
            self._settle(done, WorkerError("the processes that grade came to an end", is_own_fault=False))

    def _pass_on(self, inner: "Future[Any]", done: "Future[Any]", timeout: float) -> None:
        try:
            self._settle(done, result=inner.result())
        except TimeoutError:
            self._settle(
                done,
                WorkerError(f"grading it took longer than {timeout:g} s, and was stopped (--timeout raises the limit)"),
            )
        except ProcessExpired as error:
            is_own_fault = error.exitcode != _MUTE
            self._settle(
                done, WorkerError(f"the process that graded it {_end_of(error.exitcode)}", is_own_fault=is_own_fault)
            )
        except (BrokenProcessPool, CancelledError):
            self._settle(done, WorkerError("the processes that grade came to an end", is_own_fault=False))
        except MemoryError:
            self._settle(done, WorkerError(NO_MEMORY))
        except Exception as error:  # noqa: BLE001  it is told, whatever it is
            self._settle(done, error)

    def _settle(self, done: "Future[Any]", error: Exception | None = None, *, result: Any = None) -> None:
        """Keep a promise, once."""
        with self._lock:
            if done not in self._promised:
                return
            self._promised.discard(done)
        if error is not None:
            done.set_exception(error)
        else:
            done.set_result(result)


def _end_of(code: int) -> str:
    if code == _LEFT:
        return "ended in the midst of it"
    return f"was ended by signal {-code}" if code < 0 else f"ended with exit code {code}"


def _context(preload: Sequence[str]) -> Any:
    """Where workers come from: a server that has loaded everything once, and forks; spawned where there is no such thing."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # each worker is one thread; there are enough of them
    # Python looks for modules in the current folder first, which may be a class's: nothing there may be imported.
    os.environ["PYTHONSAFEPATH"] = "1"
    methods = multiprocessing.get_all_start_methods()
    context: Any = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
    if "forkserver" in methods and preload:
        context.set_forkserver_preload([*preload, "grader.classroom.run.fork_server"])
    return context


def _start_server(context: Any) -> None:
    """Start what workers are forked from; while it loads it would take Ctrl-C for its own, and tell of it at length."""
    if context.get_start_method() == "forkserver":
        from multiprocessing import forkserver, resource_tracker

        resource_tracker.ensure_running()  # it takes care of itself, and has signals let through when it is done
        with _deaf():
            forkserver.ensure_running()


@contextmanager
def _deaf() -> Iterator[None]:
    """Keep Ctrl-C waiting; processes that are started in here never hear of it."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(prepare: Callable[[int], None], memory: int) -> None:
    """Make a worker ready for work; from now on it ends with the process that has started it, whatever it does."""
    leave = os._exit
    # Of one that ends with 0 pebble hears nothing.
    os._exit = lambda status: leave(status or _LEFT)
    CONSTS.channel_lock_timeout = _SPEAKING
    prepare(memory)
    parent = multiprocessing.parent_process()
    with suppress(ImportError, AttributeError, OSError):
        import fcntl

        # A signal when the pipe to that process closes: no thread could tell what the interpreter does not get out of.
        assert parent is not None
        fcntl.fcntl(parent.sentinel, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(parent.sentinel, fcntl.F_SETFL, fcntl.fcntl(parent.sentinel, fcntl.F_GETFL) | os.O_ASYNC)


def processors() -> int:
    """How many workers this machine keeps busy."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity is not None else os.cpu_count() or 1
