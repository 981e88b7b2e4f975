"""The robot on a page: three views, the 3-D model with its controls, and a description."""

from collections.abc import Iterator, Mapping
from math import degrees
from typing import Any, NamedTuple

from lxml import etree
from markupsafe import Markup

from grader.drawing.picture import Callout, Picture
from grader.drawing.scene import Scene
from grader.errors import MissingElement, NotDecided
from grader.report.drawing import drawing_element
from grader.report.pages.model import picture_data
from grader.report.pages.sliders import Slider, sliders_of, unmoved
from grader.report.svg_elements import DARK_RULES
from grader.robot.kinematics import Configuration
from grader.robot.model import Box, Cylinder
from grader.robot.shapes import Shape
from grader.robot.transforms import Transform
from grader.text import counted

STYLE = "robot.css"
SCRIPTS = "kinematics.js solids.js painter.js camera.js scene.js labels.js driving.js viewer.js controls.js"
RULES = f"@media screen and (prefers-color-scheme: dark) {{{DARK_RULES}}}"  # of the views


class LinkRow(NamedTuple):
    """A link in words: its shapes, the pose of its frame, and its parent joint."""

    name: str
    shows: str
    place: str
    joint: str


class RobotView(NamedTuple):
    """The content of a page about a robot. `words` is the description for screen readers."""

    data: Mapping[str, Any]
    sliders: tuple[Slider, ...]
    still: tuple[str, ...]
    links: tuple[LinkRow, ...]
    frame: str
    words: str
    missing: tuple[str, ...]
    has_reference: bool
    has_wheels: bool
    can_drive: bool
    callouts: tuple[Callout, ...]


def views(picture: Picture) -> Markup:
    """Return the three views as an element of a page."""
    element = drawing_element(picture, legend=False)
    return Markup(etree.tostring(element, encoding="unicode"))  # noqa: S704  an element tree, whose text is escaped


def robot_view(picture: Picture) -> RobotView:
    """Return the content of a page about the robot of a picture."""
    scene = picture.scene
    sliders = tuple(sliders_of(scene))
    starts = [{"joint": one.name, "value": one.value * one.scale} for one in sliders if not one.follows]
    mode = "both" if picture.outlines or picture.frames else "submission"
    return RobotView(
        {**picture_data(picture), "sliders": starts, "mode": mode},
        sliders,
        tuple(unmoved(scene)),
        tuple(_rows(scene)),
        scene.frame,
        _words(picture),
        scene.missing,
        picture.reference is not None,
        bool(scene.wheels),
        any(wheel.is_free for wheel in scene.wheels),
        picture.callouts,
    )


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
    """Return why a link has no pose in the picture."""
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
    """Return the description for screen readers: the parts of the robot, and the failed criteria of each link."""
    robot: Configuration = picture.scene.robot
    moving = sum(1 for _ in sliders_of(picture.scene))
    words = f"{counted(len(robot.robot.links), 'link')}, {counted(moving, 'joint')} that can be moved."
    for callout in picture.callouts:
        names = ", ".join(result.criterion.id for result in callout.results)
        words += f" {callout.number}: {names} failed{f' at {callout.link}' if callout.link else ''}."
    return words
