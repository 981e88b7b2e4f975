"""Robots that Gazebo refuses: libsdformat cannot make its own description of them.

The verdicts are those of libsdformat 12.7, sdf::Root::LoadSdfString, and of std::stod for the
contacts of a link. It joins links that a fixed joint joins before it judges them.
"""

import re
from collections.abc import Collection, Iterator

from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location, place
from grader.base.text import quoted
from grader.base.transforms import IDENTITY, Transform
from grader.ros.known.gazebo_rows import gazebo
from grader.ros.urdf.mass_properties import (
    MassProperties,
    principal_moments,
    together,
    turned,
)
from grader.ros.urdf.model import Joint, Link
from grader.ros.xml.parsing import Element
from grader.workspace.graph.compared_robots import robots_for_launch
from grader.workspace.model.known_robots import KnownRobot
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Facts, Mismatch, Mismatches
from grader.workspace.rules.rule_table import NO_TOPIC, Rule

_CREATORS = ("ros_gz_sim", "ros_ign_gazebo")
# Elements of a sensor, and of the contacts of a link, that are numbers; those that are switches.
_NUMBERS = frozenset(
    {
        *("update_rate", "width", "height", "horizontal_fov", "near", "far", "samples"),
        *("resolution", "min_angle", "max_angle", "min", "max", "mean", "stddev"),
    }
)
_OF_CONTACTS = frozenset(
    {"mu1", "mu2", "kp", "kd", "maxVel", "minDepth", "maxContacts", "dampingFactor"}
)
_SWITCHES = frozenset({"always_on", "visualize"})
_OF_LINKS = frozenset({"gravity", "self_collide"})
_NUMBER = on_use(r"\s*+(?:[+-]?(?:\d|\.\d|inf|nan)|$)", re.IGNORECASE)
_SWITCH = on_use(r"\s*+(?:true|false|0|1)?\s*+", re.IGNORECASE)
_KEEPING = ("preserveFixedJoint", "disableFixedJointLumping")
_ROUNDING = 1e-9  # of a moment of inertia

_SENSOR_NAME = Rule(
    "sensor-name",
    "topics",
    NO_TOPIC,
    "A sensor of Gazebo has a name, which no other one of its link has.",
    why="libsdformat refuses the description, so that Gazebo creates nothing of the robot.",
    wrong='<gazebo reference="base_link"><sensor type="imu"><topic>imu</topic></sensor></gazebo>',
    right="""
<gazebo reference="base_link"><sensor name="imu" type="imu"><topic>imu</topic></sensor></gazebo>
""",
    frame="rover.urdf",
)

_GAZEBO_ROBOT = Rule(
    "gazebo-robot",
    "topics",
    NO_TOPIC,
    "Gazebo accepts the robot that a launch file creates in it.",
    why="libsdformat refuses the description, so that Gazebo creates nothing of the robot.",
    wrong="""
<gazebo><plugin name="gz::sim::systems::PosePublisher"/></gazebo>
""",
    right="""
<gazebo>
  <plugin filename="gz-sim-pose-publisher-system" name="gz::sim::systems::PosePublisher"/>
</gazebo>
""",
    frame="rover.urdf",
    beside={
        "rover.launch.py": """
Node(package='ros_gz_sim', executable='create', arguments=['-string', robot]),
""",
    },
)


def refused_robot_facts(workspace: Workspace) -> Facts:
    """Yield what Gazebo refuses of the robots that launch files create in it.

    Sensors without a name, or with that of another one, are yielded of any robot.
    """
    for known in workspace.robots.known:
        yield from _nameless_sensors(known)
    created = {}
    for number, node in workspace.launches.launched:
        if node.package in _CREATORS and node.executable == "create" and node.when is not False:
            for known in robots_for_launch(workspace, number).robots:
                created[known.path] = known
    for known in created.values():
        workspace.charge(1 + len(known.robot.links))
        yield from _refused_parts(known)
        yield from _same_names(known)
        yield from _refused_bodies(known)


def _nameless_sensors(known: KnownRobot) -> Mismatches:
    """Yield sensors without a name, or with the name of another one of what their link is in."""
    holders = {name: holder for name, (holder, _) in _join_links(known).items()}
    seen = set()
    for sensor in known.root.iterfind("gazebo/sensor"):
        above = sensor.getparent()
        reference = above.get("reference", "") if above is not None else ""
        name = sensor.get("name", "")
        link = holders.get(reference, reference)
        if not name or (link, name) in seen:
            has = f"the name {quoted(name)} of another one" if name else "no name"
            message = f"a sensor has {has}, so Gazebo refuses the robot"
            yield Mismatch(_SENSOR_NAME, message, known.place(sensor))
        seen.add((link, name))


def _refused_parts(known: KnownRobot) -> Mismatches:
    """Yield sensors of no type, plugins without names, and words where numbers belong."""
    for part in known.root.iterchildren("gazebo"):
        plugins = list(part.iterfind("sensor/plugin"))
        plugins += [] if part.get("reference") else list(part.iterchildren("plugin"))
        for plugin in plugins:
            for name in ("filename", "name"):
                if plugin.get(name) is None:
                    yield _refuse(known, plugin, f"a <plugin> has no {name}")
        for sensor in part.iterchildren("sensor"):
            kind = sensor.get("type", "")
            if kind not in gazebo().known_sensors:
                has = f"the type {quoted(kind)}, which does not exist" if kind else "no type"
                yield _refuse(known, sensor, f"a sensor has {has}")
            yield from _wrong_texts(known, sensor.iter("*"), _NUMBERS, _SWITCHES)
        yield from _wrong_texts(known, part.iterchildren("*"), _OF_CONTACTS, _OF_LINKS)


