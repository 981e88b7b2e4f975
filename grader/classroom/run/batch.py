"""Grade a class: send new and changed submissions to the workers, write each result into the gradebook at once."""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from functools import partial
from itertools import chain
from typing import NamedTuple

from grader.classroom.results import Graded, Results, ResultsWriter
from grader.classroom.roster import Student
from grader.classroom.run.pool import WorkerError
from grader.classroom.run.progress import Progress
from grader.classroom.run.queue import Queue
from grader.classroom.run.worker import ClassContext, Task, grade_all, undecided
from grader.classroom.submissions import ClassSubmission

_OF_PERSON = ("name", "email", "login", "sis", "canvas", "moodle")


class _AtWork(NamedTuple):
    """A submission that is graded, and its result if that is current."""

    submission: ClassSubmission
    current: Graded | None


class Batch:
    """One run over a class. `context` is the hash of all that results depend on besides the submissions."""

    def __init__(
        self,
        results: Results,
        writer: ResultsWriter,
        shared: ClassContext,
        context: str,
        executor: Executor,
        workers: int,
        listener: Callable[[Progress], None] = lambda _: None,
    ) -> None:
        self._results, self._writer, self._shared, self._context = results, writer, shared, context
        self._executor, self._workers, self._listener = executor, workers, listener
        self._at_work: dict[str, _AtWork] = {}
        self.progress = Progress(0)

    def grade(self, submissions: Iterable[ClassSubmission], total: int, *, force: bool = False) -> Progress:
        """Grade all submissions that have no current result.

        One whose grading is lost is graded without its documents; if that is lost as well, it is `errored`.
        """
        self.progress = Progress(total)
        self._report(())  # the total, before the first result
        tasks = self._tasks(submissions, force=force)

        def lost(task: Task, error: Exception) -> Graded | None:
            if isinstance(error, WorkerError) and not task.no_documents:  # a document may be the cause
                queue.put_back(task._replace(no_documents=str(error)))
                return None
            reason = str(error) if isinstance(error, WorkerError) else f"{type(error).__name__}: {error}"
            return undecided(self._shared, Graded(task.key, 0, "errored", reason=reason))

        queue = Queue(self._executor, self._workers, partial(grade_all, self._shared), lost)
        first = next(tasks, None)
        for results in queue.all(chain([first], tasks)) if first is not None else ():
            self._writer.append(*chain.from_iterable(map(self._lines, results)))
            self._report(result.verdict for result in results)
        return self.progress

    def _tasks(self, submissions: Iterable[ClassSubmission], *, force: bool) -> Iterator[Task]:
        for one in submissions:
            key, newest = one.student.key, self._results.of(one.student.key)
            is_current = newest is not None and newest.context == self._context and newest.verdict != "errored"
            current = newest if is_current and not force else None
            self._at_work[key] = _AtWork(one, current)
            yield Task(key, one.root, one.paths, one.names, current.digest if current is not None else "")

    def _lines(self, result: Graded) -> Iterator[bytes]:
        """Yield the line of a result, unless the file has it."""
        submission, current = self._at_work.pop(result.student)
        is_kept = result.verdict == "unchanged" and current is not None
        found = current if is_kept and current is not None else result
        new = found._replace(
            context=self._context,
            root=submission.root,
            paths=submission.paths,
            names=submission.names,
            is_late=submission.is_late,
            submitted=submission.submitted,
            person=_person(submission.student),
        )
        if new != current:
            yield new._replace(run=self._results.next_run).line

    def _report(self, verdicts: Iterable[str]) -> None:
        for verdict in verdicts:
            self.progress = self.progress.with_result(verdict)
        self._listener(self.progress)


def _person(student: Student) -> dict[str, str]:
    """Return what the names of the files say of a student."""
    return {name: value for name in _OF_PERSON if (value := getattr(student, name))}
