"""The second pass over a class: search the proven hints of submissions that lost points, once for equal ones."""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from functools import lru_cache
from itertools import islice
from pathlib import Path

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.hints import Mistaken, mistaken, save_hints
from grader.classroom.gradebook.result import Verdict
from grader.classroom.intake.opening import open_submission
from grader.classroom.run.pool import WorkerError
from grader.errors import InputError
from grader.grading.hints.record import NO_HINTS
from grader.grading.rubric import Rubric, read_rubric

_AHEAD = 3  # tasks for each worker: one at work, the others ready
_GRADED: Verdict = "graded"
_ERRORED: Verdict = "errored"
_NO_DOCUMENTS = "hints are about the URDF and the package"

Group = Callable[[Mistaken], tuple[str, ...]]  # what submissions have in common of which one is searched


def search_hints(one: Mistaken, parts: tuple[str, ...], data: bytes, path: str, max_size: int) -> str | None:
    """Return the proven hints of a submission as JSON; None if its files are not those that were graded.

    The rubric is the content of the file at `path`, which need not exist.
    """
    from grader.grading.grade import grade  # late, like the next two: only workers that search hints load them
    from grader.grading.hints.hinting import hinted
    from grader.grading.hints.record import hints_to_record

    rubric = _rubric(data, path)
    try:
        opened = open_submission(one.root, one.paths, one.names, one.key, max_size)
        if opened.digest != one.digest:
            return None
        submission = opened.submission(rubric, _NO_DOCUMENTS)
    except InputError:
        return None
    report = grade(rubric, submission, parts, is_one_of_class=True)
    return hints_to_record(hinted(report, submission, rubric.hints, keep_edits=True).report)


@lru_cache(maxsize=4)
def _rubric(data: bytes, path: str) -> Rubric:
    return read_rubric(data, Path(path))


class HintSearch:
    """The search for a class's hints for one rubric. `unavailable` counts submissions with changed or missing files."""

    def __init__(self, book: Gradebook, rubric: Rubric, group: Group, max_size: int) -> None:
        self._book, self._rubric, self._max_size = book, rubric, max_size
        submissions = mistaken(book, rubric)
        self._alike: dict[tuple[str, ...], list[int]] = {}
        for submission in submissions:
            if submission.hints is None:
                self._alike.setdefault(submission.content, []).append(submission.result)
        self._stored = {one.content: one.hints for one in submissions if one.hints is not None}
        known = {group(submission) for submission in submissions if submission.hints is not None}
        first = {group(one): one for one in reversed(submissions) if not one.is_gone and group(one) not in known}
        self.wanted = [one for one in submissions if first.get(group(one)) is one]
        self.unavailable = 0

    def run(self, executor: Executor, workers: int) -> Iterator[Verdict]:
        """Search, and store what is found at once; yield for each search whether it was completed."""
        for content, hints in self._stored.items():
            if content in self._alike:
                save_hints(self._book, self._alike[content], hints)
        waiting = iter(self.wanted)
        running = dict(self._submitted(executor, islice(waiting, workers * _AHEAD)))
        while running:
            finished, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in finished:
                yield self._save(running.pop(future), future)
            running |= self._submitted(executor, islice(waiting, len(finished)))

    def _submitted(
        self, executor: Executor, submissions: Iterable[Mistaken]
    ) -> Iterator[tuple[Future[str | None], Mistaken]]:
        rubric = self._rubric
        for one in submissions:
            task = one, one.parts, rubric.data, str(rubric.path), self._max_size
            yield executor.submit(search_hints, *task), one

    def _save(self, submission: Mistaken, future: "Future[str | None]") -> Verdict:
        """Store the hints of a submission; none if its search was lost, unless another one may be the cause."""
        try:
            found, verdict = future.result(), _GRADED
        except Exception as error:  # noqa: BLE001  it costs the hints of one submission, not its report
            if isinstance(error, WorkerError) and not error.is_own_fault:
                return _ERRORED
            found, verdict = NO_HINTS, _ERRORED
        if found is None:
            self.unavailable += 1
        else:
            save_hints(self._book, self._alike[submission.content], found)
        return verdict
