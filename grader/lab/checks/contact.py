"""Checks of contact between two links: one rests on the other, or does not cut into it."""

from itertools import product
from operator import itemgetter

from grader.base.errors import NotDecided
from grader.base.quantities import SLACK, in_millimetres, point, within
from grader.base.source import place
from grader.base.toml_types import NonNegative
from grader.base.transforms import X_AXIS, Z_AXIS
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, difference, judged
from grader.lab.checks.visuals import ShapeName, main_visual
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Box, Mesh
from grader.ros.urdf.overlap import penetration
from grader.ros.urdf.shapes import PlacedShape, UnknownShape
from grader.ros.urdf.visuals import origin_place, placed, visuals

ABOUT = {
    "stands_on": About(
        picture="outline", causes={"edge": "the link reaches beyond the edge of the other one"}
    ),
    "clear_of": About(picture="outline"),
}

_LEFT = (0.0, 1.0, 0.0)
_MAX_PAIRS = 2_000


def stands_on(
    robot: Configuration, *, link: str, on: str, tolerance: NonNegative, shape: ShapeName = "any"
) -> Outcome:
    """The visuals of a link stand on the top of another link's visual: no gap, no overlap, within
    its outline.

    Args:
        link: The link that stands on the other.
        on: The link that it stands on.
        tolerance: How large a gap, an overlap and the part beyond the outline may each be, in
            metres.
        shape: Which of several visuals of the lower link counts: the largest of this shape or,
            without one, of all.
    """
    below = placed(robot, on, main_visual(robot, on, shape), on)
    above = [placed(robot, link, visual, on) for visual in visuals(robot, link)]
    bottom = min(shape.extent(Z_AXIS)[0] for shape in above)
    _, top = below.extent(Z_AXIS)
    beyond = _overhang(above, below)
    message = f"{link!r} stands on the top of {on!r}, at z = {point((top,))} m in {on!r}"
    touches = within(bottom, top, tolerance)
    fine = touches and beyond <= tolerance + SLACK
    if not touches:
        message = (
            f"the bottom of {link!r} is at z = {point((bottom,))} m in {on!r}; it should be at "
            f"the top of {on!r}"
        )
        message += f", {point((top,))} m ({difference(bottom - top, 'too high', 'too low')})"
    elif not fine:
        message = f"{link!r} reaches {in_millimetres(beyond)} beyond the edge of the top of {on!r}"
    at = origin_place(robot, link) if touches else None  # either of the two may be wrong
    outcome = judged(fine, message, bottom, top, tolerance, "m", at=at)
    return outcome._replace(cause="edge") if touches else outcome


def clear_of(robot: Configuration, *, link: str, of: str, tolerance: NonNegative) -> Outcome:
    """No visual of a link cuts into a visual of another by more than the tolerance, in metres;
    touching passes.

    Args:
        link: The link that is examined.
        of: The other link.
        tolerance: How deep the visuals may overlap, in metres.
    """
    own_visuals = [
        (visual, placed(robot, link, visual, of).pose) for visual in visuals(robot, link)
    ]
    others = [placed(robot, of, visual, of) for visual in visuals(robot, of)]
    if len(own_visuals) * len(others) > _MAX_PAIRS:
        raise NotDecided(f"{link!r} and {of!r} show too many shapes to compare", "too many shapes")
    deepest = 0.0
    culprit = own_visuals[0][0]
    unknown = None
    for (visual, pose), (geometry, other) in product(own_visuals, others):
        if isinstance(visual.geometry, Mesh):
            unknown = visual.geometry
        elif isinstance(geometry, Mesh):
            unknown = geometry
        else:
            depth = penetration(visual.geometry, pose, geometry, other, allowed=tolerance)
            deepest, culprit = max((deepest, culprit), (depth, visual), key=itemgetter(0))
    fine = deepest <= tolerance
    if fine and unknown:
        raise UnknownShape(unknown)
    if fine:
        message = f"{link!r} does not overlap {of!r}"
    else:
        message = f"{link!r} overlaps {of!r} by {in_millimetres(deepest)}"
    at = place(culprit.origin.location, "xyz") or place(culprit.location)
    return judged(fine, message, round(deepest, 4), 0.0, tolerance, "m", at=at)


def _overhang(above: list[PlacedShape], below: PlacedShape) -> float:
    """Return how far shapes reach beyond the outline of the one below, in metres.

    The outline is seen from above.
    """
    directions = [X_AXIS, _LEFT]
    if isinstance(below.geometry, Box):  # its own edges: it may be turned about the vertical
        axes = [below.pose.rotate(axis) for axis in (X_AXIS, _LEFT, Z_AXIS)]
        directions = sorted(axes, key=lambda axis: abs(axis[2]))[:2]
    beyond = 0.0
    for direction in directions:
        low, high = below.extent(direction)
        for shape in above:
            lowest, highest = shape.extent(direction)
            beyond = max(beyond, low - lowest, highest - high)
    return beyond
