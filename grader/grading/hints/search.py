"""Search the edits that make failed criteria pass: single ones first, then pairs, within a budget of gradings."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from decimal import Decimal
from itertools import combinations
from typing import NamedTuple

from grader.edits import Proposal, composed
from grader.grading.hints.targets import links_of
from grader.grading.hints.trials import Edits, OutOfBudget, Results, State, Trials, gained, loses_nothing
from grader.grading.rubric import Criterion
from grader.robot.edits.candidates import proposals
from grader.robot.edits.draft import Draft
from grader.source import Edit
from grader.submission.editing import content
from grader.submission.raw_xacro import raw_xacro_proposals
from grader.submission.submission import Submission
from grader.submission.urdf import Read

_MAX_ROUNDS = 4
_MAX_OPTIONS = 4  # edits that are proven for one criterion, to choose the best
_MAX_PAIRS = 60
_MAX_REPAIRED = 3  # edits that make a criterion pass and others fail, which a second edit may repair


class Found(NamedTuple):
    """A proven edit of the submission as it is, and the criteria that pass with it."""

    proposal: Proposal
    edits: Edits
    gains: tuple[str, ...]
    results: Results


class Option(NamedTuple):
    """An edit, and the criteria that a quick look says pass with it."""

    proposal: Proposal
    passes: frozenset[str]


class Search:
    """The search for one submission; `found` are proven edits, `final` the submission with those that fit together."""

    def __init__(self, trials: Trials, reference: Draft | None) -> None:
        self.trials = trials
        self.reference = reference
        self.found: list[Found] = []
        self.final = trials.start
        self._criteria = {criterion.id: criterion for criterion in trials.rubric.criteria}

    def run(self) -> "Search":
        """Search until nothing more is found, or the budget is spent."""
        try:
            for _ in range(_MAX_ROUNDS):
                if not self._round(self.final):
                    break
            self._combine()
        except OutOfBudget:
            pass
        return self

    def _round(self, state: State) -> bool:
        """Find edits of a state for as many of its failed criteria as possible; return whether there were any."""
        wanted = self._by_cost(state.results)
        if not wanted:
            return False
        options = self._options(state, wanted)
        taken: Edits = ()
        current = state
        for name in wanted:
            if current.results[name].outcome.status == "passed":
                continue
            best = (
                self._best(state, name, options)
                or self._repaired(state, name, options)
                or self._pair(state, name, options)
            )
            if best is None or not self._prove(state, best, name):
                continue
            together = self.trials.applied(state, (*taken, *best.edits))
            if together is not None and loses_nothing(current.results, together.results):
                taken, current = together.edits, together
        if taken:
            self.final = current._replace(edits=_joined(self.trials.start.submission, state.edits, taken))
        return bool(taken)

    def _by_cost(self, results: Results) -> list[str]:
        """Return the failed criteria, those with which most points are lost first."""
        lost: dict[str, Decimal] = {}
        for name, result in results.items():
            if result.outcome.status in ("failed", "skipped") and not result.carried:
                cause = result.because if result.because in results else None
                lost[cause or name] = lost.get(cause or name, Decimal(0)) + result.criterion.points
        failed = [name for name in lost if results[name].outcome.status == "failed"]
        return sorted(failed, key=lambda name: (-lost[name], self._criteria[name].position))

    def _proposals(self, state: State, names: Iterable[str]) -> list[Proposal]:
        """Return edits for criteria."""
        criteria = [self._criteria[name] for name in names]
        about_urdf = any(criterion.check.subject == "urdf" for criterion in criteria)
        found: list[Proposal] = list(raw_xacro_proposals(state.submission)) if about_urdf else []
        urdf = state.submission.urdf
        draft = Draft.of(urdf.reading) if isinstance(urdf, Read) else None
        if draft is not None:
            reference = self.reference or draft
            links = links_of(_about_robot(criteria), draft.robot, reference.robot)
            if about_urdf:
                links = list(dict.fromkeys((*links, *(link.name for link in reference.robot.links))))
            places = [
                result.outcome.location for result in state.results.values() if result.outcome.location is not None
            ]
            found += proposals(draft, reference, links, places)
        return found

    def _options(self, state: State, wanted: Sequence[str]) -> list[Option]:
        """Return the edits of a state that make a wanted criterion pass, or may be one half of a pair."""
        options: list[Option] = []
        for proposal in self._proposals(state, wanted):
            passes = frozenset(self.trials.passing(state, proposal.edits, wanted))
            options.append(Option(proposal, passes))
            if len(passes) == len(wanted) and self._proven(state, proposal.edits, wanted[0]):
                break
        return options

    def _best_of(self, state: State, name: str, options: Sequence[Option]) -> Proposal | None:
        """Return a single edit, else two, else one that takes whole elements of the reference."""
        edits = [option for option in options if not option.proposal.is_rewrite]
        rewrites = [option for option in options if option.proposal.is_rewrite]
        return (
            self._best(state, name, edits)
            or self._repaired(state, name, edits)
            or self._pair(state, name, edits)
            or self._best(state, name, rewrites)
        )

    def _best(self, state: State, name: str, options: Sequence[Option]) -> Proposal | None:
        """Return the edit with which a criterion passes, nothing is lost, and most points are gained; of equals the smallest."""
        passing = sorted((option for option in options if name in option.passes), key=_promise(state.results))
        best: tuple[Decimal, int, Proposal] | None = None
        for option in passing[:_MAX_OPTIONS]:
            after = self._proven(state, option.proposal.edits, name)
            if after is not None:
                gain = _score(after.results), -option.proposal.size, option.proposal
                best = max(best, gain, key=lambda found: found[:2]) if best is not None else gain
        return best[2] if best is not None else None

    def _proven(self, state: State, edits: Edits, name: str) -> State | None:
        after = self.trials.applied(state, edits)
        if after is None or after.results[name].outcome.status != "passed":
            return None
        return after if loses_nothing(state.results, after.results) else None

    def _repaired(self, state: State, name: str, options: Sequence[Option]) -> Proposal | None:
        """Return two edits: the first makes a criterion pass and others fail, which the second repairs."""
        passing = sorted((option for option in options if name in option.passes), key=_promise(state.results))
        for option in [option for option in passing if not option.proposal.is_blind][:_MAX_REPAIRED]:
            first = option.proposal
            middle = self.trials.applied(state, first.edits)
            if middle is None:
                continue
            broken = [other for other in _worse(state.results, middle.results) if other in middle.results]
            for second in self._options(middle, broken) if broken else ():
                if len(second.passes) == len(broken):
                    edits = _joined(state.submission, first.edits, second.proposal.edits)
                    if self._proven(state, edits, name):
                        return _pair_of(first, second.proposal, edits)
        return None

    def _pair(self, state: State, name: str, options: Sequence[Option]) -> Proposal | None:
        """Return two edits of one link that make a criterion pass together."""
        urdf = state.submission.urdf
        robot = urdf.reading.robot if isinstance(urdf, Read) else None
        if robot is None:
            return None
        links = set(links_of([self._criteria[name]], robot, self.reference.robot if self.reference else robot))
        plausible = [
            option.proposal for option in options if not option.proposal.is_blind and option.proposal.link in links
        ]
        pairs = (pair for pair in combinations(plausible, 2) if pair[0].link == pair[1].link)
        for _, (first, second) in zip(range(_MAX_PAIRS), pairs, strict=False):
            edits = (*first.edits, *second.edits)
            if self.trials.passing(state, edits, (name,)) and self._proven(state, edits, name):
                return _pair_of(first, second, edits)
        return None

    def _prove(self, state: State, proposal: Proposal, name: str) -> bool:
        """Add a proven edit of the submission as it is: the edit alone, else together with those before it."""
        start = self.trials.start
        together = _joined(start.submission, state.edits, proposal.edits)
        alone = tuple(edit for edit in together if edit not in state.edits)
        is_apart = len(alone) + len(state.edits) == len(together)
        for edits in ((alone,) if is_apart else ()) + (together,):
            after = self.trials.applied(start, edits, whole=True)
            if after is None or not loses_nothing(start.results, after.results):
                continue
            gains = gained(start.results, after.results)
            if name in gains:
                self.found.append(Found(proposal, edits, tuple(gains), after.results))
                return True
        return False

    def _combine(self) -> None:
        """Find which edits together make a criterion pass that no single one does."""


def _about_robot(criteria: Iterable[Criterion]) -> Iterator[Criterion]:
    return (criterion for criterion in criteria if criterion.check.subject == "robot")


def _promise(results: Results) -> Callable[[Option], tuple[Decimal, bool, int]]:
    def key(option: Option) -> tuple[Decimal, bool, int]:
        points = sum((results[name].criterion.points for name in option.passes), Decimal(0))
        return -points, option.proposal.is_blind, option.proposal.size

    return key


def _score(results: Results) -> Decimal:
    return sum((result.points for result in results.values()), Decimal(0))


def _worse(before: Results, after: Results) -> list[str]:
    return [
        name
        for name, result in before.items()
        if result.outcome.status == "passed" and after[name].outcome.status != "passed"
    ]


def _pair_of(first: Proposal, second: Proposal, edits: Edits) -> Proposal:
    return Proposal(edits, f"{first.cause} and {second.cause}", f"{first.said} and {second.said}", "", first.link)


def _joined(submission: Submission, first: Sequence[Edit], second: Sequence[Edit]) -> Edits:
    """Return the edits of a submission that do what `first` does, and then `second`."""
    joined = [edit for edit in (*first, *second) if edit.renamed]
    before = {edit.renamed: edit.path for edit in joined}
    second = [edit._replace(path=before.get(edit.path, edit.path)) for edit in second]
    first, second = ([edit for edit in edits if not edit.renamed] for edits in (first, second))
    for path in dict.fromkeys(edit.path for edit in (*first, *second)):
        text = (content(submission, path) or b"").decode("utf-8", "surrogateescape")
        halves = ([edit for edit in edits if edit.path == path] for edits in (first, second))
        joined += composed(text, path, *halves)
    return tuple(joined)
