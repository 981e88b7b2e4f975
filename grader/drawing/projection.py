"""A scene in one view: bodies from back to front, and the visible and hidden pieces of their edges."""

from collections.abc import Iterable, Iterator, Sequence
from math import hypot
from typing import NamedTuple

from grader.drawing.covered_arcs import covered_arc
from grader.drawing.covered_lines import covered_line
from grader.drawing.curves import Curve, Line, Piece, edges
from grader.drawing.order import Seen, overlapping, painted
from grader.drawing.scene import Body, Rgba, Scene
from grader.drawing.views import View

_TRANSPARENT = 0.05  # a body with less alpha hides nothing
_SHORT = 1e-5  # metres: shorter pieces are not drawn


class Stroke(NamedTuple):
    """A piece of an edge, and the colour behind it in the drawing: that of its body, or of the body that hides it."""

    curve: Curve
    rgba: Rgba


class Projection(NamedTuple):
    """The content of one view of a scene. `bodies` are from back to front; `hidden` strokes are behind or inside of bodies.

    `is_complete` is false if too many bodies overlap: then all edges that face the viewer count as visible.
    """

    view: View
    bodies: tuple[Seen, ...]
    visible: tuple[Stroke, ...]
    hidden: tuple[Stroke, ...]
    is_complete: bool = True


def projection(scene: Scene, view: View) -> Projection:
    """Return the content of a view of a scene."""
    seen = seen_in(scene, scene.bodies, view)
    found = overlapping(seen)
    pairs = found or []
    behind: dict[int, list[Seen]] = {}
    for one, other in pairs:
        behind.setdefault(one, []).append(seen[other])
        behind.setdefault(other, []).append(seen[one])
    visible: list[Stroke] = []
    hidden: list[Stroke] = []
    for index, body in enumerate(seen):
        others = [other for other in behind.get(index, ()) if other.body.rgba[3] >= _TRANSPARENT]
        _add_strokes(body, others, visible, hidden)
    shown = {_key(stroke.curve): stroke for stroke in visible}
    unshown = {_key(stroke.curve): stroke for stroke in hidden if _key(stroke.curve) not in shown}
    bodies = tuple(seen[index] for index in painted(seen, pairs))
    return Projection(view, bodies, tuple(shown.values()), tuple(unshown.values()), found is not None)


def seen_in(scene: Scene, bodies: Iterable[Body], view: View) -> list[Seen]:
    """Return the bodies of a scene in a view."""
    return [Seen.of(body, view.T_view_frame @ scene.pose(body)) for body in bodies]


def _add_strokes(seen: Seen, others: Sequence[Seen], visible: list[Stroke], hidden: list[Stroke]) -> None:
    """Add the edges of a body. Pieces that other bodies or the body itself cover are hidden."""
    own = seen.body.rgba
    for curve, faces_viewer in edges(seen.body.shape, seen.pose):
        extents = curve.extents()
        near = [other for other in others if other.may_cover(extents)]
        covered = [(piece, other) for other in near for piece in _covered(other, curve)]
        if not faces_viewer:
            front = max((other for _, other in covered), key=_front, default=None)
            hidden += _strokes(curve, [(0.0, 1.0)], front.body.rgba if front is not None else own)
            continue
        rest = 0.0
        for start, end, rgba in _merged(covered):
            visible += _strokes(curve, [(rest, start)], own)
            hidden += _strokes(curve, [(start, end)], rgba)
            rest = end
        visible += _strokes(curve, [(rest, 1.0)], own)


def _covered(seen: Seen, curve: Curve) -> Iterable[Piece]:
    return covered_line(seen.cover, curve) if isinstance(curve, Line) else covered_arc(seen.cover, curve)


def _front(seen: Seen) -> float:
    return seen.extents[2][1]


def _merged(covered: list[tuple[Piece, Seen]]) -> Iterator[tuple[float, float, Rgba]]:
    """Yield the union of covered pieces in ascending order, each with the colour of the body in front."""
    start, end, front = 0.0, -1.0, None
    for (one, other), seen in sorted(covered, key=lambda pair: pair[0]):
        if front is not None and one <= end:
            end, front = max(end, other), max(front, seen, key=_front)
            continue
        if front is not None:
            yield start, end, front.body.rgba
        start, end, front = one, other, seen
    if front is not None:
        yield start, end, front.body.rgba


def _strokes(curve: Curve, pieces: list[Piece], rgba: Rgba) -> Iterator[Stroke]:
    for start, end in pieces:
        piece = curve.cut(start, end) if (start, end) != (0.0, 1.0) else curve
        if end > start and _length(piece) > _SHORT:
            yield Stroke(piece, rgba)


def _length(curve: Curve) -> float:
    if isinstance(curve, Line):
        return hypot(curve.end[0] - curve.start[0], curve.end[1] - curve.start[1])
    return abs(curve.end - curve.start) * hypot(*curve.major[:2])


def _key(curve: Curve) -> tuple[object, ...]:
    """Return a key that is equal for curves that look the same."""
    if isinstance(curve, Line):
        return tuple(sorted((_rounded(curve.start), _rounded(curve.end))))
    return (_rounded(curve.centre), _rounded(curve.at(0.0)), _rounded(curve.at(0.5)), _rounded(curve.at(1.0)))


def _rounded(point: Sequence[float]) -> tuple[float, float]:
    return round(point[0] / 1e-5) * 1e-5 + 0.0, round(point[1] / 1e-5) * 1e-5 + 0.0
