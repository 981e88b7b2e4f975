"""Choose the edit that makes a failed criterion pass: a piece of the difference, a solved number, or few pieces."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from decimal import Decimal
from itertools import islice
from typing import TYPE_CHECKING, NamedTuple

from grader.checks.registry import declared
from grader.edits import Proposal
from grader.grading.criterion import Criterion
from grader.grading.hints.look import Look
from grader.grading.hints.solving import Solver, slots
from grader.grading.hints.trials import Edits, Results, State, Trials, joined, together
from grader.robot.edits.conventions import conventions, other_frames
from grader.robot.edits.difference import RobotDifference
from grader.robot.edits.draft import Draft
from grader.robot.edits.pieces import KNOWN, SOLVED, STRUCTURE, Piece

if TYPE_CHECKING:
    from grader.package.package import Package

_MAX_OPTIONS = 4  # edits that are proven for one criterion, to choose the best
_MAX_FIRST = 3  # edits that make a criterion pass and others fail, which a second edit may repair
_WAYS = 4  # before numbers are solved for
_MIN_WHOLE = 4  # criteria that fail where a convention of the robot is wrong
_MAX_PLACES = 3  # that a hint changes: more are no single mistake


class Proven(NamedTuple):
    """An edit of a state that is proven, and the points that it gains."""

    proposal: Proposal
    gain: Decimal


class Choice:
    """Chooses edits of states."""

    def __init__(self, trials: Trials, reference: Draft | None, package: "Callable[[], Package | None]") -> None:
        self._trials, self._reference, self._package = trials, reference, package
        self._looks: tuple[State, Look] | None = None
        self.causes: dict[str, list[str]] = {}  # what is wrong where more has to change than a hint may say

    def _look(self, state: State) -> Look:
        if self._looks is None or self._looks[0] is not state:
            self._looks = state, Look(self._trials, state, self._reference, self._package)
        return self._looks[1]

    def best(self, state: State, criterion: Criterion, *, is_solving: bool) -> Proposal | None:
        """Return the edit with which a criterion passes, and which gains most; None if none is found."""
        look, name, lost = self._look(state), criterion.id, state.failed
        ways: Sequence[Callable[[], Iterable[Proposal]]] = (
            lambda: self._passing(look, look.relevant(criterion), name, lost),
            lambda: self._suggested(look, criterion, lost),
            lambda: self._package_edits(look, criterion),
            lambda: self._repaired(look, criterion, lost, SOLVED),
            lambda: self._solved(look, criterion, lost),
            lambda: self._of_whole(look, criterion, other_frames, lost),
            lambda: self._repaired(look, criterion, lost, STRUCTURE),
            lambda: self._together(look, criterion),
        )
        best: Proven | None = None
        for way in ways if is_solving else ways[:_WAYS]:
            if best is None or best.proposal.rank >= STRUCTURE:
                with self._trials.isolated():
                    best = min(filter(None, (best, self._best(state, name, way()))), key=_order, default=None)
        return best.proposal if best is not None else None

    def convention(self, state: State) -> Proposal | None:
        """Return the edit that changes a convention of the whole robot, if many criteria pass with it."""
        look, lost = self._look(state), state.failed
        if look.draft is None or len(lost) < _MIN_WHOLE:
            return None
        pieces = [piece for piece in conventions(look.difference) if len(look.passing(piece, lost)) >= _MIN_WHOLE - 1]
        pieces.sort(key=lambda piece: -len(look.passing(piece, lost)))
        firsts = (it for piece in pieces for it in islice(look.proposals(piece), 1))
        return next((it for it in firsts if self._trials.loses_nothing(state, it.edits)), None)

    def _best(self, state: State, name: str, proposals: Iterable[Proposal]) -> Proven | None:
        """Return the proven edit that gains most, of equals the smallest; one that gains all ends the search."""
        found: list[Proven] = []
        for proposal in proposals:
            proven = self._proven(state, proposal, name)
            if proven is not None:
                found.append(proven)
            if len(found) == _MAX_OPTIONS or (proven is not None and proven.gain >= _lost(state.results)):
                break
        return min(found, key=_order, default=None)

    def _proven(self, state: State, proposal: Proposal, name: str) -> Proven | None:
        after = self._trials.applied(state, proposal.edits)
        if after is None or after.lost or after.results[name].outcome.status != "passed":
            return None
        return Proven(proposal, _score(after.results) - _score(state.results))

    def _passing(self, look: Look, pieces: Iterable[Piece], name: str, lost: Sequence[str]) -> Iterator[Proposal]:
        """Yield the edits of pieces with which a criterion passes, those with which most pass first of a few."""
        batch: list[Piece] = []
        for piece in pieces:
            passes = look.passing(piece, lost)
            if name in passes:
                batch.append(look.shrunk(piece, passes))
            if len(passes) == len(lost) or len(batch) == 2 * _MAX_OPTIONS:
                break
        batch.sort(key=lambda piece: -len(look.passing(piece, lost)))
        for piece in batch:
            yield from islice(look.proposals(piece), 3)

    def _of_whole(
        self, look: Look, criterion: Criterion, make: Callable[[RobotDifference], Iterable[Piece]], lost: Sequence[str]
    ) -> Iterator[Proposal]:
        if look.draft is not None and criterion.check.subject == "robot":
            yield from self._passing(look, make(look.difference), criterion.id, lost)

    def _suggested(self, look: Look, criterion: Criterion, lost: Sequence[str]) -> Iterator[Proposal]:
        """Yield the edits that the check suggests itself."""
        place = criterion.check.about.suggests
        if look.draft is not None and place:
            make = declared(place)
            failed = [look.with_links(it) for it in self._trials.rubric.criteria if it.id in lost]
            own = look.with_links(criterion).arguments
            others = [it.arguments for it in failed if it.arguments.get("link") == own.get("link")]
            arguments = {key: value for given in (*others, own) for key, value in given.items()}
            yield from self._passing(look, make(look.difference, arguments), criterion.id, lost)

    def _package_edits(self, look: Look, criterion: Criterion) -> Iterator[Proposal]:
        for proposal in look.of_package(criterion):
            if self._trials.passing(look.state, proposal.edits, (criterion.id,)):
                yield proposal

    def _solved(self, look: Look, criterion: Criterion, lost: Sequence[str]) -> Iterator[Proposal]:
        if look.draft is None or criterion.check.subject != "robot":
            return
        shown, moved = look.targets(criterion)
        solver = Solver(look.model, look.difference, criterion.id, look.state.results[criterion.id].outcome)
        yield from self._passing(look, solver.pieces(slots(look.draft, shown, moved)), criterion.id, lost)

    def _repaired(self, look: Look, criterion: Criterion, lost: Sequence[str], rank: int) -> Iterator[Proposal]:
        """Yield two edits up to a rank: the first makes a criterion pass and others fail, which the second repairs."""
        name = criterion.id
        plausible = [piece for piece in look.relevant(criterion) if piece.rank <= rank]
        firsts = [piece for piece in plausible if name in look.passing(piece, lost)]
        for first in islice((it for piece in firsts for it in islice(look.proposals(piece), 1)), _MAX_FIRST):
            middle = self._trials.applied(look.state, first.edits)
            if middle is None or not middle.lost:
                continue
            broken = middle.lost
            other = Look(self._trials, middle, self._reference, self._package)
            target = next(it for it in self._trials.rubric.criteria if it.id == broken)
            for piece in other.relevant(target):
                if piece.rank <= rank and broken in other.passing(piece, (broken,)):
                    for second in islice(other.proposals(piece), 1):
                        edits = joined(look.state.submission, first.edits, second.edits)
                        yield together([first, second], edits)

    def _together(self, look: Look, criterion: Criterion) -> Iterator[Proposal]:
        """Yield the fewest pieces of the difference with which a criterion passes, if they are few."""
        pieces = [piece for piece in look.relevant(criterion) if piece.sets or piece.edits]
        kept = self._fewest(look, _compatible(pieces, KNOWN), criterion.id) or self._fewest(
            look, _compatible(pieces, STRUCTURE), criterion.id
        )
        if len(kept) > _MAX_PLACES:
            self.causes[criterion.id] = list(dict.fromkeys(piece.cause for piece in kept))[:_MAX_PLACES]
        elif len(kept) > 1:
            proposals = [it for piece in kept for it in islice(look.proposals(piece), 1)]
            yield together(proposals, tuple(edit for it in proposals for edit in it.edits))

    def _fewest(self, look: Look, pieces: list[Piece], name: str) -> list[Piece]:
        """Return few of these pieces with which a criterion passes; none if it does not pass with all of them."""
        if not pieces or not self._is_passing(look, pieces, name):
            return []
        size = max(1, len(pieces) // 2)
        while True:
            for start in range(0, len(pieces), size):
                fewer = pieces[:start] + pieces[start + size :]
                if fewer and self._is_passing(look, fewer, name):
                    pieces = fewer
                    break
            else:
                if size == 1:
                    return pieces
                size = max(1, size // 2)
            size = min(size, max(1, len(pieces) // 2))

    def _is_passing(self, look: Look, pieces: Sequence[Piece], name: str) -> bool:
        if all(piece.sets for piece in pieces):
            sets = [one for piece in pieces for one in piece.sets]
            return look.model.results(sets, (name,))[name].outcome.status == "passed"
        proposals = [next(look.proposals(piece), None) for piece in pieces]
        edits: Edits = tuple(dict.fromkeys(edit for it in proposals if it is not None for edit in it.edits))
        return name in self._trials.passing(look.state, edits, (name,))


def _order(one: Proven) -> tuple[Decimal, int, int, int]:
    return -one.gain, one.proposal.rank, one.proposal.way, one.proposal.size


def _compatible(pieces: Iterable[Piece], rank: int) -> list[Piece]:
    """Return the pieces up to a rank that do not change the same thing twice."""
    found: list[Piece] = []
    seen: set[object] = set()
    keys: set[object]
    for piece in pieces:
        keys = {one[:3] for one in piece.sets}
        keys |= {(edit.path, edit.line, edit.column) for edit in piece.edits if edit.old}
        if seen.isdisjoint(keys) and piece.rank <= rank:
            found.append(piece)
            seen |= keys
    return found


def _score(results: Results) -> Decimal:
    return sum((result.points for result in results.values()), Decimal(0))


def _lost(results: Results) -> Decimal:
    return sum((result.criterion.points for result in results.values() if result.is_lost), Decimal(0))
