"""How a robot stands: the pose in which it comes to rest on level ground, without a simulator.

A robot that is set down rests where the height of its centre of mass is at a local minimum. As
seen from the robot, the ground is a plane that touches its convex hull from below, and the pose is
the normal of that plane. Lengths are metres, poses are in the frame of the base.
"""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from itertools import combinations, product
from math import atan2, cos, degrees, hypot, inf, isfinite, pi, radians, sin

from grader.base.errors import MissingElement, NotDecided
from grader.base.records import Named
from grader.base.transforms import (
    X_AXIS,
    Z_AXIS,
    Transform,
    Vector,
    add_up,
    cross,
    degrees_between,
    dot,
    minus,
    unit,
    weighted_mean,
)
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Box, Capsule, Collision, Cylinder, Mesh, Visual
from grader.ros.urdf.shapes import PlacedShape, UnknownShape, bounding_radius

_Points = list[Vector]

_TOUCHING = 1e-4  # metres above the ground at which a link still touches it
MAX_SHAPES = 300
_MAX_TILT = 75.0  # degrees; a robot that leans by more has fallen over
_STEEPEST = 9.0  # the slope of the steepest face on which a robot is said to stand
_EXACT = 1e-14  # of the size of a robot: a point that is nearer to a plane is on it
_STILL = 1e-6  # radians; a smaller motion is none
_LEAP = 0.01  # radians
_MAX_STEPS = 300
_MAX_REFINEMENTS = 100
_THIN = 1e-12  # the area of a triangle that has none, of the square of its distance
_ROUNDING = 1e-9  # of the area of a triangle
_LOWER = 1e-12  # of the size of a robot: a mass that goes down by less does not fall
_NUDGE = 2e-3  # radians by which a robot that balances is pushed
_BALANCE = 1e-6  # metres from an edge of the contacts within which a mass balances on it
_RIM_POINTS = 24  # of a cylinder that stands on its flat side
_FALL_STEP = 15.0  # degrees
_MAX_FALL = 12  # poses
_FLAT = 1e-3  # the sine of the angle from which on a cylinder stands on one point of its rim


class _LinkShape(Named):
    """A shape of a link, placed in the frame of the base."""

    link: str
    shape: PlacedShape


class _RestingBody(Named):
    """What decides how a robot stands: its shapes and its centre of mass, in the frame of the base.

    `is_weighed` says that the robot has masses; otherwise its shapes have equal density.
    """

    shapes: tuple[_LinkShape, ...]
    mass_centre: Vector
    is_weighed: bool

    def lowest(self, up: Vector) -> Vector:
        """Return the lowest point of all shapes; `up` is the direction away from the ground."""
        down = (-up[0], -up[1], -up[2])
        lowest = self.mass_centre
        height = inf
        for _, shape in self.shapes:
            point = shape.farthest(down)
            if dot(point, up) < height:
                lowest = point
                height = dot(point, up)
        return lowest

    def mass_height(self, up: Vector) -> float:
        """Return the height of the centre of mass above the ground."""
        return dot(minus(self.mass_centre, self.lowest(up)), up)


class Rest(Named):
    """How a robot stands: where up is as seen from the base, and which points touch the ground.

    `find_rest` makes it; `heights` has the height of the lowest point of each link that has a
    shape, and `contacts` the points of each link that touches the ground.
    """

    up: Vector
    mass_centre: Vector
    heights: dict[str, float]
    contacts: dict[str, _Points]

    def leveled(self, links: Sequence[str]) -> "Rest":
        """Return how it would stand with its base level and these links on the ground."""
        return self._replace(up=Z_AXIS, heights={**self.heights, **dict.fromkeys(links, 0.0)})

    @property
    def tilt(self) -> float:
        """The angle in degrees by which the base leans."""
        return degrees(atan2(hypot(self.up[0], self.up[1]), self.up[2]))

    @property
    def has_fallen(self) -> bool:
        """Whether the robot tips over."""
        return self.tilt > _MAX_TILT

    @property
    def mass_height(self) -> float:
        """The height of the centre of mass above the ground."""
        touching = next(iter(self.contacts.values()))
        return dot(minus(self.mass_centre, touching[0]), self.up)


