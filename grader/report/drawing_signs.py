"""The signs of a drawing: ground, frames, driving directions of wheels, outlines of the reference, numbers."""

from collections.abc import Iterator
from math import cos, hypot, sin, tau

from grader.drawing.picture import Picture
from grader.drawing.views import FreePlaces, Panel, Place, framed_links
from grader.report.svg_elements import RADIUS, badge, circle, path, polygon, segment, text
from grader.robot.transforms import AXES, Z_AXIS, Transform, Vector

_AXIS, _LONG_AXIS, _ARROW = 20.0, 32.0, 30.0  # pixels
_END_ON = 0.2  # of its length: an axis that appears shorter is a dot
_LETTER, _BADGE = (9.0, 11.0), (2.0 * RADIUS + 2.0, 2.0 * RADIUS + 2.0)  # the room of one
_RINGS = (22.0, 30.0, 40.0, 52.0, 66.0, 84.0, 106.0, 132.0)  # pixels from what a number labels
_AROUND = [(ring * cos(tau * n / 16), -ring * sin(tau * n / 16)) for ring in _RINGS for n in range(2, 18)]
# Where the letter of an axis is, from its tip: along the axis, and to the side of it.
_BESIDE = ((8.0, 0.0), (2.0, 8.0), (2.0, -8.0), (-5.0, 8.5), (-5.0, -8.5), (-12.0, 13.0), (-12.0, -13.0), (20.0, 0.0))


def ground_line(panel: Panel, picture: Picture) -> list[Place]:
    """Return the ends of the ground in a panel; none if it is not seen edge-on and in the panel."""
    ground = picture.scene.ground
    if ground is None:
        return []
    across, down, depth = panel.direction(ground.rotate(Z_AXIS))
    if abs(depth) > 1e-3 or abs(down) < 0.05:
        return []
    x, y = panel.place(ground.translation)
    ends = [(at, y - (at - x) * across / down) for at in (panel.left + 6.0, panel.left + panel.width - 6.0)]
    return ends if all(panel.top <= height <= panel.top + panel.height for _, height in ends) else []


class Signs:
    """The signs of a picture in one panel, with its labels."""

    def __init__(self, panel: Panel, picture: Picture) -> None:
        self._panel, self._picture, self._places = panel, picture, FreePlaces(panel)
        self._lines: dict[tuple[str, str], None] = {}  # the class and the path data, each once
        self._letters: list[tuple[Place, Place, str]] = []  # the ends of axes with their names

    def all(self) -> Iterator[str]:
        """Yield the signs above the shapes, the lines with a halo that separates them from what is below."""
        if ground := ground_line(self._panel, self._picture):
            self._places.avoid(ground, 1.0)
            x, y = self._places.take(ground[0], [(22.0, 10.0), (22.0, -8.0)], (44.0, 12.0)) or ground[0]
            yield text("letter", (x, y + 2.0), "ground")
        self._add_reference()
        poses = [self._picture.scene.poses[link] for link in framed_links(self._picture)]
        for pose in {
            self._look_of(pose): pose for pose in reversed(poses)
        }.values():  # of those that look the same, one
            self._add_frame(pose, _AXIS)
        for wheel in self._picture.scene.wheels:
            self._add_wheel(self._panel.place(wheel.centre), wheel.travel)
        labels = [*self._place_letters(), *self._place_numbers()]
        yield path("halo", "".join(data for look, data in self._lines if look[:3] != "dot"))
        yield from (path(look, data) for look, data in self._lines)
        yield from labels

    def _add(self, look: str, data: str, places: list[Place], margin: float = 2.0) -> None:
        self._lines[look, data] = None
        self._places.avoid(places, margin)

    def _add_reference(self) -> None:
        """Add the dashed outlines of the reference, and its frames where they look different."""
        picture, reference = self._picture, self._picture.reference
        if reference is None:
            return
        for body in picture.outlines:
            corners = self._panel.outline(reference, body)
            self._add("reference", polygon(corners), corners)
        for link in picture.frames:
            own = picture.scene.poses.get(link)
            if own is None or self._look_of(reference.poses[link]) != self._look_of(own):
                self._add_frame(reference.poses[link], _LONG_AXIS, "reference")

    def _add_frame(self, pose: Transform, length: float, look: str = "") -> None:
        start = self._panel.place(pose.translation)
        for name, axis in zip("xyz", AXES, strict=True):
            across, down, depth = self._panel.direction(pose.rotate(axis))
            if hypot(across, down) > _END_ON:
                tip = start[0] + length * across, start[1] + length * down
                self._add(look or f"axis-{name}", segment(start, tip), [start, tip])
                self._letters.append((start, tip, name))
            elif not look:  # to the viewer, or away
                self._add(f"{'dot' if depth > 0.0 else 'axis'}-{name}", circle(start, 3.0), [start])

    def _look_of(self, pose: Transform) -> tuple[int, ...]:
        """Return a key that is equal for frames that look the same in the panel."""
        directions = (value for axis in AXES for value in self._panel.direction(pose.rotate(axis)))
        return (*map(round, self._panel.place(pose.translation)), *(round(10.0 * value) for value in directions))

    def _add_wheel(self, centre: Place, travel: Vector | None) -> None:
        """Add an arrow for the driving direction of a wheel; it keeps to the right of its centre."""
        across, down, depth = self._panel.direction(travel) if travel is not None else (0.0, 0.0, 0.0)
        start = centre[0] - 7.0 * down, centre[1] + 7.0 * across
        tip = start[0] + _ARROW * across, start[1] + _ARROW * down
        self._add("arrow", wheel_sign(start, (across, down, depth) if travel else None), [start, tip], 5.0)

    def _place_letters(self) -> Iterator[str]:
        """Yield the letters of axes, behind or beside their tips, unless others are there."""
        for start, tip, name in self._letters:
            across, down = tip[0] - start[0], tip[1] - start[1]
            long = hypot(across, down)
            shifts = [((a * across - b * down) / long, (a * down + b * across) / long) for a, b in _BESIDE]
            if place := self._places.take(tip, shifts, _LETTER):
                yield text("letter", (place[0], place[1] + 3.5), name)

    def _place_numbers(self) -> Iterator[str]:
        """Yield the numbers of callouts beside their points, and add their leader lines."""
        for callout in self._picture.callouts:
            if callout.point is not None:
                point = self._panel.place(callout.point)
                centre = self._places.take(point, _AROUND, _BADGE) or point
                self._lines["leader", segment(point, centre) + circle(point, 1.5)] = None
                yield badge(centre, callout.number)


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
