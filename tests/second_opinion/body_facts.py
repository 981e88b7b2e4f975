"""Facts about one link: shapes, colours, mass, inertia, collision shapes."""

from collections.abc import Sequence
from itertools import combinations
from math import cos, radians

import numpy as np

from tests.second_opinion.elements import Link, Shape
from tests.second_opinion.geometry import inertia, is_same_solid, overlap
from tests.second_opinion.posed import SLACK, Fact, Missing, Posed, Undecided, near

_VISIBLE = 0.01  # alpha
_SIDE_BY_SIDE = 0.001  # metres: shapes that overlap by no more share no solid


def shows_box(
    posed: Posed, link: str, size: Sequence[float], tolerance: float, centred: bool = False
) -> Fact:
    edges = []
    for shape in _of_kind(posed, link, "box"):
        turned = np.abs(shape.pose[:3, :3])
        order = turned.argmax(axis=1)
        if sorted(order) == [0, 1, 2] and turned[range(3), order].min() >= cos(radians(1.0)):
            edges.append((np.array(shape.size)[order], shape.pose[:2, 3]))
    if not edges:
        return False, None
    best, middle = min(
        edges, key=lambda found: (np.abs(found[0] - size).max(), np.abs(found[1]).max())
    )
    fine = near(best, size, tolerance) and bool(best.min() >= 0)
    if fine and centred and not near(middle, (0, 0), tolerance):
        return False, middle
    return fine, best


def shows_cylinder(posed: Posed, link: str, radius: float, length: float, tolerance: float) -> Fact:
    sizes = [np.array(shape.size) for shape in _of_kind(posed, link, "cylinder")]
    best = min(sizes, key=lambda found: np.abs(found - (radius, length)).max())
    return near(best, (radius, length), tolerance) and bool(best.min() >= 0), best


def shows_sphere(posed: Posed, link: str, radius: float, tolerance: float) -> Fact:
    best = min(
        (shape.size[0] for shape in _of_kind(posed, link, "sphere")),
        key=lambda found: abs(found - radius),
    )
    return near(best, radius, tolerance), best


def _of_kind(posed: Posed, link: str, kind: str) -> list[Shape]:
    found = [shape for shape in posed.visuals(link) if shape.kind == kind]
    if not found and posed.main(link).kind == "mesh":
        raise Undecided(link)
    if not found:
        raise Missing(kind, link)
    return found


def shows_colour(
    posed: Posed, link: str, colour: Sequence[float], tolerance: float, shape: str = "any"
) -> Fact:
    found = posed.main(link, shape).colour
    if found is None:
        return False, None
    is_visible = found[3] >= _VISIBLE or (len(colour) == 4 and colour[3] < _VISIBLE)
    found = found[: len(colour)]
    return near(found, colour, tolerance) and is_visible, found


def shows_grey(posed: Posed, link: str, at_least: float, tolerance: float) -> Fact:
    found = posed.main(link).colour
    if found is None:
        return False, None
    red_green_blue = found[:3]
    is_grey = (
        found[3] >= _VISIBLE and max(red_green_blue) - min(red_green_blue) <= tolerance + SLACK
    )
    return bool(is_grey and min(red_green_blue) >= at_least - SLACK), red_green_blue


def shows_nothing(posed: Posed, link: str) -> Fact:
    return not is_shown(posed.link(link)), None


def is_shown(link: Link) -> bool:
    """Return whether a link shows anything: a visual that has a size and is not transparent."""
    return any(
        one.has_size and (one.colour is None or one.colour[3] >= _VISIBLE) for one in link.visuals
    )


def mass_is(posed: Posed, link: str, mass: float, tolerance: float) -> Fact:
    inertial = posed.link(link).inertial
    if inertial is None:
        raise Missing("inertial", link)
    return near(inertial[0], mass, tolerance), inertial[0]


def inertia_plausible(posed: Posed, link: str, tolerance: float) -> Fact:
    found = posed.link(link)
    if found.inertial is None:
        raise Missing("inertial", link)
    mass, centre, tensor = found.inertial
    moments = np.linalg.eigvalsh(tensor)
    if mass <= 0 or moments[0] <= 0 or moments[2] > (moments[0] + moments[1]) * (1 + SLACK):
        return False, None
    shapes = [shape for shape in found.collisions if shape.volume > 0] or [
        shape for shape in found.visuals if shape.volume > 0
    ]
    if not shapes:
        raise Missing("visual", link)
    if any(shape.kind == "mesh" for shape in shapes):
        raise Undecided(link)
    shapes = [
        one
        for at, one in enumerate(shapes)
        if not any(_is_equal(one, other) for other in shapes[:at])
    ]
    total = sum(shape.volume for shape in shapes)
    middle = sum((shape.volume / total * shape.pose[:3, 3] for shape in shapes), np.zeros(3))
    expected = np.zeros((3, 3))
    for shape in shapes:
        part, away = mass * shape.volume / total, shape.pose[:3, 3] - middle
        turned = shape.pose[:3, :3]
        expected += turned @ inertia(shape, part) @ turned.T + part * (
            away @ away * np.eye(3) - np.outer(away, away)
        )
    size = max(
        float(np.linalg.norm(one.pose[:3, 3] - other.pose[:3, 3])) + one.radius + other.radius
        for one in shapes
        for other in shapes
    )
    is_off = np.linalg.norm(centre - middle) > max(0.002, 0.02 * size) + SLACK
    off = (
        100 * np.abs(np.linalg.eigvalsh(tensor - expected)).max() / np.linalg.eigvalsh(expected)[2]
    )
    fine = bool(off <= tolerance + SLACK and not is_off)
    pairs = combinations(shapes, 2)
    if not fine and any(
        overlap(one, one.pose, other, other.pose, _SIDE_BY_SIDE) > _SIDE_BY_SIDE
        for one, other in pairs
    ):
        raise Undecided(link)
    return fine, off


def _is_equal(one: Shape, other: Shape) -> bool:
    return (one.kind, one.size) == (other.kind, other.size) and bool((one.pose == other.pose).all())


def collision_matches_visual(posed: Posed, link: str, tolerance: float) -> Fact:
    visuals, left = (
        posed.visuals(link),
        [shape for shape in posed.link(link).collisions if shape.has_size],
    )
    if any(shape.kind == "mesh" for shape in (*visuals, *left)):
        raise Undecided(link)
    if len(visuals) != len(left):
        return False, None
    for shape in visuals:
        same = [other for other in left if is_same_solid(shape, other, tolerance)]
        if not same:
            return False, None
        left.remove(min(same, key=lambda other: float(np.abs(other.pose - shape.pose).max())))
    return True, None
