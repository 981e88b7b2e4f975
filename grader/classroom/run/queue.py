"""Hand-ins on their way through an executor: many in one task while all goes well, each on its own where it does not."""

import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from functools import cache

from grader.classroom.gradebook.result import GradingResult
from grader.classroom.run.pool import WorkerError
from grader.classroom.run.worker import ClassContext, Task, failed, grade_all
from grader.grading.rubric import Rubric

_TASK_TIME = 0.05  # seconds of work that are worth being handed out at once
_MAX_TOGETHER = 64
_AHEAD = 3  # tasks for each worker: one at work, the others at hand
_TRIES = 3


class Queue:
    """Hands tasks out and takes results in. A hand-in whose grading is lost is tried alone, then without its documents.

    Where that is lost as well it is `errored`.
    """

    def __init__(self, executor: Executor, workers: int, common: Callable[[], ClassContext], rubric: Rubric) -> None:
        self._executor, self._workers, self._rubric = executor, workers, rubric
        self._common = cache(common)
        self._waiting: deque[Task] = deque()
        self._alone: deque[tuple[Task, int]] = deque()
        self._out: dict[Future[list[GradingResult]], tuple[Sequence[Task], int]] = {}
        self._began = 0.0
        self._done = 0

    def put(self, task: Task) -> None:
        """Add a hand-in, and hand out what is ready."""
        self._waiting.append(task)
        self._hand_out(all_in=False)

    @property
    def is_full(self) -> bool:
        """Whether there is more at hand than can be handed out now."""
        return len(self._waiting) >= self._together and len(self._out) >= self._workers * _AHEAD

    def take(self, *, all_in: bool) -> Iterator[list[GradingResult]]:
        """Hand out what is ready and wait for results; `all_in` says that nothing more will be put in."""
        self._hand_out(all_in=all_in)
        if not self._out:
            return
        finished, _ = wait(self._out, return_when=FIRST_COMPLETED)
        for future in finished:
            results = self._results(future)
            self._done += len(results)
            if results:
                yield results
        self._hand_out(all_in=all_in)

    def __len__(self) -> int:
        return len(self._waiting) + len(self._alone) + len(self._out)

    @property
    def _together(self) -> int:
        if not self._done:
            return 1
        each = (time.perf_counter() - self._began) * self._workers / self._done
        return max(1, min(_MAX_TOGETHER, int(_TASK_TIME / each)))

    def _hand_out(self, *, all_in: bool) -> None:
        self._began = self._began or time.perf_counter()
        while len(self._out) < self._workers * _AHEAD:
            if self._alone:
                if (
                    self._alone[0][1] > 1 and self._out
                ):  # it was at work when all processes ended: nothing runs beside it now
                    return
                task, tries = self._alone.popleft()
                self._submit([task], tries)
                if tries > 1:
                    return
                continue
            count = self._together
            if not self._waiting or (len(self._waiting) < count and not all_in):
                return
            self._submit([self._waiting.popleft() for _ in range(min(count, len(self._waiting)))], 1)

    def _submit(self, tasks: Sequence[Task], tries: int) -> None:
        self._out[self._executor.submit(grade_all, self._common(), tasks)] = (tasks, tries)

    def _results(self, future: "Future[list[GradingResult]]") -> list[GradingResult]:
        tasks, tries = self._out.pop(future)
        try:
            return future.result()
        except Exception as error:  # noqa: BLE001  whatever it is, it costs one hand-in at most
            if len(tasks) > 1:
                self._alone += [(task, 1) for task in tasks]
            elif isinstance(error, WorkerError) and not error.is_own_fault and tries < _TRIES:
                self._alone.append((tasks[0], tries + 1))
            elif isinstance(error, WorkerError) and not tasks[0].no_documents:  # a document may be what it was lost to
                self._alone.append((tasks[0]._replace(no_documents=str(error)), 1))
            else:
                reason = str(error) if isinstance(error, WorkerError) else f"{type(error).__name__}: {error}"
                return [failed(self._rubric, tasks[0], "errored", reason)]
            return []
