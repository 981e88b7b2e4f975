"""The second pass over a class: search the proven hints of submissions that lost points, once for those that have the same."""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from functools import lru_cache
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.hints import Mistaken, mistaken, save_hints
from grader.classroom.gradebook.result import Verdict, graded_on
from grader.classroom.intake.opening import open_submission
from grader.classroom.run.pool import WorkerError
from grader.errors import InputError
from grader.files.reading import URDF_LIMIT
from grader.grading.rubric import Rubric, read_rubric

_AHEAD = 3  # tasks for each worker: one at work, the others ready
_NONE = "[null]"  # of a search that was not complete
_NO_DOCUMENTS = "hints are about the URDF and the package"

Group = Callable[[Mistaken], tuple[str, ...]]


class HintTask(NamedTuple):
    """A submission whose hints are searched: where it is, what was graded, and by which rubric."""

    root: str
    paths: tuple[str, ...]
    names: tuple[str, ...]
    key: str
    digest: str
    parts: tuple[str, ...]
    rubric: bytes
    rubric_path: str
    max_size: int = URDF_LIMIT


def same_content(submission: Mistaken) -> tuple[str, ...]:
    """Return what two submissions have in common whose hints are equal: reports quote the text of the student."""
    return submission.content


def same_robot(submission: Mistaken) -> tuple[str, ...]:
    """Return what two submissions have in common that need the same changes: statistics show one of them."""
    return submission.robot


def search_hints(task: HintTask) -> str | None:
    """Return the proven hints of a submission as JSON; None if its files are not those that were graded."""
    from grader.grading.grade import grade  # late, like the next two: only workers that search hints load them
    from grader.grading.hints.hinting import hinted
    from grader.grading.hints.record import hints_to_record

    rubric = _rubric(task.rubric, task.rubric_path)
    try:
        opened = open_submission(task.root, task.paths, task.names, task.key, task.max_size)
        if opened.digest != task.digest:
            return None
        submission = opened.submission(rubric, _NO_DOCUMENTS)
    except InputError:
        return None
    report = grade(rubric, submission, task.parts, is_one_of_class=True)
    return hints_to_record(hinted(report, submission, rubric.hints, keep_edits=True).report)


@lru_cache(maxsize=4)
def _rubric(data: bytes, path: str) -> Rubric:
    return read_rubric(data, Path(path))


class HintSearch:
    """The search for the hints of a class, for one rubric. `unavailable` counts submissions whose files have changed or are gone."""

    def __init__(self, book: Gradebook, rubric: Rubric, group: Group, max_size: int = URDF_LIMIT) -> None:
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
        for one in submissions:
            parts = graded_on(self._rubric, one.statuses)
            rubric = self._rubric.data, str(self._rubric.path)
            task = HintTask(one.root, one.paths, one.names, one.key, one.digest, parts, *rubric, self._max_size)
            yield executor.submit(search_hints, task), one

    def _save(self, submission: Mistaken, future: "Future[str | None]") -> Verdict:
        """Store the hints of a submission; none if the search was lost, unless it may have been lost with another one's."""
        verdict: Verdict = "graded"
        try:
            found = future.result()
        except Exception as error:  # noqa: BLE001  it costs the hints of one submission, not its report
            verdict = "errored"
            found = _NONE
            if isinstance(error, WorkerError) and not error.is_own_fault:
                return verdict
        if found is None:
            self.unavailable += 1
        else:
            save_hints(self._book, self._alike[submission.content], found)
        return verdict
