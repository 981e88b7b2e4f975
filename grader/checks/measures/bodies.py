"""Facts about the mass of a link, its inertia and its collision shapes."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import isfinite
from typing import Any

from grader.checks.measures.fact import Fact, Omission, exact, in_title, length, lengths, of_links, whole_angle
from grader.checks.visuals import MAX_SHAPES
from grader.robot.model import INERTIA, Box, Collision, Cylinder, Inertial, Link, Mesh, Sphere
from grader.robot.shapes import is_empty
from grader.xml.wanted_element import readable

_MASS_TOLERANCE = 0.001  # kg: the default of mass_is
_SHARE = 0.01  # of a mass for which the default tolerance is too much
_LOOSE_INERTIA = 5.0  # percent, for a solution with rounded numbers
_INERTIA_SHARE = 0.005  # of the largest moment, where the inertia is that of a mesh
_CENTRE_TOLERANCE = 0.002  # m
_DIAGONAL = (0, 3, 5)


def _masses(link: Link) -> Iterator[Fact]:
    if link.inertial is not None and isfinite(link.inertial.mass):
        yield _mass(link.name, exact(link.inertial.mass))


def _inertias(link: Link) -> Iterator[Fact]:
    if link.inertial is not None and isfinite(link.inertial.mass) and link.inertial.mass > 0:
        yield _inertia(link, link.inertial)


def _collisions(link: Link) -> Iterator[Fact | Omission]:
    """Yield the collision shapes of a link that shows nothing."""
    if len(link.collisions) > MAX_SHAPES:
        yield Omission(f"how {link.name} collides", f"it has more than {MAX_SHAPES} collisions")
    elif not _is_shown(link):
        yield from _each_collision(link)


def _collisions_as_shown(link: Link) -> Iterator[Fact]:
    """Yield that the collision shapes of a link are those that it shows, or else what they are."""
    if link.collisions and len(link.collisions) <= MAX_SHAPES and _is_shown(link):
        title = f"The collision shapes of {link.name} are those that it shows"
        fact = Fact(link.name, "collision", title, "collision_matches_visual", {"link": link.name})
        yield replace(fact, otherwise=tuple(_each_collision(link)))


def _is_shown(link: Link) -> bool:
    return any(not is_empty(visual.geometry) for visual in link.visuals)


def _each_collision(link: Link) -> Iterator[Fact]:
    is_only = len(link.collisions) == 1
    for index, collision in enumerate(link.collisions):
        yield _collision(link.name, collision, index, only=is_only)


masses = of_links(_masses)
inertias = of_links(_inertias)
collisions = of_links(_collisions)
collisions_as_shown = of_links(_collisions_as_shown)


def _mass(link: str, mass: float) -> Fact:
    least = abs(mass) * _SHARE
    tolerance = {"tolerance": exact(least)} if least < _MASS_TOLERANCE else {}
    title = f"The mass of {link} is {in_title([mass])} kg"
    return Fact(link, "mass", title, "mass_is", {"link": link, "mass": mass, **tolerance})


def _inertia(link: Link, inertial: Inertial) -> Fact:
    """Return that an inertia fits the shapes; where these are not known, what its numbers are."""
    title = f"The inertia of {link.name} is that of a uniform solid of its shape, with its mass"
    fact = Fact(link.name, "inertia", title, "inertia_plausible", {"link": link.name})
    shapes = [shape.geometry for shape in (link.collisions or link.visuals)]
    if not shapes or any(isinstance(shape, Mesh) for shape in shapes):
        return replace(fact, otherwise=tuple(_numbers_of(link.name, inertial)))
    loose = replace(fact, arguments={**fact.arguments, "tolerance": _LOOSE_INERTIA})
    return replace(fact, otherwise=(loose,))


def _numbers_of(link: str, inertial: Inertial) -> Iterator[Fact]:
    if min(inertial.inertia[index] for index in _DIAGONAL) <= 0:
        return
    moments = dict(zip(INERTIA, map(exact, inertial.inertia), strict=True))
    parts = ", ".join(f"{key} {in_title([value])}" for key, value in moments.items())
    title = f"The inertia of {link} is {parts} kg m^2"
    tolerance = exact(max(map(abs, moments.values())) * _INERTIA_SHARE)
    yield _element(
        link, "inertia", title, "inertial/inertia", {f"@{key}": it for key, it in moments.items()}, tolerance
    )
    if any(inertial.origin.xyz):
        xyz = in_title(lengths(inertial.origin.xyz))
        title = f"The centre of mass of {link} is at {xyz} m in its frame"
        yield _element(link, "mass-centre", title, "inertial/origin", {"@xyz": xyz}, _CENTRE_TOLERANCE)


def _collision(link: str, collision: Collision, index: int, *, only: bool) -> Fact:
    """Return the size of a collision shape that is no visual shape, and where it is."""
    aspect, xyz = f"collision-{index + 1}" if index else "collision", lengths(collision.origin.xyz)
    shape: dict[str, Any]
    match collision.geometry:
        case Box(size=size):
            shape, what = {"box": lengths(size)}, f"box {in_title(size)} m"
        case Cylinder(radius=radius, length=long):
            shape = {"cylinder": [length(radius), length(long)]}
            what = f"cylinder of radius {in_title([radius])} m and length {in_title([long])} m"
        case Sphere(radius=radius):
            shape, what = {"sphere": length(radius)}, f"sphere of radius {in_title([radius])} m"
        case mesh:
            file = readable(mesh.filename)
            values = {"geometry/mesh/@filename": file}
            values |= {"geometry/mesh/@scale": in_title(mesh.scale)} if mesh.scale != (1.0, 1.0, 1.0) else {}
            values |= {"origin/@xyz": in_title(xyz)} if any(xyz) else {}
            title = f"{link} collides as a mesh {file}{f' at {in_title(xyz)} m in its frame' if any(xyz) else ''}"
            return _element(link, aspect, title, "collision", values, _CENTRE_TOLERANCE)
    title = f"{link} collides as a {what}{f' at {in_title(xyz)} m in its frame' if any(xyz) else ''}"
    place = {"xyz": xyz, "rpy": [whole_angle(angle) for angle in collision.origin.rpy]}
    return Fact(
        link, aspect, title, "collides_as", {"link": link, **shape, **place, **({"only": True} if only else {})}
    )


def _element(link: str, aspect: str, title: str, path: str, values: Mapping[str, Any], tolerance: float) -> Fact:
    arguments = {"tag": "link", "attributes": {"name": link}, "path": path, "values": values, "tolerance": tolerance}
    return Fact(link, aspect, title, "element_present", arguments)
