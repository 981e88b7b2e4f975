"""Checks of the mass and the inertia of a link.

The inertia is compared with that of a uniform solid of its shapes.
"""

from math import isfinite

from grader.base.errors import MissingElement, NotDecided
from grader.base.grouping import Strings
from grader.base.quantities import in_millimetres, point, within
from grader.base.source import place
from grader.base.toml_types import NonNegative
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, judged
from grader.lab.checks.visuals import MAX_SHAPES
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.mass_properties import (
    Solid,
    principal_moments,
    with_volume,
)
from grader.ros.urdf.model import Inertial

ABOUT = {
    "mass_is": About(("mass", "inertial")),
    "inertia_plausible": About(("inertial",)),
}

_SINGULAR = 1e-12  # of the largest principal moment: a smaller one is 0 but for rounding
# Of the largest principal moment: what rounding may add to it in a thin plate, where it is the sum
# of the others.
_ROUNDING = 0.01
_CENTRE = 0.002  # metres that a centre of mass may be off
_CENTRE_SHARE = 0.02  # of the size that a centre of mass may be off
_OVERLAP = 0.001  # metres; shapes that overlap by less are side by side


def mass_is(
    robot: Configuration, *, link: str, mass: NonNegative, tolerance: NonNegative
) -> Outcome:
    """The mass of a link is the given one in kilograms.

    Args:
        link: The link that is examined.
        mass: The mass in kilograms.
        tolerance: How far the mass may be off, in kilograms.
    """
    inertial = _needed_inertial(robot, link)
    actual = inertial.mass
    fine = within(actual, mass, tolerance)
    message = f"the mass of {link!r} is {actual:.6g} kg"
    if not fine:
        unit = ": is it in grams?" if 0.99 * mass < actual / 1000.0 < 1.01 * mass else ""
        side = "large" if actual > mass else "small"
        message += f"; it should be {mass:.6g} kg ({abs(actual - mass):.6g} kg too {side}){unit}"
    return judged(
        fine, message, actual, mass, tolerance, "kg", at=place(inertial.location, "value", "mass")
    )


def inertia_plausible(
    robot: Configuration,
    *,
    link: str,
    tolerance: NonNegative,
    mass: NonNegative | None = None,
    shown: bool = False,
) -> Outcome:
    """The inertia and the centre of mass of a link are those of a uniform solid of its shapes with
    its mass.

    The shapes are the collision shapes, or the visuals of a link without any; a mesh needs manual
    grading. The mass must be positive, the inertia positive definite, and no principal moment
    larger than the sum of the other two. The centre of mass may be 2 mm or 2 % of the size off,
    whichever is more; the size is the largest distance of two points. If shapes overlap by more
    than 1 mm, their solid is not known, and what is off needs manual grading.

    Args:
        link: The link that is examined.
        tolerance: How far the inertia about any axis may be off, in percent of the largest
            principal moment of the solid.
        mass: The mass of the solid in kilograms, in place of that of the link.
        shown: Whether only the visuals count.
    """
    inertial = _needed_inertial(robot, link)
    if mass is not None:
        inertial = inertial._replace(mass=mass)
    impossible = _refuse_impossible(link, inertial)
    if impossible:
        return impossible
    what, solid = _find_solid(robot, link, ("visual",) if shown else ("collision shape", "visual"))
    try:
        difference = solid.difference(inertial)
    except ValueError:
        message = (
            f"the inertia of {link!r} cannot be compared: the volume of its {what} is too large"
        )
        return failed(message, robot.link(link).location)
    off = difference.percent
    distance = difference.distance
    at = place(inertial.location, None, "inertia")
    if not isfinite(off + distance):
        return failed(
            f"the inertia of {link!r} cannot be compared: its numbers are too large or too small",
            at,
        )
    wrong = []
    if not within(off, 0.0, tolerance):
        reason = ", ".join(
            f"{name} is {actual:.3g}, not {wanted + 0.0:.3g}"
            for name, actual, wanted in difference.components(tolerance)
        )
        solid_text = f"a uniform solid of its {what} with a mass of {inertial.mass:.6g} kg"
        percent = f"{off:,.0f}" if 1e3 <= off < 1e10 else f"{off:.3g}"
        wrong.append(f"the inertia of {link!r} is {percent} % off that of {solid_text}: {reason}")
    if not within(distance, 0.0, max(_CENTRE, _CENTRE_SHARE * solid.size)):
        at = at if wrong else place(inertial.origin.location, "xyz") or place(inertial.location)
        wrong.append(
            f"the centre of mass of {link!r} is at {point(difference.given.centre)} m; it should "
            f"be at {point(difference.solid.centre)} m in {link!r} ({in_millimetres(distance)} off)"
        )
    if wrong and solid.overlaps(_OVERLAP):
        reason = f"the {what} of a link overlap, so their solid is not known"
        raise NotDecided(f"{'; '.join(wrong)}, but the {what} overlap", reason)
    message = "; ".join(wrong) or (
        f"the inertia of {link!r} is that of a uniform solid of its {what} "
        f"({round(off, 2):g} % off)"
    )
    return judged(not wrong, message, off, 0.0, tolerance, "%", at=at)


def _needed_inertial(robot: Configuration, link: str) -> Inertial:
    """Return the <inertial> of a link; raise MissingElement if ROS 2 reads none."""
    found_link = robot.link(link)
    if not found_link.inertial:
        message = f"link {link!r} has no valid <inertial>"
        raise MissingElement("inertial", link, message=message, location=place(found_link.location))
    return found_link.inertial


def _refuse_impossible(link: str, inertial: Inertial) -> Outcome | None:
    """Return the failure of a mass or inertia that is physically impossible."""
    if not inertial.mass > 0.0:
        message = f"the mass of {link!r} is {inertial.mass:.6g} kg; it should be positive"
        return failed(message, place(inertial.location, "value", "mass"))
    at = place(inertial.location, None, "inertia")
    smallest, middle, largest = principal_moments(inertial.inertia)
    moments = f"its principal moments are {smallest:.3g}, {middle:.3g} and {largest:.3g} kg m^2"
    if not smallest > _SINGULAR * largest:
        return failed(
            f"the inertia of {link!r} is not positive definite: {moments}; each should be positive",
            at,
        )
    if not smallest + middle >= (1.0 - _ROUNDING) * largest:
        rule = "none should be larger than the sum of the other two"
        return failed(f"the inertia of {link!r} is physically impossible: {moments}; {rule}", at)
    return None


def _find_solid(robot: Configuration, link: str, words: Strings) -> tuple[str, Solid]:
    """Return the first of these kinds of shapes that a link has, and its solid.

    Raises UnknownShape for a mesh, MissingElement for a link without a shape.
    """
    found_link = robot.link(link)
    for word in words:
        placed = with_volume(found_link.visuals if word == "visual" else found_link.collisions)
        if len(placed) > MAX_SHAPES:
            raise NotDecided(
                f"{link!r} has more than {MAX_SHAPES} shapes", "a link has very many shapes"
            )
        if placed:
            return word if len(placed) == 1 else f"{word}s", Solid.of(placed)
    message = f"link {link!r} has no visual or collision shape with a volume"
    raise MissingElement("visual", link, message=message, location=place(found_link.location))
