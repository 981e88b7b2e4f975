"""The signs of a drawing: ground, frames, driving directions of wheels, outlines of the reference, numbers."""

from collections.abc import Iterable, Iterator
from math import hypot
from typing import Any

from grader.drawing.curves import AXES
from grader.drawing.labels import Labels
from grader.drawing.picture import Picture
from grader.drawing.sheet import Panel, Place, project
from grader.report.svg_elements import circle, path_data, put, segments
from grader.robot.transforms import Transform, Vector

_AXIS = 20.0  # pixels
_LONG_AXIS = 32.0  # of a frame of the reference, so that it is visible beside the robot's own
_LETTER = 7.0  # behind the tip of an axis
_ARROW = 30.0
_HEAD = 6.0
_RADIUS = 9.0  # of a number
_END_ON = 0.2  # of its length: an axis that appears shorter is a dot
_SAME = 0.001  # metres
_AXES = tuple(zip("xyz", AXES, strict=True))
_NO_HALO = ("ground", "dot-x", "dot-y", "dot-z")


class Signs:
    """The signs of one view: path data and texts by look, so that the attributes of each look are written once."""

    def __init__(self) -> None:
        self._paths: dict[str, dict[str, None]] = {}
        self._texts: dict[str, list[tuple[Place, str]]] = {}

    def line(self, look: str, data: str) -> None:
        """Record path data, each once."""
        self._paths.setdefault(look, {})[data] = None

    def text(self, look: str, place: Place, text: str) -> None:
        """Record a text; its place is on its base line."""
        self._texts.setdefault(look, []).append((place, text))

    def put(self, group: Any) -> None:
        """Add all signs, the lines with a halo that separates them from what is below."""
        halo = [path for look, paths in self._paths.items() if look not in _NO_HALO for path in paths]
        if halo:
            put(group, "path", "halo", {"d": "".join(halo)})
        for look, paths in self._paths.items():
            put(group, "path", look, {"d": "".join(paths)})
        for look, texts in self._texts.items():
            lines = put(group, "g", look)
            for (x, y), text in texts:
                put(lines, "text", "", {"x": x, "y": y}, text)


def add_ground(signs: Signs, cell: Panel, picture: Picture, labels: Labels) -> None:
    """Add the ground as a line if it is seen edge-on, and that of the reference if it differs."""
    ground = picture.scene.ground
    line = _ground_line(cell, ground) if ground is not None else None
    if line is not None:
        signs.line("ground", segments([line]))
        place = line[0][0] + 15.0, line[0][1] + 11.0
        labels.take(place, 40.0, 12.0)
        signs.text("letter", place, "ground")
    expected = picture.reference.ground if picture.reference is not None else None
    if expected is not None and ground is not None and is_lifted(expected, ground):
        line = _ground_line(cell, expected)
        if line is not None:
            signs.line("reference", segments([line]))


def is_lifted(one: Transform, other: Transform) -> bool:
    """Return whether two grounds differ in height."""
    return abs(one.translation[2] - other.translation[2]) > _SAME


def _ground_line(cell: Panel, ground: Transform) -> tuple[Place, Place] | None:
    """Return both ends of the plane z = 0 of a frame in a cell, if it is seen edge-on and crosses the cell."""
    across, down, depth = cell.direction(ground.rotate((0.0, 0.0, 1.0)))
    if abs(depth) > 1e-3 or abs(down) < 0.05:
        return None
    x, y = cell.place(ground.translation)
    ends = [(end, y - (end - x) * across / down) for end in (cell.left + 6.0, cell.left + cell.width - 6.0)]
    if not all(cell.top <= height <= cell.top + cell.height for _, height in ends):
        return None
    return ends[0], ends[1]


def add_outlines(signs: Signs, cell: Panel, picture: Picture, labels: Labels) -> None:
    """Add the dashed outlines of the reference, and its frames with their axes and letters."""
    if picture.reference is None:
        return
    for seen in project(picture.reference, picture.outlines, cell.view):
        signs.line("reference", path_data(cell, seen.outline, closed=True))
        (a, b), (c, d), _ = seen.extents
        labels.mark([cell.on_sheet((a, c, 0.0)), cell.on_sheet((b, d, 0.0))])
    for link in picture.frames:
        pose = picture.reference.poses[link]
        if link in picture.scene.poses and _look_of(cell, pose) == _look_of(cell, picture.scene.poses[link]):
            continue  # in this view it covers the robot's own
        start = cell.place(pose.translation)
        for name, axis in _AXES:
            tip, length = _tip(cell, start, pose.rotate(axis), _LONG_AXIS)
            if length > _END_ON:
                signs.line("reference", segments([(start, tip)]))
                _add_letter(signs, labels, start, tip, name)


