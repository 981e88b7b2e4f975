"""Positions for labels: near what they label, without overlaps."""

from collections.abc import Iterable
from itertools import product
from math import cos, hypot, sin, tau
from typing import NamedTuple

from grader.drawing.sheet import TITLE, Panel, Place

_RINGS = (22.0, 30.0, 40.0, 52.0, 66.0, 84.0, 106.0, 132.0)  # pixels from what is labelled
_DIRECTIONS = 16
_ANGLES = [tau * (direction + 2) / _DIRECTIONS for direction in range(_DIRECTIONS)]  # up and to the right first
AROUND = [(ring * cos(angle), -ring * sin(angle)) for ring, angle in product(_RINGS, _ANGLES)]
_STEP = 4.0  # pixels between the points at which a leader line is compared with rectangles


class Rectangle(NamedTuple):
    """A rectangle on the sheet, in pixels."""

    left: float
    top: float
    right: float
    bottom: float

    @classmethod
    def around(cls, places: Iterable[Place], margin: float) -> "Rectangle":
        """Return the rectangle around places, with a margin."""
        xs, ys = zip(*places, strict=True)
        return cls(min(xs) - margin, min(ys) - margin, max(xs) + margin, max(ys) + margin)

    def overlaps(self, other: "Rectangle") -> bool:
        """Return whether two rectangles have an area in common."""
        return (
            self.left < other.right and other.left < self.right and self.top < other.bottom and other.top < self.bottom
        )

    def contains(self, place: Place) -> bool:
        """Return whether a place is inside."""
        return self.left < place[0] < self.right and self.top < place[1] < self.bottom


class Labels:
    """The labels of one panel: the rectangles that they have taken, and those of signs that they should not cover."""

    def __init__(self, panel: Panel) -> None:
        self._room = Rectangle(panel.left, panel.top + TITLE, panel.left + panel.width, panel.top + panel.height)
        self._taken: list[Rectangle] = []
        self._marks: list[Rectangle] = []

    def mark(self, places: Iterable[Place], margin: float = 2.0) -> None:
        """Record a sign that labels should not cover."""
        self._marks.append(Rectangle.around(places, margin))

    def put(self, place: Place, shifts: Iterable[Place], size: Place) -> Place | None:
        """Put a label of a width and height near a place and return its centre; None without a free place.

        It overlaps no other label. Of the free places, that with the lowest cost is taken: its distance, and the signs
        that it covers. The shifts to the places are sorted by their length.
        """
        best, lowest = None, 1e6
        for across, down in shifts:
            distance = hypot(across, down)
            if distance >= lowest:  # nothing farther away costs less
                break
            x, y = place[0] + across, place[1] + down
            box = Rectangle(x - size[0] / 2.0, y - size[1] / 2.0, x + size[0] / 2.0, y + size[1] / 2.0)
            cost = distance + self._cost(place, (x, y), box) if self._is_free(box) else lowest
            if cost < lowest:
                best, lowest, taken = (x, y), cost, box
        if best is not None:
            self._taken.append(taken)
        return best

    def _cost(self, place: Place, centre: Place, box: Rectangle) -> float:
        """Return the cost of a label: the signs that it covers, and the labels that its leader line crosses."""
        covered = sum(30.0 for mark in self._marks if box.overlaps(mark))
        leader = Rectangle.around((place, centre), 0.0)
        near = [other for other in self._taken if other.overlaps(leader)]
        if not near:
            return covered
        across, down = centre[0] - place[0], centre[1] - place[1]
        steps = max(1, round(hypot(across, down) / _STEP))
        line = [(place[0] + across * step / steps, place[1] + down * step / steps) for step in range(2, steps)]
        return covered + sum(40.0 for other in near if any(map(other.contains, line)))

    def _is_free(self, box: Rectangle) -> bool:
        room = self._room
        if box.left < room.left or box.right > room.right or box.top < room.top or box.bottom > room.bottom:
            return False
        return not any(box.overlaps(other) for other in self._taken)
