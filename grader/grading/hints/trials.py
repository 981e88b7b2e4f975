"""Try edits of a submission: which criteria pass with them, and whether the whole proves it."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from decimal import Decimal
from typing import NamedTuple

from grader.edits import Proposal, composed
from grader.errors import InputError
from grader.grading.criterion import Criterion
from grader.grading.deciding import decide
from grader.grading.report import Result
from grader.grading.rubric import Rubric
from grader.robot.edits.pieces import SOLVED
from grader.source import Edit, Edits
from grader.submission.editing import content, edited_files, with_files, with_urdf
from grader.submission.submission import Submission
from grader.submission.urdf import Read

Results = Mapping[str, Result]

_MAX_STEPS = 3000  # of one submission
# What it costs to read a text, and what a package costs in addition; to read changed elements costs one step.
_TEXT_STEPS, _PACKAGE_STEPS = 2, 4
_SAMPLES = 10  # positions of joints at which a check compares robots, for one step
_HARMFUL = ("rejects", "drops", "undetermined")


class NoTrialsLeft(Exception):
    """The budget for one submission is spent."""


class State(NamedTuple):
    """A submission with the edits that made it, and the results of its criteria.

    `lost` is the first criterion that the edits make worse; those after it are not decided then.
    """

    submission: Submission
    edits: Edits
    results: Results
    lost: str = ""

    @property
    def score(self) -> Decimal:
        """The points of all criteria."""
        return sum((result.points for result in self.results.values()), Decimal(0))

    @property
    def lost_points(self) -> Decimal:
        """The points that mistakes cost."""
        return sum((result.criterion.points for result in self.results.values() if result.is_lost), Decimal(0))

    @property
    def failed(self) -> list[str]:
        """The criteria that have no points because of a mistake."""
        return [name for name, result in self.results.items() if result.is_lost]


class Trials:
    """Reads and grades edited submissions. The budget counts readings, so that it is the same on every machine."""

    def __init__(self, rubric: Rubric, submission: Submission, results: Results) -> None:
        self.rubric = rubric
        parts = {part.id for part in rubric.parts if part.needs != "files"}
        own = {name: result for name, result in results.items() if result.criterion.part in parts}
        self.start = State(submission, (), own)
        self._steps = {criterion.id: _steps_of(criterion) for criterion in rubric.criteria}
        self.left = 0 if submission.is_costly else _MAX_STEPS
        self.faults: list[str] = []  # the types of exceptions

    @contextmanager
    def isolated(self) -> Iterator[None]:
        """Record a fault of the grader in one family of edits or one step: it must not cost the hints of the others."""
        try:
            yield
        except NoTrialsLeft:
            raise
        except Exception as error:  # noqa: BLE001
            self.faults.append(type(error).__name__)

    def passing(self, state: State, edits: Edits, wanted: Collection[str]) -> frozenset[str]:
        """Return those of the wanted criteria that pass with edits, at a quick look. Raises NoTrialsLeft."""
        edited = self.edit(state, edits)
        self.charge_checks(wanted)
        results = decide(self.rubric, edited, wanted) if edited is not None else ()
        return frozenset(result.criterion.id for result in results if result.outcome.status == "passed")

    def apply(self, state: State, edits: Edits, against: Results | None = None, *, whole: bool = False) -> State | None:
        """Return the state after edits of this one, None if they do not fit; `whole` reads the submission from scratch.

        Raises NoTrialsLeft.
        """
        edited = self._from_scratch(state, edits) if whole else self.edit(state, edits)
        if edited is None:
            return None
        self._charge_reading(edited)
        if _new_problems(state.submission, edited):
            return None
        before = state.results if against is None else against
        results: dict[str, Result] = {}
        for result in decide(self.rubric, edited, before):
            name = result.criterion.id
            self.charge_checks((name,))
            results[name] = result
            if is_worse(before[name], result):
                return State(edited, edits, results, name)
        return State(edited, edits, results)

    def loses_nothing(self, state: State, edits: Edits) -> bool:
        """Return whether edits of a state fit, and no criterion is worse after them. Raises NoTrialsLeft."""
        after = self.apply(state, edits)
        return after is not None and not after.lost

    def edit(self, state: State, edits: Edits) -> Submission | None:
        """Return the submission with edits of a state, not graded; None where they do not fit. Raises NoTrialsLeft."""
        self._charge_reading(state.submission)
        files = edited_files(state.submission, edits)
        if files is None:
            return None
        is_moved = None in files.values()
        is_robot = all(_is_of_robot(path, state.submission) for path in files)
        if isinstance(state.submission.urdf, Read) and is_robot and not is_moved:
            return with_urdf(state.submission, files)
        self.charge(_PACKAGE_STEPS)
        return self._from_scratch(state, edits)

    def _from_scratch(self, state: State, edits: Edits) -> Submission | None:
        self._charge_reading(state.submission)
        files = edited_files(state.submission, edits)
        try:
            return with_files(state.submission, files) if files is not None else None
        except InputError:
            return None

    def _charge_reading(self, submission: Submission) -> None:
        self.charge(_TEXT_STEPS * (1 + submission.cost))

    def charge_checks(self, names: Iterable[str]) -> None:
        """Charge the checks of criteria that take longer than others. Raises NoTrialsLeft."""
        self.charge(sum(self._steps[name] for name in names))

    def charge(self, steps: int) -> None:
        """Charge steps. Raises NoTrialsLeft."""
        self.left -= steps
        if self.left < 0:
            raise NoTrialsLeft


def _steps_of(criterion: Criterion) -> int:
    """Return what the checks of a criterion cost besides reading a text: nothing unless they sample positions."""
    checks = [(criterion.check, criterion.arguments), *((one.check, one.arguments) for one in criterion.carried)]
    sampling = [(check.parameters["samples"], given) for check, given in checks if "samples" in check.parameters]
    return sum(int(given.get("samples", parameter.default)) // _SAMPLES for parameter, given in sampling)


def _new_problems(before: Submission, after: Submission) -> bool:
    """Return whether ROS 2 loads the URDF, with a kind of problem that it had not before: no edit may make it worse."""
    if (
        not isinstance(before.urdf, Read)
        or not isinstance(after.urdf, Read)
        or before.urdf.loaded.verdict == "rejected"
    ):
        return False
    known = {problem.kind for problem in before.urdf.loaded.problems if problem.kind.effect in _HARMFUL}
    return any(it.kind not in known for it in after.urdf.loaded.problems if it.kind.effect in _HARMFUL)


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


def join(submission: Submission, first: Sequence[Edit], second: Sequence[Edit]) -> Edits:
    """Return the edits of a submission that do what `first` does, and then `second`."""
    renamed = {edit.renamed: edit.path for edit in first if edit.renamed}
    second = [edit._replace(path=renamed.get(edit.path, edit.path)) for edit in second]
    found: list[Edit] = []
    for path in dict.fromkeys(edit.path for edit in (*first, *second)):
        text = (content(submission, path) or b"").decode("utf-8", "surrogateescape")
        halves = ([edit for edit in edits if edit.path == path and not edit.renamed] for edits in (first, second))
        renames = [edit for edit in (*first, *second) if edit.path == path and edit.renamed]
        found += (*composed(text, path, *halves), *renames[-1:])
    return tuple(found)


def as_one(proposals: Sequence[Proposal], edits: Edits) -> Proposal:
    """Return several proposals as one, with these edits: those of the first one come first."""
    causes = dict.fromkeys(proposal.cause for proposal in proposals)
    actions = dict.fromkeys(proposal.action for proposal in proposals)
    rank = max(SOLVED, *(proposal.rank for proposal in proposals))
    ordered = tuple(sorted(dict.fromkeys(edits), key=lambda edit: edit not in proposals[0].edits))
    return Proposal(ordered, " and ".join(causes), " and ".join(actions), proposals[0].link, rank)
