"""Search the edits that make failed criteria pass: single ones first, then pairs, within a budget of gradings."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

from grader.edits import FITTED, REWRITTEN, Proposal
from grader.grading.hints.targets import targets_of
from grader.grading.hints.trials import Edits, OutOfBudget, Results, State, Trials, gained, joined
from grader.grading.rubric import Criterion
from grader.robot.edits.candidates import proposals
from grader.robot.edits.draft import Draft
from grader.robot.reader import Reading
from grader.submission.raw_xacro import raw_xacro_proposals
from grader.submission.urdf import Read

if TYPE_CHECKING:
    from grader.package.package import Package

_MAX_OPTIONS = 4  # edits that are proven for one criterion, to choose the best
_MAX_PAIRS = 60
_MAX_REPAIRED = 3  # edits that make a criterion pass and others fail, which a second edit may repair


_UNION = Proposal((), "", "")  # of edits that are proposed already


class Found(NamedTuple):
    """A proven edit of the submission as it is, and the points of the criteria that pass with it.

    `after` are earlier edits that it includes, because it needs them.
    """

    proposal: Proposal
    edits: Edits
    gains: Mapping[str, Decimal]
    after: "tuple[Found, ...]" = ()


class Option(NamedTuple):
    """An edit, and the criteria that a quick look says pass with it."""

    proposal: Proposal
    passes: frozenset[str]


class Search:
    """The search for one submission; `found` are proven edits, `final` the submission with those that fit together."""

    def __init__(
        self, trials: Trials, reference: Draft | None, package: "Callable[[], Package | None]" = lambda: None
    ) -> None:
        """`reference` and `package` are the robot and the package of the rubric's reference solution."""
        self.trials = trials
        self.reference = reference
        self._package = package
        self.found: list[Found] = []
        self.final = trials.start
        self._known: dict[Edits, list[Option]] = {}
        self._criteria = {criterion.id: criterion for criterion in trials.rubric.criteria}

    def run(self) -> "Search":
        """Search until nothing more is found, or the budget is spent."""
        if not self.trials.left:
            return self
        try:
            self._load()
            for ranks in (range(REWRITTEN), range(REWRITTEN + 1), range(REWRITTEN)):
                while self._round(self.final, ranks):
                    pass
            self._combine()
        except OutOfBudget:
            pass
        return self

    def _round(self, state: State, ranks: range) -> bool:
        """Find edits of a state for as many of its failed criteria as possible; return whether there were any."""
        wanted = self._by_cost(state.results)
        if not wanted:
            return False
        options = self._known.get(state.edits) or self._tried(state, wanted)
        self._known = {state.edits: options}
        taken: Edits = ()
        current = state
        for name in wanted:
            if current.results[name].outcome.status == "passed":
                continue
            best = self._best_of(state, name, options, ranks)
            if best is None or not self._prove(state, best, name):
                continue
            together = self.trials.applied(state, (*taken, *best.edits), current.results)
            if together is not None and not together.lost:
                taken, current = together.edits, together
        if taken:
            self.final = current._replace(edits=joined(self.trials.start.submission, state.edits, taken))
        return bool(taken)

    def _load(self) -> None:
        """Repair a URDF that ROS 2 rejects, or drops content of: the rest of the search goes on from there."""
        urdf = self.final.submission.urdf
        if isinstance(urdf, Read) and urdf.loaded.verdict == "clean" and not _has_remains(urdf.loaded):
            return
        from grader.grading.hints.loading import repaired  # late: most robots load

        repair = repaired(self.trials, self.reference)
        self.found += [Found(*hint) for hint in repair.hints]
        self.final = repair.final

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
        found: list[Proposal] = []
        if any(criterion.check.subject not in ("urdf", "robot") for criterion in criteria):
            from grader.package.edits.candidates import package_proposals  # late: a robot on its own needs none

            wanted = [(criterion.check.name, criterion.arguments) for criterion in criteria]
            found += package_proposals(state.submission.package, self._package(), wanted)
        found += raw_xacro_proposals(state.submission) if about_urdf else ()
        urdf = state.submission.urdf
        draft = Draft.of(urdf.reading) if isinstance(urdf, Read) else None
        if draft is not None:
            reference = self.reference or draft
            shown, moved = targets_of(_about_robot(criteria), draft.robot, reference.robot)
            anchors = tuple(dict.fromkeys((*shown, *moved)))
            if about_urdf:
                shown = moved = tuple(dict.fromkeys((*anchors, *(link.name for link in reference.robot.links))))
            places = [
                result.outcome.location for result in state.results.values() if result.outcome.location is not None
            ]
            found += proposals(draft, reference, shown, moved, anchors, places)
        return found

    def _options(self, state: State, wanted: Sequence[str], tried: Sequence[str]) -> Iterator[Option]:
        """Yield the edits of a state for wanted criteria, each with those of the tried ones that it makes pass."""
        for proposal in self._proposals(state, wanted):
            yield Option(proposal, self.trials.passing(state, proposal.edits, tried))

    def _tried(self, state: State, wanted: Sequence[str]) -> list[Option]:
        """Return the edits of a state, up to one that makes all lost criteria pass: no other can gain more."""
        options: list[Option] = []
        lost = state.failed
        for option in self._options(state, wanted, lost):
            options.append(option)
            is_enough = len(option.passes) == len(lost) and option.proposal.rank <= FITTED
            if is_enough and self._proven(state, option.proposal, wanted[0]):
                break
        return options

    def _best_of(self, state: State, name: str, options: Sequence[Option], ranks: range) -> Proposal | None:
        """Return a single edit, or two where these gain more; else all values of a link, or whole elements of the reference."""
        passing = [option for option in options if name in option.passes]
        single = [option for option in passing if option.proposal.rank <= FITTED]
        whole = [option for option in passing if FITTED < option.proposal.rank in ranks]
        best = self._best(state, name, single)
        more = [option for option in single if best is None or _promised(state.results, option) > best.gain]
        two = self._repaired(state, name, more)
        if two is not None and (best is None or two.gain > best.gain):
            best = two
        found = best or self._best(state, name, whole) or self._pair(state, name, options)
        return found.proposal if found is not None else None

    def _best(self, state: State, name: str, options: Iterable[Option]) -> "_Proven | None":
        """Return the edit with which a criterion passes, nothing is lost, and most points are gained; of equals the smallest."""
        found: list[_Proven] = []
        for option in sorted(options, key=lambda option: _promise(state.results, option))[:_MAX_OPTIONS]:
            proven = self._proven(state, option.proposal, name)
            if proven is not None:
                found.append(proven)
        return min(found, key=lambda one: (-one.gain, one.proposal.rank, one.proposal.size), default=None)

    def _proven(self, state: State, proposal: Proposal, name: str) -> "_Proven | None":
        after = self.trials.applied(state, proposal.edits)
        if after is None or after.lost or after.results[name].outcome.status != "passed":
            return None
        return _Proven(proposal, _score(after.results) - _score(state.results))

    def _repaired(self, state: State, name: str, options: Iterable[Option]) -> "_Proven | None":
        """Return two edits: the first makes a criterion pass and others fail, which the second repairs."""
        likely = [option for option in options if option.proposal.is_expected]
        for option in sorted(likely, key=lambda option: _promise(state.results, option))[:_MAX_REPAIRED]:
            first = option.proposal
            middle = self.trials.applied(state, first.edits)
            broken = [middle.lost] if middle is not None and middle.lost else []
            for second in self._options(middle, broken, broken) if middle is not None and broken else ():
                if second.passes and second.proposal.rank <= FITTED:
                    edits = joined(state.submission, first.edits, second.proposal.edits)
                    proven = self._proven(state, _pair_of(first, second.proposal, edits), name)
                    if proven is not None:
                        return proven
        return None

    def _pair(self, state: State, name: str, options: Sequence[Option]) -> "_Proven | None":
        """Return two edits of one link that make a criterion pass together."""
        urdf = state.submission.urdf
        robot = urdf.reading.robot if isinstance(urdf, Read) else None
        if robot is None:
            return None
        links = targets_of([self._criteria[name]], robot, self.reference.robot if self.reference else robot)
        plausible = [
            option.proposal
            for option in options
            if option.proposal.is_expected and option.proposal.link in (*links.shown, *links.moved)
        ]
        pairs = (pair for pair in combinations(plausible, 2) if pair[0].link == pair[1].link)
        for _, (first, second) in zip(range(_MAX_PAIRS), pairs, strict=False):
            pair = _pair_of(first, second, (*first.edits, *second.edits))
            proven = self._proven(state, pair, name) if self.trials.passing(state, pair.edits, (name,)) else None
            if proven is not None:
                return proven
        return None

    def _prove(self, state: State, proposal: Proposal, name: str) -> bool:
        """Add a proven edit of the submission as it is: the edit alone, else together with one or all of those before it."""
        submission = self.trials.start.submission
        all_edits = joined(submission, state.edits, proposal.edits) if state.edits else proposal.edits
        alone = tuple(edit for edit in all_edits if edit not in state.edits)
        if len(alone) + len(state.edits) == len(all_edits):
            if self._add(proposal, alone, name, ()):
                return True
            for before in list(self.found):
                if self._add(proposal, joined(submission, before.edits, ()) + alone, name, (before,)):
                    return True
        return self._add(proposal, all_edits, name, tuple(self.found))

    def _add(self, proposal: Proposal, edits: Edits, name: str, after: tuple[Found, ...]) -> bool:
        start = self.trials.start
        state = self.trials.applied(start, edits, whole=True)
        if state is None or state.lost:
            return False
        gains = gained(start.results, state.results)
        edits = tuple(edit for edit in edits if edit.old != edit.new or edit.renamed)
        if name in gains:
            self.found.append(Found(proposal, edits, gains, after))
        return name in gains

    def _combine(self) -> None:
        """Find which of the proven edits make a criterion pass together that no single one does."""
        start = self.trials.start
        for name in self._by_cost(start.results):
            if any(name in found.gains for found in self.found) or self.final.results[name].outcome.status != "passed":
                continue
            for first, second in combinations(self.found, 2):
                edits = tuple(dict.fromkeys((*first.edits, *second.edits)))
                if not first.after and not second.after and self._add(_UNION, edits, name, (first, second)):
                    break
            else:
                self._add(_UNION, self.final.edits, name, tuple(self.found))


