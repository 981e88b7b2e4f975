"""What a robot shows and how it moves, whatever its frames, to compare two robots."""

from grader.base.errors import MissingElement, NotDecided
from grader.base.transforms import Vector, unit
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Box, Cylinder, Sphere, Visual
from grader.ros.urdf.shapes import half_width

_AXES: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_SAME = 4e-3  # metres, components of directions and channels of colours: what the lab's tolerances leave open


Behaviour = dict[str, tuple[object, ...]]


def behaviour(submission: Submission) -> Behaviour:
    """Return what a robot shows and how it moves, whatever its frames: by link the extent and colour of shapes, and its axis."""
    urdf = submission.urdf
    if not isinstance(urdf, Read) or urdf.reading.robot is None:
        return {}
    robot = Configuration(urdf.reading.robot)
    found: Behaviour = {}
    for link in urdf.reading.robot.links:
        try:
            pose = robot.pose(link.name, relative_to="base_link")
        except (MissingElement, NotDecided):
            continue
        for index, visual in enumerate(
            shown for shown in link.visuals if not shown.geometry.is_empty
        ):
            shape = visual.geometry
            placed = visual.origin.placed_in(pose)
            if isinstance(shape, Box | Cylinder | Sphere):
                extent = tuple(half_width(shape, placed.unrotate(axis)) for axis in _AXES)
                found[f"{link.name} {index}"] = (*placed.translation, *extent, *_colour(visual))
        joint = robot.parent_joints.get(link.name)
        if joint is not None and joint.type in (
            "continuous",
            "revolute",
            "prismatic",
            "planar",
            "floating",
        ):
            axis = unit(pose.rotate(joint.axis)) if joint.axis is not None else ()
            found[f"joint of {link.name}"] = (joint.type, *(axis or ()))
        if link.name in ("lidar", "base_footprint"):
            found[f"frame of {link.name}"] = pose.translation
    return found


def _colour(visual: Visual) -> tuple[object, ...]:
    rgba = visual.material.rgba if visual.material is not None else (1.0, 0.0, 0.0, 1.0)
    return ("white", rgba[3]) if rgba[0] == rgba[1] == rgba[2] >= 0.71 else rgba


def differences(one: Behaviour, other: Behaviour) -> list[str]:
    """Return what differs between two robots."""
    return [
        name
        for name in dict.fromkeys((*one, *other))
        if not _is_same(one.get(name, ()), other.get(name, ()))
    ]


def _is_same(one: tuple[object, ...], other: tuple[object, ...]) -> bool:
    return len(one) == len(other) and all(
        abs(a - b) <= _SAME if isinstance(a, float) and isinstance(b, float) else a == b
        for a, b in zip(one, other, strict=True)
    )