def make_body(robot: Configuration, base: str) -> _RestingBody:
    """Return the shapes and the centre of mass of a robot, in the frame of its base.

    The shapes of a link are its collision shapes, else its visuals. A link without an <inertial>
    weighs nothing if another link has one, as in Gazebo. Links of other trees do not count. Raises
    UnknownShape for a mesh, NotDecided for a robot without shapes or mass, MissingElement where a
    pose is undefined.
    """
    root = robot.find_root(base)
    roots = {}
    shapes: list[_LinkShape] = []
    masses = []
    for link in robot.robot.links:
        with suppress(MissingElement):  # a link on a loop of joints is in no tree
            roots[link.name] = robot.find_root(link.name)
        if roots.get(link.name) != root:
            continue
        solids = solid_shapes(link.collisions) or solid_shapes(link.visuals)
        if not solids and not link.inertial:
            continue
        T_base_link = robot.pose(link.name, relative_to=base)
        shapes += _place_shapes(link.name, solids, T_base_link)
        if link.inertial and link.inertial.mass > 0.0:
            masses.append((link.inertial.mass, T_base_link.apply(link.inertial.origin.xyz)))
    if len(shapes) > MAX_SHAPES:
        raise NotDecided(f"the robot has more than {MAX_SHAPES} shapes", "a robot has many shapes")
    mean = _mean(masses or _volumes(shapes))
    return _RestingBody(tuple(shapes), mean, bool(masses))


def _place_shapes(
    link: str, elements: Iterable[Visual | Collision], T_base_link: Transform
) -> Iterator[_LinkShape]:
    """Yield the shapes of a link in the frame of the base. Raises UnknownShape for a mesh."""
    for element in elements:
        if isinstance(element.geometry, Mesh):
            raise UnknownShape(element.geometry)
        pose = element.origin.placed_in(T_base_link)
        yield _LinkShape(link, PlacedShape(element.geometry, pose))


def _volumes(shapes: Iterable[_LinkShape]) -> list[tuple[float, Vector]]:
    """Return the volume and the centre of each shape."""
    volumes = []
    for _, (geometry, pose) in shapes:
        assert not isinstance(geometry, Mesh)
        volumes.append((geometry.volume, pose.translation))
    return volumes


def solid_shapes(elements: Iterable[Visual | Collision]) -> list[Visual | Collision]:
    """Return the visuals or collisions that have a size."""
    return [element for element in elements if not element.geometry.is_empty]


def _mean(weighted: Sequence[tuple[float, Vector]]) -> Vector:
    """Return the mean of points with weights. Raises NotDecided if all weights are 0."""
    if not 0.0 < add_up(weight for weight, _ in weighted) < inf:
        raise NotDecided("the robot has no mass and no shape with a volume", "a robot has no mass")
    return weighted_mean(weighted)


def find_rest(body: _RestingBody) -> Rest:
    """Return how a robot stands that is set down upright, its base level, and then let go.

    The body must have shapes.
    """
    *_, up = _fall(body, _MAX_TILT)
    heights, contacts = _measure_heights(body, up)
    if not contacts:
        raise NotDecided("the numbers of the robot are too large to tell how it stands")
    return Rest(up, body.mass_centre, heights, contacts)


def list_fall(body: _RestingBody) -> list[tuple[Vector, float]]:
    """Return how a robot comes to rest that is set down upright, even if it tips over.

    Its base is level. The result is where up is on the way, each with the height of the centre of
    mass above the ground.
    """
    ups: _Points = []
    for up in _fall(body, 180.0):
        if len(ups) > 1 and degrees_between(ups[-2], ups[-1]) < _FALL_STEP / 4.0:
            ups.pop()  # a large ball rolls far in many small steps
        before = ups[-1] if ups else up
        angle = degrees_between(before, up)
        steps = int(angle / _FALL_STEP) + 1 if isfinite(angle) else 1
        for number in range(1, steps + 1):
            way = minus(up, before)
            ups.append(unit(moved(before, [(way, number / steps)])) or up)
    del ups[_MAX_FALL - 1 : -1]
    return [(up, body.mass_height(up)) for up in ups]


def _fall(body: _RestingBody, max_tilt: float) -> Iterator[Vector]:
    """Yield where up is while a robot falls that is set down upright.

    It falls until it rests, or leans by more than an angle in degrees.

    The face of the convex hull that is straight below the centre of mass becomes the ground, until
    it is the ground already. The centre of mass only goes down on the way: the height of the hull's
    bottom below it, measured along the old normal, is a convex function of the slope of the ground,
    and that face is its minimum. A robot that then balances is pushed.
    """
    up = Z_AXIS
    size = _bound_size(body)
    yield up
    for _ in range(_MAX_STEPS):
        face = _face_below(body, up, size)
        if face is None:
            touching = lowest_points([shape for _, shape in body.shapes], up)
            away = minus(body.mass_centre, _mean([(1.0, point) for point in touching]))
            yield unit((-away[0], -away[1], 0.0)) or X_AXIS  # to the side where the mass is
            return
        falls = body.mass_height(face) < body.mass_height(up) - _LOWER * size
        if falls and hypot(*minus(face, up)) > _STILL:
            up = _follow(body, up, face)
        else:
            pushed = _pushed_off_balance(body, face, size)
            if pushed is None:
                return
            up = pushed
        yield up
        if up[2] < cos(radians(max_tilt)):
            return


