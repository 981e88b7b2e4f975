"""Choose the edits of a submission for its failed criteria: single ones first, then two, then whole elements of the reference."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from itertools import combinations
from typing import NamedTuple

from grader.edits import FITTED, Proposal
from grader.grading.criterion import Criterion
from grader.grading.hints.proposing import Proposing
from grader.grading.hints.trials import Edits, Results, State, Trials, joined

_MAX_OPTIONS = 4  # edits that are proven for one criterion, to choose the best
_MAX_PAIRS = 60
_MAX_REPAIRED = 3  # edits that make a criterion pass and others fail, which a second edit may repair


class Option(NamedTuple):
    """An edit, and the criteria that a quick look says pass with it."""

    proposal: Proposal
    passes: frozenset[str]


class _Proven(NamedTuple):
    """An edit of a state that is proven, and the points that it gains."""

    proposal: Proposal
    gain: Decimal


class Choice:
    """The edits that may be chosen, and the trials that decide."""

    def __init__(self, trials: Trials, proposing: Proposing, criteria: Mapping[str, Criterion]) -> None:
        self._trials = trials
        self._proposing = proposing
        self._criteria = criteria

    def _options(self, state: State, wanted: Sequence[str], tried: Sequence[str]) -> Iterator[Option]:
        """Yield the edits of a state for wanted criteria, each with those of the tried ones that it makes pass."""
        for proposal in self._proposing.proposals(state, [self._criteria[name] for name in wanted]):
            yield Option(proposal, self._trials.passing(state, proposal.edits, tried))

    def tried(self, state: State, wanted: Sequence[str]) -> list[Option]:
        """Return the edits of a state, up to one that makes all lost criteria pass: no other can gain more."""
        options: list[Option] = []
        lost = state.failed
        for option in self._options(state, wanted, lost):
            options.append(option)
            is_enough = len(option.passes) == len(lost) and option.proposal.rank <= FITTED
            if is_enough and self._proven(state, option.proposal, wanted[0]):
                break
        return options

    def best(self, state: State, name: str, options: Sequence[Option], ranks: range) -> Proposal | None:
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
        after = self._trials.applied(state, proposal.edits)
        if after is None or after.lost or after.results[name].outcome.status != "passed":
            return None
        return _Proven(proposal, _score(after.results) - _score(state.results))

    def _repaired(self, state: State, name: str, options: Iterable[Option]) -> "_Proven | None":
        """Return two edits: the first makes a criterion pass and others fail, which the second repairs."""
        likely = [option for option in options if option.proposal.is_expected]
        for option in sorted(likely, key=lambda option: _promise(state.results, option))[:_MAX_REPAIRED]:
            first = option.proposal
            middle = self._trials.applied(state, first.edits)
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
        links = self._proposing.targets(state, self._criteria[name])
        plausible = [
            option.proposal
            for option in options
            if option.proposal.is_expected and option.proposal.link in (*links.shown, *links.moved)
        ]
        pairs = (pair for pair in combinations(plausible, 2) if pair[0].link == pair[1].link)
        for _, (first, second) in zip(range(_MAX_PAIRS), pairs, strict=False):
            pair = _pair_of(first, second, (*first.edits, *second.edits))
            proven = self._proven(state, pair, name) if self._trials.passing(state, pair.edits, (name,)) else None
            if proven is not None:
                return proven
        return None


def _promised(results: Results, option: Option) -> Decimal:
    return sum((results[name].criterion.points for name in option.passes), Decimal(0))


def _promise(results: Results, option: Option) -> tuple[Decimal, int, int]:
    return -_promised(results, option), option.proposal.rank, option.proposal.size


def _score(results: Results) -> Decimal:
    return sum((result.points for result in results.values()), Decimal(0))


def _pair_of(first: Proposal, second: Proposal, edits: Edits) -> Proposal:
    leading = tuple(sorted(edits, key=lambda edit: edit not in first.edits))
    return Proposal(leading, f"{first.named} and {second.named}", f"{first.said} and {second.said}", "", first.link)
