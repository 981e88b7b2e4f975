"""Read a URDF as ROS 2 (Jazzy) does, and say everything that is wrong with it."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

from lxml import etree

from grader.problems import Problem
from grader.robot import catalogue
from grader.robot.diagnostics import Notes
from grader.robot.joints import read_joint
from grader.robot.links import read_link
from grader.robot.materials import Materials
from grader.robot.model import Joint, Link, Robot
from grader.robot.numbers import is_version_one
from grader.robot.spelling import check_spelling
from grader.robot.tree import check_tree
from grader.source import Source
from grader.text import quoted
from grader.xml import tinyxml2 as dialect
from grader.xml.parsing import Element, XMLSyntaxError, parse_xml

Verdict = Literal["clean", "degraded", "rejected"]

_XACRO = re.compile(r"<xacro:|\$\{|\$\(")


@dataclass(frozen=True, slots=True)
class Reading:
    """What ROS 2 makes of a URDF. `robot` holds what could be read, also of a rejected file; None where nothing could."""

    verdict: Verdict
    robot: Robot | None
    problems: tuple[Problem, ...]
    source: Source


def read_urdf(data: bytes, path: str = "robot.urdf") -> Reading:
    """Read the bytes of a URDF; `path` is only quoted in places.

    The verdict is ROS 2 Jazzy's (urdfdom on TinyXML2): `clean`; `degraded`, if content was dropped or links are left out
    of the tree; `rejected`. Every problem is reported, sorted by place. Never raises for any input.
    """
    text = data.decode("utf-8", "surrogateescape")
    body = dialect.without_mark(data)
    if dialect.is_plain(body):
        try:
            root = parse_xml(body)
        except XMLSyntaxError:
            pass
        else:
            return _read_plain(root, Source(path, text))
    return _read_dialect(text, path)


def _read_plain(root: Element, source: Source) -> Reading:
    notes = Notes(source, root)
    if root.tag != "robot":
        message = f"the file holds <{etree.QName(root).localname}>, no <robot>; ROS 2 loads nothing"
        return _judge(None, [Problem(catalogue.NO_ROBOT, message, source.tag(0))], source)
    robot = _read_robot(root, notes)
    return _judge(robot, notes.problems, source, notes)


def _read_dialect(text: str, path: str) -> Reading:
    scan = dialect.translate(text)
    source = Source(path, text, scan.offsets)
    problems = [Problem(each.kind, each.message, source.at(each.offset)) for each in scan.findings]
    if not scan.xml:
        if not any(problem.kind.effect == "rejects" for problem in problems):
            message = "there is no <robot> at the top level of the file; ROS 2 loads nothing"
            problems.append(Problem(catalogue.NO_ROBOT, message, source.at(scan.first_tag)))
        return _judge(None, problems, source)
    root = parse_xml(scan.xml)
    notes = Notes(source, root)
    robot = _read_robot(root, notes)
    return _judge(robot, problems + notes.problems, source, notes)


def _judge(robot: Robot | None, problems: list[Problem], source: Source, notes: Notes | None = None) -> Reading:
    effects = {problem.kind.effect for problem in problems}
    if notes is not None and notes.unlisted:
        effects |= notes.effects
        message = f"{notes.unlisted} more problems of this file are not listed"
        problems = [*problems, Problem(catalogue.UNLISTED, message, source.at(len(source.text)))]
    verdict: Verdict = "rejected" if "rejects" in effects else "degraded" if "drops" in effects else "clean"
    ordered = sorted(problems, key=lambda each: (each.location.line, each.location.column, each.code))
    if robot is not None and verdict == "rejected":
        robot = replace(robot, rejected=True)
    return Reading(verdict, robot, tuple(ordered), source)


def _read_robot(root: Element, notes: Notes) -> Robot:
    _check_robot(root, notes)
    materials = Materials(notes)
    for element in root.iterchildren("material"):
        materials.define(element)
    links: dict[str, tuple[Link, Element]] = {}
    for element in root.iterchildren("link"):
        link = read_link(element, notes, materials)
        if link.name in links:
            line = notes.location(links[link.name][1]).resolve().line
            message = f"there is a link {quoted(link.name)} already, in line {line}; ROS 2 loads nothing of the file"
            notes.add(catalogue.DUPLICATE_LINK, message, element, "name")
        else:
            links[link.name] = (link, element)
    if not links:
        notes.add(catalogue.NO_LINKS, "the robot has no <link>; ROS 2 loads nothing", root)
    joints = _read_joints(root, notes)
    robot = Robot(
        root.get("name") or "",
        tuple(link for link, _ in links.values()),
        joints,
        tuple(materials.known.values()),
    )
    link_elements = {name: element for name, (_, element) in links.items()}
    check_tree(robot, link_elements, notes)
    check_spelling(root, notes)
    _check_root_inertia(robot, link_elements, notes)
    _check_text(notes)
    return robot


def _read_joints(root: Element, notes: Notes) -> tuple[Joint, ...]:
    joints: list[Joint] = []
    seen: dict[str, Element] = {}
    for element in root.iterchildren("joint"):
        joint = read_joint(element, notes)
        joints.append(joint)
        if element.get("name") is None:
            continue
        if joint.name in seen:
            line = notes.location(seen[joint.name]).resolve().line
            message = f"there is a joint {quoted(joint.name)} already, in line {line}; ROS 2 loads nothing of the file"
            notes.add(catalogue.DUPLICATE_JOINT, message, element, "name")
        seen.setdefault(joint.name, element)
    return tuple(joints)


def _check_robot(root: Element, notes: Notes) -> None:
    if root.get("name") is None:
        notes.add(catalogue.ROBOT_WITHOUT_NAME, "<robot> has no name; ROS 2 loads nothing of the file", root)
    version = root.get("version")
    if version is not None and not is_version_one(version):
        message = f'version="{version[:40]}" is not one that ROS 2 knows (1.0); it loads nothing of the file'
        notes.add(catalogue.BAD_VERSION, message, root, "version")


def _check_root_inertia(robot: Robot, links: dict[str, Element], notes: Notes) -> None:
    children = {joint.child for joint in robot.joints}
    for link in robot.links:
        if link.inertial is not None and link.name not in children:
            message = (
                f"the root link {quoted(link.name)} has an inertia: robot_state_publisher warns, and KDL ignores it"
            )
            element = links[link.name]
            inertial = element.find("inertial")
            notes.add(catalogue.ROOT_INERTIA, message, element if inertial is None else inertial)


def _check_text(notes: Notes) -> None:
    text = notes.source.text
    at = notes.source.at
    comments = list(_comments(text)) if "<!--" in text else []
    if "$" in text or "xacro:" in text:
        xacro = _outside(_XACRO, text, comments)
        if xacro is not None:
            name = notes.source.path.rpartition("/")[2]
            message = (
                f"this is xacro, which ROS 2 does not evaluate in a .urdf: expand it (ros2 run xacro xacro {name})"
            )
            notes.problems.append(Problem(catalogue.RAW_XACRO, message, at(xacro)))
    for start, end in comments:
        if text.find(": ", start, end) >= 0 or text.find("\t", start, end) >= 0:
            message = (
                "a comment with a colon and a space, or a tab, can stop a launch file that passes the URDF as YAML"
            )
            notes.problems.append(Problem(catalogue.COMMENT_TRAP, message, at(start)))
            break


def _comments(text: str) -> Iterator[tuple[int, int]]:
    """Where each comment begins and ends."""
    start = text.find("<!--")
    while start >= 0 and (end := text.find("-->", start + 4)) >= 0:
        yield start, end
        start = text.find("<!--", end)


def _outside(pattern: re.Pattern[str], text: str, comments: list[tuple[int, int]]) -> int | None:
    """Where a pattern is first found outside comments."""
    position = 0
    for start, end in [*comments, (len(text), len(text))]:
        found = pattern.search(text, position, start)
        if found:
            return found.start()
        position = end
    return None
