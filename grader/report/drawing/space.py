"""The robot of a picture as data for the script of a page, which moves its joints.

The data has links with shapes, and joints.

It has nothing of the reference: the script reads that from the three views in the page.
"""

from collections.abc import Mapping
from math import inf, isfinite, pi
from typing import Any

from grader.base.grouping import StringsByName
from grader.base.transforms import Transform, unit
from grader.report.drawing.drive import drive_data, rounded
from grader.report.drawing.picture import Body, Picture, Scene
from grader.ros.api import Box, Capsule, Configuration, Cylinder, Joint, Mesh, Shape, Sphere

_Data = dict[str, Any]  # for a script

_MAX_LINKS = 500  # in software, a browser moves more only in seconds
_WITHOUT_LIMITS = {"prismatic": 1.0}  # metres to each side; the other joints turn by half a turn


def space_data(
    picture: Picture, cards: StringsByName, meshes: Mapping[Mesh, str] = {}
) -> _Data | None:
    """Return the robot of a picture; None if it has too many links.

    Poses are 12 numbers, row by row: the rotation and the translation in metres. `cards` are the
    ids of the cards on the page, by criterion, and `meshes` the addresses of triangles.
    """
    scene = picture.scene
    if len(scene.poses) > _MAX_LINKS or len(scene.robot.known.joints) > _MAX_LINKS:
        return None
    shapes = _shapes_by_link(scene, meshes)
    joints = [_joint(joint, scene.robot, scene.poses) for joint in scene.robot.known.joints]
    leaders = {joint["mimic"][0] for joint in joints if "mimic" in joint}
    for joint in joints:
        if "origin" not in joint and joint["name"] not in leaders:
            joint.pop("range", None)  # it moves nothing that is shown
    placed = {joint["child"] for joint in joints if "origin" in joint}
    links = []
    for name, pose in scene.poses.items():
        link: _Data = {"name": name, "shapes": shapes.get(name, [])}
        if name not in placed:
            link["pose"] = list_rows(pose)
        links.append(link)
    data = {
        "frame": scene.frame,
        "root": scene.root,
        "links": links,
        "joints": joints,
        "pins": _pins(picture, cards),
    }
    drive = drive_data(picture)
    return data if drive is None else {**data, "drive": drive}


def _pins(picture: Picture, cards: StringsByName) -> list[_Data]:
    """Return the numbers at links, each with the card on the page that it leads to."""
    pins = []
    for callout in picture.callouts:
        if callout.point is not None:
            pin = {"number": callout.number, "link": callout.link}
            card = cards.get(callout.names[0])
            if card is not None:
                pin["card"] = f"criterion-{card}"
            pins.append(pin)
    return pins


def without_names(space: Mapping[str, Any]) -> _Data:
    """Return a robot with numbers in place of the names of links and joints, and without pins."""
    names = {"": ""}
    joints = []
    links = []
    for number, link in enumerate(space["links"], 1):
        names[link["name"]] = f"link {number}"
        links.append({**link, "name": names[link["name"]]})
    numbers: dict[str, str] = {}
    for joint in space["joints"]:
        numbers.setdefault(joint["name"], f"joint {len(numbers) + 1}")
    for joint in space["joints"]:
        ends = {end: names.get(joint[end], "") for end in ("parent", "child")}
        renamed = {**joint, **ends, "name": numbers[joint["name"]]}
        if "axis" not in joint:
            renamed["type"] = ""  # it may be any text
        if "mimic" in joint:
            leader, *motion = joint["mimic"]
            renamed["mimic"] = [numbers.get(leader, ""), *motion]
        joints.append(renamed)
    frame = names.get(space["frame"], "")
    root = names.get(space["root"], "")
    robot: _Data = {
        "frame": frame,
        "root": root,
        "links": links,
        "joints": joints,
        "pins": [],
    }
    if "drive" in space:
        driven = [numbers[joint] for joint in space["drive"]["joints"]]
        robot["drive"] = {**space["drive"], "joints": driven, "text": ""}
    return robot


