"""Checks of heights: the lowest points of links, and a footprint level with them."""

from collections.abc import Callable, Iterator, Sequence
from math import inf

from grader.base.errors import MissingElement
from grader.base.quantities import SLACK, in_degrees, in_millimetres, point, within
from grader.base.source import LazyLocation, place
from grader.base.text import enumerated
from grader.base.toml_types import NonNegative
from grader.base.transforms import IDENTITY_ROTATION, Z_AXIS, Transform, turn_between
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, difference, judged, measured
from grader.lab.checks.visuals import ShapeName, main_visual, shape_name, span
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.shapes import UnknownShape
from grader.ros.urdf.visuals import origin_place, placed

ABOUT = {
    "bottom_at_height": About(("visual/origin",), picture="outline"),
    "bottoms_at_height": About(picture="outline"),
    "under_the_base": About(picture="frame"),
    "above_others": About(picture="outline"),
}
_Heights = dict[str, float]  # of links


def bottom_at_height(
    robot: Configuration,
    *,
    link: str,
    relative_to: str,
    height: float,
    tolerance: NonNegative,
    shape: ShapeName = "any",
) -> Outcome:
    """The lowest point of a link's visuals is at a height (z) in another link's frame, in metres.

    Args:
        link: The link that is examined.
        relative_to: The link in whose frame the height is given.
        height: The height (z), in metres.
        tolerance: How far the height may be off, in metres.
        shape: If given and the link shows it, only the largest visual of this shape counts.
    """
    visual = main_visual(robot, link, shape)
    if shape == "any" or shape_name(visual.geometry) != f"a {shape}":
        lowest, _ = span(robot, link, relative_to, Z_AXIS)
    else:
        lowest, _ = placed(robot, link, visual, relative_to).extent(Z_AXIS)
    what = f"the bottom of {link!r} in the frame {relative_to!r} is at z ="
    at = place(visual.origin.location, "xyz") or visual.location
    return measured(what, lowest, height, tolerance, sides=("too high", "too low"), at=at)


def bottoms_at_height(
    robot: Configuration,
    *,
    links: list[str],
    relative_to: str,
    height: float,
    tolerance: NonNegative,
) -> Outcome:
    """The lowest points of several links are at the same height (z) in another link's frame, in
    metres.

    Args:
        links: The links that are examined.
        relative_to: The link in whose frame the height is given.
        height: The height (z), in metres.
        tolerance: How far each height may be off, in metres.
    """
    robot.link(relative_to)
    lowest, missing = _measure_each(links, lambda link: span(robot, link, relative_to, Z_AXIS)[0])
    wrong = {link: value for link, value in lowest.items() if not within(value, height, tolerance)}
    actual = tuple(lowest.values())
    if not wrong and missing:
        raise missing
    names = enumerated(map(repr, lowest))
    message = f"the bottoms of {names} are at z = {point(actual)} m in {relative_to!r}"
    if wrong:
        off = [
            f"{link!r} {difference(value - height, 'too high', 'too low')}"
            for link, value in wrong.items()
        ]
        message += f"; they should be at {height:g} m ({', '.join(off)})"
    at = _common_place(robot, wrong, lowest, relative_to, tolerance) if wrong else None
    return judged(not wrong, message, actual, height, tolerance, "m", at=at)


