"""Pages about a robot: three views, the 3-D model with the sliders of its joints, and a description."""

from collections.abc import Iterator, Mapping
from itertools import islice
from math import degrees, pi
from typing import Any, NamedTuple

from markupsafe import Markup

from grader import __version__
from grader.drawing.picture import Picture, plain_picture
from grader.drawing.scene import Scene
from grader.errors import MissingElement, NotDecided
from grader.report.content import problem_line
from grader.report.criteria import alike
from grader.report.drawing import drawing_element
from grader.report.inspection import Inspection, effect, joint_text, tree
from grader.report.locations import source_lines
from grader.report.pages.model import picture_data
from grader.report.pages.shell import Assets, render_page
from grader.report.svg_elements import STYLE
from grader.robot.model import Box, Cylinder, Joint
from grader.robot.shapes import Shape
from grader.robot.transforms import Transform
from grader.text import counted, first_lines, printable, quoted

_HALF_TURN = 180.0
_MAX_LISTED = 500  # links, joints, and problems
_CLASSES = {"clean": "passed", "degraded": "skipped"}  # of verdicts
_MAX_SLIDE = 1.0  # metres, of a joint without limits
_MAX_RANGE = 1e5  # radians or metres: larger limits are ignored


class Slider(NamedTuple):
    """The control of a joint: its number in the file, its range and position in degrees or mm.

    `scale` makes them radians or metres. A mimic joint `follows` another one; `note` names that joint, or describes
    invalid limits. The position of a continuous joint `wraps` after a full turn.
    """

    joint: int
    name: str
    low: float
    high: float
    value: float
    unit: str
    scale: float
    note: str
    follows: bool = False
    wraps: bool = False


def _sliders(scene: Scene) -> Iterator[Slider]:
    """Yield a slider for each joint that turns or slides, and whose child link has a pose in the picture."""
    for number, joint in _joints_of(scene):
        if joint.type not in ("revolute", "continuous", "prismatic"):
            continue
        slides = joint.type == "prismatic"
        scale = 0.001 if slides else pi / _HALF_TURN
        low, high = _range(joint)
        position = scene.robot.position(joint)
        value = position if isinstance(position, int | float) and abs(position) < _MAX_RANGE else 0.0
        follows = joint.mimic is not None and joint.name not in scene.robot.positions
        least, most, start = (round(end / scale, 6) + 0.0 for end in (min(low, value), max(high, value), value))
        unit, wraps = ("mm" if slides else "\u00b0"), joint.type == "continuous"
        note = _note(joint, value, follows)
        yield Slider(number, joint.name, least, most, start, unit, scale, note, follows, wraps)


def _note(joint: Joint, value: float, follows: bool) -> str:
    """Return which joint moves a mimic joint, or a description of invalid limits; empty for other joints."""
    if follows and joint.mimic is not None:
        return f"follows {joint.mimic.joint}"
    if joint.type == "continuous" or joint.limit is None or joint.limit.lower <= value <= joint.limit.upper:
        return ""
    return "its limits are reversed" if joint.limit.lower > joint.limit.upper else "starts outside its limits"


def _range(joint: Joint) -> tuple[float, float]:
    """Return the range of a joint in radians or metres; without usable limits, half a turn or a metre each way."""
    limit = joint.limit
    most = _MAX_SLIDE if joint.type == "prismatic" else pi
    if joint.type == "continuous" or limit is None or not 0.0 < limit.upper - limit.lower < _MAX_RANGE:
        return -most, most
    return limit.lower, limit.upper


def _unmoved_joints(scene: Scene) -> Iterator[str]:
    """Yield a sentence for each joint that moves in the robot, but not on the page."""
    for _, joint in _joints_of(scene):
        if joint.type in ("planar", "floating") and joint.name not in scene.robot.positions:
            yield f"{quoted(joint.name)} is {joint.type}: it stays at 0 here."


def _joints_of(scene: Scene) -> Iterator[tuple[int, Joint]]:
    """Yield the joints whose child link has a pose in the picture; of joints with the same name, the first."""
    names: set[str] = set()
    for number, joint in enumerate(scene.robot.robot.joints):
        if (
            scene.robot.parent_joints.get(joint.child) is joint
            and joint.child in scene.poses
            and joint.name not in names
        ):
            names.add(joint.name)
            yield number, joint


