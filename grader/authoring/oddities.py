"""What looks odd in a reference: it gets full marks anyway, so only its author knows whether it is correct."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from itertools import chain, combinations

from grader.checks.measures.elements import foreign_words
from grader.checks.measures.fact import Fact, Solution, in_title
from grader.checks.outcome import Outcome
from grader.errors import MissingElement, NotDecided
from grader.package.launch.places import is_of_one_machine, one_machine_only
from grader.robot.model import Cylinder, Joint, Link, Mesh
from grader.robot.shapes import is_empty
from grader.robot.transforms import Vector, dot
from grader.text import counted, enumerated

_OPPOSITE = -0.999  # the cosine of the angle between two axes
_IN_SIMULATION = ("gazebo", "ros2_control")
_MAX_NAMED = 4
_MAX_ALIKE = 3  # questions about one check


def oddities(solution: Solution) -> Iterator[str]:
    """Yield a line for each thing that looks odd, which names all links and joints that it is true of."""
    yield from _problems(solution)
    names: dict[str, list[str]] = {}
    for link in solution.links:
        for what in chain.from_iterable(rule(solution, link) for rule in _OF_LINKS):
            names.setdefault(what, []).append(link.name)
    for joint in solution.moving_joints:
        for what in _of_joint(joint):
            names.setdefault(what, []).append(joint.name)
    yield from (f"{enumerated(found, _MAX_NAMED)}: {what}" for what, found in names.items())
    yield from _mirrored_wheels(solution)
    words = foreign_words(solution.reading.root) if solution.reading.root is not None else ()
    yield from (one_machine_only(word) for word in sorted(words) if is_of_one_machine(word))


def _problems(solution: Solution) -> Iterator[str]:
    """Yield each kind of problem that the reader has with the file, once."""
    numbers: dict[str, int] = {}
    for problem in solution.reading.problems:
        numbers[problem.code] = numbers.get(problem.code, 0) + 1
    for problem in solution.reading.problems:
        number = numbers.pop(problem.code, 0)
        if number:
            line = f" (line {problem.location.line})" if problem.location else ""
            more = f", and {counted(number - 1, 'more such problem')}" if number > 1 else ""
            yield f"{problem.code}: {problem.message}{line}{more}"


def _mass(solution: Solution, link: Link) -> Iterator[str]:
    root = solution.reading.root
    if link.inertial is not None:
        if not link.inertial.mass > 0:
            yield f"the mass is {in_title([link.inertial.mass])} kg"
    elif (link.visuals or link.collisions) and any(
        root is not None and root.find(tag) is not None for tag in _IN_SIMULATION
    ):
        yield "no <inertial>, though the link has shapes: a simulator ignores the link or fixes it"


def _colour(solution: Solution, link: Link) -> Iterator[str]:
    del solution
    shapes = [shape for shape in link.visuals if not is_empty(shape.geometry) and not isinstance(shape.geometry, Mesh)]
    if any(visual.material is None for visual in shapes):
        yield "no colour, or one that is not defined, so RViz shows red"


def _collision(solution: Solution, link: Link) -> Iterator[str]:
    if link.visuals and not link.collisions and any(other.collisions for other in solution.links):
        yield "a <visual>, but no <collision>, which other links have"


_OF_LINKS: tuple[Callable[[Solution, Link], Iterator[str]], ...] = (_mass, _colour, _collision)


def _of_joint(joint: Joint) -> Iterator[str]:
    limit = joint.limit
    if limit is None or joint.type not in ("revolute", "prismatic"):
        return
    for name, value in (("effort", limit.effort), ("velocity", limit.velocity)):
        if value == 0:
            yield f"the {name} is 0, so no controller can move the joint"


def _mirrored_wheels(solution: Solution) -> Iterator[str]:
    """Yield pairs of equal wheels on one link with opposite axes: one of them turns backward to drive forward."""
    wheels: list[tuple[Joint, Mapping[str, float], Vector]] = []
    for joint in solution.moving_joints:
        size = _wheel(solution, joint) if joint.type == "continuous" else None
        if size is not None:
            with suppress(MissingElement, NotDecided):  # an axis of length zero, an origin that is too far away
                pose = solution.robot.pose(joint.child, relative_to=joint.parent)
                wheels.append((joint, size, pose.rotate(solution.robot.axis(joint))))
    for (one, size, axis), (other, other_size, other_axis) in combinations(wheels, 2):
        if one.parent == other.parent and size == other_size and dot(axis, other_axis) < _OPPOSITE:
            yield (
                f"{one.child} and {other.child} are equal wheels with opposite axes: "
                "positive velocities of both turn the robot on the spot"
            )


def _wheel(solution: Solution, joint: Joint) -> Mapping[str, float] | None:
    shapes = [visual.geometry for visual in solution.robot.link(joint.child).visuals]
    cylinder = next((shape for shape in shapes if isinstance(shape, Cylinder)), None)
    return {"radius": cylinder.radius, "length": cylinder.length} if cylinder is not None else None


class Doubts:
    """Facts of the reference that it does not pass: of each check the first few, and the names of the others."""

    def __init__(self) -> None:
        self._by_check: dict[str, list[tuple[Fact, Outcome]]] = {}

    def add(self, fact: Fact, outcome: Outcome) -> None:
        """Add a fact that the reference does not pass."""
        self._by_check.setdefault(fact.check, []).append((fact, outcome))

    def lines(self) -> Iterator[str]:
        """Yield a question for each fact, and one for all others of a check."""
        for found in self._by_check.values():
            yield from (f"{outcome.message}: is the solution right?" for _, outcome in found[:_MAX_ALIKE])
            others = [fact.subject for fact, _ in found[_MAX_ALIKE:]]
            if others:
                yield f"the same applies to the {found[0][0].aspect} of {enumerated(others, _MAX_NAMED)}"