def under_the_base(
    robot: Configuration,
    *,
    link: str,
    base: str,
    wheels: list[str],
    tolerance: NonNegative,
    angle: NonNegative,
) -> Outcome:
    """A frame has the x, y and orientation of a base's frame and is level with the lowest points of
    the wheels.

    Args:
        link: The link whose frame is examined, such as base_footprint.
        base: The link of the base.
        wheels: The links of the wheels.
        tolerance: How far x, y and the height may each be off, in metres.
        angle: How far the orientation may be off, in degrees.
    """
    T_link_base = robot.pose(base, relative_to=link)
    x, y, _ = T_link_base.translation
    lowest, missing = _measure_each(wheels, lambda wheel: span(robot, wheel, link, Z_AXIS)[0])
    off = {wheel: value for wheel, value in lowest.items() if not within(value, 0.0, tolerance)}
    faults = list(_find_pose_faults(base, T_link_base, tolerance, angle))
    for wheel, value in off.items():
        height = difference(value, "above", "below")
        faults.append(f"the lowest point of {wheel!r} is {height} it")
    if missing and not faults:
        raise missing
    verb = "is"
    explanation = ""
    if faults:
        verb = "should be"
        explanation = f": {'; '.join(faults)}"
    message = (
        f"the frame {link!r} {verb} under {base!r}, "
        f"level with the bottoms of the wheels{explanation}"
    )
    actual = (x, y, *lowest.values())
    at = origin_place(robot, base)
    # The frame is where it should be, and some wheel is not.
    if len(off) == len(faults) < len(lowest):
        at = origin_place(robot, next(iter(off), base))
    return judged(not faults, message, actual, 0.0, tolerance, "m", at=at)


def _find_pose_faults(
    base: str, T_link_base: Transform, tolerance: float, angle: float
) -> Iterator[str]:
    """Yield what is wrong with the pose of a base in a frame that should be below it."""
    x, y, _ = T_link_base.translation
    if not (within(x, 0.0, tolerance) and within(y, 0.0, tolerance)):
        yield f"{base!r} is at x, y = {point((x, y))} m in it and should be at 0 0"
    turned = turn_between(T_link_base.rotation, IDENTITY_ROTATION)
    if turned > angle + SLACK:
        yield f"{base!r} is rotated by {in_degrees(turned)} in it and should not be rotated"


def above_others(
    robot: Configuration, *, link: str, relative_to: str, tolerance: NonNegative
) -> Outcome:
    """The visuals of a link are above those of all other links of its tree, along the z axis of
    another link's frame.

    Args:
        link: The link that is examined.
        relative_to: The link along whose z axis the heights are measured.
        tolerance: How far another link may reach above the lowest point of this one, in metres.
    """
    bottom, _ = span(robot, link, relative_to, Z_AXIS)
    highest = ""
    top = -inf
    root = robot.find_root(link)
    for other in robot.robot.links:
        if other.name == link or robot.find_root(other.name) != root or not other.visuals:
            continue
        _, height = span(robot, other.name, relative_to, Z_AXIS)
        if height > top:
            highest = other.name
            top = height
    at = origin_place(robot, link)
    above = top - bottom
    fine = not above > tolerance + SLACK
    message = f"{link!r} is above all other links"
    if not fine:
        message = (
            f"{highest!r} reaches {in_millimetres(above)} above the bottom of {link!r}; {link!r} "
            "should be above all other links"
        )
    return judged(fine, message, max(above, 0.0), 0.0, tolerance, "m", at=at)


def _measure_each(
    links: Sequence[str], measure: Callable[[str], float]
) -> tuple[_Heights, MissingElement | UnknownShape | None]:
    """Return what can be measured of each link, and why one of them cannot.

    Such a link does not hide the others.
    """
    measurements = {}
    missing = None
    for link in links:
        try:
            measurements[link] = measure(link)
        except (MissingElement, UnknownShape) as error:
            missing = missing or error.with_traceback(
                None
            )  # a traceback keeps this frame and its values alive
    return measurements, missing


def _common_place(
    robot: Configuration,
    wrong: _Heights,
    lowest: _Heights,
    relative_to: str,
    tolerance: float,
) -> LazyLocation | None:
    """Return where to look if heights are off.

    This is the origin of the frame if all are off alike, else of the first link.
    """
    first, value = next(iter(wrong.items()))
    alike = len(wrong) == len(lowest) > 1 and all(
        within(other, value, tolerance) for other in wrong.values()
    )
    chain = robot.chain(first, above=relative_to) if alike else None
    return origin_place(robot, chain[0].child if chain else first)