_SCRIPTS = "kinematics.js solids.js painter.js camera.js scene.js labels.js driving.js viewer.js controls.js"


def render_robot_page(
    template: str, values: Mapping[str, object], picture: Picture | None, data: Mapping[str, Any], *scripts: str
) -> str:
    """Return a page about the robot of a picture, if there is one. The last of the scripts does not need the robot."""
    if picture is None:
        assets = Assets("robot.css student.css", " ".join(scripts[-1:]))
        return render_page(template, {**values, "robot": None, "views": ""}, {}, assets)
    scene = picture.scene
    sliders, links = [*_sliders(scene)], [*_links(scene)]
    view = {
        "picture": picture,
        "sliders": sliders[:_MAX_LISTED],
        "still": (*_unmoved_joints(scene), *_unlisted(len(sliders), "joint")),
        "links": links[:_MAX_LISTED],
        "unlisted_links": (*_unlisted(len(links), "link"),),
        "words": _words(picture, len(sliders)),
        "can_drive": any(wheel.is_free for wheel in scene.wheels),
    }
    views = Markup(drawing_element(picture, legend=False))  # noqa: S704  an element, whose text is escaped
    starts = [{"joint": one.name, "value": one.value * one.scale} for one in sliders if not one.follows]
    robot = {**picture_data(picture), "sliders": starts}
    assets = Assets("robot.css student.css", " ".join((_SCRIPTS, *scripts)), STYLE)
    return render_page(template, {**values, "robot": view, "views": views}, {**robot, **data}, assets)


def _unlisted(number: int, noun: str) -> Iterator[str]:
    """Yield how many are not listed, if there are too many."""
    if number > _MAX_LISTED:
        yield f"Not listed: {counted(number - _MAX_LISTED, f'more {noun}')}."


def _links(scene: Scene) -> Iterator[tuple[str, str, str, str]]:
    """Yield each link in words: its name, its shapes, the pose of its frame, and its parent joint."""
    bodies = dict(alike(scene.bodies, lambda body: body.link))
    for name in dict.fromkeys(link.name for link in scene.robot.robot.links):
        shapes = ", ".join(_shape_words(body.shape) for body in bodies.get(name, ()))
        pose, joint = scene.poses.get(name), scene.robot.parent_joints.get(name)
        place = _pose_words(pose) if pose is not None else _why_none(scene, name)
        yield name, shapes, place, f"{joint.name} ({joint.type}) from {joint.parent}" if joint is not None else ""


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
    return f"{place}{'; rotated by ' + ' '.join(f'{value:g}' for value in angles) + ' degrees' if any(angles) else ''}"


def _words(picture: Picture, moving: int) -> str:
    """Return the description for screen readers: the parts of the robot, and the failed criteria of each link."""
    links = counted(len(picture.scene.robot.robot.links), "link")
    words = f"{links}, {counted(moving, 'joint')} that can be moved."
    for callout in picture.callouts:
        names = ", ".join(result.criterion.id for result in callout.results)
        words += f" {callout.number}: {names} failed{f' at {callout.link}' if callout.link else ''}."
    return words


def inspection_html(inspection: Inspection) -> str:
    """Return the inspection as an HTML page, with the joints at the given positions."""
    reading, robot = inspection.reading, inspection.robot
    sources = {reading.source.path: reading.source}
    links = tree(robot) if robot is not None else ()
    lines = (f"{indent}{printable(link)}{joint_text(joint)}" for indent, link, joint in links)
    values = {
        "version": __version__,
        "title": printable(robot.robot.name if robot is not None else inspection.path),
        "path": inspection.path,
        "effect": effect(inspection),
        "verdict": _CLASSES.get(inspection.verdict, "failed"),
        "problems": [
            (problem.severity, problem_line(problem), source_lines(problem.location, sources.get))
            for problem in reading.problems[:_MAX_LISTED]
        ],
        "tree": first_lines([*islice(lines, _MAX_LISTED + 1)], _MAX_LISTED),
    }
    return render_robot_page("inspection.html", values, plain_picture(robot, inspection.relative_to), {})
