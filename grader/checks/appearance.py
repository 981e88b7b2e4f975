"""Checks of what a link shows: its shape, its size, its colour."""

from itertools import permutations
from math import cos, radians

from grader.checks.outcome import SLACK, Outcome, failed, judged, measured, passed, place, point, within
from grader.checks.visuals import ShapeName, body, shape_name, visuals
from grader.errors import MissingElement
from grader.robot.kinematics import Configuration
from grader.robot.model import Box, Cylinder, Material, Sphere, Visual
from grader.robot.transforms import IDENTITY_ROTATION, Vector, minus, rotation_from_rpy

Rgb = tuple[float, float, float]
Rgba = tuple[float, float, float, float]

_ALIGNED = cos(radians(1.0))


def shows_box(robot: Configuration, *, link: str, size: Vector, tolerance: float) -> Outcome:
    """A link shows a box whose edges along the link's x, y and z axes have the given lengths in metres."""
    found = [visual for visual in visuals(robot, link) if isinstance(visual.geometry, Box)]
    if not found:
        return _other_shape(robot, link, "box")
    edges = [(_edges(visual), visual) for visual in found]
    actual, visual = min(edges, key=lambda each: _largest_gap(each[0], size))
    turned = actual is None or within(max(map(abs, minus(_sorted(actual), _sorted(size)))), 0.0, tolerance)
    at = (
        place(visual.origin.location, "rpy")
        if turned and any(visual.origin.rpy)
        else place(visual.geometry.location, "size")
    )
    if actual is None:
        return failed(f"the box of {link!r} is turned: its edges are not along the axes of {link!r}", at)
    fine = all(within(a, b, tolerance) for a, b in zip(actual, size, strict=True))
    message = f"{link!r} shows a box {point(actual)} m{'' if fine else f', expected {point(size)} m (x, y, z)'}"
    return judged(fine, message, actual=actual, expected=size, tolerance=tolerance, unit="m", at=at)


def shows_cylinder(robot: Configuration, *, link: str, radius: float, length: float, tolerance: float) -> Outcome:
    """A link shows a cylinder of the given radius and length in metres."""
    found = [visual.geometry for visual in visuals(robot, link) if isinstance(visual.geometry, Cylinder)]
    if not found:
        return _other_shape(robot, link, "cylinder")
    expected = (radius, length)
    best = min(found, key=lambda shape: max(abs(abs(shape.radius) - radius), abs(abs(shape.length) - length)))
    actual = (abs(best.radius), abs(best.length))
    right_radius = within(actual[0], radius, tolerance)
    fine = right_radius and within(actual[1], length, tolerance)
    message = f"{link!r} shows a cylinder of radius {point(actual[:1])} m and length {point(actual[1:])} m"
    at = place(best.location)
    if not fine:
        message += f", expected radius {point((radius,))} m and length {point((length,))} m"
        at = place(best.location, "length" if right_radius else "radius")
    return judged(fine, message, actual=actual, expected=expected, tolerance=tolerance, unit="m", at=at)


def shows_sphere(robot: Configuration, *, link: str, radius: float, tolerance: float) -> Outcome:
    """A link shows a sphere of the given radius in metres."""
    found = [visual.geometry for visual in visuals(robot, link) if isinstance(visual.geometry, Sphere)]
    if not found:
        return _other_shape(robot, link, "sphere")
    best = min(found, key=lambda shape: abs(abs(shape.radius) - radius))
    what = f"the radius of the sphere that {link!r} shows"
    at = place(best.location, "radius")
    return measured(what, actual=abs(best.radius), expected=radius, tolerance=tolerance, unit="m", at=at)


