"""Checks of what a link shows: shapes of a size, in a colour, or nothing."""

from collections.abc import Sequence
from itertools import permutations
from math import cos, radians
from typing import TypeVar

from grader.base.errors import MissingElement, NotDecided
from grader.base.quantities import SLACK, point, within
from grader.base.source import place
from grader.base.toml_types import Colour, NonNegative, Size
from grader.base.transforms import IDENTITY_ROTATION, Vector, rotation_from_rpy
from grader.lab.checks.check import About
from grader.lab.checks.outcome import (
    Outcome,
    difference,
    failed,
    judged,
    measured,
    other_unit,
    passed,
)
from grader.lab.checks.visuals import (
    VISIBLE,
    ShapeName,
    all_within,
    main_visual,
    shape_name,
    visible,
)
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Box, Cylinder, Material, Sphere, Visual
from grader.ros.urdf.visuals import visuals

ABOUT = {
    "shows_box": About(("box", "visual"), picture="outline"),
    "shows_cylinder": About(("cylinder", "visual"), picture="outline"),
    "shows_sphere": About(("sphere", "visual"), picture="outline"),
    "shows_colour": About(("material",)),
    "shows_grey": About(("material",)),
    "shows_nothing": About(("visual",)),
}

_ALIGNED = cos(radians(1.0))

_Shown = TypeVar("_Shown", Box, Cylinder, Sphere)


def shows_box(
    robot: Configuration, *, link: str, size: Size, tolerance: NonNegative, centred: bool = False
) -> Outcome:
    """A link shows a box whose edges along the link's x, y and z axes have the given lengths in
    metres.

    A negative length is wrong in every shape: ROS 2 loads it, and each program shows something
    else.

    Args:
        link: The link that is examined.
        size: The lengths of the edges along the link's x, y and z axes, in metres.
        tolerance: How far each length may be off, in metres.
        centred: Whether the middle of the box must be straight above or below the link's frame, at
            x and y 0.
    """
    edges = [
        (_edges_along_link(visual, box), visual)
        for visual, box in _visuals_of_kind(robot, link, Box)
    ]
    actual, visual = min(
        edges,
        key=lambda pair: (_largest_difference(pair[0], size), centred and _off_centre(pair[1])),
    )
    is_turned = actual is None or all_within(sorted(actual), sorted(size), tolerance)
    is_turned = is_turned and any(visual.origin.rpy)
    if is_turned:
        at = place(visual.origin.location, "rpy")
    else:
        at = place(visual.geometry.location, "size")
    if actual is None:
        return failed(
            f"the box of {link!r} is rotated: its edges should be along the axes of {link!r}", at
        )
    fine = min(actual) >= 0.0 and all_within(actual, size, tolerance)
    message = f"the box of {link!r} is {_size_text(actual)} m"
    if not fine:
        message += f"; it should be {_size_text(size)} m ({other_unit(actual, size) or 'x, y, z'})"
    elif centred and not within(_off_centre(visual), 0.0, tolerance):
        return _off_centre_failure(link, visual, tolerance)
    return judged(fine, message, actual, size, tolerance, "m", at=at)


def _size_text(size: Vector) -> str:
    """Return the edges of a box: 0.6 x 0.4 x 0.2."""
    return " x ".join(point((edge,)) for edge in size)


