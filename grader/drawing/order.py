"""The order in which shapes are painted: each shape after those that it hides."""

from collections.abc import Iterable, Iterator, Sequence
from heapq import heapify, heappop, heappush
from typing import NamedTuple

from grader.drawing.cover import Cover
from grader.drawing.curves import Curve, Extents, outline
from grader.drawing.scene import Body
from grader.drawing.views import AXES
from grader.robot.separation import separation
from grader.robot.shapes import extent
from grader.robot.transforms import Transform

MAX_PAIRS = 600  # shapes that overlap in a view: more are ordered by their depth, and hide nothing
_SAME = 1e-6  # metres
_MAJORITY = 3  # places at which one body is in front of the other, more than the other way round
_INSIDE = (0.95, 0.5)  # of the way from the centre of a shape to its outline


class Seen(NamedTuple):
    """A body in a view with T_view_shape, its closed outline, and its extents along x, y and z."""

    body: Body
    pose: Transform
    outline: tuple[Curve, ...]
    extents: Extents
    cover: Cover

    @classmethod
    def of(cls, body: Body, pose: Transform) -> "Seen":
        """Return a body in a view with T_view_shape."""
        extents = tuple(extent(body.shape, pose, axis) for axis in AXES)
        return cls(body, pose, outline(body.shape, pose), extents, Cover.of(body.shape, pose))

    def overlaps(self, other: Extents) -> bool:
        """Return whether the rectangle around the body overlaps another one in the view."""
        (a, b), (c, d), _ = self.extents
        (e, f), (g, h), _ = other
        return a < f - _SAME and e < b - _SAME and c < h - _SAME and g < d - _SAME

    def may_cover(self, other: Extents) -> bool:
        """Return whether something with these extents may be behind the body, or inside of it."""
        (a, b), (c, d), (_, near) = self.extents
        (e, f), (g, h), (far, _) = other
        return near > far + _SAME and a < f and e < b and c < h and g < d


def overlapping(seen: Sequence[Seen]) -> list[tuple[int, int]] | None:
    """Return the pairs of bodies whose rectangles overlap, by position; None if there are too many."""
    ordered = sorted(range(len(seen)), key=lambda index: seen[index].extents[0][0])
    pairs: list[tuple[int, int]] = []
    active: list[int] = []
    for index in ordered:
        left = seen[index].extents[0][0]
        active = [other for other in active if seen[other].extents[0][1] > left]
        pairs += [(other, index) for other in active if seen[index].overlaps(seen[other].extents)]
        if len(pairs) > MAX_PAIRS:
            return None
        active.append(index)
    return pairs


def painted(seen: Sequence[Seen], pairs: Iterable[tuple[int, int]]) -> list[int]:
    """Return the positions of bodies from back to front; `pairs` are the bodies that overlap.

    Where three bodies hide each other in turn, the one whose front is farthest comes first.
    """
    hides: list[list[int]] = [[] for _ in seen]
    waits = [0] * len(seen)
    for one, other in pairs:
        nearer = _in_front(seen[one], seen[other])
        if nearer:
            back, front = (other, one) if nearer > 0.0 else (one, other)
            hides[back].append(front)
            waits[front] += 1
    return [*_sorted(hides, waits, [body.extents[2][1] for body in seen])]


def _sorted(hides: Sequence[Sequence[int]], waits: list[int], depths: Sequence[float]) -> Iterator[int]:
    rest = dict.fromkeys(sorted(range(len(depths)), key=lambda index: (depths[index], index)))
    ready = [(depths[index], index) for index in rest if waits[index] == 0]
    heapify(ready)
    while rest:
        index = heappop(ready)[1] if ready else next(iter(rest))
        if index not in rest:
            continue
        del rest[index]
        yield index
        for front in hides[index]:
            waits[front] -= 1
            if waits[front] == 0 and front in rest:
                heappush(ready, (depths[front], front))


def _in_front(one: Seen, other: Seen) -> float:
    """Return a positive number if one body hides the other, a negative one if it is hidden, 0 for neither."""
    (far, near), (other_far, other_near) = one.extents[2], other.extents[2]
    if far >= other_near - _SAME or other_far >= near - _SAME:
        return (far + near) - (other_far + other_near)
    votes = 0
    for x, y in (*_places(one), *_places(other)):
        depth, other_depth = one.cover.depth(x, y), other.cover.depth(x, y)
        if depth is not None and other_depth is not None and abs(depth - other_depth) > 2e-4:
            votes += 1 if depth > other_depth else -1
        if abs(votes) == _MAJORITY:
            break
    if votes:
        return votes
    gap = separation(one.body.shape, one.pose, other.body.shape, other.pose)
    return -gap.direction[2] if abs(gap.direction[2]) > _SAME else 0.0


def _places(seen: Seen) -> Iterator[tuple[float, float]]:
    """Yield places inside the outline of a body."""
    x, y, _ = seen.pose.translation
    yield x, y
    for curve in seen.outline:
        for share in (0.0, 0.5):
            u, v, _ = curve.at(share)
            yield from ((x + way * (u - x), y + way * (v - y)) for way in _INSIDE)
