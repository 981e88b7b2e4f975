"""Tasks in an executor: in groups as long as none fails, one by one after a failure."""

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from itertools import islice
from typing import TypeVar

from grader.classroom.run.pool import WorkerError

_GROUP_TIME = 0.05  # seconds of work that are worth one message to a worker
_MAX_GROUP = 64
_AHEAD = 3  # groups for each worker: one at work, the others ready
_MAX_TRIES = 3

Task = TypeVar("Task")
Result = TypeVar("Result")


def results_of(
    executor: Executor,
    workers: int,
    work: Callable[[Sequence[Task]], list[Result]],
    tasks: Iterable[Task],
    again: Callable[[Task, WorkerError], Task | None],
    lost: Callable[[Task, Exception], Result],
    size: int = 0,
) -> Iterator[list[Result]]:
    """Yield the results of tasks as they come; no task is taken before it can be submitted.

    `work` returns the results of tasks in a worker. Where a task fails alone, `again` returns another one to be tried in its place,
    else `lost` its result. `size` is the number of tasks in a group; default: as many as take `_GROUP_TIME`.
    """
    waiting, alone = iter(tasks), deque[tuple[Task, int]]()
    running: dict[Future[list[Result]], tuple[list[Task], int]] = {}
    began, done = 0.0, 0  # when the first results came: until then workers start; and the results since then

    def submit(group: list[Task], tries: int) -> None:
        running[executor.submit(work, group)] = (group, tries)

    def submit_ready() -> None:
        while len(running) < workers * _AHEAD and not (alone and alone[0][1] > 1 and running):
            if alone:
                task, tries = alone.popleft()
                submit([task], tries)
                if tries > 1:  # it was lost when all processes ended: it runs alone
                    return
            elif group := list(islice(waiting, size or _group_size(workers, done, began))):
                submit(group, 1)
            else:
                return

    submit_ready()
    while running:
        for future in wait(running, return_when=FIRST_COMPLETED).done:
            group, tries = running.pop(future)
            try:
                results = future.result()
            except Exception as error:  # noqa: BLE001  any failure affects one task at most
                results = []
                if len(group) > 1:
                    alone += [(task, 1) for task in group]
                elif isinstance(error, WorkerError) and not error.is_own_fault and tries < _MAX_TRIES:
                    alone.append((group[0], tries + 1))
                elif isinstance(error, WorkerError) and (other := again(group[0], error)) is not None:
                    alone.append((other, 1))
                else:
                    results = [lost(group[0], error)]
            if began:
                done += len(results)
            else:
                began = time.perf_counter()
            if results:
                yield results
        submit_ready()


def _group_size(workers: int, done: int, began: float) -> int:
    """Return how many tasks are worth a message, after `done` results since a time."""
    if not done:
        return 1
    seconds = (time.perf_counter() - began) * workers / done  # for one task
    share = done // (workers * _AHEAD)  # few tasks wait behind one that hangs in their group
    return max(1, min(_MAX_GROUP, share, int(_GROUP_TIME / seconds)))
