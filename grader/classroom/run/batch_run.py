"""Grade a class.

Send new and changed submissions to the workers, write each result into the gradebook at once.
"""

from collections.abc import Callable
from concurrent.futures import Executor
from functools import partial

from grader.base.grouping import Strings
from grader.classroom.intake.submissions import ClassSubmission
from grader.classroom.results.results import Results, ResultsWriter, StoredResult
from grader.classroom.run.batch_worker import (
    ClassContext,
    Task,
    given_up,
    grade_all,
    unopened_digest,
)
from grader.workers.pool import WorkerError
from grader.workers.queue import Progress, Queue

_OF_PERSON = ("name", "email", "login", "sis", "canvas", "moodle")


class Batch:
    """One run over a class.

    `context` is the hash of all that results depend on besides the submissions.
    """

    def __init__(
        self, results: Results, writer: ResultsWriter, shared: ClassContext, context: str
    ) -> None:
        self._results = results
        self._writer = writer
        self._shared = shared
        self._context = context
        self._at_work: dict[
            str, tuple[ClassSubmission, StoredResult | None]
        ] = {}  # with the result that is current
        self.progress = Progress(0)
        self._being_written = (
            0,
            self.progress,
        )  # where the file ends once a write is done, and the progress then
        self._counted = set[tuple[int, Strings]]()
        self.written = (
            results.unfinished
        )  # the students whose results this run has written, or one that was stopped

    def grade(
        self,
        submissions: list[ClassSubmission],
        executor: Executor,
        workers: int,
        show: Callable[[Progress], None] = lambda _: None,
        *,
        force: bool = False,
    ) -> Progress:
        """Grade all submissions that have no current result, and empty the list.

        A large class takes memory.

        One whose grading is lost is graded without its documents, if it has any; if that is lost as
        well, it is `errored`. One that used up its processor time is kept like a grade.
        """
        self.progress = Progress(len({(one.root, one.paths) for one in submissions}))
        show(self.progress)  # before the first result
        submissions.reverse()
        tasks = (self._task(submissions.pop(), force=force) for _ in range(len(submissions)))
        queue = Queue(
            executor, workers, partial(grade_all, self._shared), _without_documents, self._errored
        )
        for results in queue.results(tasks):
            progress = self.progress
            lines = []
            for result in results:
                submission, current = self._at_work.pop(result.student)
                if (
                    place := (submission.root, submission.paths)
                ) not in self._counted:  # that of a team counts once
                    self._counted.add(place)
                    progress = progress.with_result(result.verdict)
                lines.append(self._line(result, submission, current))
            self._being_written = self._writer.end + sum(map(len, lines)), progress
            self._writer.append(*lines)
            self.progress = progress
            show(self.progress)
        return self.progress

    @property
    def kept(self) -> int:
        """The number of submissions whose results are in the file, wherever Ctrl-C arrived."""
        end, progress = self._being_written
        return (progress if self._writer.end >= end else self.progress).done

    def _task(self, one: ClassSubmission, *, force: bool) -> Task:
        newest = self._results.of(one.student.key)
        current = None
        if newest and newest.context == self._context and not force:
            is_final = newest.verdict != "errored" or newest.timeout >= self._shared.timeout
            current = newest if is_final else None
        self._at_work[one.student.key] = one, current
        return Task(
            one.student.key,
            one.root,
            one.paths,
            one.names,
            current.digest if current else "",
            current is not None and current.timeout > 0,
        )

    def _errored(self, task: Task, error: Exception) -> StoredResult:
        if not isinstance(error, WorkerError):
            error = WorkerError(f"{type(error).__name__}: {error}")
        digest = ""
        if error.timeout:
            digest = unopened_digest(self._shared.roots[task.root], task.paths)
        return given_up(self._shared, task, error, digest)

    def _line(
        self, result: StoredResult, submission: ClassSubmission, current: StoredResult | None
    ) -> bytes:
        """Return the line of a result, empty if the file has it."""
        shown = current if result.verdict == "unchanged" and current else result
        person = {
            name: value for name in _OF_PERSON if (value := getattr(submission.student, name))
        }
        new = shown._replace(
            context=self._context,
            root=submission.root,
            paths=submission.paths,
            names=submission.names,
            is_late=submission.is_late,
            submitted=submission.submitted,
            person=person,  # what the names of the files say of the student
        )
        if new == current:
            return b""
        self.written.add(result.student)
        return new._replace(run=self._results.next_run).line


def _without_documents(task: Task, error: WorkerError) -> Task | None:
    """Return a lost task without its documents, which may be the cause."""
    if task.no_documents:
        return None
    return task._replace(no_documents=str(error), reached=error.timeout)
