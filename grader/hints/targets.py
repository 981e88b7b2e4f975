"""The links that a criterion depends on: those that its arguments name, and those on the chains between them."""

from collections.abc import Callable, Collection, Iterable, Iterator

from grader.errors import MissingElement, NotDecided
from grader.grading.criterion import Criterion
from grader.robot.kinematics import Configuration
from grader.robot.link_tree import selected_link, texts_in
from grader.robot.model import Robot
from grader.submission.urdf import known_links

_MAX_LINKS = 40


def links_of(criteria: Iterable[Criterion], robot: Robot, reference: Robot) -> list[str] | None:
    """Return the links whose joints and shapes decide criteria, with all above them; None if all may."""
    found: dict[str, None] = {}
    posed = Configuration(robot)
    for criterion in (it for it in criteria if it.check.subject in ("urdf", "robot")):
        given = (selected(posed, name) for name in texts_in(criterion.arguments))
        named = [name for name in given if reference.has_link(name) or robot.has_link(name)]
        if not named:
            return None
        for name in named:
            link: str | None = name
            while link is not None and link not in found:
                found[link] = None
                joint = posed.parent_joints.get(link)
                link = joint.parent if joint is not None else None
    return [*found][:_MAX_LINKS]


def selected(posed: Configuration, name: str) -> str:
    """Return the link that a selector means; a name, or a selector that means no single link, as it is."""
    try:
        return selected_link(posed.robot, posed.parent_joints, name)
    except (MissingElement, NotDecided):
        return name


def own_chain(link: object, robot: Robot, is_known: Callable[[str], bool]) -> Iterator[str]:
    """Yield a link, and those above it that only the student's robot has."""
    parents = {joint.child: joint.parent for joint in robot.joints}
    while isinstance(link, str):
        yield link
        above = parents.pop(link, "")
        link = above if above and not is_known(above) else None


def leaves_others(shared: Collection[str], passing: Iterable[Criterion], lost: Collection[Criterion]) -> bool:
    """Return whether a criterion that passes for one call of a macro still fails for another one."""
    functions = {criterion.check.function for criterion in passing} if shared else set()
    return any(it.check.function in functions and it.arguments.get("link") in shared for it in lost)


def is_another(robot: Robot, wanted: Collection[str]) -> bool:
    """Return whether a robot has few links, and none of the lab's: no correction makes it the lab's robot."""
    return 2 * len(robot.links) < len(wanted) and not known_links(robot, wanted)
