"""The signs of a drawing: ground, frames with axes, the way wheels drive, the reference's outlines, numbers where criteria failed."""

from collections.abc import Iterator, Sequence
from math import hypot
from typing import Any

from grader.drawing.labels import Labels
from grader.drawing.order import Seen
from grader.drawing.picture import Picture
from grader.drawing.projection import seen_in
from grader.drawing.scene import Scene, Wheel
from grader.drawing.sheet import Cell, Place, framed_links
from grader.report.svg_elements import number, path_data, put, segments
from grader.robot.transforms import Transform, Vector

AXIS = 22.0  # pixels
_ARROW = 30.0
_HEAD = 6.0
_RADIUS = 9.0  # of a number
_END_ON = 0.2  # of its length: an axis that is seen shorter is a dot
_SAME = 0.001  # metres
_DIRECTIONS: tuple[tuple[str, Vector], ...] = (("x", (1.0, 0.0, 0.0)), ("y", (0.0, 1.0, 0.0)), ("z", (0.0, 0.0, 1.0)))


def put_ground(group: Any, cell: Cell, picture: Picture) -> None:
    """Add the ground as a line where it is seen from its edge, and that of the reference where it differs."""
    ground = picture.scene.ground
    drawn = _ground_line(cell, ground) if ground is not None else None
    if drawn is not None:
        put(group, "path", "ground", {"d": segments([drawn])})
        (x, y), _ = drawn
        put(group, "text", "letter", {"x": x + 16.0, "y": y + 12.0}, "ground")
    expected = picture.reference.ground if picture.reference is not None else None
    if expected is not None and ground is not None and _differ(expected, ground):
        line = _ground_line(cell, expected)
        if line is not None:
            put(group, "path", "reference", {"d": segments([line])})


def _ground_line(cell: Cell, ground: Transform) -> tuple[Place, Place] | None:
    """Return both ends of the plane z = 0 of a frame in a cell, if it is seen from its edge and crosses the cell."""
    across, down, depth = cell.direction(ground.rotate((0.0, 0.0, 1.0)))
    if abs(depth) > 1e-3 or abs(down) < 0.05:
        return None
    x, y = cell.place(ground.translation)
    left, right = cell.left + 6.0, cell.left + cell.width - 6.0
    ends = [(end, y - (end - x) * across / down) for end in (left, right)]
    if not all(cell.top <= height <= cell.top + cell.height for _, height in ends):
        return None
    return ends[0], ends[1]


def _differ(one: Transform, other: Transform) -> bool:
    return abs(one.translation[2] - other.translation[2]) > _SAME


def put_outlines(group: Any, cell: Cell, picture: Picture, labels: Labels) -> None:
    """Add the dashed outlines and frames of the reference."""
    if picture.reference is None:
        return
    paths = [path_data(cell, seen.outline, closed=True) for seen in outlines(picture, cell)]
    for link in picture.frames:
        pose = picture.reference.poses[link]
        start = cell.place(pose.translation)
        tips = [_tip(cell, start, pose.rotate(axis)) for _, axis in _DIRECTIONS]
        paths += [segments([(start, tip)]) for tip, length in tips if length > _END_ON]
        labels.mark([start])
    for path in dict.fromkeys(filter(None, paths)):
        put(group, "path", "halo", {"d": path})
        put(group, "path", "reference", {"d": path})


def outlines(picture: Picture, cell: Cell) -> list[Seen]:
    """Return the bodies of the reference that are outlined, as they are seen in a cell."""
    return seen_in(picture.reference, picture.outlines, cell.view) if picture.reference is not None else []


def put_frames(group: Any, cell: Cell, picture: Picture, labels: Labels) -> None:
    """Add the frames of links with their axes and letters, each that looks the same once."""
    shown: set[object] = set()
    for link in framed_links(picture):
        pose = picture.scene.poses[link]
        start = cell.place(pose.translation)
        key = tuple(round(value) for value in (*start, *(10.0 * part for part in pose.rotation)))
        if key not in shown:
            shown.add(key)
            _put_frame(put(group, "g"), cell, pose, labels)


