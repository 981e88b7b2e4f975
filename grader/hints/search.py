"""Search the edits that make failed criteria pass: each is graded alone, and with those that were found before it.

A `Piece` is what one mistake needs, with its words; a `Proposal` is one way to write it into the files; what grading
proves becomes a `FoundHint`, and in a report a `Hint`. All of them together are the `Fix`.
"""

from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import suppress
from decimal import Decimal
from typing import TYPE_CHECKING, NamedTuple

from grader.grading.criterion import Criterion
from grader.hints.edits import Proposal
from grader.hints.families import Families
from grader.hints.missing import missing_hints
from grader.hints.robot.draft import Draft
from grader.hints.robot.pieces import REFERENCE, STRUCTURE
from grader.hints.targets import leaves_others
from grader.hints.trials import FoundHint, NoTrialsLeft, Results, Trials, costs_of, gains_of
from grader.source import Edits

if TYPE_CHECKING:
    from grader.package.package import Package

_RESERVE = 20  # gradings for proofs
_AROUND = " ,\r\n"  # of a text that is added
_MAX_PARTS = 5  # edits of a hint of which each is tried without


class _Tried(NamedTuple):
    proposal: Proposal
    passes: frozenset[str]
    is_assumed: bool  # they may pass by what is undone, and not by the edit: others come first


