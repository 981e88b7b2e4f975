"""The visuals of a link for the checks that measure them, and the places of origins and axes."""

from collections.abc import Sequence
from itertools import repeat
from math import inf
from typing import Literal

from grader.base.quantities import within
from grader.base.transforms import Vector
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Box, Cylinder, Geometry, Mesh, Sphere, Visual
from grader.ros.urdf.visuals import placed, visuals

MAX_SHAPES = 50  # of one link that are compared with each other
VISIBLE = 0.01  # the smallest alpha of a colour that shows
ShapeName = Literal["any", "box", "cylinder", "sphere"]
_SHAPES = {
    "box": Box,
    "cylinder": Cylinder,
    "sphere": Sphere,
}


def visible(robot: Configuration, link: str) -> list[Visual]:
    """Return the visuals of a link that have a size and are not transparent.

    Raise MissingElement without the link.
    """
    shown = (visual for visual in robot.link(link).visuals if not visual.geometry.is_empty)
    return [visual for visual in shown if not visual.material or visual.material.rgba[3] >= VISIBLE]


def hiding_link(robot: Configuration, link: str) -> str:
    """Return a link one opaque visual of which is around all that another link shows.

    It is empty if there is none, or nothing to hide. Raises MissingElement where a pose is not
    defined.
    """
    hidden = [placed(robot, link, visual, link) for visual in visible(robot, link)]
    for other in robot.robot.links if hidden else ():
        for visual in other.visuals if other.name != link else ():
            is_opaque = not visual.material or visual.material.rgba[3] >= 1.0
            if is_opaque and not visual.geometry.is_empty:
                shape = placed(robot, other.name, visual, link)
                if all(map(shape.is_around, hidden)):
                    return other.name
    return ""


def main_visual(robot: Configuration, link: str, shape: ShapeName = "any") -> Visual:
    """Return the visual that counts for a link.

    This is its only one, else the first mesh, of unknown size, else the largest.

    If the link has visuals of the named shape, only these count.
    """
    shown = visuals(robot, link)
    if len(shown) == 1:
        return shown[0]
    if shape != "any":
        shown = (
            tuple(visual for visual in shown if isinstance(visual.geometry, _SHAPES[shape]))
            or shown
        )
    return max(
        shown,
        key=lambda visual: inf if isinstance(visual.geometry, Mesh) else visual.geometry.volume,
    )


def span(
    robot: Configuration, link: str, relative_to: str, direction: Vector
) -> tuple[float, float]:
    """Return the lowest and highest coordinate of a link's visuals along a unit direction.

    The coordinates are in metres, in a frame.
    """
    shapes = [placed(robot, link, visual, relative_to) for visual in visuals(robot, link)]
    spans = [shape.extent(direction) for shape in shapes]
    lows, highs = zip(*spans, strict=True)
    return min(lows), max(highs)


def shape_name(geometry: Geometry) -> str:
    """Return the name of a shape: a box, a cylinder, a sphere, a mesh."""
    return f"a {type(geometry).__name__.lower()}"


def all_within(actual: Sequence[float], expected: Sequence[float], tolerance: float) -> bool:
    """Return whether each of several numbers is within a tolerance."""
    return all(map(within, actual, expected, repeat(tolerance)))
