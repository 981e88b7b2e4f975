"""Repair a URDF step by step until ROS 2 loads it: each step makes ROS 2 read on, or reject or drop less."""

from collections.abc import Iterable, Iterator
from decimal import Decimal
from itertools import islice
from typing import NamedTuple

from grader.edits import Proposal
from grader.grading.hints.trials import Edits, State, Trials, loses_nothing
from grader.robot.catalogue import COLOUR_COUNT, MISSPELT
from grader.robot.edits.draft import Draft
from grader.robot.model import Robot
from grader.robot.reader import Reading
from grader.robot.repairs.pieces import remaining
from grader.robot.repairs.repairs import repairable, repairs_of
from grader.robot.repairs.site import Robots
from grader.robot.repairs.texts import fallback_proposals, lost_brackets, text_proposals
from grader.submission.urdf import Read
from grader.xml.catalogue import IGNORED_REST, NOT_UTF8, SEVERAL_ROOTS

_MAX_STEPS = 20  # of one chain
_MAX_GRADED = 4  # edits of one step that are graded, to choose the best
_MAX_FALLBACKS = 60
_SILENT = (MISSPELT, COLOUR_COUNT, IGNORED_REST, SEVERAL_ROOTS)  # ROS 2 loads the file, without what was meant

Defects = tuple[int, ...]


class Step(NamedTuple):
    """An edit of a state that brings ROS 2 further, and the state after it."""

    proposal: Proposal
    before: State
    after: State


def defects(reading: Reading) -> Defects:
    """Return how much ROS 2 does not read, rejects, leaves unconnected, and drops or ignores: less is better."""
    effects = [problem.kind.effect for problem in reading.problems]
    unread = remaining(reading.source.text) if reading.root is None else -1
    silent = sum(problem.kind in _SILENT for problem in reading.problems) + len(lost_brackets(reading.source.text))
    rejected = effects.count("rejects") or int(reading.verdict == "rejected")
    return unread, rejected, _loose(reading.robot), effects.count("drops") + silent


def _loose(robot: Robot | None) -> int:
    """Return how many links have no parent joint."""
    return len(robot.links) - len({joint.child for joint in robot.joints}) if robot is not None else 0


def steps(trials: Trials, start: State, reference: Draft | None) -> Iterator[Step]:
    """Yield the steps from a state towards a URDF of which ROS 2 drops nothing. Raises OutOfBudget."""
    state = start
    for _ in range(_MAX_STEPS):
        reading = _reading(state)
        if reading is None or (reading.verdict == "clean" and not defects(reading)[-1]):
            return
        step = next(filter(None, (_best(trials, state, group) for group in _groups(reading, reference))), None)
        if step is None:
            return
        yield step
        state = step.after


def _reading(state: State) -> Reading | None:
    """Return what ROS 2 loads; None of xacro that is loaded without xacro: its text is not what is wrong."""
    urdf = state.submission.urdf
    if not isinstance(urdf, Read) or (urdf.as_it_stands is not None and b"xacro:" in urdf.data):
        return None
    return urdf.loaded


def _groups(reading: Reading, reference: Draft | None) -> Iterator[Iterable[Proposal]]:
    """Yield edits that may be the next step, one group for each problem."""
    yield text_proposals(reading, reference)
    draft = Draft.of(reading)
    if draft is not None:
        robots = Robots(draft, reference or draft, reading.problems)
        for problem in repairable(reading.problems):
            yield repairs_of(robots, problem)
    elif reading.source.text.strip() and not any(problem.kind is NOT_UTF8 for problem in reading.problems):
        yield islice(fallback_proposals(reading.source), _MAX_FALLBACKS)


def _best(trials: Trials, state: State, proposals: Iterable[Proposal]) -> Step | None:
    """Return the edit that brings ROS 2 furthest; of several that make it load the file, the one with the best score."""
    before = _reading(state)
    assert before is not None
    now = defects(before)
    better: list[tuple[Defects, int, Proposal]] = []
    for order, proposal in enumerate(proposals):
        edited = trials.edited(state, proposal.edits)
        urdf = edited.urdf if edited is not None else None
        left = defects(urdf.loaded) if isinstance(urdf, Read) else now
        if left < now:
            better.append((left, order, proposal))
    best: tuple[tuple[bool, Decimal, Defects], Step] | None = None
    better.sort(key=lambda found: (found[0][0], found[1]))
    is_read = bool(better) and better[0][0][0] < 0
    for left, _, proposal in better[: _MAX_GRADED if is_read else 1]:
        after = trials.applied(state, proposal.edits)
        if after is not None and loses_nothing(state.results, after.results):
            rank = (left[0] < 0, _score(after), tuple(-count for count in left))
            if best is None or rank > best[0]:
                best = rank, Step(proposal, state, after)
    return best[1] if best is not None else None


def _score(state: State) -> Decimal:
    return sum((result.points for result in state.results.values()), Decimal(0))


def grouped(proposals: Iterable[Proposal]) -> list[Proposal]:
    """Return steps with those that do the same as one."""
    groups: dict[tuple[str, str], list[Proposal]] = {}
    for proposal in proposals:
        groups.setdefault((proposal.cause, proposal.action), []).append(proposal)
    return [_together(group) for group in groups.values()]


def _together(group: list[Proposal]) -> Proposal:
    owners, links = {proposal.of for proposal in group}, {proposal.link for proposal in group}
    edits = tuple(edit for proposal in group for edit in proposal.edits) if all(p.edits for p in group) else ()
    return group[0]._replace(
        edits=edits,
        of=owners.pop() if len(owners) == 1 else "",
        link=links.pop() if len(links) == 1 else "",
    )


def chained(proposals: list[Proposal], edits: Edits) -> Proposal:
    """Return several steps as one proposal."""
    causes = dict.fromkeys(proposal.cause for proposal in proposals)
    actions = dict.fromkeys(proposal.said for proposal in proposals)
    links = {proposal.link for proposal in proposals}
    return Proposal(edits, " and ".join(causes), " and ".join(actions), "", links.pop() if len(links) == 1 else "")