def _follow(body: _RestingBody, start: Vector, face: Vector) -> Vector:
    """Return where up is after a fall to a face, and further that way.

    It goes further while the mass goes down and the way is short: a large ball rolls far in many
    small steps.
    """
    best = face
    step = minus(face, start)
    while hypot(*step) < _LEAP:
        step = (2.0 * step[0], 2.0 * step[1], 2.0 * step[2])
        further = unit((start[0] + step[0], start[1] + step[1], start[2] + step[2]))
        if further is None or not body.mass_height(further) < body.mass_height(best):
            break
        best = further
    return best


def _bound_size(body: _RestingBody) -> float:
    """Return an upper bound on the distance of a point of the robot from its centre of mass."""
    distances = []
    for _, (geometry, pose) in body.shapes:
        assert not isinstance(geometry, Mesh)
        distances.append(hypot(*minus(pose.translation, body.mass_centre)))
        distances[-1] += bounding_radius(geometry)
    return max(distances)


def _face_below(body: _RestingBody, up: Vector, size: float) -> Vector | None:
    """Return the normal, upward, of the face of the convex hull straight below the centre of mass.

    It is None if there is no such face, or one that is very steep. This is portal refinement
    (Snethen, XenoCollide, Game Programming Gems 7, 2008): a triangle of points around the line of
    the mass goes down until no point of the hull is below it.
    """
    x, y = level_directions(up)
    far = 4.0 * size
    corners = []
    for number in range(3):  # above all faces that are not too steep
        angle = 2.0 * pi * number / 3.0 + 0.1
        reach = ((x, far * cos(angle)), (y, far * sin(angle)), (up, far * _STEEPEST))
        corners.append(moved(body.mass_centre, reach))
    bounds = tuple(corners)
    normal = up
    for _ in range(_MAX_REFINEMENTS):
        point = body.lowest(normal)
        if dot(minus(corners[0], point), normal) <= _EXACT * size:
            break
        refined = _refined(corners, point, body.mass_centre, up)
        turned = unit(cross(minus(refined[1], refined[0]), minus(refined[2], refined[0])))
        corners = refined
        # but for rounding, an edge has no face
        normal = turned if turned is not None and dot(turned, up) > 0.0 else normal
    if any(corner in bounds for corner in corners):
        return None
    return normal


def moved(point: Vector, moves: Iterable[tuple[Vector, float]]) -> Vector:
    """Return a point that is moved by lengths along directions."""
    x, y, z = point
    for direction, length in moves:
        x += length * direction[0]
        y += length * direction[1]
        z += length * direction[2]
    return (x, y, z)


def _refined(corners: _Points, point: Vector, centre: Vector, up: Vector) -> _Points:
    """Return the triangle of two corners and a point that has the centre inside.

    This is seen from above. The triangle is counterclockwise, as the corners are.
    """
    a, b, c = corners
    best = corners
    best_fit = (-inf, 0.0)
    for triangle in ([point, a, b], [point, b, c], [point, c, a]):
        fit = _fit_around(triangle, centre, up)
        if fit > best_fit:
            best = triangle
            best_fit = fit
    return best


def _fit_around(triangle: _Points, centre: Vector, up: Vector) -> tuple[float, float]:
    """Return how well a triangle has a point inside, seen from above, and its area.

    The first is by how much of the area the point is outside, at most 0.
    """
    a, b, c = (minus(corner, centre) for corner in triangle)
    parts = [dot(up, cross(a, b)), dot(up, cross(b, c)), dot(up, cross(c, a))]
    area = add_up(parts)
    if area <= _THIN * max(dot(a, a), dot(b, b), dot(c, c)):
        return (-inf, 0.0)
    return (min(0.0, min(parts) / area + _ROUNDING), area)


