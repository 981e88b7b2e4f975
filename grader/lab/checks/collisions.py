"""Checks of the collision shapes of a link."""

from collections.abc import Sequence
from math import inf

from grader.base.errors import MissingElement, NotDecided, RubricError
from grader.base.pairing import most_pairs
from grader.base.quantities import SLACK, in_degrees, in_millimetres, point
from grader.base.source import place
from grader.base.text import counted, quoted_end
from grader.base.toml_types import NonNegative, RadiusAndLength, Size
from grader.base.transforms import Vector
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.lab.checks.visuals import MAX_SHAPES
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Geometry,
    Mesh,
    Origin,
    Sphere,
    Visual,
)
from grader.ros.urdf.shapes import PlacedShape, Shape, ShapeDifference
from grader.ros.urdf.visuals import visuals

ABOUT = {
    "collision_matches_visual": About(("collision",)),
    "collides_as": About(("collision",)),
}

_ZERO = (0.0, 0.0, 0.0)


def collision_matches_visual(robot: Configuration, *, link: str, tolerance: NonNegative) -> Outcome:
    """The collision shapes of a link are the shapes that it shows, each in its place.

    They are compared as solids: turning a cylinder about its axis changes nothing. Shapes without a
    size do not count. A negative size differs from a positive one, because simulators refuse it. A
    mesh is the same if it is the same file at the same scale and pose; whether another file has the
    same shape needs manual grading.

    Args:
        link: The link that is examined.
        tolerance: How far a centre, a size or a point of the surface may be off, in metres.
    """
    shown = visuals(robot, link)
    solid = _solid_collisions(robot, link, "the shapes that it shows")
    if max(len(shown), len(solid)) > MAX_SHAPES:
        raise NotDecided(
            f"{link!r} has more than {MAX_SHAPES} shapes", "a link has very many shapes"
        )
    fitting: list[list[int]] = []  # for each visual, the collisions that may be its own
    for visual in shown:
        fitting.append([])
        for index, other in enumerate(solid):
            if _fits(_mismatch(visual, other, tolerance), tolerance):
                fitting[-1].append(index)
    partners = most_pairs(fitting)
    lonely = [visual for index, visual in enumerate(shown) if index not in partners.values()]
    others = [collision for index, collision in enumerate(solid) if index not in partners]
    if not lonely and not others:
        return passed(f"{link!r} has {counted(len(solid), 'collision shape')}, as shown")
    if not lonely:
        message = (
            f"{link!r} has a collision shape that it does not show: {_describe_shape(others[0])}"
        )
        return failed(message, others[0].location)
    if not others:
        return failed(
            f"no collision shape of {link!r} is {_describe_shape(lonely[0])}, as shown",
            lonely[0].location,
        )
    return _judge_unmatched(link, lonely, others, tolerance)


def collides_as(
    robot: Configuration,
    *,
    link: str,
    tolerance: NonNegative,
    box: Size | None = None,
    cylinder: RadiusAndLength | None = None,
    capsule: RadiusAndLength | None = None,
    sphere: NonNegative | None = None,
    xyz: Vector | None = None,
    rpy: Vector | None = None,
    relative_to: str = "",
    only: bool = False,
) -> Outcome:
    """A link collides as a box, a cylinder, a capsule or a sphere of the given size in the given
    place.

    Exactly one of `box`, `cylinder`, `capsule` and `sphere` is given. They are compared as solids:
    turning a cylinder about its axis changes nothing. Shapes without a size do not count.

    Args:
        link: The link that is examined.
        tolerance: How far the centre, a size or a point of the surface may be off, in metres.
        box: The lengths of the edges along the box's own x, y and z axes, in metres.
        cylinder: The radius and the length, in metres.
        capsule: The radius, and the length without the half spheres at its ends, in metres.
        sphere: The radius, in metres.
        xyz: The centre, in metres.
        rpy: The orientation: roll, pitch and yaw about fixed axes, in radians.
        relative_to: The link in whose frame the place is given, by default the link itself.
        only: Whether the link has no other collision shape.
    """
    wanted = _wanted_shape(box, cylinder, capsule, sphere)
    what = shape_text(wanted) + _place_text(xyz, rpy, relative_to)
    origin = Origin(xyz or _ZERO, rpy or _ZERO)
    pose = origin.placed_in(robot.pose(relative_to or link, relative_to=link))
    placed = PlacedShape(wanted, pose)

    def off(collision: Collision) -> ShapeDifference | None:
        other = PlacedShape(collision.geometry, collision.origin.placed_in())
        mismatch = placed.mismatch(other, tolerance + SLACK, turned=rpy is not None)
        if not mismatch or xyz is not None:
            return mismatch
        return mismatch._replace(apart=0.0)

    solid = _solid_collisions(robot, link, what)
    fitting = next((one for one in solid if _fits(off(one), tolerance)), None)
    if not fitting:
        nearest = min(solid, key=lambda one: _rank_mismatch(off(one)))
        return _fail_with_nearest(
            f"no collision shape of {link!r} is {what}", nearest, off(nearest), tolerance
        )
    other = next((one for one in solid if one is not fitting), None)
    if only and other:
        message = (
            f"{link!r} has another collision shape, {_describe_shape(other)}; it should have "
            f"only {what}"
        )
        return failed(message, other.location)
    return passed(f"{link!r} collides as {what}")


