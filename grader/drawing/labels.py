"""Positions for labels: near what they label, without overlaps."""

from collections.abc import Iterable
from itertools import product
from math import cos, hypot, sin, tau
from typing import NamedTuple

from grader.drawing.sheet import TITLE, Panel, Place

_RINGS = (22.0, 30.0, 40.0, 52.0, 66.0, 84.0, 106.0, 132.0)  # pixels from what is labelled
_DIRECTIONS = 16
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

    def take(self, place: Place, width: float, height: float) -> bool:
        """Put a label with its centre at a place if it is free; return whether it is."""
        x, y = place
        box = Rectangle(x - width / 2, y - height / 2, x + width / 2, y + height / 2)
        if not self._is_free(box):
            return False
        self._taken.append(box)
        return True

    def put_near(self, place: Place, size: float) -> Place:
        """Put a square label near a place and return its centre.

        It overlaps no other label. Of the free places, that with the lowest cost is taken: its distance, and the signs
        that it covers.
        """
        best, lowest = place, 1e6
        for ring, direction in product(_RINGS, range(_DIRECTIONS)):
            if ring >= lowest:  # nothing farther away costs less
                break
            angle = tau * (direction + 2) / _DIRECTIONS  # up and to the right first
            centre = place[0] + ring * cos(angle), place[1] - ring * sin(angle)
            box = Rectangle.around([centre], size / 2.0 + 1.0)
            cost = ring + self._cost(place, centre, box) if self._is_free(box) else lowest
            if cost < lowest:
                best, lowest = centre, cost
        self._taken.append(Rectangle.around([best], size / 2.0))
        return best

    def _cost(self, place: Place, centre: Place, box: Rectangle) -> float:
        """Return the cost of a label: the signs that it covers, and the labels that its leader line crosses."""
        covered = sum(30.0 for mark in self._marks if box.overlaps(mark))
        across, down = centre[0] - place[0], centre[1] - place[1]
        steps = max(1, round(hypot(across, down) / _STEP))
        line = [(place[0] + across * step / steps, place[1] + down * step / steps) for step in range(2, steps)]
        return covered + sum(40.0 for other in self._taken if any(map(other.contains, line)))

    def _is_free(self, box: Rectangle) -> bool:
        room = self._room
        if box.left < room.left or box.right > room.right or box.top < room.top or box.bottom > room.bottom:
            return False
        return not any(box.overlaps(other) for other in self._taken)
