"""The edits that are proposed for criteria: of the robot, of xacro that is loaded as it stands, and of the package."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from typing import TYPE_CHECKING

from grader.edits import Proposal
from grader.errors import MissingElement, NotDecided
from grader.grading.hints.targets import Targets, targets_of
from grader.grading.hints.trials import State
from grader.grading.rubric import Criterion
from grader.robot.edits.candidates import proposals
from grader.robot.edits.draft import Draft
from grader.robot.edits.families import Values
from grader.robot.edits.xml_values import element_proposals
from grader.robot.model import Robot
from grader.robot.selectors import selected_link
from grader.robot.tree import parent_joints
from grader.submission.raw_xacro import raw_xacro_proposals
from grader.submission.urdf import Read
from grader.xml.wanted_element import WantedElement

if TYPE_CHECKING:
    from grader.package.package import Package

_NUMBERS = ("xyz", "size", "radius", "length", "colour")  # arguments of checks
NO_TARGETS = Targets((), ())


class Proposing:
    """Proposes edits by the robot and the package of the rubric's reference solution."""

    def __init__(self, reference: Draft | None, package: "Callable[[], Package | None]") -> None:
        self.reference = reference
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

            wanted = [(criterion.check.name, criterion.arguments) for criterion in criteria]
            found += package_proposals(state.submission.package, self._package(), wanted)
        found += raw_xacro_proposals(state.submission) if about_urdf else ()
        urdf = state.submission.urdf
        draft = Draft.of(urdf.reading) if isinstance(urdf, Read) else None
        if draft is not None:
            reference = self.reference or draft
            for element in _elements(criteria, draft.robot):
                found += element_proposals(draft, reference, element)
            shown, moved = targets_of(_about_robot(criteria), draft.robot, reference.robot)
            anchors = tuple(dict.fromkeys((*shown, *moved)))
            if about_urdf:
                shown = moved = tuple(dict.fromkeys((*anchors, *(link.name for link in reference.robot.links))))
            places = [
                result.outcome.location for result in state.results.values() if result.outcome.location is not None
            ]
            found += proposals(draft, reference, shown, moved, anchors, places, _given(criteria))
        return found


def _elements(criteria: Iterable[Criterion], robot: Robot) -> Iterator[WantedElement]:
    """Yield the elements that criteria look for, with the links that selectors mean."""
    parents = parent_joints(robot)
    for criterion in criteria:
        if criterion.check.name == "element_present":
            with suppress(MissingElement, NotDecided):
                attributes = {
                    key: selected_link(robot, parents, value) if isinstance(value, str) else value
                    for key, value in criterion.arguments.get("attributes", {}).items()
                }
                given = {"path": "", "values": {}, "tolerance": 1e-6, **criterion.arguments, "attributes": attributes}
                yield WantedElement(**given)


def _about_robot(criteria: Iterable[Criterion]) -> Iterator[Criterion]:
    return (criterion for criterion in criteria if criterion.check.subject == "robot")


def _given(criteria: Iterable[Criterion]) -> dict[str, dict[str, Values]]:
    """Return the numbers that the arguments of criteria give for links."""
    given: dict[str, dict[str, Values]] = {}
    for criterion in criteria:
        for name in _NUMBERS:
            value = criterion.arguments.get(name)
            if value is not None and isinstance(link := criterion.arguments.get("link"), str):
                numbers = tuple(value) if isinstance(value, list | tuple) else (value,)
                given.setdefault(link, {})[name] = tuple(map(float, numbers))
    return given
