"""Grade on a Dask cluster.

Each Dask worker grades in separate processes, so that no submission can end it.
"""

import asyncio
import logging
import multiprocessing
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError, Executor, Future
from functools import lru_cache
from multiprocessing.util import Finalize
from pathlib import Path
from typing import Any

from grader import __version__
from grader.base.errors import InputError
from grader.base.grouping import Strings
from grader.base.text import printable_path
from grader.workers.pool import Processes, WorkerError

_CONNECT_TIMEOUT = 10.0  # seconds to find the scheduler, and to get an answer from every worker
_NO_TIMEOUT = 0.0  # every run passes its own
_lock = threading.Lock()  # a Dask worker may have many threads


class Cluster(Executor):
    """An executor whose tasks run on the workers of a Dask cluster.

    Raises InputError if it cannot be used.

    `roots` are the class: every worker has to see them at the same paths. If a worker is lost, Dask
    gives its tasks to another one; a task that ends one worker after the other raises WorkerError.
    """

    def __init__(
        self, address: str, timeout: float, roots: Sequence[Path], preload: Sequence[str] = ()
    ) -> None:
        try:
            import distributed
        except ImportError:
            raise InputError("--cluster needs Dask: pip install 'urdf-grader[cluster]'") from None
        self._timeout = timeout
        self._address = address
        self._preload = tuple(preload)
        self._is_gone = False
        for name in [
            name
            for name in logging.root.manager.loggerDict
            if name.partition(".")[0] == "distributed"
        ]:
            logging.getLogger(name).setLevel(
                logging.CRITICAL + 1
            )  # errors are reported in one line here
        dask: Any = distributed  # it has no annotations
        try:
            asyncio.run(
                _connect_once(address)
            )  # a client that has failed keeps its process from ending
            self._client = dask.Client(address, timeout=_CONNECT_TIMEOUT, set_as_default=False)
        except Exception as error:  # noqa: BLE001  a wrong address, another program, TLS: Dask raises many types
            reason = str(error) or type(error).__name__
            raise InputError(
                f"there is no Dask scheduler at {address or repr(address)}: {reason} (start "
                "one with `dask scheduler`)"
            ) from None
        try:
            self.workers = self._check_workers(address, roots)
        except BaseException:
            self._client.close()
            raise

    def submit(
        self, function: Callable[..., Any], /, *arguments: Any, **named: Any
    ) -> "Future[Any]":
        """Run a function on the cluster."""
        outer: Future[Any] = Future()
        gone = InputError(f"lost the connection to the Dask scheduler at {self._address}")
        if self._is_gone:
            raise gone
        try:
            task = self._client.submit(
                _run_in_process,
                self._timeout,
                self._preload,
                function,
                arguments,
                named,
                pure=False,
            )
            self._client.loop.add_callback(self._pass_on, task, outer)
        except Exception:  # noqa: BLE001  Dask raises many types
            raise gone from None
        return outer

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Disconnect from the cluster; its workers stay."""
        del wait, cancel_futures
        self._client.close()

    def _check_workers(self, address: str, roots: Sequence[Path]) -> int:
        """Return how many tasks the workers run at once.

        Raises InputError if one could not grade this class.
        """
        threads = self._client.nthreads()
        if not threads:
            raise InputError(
                f"the Dask cluster at {address} has no workers yet: start one with `dask "
                f"worker {address}`"
            )
        try:
            answers = self._client.run(_version_and_access, list(map(str, roots)))
        except Exception as error:  # noqa: BLE001  a worker without the grader raises any type
            raise InputError(
                f"a worker of {address} cannot grade: {type(error).__name__}: {error}"
            ) from None
        for worker, (version, hidden) in sorted(answers.items()):
            if version != __version__:
                raise InputError(
                    f"the worker {worker} has grader {version}, and this is {__version__}"
                )
            if hidden:
                raise InputError(
                    f"the worker {worker} does not see {printable_path(Path(hidden))}: "
                    "share that folder"
                )
        return sum(threads.values())

    async def _pass_on(self, task: Any, outer: "Future[Any]") -> None:
        """Wait for a task of the cluster, and complete its future in any case."""
        from distributed import KilledWorker

        try:
            result = await self._client.gather(task, asynchronous=True)
        except (
            CancelledError,
            asyncio.CancelledError,
            OSError,
        ):  # no task is cancelled here: the cluster ended
            self._is_gone = True
            result = WorkerError("the cluster ended", is_own_fault=False)
        except KilledWorker:
            result = WorkerError("it ended several workers of the cluster")
        except Exception as error:  # noqa: BLE001  of the task itself, or of Dask
            result = error
        if isinstance(result, Exception):
            outer.set_exception(result)
        else:
            outer.set_result(result)


async def _connect_once(address: str) -> None:
    """Connect to the scheduler and disconnect; raises any error."""
    from distributed import Security
    from distributed.comm.core import connect

    arguments = Security().get_connection_args("client")  # type: ignore[no-untyped-call]
    comm = await connect(address, timeout=_CONNECT_TIMEOUT, **arguments)  # type: ignore[no-untyped-call]
    await comm.close()


def _version_and_access(roots: Sequence[str]) -> tuple[str, str]:
    """Return, on a worker, the version of its grader.

    Also return the first path of the class that the worker does not see.
    """
    return __version__, next((root for root in roots if not Path(root).exists()), "")


def _run_in_process(
    timeout: float,
    preload: Strings,
    function: Callable[..., Any],
    arguments: tuple[Any, ...],
    named: dict[str, Any],
) -> Any:
    """Run a function in a process of this worker, and return its result or a WorkerError.

    A WorkerError that is raised would fill the worker's log.
    """
    with _lock:
        processes = _processes(preload)
    try:
        return processes.submit_within(timeout, function, arguments, named).result()
    except WorkerError as error:
        return error


@lru_cache(maxsize=1)
def _processes(preload: Strings) -> Processes:
    from distributed import get_worker

    # Dask starts its workers as daemons, which may not have processes of their own; those that
    # pebble starts end with it.
    multiprocessing.current_process().daemon = False
    processes = Processes(get_worker().state.nthreads, _NO_TIMEOUT, preload=preload)
    Finalize(
        None, processes.shutdown, exitpriority=1
    )  # before a worker that ends waits for its processes
    return processes
