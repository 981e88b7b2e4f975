"""The second pass over a class: search the proven hints of submissions that lost points, once for equal ones."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from functools import partial
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.hints import HintKey, LossySubmission, lossy_submissions, save_hints
from grader.classroom.gradebook.result import GradingVerdict
from grader.classroom.run.pool import WorkerError
from grader.classroom.run.queue import Queue
from grader.classroom.run.worker import rubric_from
from grader.errors import InputError, MachineError
from grader.grading.hints.record import NO_HINTS
from grader.grading.rubric import Rubric

_NO_DOCUMENTS = "hints are about the URDF and the package"

Group = Callable[[LossySubmission], HintKey]  # what submissions have in common of which one is searched


class SearchedHints(NamedTuple):
    """The hints of submissions with the same content, as JSON; None if the files are not those that were graded."""

    content: HintKey
    hints: str | None
    verdict: GradingVerdict = "graded"


def search_hints(data: bytes, path: str, submissions: Sequence[LossySubmission]) -> list[SearchedHints]:
    """Search the hints of submissions for the rubric in a file."""
    rubric = rubric_from(data, path)
    return [SearchedHints(one.content, _proven_hints(one, rubric)) for one in submissions]


def _proven_hints(one: LossySubmission, rubric: Rubric) -> str | None:
    from grader.grading.grade import grade  # late, like the next two: only workers that search hints load them
    from grader.grading.hints.hinting import hinted
    from grader.grading.hints.record import hints_to_record

    try:
        opened = one.files.open()
        if opened.digest != one.files.digest:
            return None
        submission = opened.submission(rubric, _NO_DOCUMENTS)
    except InputError:
        return None
    report = grade(rubric, submission, one.parts, is_one_of_class=True)
    return hints_to_record(hinted(report, submission, rubric.hints, keep_edits=True).report)


def _give_up(submission: LossySubmission, error: Exception) -> SearchedHints:
    """Return that there are no hints: searched again if another task or the machine may be why the search was lost."""
    is_own_fault = (
        error.is_own_fault if isinstance(error, WorkerError) else not isinstance(error, MachineError | OSError)
    )
    return SearchedHints(submission.content, NO_HINTS if is_own_fault else None, "errored")


class ClassHintSearch:
    """The search for a class's hints for one rubric. `unavailable` counts submissions that cannot be read as graded."""

    def __init__(self, book: Gradebook, rubric: Rubric, group: Group) -> None:
        self._book, self._rubric = book, rubric
        submissions = lossy_submissions(book, rubric)
        self._alike: dict[HintKey, list[int]] = {}
        for submission in submissions:
            if submission.hints is None:
                self._alike.setdefault(submission.content, []).append(submission.result)
        self._stored = {one.content: one.hints for one in submissions if one.hints is not None}
        known = {group(submission) for submission in submissions if submission.hints is not None}
        first = {group(one): one for one in reversed(submissions) if not one.is_gone and group(one) not in known}
        self.wanted = [one for one in submissions if first.get(group(one)) is one]
        self.unavailable = 0

    def run(self, executor: Executor, workers: int) -> Iterator[GradingVerdict]:
        """Search, and store what is found at once; yield for each search whether it was completed."""
        for content, hints in self._stored.items():
            if content in self._alike:
                save_hints(self._book, self._alike[content], hints)
        work = partial(search_hints, self._rubric.data, str(self._rubric.path))
        for group in Queue(executor, workers, work, _give_up).all(self.wanted):
            for searched in group:
                if searched.hints is not None:
                    save_hints(self._book, self._alike[searched.content], searched.hints)
                self.unavailable += searched.hints is None
                yield searched.verdict
