"""The sliders of a robot's joints on a page, and the joints that cannot be moved."""

from collections.abc import Iterator
from math import pi
from typing import NamedTuple

from grader.drawing.scene import Scene
from grader.robot.model import Joint
from grader.text import quoted

_HALF_TURN = 180.0
_MAX_SLIDE = 1.0  # metres, of a joint without limits
_MAX_RANGE = 1e5  # radians or metres: larger limits are ignored


class Slider(NamedTuple):
    """The control of a joint: its number in the file, its range and position in degrees or mm; `scale` makes them radians or metres.

    A mimic joint `follows` another one; `note` names that joint, or describes invalid limits. The position of a continuous joint
    `wraps` after a full turn.
    """

    joint: int
    name: str
    low: float
    high: float
    value: float
    unit: str
    scale: float
    note: str
    follows: bool = False
    wraps: bool = False


def sliders_of(scene: Scene) -> Iterator[Slider]:
    """Yield a slider for each joint that turns or slides, and whose child link has a pose in the picture."""
    for number, joint in _moved(scene):
        if joint.type not in ("revolute", "continuous", "prismatic"):
            continue
        slides = joint.type == "prismatic"
        scale = 0.001 if slides else pi / _HALF_TURN
        low, high = _range(joint)
        position = scene.robot.position(joint)
        value = position if isinstance(position, int | float) and abs(position) < _MAX_RANGE else 0.0
        follows = joint.mimic is not None and joint.name not in scene.robot.positions
        least, most, start = (round(end / scale, 6) + 0.0 for end in (min(low, value), max(high, value), value))
        unit, wraps = ("mm" if slides else "\u00b0"), joint.type == "continuous"
        note = _note(joint, value, follows)
        yield Slider(number, joint.name, least, most, start, unit, scale, note, follows, wraps)


def _note(joint: Joint, value: float, follows: bool) -> str:
    """Return which joint moves a mimic joint, or a description of invalid limits; empty for other joints."""
    if follows and joint.mimic is not None:
        return f"follows {joint.mimic.joint}"
    if joint.type == "continuous" or joint.limit is None or joint.limit.lower <= value <= joint.limit.upper:
        return ""
    return "its limits are reversed" if joint.limit.lower > joint.limit.upper else "starts outside its limits"


def _range(joint: Joint) -> tuple[float, float]:
    """Return the range of a joint in radians or metres; without usable limits, half a turn or a metre in both directions."""
    limit = joint.limit
    most = _MAX_SLIDE if joint.type == "prismatic" else pi
    if joint.type == "continuous" or limit is None or not 0.0 < limit.upper - limit.lower < _MAX_RANGE:
        return -most, most
    return limit.lower, limit.upper


def unmoved(scene: Scene) -> Iterator[str]:
    """Yield a sentence for each joint that moves in the robot, but not on the page."""
    for _, joint in _moved(scene):
        if joint.type in ("planar", "floating") and joint.name not in scene.robot.positions:
            yield f"{quoted(joint.name)} is {joint.type}: it stays at 0 here."


def _moved(scene: Scene) -> Iterator[tuple[int, Joint]]:
    """Yield the joints whose child link has a pose in the picture; of joints with the same name, the first."""
    names: set[str] = set()
    for number, joint in enumerate(scene.robot.robot.joints):
        if (
            scene.robot.parent_joints.get(joint.child) is joint
            and joint.child in scene.poses
            and joint.name not in names
        ):
            names.add(joint.name)
            yield number, joint
