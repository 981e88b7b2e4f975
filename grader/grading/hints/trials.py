"""Try edits of a submission: which criteria pass with them, and whether the whole proves it."""

from collections.abc import Collection, Iterable, Mapping
from typing import NamedTuple

from grader.errors import InputError
from grader.grading.grade import decide
from grader.grading.report import Result
from grader.grading.rubric import Rubric
from grader.source import Edit
from grader.submission.editing import edited_files, with_files, with_urdf
from grader.submission.submission import Submission
from grader.submission.urdf import Read

Results = Mapping[str, Result]
Edits = tuple[Edit, ...]

_MAX_STEPS = 600  # of one submission
_PACKAGE_STEPS = 4  # that it costs more to evaluate a package than to read a URDF
_BYTES_PER_STEP = 8192  # a larger file costs more to read


class OutOfBudget(Exception):
    """The budget for one submission is spent."""


class State(NamedTuple):
    """A submission with the edits that made it, and the results of its criteria."""

    submission: Submission
    edits: Edits
    results: Results

    @property
    def failed(self) -> list[str]:
        """The criteria that failed or are skipped, and have no points because of that."""
        return [name for name, result in self.results.items() if is_lost(result)]


class Trials:
    """Edited submissions are read and graded here. The budget counts readings, so that it is the same on every machine."""

    def __init__(self, rubric: Rubric, submission: Submission, results: Results) -> None:
        self.rubric = rubric
        parts = {part.id for part in rubric.parts if part.needs != "files"}
        own = {name: result for name, result in results.items() if result.criterion.part in parts}
        self.start = State(submission, (), own)
        self.left = _MAX_STEPS

    def passing(self, state: State, edits: Edits, wanted: Collection[str]) -> set[str]:
        """Return those of the wanted criteria that pass with edits, as far as a quick look tells. Raises OutOfBudget."""
        edited = self._quick(state, edits)
        if edited is None:
            return set()
        return {
            name for name, result in decide(self.rubric, edited, wanted).items() if result.outcome.status == "passed"
        }

    def applied(self, state: State, edits: Edits, *, whole: bool = False) -> State | None:
        """Return the state after edits of this one; `whole` reads the submission from scratch. Raises OutOfBudget."""
        edited = self._from_scratch(state, edits) if whole else self._quick(state, edits)
        if edited is None:
            return None
        self._spend(edited)
        return State(edited, edits, decide(self.rubric, edited, self.start.results))

    def _quick(self, state: State, edits: Edits) -> Submission | None:
        self._spend(state.submission)
        files = edited_files(state.submission, edits)
        if files is None:
            return None
        if isinstance(state.submission.urdf, Read) and all(_is_of_robot(path, state.submission) for path in files):
            return with_urdf(state.submission, files)
        self.left -= _PACKAGE_STEPS
        return self._from_scratch(state, edits)

    def _from_scratch(self, state: State, edits: Edits) -> Submission | None:
        self._spend(state.submission)
        files = edited_files(state.submission, edits)
        try:
            return with_files(state.submission, files) if files is not None else None
        except InputError:
            return None

    def _spend(self, submission: Submission) -> None:
        size = len(submission.urdf.data) if isinstance(submission.urdf, Read) else 0
        self.left -= 1 + size // _BYTES_PER_STEP
        if self.left < 0:
            raise OutOfBudget


def _is_of_robot(path: str, submission: Submission) -> bool:
    """Return whether a file is the URDF or one that its xacro reads, and not one that the package's checks read."""
    is_robot = path.lower().endswith((".urdf", ".xacro")) and path in submission.everything.files
    return is_robot or path == submission.path


def is_lost(result: Result) -> bool:
    """Return whether a criterion has no points because of a mistake."""
    return result.outcome.status in ("failed", "skipped") and not result.carried


def loses_nothing(before: Results, after: Results) -> bool:
    """Return whether everything that passed still passes, and no criterion has fewer points or is undecided now."""
    for name, result in before.items():
        now = after[name]
        if result.outcome.status != now.outcome.status and (
            result.outcome.status == "passed" or now.outcome.status in ("pending", "errored")
        ):
            return False
        if now.points < result.points:
            return False
    return True


def gained(before: Results, after: Results) -> list[str]:
    """Return the criteria that pass now and did not before."""
    return [
        name
        for name, result in after.items()
        if result.outcome.status == "passed" and before[name].outcome.status in ("failed", "skipped")
    ]


def points_of(results: Results, names: Iterable[str]) -> object:
    """Return the points that these criteria do not have yet."""
    return sum(results[name].criterion.points - results[name].points for name in names)
