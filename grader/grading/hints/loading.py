"""Repair a URDF step by step until ROS 2 loads it: each step makes ROS 2 read on, or reject or drop less."""

from collections.abc import Iterable, Iterator
from itertools import chain, islice
from typing import NamedTuple

from grader.edits import Proposal
from grader.grading.hints.trials import State, Trials, join
from grader.robot.catalogue import COLOUR_COUNT, MISSPELT
from grader.robot.edits.difference import RobotDifference
from grader.robot.edits.draft import Draft
from grader.robot.edits.pieces import STRUCTURE
from grader.robot.edits.problem_edits import misplaced, pieces_for, repairable
from grader.robot.model import Robot
from grader.robot.reader import Reading
from grader.source import Edits
from grader.submission.urdf import Read
from grader.xml.catalogue import IGNORED_REST, SEVERAL_ROOTS
from grader.xml.pieces import remaining
from grader.xml.syntax import syntax_proposals

_MAX_STEPS = 20  # of one chain
_MAX_GRADED = 4  # kinds of edits of one step that are graded, to choose the best
_MAX_VALUES = 40  # edits of one step that are graded
_MAX_CANDIDATES = 150  # edits of one step that are read
_MAX_MOVED = 6  # elements that are moved elsewhere
_MAX_BYTES = 400_000  # of a file: nobody types a larger one
_CHARACTERS = 5_000  # that the search for broken tags reads in the time of one step
_SILENT = (MISSPELT, COLOUR_COUNT, IGNORED_REST, SEVERAL_ROOTS)  # ROS 2 loads the file, without what was meant

Defects = tuple[int, ...]


class LoadingStep(NamedTuple):
    """An edit of a state that brings ROS 2 further, and the state after it."""

    proposal: Proposal
    before: State
    after: State


def defects(reading: Reading) -> Defects:
    """Return how much ROS 2 does not read, rejects, leaves unconnected, and drops or ignores: less is better."""
    effects = [problem.kind.effect for problem in reading.problems]
    unread = remaining(reading.source.text) if reading.root is None else -1
    is_cut = unread >= 0 or remaining(reading.source.text, is_urdf=True) >= 0
    silent = sum(problem.kind in _SILENT for problem in reading.problems) + is_cut
    rejected = effects.count("rejects") or int(reading.verdict == "rejected")
    return unread, rejected, _loose(reading.robot), effects.count("drops") + silent


def _loose(robot: Robot | None) -> int:
    """Return how many links have no parent joint."""
    return len(robot.links) - len({joint.child for joint in robot.joints}) if robot is not None else 0


def repair(trials: Trials, reference: Draft | None) -> tuple[list[Proposal], State]:
    """Return the repairs of a URDF as it is, without edits where one needs those before it; and the state after all.

    Raises NoTrialsLeft.
    """
    final = trials.start
    taken: list[Proposal] = []
    for step in _steps(trials, reference):
        edits = join(trials.start.submission, final.edits, step.proposal.edits)
        taken.append(step.proposal._replace(edits=_alone(edits, final.edits)))
        final = step.after._replace(edits=edits)
    return _group(taken), final


def _steps(trials: Trials, reference: Draft | None) -> Iterator[LoadingStep]:
    """Yield the steps towards a URDF of which ROS 2 drops nothing, within half of the budget. Raises NoTrialsLeft."""
    state, reserve = trials.start, trials.left // 2
    for _ in range(_MAX_STEPS):
        reading = _reading(state)
        if (
            reading is None
            or not state.failed
            or (reading.verdict == "clean" and not defects(reading)[-1])
            or trials.left < reserve
        ):
            return
        step = _best(trials, state, reading, islice(_candidates(trials, reading, reference), _MAX_CANDIDATES))
        if step is None:
            return
        yield step
        state = step.after


