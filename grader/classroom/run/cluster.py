"""The same work on a Dask cluster: each of its workers grades in processes of its own, so that no hand-in can end it."""

import asyncio
import logging
import multiprocessing
import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, Executor, Future
from functools import lru_cache
from multiprocessing.util import Finalize
from pathlib import Path
from typing import Any

from grader import __version__
from grader.classroom.run.pool import Processes, WorkerError
from grader.classroom.run.worker import PRELOAD, prepare
from grader.errors import InputError
from grader.text import printable_path

_PATIENCE = 10.0  # seconds to find the scheduler, and to have an answer of every worker
_NO_LIMIT = 0.0  # every run says how long its tasks may take
_one_at_a_time = threading.Lock()  # a worker may have many threads


class Cluster(Executor):
    """An executor whose tasks run on the workers of a Dask cluster; raises InputError where it cannot be used.

    `root` is the class: every worker has to see it at the same path. A worker that is lost is Dask's business: its tasks go to
    another one, and one that ends worker after worker is told as WorkerError.
    """

    def __init__(self, address: str, timeout: float, root: Path) -> None:
        try:
            import distributed
        except ImportError:
            raise InputError("--cluster needs Dask: pip install 'urdf-grader[cluster]'") from None
        self._timeout, self._address = timeout, address
        self._is_gone = False
        _hush()
        dask: Any = distributed  # it has no annotations
        try:
            asyncio.run(_reach(address))  # a client that has failed keeps its process from ending
            self._client = dask.Client(address, timeout=_PATIENCE, set_as_default=False)
        except Exception as error:  # noqa: BLE001  whatever a wrong address, another program or TLS brings about
            reason = str(error) or type(error).__name__
            raise InputError(
                f"there is no Dask scheduler at {address or repr(address)}: {reason} (dask scheduler starts one)"
            ) from None
        try:
            self.workers = self._checked(address, root)
        except BaseException:
            self._client.close()
            raise

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> "Future[Any]":
        """Have a function run on the cluster."""
        done: Future[Any] = Future()
        gone = InputError(f"the Dask scheduler at {self._address} is there no longer")
        if self._is_gone:
            raise gone
        try:
            task = self._client.submit(_apart, self._timeout, function, arguments, named, pure=False)
            self._client.loop.add_callback(self._follow, task, done)
        except Exception:  # noqa: BLE001  Dask has many words for it
            raise gone from None
        return done

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Leave the cluster; its workers stay."""
        del wait, cancel_futures  # whoever leaves waits for nothing more
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

    async def _follow(self, task: Any, done: "Future[Any]") -> None:
        """Wait for a task of the cluster's, and keep the promise whatever becomes of it."""
        try:
            result = await self._client.gather(task, asynchronous=True)
        except (CancelledError, asyncio.CancelledError, OSError):  # nobody here cancels anything
            self._is_gone = True
            result = WorkerError("the cluster that grades came to an end", is_own_fault=False)
        except Exception as error:  # noqa: BLE001  such as Dask's KilledWorker
            known = type(error).__name__ == "KilledWorker"
            result = WorkerError("it ended one worker of the cluster after the other") if known else error
        if isinstance(result, Exception):
            done.set_exception(result)
        else:
            done.set_result(result)


def _hush() -> None:
    """Keep Dask from telling at length what is told here in a line."""
    for name in [name for name in logging.root.manager.loggerDict if name.partition(".")[0] == "distributed"]:
        logging.getLogger(name).setLevel(logging.CRITICAL + 1)


async def _reach(address: str) -> None:
    """Speak to the scheduler once; raises whatever keeps from it."""
    from distributed import Security
    from distributed.comm.core import connect

    how = Security().get_connection_args("client")  # type: ignore[no-untyped-call]
    comm = await connect(address, timeout=_PATIENCE, **how)  # type: ignore[no-untyped-call]
    await comm.close()


def _introduce(root: str) -> tuple[str, bool]:
    """What a worker has to say for itself: which grader it has, and whether it sees the class."""
    return __version__, Path(root).exists()


def _apart(timeout: float, function: Callable[..., Any], arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
    """Run a function in a process of this worker's: what it gives, or WorkerError, which raised would fill the worker's log."""
    with _one_at_a_time:
        processes = _processes()
    try:
        return processes.submit_within(timeout, function, arguments, named).result()
    except WorkerError as lost:
        return lost


@lru_cache(maxsize=1)
def _processes() -> Processes:
    from distributed import get_worker

    # Dask starts its workers as daemons, which may have no processes of their own; those that pebble starts end with it.
    multiprocessing.current_process().daemon = False
    processes = Processes(get_worker().state.nthreads, _NO_LIMIT, prepare, preload=PRELOAD)
    Finalize(None, processes.shutdown, exitpriority=1)  # before a worker that ends waits for what it has started
    return processes
