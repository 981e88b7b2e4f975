"""The links that a criterion depends on: those that its arguments name, and those on the chains between them."""

from collections.abc import Iterable, Iterator

from grader.errors import MissingElement, NotDecided
from grader.grading.criterion import Criterion
from grader.robot.kinematics import Configuration
from grader.robot.model import Robot
from grader.robot.selectors import selected_link, texts_in

_MAX_LINKS, _MAX_CHAIN = 40, 12


def links_of(criteria: Iterable[Criterion], robot: Robot, reference: Robot) -> list[str] | None:
    """Return the links whose joints and shapes decide criteria; None if all may."""
    found: dict[str, None] = {}
    posed = Configuration(robot)
    for criterion in (it for it in criteria if it.check.subject in ("urdf", "robot")):
        given = (selected(posed, name) for name in texts_in(criterion.arguments))
        named = [name for name in given if reference.has_link(name) or robot.has_link(name)]
        if not named:
            return None
        found |= dict.fromkeys(named)
        found |= dict.fromkeys(_between(posed, named) if len(named) > 1 else named)
        found |= dict.fromkeys(moving_child(posed, name) for name in named)
    return [*found][:_MAX_LINKS]


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
