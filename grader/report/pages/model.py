"""The data of a robot for the script of a page: links, joints, shapes and wheels. The script computes all poses."""

from collections.abc import Collection, Mapping, Sequence
from math import isfinite
from typing import Any

from grader.checks.visuals import main_visual
from grader.drawing.picture import Picture
from grader.drawing.scene import Body, Scene, Wheel
from grader.report.inspection import tree
from grader.robot.frames import motion_of, placed_by
from grader.robot.kinematics import Configuration
from grader.robot.model import Box, Cylinder, Joint, Sphere
from grader.robot.transforms import IDENTITY, Transform, dot, unit
from grader.text import printable

Data = Mapping[str, Any]

_SLIDING = ("continuous", "revolute", "prismatic")  # the types with a position that a slider sets
_DIGITS = 9


def picture_data(picture: Picture) -> dict[str, Any]:
    """Return the data of the script: the robot, the reference, and the callouts."""
    scene, reference = picture.scene, picture.reference
    links, others = _indices(scene), _indices(reference) if reference is not None else {}
    lost = [(callout.link, result.criterion.check.about) for callout in picture.callouts for result in callout.results]
    return {
        "robot": _robot(scene, reference, {link for link, about in lost if about.picture == "wheel"}),
        "reference": _robot(reference) if reference is not None else None,
        "same": [links.get(name, -1) for name in others],
        "callouts": [
            {
                "number": callout.number,
                "link": links.get(callout.link, -1),
                "other": others.get(callout.link, -1),
                "point": _numbers(callout.point),
            }
            for callout in picture.callouts
        ],
    }


def _indices(scene: Scene) -> dict[str, int]:
    """Return the number of each link; links with the same name have one number."""
    return {name: number for number, name in enumerate(dict.fromkeys(link.name for link in scene.robot.robot.links))}


def _robot(scene: Scene, expected: Scene | None = None, failed: Collection[str] = ()) -> Data:
    links, robot = _indices(scene), scene.robot
    joints = {id(joint): number for number, joint in enumerate(robot.robot.joints)}
    named = {joint.name: joints[id(joint)] for joint in reversed(robot.robot.joints)}
    parents = robot.parent_joints
    turning = {wheel.link for wheel in scene.wheels}
    return {
        "links": [*map(printable, links)],
        "parent": [joints[id(parents[name])] if name in parents else -1 for name in links],
        "order": [links[name] for _, name, _ in tree(robot)],
        "joints": [_joint(joint, robot, links, named) for joint in robot.robot.joints],
        "frame": links[scene.frame],
        "root": links[scene.root],
        "shapes": [_shape(body, links, is_wheel=body.link in turning) for body in scene.bodies],
        "wheels": [_wheel(wheel, scene, links, expected, failed) for wheel in scene.wheels],
    }


def _joint(joint: Joint, robot: Configuration, links: Mapping[str, int], named: Mapping[str, int]) -> Data:
    """Return a joint; a joint without a slider is fixed at its position."""
    found: dict[str, Any] = {"name": joint.name, "parent": links.get(joint.parent, -1)}
    origin = placed_by(IDENTITY, joint.origin) if joint.origin is not None else None
    if joint.type in _SLIDING:
        found |= {"type": joint.type, "axis": _axis(joint)}
    else:
        motion = motion_of(joint, robot.position(joint))
        origin = origin @ motion if origin is not None and motion is not None else None
    if "mimic" in joint.unresolved:
        found["mimic"] = None
    elif joint.mimic is not None:
        factors = _numbers((joint.mimic.multiplier, joint.mimic.offset))
        found["mimic"] = [named.get(joint.mimic.joint, -1), *factors] if factors else None
    return found | {"origin": _pose(origin)}


def _axis(joint: Joint) -> list[float] | bool | None:
    """Return the unit axis; None if it cannot be read, and False if it has no direction."""
    return _numbers(unit(joint.axis)) or False if joint.axis is not None else None


def _shape(body: Body, links: Mapping[str, int], *, is_wheel: bool) -> list[Any]:
    """Return link, kind, extents, pose, colour, and whether spokes are drawn to show that it turns."""
    match body.shape:
        case Box(size=size):
            kind, extents = "box", size
        case Cylinder(radius=radius, length=length):
            kind, extents = "cylinder", (radius, radius, length)
        case Sphere(radius=radius):
            kind, extents = "sphere", (radius, radius, radius)
    marked = is_wheel and kind != "box"
    return [links[body.link], kind, _numbers(extents), _pose(body.T_link_shape), _numbers(body.rgba), int(marked)]


def _wheel(
    wheel: Wheel, scene: Scene, links: Mapping[str, int], expected: Scene | None, failed: Collection[str]
) -> Data:
    """Return a wheel; `right` is whether its direction failed no criterion and is that of the reference's wheel."""
    joint = scene.robot.joint(wheel.joint)
    others = expected.wheels if expected is not None else ()
    wanted = next((other.travel for other in others if other.link == wheel.link), None)
    is_right = wheel.travel is not None and (wanted is None or dot(wheel.travel, wanted) > 0.7)
    shape = main_visual(scene.robot, wheel.link).geometry
    reach = max(shape.size) / 2 if isinstance(shape, Box) else getattr(shape, "radius", 0.1)
    return {
        "joint": wheel.joint,
        "parent": links.get(joint.parent, -1),
        "centre": _numbers(wheel.centre),
        "travel": _numbers(wheel.travel),
        "right": is_right and wheel.link not in failed,
        "free": wheel.is_free,
        "reach": abs(reach),
    }


def _pose(pose: Transform | None) -> list[float] | None:
    """Return x, y, z, roll, pitch, yaw."""
    return _numbers((*pose.translation, *pose.rpy)) if pose is not None else None


def _numbers(values: Sequence[float] | None) -> list[float] | None:
    """Return numbers rounded to 1e-9, which is enough for a picture, so that JSON is short; None if one is infinite."""
    if values is None or not all(map(isfinite, values)):
        return None
    rounded = (round(value, _DIGITS) + 0.0 for value in values)
    return [int(value) if value == int(value) else value for value in rounded]
