"""Three orthographic views of a scene at one scale, as in third-angle projection, and free places for labels in them.

A box, a cylinder and a sphere are convex, so the outline of each in a view is the convex hull of its projected points.
Lengths on the sheet are pixels, and y points down.
"""

from collections.abc import Iterable
from itertools import product
from math import floor, log10
from typing import Any, NamedTuple

import numpy as np

from grader.drawing.picture import Picture
from grader.drawing.scene import Body, Scene
from grader.robot.model import Box, Sphere
from grader.robot.transforms import Vector

Place = tuple[float, float]
Points = Any  # an array of shape (n, 3), or (n, 2) in a view

WIDTH, TITLE = 600.0, 18.0
KEY_WIDTH, _KEY_HEIGHT = 226.0, 150.0
_MARGIN = 40.0  # around the robot in each view, for labels
_MAX_HEIGHT = 460.0  # of the top and the side view of the robot together
_MAX_BAR = 90.0
_SMALLEST = 0.02  # metres
_MAX_FRAMES = 12
_MAX_FRAMES_ALONE = 60  # where no shape is shown
_FAR = 2.0  # times the size of the robot: a ground farther away is not in the picture
_UNITS = ((1.0, "m"), (0.01, "cm"), (0.001, "mm"))
_ANGLES = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
_CIRCLE = np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)])
_CORNERS = np.array([*product((-0.5, 0.5), repeat=3)])
_CAPS = np.array([(x, y, z) for z in (-0.5, 0.5) for x, y in _CIRCLE])
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
    width: float
    height: float
    middle: Vector
    scale: float

    def direction(self, direction: Vector) -> Vector:
        """Return a direction of the frame on the sheet, with y down, and its component to the viewer."""
        x, y, z = np.array((self.right, self.up, self.near)) @ direction
        return float(x), -float(y), float(z)

    def places(self, points: Points) -> Points:
        """Return the positions of points of the frame on the sheet."""
        centre = self.left + self.width / 2.0, self.top + (TITLE + self.height) / 2.0
        across = (np.array(points) - self.middle) @ np.array((self.right, self.up)).T
        return centre + across * (self.scale, -self.scale)

    def place(self, point: Vector) -> Place:
        """Return the position of a point of the frame on the sheet."""
        x, y = self.places(point)
        return float(x), float(y)

    def outline(self, scene: Scene, body: Body) -> list[Place]:
        """Return the corners of the outline of a body."""
        if isinstance(body.shape, Sphere):
            return hull(self.places(scene.pose(body).translation) + _CIRCLE * body.shape.radius * self.scale)
        return hull(self.places(points_of(scene, body)))


def points_of(scene: Scene, body: Body) -> Points:
    """Return points of the frame whose hull is a body; of a sphere, those that are farthest along the axes."""
    pose, shape = scene.pose(body), body.shape
    if isinstance(shape, Sphere):
        return pose.translation + shape.radius * np.vstack([np.eye(3), -np.eye(3)])
    points = _CORNERS * shape.size if isinstance(shape, Box) else _CAPS * (shape.radius, shape.radius, shape.length)
    return points @ np.reshape(pose.rotation, (3, 3)).T + pose.translation


def hull(points: Points) -> list[Place]:
    """Return the convex hull of points on the sheet, to a tenth of a pixel (Andrew's monotone chain, 1979)."""
    ordered = sorted({(round(float(x), 1), round(float(y), 1)) for x, y in points})
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


def from_back_to_front(scene: Scene, panel: Panel) -> list[Body]:
    """Return the bodies by the depth of their nearest points; slanted ones that interlock may be in the wrong order."""
    return sorted(scene.bodies, key=lambda body: float((points_of(scene, body) @ panel.near).max()))


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
    """Return the sheet for a picture; its panels begin at `top`. The key is above the front view."""
    low, high = _bounds(picture)
    x, y, z = np.maximum(high - low, _SMALLEST)
    scale = min((WIDTH - 4.0 * _MARGIN) / (x + y), (WIDTH - KEY_WIDTH - 2.0 * _MARGIN) / x, _MAX_HEIGHT / (y + z))
    deep, tall = y * scale + 2.0 * _MARGIN, z * scale + 2.0 * _MARGIN + TITLE
    right, upper = max(deep, KEY_WIDTH), max(deep + TITLE, _KEY_HEIGHT)
    left, rest = WIDTH - right, (tuple((low + high) / 2.0), scale)
    panels = (
        Panel(*_TOP, 0.0, top, left, upper, *rest),
        Panel(*_SIDE, 0.0, top + upper, left, tall, *rest),
        Panel(*_FRONT, left, top + upper, right, tall, *rest),
    )
    return Sheet(panels, (left, top), top + upper + tall, scale)


def _bounds(picture: Picture) -> tuple[Points, Points]:
    """Return the least and the largest coordinates (m) of what a picture shows, in the frame."""
    shown = [([(0.0, 0.0, 0.0)])]
    for scene, bodies, links in (
        (picture.scene, picture.scene.bodies, framed_links(picture)),
        (picture.reference, picture.outlines, picture.frames),
    ):
        if scene is not None:
            shown += [points_of(scene, body) for body in bodies] + [[scene.poses[link].translation] for link in links]
    points = np.concatenate(shown)
    low, high = points.min(axis=0), points.max(axis=0)
    far = _FAR * (high - low).max()
    ground = picture.scene.ground
    if ground is not None and low[2] - far <= ground.translation[2] <= high[2] + far:
        low[2], high[2] = min(low[2], ground.translation[2]), max(high[2], ground.translation[2])
    return low, high


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


class FreePlaces:
    """The rectangles of a panel that labels have taken, and those of signs that they should not cover."""

    def __init__(self, panel: Panel) -> None:
        self._panel = panel.left, panel.top + TITLE, panel.left + panel.width, panel.top + panel.height
        self._taken: list[tuple[float, ...]] = []
        self._signs: list[tuple[float, ...]] = []

    def avoid(self, places: Iterable[Place], margin: float = 2.0) -> None:
        """Record a sign that labels should not cover."""
        xs, ys = zip(*places, strict=True)
        self._signs.append((min(xs) - margin, min(ys) - margin, max(xs) + margin, max(ys) + margin))

    def take(self, place: Place, shifts: Iterable[Place], size: Place) -> Place | None:
        """Take the first free place of a label near a place, and return its centre; None without one.

        One that covers a sign is taken only if there is no other; labels never overlap.
        """
        half, low_x, low_y, high_x, high_y = (size[0] / 2.0, size[1] / 2.0), *self._panel
        centres = [(place[0] + across, place[1] + down) for across, down in shifts]
        for others in ([*self._taken, *self._signs], self._taken):
            for x, y in centres:
                box = (x - half[0], y - half[1], x + half[0], y + half[1])
                is_inside = low_x <= box[0] and low_y <= box[1] and box[2] <= high_x and box[3] <= high_y
                if is_inside and not any(_overlap(box, other) for other in others):
                    self._taken.append(box)
                    return x, y
        return None


def _overlap(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]
