"""The three views of a drawing: directions in orthographic projection, arranged as in third-angle projection.

In a view x points to the right, y up and z to the viewer, all in metres.
"""

from typing import NamedTuple

from grader.robot.transforms import Rotation, Transform, Vector


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
AXES: tuple[Vector, Vector, Vector] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
VIEWER: Vector = (0.0, 0.0, 1.0)  # the direction to the viewer, in a view
