"""A scene in one view: bodies from back to front, each painted over those behind it."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from grader.drawing.curves import Curve, Extents, outline
from grader.drawing.scene import Body, Scene
from grader.drawing.views import AXES, View
from grader.robot.shapes import extent
from grader.robot.transforms import Transform

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

    The depth of a body is that of its nearest point. Bodies that are slanted can be painted in the wrong order: an exact one needs
    the depths at each place of the view.
    """
    return sorted(seen_in(scene, scene.bodies, view), key=lambda seen: seen.extents[2][1])


def seen_in(scene: Scene, bodies: Iterable[Body], view: View) -> list[Seen]:
    """Return bodies of a scene in a view."""
    found = ((body, view.T_view_frame @ scene.pose(body)) for body in bodies)
    return [
        Seen(body, pose, outline(body.shape, pose), tuple(extent(body.shape, pose, axis) for axis in AXES))
        for body, pose in found
    ]


def with_fronts(bodies: Sequence[Seen]) -> Iterator[tuple[Seen, list[Seen]]]:
    """Yield the bodies of a projection, each with those in front of it whose rectangles in the view overlap its own."""
    rows = [(*seen.extents[0], *seen.extents[1], seen) for seen in bodies]
    for number, (a, b, c, d, seen) in enumerate(rows, 1):
        fronts = [
            other
            for e, f, g, h, other in rows[number:]
            if a < f - _SAME and e < b - _SAME and c < h - _SAME and g < d - _SAME
        ]
        yield seen, [other for other in fronts if other.body.rgba[3] >= _TRANSPARENT][-_MAX_FRONTS:]
