"""A robot for checks: reading a value of it that xacro leaves open needs manual grading."""

from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from typing import TypeVar

from grader.robot.model import Joint, Link, Material, Robot, Visual
from grader.robot.unresolved import open_part

_OF_LINK = ("name", "visuals", "collisions", "inertial")
_OF_PLACE = ("name", "parent", "child", "type", "origin", "axis")
_OF_JOINT = (*_OF_PLACE, "limit", "mimic", "dynamics", "safety_controller", "calibration")

Part = TypeVar("Part", Link, Joint, Material)


def guarded(robot: Robot) -> tuple[Robot, tuple[Joint, ...]]:
    """Return a robot in which reading what is open raises NotDecided, or MissingElement for what xacro refuses.

    So does reading its links and joints as a whole, and asking for one that is not there, where it is open which ones
    there are. The second value are its known joints, in the same order.
    """
    joints = tuple(_without(joint, _open(joint, _OF_JOINT)) for joint in robot.joints)
    links = tuple(
        _without(replace(link, visuals=tuple(map(_visual, link.visuals))), _open(link, _OF_LINK))
        for link in robot.links
    )
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


def _open(part: Link | Joint, fields: Iterable[str]) -> Iterable[str]:
    """Yield the fields that are open. What xacro refuses of a name or a joint's place is wrong, and not missing."""
    for name in fields if part.unresolved else ():
        # A visual that is known counts, even if there may be more.
        found = open_part(part.unresolved, name, is_absent=name == "collisions" or not getattr(part, name))
        if found is not None and (found.reason or name not in _OF_PLACE):
            yield name


def _visual(visual: Visual) -> Visual:
    material = visual.material
    return visual if material is None or not material.unresolved else visual._replace(material=_material(material))


def _material(material: Material) -> Material:
    return _without(material, ("rgba", "texture") if any(it.reason for it in material.unresolved.values()) else ())


def _without(part: Part, names: Iterable[str]) -> Part:
    """Return a copy in which some fields are not set, so that reading them raises."""
    unset = [*names]
    copy = replace(part) if unset else part
    for name in unset:
        object.__delattr__(copy, name)
    return copy