def _reading(state: State) -> Reading | None:
    """Return what ROS 2 loads; None of xacro that is loaded without xacro: its text is not what is wrong."""
    urdf = state.submission.urdf
    if not isinstance(urdf, Read) or len(urdf.data) > _MAX_BYTES:
        return None
    if urdf.as_it_stands is not None and b"xacro:" in urdf.data:
        return None
    return urdf.loaded


def _candidates(trials: Trials, reading: Reading, reference: Draft | None) -> Iterator[Proposal]:
    """Yield the edits that may be the next step, the most plausible first: of the text, then of its elements."""

    def charge(characters: int) -> None:
        trials.charge(characters // _CHARACTERS)

    is_strict = any(problem.kind.is_before_ros for problem in reading.problems)  # xacro, which reads XML only
    yield from syntax_proposals(reading.source, is_urdf=True, is_strict=is_strict, charge=charge)
    draft = Draft.of(reading)
    if draft is not None:
        difference = RobotDifference(draft, reference or draft)
        yield from draft.corrections(difference.names, difference.numbers)
        problems = repairable(reading.problems)
        own = (pieces_for(difference, problem) for problem in problems)
        lines = {problem.location.line for problem in problems}
        near = [
            piece
            for piece in difference.pieces
            if piece.rank == STRUCTURE
            or (piece.element is not None and draft.line(draft.owner(piece.element)) in lines)
        ]
        for piece in chain(islice(misplaced(difference), _MAX_MOVED), chain.from_iterable(own), near):
            for way, edits in enumerate(draft.ways(piece.sets)[:2] if piece.sets else [piece.edits]):
                yield Proposal(edits, piece.cause, piece.action, piece.link, piece.rank, way)


def _best(trials: Trials, state: State, reading: Reading, proposals: Iterable[Proposal]) -> LoadingStep | None:
    """Return the edit that brings ROS 2 furthest; of several after which it loads the file, the best-scoring one."""
    now = defects(reading)
    better: list[tuple[Defects, int, Proposal]] = []
    for order, proposal in enumerate(proposals):
        edited = trials.edit(state, proposal.edits)
        urdf = edited.urdf if edited is not None else None
        left = defects(urdf.loaded) if isinstance(urdf, Read) else now
        if left < now:
            better.append((left, order, proposal))
    better.sort(key=lambda found: (found[0], found[1]))
    is_read = bool(better) and better[0][0][0] < 0
    causes = list(dict.fromkeys(proposal.cause for _, _, proposal in better))[: _MAX_GRADED if is_read else 1]
    near = [(left, it) for left, _, it in better if it.cause in causes][: _MAX_VALUES if is_read else 1]
    ranked = []
    for left, proposal in near:
        after = trials.apply(state, proposal.edits)
        if after is not None and not after.lost:
            rank = (left[0] < 0, after.score, tuple(-count for count in left), -proposal.way, -proposal.size)
            ranked.append((rank, LoadingStep(proposal, state, after)))
    return max(ranked, key=lambda found: found[0])[1] if ranked else None


def _group(proposals: Iterable[Proposal]) -> list[Proposal]:
    """Return steps with those that correct the same mistake as one; what is added for one link stays apart."""
    groups: dict[tuple[str, str, str], list[Proposal]] = {}
    for proposal in proposals:
        added_for = proposal.link if not any(edit.old for edit in proposal.edits) else ""
        groups.setdefault((proposal.cause, proposal.action, added_for), []).append(proposal)
    return [_as_one(group) for group in groups.values()]


def _as_one(group: list[Proposal]) -> Proposal:
    links = {proposal.link for proposal in group}
    edits = tuple(edit for proposal in group for edit in proposal.edits) if all(p.edits for p in group) else ()
    return group[0]._replace(edits=edits, link=links.pop() if len(links) == 1 else "")


def _alone(together: Edits, before: Edits) -> Edits:
    """Return the edits that were added; none where they change what earlier ones wrote."""
    added = tuple(edit for edit in together if edit not in before)
    return added if len(added) + len(before) == len(together) else ()
