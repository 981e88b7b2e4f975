"""The robot on a page: three views, the model that is shown in 3-D with its controls, and both in words."""

from collections.abc import Iterator, Mapping
from math import degrees, isfinite, pi
from typing import Any, NamedTuple

from lxml import etree
from markupsafe import Markup

from grader.drawing.picture import Callout, Picture
from grader.drawing.scene import Scene
from grader.errors import MissingElement, NotDecided
from grader.report.drawing import drawing_element
from grader.report.pages.model import picture_data
from grader.report.svg_elements import DARK_RULES
from grader.robot.kinematics import Configuration
from grader.robot.model import Box, Cylinder, Joint
from grader.robot.shapes import Shape
from grader.robot.transforms import Transform
from grader.text import counted, quoted

STYLE = "robot.css"
SCRIPTS = "kinematics.js solids.js painter.js camera.js scene.js labels.js driving.js viewer.js controls.js"
RULES = f"@media screen and (prefers-color-scheme: dark) {{{DARK_RULES}}}"  # of the views
_HALF_TURN = 180.0
_MAX_SLIDE = 1.0  # metres, of a joint without limits
_STILL = "stays at 0 here"


class Slider(NamedTuple):
    """The control of a joint: its number in the file, its range and position in degrees or mm; `scale` makes them radians or metres.

    A joint that nothing can move here says why in `note`; one that mimics another follows it.
    """

    joint: int
    name: str
    link: str
    low: float
    high: float
    value: float
    unit: str
    scale: float
    note: str
    follows: bool = False
    wraps: bool = False


class LinkRow(NamedTuple):
    """A link in words: what it shows, where its frame is, and its parent joint."""

    name: str
    shows: str
    place: str
    joint: str


class RobotView(NamedTuple):
    """What a page shows of a robot. `words` says it to a screen reader."""

    data: Mapping[str, Any]
    sliders: tuple[Slider, ...]
    still: tuple[str, ...]
    links: tuple[LinkRow, ...]
    frame: str
    words: str
    missing: tuple[str, ...]
    has_reference: bool
    has_wheels: bool
    callouts: tuple[Callout, ...]


def views(picture: Picture) -> Markup:
    """Return the three views as an element of a page."""
    element = drawing_element(picture, legend=False)
    return Markup(etree.tostring(element, encoding="unicode"))  # noqa: S704  an element tree, whose text is escaped


def robot_view(picture: Picture) -> RobotView:
    """Return what a page shows of the robot of a picture."""
    scene = picture.scene
    sliders = tuple(_sliders(scene))
    starts = [{"joint": one.name, "value": one.value * one.scale} for one in sliders if not one.follows]
    mode = "both" if picture.outlines or picture.frames else "submission"
    return RobotView(
        {**picture_data(picture), "sliders": starts, "mode": mode},
        sliders,
        tuple(_still(scene)),
        tuple(_rows(scene)),
        scene.frame,
        _words(picture),
        scene.missing,
        picture.reference is not None,
        bool(scene.wheels),
        picture.callouts,
    )


def _moved(scene: Scene) -> Iterator[tuple[int, Joint]]:
    """Yield the joints that hold a link with a place in the picture; of those with one name the first."""
    names: set[str] = set()
    for number, joint in enumerate(scene.robot.robot.joints):
        if (
            scene.robot.parent_joints.get(joint.child) is joint
            and joint.child in scene.poses
            and joint.name not in names
        ):
            names.add(joint.name)
            yield number, joint


def _sliders(scene: Scene) -> Iterator[Slider]:
    for number, joint in _moved(scene):
        if joint.type not in ("revolute", "continuous", "prismatic"):
            continue
        slides = joint.type == "prismatic"
        scale = 0.001 if slides else pi / _HALF_TURN
        low, high = _range(joint)
        position = scene.robot.position(joint)
        value = position if isinstance(position, int | float) and isfinite(position) else 0.0
        follows = joint.mimic is not None and joint.name not in scene.robot.positions
        note = f"follows {joint.mimic.joint}" if joint.mimic is not None and follows else ""
        least, most, start = (round(end / scale, 6) + 0.0 for end in (min(low, value), max(high, value), value))
        unit, wraps = ("mm" if slides else "\u00b0"), joint.type == "continuous"
        yield Slider(number, joint.name, joint.child, least, most, start, unit, scale, note, follows, wraps)


def _range(joint: Joint) -> tuple[float, float]:
    """Return the range of a joint in radians or metres; without usable limits half a turn, or a metre, to both sides."""
    limit = joint.limit
    most = _MAX_SLIDE if joint.type == "prismatic" else pi
    if (
        joint.type == "continuous"
        or limit is None
        or not isfinite(limit.upper - limit.lower)
        or limit.lower >= limit.upper
    ):
        return -most, most
    return limit.lower, limit.upper


def _still(scene: Scene) -> Iterator[str]:
    """Yield in words which joints could move, but not here."""
    for _, joint in _moved(scene):
        if joint.type in ("planar", "floating") and joint.name not in scene.robot.positions:
            yield f"{quoted(joint.name)} is {joint.type}: it {_STILL}."


def _rows(scene: Scene) -> Iterator[LinkRow]:
    shown: dict[str, list[str]] = {}
    for body in scene.bodies:
        shown.setdefault(body.link, []).append(_shape_words(body.shape))
    for name in dict.fromkeys(link.name for link in scene.robot.robot.links):
        pose, joint = scene.poses.get(name), scene.robot.parent_joints.get(name)
        yield LinkRow(
            name,
            ", ".join(shown.get(name, [])),
            _pose_words(pose) if pose is not None else _why_none(scene, name),
            f"{joint.name} ({joint.type}) from {joint.parent}" if joint is not None else "",
        )


def _why_none(scene: Scene, link: str) -> str:
    """Return why a link has no place in the picture."""
    try:
        scene.robot.pose(link, relative_to=scene.frame)
    except (MissingElement, NotDecided) as reason:
        return str(reason)
    return "too far away"


def _shape_words(shape: Shape) -> str:
    match shape:
        case Box(size=size):
            return f"box {' x '.join(f'{value:g}' for value in size)} m"
        case Cylinder(radius=radius, length=length):
            return f"cylinder, radius {radius:g}, length {length:g} m"
        case _:
            return f"sphere, radius {shape.radius:g} m"


def _pose_words(pose: Transform) -> str:
    """Return a position in metres, and the angles in degrees unless all are 0."""
    place = " ".join(f"{round(value, 4) + 0.0:g}" for value in pose.translation)
    angles = [round(degrees(value), 1) + 0.0 for value in pose.rpy]
    return f"{place}{'; turned by ' + ' '.join(f'{value:g}' for value in angles) + ' degrees' if any(angles) else ''}"


def _words(picture: Picture) -> str:
    """Return the text alternative: what the robot consists of, and which criteria failed where."""
    robot: Configuration = picture.scene.robot
    moving = sum(1 for _ in _sliders(picture.scene))
    words = f"{counted(len(robot.robot.links), 'link')}, {counted(moving, 'joint')} that can be moved."
    for callout in picture.callouts:
        names = ", ".join(result.criterion.id for result in callout.results)
        words += f" {callout.number}: {names} failed{f' at {callout.link}' if callout.link else ''}."
    return words
