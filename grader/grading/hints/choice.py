"""Choose the edit that makes a failed criterion pass: a piece of the difference, a solved number, or few pieces."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from decimal import Decimal
from itertools import chain, islice
from typing import TYPE_CHECKING, NamedTuple

from grader.checks.registry import declared
from grader.edits import Proposal
from grader.grading.criterion import Criterion
from grader.grading.hints.slots import slots
from grader.grading.hints.solving import Solver
from grader.grading.hints.state_edits import StateEdits
from grader.grading.hints.trials import NoTrialsLeft, State, Trials, as_one, join
from grader.robot.edits.conventions import conventions, other_frames
from grader.robot.edits.draft import Draft
from grader.robot.edits.pieces import KNOWN, SOLVED, STRUCTURE, Piece
from grader.source import Certainty, Edits
from grader.submission.editing import edited_files
from grader.submission.submission import Submission

if TYPE_CHECKING:
    from grader.package.package import Package

_MAX_OPTIONS = 4  # edits that are proven for one criterion, to choose the best
_MAX_FIRST = 3  # edits that make a criterion pass and others fail, which a second edit may repair
_MAX_WRITINGS = 3  # of a change in xacro
_WAYS = 4  # before numbers are solved for
_MIN_WHOLE = 4  # criteria that fail where a convention of the robot is wrong
_MAX_LOOK_STEPS = 100  # for other edits than those that were found, of one submission
_MAX_PLACES = 3  # that a hint changes: more are no single mistake


class Proven(NamedTuple):
    """An edit of a state that is proven, and the points that it gains."""

    proposal: Proposal
    gain: Decimal


class EditChoice:
    """Chooses edits of states."""

    def __init__(self, trials: Trials, reference: Draft | None, package: "Callable[[], Package | None]") -> None:
        self._trials, self._reference, self._package = trials, reference, package
        self._options: tuple[State, StateEdits] | None = None
        self._chosen: dict[Proposal, tuple[Proven, StateEdits, Criterion]] = {}
        self.causes: dict[str, list[str]] = {}  # what is wrong where more has to change than a hint may say

    def _options_of(self, state: State) -> StateEdits:
        if self._options is None or self._options[0] is not state:
            self._options = state, StateEdits(self._trials, state, self._reference, self._package)
        return self._options[1]

    def best(self, state: State, criterion: Criterion, *, is_solving: bool) -> Proposal | None:
        """Return the edit with which a criterion passes, and which gains most; None if none is found."""
        options, name = self._options_of(state), criterion.id
        ways: Sequence[Callable[[], Iterable[Proposal]]] = (
            lambda: self._passing(options, options.relevant(criterion), name),
            lambda: self._passing(options, self._suggested(options, criterion), name),
            lambda: self._package_edits(options, criterion),
            lambda: self._repairs(options, criterion, SOLVED),
            lambda: self._passing(options, self._solved(options, criterion), name),
            lambda: self._other_frames(options, criterion),
            lambda: self._repairs(options, criterion, STRUCTURE),
            lambda: self._together(options, criterion),
        )
        best: Proven | None = None
        for way in ways if is_solving else ways[:_WAYS]:
            if best is None or best.proposal.rank >= STRUCTURE:
                with self._trials.isolated():
                    best = min(filter(None, (best, self._best(state, name, way()))), key=_order, default=None)
        if best is None:
            return None
        self._chosen[best.proposal] = best, options, criterion
        return best.proposal

    def certainties(self, found: Iterable[Proposal]) -> dict[Proposal, Certainty]:
        """Return how sure chosen edits are: looks at other places with a budget of its own, after the search."""
        certainties: dict[Proposal, Certainty] = dict.fromkeys(found, "preferred")
        chosen = [proposal for proposal in certainties if proposal in self._chosen]
        left = _MAX_LOOK_STEPS
        for others, proposal in zip(reversed(range(len(chosen))), chosen, strict=True):
            share = self._trials.left = left // (others + 1)
            with suppress(NoTrialsLeft), self._trials.isolated():
                certainties[proposal] = self._certainty(*self._chosen[proposal])
            left -= share - max(self._trials.left, 0)
        return certainties

    def _certainty(self, chosen: Proven, options: StateEdits, criterion: Criterion) -> Certainty:
        mine, submission = chosen.proposal, options.state.submission
        text, has_mine, has_others = _text_after(submission, mine.edits), False, False
        for proposal in self._all_passing(options, criterion):
            if has_others and proposal.rank > mine.rank:
                break
            if proposal.places >= mine.places or _text_after(submission, proposal.edits) == text:
                has_mine |= proposal.places == mine.places
                continue
            other = self._proven(options.state, proposal, criterion.id)
            if other is not None and _order(other) <= _order(chosen):
                return "one of several"
            has_others |= other is not None
        # Edits of several places are not looked through, and a package can be written in ways that are not known here.
        is_only = has_mine and not has_others and criterion.check.subject == "robot"
        return "only" if is_only else "preferred"

    def _all_passing(self, options: StateEdits, criterion: Criterion) -> Iterator[Proposal]:
        """Yield the edits of one place with which a criterion passes, of all that are known."""
        for piece in chain(
            options.relevant(criterion), self._suggested(options, criterion), self._solved(options, criterion)
        ):
            passes = options.passing(piece)
            if criterion.id in passes:
                yield from islice(options.proposals(options.shrunk(piece, passes)), _MAX_WRITINGS)
        yield from self._package_edits(options, criterion)

    def convention(self, state: State) -> Proposal | None:
        """Return the edit that changes a convention of the whole robot, if many criteria pass with it."""
        options = self._options_of(state)
        if options.draft is None or len(options.lost) < _MIN_WHOLE:
            return None
        pieces = [piece for piece in conventions(options.difference) if len(options.passing(piece)) >= _MIN_WHOLE - 1]
        pieces.sort(key=lambda piece: -len(options.passing(piece)))
        firsts = (it for piece in pieces for it in islice(options.proposals(piece), 1))
        return next((it for it in firsts if self._trials.loses_nothing(state, it.edits)), None)

    def _best(self, state: State, name: str, proposals: Iterable[Proposal]) -> Proven | None:
        """Return the proven edit that gains most, of equals the smallest; one that gains all ends the search."""
        found: list[Proven] = []
        for proposal in proposals:
            proven = self._proven(state, proposal, name)
            if proven is not None:
                found.append(proven)
            if len(found) == _MAX_OPTIONS or (proven is not None and proven.gain >= state.lost_points):
                break
        return min(found, key=_order, default=None)

    def _proven(self, state: State, proposal: Proposal, name: str) -> Proven | None:
        after = self._trials.apply(state, proposal.edits)
        if after is None or after.lost or after.results[name].outcome.status != "passed":
            return None
        return Proven(proposal, after.score - state.score)

    def _passing(self, options: StateEdits, pieces: Iterable[Piece], name: str) -> Iterator[Proposal]:
        """Yield the edits of pieces with which a criterion passes, those with which most pass first of a few."""
        batch: list[Piece] = []
        for piece in pieces:
            passes = options.passing(piece)
            if name in passes:
                batch.append(options.shrunk(piece, passes))
            if len(passes) == len(options.lost) or len(batch) == 2 * _MAX_OPTIONS:
                break
        batch.sort(key=lambda piece: -len(options.passing(piece)))
        for piece in batch:
            yield from islice(options.proposals(piece), _MAX_WRITINGS)

    def _other_frames(self, options: StateEdits, criterion: Criterion) -> Iterator[Proposal]:
        if options.draft is not None and criterion.check.subject == "robot":
            yield from self._passing(options, other_frames(options.difference), criterion.id)

    def _suggested(self, options: StateEdits, criterion: Criterion) -> Iterable[Piece]:
        """Return the pieces that the check suggests itself."""
        place = criterion.check.about.suggests
        if options.draft is None or not place:
            return ()
        failed = [options.with_links(it) for it in self._trials.rubric.criteria if it.id in options.lost]
        own = options.with_links(criterion).arguments
        others = [it.arguments for it in failed if it.arguments.get("link") == own.get("link")]
        arguments = {key: value for given in (*others, own) for key, value in given.items()}
        found: Iterable[Piece] = declared(place)(options.difference, arguments)
        return found

    def _package_edits(self, options: StateEdits, criterion: Criterion) -> Iterator[Proposal]:
        for proposal in options.of_package(criterion):
            if self._trials.passing(options.state, proposal.edits, (criterion.id,)):
                yield proposal

    def _solved(self, options: StateEdits, criterion: Criterion) -> Iterable[Piece]:
        if options.draft is None or criterion.check.subject != "robot":
            return ()
        shown, moved = options.targets(criterion)
        solver = Solver(options.quick, options.difference, criterion.id, options.state.results[criterion.id].outcome)
        return solver.pieces(slots(options.draft, shown, moved))

    def _repairs(self, options: StateEdits, criterion: Criterion, rank: int) -> Iterator[Proposal]:
        """Yield two edits up to a rank: the first makes a criterion pass and others fail, which the second repairs."""
        name = criterion.id
        plausible = [piece for piece in options.relevant(criterion) if piece.rank <= rank]
        firsts = [piece for piece in plausible if name in options.passing(piece)]
        for first in islice((it for piece in firsts for it in islice(options.proposals(piece), 1)), _MAX_FIRST):
            middle = self._trials.apply(options.state, first.edits)
            if middle is None or not middle.lost:
                continue
            broken = middle.lost
            other = StateEdits(self._trials, middle, self._reference, self._package)
            target = next(it for it in self._trials.rubric.criteria if it.id == broken)
            for piece in other.relevant(target):
                if piece.rank <= rank and broken in other.passing(piece, (broken,)):
                    for second in islice(other.proposals(piece), 1):
                        edits = join(options.state.submission, first.edits, second.edits)
                        yield as_one([first, second], edits)

    def _together(self, options: StateEdits, criterion: Criterion) -> Iterator[Proposal]:
        """Yield the fewest pieces of the difference with which a criterion passes, if they are few."""
        pieces = [piece for piece in options.relevant(criterion) if piece.sets or piece.edits]
        kept = self._fewest(options, _compatible(pieces, KNOWN), criterion.id) or self._fewest(
            options, _compatible(pieces, STRUCTURE), criterion.id
        )
        if len(kept) > _MAX_PLACES:
            self.causes[criterion.id] = list(dict.fromkeys(piece.cause for piece in kept))[:_MAX_PLACES]
        elif len(kept) > 1:
            proposals = [it for piece in kept for it in islice(options.proposals(piece), 1)]
            yield as_one(proposals, tuple(edit for it in proposals for edit in it.edits))

    def _fewest(self, options: StateEdits, pieces: list[Piece], name: str) -> list[Piece]:
        """Return few of these pieces with which a criterion passes; none if it does not pass with all of them."""
        if not pieces or not self._is_passing(options, pieces, name):
            return []
        size = max(1, len(pieces) // 2)
        while True:
            for start in range(0, len(pieces), size):
                fewer = pieces[:start] + pieces[start + size :]
                if fewer and self._is_passing(options, fewer, name):
                    pieces = fewer
                    break
            else:
                if size == 1:
                    return pieces
                size = max(1, size // 2)
            size = min(size, max(1, len(pieces) // 2))

    def _is_passing(self, options: StateEdits, pieces: Sequence[Piece], name: str) -> bool:
        if all(piece.sets for piece in pieces):
            sets = [one for piece in pieces for one in piece.sets]
            return options.quick.results(sets, (name,))[name].outcome.status == "passed"
        proposals = [next(options.proposals(piece), None) for piece in pieces]
        edits: Edits = tuple(dict.fromkeys(edit for it in proposals if it is not None for edit in it.edits))
        return name in self._trials.passing(options.state, edits, (name,))


def _order(one: Proven) -> tuple[Decimal, int, int, int]:
    return -one.gain, one.proposal.rank, one.proposal.way, one.proposal.size


def _text_after(submission: Submission, edits: Edits) -> dict[str, bytes | None]:
    """Return the files that edits change, without white space: several edits may write the same."""
    files = edited_files(submission, edits) or {}
    return {path: data and b"".join(data.split()) for path, data in files.items()}


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
