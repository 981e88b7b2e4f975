"""A robot for checks: reading a value of it that xacro leaves open needs manual grading."""

from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from typing import TypeVar

from grader.robot.model import Joint, Link, Material, Robot, Visual, open_part

_OF_LINK = ("name", "visuals", "collisions", "inertial")
_OF_PLACE = ("name", "parent", "child", "type", "origin", "axis")
_OF_JOINT = (*_OF_PLACE, "limit", "mimic", "dynamics", "safety_controller", "calibration")
_OF_MATERIAL = ("rgba", "texture")

Part = TypeVar("Part", Link, Joint, Material)


def guarded(robot: Robot) -> tuple[Robot, tuple[Joint, ...]]:
    """Return a robot in which reading what is open raises NotDecided, or MissingElement for what xacro refuses.

    So does reading its links and joints as a whole, and asking for one that is not there, where it is open which ones
    there are. The second value are its known joints, in the same order.
    """
    parts: tuple[Link | Joint | Material, ...] = (*robot.links, *robot.joints, *robot.materials)
    if not robot.incomplete and not any(part.unresolved for part in parts):
        return robot, robot.joints
    links, joints = tuple(map(_link, robot.links)), tuple(map(_joint, robot.joints))
    found = replace(robot)
    put = partial(object.__setattr__, found)
    put("links", links)
    put("joints", joints)
    put("_links", {old.name: new for old, new in reversed([*zip(robot.links, links, strict=True)])})
    put("_joints", {old.name: new for old, new in reversed([*zip(robot.joints, joints, strict=True)])})
    put("materials", tuple(map(_material, robot.materials)))
    for name in ("links", "joints") if robot.incomplete else ():
        object.__delattr__(found, name)
    return found, joints


def _link(link: Link) -> Link:
    visuals = tuple(map(_visual, link.visuals))

    def is_open(name: str) -> bool:
        # A visual or inertial that is known counts, even if there may be more.
        is_absent = name == "collisions" or not getattr(link, name)
        part = open_part(link.unresolved, name, is_absent=is_absent)
        return part is not None and (name != "name" or part.reason != "")

    return _without(replace(link, visuals=visuals), filter(is_open, _OF_LINK if link.unresolved else ()))


def _visual(visual: Visual) -> Visual:
    material = visual.material
    return visual if material is None or not material.unresolved else visual._replace(material=_material(material))


def _material(material: Material) -> Material:
    is_open = any(part.reason for part in material.unresolved.values())
    return _without(material, _OF_MATERIAL if is_open else ())


def _joint(joint: Joint) -> Joint:
    def is_open(name: str) -> bool:
        part = open_part(joint.unresolved, name, is_absent=getattr(joint, name) is None)
        # What xacro refuses of a joint's place is read as it is written: it is wrong, and not missing.
        return part is not None and (part.reason != "" or name not in _OF_PLACE)

    return _without(joint, filter(is_open, _OF_JOINT if joint.unresolved else ()))


def _without(part: Part, names: Iterable[str]) -> Part:
    """Return a copy in which some fields are not set, so that reading them raises."""
    unset = [*names]
    copy = replace(part) if unset else part
    for name in unset:
        object.__delattr__(copy, name)
    return copy