def add_frames(signs: Signs, cell: Panel, picture: Picture, labels: Labels, links: Iterable[str]) -> None:
    """Add the frames of links with their axes and letters; of frames that look the same, only one."""
    shown: set[object] = set()
    for link in links:
        pose = picture.scene.poses[link]
        look = _look_of(cell, pose)
        if look not in shown:
            shown.add(look)
            _add_frame(signs, cell, pose, labels)


def _look_of(cell: Panel, pose: Transform) -> tuple[int, ...]:
    """Return a key that is equal for frames that look the same in a cell."""
    seen = (value for _, axis in _AXES for value in cell.direction(pose.rotate(axis)))
    return (*map(round, cell.place(pose.translation)), *(round(10.0 * value) for value in seen))


def _add_frame(signs: Signs, cell: Panel, pose: Transform, labels: Labels) -> None:
    start = cell.place(pose.translation)
    for name, axis in _AXES:
        tip, length = _tip(cell, start, pose.rotate(axis))
        if length > _END_ON:
            signs.line(f"axis-{name}", segments([(start, tip)]))
            labels.mark([start, tip])
            _add_letter(signs, labels, start, tip, name)
        elif cell.direction(pose.rotate(axis))[2] > 0.0:
            signs.line(f"dot-{name}", circle(start, 3.0))  # to the viewer
        else:
            signs.line(f"axis-{name}", circle(start, 2.5))


def _add_letter(signs: Signs, labels: Labels, start: Place, tip: Place, name: str) -> None:
    """Add the letter of an axis behind its tip, unless another one is there."""
    long = hypot(tip[0] - start[0], tip[1] - start[1])
    way = 1.0 + _LETTER / long
    place = start[0] + (tip[0] - start[0]) * way, start[1] + (tip[1] - start[1]) * way
    if labels.take(place, 9.0, 11.0):
        signs.text("letter", (place[0], place[1] + 3.5), name)


def _tip(cell: Panel, start: Place, axis: Vector, length: float = _AXIS) -> tuple[Place, float]:
    """Return the end of an axis on the sheet, and its apparent share of its length."""
    x, y, _ = cell.direction(axis)
    return (start[0] + length * x, start[1] + length * y), hypot(x, y)


def add_wheels(signs: Signs, cell: Panel, picture: Picture, labels: Labels) -> None:
    """Add an arrow at each wheel for its driving direction; a circle with a slash if it does not roll."""
    for wheel in picture.scene.wheels:
        start = cell.place(wheel.centre)
        travel = cell.direction(wheel.travel) if wheel.travel else None
        signs.line("arrow", wheel_sign(start, travel))
        across, down, _ = travel or (0.0, 0.0, 0.0)
        labels.mark([start, (start[0] + _ARROW * across, start[1] + _ARROW * down)], 5.0)


def wheel_sign(start: Place, travel: Vector | None) -> str:
    """Return the path of an arrow in a direction on the sheet; to or from the viewer a dot or a cross in a circle."""
    x, y = start
    if travel is None:
        return circle(start, 8.0) + segments([((x - 5.6, y + 5.6), (x + 5.6, y - 5.6))])
    across, down, depth = travel
    if hypot(across, down) < _END_ON:
        return circle(start, 7.0) + (circle(start, 1.2) if depth > 0.0 else segments(_cross(start, 4.0)))
    tip = x + _ARROW * across, y + _ARROW * down
    back, side = (-_HEAD * across, -_HEAD * down), (-_HEAD * 0.7 * down, _HEAD * 0.7 * across)
    barbs = [(tip, (tip[0] + back[0] + sign * side[0], tip[1] + back[1] + sign * side[1])) for sign in (1.0, -1.0)]
    return segments([(start, tip), *barbs])


def _cross(middle: Place, half: float) -> Iterator[tuple[Place, Place]]:
    x, y = middle
    yield (x - half, y - half), (x + half, y + half)
    yield (x - half, y + half), (x + half, y - half)


def add_callouts(signs: Signs, cell: Panel, picture: Picture, labels: Labels) -> None:
    """Add the numbers of callouts beside their points, with leader lines, none over another."""
    points = [(callout.number, cell.place(callout.point)) for callout in picture.callouts if callout.point is not None]
    for _, point in points:
        labels.mark([point], 5.0)
    for number, point in points:
        centre = labels.put_near(point, 2.0 * _RADIUS + 2.0)
        signs.line("leader", segments([(point, centre)]) + circle(point, 1.5))
        add_badge(signs, centre, number)


def add_badge(signs: Signs, centre: Place, number: int) -> None:
    """Add a number in a disc."""
    signs.line("badge", circle(centre, _RADIUS))
    signs.text("number", (centre[0], centre[1] + 4.2), str(number))
