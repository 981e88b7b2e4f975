"""Tasks in an executor, and the progress of a run.

They run in groups as long as none fails, one by one after a failure.
"""

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import dataclass, replace
from itertools import islice
from typing import Generic, TypeVar

from grader.workers.pool import WorkerError

_GROUP_TIME = 0.05  # seconds of work that are worth one message to a worker
_MAX_GROUP = 64
_AHEAD = 3  # groups for each worker: one at work, the others ready
_MAX_TRIES = 3
_Task = TypeVar("_Task")
_Result = TypeVar("_Result")


@dataclass(frozen=True, slots=True)
class Progress:
    """The progress of a run.

    `errored` and `unreadable` count submissions that were graded in this run.
    """

    total: int
    graded: int = 0
    unchanged: int = 0
    unreadable: int = 0
    errored: int = 0
    note: str = ""  # what is said besides the counts

    @property
    def done(self) -> int:
        """The number of submissions that have a result."""
        return self.graded + self.unchanged

    def with_result(self, verdict: str) -> "Progress":
        """Return the progress after one more result."""
        if verdict == "unchanged":
            return replace(self, unchanged=self.unchanged + 1)
        return replace(
            self,
            graded=self.graded + 1,
            unreadable=self.unreadable + (verdict == "unreadable"),
            errored=self.errored + (verdict == "errored"),
        )


class Queue(Generic[_Task, _Result]):
    """Submits tasks and collects results.

    `work` returns the results of tasks in a worker. Where a task fails alone, `retried` returns
    another one to be tried in its place, or None, and `given_up` its result then. `size` is the
    number of tasks in a group; default: as many as take `_GROUP_TIME`.
    """

    def __init__(
        self,
        executor: Executor,
        workers: int,
        work: Callable[[Sequence[_Task]], list[_Result]],
        retried: Callable[[_Task, WorkerError], _Task | None],
        given_up: Callable[[_Task, Exception], _Result],
        size: int = 0,
    ) -> None:
        self._executor = executor
        self._workers = workers
        self._size = size
        self._work = work
        self._retried = retried
        self._given_up = given_up
        self._waiting_alone: deque[tuple[_Task, int]] = deque()
        self._running: dict[Future[list[_Result]], tuple[Sequence[_Task], int]] = {}
        self._began = 0.0  # when the first results came: until then workers start
        self._done = 0  # since then

    def results(self, tasks: Iterable[_Task]) -> Iterator[list[_Result]]:
        """Yield the results of tasks as they come; no task is taken before it can be submitted."""
        waiting = iter(tasks)
        self._submit_ready(waiting)
        while self._running:
            for future in wait(self._running, return_when=FIRST_COMPLETED).done:
                results = self._results(future)
                if self._began:
                    self._done += len(results)
                else:
                    self._began = time.perf_counter()
                if results:
                    yield results
            self._submit_ready(waiting)

    def _submit_ready(self, waiting: Iterator[_Task]) -> None:
        while len(self._running) < self._workers * _AHEAD:
            if not self._waiting_alone:
                if not (group := list(islice(waiting, self._group_size))):
                    return
                self._submit(group, 1)
            elif self._waiting_alone[0][1] > 1 and self._running:
                return
            else:
                task, tries = self._waiting_alone.popleft()
                self._submit([task], tries)
                if tries > 1:  # it was lost when all processes ended: it runs alone
                    return

    def _submit(self, tasks: Sequence[_Task], tries: int) -> None:
        self._running[self._executor.submit(self._work, tasks)] = (tasks, tries)

    @property
    def _group_size(self) -> int:
        if self._size or not self._done:
            return self._size or 1
        seconds = (time.perf_counter() - self._began) * self._workers / self._done  # for one task
        share = self._done // (
            self._workers * _AHEAD
        )  # few tasks wait behind one that hangs in their group
        return max(1, min(_MAX_GROUP, share, int(_GROUP_TIME / seconds)))

    def _results(self, future: "Future[list[_Result]]") -> list[_Result]:
        tasks, tries = self._running.pop(future)
        try:
            return future.result()
        except Exception as error:  # noqa: BLE001  any failure affects one task at most
            if len(tasks) > 1:
                self._waiting_alone += [(task, 1) for task in tasks]
            elif isinstance(error, WorkerError) and not error.is_own_fault and tries < _MAX_TRIES:
                self._waiting_alone.append((tasks[0], tries + 1))
            elif (
                isinstance(error, WorkerError)
                and (other := self._retried(tasks[0], error)) is not None
            ):
                self._waiting_alone.append((other, 1))
            else:
                return [self._given_up(tasks[0], error)]
            return []
