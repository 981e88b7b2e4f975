"""The origins and axes that put a link where the reference has it, whatever frames the robot uses."""

from collections.abc import Iterator, Mapping, Sequence
from math import hypot, isfinite

from grader.errors import MissingElement, NotDecided
from grader.robot.edits.families import HalfLength, Values
from grader.robot.frames import placed_by
from grader.robot.kinematics import Configuration
from grader.robot.model import Box, Cylinder, Mesh, Robot, Sphere, Visual
from grader.robot.shapes import bounding_radius
from grader.robot.transforms import Transform, Vector, minus, rotation_from_rpy

_SAME = 2e-3  # metres
_STEP, _ROUND = 5e-4, 2e-4  # metres, radians
_AXES: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_UP = 2  # the component z


class Poses:
    """A robot and the reference, each with its joints at 0; `anchors` are links in whose frames the lab measures."""

    def __init__(
        self,
        robot: Robot,
        reference: Robot,
        anchors: Sequence[str],
        given: Mapping[str, Mapping[str, Values]],
    ) -> None:
        self.robot, self.reference = Configuration(robot), Configuration(reference)
        self._anchors = anchors
        self._given = given

    def given(self, link: str, name: str) -> tuple[Values, ...]:
        """Return the numbers that a criterion expects of a link."""
        values = self._given.get(link, {}).get(name)
        return (values,) if values is not None else ()

    def joint(self, link: str, tag: str, attribute: str) -> Iterator[Values]:
        """Yield the values of a joint's origin or axis with which the link's frame, or what it shows, is right."""
        joint = self.robot.parent_joints.get(link)
        if joint is None or joint.origin is None:
            return
        if tag == "axis":
            yield from self._axis(link)
            return
        for frame in self._frames(link, joint.parent):
            yield from _round(frame.translation if attribute == "xyz" else frame.rpy)
        if attribute == "xyz":
            for centre in self._centres(link, joint.parent):
                for visual in self._visuals(link)[:1]:
                    offset = Transform(rotation_from_rpy(joint.origin.rpy)).rotate(visual.origin.xyz)
                    yield from _round(minus(centre.translation, offset))

    def visual(self, link: str, index: int, attribute: str) -> Iterator[Values]:
        """Yield the values of a visual's origin with which it is where the reference shows it, if that is at its frame."""
        shown = self._visuals(link)
        for pose in self._centres(link, link) if index < len(shown) else ():
            shape = shown[index].geometry
            if isinstance(shape, Mesh) or hypot(*pose.translation) <= bounding_radius(shape) + _SAME:
                yield from _round(pose.translation if attribute == "xyz" else pose.rpy)

    def is_shown_right(self, link: str) -> bool:
        """Return whether what a link shows is where the reference shows it."""
        own = [visual.origin.xyz for visual in self._visuals(link)[:1]]
        return any(
            max(map(abs, minus(pose.translation, place))) < _SAME for pose in self._centres(link, link) for place in own
        )

    def shown_offset(self, link: str) -> Values:
        """Return the position of the reference's visual of a link in its frame."""
        shown = self.reference.robot.link(link).visuals if self.reference.robot.has_link(link) else ()
        return shown[0].origin.xyz if shown else (0.0, 0.0, 0.0)

    def _frames(self, link: str, parent: str) -> Iterator[Transform]:
        """Yield T_parent_link as the reference has it: of a link that it does not have, as one that it carries needs it."""
        carried = [name for name in self._anchors if name != link and self._is_above(link, name)]
        targets = [link] if self.reference.robot.has_link(link) else carried
        for target in targets:
            inner = _pose(self.robot, target, link)
            for anchor in dict.fromkeys((parent, *self._near(link))):
                wanted, own = _pose(self.reference, target, anchor), _pose(self.robot, parent, anchor)
                if wanted and own and inner and not self._is_above(link, anchor):
                    yield own.inverse() @ wanted @ inner.inverse()
                    return

    def _centres(self, link: str, frame: str) -> Iterator[Transform]:
        """Yield the pose of the reference's visual of a link in a frame of the robot: of its parent, or its own."""
        shown = self.reference.robot.link(link).visuals if self.reference.robot.has_link(link) else ()
        apart = [anchor for anchor in self._near(link) if not self._is_above(link, anchor)]
        for anchor in (*apart, *([link] if frame == link else [])):
            wanted, own = _pose(self.reference, link, anchor), _pose(self.robot, frame, anchor)
            if shown and wanted is not None and own is not None:
                yield own.inverse() @ placed_by(wanted, shown[0].origin)
                return

    def _near(self, link: str) -> list[str]:
        """Return the anchors, first those that carry a link: others may be misplaced themselves."""
        return sorted(self._anchors, key=lambda anchor: not self._is_above(anchor, link))

    def _is_above(self, link: str, other: str) -> bool:
        """Return whether a link carries another one, or is it: then it cannot be measured from there."""
        name = other
        for _ in self.robot.parent_joints:
            if name == link or name not in self.robot.parent_joints:
                break
            name = self.robot.parent_joints[name].parent
        return name == link

    def _axis(self, link: str) -> Iterator[Values]:
        """Yield the axis with which the link turns in the reference's direction."""
        other = self.reference.parent_joints.get(link)
        for anchor in self._near(link):
            wanted, own = _pose(self.reference, link, anchor), _pose(self.robot, link, anchor)
            if other is not None and other.axis is not None and wanted is not None and own is not None:
                direction = own.unrotate(wanted.rotate(other.axis))
                yield tuple(round(value, 2) + 0.0 for value in direction)
                return

    def _visuals(self, link: str) -> tuple[Visual, ...]:
        return self.robot.robot.link(link).visuals if self.robot.robot.has_link(link) else ()


