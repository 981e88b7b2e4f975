"""Grade a submission with edits, within a budget of gradings."""

from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from decimal import Decimal
from typing import NamedTuple

from grader.errors import InputError
from grader.grading.deciding import decide
from grader.grading.report import Result
from grader.grading.rubric import Rubric
from grader.hints.editing import edited_files, with_files, with_urdf
from grader.hints.edits import Proposal
from grader.source import Certainty, Edits
from grader.submission.submission import Submission
from grader.submission.urdf import Read

Results = Mapping[str, Result]

_MAX_GRADINGS = 170  # of one submission that is as short as most
_HARMFUL = ("rejects", "drops", "undetermined")


class FoundHint(NamedTuple):
    """A proven edit, and the points of the criteria that pass with it; without edits, `words` say what is missing.

    `is_late` says that the gains are those after the edits of earlier hints. With an `alternative`, two edits cannot be
    told apart: both are named, and neither is made.
    """

    proposal: Proposal
    gains: Mapping[str, Decimal]
    certainty: Certainty = "preferred"
    is_late: bool = False
    words: str = ""
    alternative: Proposal | None = None

    @property
    def edits(self) -> Edits:
        """The edits to make."""
        return self.proposal.edits if self.alternative is None else ()


class NoTrialsLeft(Exception):
    """The budget for one submission is spent."""


class Trials:
    """Grades edited submissions. The budget counts gradings, so that it is the same on every machine."""

    def __init__(self, rubric: Rubric, submission: Submission, results: Results) -> None:
        parts = {part.id for part in rubric.parts if part.needs != "files"}
        self.rubric, self.submission = rubric, submission
        self.results = {name: result for name, result in results.items() if result.criterion.part in parts}
        self.left = 0 if submission.is_costly else _MAX_GRADINGS
        self.faults: list[str] = []  # the types of exceptions
        self.is_assumed = False  # whether the last one is read with words undone, and the submission is not

    @contextmanager
    def isolated(self) -> Iterator[None]:
        """Record a fault of the grader in one family of edits or one step: it must not cost the hints of the others."""
        try:
            yield
        except NoTrialsLeft:
            raise
        except Exception as error:  # noqa: BLE001
            self.faults.append(type(error).__name__)

    def graded(self, edits: Edits, wanted: Collection[str] | Results, *, whole: bool = False) -> Results:
        """Return the results of criteria with edits, none where these do not fit, or ROS 2 would reject or drop more.

        With the results that criteria had, there are none where one is worse now.
        `whole` reads the submission from scratch. Raises NoTrialsLeft.
        """
        self.left -= 1 + self.submission.cost
        if self.left < 0:
            raise NoTrialsLeft
        edited = self._edited(edits, whole=whole)
        if edited is None or _has_new_problems(self.submission, edited):
            return {}
        self.is_assumed = _is_assumed(edited) and not _is_assumed(self.submission)
        found: dict[str, Result] = {}
        for result in decide(self.rubric, edited, wanted):
            name = result.criterion.id
            if isinstance(wanted, Mapping) and is_worse(wanted[name], result):
                return {}  # at once: a shape in another one takes long to measure
            found[name] = result
        return found

    def _edited(self, edits: Edits, *, whole: bool) -> Submission | None:
        files = edited_files(self.submission, edits)
        if files is None:
            return None
        is_robot = isinstance(self.submission.urdf, Read) and None not in files.values()
        is_decoded = all(edit.old.isascii() for edit in edits)  # else a launch file that could not read it now may
        if is_robot and is_decoded and not whole and all(_is_of_robot(path, self.submission) for path in files):
            return with_urdf(self.submission, files)
        try:
            return with_files(self.submission, files)
        except InputError:
            return None


def _has_new_problems(before: Submission, after: Submission) -> bool:
    """Return whether ROS 2 loads the URDF, with a kind of problem that it had not before: no edit may make it worse."""
    if (
        not isinstance(before.urdf, Read)
        or not isinstance(after.urdf, Read)
        or before.urdf.loaded.verdict == "rejected"
    ):
        return False
    known = {problem.kind for problem in before.urdf.loaded.problems if problem.kind.effect in _HARMFUL}
    return any(it.kind not in known for it in after.urdf.loaded.problems if it.kind.effect in _HARMFUL)


def _is_assumed(submission: Submission) -> bool:
    """Return whether ROS 2 rejects the URDF, and it is read with words undone: criteria may pass by them."""
    reading = submission.urdf.loaded if isinstance(submission.urdf, Read) else None
    return reading is not None and reading.verdict == "rejected" and reading.is_meant


def _is_of_robot(path: str, submission: Submission) -> bool:
    """Return whether a file is the URDF or one that its xacro reads, and not one that the package's checks read."""
    is_robot = path.lower().endswith((".urdf", ".xacro")) and path in submission.whole_tree.files
    return is_robot or path == submission.path


def is_worse(before: Result, after: Result) -> bool:
    """Return whether a criterion no longer passes, has fewer points, or is undecided now; never an adjusted one."""
    status = after.outcome.status
    if after.is_adjusted:
        return False
    if before.outcome.status != status and (before.outcome.status == "passed" or status in ("pending", "errored")):
        return True
    return after.points < before.points


def costs_of(results: Results) -> dict[str, Decimal]:
    """Return what each failed criterion costs, with the criteria that are skipped because of it."""
    lost: dict[str, Decimal] = {}
    for name, result in results.items():
        if result.is_lost:
            cause = result.because if result.because in results else None
            lost[cause or name] = lost.get(cause or name, Decimal(0)) + result.criterion.points
    return {name: points for name, points in lost.items() if results[name].outcome.status == "failed"}


def gains_of(before: Results, after: Results) -> dict[str, Decimal]:
    """Return the criteria that pass now and did not before, with the points that this gives."""
    return {
        name: result.points - before[name].points
        for name, result in after.items()
        if result.outcome.status == "passed"
        and before[name].outcome.status in ("failed", "skipped")
        and not result.is_adjusted
    }