def shows_colour(
    robot: Configuration, *, link: str, colour: Rgb | Rgba, tolerance: float, shape: ShapeName = "any"
) -> Outcome:
    """A link is shown in a colour: red, green, blue and, where a fourth channel is given, opacity, each in 0..1.

    Of several visuals the largest counts, among those of the named shape if there are any.
    """
    visual = body(robot, link, shape)
    if visual.material is None or _is_only_a_picture(visual.material):
        return _colourless(link, visual)
    actual = visual.material.rgba[: len(colour)]
    fine = all(within(a, b, tolerance) for a, b in zip(actual, colour, strict=True))
    message = f"{link!r} is shown in {_channels(colour)} {point(actual)}"
    if not fine:
        message += f", expected {point(colour)}"
    at = place(visual.material.location, "rgba")
    return judged(fine, message, actual=actual, expected=colour, tolerance=tolerance, at=at)


def shows_grey(robot: Configuration, *, link: str, at_least: float, tolerance: float) -> Outcome:
    """A link is shown in a grey (red = green = blue) of at least the given level in 0..1; opacity does not matter."""
    visual = body(robot, link)
    if visual.material is None or _is_only_a_picture(visual.material):
        return _colourless(link, visual)
    actual = visual.material.rgba[:3]
    message = f"{link!r} is shown in rgb {point(actual)}"
    is_grey = within(max(actual), min(actual), tolerance)
    is_light = min(actual) >= at_least - SLACK
    if not is_grey:
        message += ", which is no grey: red, green and blue differ"
    elif not is_light:
        message += f", darker than {at_least:g}"
    at = place(visual.material.location, "rgba")
    return judged(is_grey and is_light, message, actual=actual, expected=at_least, tolerance=tolerance, at=at)


def shows_nothing(robot: Configuration, *, link: str) -> Outcome:
    """A link exists and shows nothing: no visual, or only invisible ones (without a size, or fully transparent)."""
    robot.link(link)
    try:
        shown = [visual for visual in visuals(robot, link) if visual.material is None or visual.material.rgba[3] > 0]
    except MissingElement:
        shown = []
    if not shown:
        return passed(f"{link!r} shows nothing")
    message = f"{link!r} shows {shape_name(shown[0].geometry)}, expected a link without a visual"
    return failed(message, place(shown[0].location))


def _edges(visual: Visual) -> Vector | None:
    """The edge lengths of a box along its link's axes; None where they are not along them."""
    assert isinstance(visual.geometry, Box)
    a, b, c = visual.geometry.size
    size = (abs(a), abs(b), abs(c))  # RViz shows a negative size as a positive one
    rotation = rotation_from_rpy(visual.origin.rpy)
    if rotation is IDENTITY_ROTATION:
        return size
    for order in permutations((0, 1, 2)):
        if all(abs(rotation[3 * row + column]) >= _ALIGNED for row, column in enumerate(order)):
            return (size[order[0]], size[order[1]], size[order[2]])
    return None


def _sorted(size: Vector) -> Vector:
    a, b, c = sorted(size)
    return (a, b, c)


def _largest_gap(actual: Vector | None, expected: Vector) -> float:
    return float("inf") if actual is None else max(abs(a - b) for a, b in zip(actual, expected, strict=True))


def _other_shape(robot: Configuration, link: str, wanted: str) -> Outcome:
    visual = body(robot, link)
    message = f"{link!r} shows {shape_name(visual.geometry)}, expected a {wanted}"
    raise MissingElement(wanted, link, message=message, location=place(visual.geometry.location))


def _is_only_a_picture(material: Material) -> bool:
    # ROS 2 gives a material black where it has a texture and no colour.
    return material.texture != "" and material.rgba == Material("").rgba


def _colourless(link: str, visual: Visual) -> Outcome:
    if visual.material is not None:
        return Outcome("pending", f"{link!r} is shown with a picture on it, which is not opened; a person has to look")
    if visual.material_name:
        message = f"{link!r} has no colour: ROS 2 knows no colour of the material {visual.material_name!r} here"
    else:
        message = f"{link!r} has no material, so RViz shows its default red"
    return failed(
        message, place(visual.location, "name", "material") if visual.material_name else place(visual.location)
    )


def _channels(colour: tuple[float, ...]) -> str:
    return "rgba" if len(colour) == 4 else "rgb"