def _round(values: Values) -> Iterator[Values]:
    """Yield values in few digits: those that a person writes are round, and others only happen to fit.

    Yield nothing for numbers that are not finite, or too large to be rounded.
    """
    if not all(isfinite(value / _STEP) for value in values):
        return
    short = tuple(round(round(value / _STEP) * _STEP, 4) + 0.0 for value in values)
    if all(abs(value - other) < _ROUND for value, other in zip(values, short, strict=True)):
        yield short


def _pose(robot: Configuration, link: str, relative_to: str) -> Transform | None:
    try:
        return robot.pose(link, relative_to=relative_to)
    except (MissingElement, NotDecided):
        return None


def halves_of_visual(robot: Robot, link: str) -> Iterator[HalfLength]:
    """Yield half the lengths of what a link shows, along the axes of its visual."""
    for visual in robot.link(link).visuals[:1] if robot.has_link(link) else ():
        match visual.geometry:
            case Box(size=size):
                for index, (length, word) in enumerate(zip(size, ("length", "width", "height"), strict=True)):
                    yield HalfLength(length / 2, index, f"the {word} of the box of {link!r}")
            case Cylinder(length=length):
                yield HalfLength(length / 2, 2, f"the length of the cylinder of {link!r}")
            case Sphere(radius=radius):
                yield from (HalfLength(radius, index, f"the diameter of the sphere of {link!r}") for index in range(3))
            case _:
                pass


def halves_of_joint(robot: Robot, link: str) -> Iterator[HalfLength]:
    """Yield half the lengths of what a link shows at its frame, along the axes of its parent; and of a box of the parent."""
    joint = next((joint for joint in robot.joints if joint.child == link), None)
    if joint is None or joint.origin is None or not robot.has_link(link):
        return
    turned = Transform(rotation_from_rpy(joint.origin.rpy))
    for half in halves_of_visual(robot, link):
        axis = turned.rotate(_AXES[half.component])
        component = max(range(3), key=lambda index: abs(axis[index]))
        if abs(robot.link(link).visuals[0].origin.xyz[half.component]) < _SAME:
            yield half._replace(component=component)
    for half in halves_of_visual(robot, joint.parent):
        if half.component < _UP and "box" in half.name:
            yield half