def _wrong_texts(
    known: KnownRobot,
    elements: Iterator[Element],
    numbers: Collection[str],
    switches: Collection[str],
) -> Mismatches:
    """Yield elements with a word in place of a number or of a switch."""
    for element in elements:
        text = element.text or ""
        if element.tag in numbers and not _NUMBER.match(text):
            yield _refuse(
                known, element, f"<{element.tag}> is {quoted(text.strip())}, not a number"
            )
        elif element.tag in switches and not _SWITCH.fullmatch(text):
            message = f"<{element.tag}> is {quoted(text.strip())}, and neither true nor false"
            yield _refuse(known, element, message)


def _refuse(known: KnownRobot, element: Element, reason: str) -> Mismatch:
    return Mismatch(_GAZEBO_ROBOT, f"{reason}, so Gazebo refuses the robot", known.place(element))


def _same_names(known: KnownRobot) -> Mismatches:
    """Yield joints with the name of a link, of which Gazebo keeps both."""
    links = _join_links(known)
    for joint in known.robot.joints:
        is_kept = joint.child in links and links[joint.child][0] == joint.child
        is_same = joint.name in links and links[joint.name][0] == joint.name
        if is_same and is_kept and joint.location:
            message = (
                f"a link and a joint are named {quoted(joint.name)}, so Gazebo refuses the robot"
            )
            at = joint.location.resolve() if joint.location else Location(known.path, 1, 1)
            yield Mismatch(_GAZEBO_ROBOT, message, at)


def _join_links(known: KnownRobot) -> dict[str, tuple[str, Transform | None]]:
    """Return the link that holds each link in Gazebo, by fixed joints, and its pose in that.

    A link that nothing holds is its own holder. The pose is None where an origin is not known.
    """
    kept = set()  # the fixed joints that Gazebo is told to keep
    for part in known.root.iterchildren("gazebo"):
        texts = [part.findtext(name, "").strip().lower() for name in _KEEPING]
        if not {"true", "1"}.isdisjoint(texts):
            kept.add(part.get("reference", ""))
    below: dict[str, list[Joint]] = {}
    inner = set()
    for joint in known.robot.joints:
        if joint.type == "fixed" and joint.name not in kept:
            below.setdefault(joint.parent, []).append(joint)
            inner.add(joint.child)
    links: dict[str, tuple[str, Transform | None]] = {
        link.name: (link.name, IDENTITY) for link in known.robot.links
    }
    pending = [name for name in links if name not in inner]
    while pending:
        above = pending.pop()
        for joint in below.get(above, ()):
            holder, pose = links[above]
            origin = joint.origin
            placed = origin.placed_in(pose) if origin and pose else None
            links[joint.child] = holder, placed
            pending.append(joint.child)
    return links


def _refused_bodies(known: KnownRobot) -> Mismatches:
    """Yield the links whose mass or inertia, with those fixed to them, no body has."""
    for body in list_impossible_bodies(known):
        message = (
            f"the mass and inertia of {quoted(body.link)}{body.others} are not physical, so Gazebo "
            "refuses the robot: each principal moment must be positive and at most the sum of the "
            "other two"
        )
        yield Mismatch(_GAZEBO_ROBOT, message, body.location, word=body.link)


class _ImpossibleBody(Named):
    """A link as Gazebo has it, and where the mass or inertia that no body has is written."""

    link: str
    location: Location
    others: str  # words for the links that it holds; empty without


def list_impossible_bodies(known: KnownRobot) -> Iterator[_ImpossibleBody]:
    """Yield the bodies that Gazebo makes of links, with a mass or inertia that no body has."""
    bodies = dict[str, list[MassProperties]]()
    places = {}
    links = {link.name: link for link in known.robot.links}
    for name, (holder, pose) in _join_links(known).items():
        body = _make_body(links[name], pose)
        inertial = links[name].inertial
        if not body or not inertial:
            continue
        bodies.setdefault(holder, []).append(body)
        at = place(inertial.location, inside="inertia" if body.mass > 0 else "mass")
        if at and (holder not in places or not _is_possible(body)):
            places[holder] = at.resolve()
    for holder, each in bodies.items():
        mass = sum(body.mass for body in each)
        if mass and holder in places and not _is_possible(together(each)):
            others = " with what is fixed to it" if len(each) > 1 else ""
            yield _ImpossibleBody(holder, places[holder], others)


def _make_body(link: Link, pose: Transform | None) -> MassProperties | None:
    """Return the mass properties of a link in the frame of what holds it; None without a mass."""
    inertial = link.inertial
    if not inertial or not pose or not inertial.mass:
        return None
    placed = inertial.origin.placed_in(pose)
    return MassProperties(
        inertial.mass, placed.translation, turned(inertial.inertia, placed.rotation)
    )


def _is_possible(body: MassProperties) -> bool:
    """Return whether gz-math takes a mass and an inertia for those of a body; NaN counts as one."""
    smallest, middle, largest = principal_moments(body.inertia)
    slack = _ROUNDING + 1e-6 * abs(largest)
    is_wrong = smallest < -slack or largest > smallest + middle + slack
    return body.mass >= 0 and not is_wrong
