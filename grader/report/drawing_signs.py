"""The signs of a drawing: ground, frames, driving directions of wheels, outlines of the reference, numbers."""

from collections.abc import Iterable, Iterator
from math import hypot
from typing import Any

from grader.drawing.labels import AROUND, Labels
from grader.drawing.picture import Picture
from grader.drawing.sheet import Panel, Place, project
from grader.report.svg_elements import circle, path_data, put, segments
from grader.robot.transforms import AXES, Transform, Vector

_AXIS = 20.0  # pixels
_LONG_AXIS = 32.0  # of a frame of the reference, so that it is visible beside the robot's own
_LETTER = (9.0, 11.0)  # the room of one
# Where the letter of an axis is, from its tip: along the axis and to either side of it.
_SIDES = ((2.0, 8.0), (-5.0, 8.5), (-12.0, 8.5), (-12.0, 13.0))
_BESIDE = ((8.0, 0.0), *((along, way * side) for along, side in _SIDES for way in (1.0, -1.0)), (20.0, 0.0))
_ARROW = 30.0
_HEAD = 6.0
_RADIUS = 9.0  # of a number
_END_ON = 0.2  # of its length: an axis that appears shorter is a dot
_ASIDE = 7.0  # arrows in several directions at one place
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
        """Add the recorded signs, the lines with a halo that separates them from what is below, and forget them."""
        halo = [path for look, paths in self._paths.items() if look not in _NO_HALO for path in paths]
        if halo:
            put(group, "path", "halo", {"d": "".join(halo)})
        for look, paths in self._paths.items():
            put(group, "path", look, {"d": "".join(paths)})
        for look, texts in self._texts.items():
            lines = put(group, "g", look)
            for (x, y), text in texts:
                put(lines, "text", "", {"x": x, "y": y}, text)
        self._paths, self._texts = {}, {}

    def badge(self, centre: Place, number: int) -> None:
        """Record a number in a disc."""
        self.line("badge", circle(centre, _RADIUS))
        self.text("number", (centre[0], centre[1] + 4.2), str(number))