def _shapes_by_link(scene: Scene, meshes: Mapping[Mesh, str]) -> Mapping[str, list[_Data]]:
    shapes: dict[str, list[_Data]] = {}
    for body in scene.bodies:
        T_link_frame = scene.poses[body.link].inverse()
        for part in _scalable_parts(body):
            shapes.setdefault(body.link, []).append(_shape(part, T_link_frame, meshes))
    return shapes


def _scalable_parts(body: Body) -> list[Body]:
    """Return a body as shapes that scaling makes of a unit shape: a capsule is three."""
    shape = body.shape
    pose = body.T_frame_shape
    if not isinstance(shape, Capsule):
        return [body]
    half = shape.length / 2.0
    parts: list[tuple[Shape, float]] = [
        (Cylinder(shape.radius, shape.length), 0.0),
        (Sphere(shape.radius), half),
        (Sphere(shape.radius), -half),
    ]
    bodies = []
    for part, height in parts:
        place = Transform(translation=(0.0, 0.0, height))
        bodies.append(body._replace(shape=part, T_frame_shape=pose @ place))
    return bodies


def _shape(body: Body, T_link_frame: Transform, meshes: Mapping[Mesh, str]) -> _Data:
    """Return a shape in the frame of its link.

    Its size is that of the scaled unit shape of the script.
    """
    shape = body.shape
    if isinstance(shape, Box):
        kind = "box"
        size = shape.size
    elif isinstance(shape, Cylinder):
        kind = "cylinder"
        size = (shape.radius, shape.radius, shape.length)
    else:
        kind = "sphere"
        size = (shape.radius, shape.radius, shape.radius)
    pose = T_link_frame @ body.T_frame_shape
    data = {
        "kind": kind,
        "size": rounded(size),
        "pose": list_rows(pose),
        "rgba": rounded(body.rgba),
    }
    if body.mesh and body.mesh in meshes:
        data["mesh"] = meshes[body.mesh]
    return data


def _joint(joint: Joint, robot: Configuration, poses: Mapping[str, Transform]) -> _Data:
    """Return a joint: how it places its child, if both are shown, how it moves, what it mimics."""
    data: _Data = {
        "name": joint.name,
        "type": joint.type,
        "parent": joint.parent,
        "child": joint.child,
    }
    is_shown = joint.parent in poses and robot.known_parents.get(joint.child) is joint
    if is_shown and joint.child in poses and joint.origin:
        data["origin"] = list_rows(joint.origin.placed_in())
    position = robot.positions.get(joint.name)
    mimic = joint.mimic
    if mimic and position is None and isfinite(mimic.multiplier + mimic.offset):
        data["mimic"] = [mimic.joint, mimic.multiplier, mimic.offset]
    axis = unit(joint.axis) if joint.axis is not None else None
    if joint.has_position and axis is not None:
        data["axis"] = rounded(axis)
        if "mimic" not in data:
            if position:
                data["start"] = position
            data["range"] = rounded(_range(joint, position or 0.0))
    return data


def _range(joint: Joint, position: float) -> tuple[float, float]:
    """Return the positions (rad or m) that a slider offers: the limits, and where the joint is."""
    reach = _WITHOUT_LIMITS.get(joint.type, pi)
    lower = -reach
    upper = reach
    limit = joint.limit
    if limit and joint.type != "continuous" and -inf < limit.lower <= limit.upper < inf:
        lower = limit.lower
        upper = limit.upper
    return min(lower, position), max(upper, position)


def list_rows(pose: Transform) -> list[float]:
    """Return a pose as 12 numbers, row by row."""
    a, b, c, d, e, f, g, h, i = pose.rotation
    x, y, z = pose.translation
    return rounded((a, b, c, x, d, e, f, y, g, h, i, z))
