"""Pages about a robot: three views, and the links with their shapes and poses."""

from collections.abc import Iterator, Mapping
from itertools import islice
from math import degrees

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
from grader.report.pages.shell import Assets, render_page
from grader.report.signs import STYLE
from grader.robot.model import Box, Cylinder
from grader.robot.shapes import Shape
from grader.robot.transforms import Transform
from grader.text import counted, first_lines, printable

_MAX_LISTED = 500  # links and problems
_CLASSES = {"clean": "passed", "degraded": "skipped"}  # of verdicts


def render_robot_page(template: str, values: Mapping[str, object], picture: Picture | None, script: str = "") -> str:
    """Return a page about the robot of a picture, if there is one."""
    styles = "robot.css student.css"
    if picture is None:
        return render_page(template, {**values, "robot": None, "views": ""}, {}, Assets(styles, script))
    links = [*_links(picture.scene)]
    more = len(links) - _MAX_LISTED
    view = {
        "picture": picture,
        "links": links[:_MAX_LISTED],
        "unlisted": f"Not listed: {counted(more, 'more link')}." if more > 0 else "",
    }
    views = Markup(drawing_element(picture, legend=False))  # noqa: S704  an element, whose text is escaped
    return render_page(template, {**values, "robot": view, "views": views}, {}, Assets(styles, script, STYLE))


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
    return render_robot_page("inspection.html", values, plain_picture(robot, inspection.relative_to))
