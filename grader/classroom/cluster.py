"""The same work on a Dask cluster: each of its workers grades in processes of its own, so that no hand-in can end it."""

import multiprocessing
from collections.abc import Callable
from concurrent.futures import Executor, Future
from functools import lru_cache
from pathlib import Path
from typing import Any

from grader import __version__
from grader.classroom.pool import Lost, Processes
from grader.classroom.work import PRELOAD, prepare
from grader.errors import InputError
from grader.submission.files import printable_path

_PATIENCE = 10.0  # seconds to find the scheduler, and to have an answer of every worker


class Cluster(Executor):
    """An executor whose tasks run on the workers of a Dask cluster; raises InputError where it cannot be used.

    `root` is the class: every worker has to see it at the same path. A worker that is lost is Dask's business: its tasks go to
    another one, and one that ends worker after worker is told as Lost.
    """

    def __init__(self, address: str, timeout: float, root: Path) -> None:
        try:
            import distributed
        except ImportError:
            raise InputError("--cluster needs Dask: pip install 'grader[cluster]'") from None
        self._timeout = timeout
        dask: Any = distributed  # it has no annotations
        try:
            self._client = dask.Client(address, timeout=_PATIENCE, set_as_default=False)
        except (OSError, ValueError) as error:
            raise InputError(f"there is no Dask scheduler at {address}: {error}") from None
        try:
            self.workers = self._checked(address, root)
        except BaseException:
            self._client.close()
            raise
        self._inner = self._client.get_executor(pure=False)

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> "Future[Any]":
        """Have a function run on the cluster."""
        done: Future[Any] = Future()
        inner = self._inner.submit(_apart, self._timeout, function, arguments, named)
        inner.add_done_callback(lambda future: _pass_on(future, done))
        return done

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Leave the cluster; its workers stay."""
        self._inner.shutdown(wait=wait, cancel_futures=cancel_futures)
        self._client.close()

    def _checked(self, address: str, root: Path) -> int:
        """How many tasks the workers take at once; raises InputError where one of them could not grade this class."""
        threads = self._client.nthreads()
        if not threads:
            raise InputError(f"the Dask cluster at {address} has no workers yet: dask worker {address}")
        try:
            answers = self._client.run(_introduce, str(root))
        except Exception as error:  # noqa: BLE001  a worker without the grader, whatever it says
            raise InputError(f"a worker of {address} cannot grade: {type(error).__name__}: {error}") from None
        for worker, (version, sees) in sorted(answers.items()):
            if version != __version__:
                raise InputError(f"the worker {worker} has grader {version}, and this is {__version__}")
            if not sees:
                raise InputError(f"the worker {worker} does not see {printable_path(root)}: share that folder with it")
        return sum(threads.values())


def _introduce(root: str) -> tuple[str, bool]:
    """What a worker has to say for itself: which grader it has, and whether it sees the class."""
    return __version__, Path(root).exists()


def _apart(timeout: float, function: Callable[..., Any], arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
    """Run a function in a process of this worker's; raises Lost."""
    return _processes(timeout).submit(function, *arguments, **named).result()


@lru_cache(maxsize=1)
def _processes(timeout: float) -> Processes:
    from distributed import get_worker

    # Dask starts its workers as daemons, which may have no processes of their own; those that pebble starts end with it.
    multiprocessing.current_process().daemon = False
    return Processes(get_worker().state.nthreads, timeout, prepare, preload=PRELOAD)


def _pass_on(inner: "Future[Any]", done: "Future[Any]") -> None:
    try:
        done.set_result(inner.result())
    except Lost as lost:
        done.set_exception(lost)
    except Exception as error:  # noqa: BLE001  such as Dask's KilledWorker
        known = type(error).__name__ == "KilledWorker"
        done.set_exception(Lost("it ended one worker of the cluster after the other") if known else error)