class HintSearch:
    """The search for one submission: `found` are proven edits that fit together, `edits` are those of all."""

    def __init__(
        self,
        trials: Trials,
        reference: Draft | None,
        package: "Callable[[], Package | None]" = lambda: None,
        told: Collection[str] = (),
    ) -> None:
        """`reference` and `package` are the robot and the package of the rubric's reference solution.

        No edit is searched for the criteria that are `told`.
        """
        self.trials, self._families = trials, Families(trials, reference, package)
        self._criteria = {criterion.id: criterion for criterion in trials.rubric.criteria}
        self.found: list[FoundHint] = []
        self.missing: dict[str, FoundHint] = {}  # by the criterion that shows that a part is missing, or two edits
        self._refused = set[Edits]()  # after all hints so far
        self._told = {*told}  # also criteria for which two edits are told that cannot be told apart
        self._taken: dict[str, Edits] = {}  # the edits after which a family was tried last
        self.results: Results = trials.results  # with all edits
        self._after: Results = self.results
        self.is_complete = self._is_cut = False

    @property
    def edits(self) -> Edits:
        """The edits of all hints."""
        return tuple(edit for found in self.found for edit in found.edits)

    def run(self) -> "HintSearch":
        """Search until nothing more is found, or the budget is spent."""
        with suppress(NoTrialsLeft):
            if self.trials.left:
                all_ = self._families
                families = (all_.of_reference, all_.of_package, all_.of_own, all_.of_links)
                for family in (*families, all_.of_reference, all_.of_package):
                    self._take(family)
                self.is_complete = not self._is_cut or not self._lost
        self.trials.left = max(self.trials.left, 1 + self.trials.submission.cost)  # for the last one
        with self.trials.isolated():
            self._verify()
        with self.trials.isolated():
            known = {name for found in self.found for name in found.gains} | self.missing.keys()
            lost = {name: points for name, points in costs_of(self.trials.results).items() if name not in known}
            if self._families.is_whole:
                self.missing |= missing_hints(self._families.difference, self._criteria, lost)
        return self

    def _verify(self) -> None:
        """Take no hint back only if all together hold where the submission is read from scratch."""
        if self.found and not self.trials.graded(self.edits, self.results, whole=True):
            self.found, self.results = [], self.trials.results

    @property
    def _lost(self) -> list[str]:
        return [name for name, result in self.results.items() if result.is_lost and name not in self._told]

    def _take(self, family: Callable[[list[Criterion]], Iterable[Proposal]]) -> None:
        """Try the edits of a family, each once, and take those that are proven, those that gain most first."""
        lost, before = self._lost, self.edits
        if self._taken.get(family.__name__) == before:
            return
        self._taken[family.__name__] = before
        tried: list[_Tried] = []
        seen: set[Edits] = set()
        with self.trials.isolated():
            for proposal in family([self._criteria[name] for name in lost]) if lost else ():
                if proposal.edits in seen:
                    continue
                seen.add(proposal.edits)
                if self.trials.left < _RESERVE:
                    self._is_cut = True
                    break
                results = self.trials.graded((*before, *proposal.edits), lost)
                passes = frozenset(name for name, result in results.items() if result.outcome.status == "passed")
                tried += [_Tried(proposal, passes, self.trials.is_assumed)] * bool(passes)
        while best := self._best(tried):
            if not self._prove(best, tried):
                self._refused.add(best.proposal.edits)

    def _best(self, tried: Iterable[_Tried]) -> _Tried | None:
        lost = set(self._lost)
        left = (it for it in tried if it.passes & lost and it.proposal.edits not in self._refused)
        return min(left, key=lambda it: self._order(it, lost), default=None)

    def _order(self, one: _Tried, lost: Collection[str]) -> tuple[bool, Decimal, int, int, int]:
        gain = sum((self._criteria[name].points for name in one.passes if name in lost), Decimal(0))
        return one.is_assumed, -gain, one.proposal.rank, one.proposal.way, one.proposal.size

    def _prove(self, best: _Tried, tried: Iterable[_Tried]) -> bool:
        """Add an edit if it gains the points alone, or after the edits before it, and loses nothing of theirs."""
        edits = tuple(edit for edit in best.proposal.edits if edit not in self.edits)
        lost = set(self._lost)
        wanted = best.passes & lost
        together = self._gains(self.edits, edits, self.results)
        if together and best.proposal.rank in (REFERENCE, STRUCTURE) and 1 < len(edits) <= _MAX_PARTS:
            edits, together = self._needed(edits, together)
        after, best = self._after, best._replace(proposal=best.proposal._replace(edits=edits))
        alone = self._gains((), edits, self.trials.results) if self.found else {}
        is_late = bool(self.found) and not wanted & alone.keys()
        gains = alone if self.found and not is_late else together
        if not together or any(after[name].outcome.status != "passed" for name in gains):
            return False
        if not wanted & gains.keys() or self._is_half(best, after):
            return False
        known = {name for found in self.found for name in found.gains}
        gains = {name: points for name, points in gains.items() if name not in known} or gains
        equal = self._equal_to(best, together, wanted, tried)
        is_of_robot = all(path.endswith((".urdf", ".xacro")) for path in {edit.path for edit in best.proposal.edits})
        if equal is not None and is_of_robot:
            name = max((it for it in self._criteria if it in wanted), key=lambda name: self._criteria[name].points)
            self.missing[name] = FoundHint(best.proposal, {}, "one of several", alternative=equal.proposal)
            self._told |= wanted
            return False
        self.found.append(FoundHint(best.proposal, gains, "one of several" if equal else "preferred", is_late))
        self.results = after
        self._refused = set()
        return True

    def _needed(self, edits: Edits, gains: dict[str, Decimal]) -> tuple[Edits, dict[str, Decimal]]:
        """Leave out changes of values without which the others gain as much, and return what the rest gains."""
        after = self._after
        for edit in [it for it in edits if it.old and it.new]:
            rest = tuple(it for it in edits if it is not edit)
            left = self._gains(self.edits, rest, self.results) if rest else {}
            if gains.keys() <= left.keys():
                edits, gains, after = rest, left, self._after
        self._after = after
        return edits, gains

    def _equal_to(
        self, best: _Tried, gains: Mapping[str, Decimal], wanted: frozenset[str], tried: Iterable[_Tried]
    ) -> _Tried | None:
        """Return another edit that gains as much, at other places, and loses nothing either."""
        lost, known = set(self._lost), {best.proposal.edits, *self._refused}
        added = {edit.new.strip(_AROUND) for edit in best.proposal.edits if not edit.old}  # also in the next line
        others = (it for it in tried if it.passes >= wanted and it.proposal.edits not in known)
        others = (it for it in others if not added.issuperset(edit.new.strip(_AROUND) for edit in it.proposal.edits))
        equal = (it for it in others if self._order(it, lost) == self._order(best, lost))
        apart = (it for it in equal if it.proposal.places.isdisjoint(best.proposal.places))
        proven = (it for it in apart if gains.keys() <= self._gains(self.edits, it.proposal.edits, self.results).keys())
        return next(proven, None)

    def _is_half(self, best: _Tried, after: Results) -> bool:
        """Return whether an edit leaves what it should correct as well: in another call of a macro, or of its link."""
        lost = [self._criteria[name] for name, result in after.items() if result.is_lost]
        if leaves_others(best.proposal.shared, [self._criteria[name] for name in best.passes], lost):
            return True
        is_own = best.proposal.rank not in (REFERENCE, STRUCTURE) and bool(best.proposal.link)
        chains = (self._families.chain(it.arguments.get("link")) for it in lost if is_own)
        return any(best.proposal.link in chain for chain in chains)

    def _gains(self, before: Edits, edits: Edits, against: Results) -> dict[str, Decimal]:
        """Return what edits gain; nothing where a criterion is worse with them."""
        after = self.trials.graded((*before, *edits), against)
        self._after = after or self._after
        return gains_of(against, after)
