"""What a link shows, for the checks that measure it."""

from typing import Literal

from grader.checks.outcome import place
from grader.errors import MissingElement
from grader.robot.kinematics import Configuration
from grader.robot.model import Box, Cylinder, Geometry, Mesh, Sphere, Visual
from grader.robot.motion import placed_by
from grader.robot.shapes import extent, is_empty, volume
from grader.robot.transforms import Transform, Vector


def visuals(robot: Configuration, link: str) -> tuple[Visual, ...]:
    """The visuals of a link that have a size; raises MissingElement where there is none."""
    shown = robot.shown.get(link)
    if shown is None:
        shown = tuple(each for each in robot.link(link).visuals if not is_empty(each.geometry))
        robot.shown[link] = shown
    if not shown:
        message = f"link {link!r} shows nothing that has a size"
        raise MissingElement("visual", link, message=message, location=place(robot.link(link).location))
    return shown


ShapeName = Literal["any", "box", "cylinder", "sphere"]
_SHAPES: dict[str, type[Box] | type[Cylinder] | type[Sphere]] = {"box": Box, "cylinder": Cylinder, "sphere": Sphere}


def body(robot: Configuration, link: str, shape: ShapeName = "any") -> Visual:
    """The visual that counts for a link: its only one, else the largest; the first mesh where sizes are unknown.

    Where a shape is named and the link shows it, others do not count.
    """
    shown = visuals(robot, link)
    if len(shown) == 1:
        return shown[0]
    if shape != "any":
        shown = tuple(each for each in shown if isinstance(each.geometry, _SHAPES[shape])) or shown
    for visual in shown:
        if isinstance(visual.geometry, Mesh):
            return visual
    return max(shown, key=lambda visual: volume(visual.geometry))


def pose_of(robot: Configuration, link: str, visual: Visual, relative_to: str) -> Transform:
    """T_relative_visual; raises MissingElement where it is not defined."""
    return placed_by(robot.pose(link, relative_to=relative_to), visual.origin)


def span(robot: Configuration, link: str, relative_to: str, direction: Vector) -> tuple[float, float]:
    """The lowest and highest coordinate of all that a link shows, along a unit direction of another link's frame."""
    pose = robot.pose(link, relative_to=relative_to)
    spans = [extent(visual.geometry, placed_by(pose, visual.origin), direction) for visual in visuals(robot, link)]
    lows, highs = zip(*spans, strict=True)
    return min(lows), max(highs)


def shape_name(geometry: Geometry) -> str:
    """A shape in words: a box, a cylinder, a sphere, a mesh."""
    return f"a {type(geometry).__name__.lower()}"
