"""A small picture of a robot for a list of many.

It shows what one sees of its larger shapes, obliquely from above, in few numbers.
"""

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from grader.base.transforms import Vector, dot
from grader.report.drawing.picture import Body, Scene
from grader.report.drawing.views import (
    CIRCLE,
    CORNERS,
    PANEL,
    TITLE,
    Panel,
    hull,
    outline_body,
)
from grader.ros.api import Box, Capsule, Cylinder, Sphere

Still = tuple[tuple[str, str], ...]  # the colour and the path data of each face

WIDTH = 160
HEIGHT = 120
_MARGIN = 6
MAX_SIZE = 1_900  # characters
# The directions to the right, up and to the viewer, as in the first view in 3-D.
_RIGHT = (0.7833, 0.6216, 0.0)
_UP = (-0.2704, 0.3407, 0.9004)
_NEAR = (0.5597, -0.7053, 0.435)
_LIGHT = (0.36, -0.48, 0.8)
_EDGE_ON = 0.02  # of the length of the normal of a face


def draw_still(scene: Scene) -> Still:
    """Return the picture of a robot, from the back to the front; empty without shapes."""
    if not scene.bodies:
        return ()
    panel = _make_panel(scene)
    left = MAX_SIZE
    shown = dict[Body, list[tuple[str, str]]]()
    for body in sorted(scene.bodies, key=lambda one: -np.ptp(outline_body(one), axis=0).max()):
        faces = [_face(body, panel, normal, points) for normal, points in _list_faces(body)]
        size = sum(len(fill) + len(data) + 8 for fill, data in faces)
        if size <= left:
            left -= size
            shown[body] = faces
    return tuple(face for body in _from_back_to_front(shown) for face in shown[body])


def _from_back_to_front(bodies: Iterable[Body]) -> Iterator[Body]:
    """Yield bodies, each before those that hide it, as far as that is the same for all of it."""
    axes = np.array((_RIGHT, _UP))
    bounds = {}
    for body in bodies:
        points = outline_body(body)
        places, depths = points @ axes.T, points * np.sign(_NEAR)  # larger is nearer
        extents = [(values.min(axis=0), values.max(axis=0)) for values in (places, depths)]
        bounds[body] = extents[0] + extents[1]
    hidden = {}
    for body, own_bounds in bounds.items():
        hidden[body] = {other for other, others in bounds.items() if _hides(own_bounds, others)}
    while hidden:
        last = min(hidden, key=lambda body: len(hidden[body]))
        del hidden[last]
        for others in hidden.values():
            others.discard(last)
        yield last


def _hides(one: tuple[Any, ...], other: tuple[Any, ...]) -> bool:
    """Return whether a body is before another one that it overlaps in the picture."""
    left, right, far, near = one
    other_left, other_right, other_far, other_near = other
    if not (left < other_right).all() or not (other_left < right).all():
        return False
    return bool((far - other_near).max() > (other_far - near).max())


def _make_panel(scene: Scene) -> Panel:
    """Return the view in which a robot fills a picture."""
    axes = np.array((_RIGHT, _UP))
    places = np.concatenate([outline_body(body) for body in scene.bodies]) @ axes.T
    low = places.min(axis=0)
    high = places.max(axis=0)
    room = np.array((WIDTH, HEIGHT)) - 2.0 * _MARGIN
    scale = float((room / np.maximum(high - low, 1e-6)).min())
    x, y, z = ((low + high) / 2.0) @ axes
    corner = (WIDTH - PANEL) / 2.0, (HEIGHT - TITLE) / 2.0
    return Panel("", _RIGHT, _UP, _NEAR, *corner, 0.0, (float(x), float(y), float(z)), scale)


def _list_faces(body: Body) -> Iterator[tuple[Vector, Any]]:
    """Yield the faces of a body that one sees: the normal of each, and points whose hull it is."""
    shape = body.shape
    pose = body.T_frame_shape
    rotation = np.reshape(pose.rotation, (3, 3))
    if not isinstance(shape, Box):
        yield _NEAR, outline_body(body)
    for k, normal in enumerate(rotation.T):
        if isinstance(shape, Box):
            corners = CORNERS[CORNERS[:, k] > 0.0] * shape.size
        elif isinstance(shape, Cylinder) and k == 2:
            rim = CIRCLE * shape.radius
            corners = np.column_stack([rim, np.full(len(rim), shape.length / 2.0)])
        else:
            continue
        side = 1.0 if normal @ _NEAR > 0.0 else -1.0
        corners[:, k] *= side
        x, y, z = (side * normal).tolist()
        if dot((x, y, z), _NEAR) > _EDGE_ON:
            yield (x, y, z), corners @ rotation.T + pose.translation


def _face(body: Body, panel: Panel, normal: Vector, points: Any) -> tuple[str, str]:
    """Return a face: its colour in the light, and its outline in whole pixels."""
    light = 0.6 + 0.4 * max(0.0, dot(normal, _LIGHT))
    *rgb, alpha = body.rgba
    channels = [*(light * channel for channel in rgb), alpha]
    fill = "".join(f"{round(255.0 * channel):02x}" for channel in channels)
    outline = hull(np.round(panel.places(points)))
    if normal == _NEAR and isinstance(body.shape, Capsule | Sphere):
        outline = hull(np.round(panel.outline(body)))
    data = " ".join(f"{x:.0f} {y:.0f}" for x, y in outline)
    return f"#{fill.removesuffix('ff') if alpha == 1.0 else fill}", f"M{data}Z"