def shows_cylinder(
    robot: Configuration,
    *,
    link: str,
    radius: NonNegative,
    length: NonNegative,
    tolerance: NonNegative,
) -> Outcome:
    """A link shows a cylinder of the given radius and length in metres.

    Args:
        link: The link that is examined.
        radius: The radius, in metres.
        length: The length, in metres.
        tolerance: How far radius and length may each be off, in metres.
    """
    expected = (radius, length)

    def difference_from_expected(shape: Cylinder) -> float:
        return _largest_difference((shape.radius, shape.length), expected)

    shapes = [shape for _, shape in _visuals_of_kind(robot, link, Cylinder)]
    best = min(shapes, key=difference_from_expected)
    actual = (best.radius, best.length)
    fine = min(actual) >= 0.0 and all_within(actual, expected, tolerance)
    message = (
        f"{link!r} shows a cylinder of radius {point(actual[:1])} m and length "
        f"{point(actual[1:])} m"
    )
    if not fine:
        message += f"; it should have radius {point((radius,))} m and length {point((length,))} m"
        units = other_unit(actual, expected)
        message += f" ({units})" if units else ""
    at = place(best.location, "length" if within(best.radius, radius, tolerance) else "radius")
    return judged(fine, message, actual, expected, tolerance, "m", at=at)


def shows_sphere(
    robot: Configuration, *, link: str, radius: NonNegative, tolerance: NonNegative
) -> Outcome:
    """A link shows a sphere of the given radius in metres.

    Args:
        link: The link that is examined.
        radius: The radius, in metres.
        tolerance: How far the radius may be off, in metres.
    """
    spheres = (sphere for _, sphere in _visuals_of_kind(robot, link, Sphere))
    best = min(spheres, key=lambda sphere: abs(sphere.radius - radius))
    what = f"the radius of the sphere that {link!r} shows is"
    return measured(what, best.radius, radius, tolerance, at=place(best.location, "radius"))


def shows_colour(
    robot: Configuration,
    *,
    link: str,
    colour: Colour,
    tolerance: NonNegative,
    shape: ShapeName = "any",
) -> Outcome:
    """A link is shown in a colour: red, green, blue and, if a fourth channel is given, opacity,
    each from 0 to 1.

    With an opacity below 0.01 it is invisible, which is never correct, unless the fourth channel
    demands it.

    Args:
        link: The link that is examined.
        colour: Red, green, blue and, if it is to be checked, opacity, each from 0 to 1.
        tolerance: How far each channel may be off, on the scale from 0 to 1.
        shape: Which of several visuals counts: the largest of this shape or, without one, the
            largest of all.
    """
    visual = main_visual(robot, link, shape)
    if not visual.material or visual.material.texture:
        return _judge_colourless(link, visual)
    actual = visual.material.rgba[: len(colour)]
    fine = all_within(actual, colour, tolerance)
    message = f"{link!r} is shown in {'rgba' if len(colour) == 4 else 'rgb'} {point(actual)}"
    if not fine:
        message += f"; it should be {point(colour)}"
    is_wanted = len(colour) == 4 and colour[3] < VISIBLE
    invisible = "" if is_wanted else _why_invisible(visual.material)
    return judged(
        fine and not invisible,
        message + invisible,
        actual,
        colour,
        tolerance,
        at=place(visual.material.location, "rgba"),
    )


def shows_grey(
    robot: Configuration, *, link: str, at_least: float, tolerance: NonNegative
) -> Outcome:
    """A link is shown in a grey (red = green = blue) of at least the given level, from 0 to 1, and
    not invisible.

    Below 0.01, the opacity makes it invisible; otherwise opacity is not checked.

    Args:
        link: The link that is examined.
        at_least: The darkest grey that passes, from 0 (black) to 1 (white).
        tolerance: How far red, green and blue may be apart, on the scale from 0 to 1.
    """
    visual = main_visual(robot, link)
    if not visual.material or visual.material.texture:
        return _judge_colourless(link, visual)
    actual = visual.material.rgba[:3]
    message = f"{link!r} is shown in rgb {point(actual)}"
    is_grey = within(max(actual), min(actual), tolerance)
    is_light = min(actual) >= at_least - SLACK
    if not is_grey:
        message += ", which is not grey; red, green and blue should be equal"
    elif not is_light:
        message += f"; each should be at least {at_least:g}"
    invisible = _why_invisible(visual.material)
    at = place(visual.material.location, "rgba")
    return judged(
        is_grey and is_light and not invisible,
        message + invisible,
        actual,
        at_least,
        tolerance,
        at=at,
    )


