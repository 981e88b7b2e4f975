"""How the robot of a picture comes to rest and drives, as few numbers for the script of a page."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import atan2, hypot
from typing import Any

from grader.base.text import capitalised
from grader.base.transforms import Rotation, Transform, Vector, rotation_about
from grader.report.drawing.picture import Picture, Scene
from grader.ros.api import Configuration, Link, Mesh, Origin, Visual, plan_drive

_MAX_COORDINATE = 1e5  # metres, and rad/s
_DIGITS = 5  # of metres and parts of 1


def drive_data(picture: Picture) -> dict[str, Any] | None:
    """Return how the robot comes to rest on level ground and then drives.

    It is None if the robot has no wheel or is too large, or if it cannot be determined how it
    stands.

    All is in the frame of the scene. `mass` is the centre of mass, which moves straight down;
    `fall` has four numbers for each pose on the way: where up is, and the height of the mass above
    the ground; `motion` is the velocity of the mass at rest along x and y and how fast it turns to
    the left, if the wheels turn at 1 rad/s; `joints` are their names.
    """
    scene = picture.scene
    robot, has_boxes = _with_boxes(scene)
    drive = plan_drive(robot, **picture.driving)
    if not drive or drive.standing.base not in scene.poses:
        return None
    T_frame_base = scene.poses[drive.standing.base]
    fall = []
    for up, height in drive.standing.list_fall():
        fall.append(rounded((*T_frame_base.rotate(up), height), _DIGITS))
    motion: Sequence[float] = ()
    if drive.joints:
        T_rest_base = (
            Transform(_upright(T_frame_base.rotate(drive.standing.rest.up))) @ T_frame_base
        )
        x, y, _ = T_rest_base.rotate(drive.velocity)
        motion = (x, y, drive.turn)
    mass = T_frame_base.apply(drive.standing.rest.mass_centre)
    if not all(abs(value) < _MAX_COORDINATE for value in (*mass, *motion, *fall[0], *fall[-1])):
        return None
    text = f"{drive.text}, if its meshes are boxes" if has_boxes else drive.text
    return {
        "mass": rounded(mass, _DIGITS),
        "fall": fall,
        "motion": rounded(motion, _DIGITS),
        "joints": list(drive.joints),
        "text": f"{capitalised(text)}.",
    }


def _with_boxes(scene: Scene) -> tuple[Configuration, bool]:
    """Return the robot with the boxes around its meshes where the scene shows them.

    Also return whether that changes how it stands.
    """
    robot = scene.robot.known
    links = [_boxed(link, scene) for link in robot.links]
    if links == list(robot.links):
        return scene.robot, False
    return Configuration(replace(robot, links=tuple(links)), scene.robot.positions), True


def _boxed(link: Link, scene: Scene) -> Link:
    """Return a link that rests on what is shown of it, if it rests on a mesh that is shown."""
    solids = link.collisions or link.visuals
    meshes = [visual for visual in link.visuals if isinstance(visual.geometry, Mesh)]
    boxes = [body for body in scene.bodies if body.link == link.name and body.mesh]
    rests_on_mesh = any(isinstance(solid.geometry, Mesh) for solid in solids)
    if not rests_on_mesh or len(boxes) != len(meshes) or not boxes:
        return link
    T_link_frame = scene.poses[link.name].inverse()
    shown = [visual for visual in link.visuals if not isinstance(visual.geometry, Mesh)]
    for body in boxes:
        T_link_shape = T_link_frame @ body.T_frame_shape
        shown.append(Visual(body.shape, Origin(T_link_shape.translation, T_link_shape.rpy)))
    return link._replace(visuals=tuple(shown), collisions=())


def _upright(up: Vector) -> Rotation:
    """Return the shortest rotation that turns a direction upward, as the script has it."""
    flat = hypot(up[0], up[1])
    axis = (up[1] / flat, -up[0] / flat, 0.0) if flat else (1.0, 0.0, 0.0)
    return rotation_about(axis, atan2(flat, up[2]))


def rounded(values: Iterable[float], digits: int = 8) -> list[float]:
    """Return numbers without the digits that no picture shows, in the shortest form."""
    numbers = []
    for value in values:
        number = round(value, digits)
        numbers.append(int(number) if number.is_integer() else number)
    return numbers