def _wanted_shape(
    box: Size | None,
    cylinder: RadiusAndLength | None,
    capsule: RadiusAndLength | None,
    sphere: NonNegative | None,
) -> Shape:
    """Return the only shape that is given; raise RubricError for none or several."""
    shapes: list[Shape] = []
    if box is not None:
        shapes.append(Box(box))
    if cylinder is not None:
        shapes.append(Cylinder(*cylinder))
    if capsule is not None:
        shapes.append(Capsule(*capsule))
    if sphere is not None:
        shapes.append(Sphere(sphere))
    if len(shapes) != 1:
        raise RubricError(("collides_as takes exactly one of box, cylinder, capsule and sphere",))
    return shapes[0]


def _place_text(xyz: Vector | None, rpy: Vector | None, relative_to: str) -> str:
    """Return the wanted place of a shape in words, empty if none is given."""
    text = ""
    if xyz:
        text += f" at {point(xyz)} m"
    if rpy and any(rpy):
        text += f" with rpy = {point(rpy)} (radians)"
    if relative_to:
        text += f" in {relative_to!r}"
    return text


def _solid_collisions(robot: Configuration, link: str, expected: str) -> Sequence[Collision]:
    """Return the collision shapes of a link that have a size.

    Raise MissingElement if there is none.
    """
    solid = tuple(
        collision for collision in robot.link(link).collisions if not collision.geometry.is_empty
    )
    if not solid:
        message = f"link {link!r} has no collision shape with a size; it should have {expected}"
        raise MissingElement(
            "collision", link, message=message, location=place(robot.link(link).location)
        )
    return solid


def _fits(off: ShapeDifference | None, tolerance: float) -> bool:
    return off is not None and off.largest <= tolerance + SLACK


def _mismatch(visual: Visual, collision: Collision, tolerance: float) -> ShapeDifference | None:
    """Return how far two shapes differ.

    It is None for shapes of different kinds, and for different meshes.
    """
    shown = PlacedShape(visual.geometry, visual.origin.placed_in())
    solid = PlacedShape(collision.geometry, collision.origin.placed_in())
    return shown.mismatch(solid, tolerance + SLACK)


def _refuse_other_meshes(link: str, lonely: Sequence[Visual], others: Sequence[Collision]) -> None:
    """Raise NotDecided for a collision mesh that is not shown, if all shapes are meshes."""
    shown_meshes = [visual.geometry for visual in lonely if isinstance(visual.geometry, Mesh)]
    meshes = [collision.geometry for collision in others if isinstance(collision.geometry, Mesh)]
    if len(meshes) < len(others) or len(shown_meshes) < len(lonely):
        return
    files = {mesh.filename for mesh in shown_meshes}
    for mesh in meshes:
        if mesh.filename not in files:
            cause = "mesh files are not opened"
            message = (
                f"whether the collision mesh {quoted_end(mesh.filename)} of {link!r} has the "
                f"shape that is shown cannot be determined: {cause}"
            )
            raise NotDecided(message, cause)


def _judge_unmatched(
    link: str, lonely: Sequence[Visual], others: Sequence[Collision], tolerance: float
) -> Outcome:
    """Return the outcome for shapes without a counterpart.

    These are visuals without a collision shape, and collision shapes without a visual.
    """
    _refuse_other_meshes(link, lonely, others)
    pairs = [
        (_mismatch(visual, other, tolerance), visual, other)
        for visual in lonely
        for other in others
    ]
    off, visual, nearest = min(pairs, key=lambda pair: _rank_mismatch(pair[0]))
    message = f"no collision shape of {link!r} is {_describe_shape(visual)}, as shown"
    return _fail_with_nearest(message, nearest, off, tolerance)


def _rank_mismatch(off: ShapeDifference | None) -> tuple[bool, float]:
    """Return the order of pairs: those of one kind first, then by the difference."""
    return off is None, 0.0 if off is None else min(off.apart + off.size + min(off.turn, 1e9), inf)


def _fail_with_nearest(
    message: str, nearest: Collision, off: ShapeDifference | None, tolerance: float
) -> Outcome:
    """Return a failure that says how the nearest shape differs from the one that should be.

    Its location is the place to look at.
    """
    message += f"; the nearest is {_describe_shape(nearest)}"
    if not off:
        return failed(message, nearest.geometry.location or nearest.location)
    differences = [
        (f"{in_millimetres(off.apart)} away", off.apart, nearest.origin.location, "xyz"),
        (f"of a size {in_millimetres(off.size)} off", off.size, nearest.geometry.location, None),
        (f"rotated by {in_degrees(off.angle)}", off.turn, nearest.origin.location, "rpy"),
    ]
    wrong = [row for row in differences if not row[1] <= tolerance + SLACK]
    text = " and ".join(text for text, *_ in wrong)
    return failed(f"{message} ({text})", place(wrong[0][2], wrong[0][3]) or nearest.location)


def _describe_shape(element: Visual | Collision) -> str:
    """Return a shape with its sizes, and its place in the link."""
    return f"{shape_text(element.geometry)} at {point(element.origin.xyz)} m"


def shape_text(geometry: Geometry) -> str:
    """Return a shape with its sizes in metres."""
    match geometry:
        case Box(size=size):
            return f"a box {point(size)} m"
        case Cylinder(radius=radius, length=length):
            return f"a cylinder of radius {point((radius,))} m and length {point((length,))} m"
        case Capsule(radius=radius, length=length):
            return f"a capsule of radius {point((radius,))} m and length {point((length,))} m"
        case Sphere(radius=radius):
            return f"a sphere of radius {point((radius,))} m"
        case mesh:
            scaled = "" if mesh.scale == Mesh("").scale else f" scaled by {point(mesh.scale)}"
            return f"the mesh {quoted_end(mesh.filename)}{scaled}"
