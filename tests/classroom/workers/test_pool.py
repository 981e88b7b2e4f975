"""The pool of worker processes: whatever runs in them, each future completes in time."""

import multiprocessing
import os
import signal
import sys
import time
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import suppress
from typing import Any

import pytest

from grader.workers.pool import Processes, WorkerError, processors
from tests.command_line import HANG_TIMEOUT

MEMORY = 512 * 1024**2
SLOW = "grading it took longer than 1.5 s of processor time (--timeout raises the limit)"
WAITED = "grading it did not end within 15 s"


@pytest.fixture(scope="module")
def pool() -> Iterator[Processes]:
    """Yield a pool of two workers with half a gigabyte each."""
    with Processes(2, HANG_TIMEOUT, MEMORY) as processes:
        yield processes


def lost(future: "Future[Any]") -> str:
    """Return why there is no result."""
    error = future.exception(HANG_TIMEOUT)
    assert isinstance(error, WorkerError), error
    return str(error)


def _eat() -> int:
    return len(bytearray(2 * MEMORY))


def _raise(kind: type[BaseException]) -> None:
    raise kind("as asked")


def _leave(code: int) -> None:
    os._exit(code)


def _unspeakable() -> object:
    return lambda: None


@pytest.mark.slow
def test_results_come_back(pool: Processes) -> None:
    """Anything that can be sent is returned, with positional and keyword arguments."""
    assert pool.submit(sorted, [3, 1, 2], reverse=True).result(HANG_TIMEOUT) == [3, 2, 1]
    assert len(pool.submit(bytes, 10**7).result(HANG_TIMEOUT)) == 10**7


@pytest.mark.exhaustive
def test_errors_are_raised(pool: Processes) -> None:
    """An error of the function is raised; a result that cannot be sent is reported, too."""
    with pytest.raises(ZeroDivisionError):
        pool.submit(divmod, 1, 0).result(HANG_TIMEOUT)
    with pytest.raises(ValueError, match="as asked"):
        pool.submit(_raise, ValueError).result(HANG_TIMEOUT)
    assert pool.submit(_unspeakable).exception(HANG_TIMEOUT) is not None
    assert pool.submit(len, "abc").result(HANG_TIMEOUT) == 3


def _work() -> None:
    while True:
        with suppress(Exception):
            sum(range(1000))


def _stop() -> None:
    while True:  # a shell that ends may leave its processes running
        signal.raise_signal(signal.SIGSTOP)


@pytest.mark.exhaustive
def test_no_more_memory_than_allowed(pool: Processes) -> None:
    """A task that needs more memory is lost, and its worker continues."""
    assert (
        lost(pool.submit(_eat)) == "grading it needs more memory than a worker has (at most 2 GiB)"
    )
    assert pool.submit(len, "abc").result(HANG_TIMEOUT) == 3


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    ("function", "arguments", "reason"),
    [
        (_leave, (0,), "the process that graded it exited unexpectedly"),
        (_leave, (7,), "the process that graded it ended with exit code 7"),
        (os.abort, (), "the process that graded it was ended by signal 6"),
        (
            signal.raise_signal,
            (signal.SIGKILL,),
            "the process that graded it was ended by signal 9",
        ),
        (_stop, (), WAITED),
        (time.sleep, (600,), WAITED),
        (_work, (), SLOW),
        (sum, (range(10**15),), SLOW),  # one call into C: it cannot be interrupted
    ],
)
def test_a_task_that_ends_or_blocks_its_worker_is_lost(
    function: Any, arguments: tuple[Any, ...], reason: str, pool: Processes
) -> None:
    """Nothing else is lost with it, once the caller has tried again what is not the task's fault: a
    worker that is killed while it holds the channel to its parent ends the pool.
    """
    for _ in range(3):
        ended = pool.submit_within(1.5, function, arguments, {})
        others = [pool.submit(pow, number, 2) for number in range(20)]
        error = ended.exception(HANG_TIMEOUT)
        if not isinstance(error, WorkerError) or error.is_own_fault:
            break
    assert lost(ended) in (reason, WAITED)
    assert [other.result(HANG_TIMEOUT) for other in others] == [number**2 for number in range(20)]


def test_workers_ignore_the_current_folder_and_ctrl_c(pool: Processes) -> None:
    """Modules in the current folder, which may be the class's, are not imported."""
    assert pool.submit(eval, "__import__('sys').flags.safe_path").result(HANG_TIMEOUT)
    assert pool.submit(signal.getsignal, signal.SIGINT).result(HANG_TIMEOUT) is signal.SIG_IGN
    assert "" not in pool.submit(eval, "__import__('sys').path").result(HANG_TIMEOUT)


@pytest.mark.exhaustive
def test_all_workers_killed_at_once(pool: Processes) -> None:
    """As when memory is short: later tasks are done."""
    pids = {pool.submit(_pid_after, 0.2).result(HANG_TIMEOUT) for _ in range(4)}
    for pid in pids:
        os.kill(pid, signal.SIGKILL)
    results = []
    for _ in range(10):
        future = pool.submit(len, "abc")
        results.append(future.exception(HANG_TIMEOUT) or future.result())
    assert results[-1] == 3
    assert all(result == 3 or isinstance(result, WorkerError) for result in results)


def _pid_after(seconds: float) -> int:
    time.sleep(seconds)
    return os.getpid()


@pytest.mark.exhaustive
def test_shutdown_during_work() -> None:
    """Shutting down does not wait for tasks that hang."""
    processes = Processes(1, 10 * HANG_TIMEOUT)
    pid = processes.submit(os.getpid).result(HANG_TIMEOUT)
    processes.submit(time.sleep, 10 * HANG_TIMEOUT)
    began = time.monotonic()
    processes.shutdown()
    assert time.monotonic() - began < HANG_TIMEOUT
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def test_shutdown_before_any_work() -> None:
    """Without a task no process is started."""
    before = multiprocessing.active_children()
    with Processes(2, HANG_TIMEOUT):
        assert multiprocessing.active_children() == before


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="asks the kernel")
def test_as_many_workers_as_processors() -> None:
    """The pool has as many workers as this process may use processors."""
    assert processors() == len(os.sched_getaffinity(0))