def shows_nothing(robot: Configuration, *, link: str) -> Outcome:
    """A link exists and shows nothing: no visual, or only invisible ones (without a size, or with
    an alpha below 0.01).

    Args:
        link: The link that is examined.
    """
    shown = visible(robot, link)
    if not shown:
        return passed(f"{link!r} has no visible shape")
    message = f"{link!r} shows {shape_name(shown[0].geometry)}; it should have no visual"
    return failed(message, shown[0].location)


def _visuals_of_kind(
    robot: Configuration, link: str, kind: type[_Shown]
) -> list[tuple[Visual, _Shown]]:
    """Return the visuals of a link that show a shape of a kind.

    Raise MissingElement where there is none.
    """
    pairs = ((visual, visual.geometry) for visual in visuals(robot, link))
    visuals_of_kind = [(visual, shape) for visual, shape in pairs if isinstance(shape, kind)]
    if not visuals_of_kind:
        other = main_visual(robot, link).geometry
        wanted = kind.__name__.lower()
        message = f"{link!r} shows {shape_name(other)}; it should show a {wanted}"
        raise MissingElement(wanted, link, message=message, location=place(other.location))
    return visuals_of_kind


def _edges_along_link(visual: Visual, box: Box) -> Vector | None:
    """Return the edge lengths of a box along its link's axes, in metres.

    It is None where they are not along them.
    """
    size = box.size
    rotation = rotation_from_rpy(visual.origin.rpy)
    if rotation is IDENTITY_ROTATION:
        return size
    for order in permutations((0, 1, 2)):
        if all(abs(rotation[3 * row + column]) >= _ALIGNED for row, column in enumerate(order)):
            return (size[order[0]], size[order[1]], size[order[2]])
    return None


def _off_centre(visual: Visual) -> float:
    return max(map(abs, visual.origin.xyz[:2]))


def _off_centre_failure(link: str, visual: Visual, tolerance: float) -> Outcome:
    actual = visual.origin.xyz[:2]
    off = [
        f"{axis} {difference(value)}"
        for axis, value in zip("xy", actual, strict=True)
        if abs(value) > tolerance
    ]
    message = (
        f"the middle of the box of {link!r} is at x {point(actual[:1])} and y "
        f"{point(actual[1:])} m in its frame"
    )
    message += f"; it should be above the frame's origin, at 0 0 ({', '.join(off)})"
    at = place(visual.origin.location, "xyz") or place(visual.location)
    return judged(False, message, actual, (0.0, 0.0), tolerance, "m", at=at)


def _largest_difference(actual: Sequence[float] | None, expected: Sequence[float]) -> float:
    if actual is None:
        return float("inf")
    return max(abs(a - b) for a, b in zip(actual, expected, strict=True))


def _why_invisible(material: Material) -> str:
    """Return the end of a message on a colour that nobody sees; empty for one that shows."""
    alpha = material.rgba[3]
    if alpha >= VISIBLE:
        return ""
    return f"; its alpha is {alpha:g}, so it is invisible; it should be at least {VISIBLE:g}"


def _judge_colourless(link: str, visual: Visual) -> Outcome:
    if visual.material:
        raise NotDecided(
            f"{link!r} is shown with a texture, which the grader does not open",
            "textures are not opened",
        )
    if visual.has_unreadable_colour:
        at = place(visual.location, None, "material")
        return failed(
            (
                f"{link!r} has no colour: ROS 2 cannot read that of its material "
                f"{visual.material_name!r}"
            ),
            at,
        )
    if visual.material_name:
        message = (
            f"{link!r} has no colour: the material {visual.material_name!r} is not defined here"
        )
        at = place(visual.location, "name", "material")
        return failed(message, at, mistake=f"{link!r} has no colour: its material is not defined")
    return failed(
        f"{link!r} has no material, so RViz shows it in its default colour, red",
        place(visual.location),
    )
