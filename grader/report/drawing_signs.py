"""The signs of a drawing: ground, frames, driving directions of wheels, outlines of the reference, numbers."""

from collections.abc import Iterator
from math import cos, hypot, sin, tau

from grader.drawing.picture import Picture
from grader.drawing.views import FreePlaces, Panel, Place, framed_links, lifted_ground
from grader.report.svg_elements import RADIUS, badge, circle, path, polygon, segment, text
from grader.robot.transforms import AXES, Transform, Vector

_AXIS, _LONG_AXIS, _ARROW = 20.0, 32.0, 30.0  # pixels
_END_ON = 0.2  # of its length: an axis that appears shorter is a dot
_LETTER = (9.0, 11.0)  # the room of one
_RINGS = (22.0, 30.0, 40.0, 52.0, 66.0, 84.0, 106.0, 132.0)  # pixels from what a number labels
_AROUND = [(ring * cos(tau * n / 16), -ring * sin(tau * n / 16)) for ring in _RINGS for n in range(2, 18)]
# Where the letter of an axis is, from its tip: along the axis, and to the side of it.
_BESIDE = ((8.0, 0.0), (2.0, 8.0), (2.0, -8.0), (-5.0, 8.5), (-5.0, -8.5), (-12.0, 13.0), (-12.0, -13.0), (20.0, 0.0))