def _pushed_off_balance(body: _RestingBody, up: Vector, size: float) -> Vector | None:
    """Return where up is after a push under which the centre of mass goes down.

    Returns None if the robot stands firmly.

    It can fall only if its centre of mass is straight above a line between two contacts, such as
    the axle of two wheels, or above a single one. There the slope is 0, and the curvature decides.
    """
    best = None
    lowest = body.mass_height(up) - _LOWER * size
    for direction in _find_loose_directions(body, up):
        pushed = unit(moved(up, [(direction, _NUDGE)]))
        if pushed is not None and body.mass_height(pushed) < lowest:
            best = pushed
            lowest = body.mass_height(pushed)
    return best


def _find_loose_directions(body: _RestingBody, up: Vector) -> Iterator[Vector]:
    """Yield the directions, level, in which a robot could fall without lifting its mass first."""
    _, contacts = _measure_heights(body, up)
    offsets = []
    for points in contacts.values():
        for point in points:
            away = minus(point, body.mass_centre)
            offsets.append(moved(away, [(up, -dot(away, up))]))
    for one, other in combinations(offsets, 2):
        along = unit(minus(other, one))
        if along is None:
            continue
        across = cross(up, along)
        is_between = dot(one, along) < _BALANCE and dot(other, along) > -_BALANCE
        if is_between and abs(dot(one, across)) < _BALANCE:
            yield across
            yield minus((0.0, 0.0, 0.0), across)
    if any(hypot(*offset) < _BALANCE for offset in offsets):
        x, y = level_directions(up)
        for number in range(8):
            angle = number * pi / 4.0
            yield moved((0.0, 0.0, 0.0), [(x, cos(angle)), (y, sin(angle))])


def _measure_heights(body: _RestingBody, up: Vector) -> tuple[dict[str, float], dict[str, _Points]]:
    """Return the height of each link above the ground, and the points of those that touch it."""
    floor = dot(body.lowest(up), up)
    heights: dict[str, float] = {}
    contacts: dict[str, _Points] = {}
    for link, shape in body.shapes:
        height = shape.extent(up)[0] - floor
        heights[link] = min(height, heights.get(link, inf))
        if height > _TOUCHING:
            continue
        for point in _low_points(shape, up):
            if dot(point, up) - floor <= _TOUCHING:
                contacts.setdefault(link, []).append(point)
    return heights, contacts


def _low_points(shape: PlacedShape, up: Vector) -> Iterator[Vector]:
    """Yield the points with which a shape can touch the ground.

    These are the corners of a box, the lowest point of a sphere, of each end of a capsule and of
    each rim of a cylinder, or points around its rims if it is upright.
    """
    geometry, pose = shape
    if isinstance(geometry, Box):
        for signs in product((0.5, -0.5), repeat=3):
            x, y, z = geometry.size
            yield pose.apply((signs[0] * x, signs[1] * y, signs[2] * z))
    elif isinstance(geometry, Cylinder):
        for x, y in _rim_directions(pose.unrotate(up)):
            for end in (0.5 * geometry.length, -0.5 * geometry.length):
                yield pose.apply((abs(geometry.radius) * x, abs(geometry.radius) * y, end))
    elif isinstance(geometry, Capsule):
        down = minus((0.0, 0.0, 0.0), pose.unrotate(up))
        x, y, z = (abs(geometry.radius) * component for component in down)
        for end in (0.5 * geometry.length, -0.5 * geometry.length):
            yield pose.apply((x, y, z + end))
    else:
        yield shape.farthest(minus((0.0, 0.0, 0.0), up))


def _rim_directions(up: Vector) -> Iterator[tuple[float, float]]:
    """Yield the directions from the middle of a rim to where it can touch the ground."""
    x, y, _ = up
    if hypot(x, y) > _FLAT:
        yield (-x / hypot(x, y), -y / hypot(x, y))
        return
    for number in range(_RIM_POINTS):
        angle = 2.0 * pi * number / _RIM_POINTS
        yield (cos(angle), sin(angle))


def lowest_points(shapes: Sequence[PlacedShape], up: Vector) -> _Points:
    """Return the points with which shapes touch the ground, or would first."""
    lowest = min(shape.extent(up)[0] for shape in shapes)
    points = []
    for shape in shapes:
        for point in _low_points(shape, up):
            if dot(point, up) <= lowest + _TOUCHING:
                points.append(point)
    return points


def level_directions(up: Vector) -> tuple[Vector, Vector]:
    """Return forward and left on the ground, as seen from the base, whose x axis points forward."""
    forward = unit(moved(X_AXIS, [(up, -up[0])])) or minus((0.0, 0.0, 0.0), Z_AXIS)
    return forward, cross(up, forward)
