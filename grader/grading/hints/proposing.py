"""The edits that are proposed for criteria: of the robot, of xacro that is loaded as it stands, and of the package."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from grader.edits import Proposal
from grader.errors import MissingElement, NotDecided
from grader.grading.criterion import Criterion
from grader.grading.hints.targets import Targets, moving_child, targets_of
from grader.grading.hints.trials import State, Trials
from grader.grading.subjects import named_links
from grader.robot.edits.bodies import body_proposals
from grader.robot.edits.candidates import proposals
from grader.robot.edits.draft import Draft
from grader.robot.edits.families import Values
from grader.robot.edits.xml_values import element_proposals
from grader.robot.kinematics import Configuration
from grader.robot.model import Robot
from grader.submission.raw_xacro import raw_xacro_proposals
from grader.submission.urdf import Read
from grader.xml.wanted_element import WantedElement

if TYPE_CHECKING:
    from grader.package.package import Package

_NUMBERS = ("xyz", "size", "radius", "length", "colour")  # arguments of checks
# Those about the joint that moves a link.
_JOINT_NUMBERS = ("lower", "upper", "effort", "velocity", "multiplier", "offset", "damping", "friction")
_SHAPE_CHECKS = ("shows_box", "shows_cylinder", "shows_sphere", "centre_at")
_BODY_CHECKS = ("mass_is", "inertia_plausible", "collision_matches_visual", "collides_as")
NO_TARGETS = Targets((), ())


class Proposing:
    """Proposes edits by the robot and the package of the rubric's reference solution."""

    def __init__(self, reference: Draft | None, package: "Callable[[], Package | None]", trials: Trials) -> None:
        self.reference, self._trials = reference, trials
        self._package = package

    def targets(self, state: State, criterion: Criterion) -> Targets:
        """Return the links on which a criterion depends."""
        urdf = state.submission.urdf
        robot = urdf.reading.robot if isinstance(urdf, Read) else None
        if robot is None:
            return NO_TARGETS
        return targets_of([criterion], robot, self.reference.robot if self.reference else robot)

    def proposals(self, state: State, criteria: list[Criterion]) -> list[Proposal]:
        """Return edits of a state for criteria."""
        about_urdf = any(criterion.check.subject == "urdf" for criterion in criteria)
        found: list[Proposal] = []
        if any(criterion.check.subject not in ("urdf", "robot") for criterion in criteria):
            from grader.package.edits.candidates import package_proposals  # late: a robot on its own needs none

            wanted = [(criterion.check.looks_at, criterion.arguments) for criterion in criteria]
            found += package_proposals(state.submission.package, self._package(), wanted, self._trials.isolated)
        with self._trials.isolated():
            found += raw_xacro_proposals(state.submission) if about_urdf else ()
        with self._trials.isolated():
            found += self._of_robot(state, criteria, about_urdf=about_urdf)
        return found

    def _of_robot(self, state: State, criteria: list[Criterion], *, about_urdf: bool) -> Iterator[Proposal]:
        urdf = state.submission.urdf
        draft = Draft.of(urdf.reading) if isinstance(urdf, Read) else None
        if draft is None:
            return
        criteria = [*_with_links(criteria, Configuration(draft.robot))]
        for link, mass in _bodies(criteria).items():
            yield from body_proposals(draft, link, mass)
        reference = self.reference or draft
        for element in _elements(criteria):
            yield from element_proposals(draft, reference, element)
        shown, moved = targets_of(_about_robot(criteria), draft.robot, reference.robot)
        anchors = tuple(dict.fromkeys((*shown, *moved)))
        if about_urdf:
            shown = moved = tuple(dict.fromkeys((*anchors, *(link.name for link in reference.robot.links))))
        places = [result.outcome.location for result in state.results.values() if result.outcome.location is not None]
        yield from proposals(draft, reference, shown, moved, anchors, places, _given(criteria, draft.robot))


def _bodies(criteria: Iterable[Criterion]) -> dict[str, float | None]:
    """Return the links whose mass, inertia or collision is examined, with the expected mass if a criterion gives it.

    Not those with another shape than a criterion expects: an inertia or a collision of the wrong shape would be a wrong hint.
    """
    found: dict[str, float | None] = {}
    misshapen = {criterion.arguments["link"] for criterion in criteria if criterion.check.name in _SHAPE_CHECKS}
    for criterion in criteria:
        if criterion.check.name in _BODY_CHECKS and criterion.arguments["link"] not in misshapen:
            link, mass = criterion.arguments["link"], criterion.arguments.get("mass")
            found[link] = mass if mass is not None else found.get(link)
    return found


def _elements(criteria: Iterable[Criterion]) -> Iterator[WantedElement]:
    """Yield the elements that criteria look for."""
    for criterion in criteria:
        if criterion.check.name == "element_present":
            yield WantedElement(
                **{"attributes": {}, "path": "", "values": {}, "tolerance": 1e-6, **criterion.arguments}
            )


def _with_links(criteria: Iterable[Criterion], posed: Configuration) -> Iterator[Criterion]:
    """Yield criteria with the names of the links that selectors mean, where each means one."""
    for criterion in criteria:
        named = criterion
        if criterion.has_selectors:
            with suppress(MissingElement, NotDecided):
                named = replace(criterion, arguments=named_links(criterion.arguments, posed))
        yield named


def _about_robot(criteria: Iterable[Criterion]) -> Iterator[Criterion]:
    return (criterion for criterion in criteria if criterion.check.subject == "robot")


def _given(criteria: Iterable[Criterion], robot: Robot) -> dict[str, dict[str, Values]]:
    """Return the numbers that the arguments of criteria give for links, or for the links below the joints that move them."""
    given: dict[str, dict[str, Values]] = {}
    posed = Configuration(robot)
    for criterion in criteria:
        link = criterion.arguments.get("link")
        if not isinstance(link, str) or criterion.at:  # numbers of a posed robot are not those in the file
            continue
        for name in (*_NUMBERS, *_JOINT_NUMBERS):
            value = criterion.arguments.get(name)
            if value is not None:
                numbers = tuple(value) if isinstance(value, list | tuple) else (value,)
                of = moving_child(posed, link) if name in _JOINT_NUMBERS else link
                given.setdefault(of, {})[name] = tuple(map(float, numbers))
    return given
