"""The edits that may help a state, as pieces, and the lost criteria that pass with each."""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

from grader.edits import Proposal
from grader.errors import MissingElement, NotDecided
from grader.grading.criterion import Criterion
from grader.grading.deciding import decide
from grader.grading.hints.targets import Targets, targets_of
from grader.grading.hints.trials import State, Trials
from grader.grading.report import Result
from grader.grading.subjects import named_links
from grader.robot.edits.difference import RobotDifference
from grader.robot.edits.draft import Draft
from grader.robot.edits.elements import Set
from grader.robot.edits.numbers import format_numbers, values_of
from grader.robot.edits.pieces import CONVENTION, Piece
from grader.robot.kinematics import Configuration
from grader.robot.reader import read_robot
from grader.source import Location, Source
from grader.submission.raw_xacro import raw_xacro_proposals
from grader.submission.urdf import Read
from grader.xml.parsing import XmlDocument

if TYPE_CHECKING:
    from grader.package.package import Package


class _Nowhere(Source):
    """The text of no file: elements that are changed have no place."""

    def tag(self, index: int, attribute: str | None = None) -> Location:
        del index, attribute
        return Location(self.path, 1, 1)

    def element(self, tag: int) -> tuple[Source, int]:
        del tag
        return self, 0


class QuickGrading:
    """What criteria measure with other values in the elements of a state's robot, without a change of its text."""

    def __init__(self, trials: Trials, state: State, draft: Draft) -> None:
        self._trials, self._state, self._draft = trials, state, draft
        self._source = _Nowhere("", "")
        self._cost = 1 + len(draft.robot.links) // 40

    def results(self, sets: Iterable[Set], wanted: Collection[str]) -> dict[str, Result]:
        """Return the results of criteria with other values, charged to the trials. Raises NoTrialsLeft."""
        self._trials.charge(self._cost)
        self._trials.charge_checks(wanted)
        submission = self._state.submission
        urdf = submission.urdf
        assert isinstance(urdf, Read)
        with self._draft.supposing(sets):
            unresolved = urdf.reading.unresolved
            document = XmlDocument(self._draft.root, self._source, [], 0, unresolved, is_expanded=urdf.is_expanded)
            reading = read_robot(document)
            changed = replace(submission, urdf=urdf._replace(reading=reading))
            return {result.criterion.id: result for result in decide(self._trials.rubric, changed, wanted)}


class StateEdits:
    """The pieces that may help a state, and the lost criteria that pass with each."""

    def __init__(
        self, trials: Trials, state: State, reference: Draft | None, package: "Callable[[], Package | None]"
    ) -> None:
        self.trials, self.state, self.reference = trials, state, reference
        self.lost = state.failed
        self._package = package
        urdf = state.submission.urdf
        self.draft = Draft.of(urdf.reading) if isinstance(urdf, Read) else None
        self._passing: dict[int, frozenset[str]] = {}
        self._kept: list[Piece] = []  # whose ids are known

    @cached_property
    def quick(self) -> QuickGrading:
        """What criteria measure with other values."""
        assert self.draft is not None
        return QuickGrading(self.trials, self.state, self.draft)

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
                corrections = self.draft.corrections(self.difference.names, self.difference.numbers)
                found = [Piece(it.cause, it.action, "", (), it.edits) for it in corrections]
                found += self.difference.pieces
        return found

    def with_links(self, criterion: Criterion) -> Criterion:
        """Return a criterion with the names of the links that selectors mean, where each means one."""
        if criterion.has_selectors and self.draft is not None:
            with suppress(MissingElement, NotDecided):
                return criterion._replace(arguments=named_links(criterion.arguments, Configuration(self.draft.robot)))
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

    def passing(self, piece: Piece, wanted: Sequence[str] = ()) -> frozenset[str]:
        """Return the wanted criteria, else the lost ones, that pass with a piece; its text changes only if needed."""
        if id(piece) not in self._passing:
            self._kept.append(piece)
            wanted = wanted or self.lost
            if piece.sets:
                results = self.quick.results(piece.sets, wanted).values()
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
            value = format_numbers((*new[:index], old[index], *new[index + 1 :]))
            if value != one.value:  # a number that is not finite, or has more digits, differs all the same
                yield [one._replace(value=value)]