def _has_remains(reading: Reading) -> bool:
    """Return whether a file that ROS 2 loads has problems, or text between its tags."""
    texts = (
        (text for element in reading.root.iter() for text in (element.text, element.tail))
        if reading.root is not None
        else ()
    )
    return bool(reading.problems) or any(text and not text.isspace() for text in texts)


def _about_robot(criteria: Iterable[Criterion]) -> Iterator[Criterion]:
    return (criterion for criterion in criteria if criterion.check.subject == "robot")


class _Proven(NamedTuple):
    """An edit of a state that is proven, and the points that it gains."""

    proposal: Proposal
    gain: Decimal


def _promised(results: Results, option: Option) -> Decimal:
    return sum((results[name].criterion.points for name in option.passes), Decimal(0))


def _promise(results: Results, option: Option) -> tuple[Decimal, int, int]:
    return -_promised(results, option), option.proposal.rank, option.proposal.size


def _score(results: Results) -> Decimal:
    return sum((result.points for result in results.values()), Decimal(0))


def _pair_of(first: Proposal, second: Proposal, edits: Edits) -> Proposal:
    leading = tuple(sorted(edits, key=lambda edit: edit not in first.edits))
    return Proposal(leading, f"{first.named} and {second.named}", f"{first.said} and {second.said}", "", first.link)
