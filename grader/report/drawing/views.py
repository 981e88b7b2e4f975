"""Three orthographic views of a scene at one scale, as in third-angle projection.

It also finds free places for labels in them.

A box, a cylinder, a capsule and a sphere are convex, so the outline of each in a view is the convex
hull of its projected points. Lengths on the sheet are pixels, and y points down.
"""

from collections.abc import Iterable
from itertools import product
from math import inf
from typing import Any, NamedTuple

import numpy as np

from grader.base.transforms import Transform, Vector
from grader.report.drawing.picture import Body, Picture
from grader.ros.api import Box, Capsule, Sphere

Place = tuple[float, float]
_Points = Any  # an array of shape (n, 3), or (n, 2) in a view

WIDTH = 600.0
TITLE = 18.0
PANEL = WIDTH / 2.0  # the width of a view
_MARGIN = 40.0  # around the robot in each view, for labels
_KEY_HEIGHT = 130.0
_MAX_HEIGHT = 460.0  # of the view from above and the side view of the robot together
_SMALLEST = 0.02  # metres
_MAX_FRAMES, _MAX_FRAMES_ALONE = 12, 60  # with shapes, and where none is shown
_FAR = 2.0  # times the size of the robot: a ground farther away is not in the picture
_ANGLES = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
CIRCLE = np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)])
CORNERS = np.array(list(product((-0.5, 0.5), repeat=3)))
_CAPS = np.array([(x, y, z) for z in (-0.5, 0.5) for x, y in CIRCLE])
# Of each view: its title, and the axes of the frame that point to the right, up and to the viewer.
_TOP = ("top (from +z)", (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_SIDE = ("side (from -y)", (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0))
_FRONT = ("front (from +x)", (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))


class Panel(NamedTuple):
    """A view on the sheet: the directions of the frame in it, its rectangle, and pixels per metre.

    `middle` is the point of the frame (m) at its centre.
    """

    title: str
    right: Vector
    up: Vector
    near: Vector
    left: float
    top: float
    height: float
    middle: Vector
    scale: float

    def direction(self, direction: Vector) -> Vector:
        """Return a direction of the frame on the sheet, and its component to the viewer.

        On the sheet y is down.
        """
        x, y, z = np.array((self.right, self.up, self.near)) @ direction
        return float(x), -float(y), float(z)

    def places(self, points: _Points) -> _Points:
        """Return the positions of points of the frame on the sheet."""
        centre = self.left + PANEL / 2.0, self.top + (TITLE + self.height) / 2.0
        across = (np.array(points) - self.middle) @ np.array((self.right, self.up)).T
        return centre + across * (self.scale, -self.scale)

    def place(self, point: Vector) -> Place:
        """Return the position of a point of the frame on the sheet."""
        x, y = self.places(point)
        return float(x), float(y)

    def outline(self, body: Body) -> list[Place]:
        """Return the corners of the outline of a body."""
        if isinstance(body.shape, Capsule | Sphere):
            circle = CIRCLE * body.shape.radius * self.scale
            return hull(np.vstack([self.places(end) + circle for end in _ball_centres(body)]))
        return hull(self.places(outline_body(body)))


def outline_body(body: Body) -> _Points:
    """Return points of the frame whose hull is a body.

    Of a sphere and of the ends of a capsule, they are those that are farthest along the axes.
    """
    pose = body.T_frame_shape
    shape = body.shape
    if isinstance(shape, Capsule | Sphere):
        around = shape.radius * np.vstack([np.eye(3), -np.eye(3)])
        return np.vstack([np.add(end, around) for end in _ball_centres(body)])
    if isinstance(shape, Box):
        points = CORNERS * shape.size
    else:
        points = _CAPS * (shape.radius, shape.radius, shape.length)
    return points @ np.reshape(pose.rotation, (3, 3)).T + pose.translation


def _ball_centres(body: Body) -> list[Vector]:
    """Return the centre of a sphere, or those of the two ends of a capsule."""
    pose = body.T_frame_shape
    shape = body.shape
    if not isinstance(shape, Capsule):
        return [pose.translation]
    half = shape.length / 2.0
    return [pose.apply((0.0, 0.0, end)) for end in (half, -half)]


def hull(points: _Points) -> list[Place]:
    """Return the convex hull of points on the sheet, to a tenth of a pixel.

    It is Andrew's monotone chain, 1979.
    """
    rounded: Any = np.round(points, 1).tolist()
    ordered = sorted({(float(x), float(y)) for x, y in rounded})
    return [place for half in (ordered, ordered[::-1]) for place in _half_hull(half)] or ordered


def _half_hull(ordered: list[Place]) -> list[Place]:
    half: list[Place] = []
    for x, y in ordered:
        while len(half) > 1:
            (a, b), (c, d) = half[-2:]
            if (c - a) * (y - b) > (d - b) * (x - a):
                break
            half.pop()
        half.append((x, y))
    return half[:-1]


def from_back_to_front(bodies: Iterable[Body], panel: Panel) -> list[Body]:
    """Return bodies by the depth of their nearest points.

    Slanted ones that interlock may be in the wrong order.
    """
    return sorted(bodies, key=lambda body: float((outline_body(body) @ panel.near).max()))


def make_panels(picture: Picture, top: float = 0.0) -> tuple[Panel, ...]:
    """Return the three views of a picture, below `top`.

    The room above the last one is for the key.
    """
    low, high = _bounds(picture)
    size = np.maximum(high - low, _SMALLEST)
    scale = min((PANEL - 2.0 * _MARGIN) / size[:2].max(), _MAX_HEIGHT / size[1:].sum())
    rest = tuple((low + high) / 2.0), scale
    upper, lower = (length * scale + 2.0 * _MARGIN + TITLE for length in size[1:])
    upper = max(upper, _KEY_HEIGHT)
    return (
        Panel(*_TOP, 0.0, top, upper, *rest),
        Panel(*_SIDE, 0.0, top + upper, lower, *rest),
        Panel(*_FRONT, PANEL, top + upper, lower, *rest),
    )


def _bounds(picture: Picture) -> tuple[_Points, _Points]:
    """Return the least and the largest coordinates (m) of what a picture shows, in the frame."""
    points = [outline_body(body) for body in picture.scene.bodies + picture.outlines]
    shown = [frame.pose for frame in list_frames(picture)]
    origins = [pose.translation for pose in (*shown, *picture.frames)]
    points.append(origins or [(0.0, 0.0, 0.0)])
    every = np.concatenate(points)
    low = every.min(axis=0)
    high = every.max(axis=0)
    if picture.scene.ground:
        far = _FAR * (high - low).max()
        height = picture.scene.ground.translation[2]
        if low[2] - far <= height <= high[2] + far:
            low[2], high[2] = min(low[2], height), max(high[2], height)
    return low, high


class _LinkFrame(NamedTuple):
    """The frame of a link.

    It has its pose in the frame of the scene, and the smallest size (m) of the link's shapes,
    which its axes must not cover; None without shapes.
    """

    pose: Transform
    size: float | None


def list_frames(picture: Picture) -> list[_LinkFrame]:
    """Return the frames that are shown.

    They are those of links with callouts or shapes, or of all links if there are no shapes.
    """
    scene = picture.scene
    called = [callout.link for callout in picture.callouts]
    sizes: dict[str, float] = {}
    for body in scene.bodies:
        sizes[body.link] = min(_smallest_size(body), sizes.get(body.link, inf))
    links = dict.fromkeys([scene.frame, scene.root, *called, *(sizes or scene.poses)])
    frames = [
        _LinkFrame(scene.poses[link], sizes.get(link)) for link in links if link in scene.poses
    ]
    return frames[: _MAX_FRAMES if scene.bodies else _MAX_FRAMES_ALONE]


def _smallest_size(body: Body) -> float:
    """Return the smallest size of a body, in metres."""
    shape = body.shape
    if isinstance(shape, Box):
        return min(shape.size)
    if isinstance(shape, Sphere):
        return 2.0 * shape.radius
    return min(2.0 * shape.radius, shape.length)


class FreePlaces:
    """The rectangles of a panel that labels have taken."""

    def __init__(self, panel: Panel) -> None:
        self._panel = panel
        self._taken: list[tuple[float, ...]] = []

    def take(self, centres: Iterable[Place], size: Place) -> Place | None:
        """Take the first of some centres at which a label of a size is in the panel and free.

        It is None without one.
        """
        panel, (across, down) = self._panel, size
        for x, y in centres:
            is_inside = across / 2.0 <= x - panel.left <= PANEL - across / 2.0
            is_inside &= TITLE + down / 2.0 <= y - panel.top <= panel.height - down / 2.0
            if is_inside and all(
                2.0 * abs(x - a) >= across + width or 2.0 * abs(y - b) >= down + height
                for a, b, width, height in self._taken
            ):
                self._taken.append((x, y, across, down))
                return x, y
        return None
