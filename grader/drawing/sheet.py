"""The sheet of a drawing: a scene in three views at one scale, side by side as in third-angle projection.

The top view is above the side view, and the front view to the right of it. Lengths on the sheet are pixels, y points
down.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from math import floor, log10
from typing import NamedTuple

from grader.drawing.curves import FRONT, SIDE, TOP, Curve, Extents, View, outline
from grader.drawing.picture import Picture
from grader.drawing.scene import Body, Scene
from grader.robot.shapes import extent
from grader.robot.transforms import AXES, Transform, Vector

_TRANSPARENT = 0.05  # a body with less alpha hides nothing
_SAME = 1e-6  # metres
_MAX_FRONTS = 50  # the nearest to the viewer


class Seen(NamedTuple):
    """A body in a view with T_view_shape, its closed outline, and its extents along x, y and z."""

    body: Body
    pose: Transform
    outline: tuple[Curve, ...]
    extents: Extents

    def encloses(self, other: Extents) -> bool:
        """Return whether another rectangle in the view is in the one around the body."""
        (a, b), (c, d), _ = self.extents
        (e, f), (g, h), _ = other
        return a <= e and f <= b and c <= g and h <= d


def projection(scene: Scene, view: View) -> list[Seen]:
    """Return the bodies of a scene in a view from back to front.

    The depth of a body is that of its nearest point. Bodies that are slanted can be painted in the wrong order: an
    exact one needs the depths at each place of the view.
    """
    return sorted(project(scene, scene.bodies, view), key=lambda seen: seen.extents[2][1])


def project(scene: Scene, bodies: Iterable[Body], view: View) -> list[Seen]:
    """Return bodies of a scene in a view."""
    found = ((body, view.T_view_frame @ scene.pose(body)) for body in bodies)
    return [
        Seen(body, pose, outline(body.shape, pose), tuple(extent(body.shape, pose, axis) for axis in AXES))
        for body, pose in found
    ]


def with_fronts(bodies: Sequence[Seen]) -> Iterator[tuple[Seen, list[Seen]]]:
    """Yield the bodies of a projection, each with those that may hide a part of it, the nearest first."""
    rows = [(*seen.extents[0], *seen.extents[1], seen) for seen in reversed(bodies)]
    for number in reversed(range(len(rows))):
        a, b, c, d, seen = rows[number]
        fronts = (
            other
            for e, f, g, h, other in islice(rows, number)
            if a < f - _SAME and e < b - _SAME and c < h - _SAME and g < d - _SAME
        )
        opaque = (other for other in fronts if other.body.rgba[3] >= _TRANSPARENT)
        yield seen, list(islice(opaque, _MAX_FRONTS))


Place = tuple[float, float]

WIDTH = 600.0
MARGIN = 40.0  # around the robot in each view, for labels
TITLE = 18.0
KEY_WIDTH = 226.0
KEY_HEIGHT = 150.0
_MAX_HEIGHT = 460.0  # of the top and the side view of the robot together
_MAX_BAR = 90.0
_SMALLEST = 0.02  # metres
_MAX_FRAMES = 12
_MAX_FRAMES_ALONE = 60  # where no shape is shown
_FAR = 2.0  # times the size of the robot: a ground farther away is not in the picture
_UNITS = ((1.0, "m"), (0.01, "cm"), (0.001, "mm"))


class Panel(NamedTuple):
    """A view on a sheet: its rectangle, the position of the frame's origin, and pixels per metre."""

    view: View
    left: float
    top: float
    width: float
    height: float
    origin: Place
    scale: float

    def place(self, point: Vector) -> Place:
        """Return the position of a point of the frame on the sheet."""
        return self.on_sheet(self.view.T_view_frame.apply(point))

    def on_sheet(self, point: Vector) -> Place:
        """Return the position of a point of the view on the sheet."""
        return self.origin[0] + self.scale * point[0], self.origin[1] - self.scale * point[1]

    def direction(self, direction: Vector) -> Vector:
        """Return a direction of the frame on the sheet, with y down, and its component to the viewer."""
        x, y, z = self.view.T_view_frame.rotate(direction)
        return (x, -y, z)


