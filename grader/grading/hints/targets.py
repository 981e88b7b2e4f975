"""The links that a criterion depends on: those that its arguments name, and those on the chains between them."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from grader.errors import MissingElement, NotDecided
from grader.grading.rubric import Criterion
from grader.robot.kinematics import Configuration
from grader.robot.model import Robot


def links_of(criteria: Iterable[Criterion], robot: Robot, reference: Robot) -> list[str]:
    """Return the links whose joints and shapes decide these criteria: first those that a criterion names, then those between."""
    found: dict[str, None] = {}
    between: dict[str, None] = {}
    posed = Configuration(robot)
    for criterion in criteria:
        named = [name for name in texts(criterion.arguments) if reference.has_link(name) or robot.has_link(name)]
        found |= dict.fromkeys(named)
        between |= dict.fromkeys(joint_children(posed, named))
    return list(found | between)


def texts(value: Any) -> Iterator[str]:
    """Yield the texts in the arguments of a check."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        yield from texts(list(value.values()))
    elif isinstance(value, list | tuple):
        for item in value:
            yield from texts(item)


def joint_children(posed: Configuration, named: list[str]) -> Iterator[str]:
    """Yield the links whose parent joints are on the chains between the first link and the others."""
    for other in named[1:]:
        try:
            for joint in posed.between(other, named[0]):
                yield joint.child
        except (MissingElement, NotDecided):
            continue