def _put_frame(group: Any, cell: Cell, pose: Transform, labels: Labels) -> None:
    start = cell.place(pose.translation)
    tips = [(name, axis, *_tip(cell, start, pose.rotate(axis))) for name, axis in _DIRECTIONS]
    seen = [(name, tip) for name, _, tip, length in tips if length > _END_ON]
    put(group, "path", "halo", {"d": segments((start, tip) for _, tip in seen)})
    for name, axis, tip, length in tips:
        if length > _END_ON:
            put(group, "path", f"axis-{name}", {"d": segments([(start, tip)])})
            continue
        dot = put(group, "circle", f"axis-{name}", {"cx": start[0], "cy": start[1], "r": 2.5})
        if cell.direction(pose.rotate(axis))[2] > 0.0:
            dot.set("fill", dot.get("stroke", ""))  # to the viewer
    for name, tip in seen:
        labels.mark([start, tip])
        x, y = start[0] + (tip[0] - start[0]) * 1.35, start[1] + (tip[1] - start[1]) * 1.35
        if labels.take((x, y), 9.0, 11.0):
            put(group, "text", "letter", {"x": x, "y": y + 3.5}, name)


def _tip(cell: Cell, start: Place, axis: Vector) -> tuple[Place, float]:
    """Return where an axis ends on the sheet, and the part of its length that is seen."""
    x, y, _ = cell.direction(axis)
    return (start[0] + AXIS * x, start[1] + AXIS * y), hypot(x, y)


def put_wheels(group: Any, cell: Cell, scene: Scene, labels: Labels) -> None:
    """Add an arrow at each wheel for the way in which a positive turn drives, or a crossed circle if it does not roll."""
    for wheel in scene.wheels:
        put_wheel(group, cell.place(wheel.centre), cell.direction(wheel.travel) if wheel.travel else None)
        _mark_wheel(cell, wheel, labels)


def _mark_wheel(cell: Cell, wheel: Wheel, labels: Labels) -> None:
    x, y = cell.place(wheel.centre)
    across, down, _ = cell.direction(wheel.travel) if wheel.travel else (0.0, 0.0, 0.0)
    labels.mark([(x, y), (x + _ARROW * across, y + _ARROW * down)], 5.0)


def put_wheel(group: Any, start: Place, travel: Vector | None) -> None:
    """Add the sign of a wheel that drives in a direction on the sheet; None if it does not roll."""
    for look, width in (("halo", 6.5), ("arrow", 2.6)):
        put(group, "path", look, {"d": _wheel_sign(start, travel), "stroke-width": width})


def _wheel_sign(start: Place, travel: Vector | None) -> str:
    x, y = start
    if travel is None:
        return _circle(x, y, 8.0) + segments([((x - 5.6, y + 5.6), (x + 5.6, y - 5.6))])
    across, down, depth = travel
    if hypot(across, down) < _END_ON:
        inner = _circle(x, y, 1.2) if depth > 0.0 else segments(_cross(x, y, 4.0))
        return _circle(x, y, 7.0) + inner
    tip = x + _ARROW * across, y + _ARROW * down
    back, side = (-_HEAD * across, -_HEAD * down), (-_HEAD * 0.7 * down, _HEAD * 0.7 * across)
    barbs = [(tip, (tip[0] + back[0] + sign * side[0], tip[1] + back[1] + sign * side[1])) for sign in (1.0, -1.0)]
    return segments([(start, tip), *barbs])


def _circle(x: float, y: float, radius: float) -> str:
    r = number(radius)
    return (
        f"M{number(x - radius)} {number(y)}a{r} {r} 0 1 1 {number(2 * radius)} 0a{r} {r} 0 1 1 {number(-2 * radius)} 0"
    )


def _cross(x: float, y: float, half: float) -> Iterator[tuple[Place, Place]]:
    yield (x - half, y - half), (x + half, y + half)
    yield (x - half, y + half), (x + half, y - half)


def put_callouts(group: Any, cell: Cell, picture: Picture, labels: Labels) -> None:
    """Add the numbers of callouts beside their points, with leader lines, none over another."""
    points = [(callout.number, cell.place(callout.point)) for callout in picture.callouts if callout.point is not None]
    for _, point in points:
        labels.mark([point], 5.0)
    centres = [labels.put_near(point, 2.0 * _RADIUS + 2.0) for _, point in points]
    put_leaders(group, [(point, centre) for (_, point), centre in zip(points, centres, strict=True)])
    for (count, _), centre in zip(points, centres, strict=True):
        put_badge(group, centre, count)


def put_leaders(group: Any, lines: Sequence[tuple[Place, Place]]) -> None:
    """Add lines from points to numbers."""
    if lines:
        path = segments(lines) + "".join(_circle(x, y, 1.5) for (x, y), _ in lines)
        put(group, "path", "halo", {"d": path})
        put(group, "path", "leader", {"d": path})


def put_badge(group: Any, centre: Place, count: int) -> None:
    """Add a number in a disc."""
    put(group, "circle", "badge", {"cx": centre[0], "cy": centre[1], "r": _RADIUS})
    put(group, "text", "number", {"x": centre[0], "y": centre[1] + 4.2}, str(count))
