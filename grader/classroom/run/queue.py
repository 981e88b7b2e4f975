"""Submissions in an executor: in groups as long as no task fails, one by one after a failure."""

import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from functools import cache

from grader.classroom.gradebook.result import GradingResult
from grader.classroom.run.pool import WorkerError
from grader.classroom.run.worker import ClassContext, Task, failed, grade_all

_GROUP_TIME = 0.05  # seconds of work that are worth one message to a worker
_MAX_GROUP = 64
_AHEAD = 3  # groups for each worker: one at work, the others ready
_MAX_TRIES = 3


class Queue:
    """Submits tasks and collects results.

    A submission whose grading is lost is tried alone, then without its documents; if that is lost as well, it is
    `errored`.
    """

    def __init__(self, executor: Executor, workers: int, context: Callable[[], ClassContext]) -> None:
        self._executor, self._workers = executor, workers
        self._context = cache(context)
        self._waiting: deque[Task] = deque()
        self._alone: deque[tuple[Task, int]] = deque()
        self._running: dict[Future[list[GradingResult]], tuple[Sequence[Task], int]] = {}
        self._began = 0.0
        self._done = 0

    def put(self, task: Task) -> None:
        """Add a task, and submit all that are ready."""
        self._waiting.append(task)
        self._submit_ready(all_in=False)

    @property
    def is_full(self) -> bool:
        """Return whether more tasks wait than can be submitted now."""
        return len(self._waiting) >= self._group_size and len(self._running) >= self._workers * _AHEAD

    def take(self, *, all_in: bool) -> Iterator[list[GradingResult]]:
        """Submit all ready tasks and yield results as they come; `all_in` says that no more tasks will be added."""
        self._submit_ready(all_in=all_in)
        if not self._running:
            return
        finished, _ = wait(self._running, return_when=FIRST_COMPLETED)
        for future in finished:
            results = self._results(future)
            self._done += len(results)
            if results:
                yield results
        self._submit_ready(all_in=all_in)

    def __len__(self) -> int:
        return len(self._waiting) + len(self._alone) + len(self._running)

    @property
    def _group_size(self) -> int:
        if not self._done:
            return 1
        seconds = (time.perf_counter() - self._began) * self._workers / self._done  # for one submission
        return max(1, min(_MAX_GROUP, int(_GROUP_TIME / seconds)))

    def _submit_ready(self, *, all_in: bool) -> None:
        self._began = self._began or time.perf_counter()
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
        self._running[self._executor.submit(grade_all, self._context(), tasks)] = (tasks, tries)

    def _results(self, future: "Future[list[GradingResult]]") -> list[GradingResult]:
        tasks, tries = self._running.pop(future)
        try:
            return future.result()
        except Exception as error:  # noqa: BLE001  any failure affects one submission at most
            is_lost = isinstance(error, WorkerError)
            if len(tasks) > 1:
                self._alone += [(task, 1) for task in tasks]
            elif isinstance(error, WorkerError) and not error.is_own_fault and tries < _MAX_TRIES:
                self._alone.append((tasks[0], tries + 1))
            elif is_lost and not tasks[0].no_documents:  # a document may be the cause
                self._alone.append((tasks[0]._replace(no_documents=str(error)), 1))
            else:
                reason = str(error) if is_lost else f"{type(error).__name__}: {error}"
                result = GradingResult(tasks[0].key, "errored", "", "", reason=reason)
                return [failed(self._context(), tasks[0], result)]
            return []