class Signs:
    """The signs of a picture in one panel, with its labels."""

    def __init__(self, panel: Panel, picture: Picture) -> None:
        self._panel, self._picture, self._places = panel, picture, FreePlaces(panel)
        self._lines: dict[tuple[str, str], None] = {}  # the class and the path data, each once
        self._letters: list[tuple[Place, Place, str]] = []  # the ends of axes with their names

    def _line(self, look: str, *data: str) -> None:
        self._lines |= dict.fromkeys((look, one) for one in data)

    def grounds(self) -> Iterator[str]:
        """Yield the ground as a line where it is seen edge-on, and that of the reference if it differs."""
        for look, ground in (("ground", self._picture.scene.ground), ("reference", lifted_ground(self._picture))):
            for start, end in self._ground_line(ground) if ground is not None else ():
                self._places.avoid([start, end], 1.0)
                yield path(look, segment(start, end))
                if look == "ground":
                    at = self._places.take(start, [(22.0, 10.0), (22.0, -8.0)], (44.0, 12.0)) or start
                    yield text("letter", (at[0], at[1] + 2.0), "ground")

    def _ground_line(self, ground: Transform) -> Iterator[tuple[Place, Place]]:
        """Yield the ends of the plane z = 0 of a frame in the panel, if it is seen edge-on and crosses the panel."""
        panel = self._panel
        across, down, depth = panel.direction(ground.rotate((0.0, 0.0, 1.0)))
        if abs(depth) > 1e-3 or abs(down) < 0.05:
            return
        x, y = panel.place(ground.translation)
        start, end = ((at, y - (at - x) * across / down) for at in (panel.left + 6.0, panel.left + panel.width - 6.0))
        if all(panel.top <= height <= panel.top + panel.height for _, height in (start, end)):
            yield start, end

    def all(self) -> Iterator[str]:
        """Yield the signs above the shapes, the lines with a halo that separates them from what is below."""
        self._add_reference()
        self._add_frames()
        self._add_wheels()
        names = [*self._place_letters()]
        badges = [*self._place_numbers()]
        yield path("halo", "".join(data for look, data in self._lines if look[:3] != "dot"))
        yield from (path(look, data) for look, data in self._lines)
        yield from (*names, *badges)

    def _add_reference(self) -> None:
        """Add the dashed outlines of the reference, and its frames where they look different."""
        picture, reference = self._picture, self._picture.reference
        if reference is None:
            return
        for body in picture.outlines:
            corners = self._panel.outline(reference, body)
            self._line("reference", polygon(corners))
            self._places.avoid(corners)
        for link in picture.frames:
            own = picture.scene.poses.get(link)
            if own is None or self._look_of(reference.poses[link]) != self._look_of(own):
                self._add_frame(reference.poses[link], _LONG_AXIS, "reference")

    def _add_frames(self) -> None:
        """Add the frames of links; of those that look the same, only one."""
        poses = [self._picture.scene.poses[link] for link in framed_links(self._picture)]
        for pose in {self._look_of(pose): pose for pose in reversed(poses)}.values():
            self._add_frame(pose, _AXIS)

    def _add_frame(self, pose: Transform, length: float, look: str = "") -> None:
        start = self._panel.place(pose.translation)
        for name, axis in zip("xyz", AXES, strict=True):
            across, down, depth = self._panel.direction(pose.rotate(axis))
            if hypot(across, down) > _END_ON:
                tip = start[0] + length * across, start[1] + length * down
                self._line(look or f"axis-{name}", segment(start, tip))
                self._places.avoid([start, tip])
                self._letters.append((start, tip, name))
            elif not look:  # to the viewer, or away
                self._line(f"{'dot' if depth > 0.0 else 'axis'}-{name}", circle(start, 3.0))

    def _look_of(self, pose: Transform) -> tuple[int, ...]:
        """Return a key that is equal for frames that look the same in the panel."""
        directions = (value for axis in AXES for value in self._panel.direction(pose.rotate(axis)))
        return (*map(round, self._panel.place(pose.translation)), *(round(10.0 * value) for value in directions))

    def _place_letters(self) -> Iterator[str]:
        """Yield the letters of axes, behind or beside their tips, unless others are there."""
        for start, tip, name in self._letters:
            across, down = tip[0] - start[0], tip[1] - start[1]
            long = hypot(across, down)
            shifts = [((a * across - b * down) / long, (a * down + b * across) / long) for a, b in _BESIDE]
            if place := self._places.take(tip, shifts, _LETTER):
                yield text("letter", (place[0], place[1] + 3.5), name)

    def _add_wheels(self) -> None:
        """Add an arrow at each wheel for its driving direction; several at one place keep to the right of it."""
        ways: dict[Place, dict[tuple[int, ...], Vector | None]] = {}
        for wheel in self._picture.scene.wheels:
            travel = self._panel.direction(wheel.travel) if wheel.travel else None
            x, y = self._panel.place(wheel.centre)
            ways.setdefault((round(x), round(y)), {})[tuple(round(5.0 * value) for value in travel or ())] = travel
        for (x, y), there in ways.items():
            for travel in there.values():
                across, down, _ = travel or (0.0, 0.0, 0.0)
                aside = 7.0 if len(there) > 1 else 0.0
                start = x - aside * down, y + aside * across
                self._line("arrow", wheel_sign(start, travel))
                self._places.avoid([start, (start[0] + _ARROW * across, start[1] + _ARROW * down)], 5.0)

    def _place_numbers(self) -> Iterator[str]:
        """Yield the numbers of callouts beside their points, and add their leader lines."""
        points = {one.number: self._panel.place(one.point) for one in self._picture.callouts if one.point is not None}
        for number, point in points.items():
            centre = self._places.take(point, _AROUND, (2.0 * RADIUS + 2.0, 2.0 * RADIUS + 2.0)) or point
            self._line("leader", segment(point, centre) + circle(point, 1.5))
            yield badge(centre, number)


def wheel_sign(start: Place, travel: Vector | None) -> str:
    """Return the path of an arrow in a direction on the sheet; to or from the viewer a dot or a cross in a circle."""
    x, y = start
    if travel is None:
        return circle(start, 8.0) + segment((x - 5.6, y + 5.6), (x + 5.6, y - 5.6))
    across, down, depth = travel
    if hypot(across, down) < _END_ON:
        crossed = (segment((x - 4.0, y - sign * 4.0), (x + 4.0, y + sign * 4.0)) for sign in (1.0, -1.0))
        return circle(start, 7.0) + (circle(start, 1.2) if depth > 0.0 else "".join(crossed))
    tip = x + _ARROW * across, y + _ARROW * down
    barbs = ((tip[0] - 6.0 * across - side * down, tip[1] - 6.0 * down + side * across) for side in (4.2, -4.2))
    return segment(start, tip) + "".join(segment(tip, barb) for barb in barbs)
