"""Facts about the mass of a link, its inertia and its collision shapes."""

from collections.abc import Iterator
from math import isfinite

from grader.authoring.fact import Fact, exact, shown
from grader.robot.model import Link

_MASS_TOLERANCE = 0.001  # kg: the default of mass_is
_SHARE = 0.01  # of a mass for which the default tolerance is too much


def body_facts(link: Link) -> Iterator[Fact]:
    """Yield the mass of a link, and that its inertia and its collision shapes fit its shapes."""
    if link.inertial is not None and isfinite(link.inertial.mass):
        mass = exact(link.inertial.mass)
        least = abs(mass) * _SHARE
        tolerance = {"tolerance": exact(least)} if least < _MASS_TOLERANCE else {}
        yield Fact(
            link.name,
            "mass",
            f"The mass of {link.name} is {shown([mass])} kg",
            "mass_is",
            {"link": link.name, "mass": mass, **tolerance},
        )
        title = f"The inertia of {link.name} is that of a uniform solid of its shape, with its mass"
        yield Fact(link.name, "inertia", title, "inertia_plausible", {"link": link.name})
    if link.collisions:
        title = f"The collision shapes of {link.name} are those that it shows"
        yield Fact(link.name, "collision", title, "collision_matches_visual", {"link": link.name})
