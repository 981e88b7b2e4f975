"""The three views of a drawing, and the edges and the outline of a shape in one of them, as exact lines and arcs.

In a view x points to the right, y up and z to the viewer, all in metres.
"""

from collections.abc import Iterator
from itertools import product
from math import atan2, cos, hypot, pi, sin, tau
from typing import NamedTuple

from grader.robot.model import Box, Cylinder, Sphere
from grader.robot.shapes import Shape
from grader.robot.transforms import Rotation, Transform, Vector, cross, minus, unit


class View(NamedTuple):
    """A direction of projection: its name, the axis of the viewer, and T_view_frame, which has no translation."""

    name: str
    origin: str
    T_view_frame: Transform

    @property
    def title(self) -> str:
        """The name with the direction: "top (from +z)"."""
        return f"{self.name} (from {self.origin})"


def _view(name: str, origin: str, rotation: Rotation) -> View:
    return View(name, origin, Transform(rotation))


TOP = _view("top", "+z", (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0))
SIDE = _view("side", "-y", (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0))
FRONT = _view("front", "+x", (0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0))
VIEWER: Vector = (0.0, 0.0, 1.0)  # the direction to the viewer, in a view


Extents = tuple[tuple[float, float], ...]  # along x, y and z

_EDGE_ON = 1e-9  # a face whose normal points less to the viewer is seen edge-on
_ALIGNED = (1.0, 0.0, 0.0)


class Line(NamedTuple):
    """The straight edge from one point to another."""

    start: Vector
    end: Vector

    def at(self, share: float) -> Vector:
        """Return the point at a share of the length, from 0 to 1."""
        return _step(self.start, minus(self.end, self.start), share)

    def extents(self) -> Extents:
        """Return the least and the largest coordinates."""
        return tuple((min(pair), max(pair)) for pair in zip(self.start, self.end, strict=True))


class Arc(NamedTuple):
    """A part of a circle: centre + cos(angle) major + sin(angle) minor, from `start` to `end` in radians.

    In the view the two radii are the semi-axes of the ellipse: `major` is perpendicular to the line of sight.
    """

    centre: Vector
    major: Vector
    minor: Vector
    start: float
    end: float

    def at(self, share: float) -> Vector:
        """Return the point at a share of the angle, from 0 to 1."""
        angle = self.start + share * (self.end - self.start)
        return _step(_step(self.centre, self.major, cos(angle)), self.minor, sin(angle))

    def extents(self) -> Extents:
        """Return the least and the largest coordinates of the whole circle."""
        reaches = map(hypot, self.major, self.minor)
        return tuple((middle - reach, middle + reach) for middle, reach in zip(self.centre, reaches, strict=True))


Curve = Line | Arc


class Edge(NamedTuple):
    """An edge of a shape inside its outline. `faces_viewer` is false if the shape itself hides it."""

    curve: Curve
    faces_viewer: bool


def inner_edges(shape: Shape, pose: Transform) -> list[Edge]:
    """Return the edges of a shape with T_view_shape that do not look like a part of its outline."""
    match shape:
        case Box(size=size):
            return [*_box_edges(_columns(pose, _scale(size, 0.5)), pose)]
        case Cylinder(radius=radius, length=length):
            tube = _Tube.of(radius, length, pose)
            near, far = Edge(tube.rim(tube.near, 0.0, pi), True), Edge(tube.rim(tube.far, pi, tau), False)
            return [near, far] if tube.shows_cap and tube.shows_side else []
        case Sphere():
            return []


def outline(shape: Shape, pose: Transform) -> tuple[Curve, ...]:
    """Return the closed outline of a shape with T_view_shape: curves, each from the end of the one before."""
    match shape:
        case Box(size=size):
            corners = [*_zonogon(pose.translation, _columns(pose, size))]
            return tuple(Line(a, b) for a, b in zip(corners, (*corners[1:], corners[0]), strict=True))
        case Cylinder(radius=radius, length=length):
            tube = _Tube.of(radius, length, pose)
            near, far = tube.rim(tube.near, 0.0, -pi), tube.rim(tube.far, pi, 0.0)
            return (near, Line(near.at(1.0), far.at(0.0)), far, Line(far.at(1.0), near.at(0.0)))
        case Sphere(radius=radius):
            return (Arc(pose.translation, (radius, 0.0, 0.0), (0.0, radius, 0.0), 0.0, tau),)


class _Tube(NamedTuple):
    """A cylinder in a view: the centres of its caps, `near` the one that faces the viewer, and the radii of their rims.

    `major` is perpendicular to the line of sight; `minor` leans to the viewer, unless the axis points to the viewer.
    """

    near: Vector
    far: Vector
    major: Vector
    minor: Vector
    shows_cap: bool
    shows_side: bool

    @classmethod
    def of(cls, radius: float, length: float, pose: Transform) -> "_Tube":
        axis = pose.rotate(VIEWER)
        axis = _scale(axis, -1.0) if axis[2] < 0.0 else axis
        shows_side = hypot(axis[0], axis[1]) > _EDGE_ON
        across = (unit(cross(axis, VIEWER)) if shows_side else None) or _ALIGNED
        near, far = (_step(pose.translation, axis, share) for share in (length / 2.0, -length / 2.0))
        major, minor = _scale(across, radius), _scale(cross(across, axis), radius)
        return cls(near, far, major, minor, axis[2] > _EDGE_ON, shows_side)

    def rim(self, centre: Vector, start: float, end: float) -> Arc:
        return Arc(centre, self.major, self.minor, start, end)


def _box_edges(halves: tuple[Vector, Vector, Vector], pose: Transform) -> Iterator[Edge]:
    to_viewer = pose.rotation[6:9]  # of each axis of the box
    for axis, first, second in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        if not any(halves[axis][:2]):
            continue
        for signs in product((-1.0, 1.0), repeat=2):
            middle = _step(_step(pose.translation, halves[first], signs[0]), halves[second], signs[1])
            line = Line(_step(middle, halves[axis], -1.0), _step(middle, halves[axis], 1.0))
            leans = signs[0] * to_viewer[first], signs[1] * to_viewer[second]
            if min(leans) > _EDGE_ON or max(leans) < -_EDGE_ON:  # the viewer sees both faces beside it, or none
                yield Edge(line, faces_viewer=leans[0] > 0.0)


def _columns(pose: Transform, sizes: Vector) -> tuple[Vector, Vector, Vector]:
    """Return the vectors from a centre along the axes of a shape."""
    x, y, z = sizes
    return pose.rotate((x, 0.0, 0.0)), pose.rotate((0.0, y, 0.0)), pose.rotate((0.0, 0.0, z))


def _zonogon(centre: Vector, sides: tuple[Vector, ...]) -> Iterator[Vector]:
    """Yield the corners of the outline of a box: its edges one after the other, by their direction, and back."""
    upward = [side if side[1] > 0.0 or (side[1] == 0.0 and side[0] > 0.0) else _scale(side, -1.0) for side in sides]
    upward.sort(key=lambda side: atan2(side[1], side[0]))
    corner = centre
    for side in upward:
        corner = _step(corner, side, -0.5)
    for way in (1.0, -1.0):
        for side in upward:
            yield corner
            corner = _step(corner, side, way)


def _step(point: Vector, along: Vector, share: float) -> Vector:
    return (point[0] + share * along[0], point[1] + share * along[1], point[2] + share * along[2])


def _scale(vector: Vector, factor: float) -> Vector:
    return (vector[0] * factor, vector[1] * factor, vector[2] * factor)