class Sheet(NamedTuple):
    """The panels of the three views, the position of the key, the total height, and pixels per metre."""

    panels: tuple[Panel, ...]
    key: Place
    height: float
    scale: float

    @property
    def bar(self) -> tuple[float, str]:
        """The length of the scale bar in pixels, and its label: 1, 2 or 5 times a power of ten."""
        longest = _MAX_BAR / self.scale
        power = 10.0 ** floor(log10(longest))
        length = max(step * power for step in (1.0, 2.0, 5.0) if step * power <= longest * (1.0 + 1e-9))
        size, name = next((pair for pair in _UNITS if length >= pair[0] * 0.999), _UNITS[-1])
        return length * self.scale, f"{length / size:g} {name}"


def sheet_of(picture: Picture, top: float = 0.0) -> Sheet:
    """Return the sheet for a picture; its panels begin at `top`."""
    low, high = _bounds(picture)
    x, y, z = (max(most - least, _SMALLEST) for least, most in zip(low, high, strict=True))
    room = WIDTH - 4.0 * MARGIN
    scale = min(room / (x + y), (WIDTH - KEY_WIDTH - 2.0 * MARGIN) / x, _MAX_HEIGHT / (y + z))
    right, upper = max(y * scale + 2.0 * MARGIN, KEY_WIDTH), max(y * scale + 2.0 * MARGIN + TITLE, KEY_HEIGHT)
    left, lower, middle = WIDTH - right, z * scale + 2.0 * MARGIN + TITLE, _middle(low, high)
    panels = (
        _panel(TOP, (0.0, top), (left, upper), middle, scale, TITLE),
        _panel(SIDE, (0.0, top + upper), (left, lower), middle, scale, TITLE),
        _panel(FRONT, (left, top + upper), (right, lower), middle, scale, TITLE),
    )
    return Sheet(panels, (left, top), top + (upper + lower), scale)


def _panel(view: View, corner: Place, size: Place, middle: Vector, scale: float, title: float) -> Panel:
    """Return a panel with the robot centred below the title."""
    u, v, _ = view.T_view_frame.apply(middle)
    origin = corner[0] + size[0] / 2.0 - scale * u, corner[1] + (title + size[1]) / 2.0 + scale * v
    return Panel(view, *corner, *size, origin, scale)


def _middle(low: Vector, high: Vector) -> Vector:
    return (low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, (low[2] + high[2]) / 2.0


def _bounds(picture: Picture) -> tuple[Vector, Vector]:
    """Return the least and the largest coordinates of what a picture shows, in the frame."""
    points = [*_extremes(picture)] or [(0.0, 0.0, 0.0)]
    low, high = ([pick(point[axis] for point in points) for axis in range(3)] for pick in (min, max))
    size = max(most - least for least, most in zip(low, high, strict=True))
    for scene in (picture.scene, picture.reference):
        ground = scene.ground if scene is not None else None
        if ground is not None and low[2] - _FAR * size <= ground.translation[2] <= high[2] + _FAR * size:
            low[2], high[2] = min(low[2], ground.translation[2]), max(high[2], ground.translation[2])
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])


def _extremes(picture: Picture) -> Iterator[Vector]:
    yield from _corners(picture.scene, picture.scene.bodies)
    if picture.reference is not None:
        yield from _corners(picture.reference, picture.outlines)
        yield from (picture.reference.poses[link].translation for link in picture.frames)
    yield from (picture.scene.poses[link].translation for link in framed_links(picture))


def _corners(scene: Scene, bodies: Iterable[Body]) -> Iterator[Vector]:
    """Yield the least and the largest coordinates of each body."""
    for body in bodies:
        (a, b), (c, d), (e, f) = (extent(body.shape, scene.pose(body), axis) for axis in AXES)
        yield from ((a, c, e), (b, d, f))


def framed_links(picture: Picture) -> list[str]:
    """Return the links whose frames are shown: those with visuals or callouts, or all links if there are no visuals.

    If there are too many links, only those with callouts.
    """
    scene = picture.scene
    called = [callout.link for callout in picture.callouts]
    shown = [link.name for link in scene.robot.robot.links if link.visuals] or list(scene.poses)
    links = dict.fromkeys([scene.frame, scene.root, *called, *picture.frames, *shown])
    if len(links) > (_MAX_FRAMES if scene.bodies else _MAX_FRAMES_ALONE):
        links = dict.fromkeys([scene.frame, *called[:_MAX_FRAMES]])
    return [link for link in links if link in scene.poses]
