"""A look at a state: the pieces that may help a criterion, and the lost criteria that pass with each."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

from grader.edits import Proposal
from grader.errors import MissingElement, NotDecided
from grader.grading.criterion import Criterion
from grader.grading.hints.model import Model
from grader.grading.hints.targets import Targets, targets_of
from grader.grading.hints.trials import State, Trials
from grader.grading.subjects import named_links
from grader.robot.edits.difference import RobotDifference
from grader.robot.edits.draft import Draft, Set
from grader.robot.edits.numbers import values_of, written
from grader.robot.edits.pieces import CONVENTION, Piece
from grader.robot.kinematics import Configuration
from grader.submission.raw_xacro import raw_xacro_proposals
from grader.submission.urdf import Read

if TYPE_CHECKING:
    from grader.package.package import Package


class Look:
    """A state that is looked at: its pieces, and the lost criteria that pass with each."""

    def __init__(
        self, trials: Trials, state: State, reference: Draft | None, package: "Callable[[], Package | None]"
    ) -> None:
        self.trials, self.state, self.reference = trials, state, reference
        self._package = package
        urdf = state.submission.urdf
        self.draft = Draft.of(urdf.reading) if isinstance(urdf, Read) else None
        self._passing: dict[int, frozenset[str]] = {}
        self._kept: list[Piece] = []  # whose ids are known

    @cached_property
    def model(self) -> Model:
        """The robot, to ask what criteria measure."""
        assert self.draft is not None
        return Model(self.trials, self.state, self.draft)

    @cached_property
    def difference(self) -> RobotDifference:
        """The robot beside the reference's."""
        assert self.draft is not None
        return RobotDifference(self.draft, self.reference or self.draft)

    @cached_property
    def pieces(self) -> list[Piece]:
        """The difference to the reference."""
        found: list[Piece] = []
        if self.draft is not None:
            with self.trials.isolated():
                corrections = self.draft.source.corrections(self.difference.names, self.difference.numbers)
                found = [Piece(it.cause, it.action, "", (), it.edits) for it in corrections]
                found += self.difference.pieces
        return found

    def with_links(self, criterion: Criterion) -> Criterion:
        """Return a criterion with the names of the links that selectors mean, where each means one."""
        if criterion.has_selectors and self.draft is not None:
            with suppress(MissingElement, NotDecided):
                return replace(criterion, arguments=named_links(criterion.arguments, Configuration(self.draft.robot)))
        return criterion

    def targets(self, criterion: Criterion) -> Targets:
        """Return the links on which a criterion depends."""
        if self.draft is None:
            return Targets((), ())
        return targets_of([self.with_links(criterion)], self.draft.robot, (self.reference or self.draft).robot)

    def relevant(self, criterion: Criterion) -> list[Piece]:
        """Return the pieces that may decide a criterion, the most plausible first."""
        if criterion.check.subject in ("package", "submission"):
            return []
        links = {*(targets := self.targets(criterion)).shown, *targets.moved, ""}
        is_all = criterion.check.subject == "urdf" or len(links) == 1
        found = (piece for piece in self.pieces if is_all or piece.link in links)
        return sorted(found, key=lambda piece: piece.rank)

    def passing(self, piece: Piece, wanted: Sequence[str]) -> frozenset[str]:
        """Return the wanted criteria that pass with a piece, as far as a quick look tells."""
        if id(piece) not in self._passing:
            self._kept.append(piece)
            if piece.sets:
                results = self.model.results(piece.sets, wanted).values()
                found = frozenset(result.criterion.id for result in results if result.outcome.status == "passed")
            else:
                found = self.trials.passing(self.state, piece.edits, wanted)
            self._passing[id(piece)] = found
        return self._passing[id(piece)]

    def shrunk(self, piece: Piece, passes: frozenset[str]) -> Piece:
        """Return a piece without changes of numbers that nothing needs."""
        if piece.sets and piece.rank != CONVENTION and not piece.is_mistake:
            for sets in _fewer(piece):
                smaller = self.difference.of_sets(sets, piece.rank)
                if passes <= self.passing(smaller, [*passes]):
                    return self.shrunk(smaller, passes)
        return piece

    def proposals(self, piece: Piece) -> Iterator[Proposal]:
        """Yield the edits of the text that a piece stands for."""
        assert self.draft is not None
        for way, edits in enumerate(self.draft.ways(piece.sets) if piece.sets else [piece.edits]):
            yield Proposal(edits, piece.cause, piece.action, piece.link, piece.rank, way)

    def of_package(self, criterion: Criterion) -> list[Proposal]:
        """Return the edits of the package for a criterion, and of xacro that is loaded as it stands."""
        found: list[Proposal] = []
        if criterion.check.subject not in ("urdf", "robot"):
            from grader.package.edits.candidates import package_proposals  # late: a robot on its own needs none

            wanted = [(criterion.check.about.looks_at, criterion.arguments)]
            found += package_proposals(self.state.submission.package, self._package(), wanted, self.trials.isolated)
        with self.trials.isolated():
            found += raw_xacro_proposals(self.state.submission) if criterion.check.subject == "urdf" else ()
        return found


def _fewer(piece: Piece) -> Iterator[list[Set]]:
    """Yield what a piece sets of its first element, without one attribute or with one of its numbers as it was."""
    first = piece.sets[0]
    own = [one for one in piece.sets if one.owner is first.owner and one.tag == first.tag]
    for place, one in enumerate(own):
        if len(own) > 1:
            yield own[:place] + own[place + 1 :]
            continue
        old, new = values_of(one.element.get(one.attribute) if one.element is not None else None), values_of(one.value)
        off = [index for index, pair in enumerate(zip(old, new, strict=False)) if pair[0] != pair[1]]
        for index in off if len(old) == len(new) and len(off) > 1 else ():
            yield [one._replace(value=written((*new[:index], old[index], *new[index + 1 :])))]
