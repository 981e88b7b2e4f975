"""Tasks in an executor: in groups as long as none fails, one by one after a failure."""

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from typing import Generic, TypeVar

from grader.classroom.run.pool import WorkerError

_GROUP_TIME = 0.05  # seconds of work that are worth one message to a worker
_MAX_GROUP = 64
_AHEAD = 3  # groups for each worker: one at work, the others ready
_MAX_TRIES = 3

Task = TypeVar("Task")
Result = TypeVar("Result")


class Queue(Generic[Task, Result]):
    """Submits tasks and collects results.

    `work` returns the results of tasks in a worker, and `lost` that of a task which failed alone; None if it has put
    the task back. `size` is the number of tasks in a group; default: as many as take `_GROUP_TIME`.
    """

    def __init__(
        self,
        executor: Executor,
        workers: int,
        work: Callable[[Sequence[Task]], list[Result]],
        lost: Callable[[Task, Exception], Result | None],
        size: int = 0,
    ) -> None:
        self._executor, self._workers, self._size = executor, workers, size
        self._work, self._lost = work, lost
        self._waiting: deque[Task] = deque()
        self._alone: deque[tuple[Task, int]] = deque()
        self._running: dict[Future[list[Result]], tuple[Sequence[Task], int]] = {}
        self._began = 0.0  # when the first results came: until then workers start
        self._done = 0  # since then

    def put(self, task: Task) -> None:
        """Add a task, and submit all that are ready."""
        self._waiting.append(task)
        self._submit_ready(all_in=False)

    def put_back(self, task: Task) -> None:
        """Add a task that was lost, changed, to be tried alone."""
        self._alone.append((task, 1))

    @property
    def is_full(self) -> bool:
        """Return whether more tasks wait than can be submitted now."""
        return len(self._waiting) >= self._group_size and len(self._running) >= self._workers * _AHEAD

    def take(self, *, all_in: bool) -> Iterator[list[Result]]:
        """Submit all ready tasks and yield results as they come; `all_in` says that no more tasks will be added."""
        self._submit_ready(all_in=all_in)
        if not self._running:
            return
        finished, _ = wait(self._running, return_when=FIRST_COMPLETED)
        for future in finished:
            results = self._results(future)
            if self._began:
                self._done += len(results)
            else:
                self._began = time.perf_counter()
            if results:
                yield results
        self._submit_ready(all_in=all_in)

    def all(self, tasks: Iterable[Task]) -> Iterator[list[Result]]:
        """Yield the results of tasks as they come, and no task is made before it can be submitted."""
        for task in tasks:
            self.put(task)
            while self.is_full:
                yield from self.take(all_in=False)
        while len(self):
            yield from self.take(all_in=True)

    def __len__(self) -> int:
        return len(self._waiting) + len(self._alone) + len(self._running)

    @property
    def _group_size(self) -> int:
        if self._size or not self._done:
            return self._size or 1
        seconds = (time.perf_counter() - self._began) * self._workers / self._done  # for one task
        share = self._done // (self._workers * _AHEAD)  # few tasks wait behind one that hangs in their group
        return max(1, min(_MAX_GROUP, share, int(_GROUP_TIME / seconds)))

    def _submit_ready(self, *, all_in: bool) -> None:
        while len(self._running) < self._workers * _AHEAD:
            if self._alone:
                # A task that was lost when all processes ended runs alone.
                if self._alone[0][1] > 1 and self._running:
                    return
                task, tries = self._alone.popleft()
                self._submit([task], tries)
                if tries > 1:
                    return
                continue
            count = self._group_size
            if not self._waiting or (len(self._waiting) < count and not all_in):
                return
            self._submit([self._waiting.popleft() for _ in range(min(count, len(self._waiting)))], 1)

    def _submit(self, tasks: Sequence[Task], tries: int) -> None:
        self._running[self._executor.submit(self._work, tasks)] = (tasks, tries)

    def _results(self, future: "Future[list[Result]]") -> list[Result]:
        tasks, tries = self._running.pop(future)
        try:
            return future.result()
        except Exception as error:  # noqa: BLE001  any failure affects one task at most
            is_own_fault = not isinstance(error, WorkerError) or error.is_own_fault
            if len(tasks) > 1:
                self._alone += [(task, 1) for task in tasks]
            elif not is_own_fault and tries < _MAX_TRIES:
                self._alone.append((tasks[0], tries + 1))
            elif (result := self._lost(tasks[0], error)) is not None:
                return [result]
            return []
