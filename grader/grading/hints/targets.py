"""The links that a criterion depends on: those that its arguments name, and those on the chains between them."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from grader.errors import MissingElement, NotDecided
from grader.grading.criterion import Criterion
from grader.robot.kinematics import Configuration
from grader.robot.model import Robot
from grader.robot.selectors import selected_link, texts_in

_MAX_LINKS, _MAX_CHAIN = 40, 12


class Targets(NamedTuple):
    """Links that decide criteria: whose shapes count, whose parent joints move them, and that criteria name."""

    shown: tuple[str, ...]
    moved: tuple[str, ...]


def targets_of(criteria: Iterable[Criterion], robot: Robot, reference: Robot) -> Targets:
    """Return the links whose joints and shapes decide criteria."""
    shown: dict[str, None] = {}
    moved: dict[str, None] = {}
    posed = Configuration(robot)
    for criterion in criteria:
        given = (selected(posed, name) for name in texts_in(criterion.arguments))
        named = [name for name in given if reference.has_link(name) or robot.has_link(name)]
        shown |= dict.fromkeys(named)
        moved |= dict.fromkeys(_between(posed, named) if len(named) > 1 else named)
        moved |= dict.fromkeys(moving_child(posed, name) for name in named)
    return Targets(tuple(shown)[:_MAX_LINKS], tuple(moved)[:_MAX_LINKS])


def selected(posed: Configuration, name: str) -> str:
    """Return the link that a selector means; a name, or a selector that means no single link, as it is."""
    try:
        return selected_link(posed.robot, posed.parent_joints, name)
    except (MissingElement, NotDecided):
        return name


def _between(posed: Configuration, named: list[str]) -> Iterator[str]:
    """Yield the links whose parent joints are on the chains between links; all of those that no chain connects."""
    for other in named[1:]:
        try:
            chain = [joint.child for joint in posed.between(other, named[0])]
            yield from chain if len(chain) <= _MAX_CHAIN else (*chain[: _MAX_CHAIN // 2], *chain[-_MAX_CHAIN // 2 :])
        except (MissingElement, NotDecided):
            yield from (named[0], other)


def moving_child(posed: Configuration, link: str) -> str:
    """Return the child of the joint that moves a link; the link itself where none does."""
    try:
        return posed.moving_joint(link).child
    except (MissingElement, NotDecided):
        return link