class ViewSigns(Signs):
    """The signs of a picture in one panel, with its labels."""

    def __init__(self, panel: Panel, picture: Picture) -> None:
        super().__init__()
        self._panel, self._picture, self._labels = panel, picture, Labels(panel)
        self._letters: list[tuple[Place, Place, str]] = []  # the ends of axes with their names
        self._names: list[tuple[Place, str]] = []

    def add_ground(self) -> None:
        """Add the ground as a line if it is seen edge-on, and that of the reference if it differs."""
        ground, expected = self._picture.scene.ground, lifted_ground(self._picture)
        if ground is None:
            return
        for start, end in self._ground_line(ground):
            self.line("ground", segments([(start, end)]))
            at = self._labels.put(start, [(22.0, 10.0), (22.0, -8.0)], (44.0, 12.0)) or start
            self._names.append(((at[0], at[1] + 2.0), "ground"))
            self._labels.mark([start, end], 1.0)
        if expected is not None:
            for line in self._ground_line(expected):
                self.line("reference", segments([line]))
                self._labels.mark(line, 1.0)

    def _ground_line(self, ground: Transform) -> Iterator[tuple[Place, Place]]:
        """Yield the ends of the plane z = 0 of a frame in the panel, if it is seen edge-on and crosses the panel."""
        panel = self._panel
        across, down, depth = panel.direction(ground.rotate((0.0, 0.0, 1.0)))
        if abs(depth) > 1e-3 or abs(down) < 0.05:
            return
        x, y = panel.place(ground.translation)
        left, right = panel.left + 6.0, panel.left + panel.width - 6.0
        start, end = ((end, y - (end - x) * across / down) for end in (left, right))
        if all(panel.top <= height <= panel.top + panel.height for _, height in (start, end)):
            yield start, end

    def add_outlines(self) -> None:
        """Add the dashed outlines of the reference, and its frames with their axes and letters."""
        panel, picture, reference = self._panel, self._picture, self._picture.reference
        if reference is None:
            return
        for seen in project(reference, picture.outlines, panel.view):
            self.line("reference", path_data(panel, seen.outline, closed=True))
            (a, b), (c, d), _ = seen.extents
            self._labels.mark([panel.on_sheet((a, c, 0.0)), panel.on_sheet((b, d, 0.0))])
        for link in picture.frames:
            pose, own = reference.poses[link], picture.scene.poses.get(link)
            if own is not None and self._look_of(pose) == self._look_of(own):
                continue  # in this view it covers the robot's own
            for name, start, tip, share, _ in self._axes(pose, _LONG_AXIS):
                if share > _END_ON:
                    self._add_axis("reference", start, tip, name)

    def add_frames(self, links: Iterable[str]) -> None:
        """Add the frames of links with their axes and letters; of frames that look the same, only one."""
        frames: dict[tuple[int, ...], Transform] = {}
        for link in links:
            pose = self._picture.scene.poses[link]
            frames.setdefault(self._look_of(pose), pose)
        for pose in frames.values():
            for name, start, tip, share, depth in self._axes(pose, _AXIS):
                if share > _END_ON:
                    self._add_axis(f"axis-{name}", start, tip, name)
                elif depth > 0.0:
                    self.line(f"dot-{name}", circle(start, 3.0))  # to the viewer
                else:
                    self.line(f"axis-{name}", circle(start, 2.5))

    def _axes(self, pose: Transform, length: float) -> Iterator[tuple[str, Place, Place, float, float]]:
        """Yield the name, the ends, the apparent share of its length and the depth of each axis of a frame."""
        start = self._panel.place(pose.translation)
        for name, axis in _AXES:
            x, y, depth = self._panel.direction(pose.rotate(axis))
            yield name, start, (start[0] + length * x, start[1] + length * y), hypot(x, y), depth

    def _look_of(self, pose: Transform) -> tuple[int, ...]:
        """Return a key that is equal for frames that look the same in the panel."""
        directions = (value for _, axis in _AXES for value in self._panel.direction(pose.rotate(axis)))
        return (*map(round, self._panel.place(pose.translation)), *(round(10.0 * value) for value in directions))

    def _add_axis(self, look: str, start: Place, tip: Place, name: str) -> None:
        self.line(look, segments([(start, tip)]))
        self._labels.mark([start, tip])
        self._letters.append((start, tip, name))

    def add_letters(self) -> None:
        """Add the name of the ground, and the letters of axes behind or beside their tips, unless others are there."""
        for start, tip, name in self._letters:
            across, down = tip[0] - start[0], tip[1] - start[1]
            long = hypot(across, down)
            shifts = [((a * across - b * down) / long, (a * down + b * across) / long) for a, b in _BESIDE]
            place = self._labels.put(tip, shifts, _LETTER)
            if place is not None:
                self._names.append(((place[0], place[1] + 3.5), name))
        for place, name in self._names:
            self.text("letter", place, name)

    def add_wheels(self) -> None:
        """Add an arrow at each wheel for its driving direction; a circle with a slash if it does not roll.

        Arrows in several directions at one place keep to the right of it, each in its own direction.
        """
        ways: dict[tuple[int, ...], dict[tuple[int, ...], tuple[Place, Vector | None]]] = {}
        for wheel in self._picture.scene.wheels:
            start = self._panel.place(wheel.centre)
            travel = self._panel.direction(wheel.travel) if wheel.travel else None
            key = tuple(round(5.0 * value) for value in travel or ())
            ways.setdefault((*map(round, start),), {})[key] = start, travel
        for there in ways.values():
            for (x, y), travel in there.values():
                across, down, _ = travel or (0.0, 0.0, 0.0)
                aside = _ASIDE if len(there) > 1 else 0.0
                start = x - aside * down, y + aside * across
                self.line("arrow", wheel_sign(start, travel))
                self._labels.mark([start, (start[0] + _ARROW * across, start[1] + _ARROW * down)], 5.0)

    def add_callouts(self) -> None:
        """Add the numbers of callouts beside their points, with leader lines, none over another."""
        callouts = self._picture.callouts
        points = [(one.number, self._panel.place(one.point)) for one in callouts if one.point is not None]
        for _, point in points:
            self._labels.mark([point], 5.0)
        for number, point in points:
            centre = self._labels.put(point, AROUND, (2.0 * _RADIUS + 2.0, 2.0 * _RADIUS + 2.0)) or point
            self.line("leader", segments([(point, centre)]) + circle(point, 1.5))
            self.badge(centre, number)


def lifted_ground(picture: Picture) -> Transform | None:
    """Return the ground of the reference if it differs in height from the robot's."""
    own, other = picture.scene.ground, picture.reference.ground if picture.reference is not None else None
    is_lifted = own is not None and other is not None and abs(own.translation[2] - other.translation[2]) > _SAME
    return other if is_lifted else None


def wheel_sign(start: Place, travel: Vector | None) -> str:
    """Return the path of an arrow in a direction on the sheet; to or from the viewer a dot or a cross in a circle."""
    x, y = start
    if travel is None:
        return circle(start, 8.0) + segments([((x - 5.6, y + 5.6), (x + 5.6, y - 5.6))])
    across, down, depth = travel
    if hypot(across, down) < _END_ON:
        cross = [((x - 4.0, y - sign * 4.0), (x + 4.0, y + sign * 4.0)) for sign in (1.0, -1.0)]
        return circle(start, 7.0) + (circle(start, 1.2) if depth > 0.0 else segments(cross))
    tip = x + _ARROW * across, y + _ARROW * down
    back, side = (-_HEAD * across, -_HEAD * down), (-_HEAD * 0.7 * down, _HEAD * 0.7 * across)
    barbs = [(tip, (tip[0] + back[0] + sign * side[0], tip[1] + back[1] + sign * side[1])) for sign in (1.0, -1.0)]
    return segments([(start, tip), *barbs])
