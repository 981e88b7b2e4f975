"""Read a URDF as a release of ROS 2 does, and report everything that is wrong with it.

Names that look misspelt are reported too.
"""

import os
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from posixpath import basename
from typing import Literal

from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.problems import NO_FIXES, Effect, Fixes, Problem, in_order
from grader.base.records import Named
from grader.base.source import Source
from grader.base.text import comment_spans, enumerated, quoted
from grader.files.limits import ROBOT_ENDINGS
from grader.files.reading import read_capped
from grader.ros.known.releases import Release
from grader.ros.urdf import urdf_problems
from grader.ros.urdf.diagnostics import Problems
from grader.ros.urdf.joint_reader import check_references, read_joint
from grader.ros.urdf.link_reader import Materials, read_link
from grader.ros.urdf.link_tree import check_tree
from grader.ros.urdf.model import Joint, Robot
from grader.ros.urdf.numbers import version_in
from grader.ros.urdf.versions import (
    FIRST,
    NEWEST,
    UrdfFormat,
    UrdfVersion,
    first_release,
    in_words,
    newest_version,
)
from grader.ros.xml.parsing import Element, Elements, Unresolved, XmlDocument, read_document
from grader.ros.xml.python_xml import python_xml_error
from grader.ros.xml.urdf_format import (
    ATTRIBUTES,
    CHILDREN,
    ELSEWHERE,
    OWNERS,
    PARTS,
    TAGS,
    numbers_in,
)
from grader.ros.xml.xml_problems import NOT_WELL_FORMED

Verdict = Literal["clean", "degraded", "rejected"]

_FATAL: frozenset[Effect] = frozenset({"rejects", "undetermined"})
_DROPPING = {
    urdf_problems.BAD_VISUAL,
    urdf_problems.BAD_COLLISION,
    urdf_problems.BAD_INERTIAL,
}
_XACRO = on_use(r"<xacro:|\$\{|\$\(")
# Correct names that urdfdom does not read: they are not misspellings.
_EXTENSIONS = frozenset(
    {"gazebo", "transmission", "hardwareInterface", "ros2_control", "sensor", "plugin"}
    | {"drake", "mujoco", "capsule", "verbose"}
)


class Reading(Named):
    """A URDF as a release of ROS 2 reads it: the verdict, the robot, and all that is wrong with it.

    `read_urdf` makes it of any text, and never raises; xacro is expanded before, in
    `grader.ros.xacro`. Checks get it as `urdf`, reports list its problems, and hints edit what it
    was read from.

    >>> text = '<robot name="r"><link name="base"/><joint name="j" type="fixed"/></robot>'
    >>> reading = read_urdf(text)
    >>> reading.verdict
    'rejected'
    >>> [link.name for link in reading.robot.links]
    ['base']
    >>> reading.problems[0].code, reading.problems[0].location.column
    ('URDF070', 36)
    """

    verdict: Verdict
    robot: Robot | None  # as much as could be read, also of a rejected file; None if nothing could
    problems: tuple[Problem, ...]  # in the order of the file
    source: Source  # the text that the places of problems and elements are in
    root: Element | None = None  # the <robot> that was read; None where the text is not XML
    unresolved: Mapping[Element, Unresolved] = {}  # what xacro leaves open
    recovered: Element | None = None  # the <robot> that was read where the text is not XML
    is_meant: bool = False  # whether ROS 2 would load the robot if its text were repaired
    fixes: Fixes = NO_FIXES  # of the words for which ROS 2 rejects the file

    @property
    def raw_xacro(self) -> Problem | None:
        """The problem of xacro that is loaded without xacro; None where it has none."""
        return next(
            (problem for problem in self.problems if problem.kind is urdf_problems.RAW_XACRO), None
        )

    @property
    def elements(self) -> Element | None:
        """The element that the robot was read from, also where the text is not XML."""
        if self.root is not None:
            return self.root
        return self.recovered

    @property
    def is_certain(self) -> bool:
        """Return whether the verdict is certain, although a part of the file may be unknown."""
        return not self.undetermined or any(
            problem.kind.effect == "rejects" for problem in self.problems
        )

    @property
    def needed_release(self) -> Release | None:
        """The first release of ROS 2 that reads its version of URDF, if Jazzy does not."""
        return None if self.root is None else first_release(self.root.get("version", ""))

    @property
    def undetermined(self) -> str:
        """Why the robot is not known completely; empty if it is."""
        return next(
            (problem.message for problem in self.problems if problem.kind.effect == "undetermined"),
            "",
        )


def read_urdf(
    source: bytes | str | os.PathLike[str],
    path: str = "robot.urdf",
    releases: Collection[Release] = (),
) -> Reading:
    """Read a URDF as ROS 2 does (urdfdom on TinyXML2).

    The verdict is `clean`; `degraded`, if content is dropped or links are omitted of the tree; or
    `rejected`. Every problem is reported, sorted by location.

    Args:
        source: The path of a file, or the text or bytes of one. A str that ends in `.urdf`,
            `.xacro` or `.xml` is a path. Xacro is not expanded.
        path: The name of the file in locations; default: that of `source`.
        releases: The releases of ROS 2 that the robot is for; default: Jazzy.

    Raises:
        GraderError: There is no file at the path, or it cannot be read. No text raises.

    >>> [link.name for link in read_urdf("rubrics/arm/arm.urdf").robot.links][:2]
    ['world', 'base_link']
    >>> read_urdf("<robot").verdict
    'rejected'
    """
    if isinstance(source, os.PathLike) or (
        isinstance(source, str) and source.endswith((*ROBOT_ENDINGS, ".xml"))
    ):
        path = os.fspath(source)
        source = read_capped(path)
    given = source.encode("utf-8", "surrogatepass") if isinstance(source, str) else source
    return read_robot(read_document(given, path), newest_version(releases))


def read_robot(document: XmlDocument, newest: UrdfVersion = FIRST) -> Reading:
    """Read a document as `read_urdf` does; its list of problems is extended."""
    root = document.root
    source = document.source
    listed = document.problems
    for content in (root, document.recovered):
        if content is not None and content.tag == "robot":
            return _read_content(document, content, newest)
    effects = {problem.kind.effect for problem in listed}
    if effects.isdisjoint(_FATAL):
        effects.add("rejects")
        message = "the file has no <robot> at its top level; ROS 2 rejects it"
        at = source.at(document.first_tag)
        if root is not None:
            message = (
                "the root of the file is "
                f"<{root.tag.rpartition('}')[2]}>, expected <robot>; ROS 2 rejects it"
            )
            at = source.tag(0)
        listed.append(Problem(urdf_problems.NO_ROBOT, message, at))
    return Reading(_verdict(effects), None, in_order(listed), source, root, document.unresolved)


def read_with_dropped(reading: Reading, releases: Iterable[Release]) -> Robot | None:
    """Return a robot with the elements that ROS 2 drops for values that are missing or unreadable.

    Reading such a value raises MissingElement. Returns None where nothing is dropped.
    """
    root = reading.elements
    kinds = {problem.kind for problem in reading.problems}
    is_refused = any(kind.is_before_ros for kind in kinds)
    if root is None or not reading.robot or not (is_refused or _DROPPING & kinds):
        return None
    is_expanded = reading.source.is_expanded
    document = XmlDocument(
        reading.root, reading.source, [], 0, reading.unresolved, is_expanded=is_expanded
    )
    newest = newest_version(list(releases))
    robot, _ = _read_robot(document, root, newest, keeps_dropped=True)
    return replace(reading.robot, links=robot.links)


def _read_content(document: XmlDocument, root: Element, newest: UrdfVersion) -> Reading:
    """Return what is read of a robot."""
    listed = document.problems
    robot, problems = _read_robot(document, root, newest)
    effects = {problem.kind.effect for problem in listed} | problems.effects
    robot_problems = problems.listed
    incomplete = _why_incomplete(document, robot) if effects.intersection(_FATAL) else ""
    is_meant = document.is_meant and "rejects" not in problems.effects
    if document.root is None:
        robot_problems = _problems_of_unbroken_lines(robot_problems, listed)
    listed += robot_problems
    if problems.unlisted:
        message = f"{problems.unlisted} more problems of this file are not listed"
        end = document.source.at(len(document.source.text))
        listed.append(Problem(urdf_problems.UNLISTED, message, end))
    verdict = _verdict(effects)
    if verdict == "rejected":
        is_open = not is_meant or "undetermined" in effects
        robot = replace(robot, rejected=is_open, incomplete=incomplete)
    elif not document.is_expanded:
        listed += _problems_for_python(document, robot)
    places = (document.source, document.root, document.unresolved, document.recovered)
    fixes = Fixes(problems.list_fixes) if verdict == "rejected" else NO_FIXES
    return Reading(verdict, robot, in_order(listed), *places, is_meant, fixes)


def _problems_of_unbroken_lines(
    problems: Iterable[Problem], reported: Sequence[Problem]
) -> list[Problem]:
    """Return problems of a robot in lines that have no problem yet, but no consequences.

    What a tag says is wrong also where another one is assumed to be closed.
    """
    lines = {problem.location.line for problem in reported}
    broken = {problem.location.line for problem in reported if problem.kind.severity == "error"}
    unbroken = []
    for problem in problems:
        hidden = broken if problem.kind in urdf_problems.OF_ATTRIBUTES else lines
        if not problem.kind.is_consequence and problem.location.line not in hidden:
            unbroken.append(problem)
    return unbroken


def _problems_for_python(document: XmlDocument, robot: Robot) -> Iterator[Problem]:
    """Yield that joint_state_publisher cannot read the file.

    This matters if the file has joints for which it publishes positions.
    """
    is_moving = any(joint.has_position for joint in robot.joints)
    error = python_xml_error(document.source.text) if is_moving else None
    if error is None:
        return
    reason, offset = error
    at = document.source.at(offset)
    same_line = (
        problem.subject
        for problem in document.problems
        if problem.location.line == at.line and problem.kind is NOT_WELL_FORMED
    )
    message = f"joint_state_publisher cannot read this file ({next(same_line, reason)})"
    message += ": in RViz no moving link has a transform"
    yield Problem(urdf_problems.NOT_FOR_PYTHON, message, at)


def _verdict(effects: Collection[Effect]) -> Verdict:
    if not _FATAL.isdisjoint(effects):
        return "rejected"
    return "degraded" if "drops" in effects else "clean"


def _read_robot(
    document: XmlDocument, root: Element, newest: UrdfVersion, *, keeps_dropped: bool = False
) -> tuple[Robot, Problems]:
    version = version_in(root.get("version", "1.0"))
    is_read = version is not None and FIRST <= version <= newest
    urdf_format = UrdfFormat(newest, version if is_read and version is not None else newest)
    problems = Problems(document, root, urdf_format, keeps_dropped=keeps_dropped)
    if root.get("name") is None:
        problems.add(
            urdf_problems.ROBOT_WITHOUT_NAME, "<robot> has no name; ROS 2 rejects the file", root
        )
    if not is_read:
        message = _refused_version(root.get("version", ""), version, newest)
        problems.add(urdf_problems.BAD_VERSION, message, root, "version")
    materials = Materials(problems)
    for element in root.iterchildren("material"):
        materials.define(element)
    links = {}
    elements: Elements = {}
    for element in root.iterchildren("link"):
        link = read_link(element, problems, materials)
        if link.name in links:
            problems.duplicate(urdf_problems.DUPLICATE_LINK, element, elements[link.name])
        else:
            links[link.name], elements[link.name] = link, element
    if not links:
        problems.add(
            urdf_problems.NO_LINKS, "the robot has no <link>; ROS 2 rejects the file", root
        )
    robot = Robot(
        root.get("name") or "",
        tuple(links.values()),
        _read_joints(root, problems),
        tuple(materials.known.values()),
    )
    problems.robot = robot
    check_references(robot, problems)
    check_tree(robot, elements, problems)
    _check_spelling(root, problems)
    _check_root_inertia(robot, elements, problems)
    if root is document.root:
        _check_text(problems, is_expanded=document.is_expanded)
    return robot, problems


def _refused_version(text: str, version: UrdfVersion | None, newest: UrdfVersion) -> str:
    """Return in words that a release does not read a version, and which it reads."""
    known = [in_words((1, minor)) for minor in range(newest[1] + 1)]
    why = "is not supported"
    if version is not None and newest < version <= NEWEST:
        why = "is supported by ROS 2 Lyrical and later"
    expected = enumerated(known, len(known), "or")
    return f'version="{text[:40]}" {why}, expected {expected}; ROS 2 rejects the file'


def _why_incomplete(document: XmlDocument, robot: Robot) -> str:
    """Return why there may be more links and joints than are known.

    The reason is unknown content, or that the name of one is unknown.
    """
    root = document.root if document.root is not None else document.recovered
    unresolved = document.unresolved.get(root) if root is not None else None
    if unresolved and unresolved.content:
        return unresolved.content
    parts_of_elements = [link.unresolved for link in robot.links]
    parts_of_elements += [joint.unresolved for joint in robot.joints]
    for parts in parts_of_elements:
        for key in ("@name", "parent", "child"):
            if key in parts and parts[key].reason:
                return parts[key].reason
    return ""


def _read_joints(root: Element, problems: Problems) -> tuple[Joint, ...]:
    joints = []
    elements: Elements = {}
    for element in root.iterchildren("joint"):
        joint = read_joint(element, problems)
        joints.append(joint)
        if (
            element.get("name") is not None
            and elements.setdefault(joint.name, element) is not element
        ):
            problems.duplicate(urdf_problems.DUPLICATE_JOINT, element, elements[joint.name])
    return tuple(joints)


def _check_root_inertia(robot: Robot, links: Elements, problems: Problems) -> None:
    children = {joint.child for joint in robot.joints}
    for link in robot.links:
        if link.inertial and link.name not in children:
            message = (
                f"the root link {quoted(link.name)} has an inertia: KDL ignores it, "
                "robot_state_publisher warns"
            )
            problems.add(
                urdf_problems.ROOT_INERTIA, message, next(links[link.name].iterchildren("inertial"))
            )


def find_xacro(text: str) -> int | None:
    """Return the offset of the first xacro in a text outside of comments.

    This is a tag, ${...} or $(...).
    """
    if "$" not in text and "xacro:" not in text:
        return None
    outside = 0  # where the text begins that is after the last comment
    for start, end in (*comment_spans(text), (len(text), len(text))):
        match = _XACRO.search(text, outside, start)
        if match:
            return match.start()
        outside = end
    return None


def _check_text(problems: Problems, *, is_expanded: bool) -> None:
    text = problems.source.text
    xacro = find_xacro(text) if not is_expanded else None
    if xacro is not None:
        from shlex import quote  # late: most files are no xacro

        name = basename(problems.source.path)
        message = (
            "this is xacro, which ROS 2 does not evaluate in a .urdf: run `ros2 run xacro "
            f"xacro {quote(name)}`"
        )
        problems.listed.append(Problem(urdf_problems.RAW_XACRO, message, problems.source.at(xacro)))
    for start, end in comment_spans(text):
        if text.find(": ", start, end) >= 0 or text.find("\t", start, end) >= 0:
            message = "this comment contains a colon and a space, or a tab"
            message += ": it can stop a launch file that passes the URDF as YAML"
            problems.listed.append(
                Problem(urdf_problems.COMMENT_TRAP, message, problems.source.at(start))
            )
            break


def _check_spelling(root: Element, problems: Problems) -> None:
    """Report misspelt names and repeated elements in what urdfdom reads.

    Extensions of other tools are skipped.
    """
    if not ATTRIBUTES["robot"].issuperset(root.keys()):
        _check_attributes(root, problems)
    waiting = [root]
    while waiting:
        element = waiting.pop()
        allowed = CHILDREN.get(element.tag, ())
        tags = []
        for child in element:
            tag = child.tag
            tags.append(tag)
            if tag in allowed:
                if not ATTRIBUTES[tag].issuperset(child.keys()):
                    _check_attributes(child, problems)
                if len(child):
                    waiting.append(child)
            else:
                _check_unread(child, element, allowed, problems)
        if (
            element is not root
            and len(tags) > 1
            and (len(set(tags)) < len(tags) or element.tag == "geometry")
        ):
            _check_repeated(element, tags, problems)


def _check_attributes(element: Element, problems: Problems) -> None:
    known = ATTRIBUTES[element.tag]
    given = list(map(str, element.keys()))
    missing = known - set(given)
    for name in given:
        if name in known or name.startswith("{"):
            continue
        meant = TAGS[element.tag].aliases.get(name) or problems.closest(name, missing)
        message = f"ROS 2 ignores the unknown attribute {quoted(name)} of <{element.tag}>"
        if meant:
            message += f"; did you mean {quoted(meant)}?"
            problems.add(urdf_problems.MISSPELT, message, element, name, str(element.tag))
        elif PARTS.get(name) and any(
            numbers_in(element.get(name) or "")
        ):  # a place that the student gives something
            owners = enumerated([f"<{tag}>" for tag in OWNERS[name]])
            problems.add(
                urdf_problems.MISSPELT,
                f"{message}: it belongs to {owners}",
                element,
                name,
                str(element.tag),
            )


def _check_unread(child: Element, parent: Element, allowed: Strings, problems: Problems) -> None:
    """Report an element that urdfdom does not read, unless it is in the place of an extension."""
    if child.tag not in _EXTENSIONS or (child.tag in ELSEWHERE and parent is not problems.root):
        _check_tag(child, parent.tag, allowed, problems)
    elif child.tag == "gazebo":
        for inner in child.iterchildren("ros2_control", "transmission"):
            _check_tag(inner, child.tag, (), problems)


def _check_tag(child: Element, parent: str, allowed: Strings, problems: Problems) -> None:
    if child.tag.startswith("{"):  # a prefix is not a misspelling
        return
    instead = ELSEWHERE.get(child.tag, "")
    meant = problems.closest(child.tag, allowed) if not instead else None
    if instead:
        message = f"<{child.tag}> in <{parent}> is ignored: {instead}"
    elif meant:
        message = f"ROS 2 ignores <{child.tag}> in <{parent}>; did you mean <{meant}>?"
    elif child.tag in ATTRIBUTES:
        message = f"ROS 2 ignores <{child.tag}> in <{parent}>: it does not belong there"
    else:
        return
    problems.add(urdf_problems.MISSPELT, message, child, subject=meant or str(child.tag))


def _check_repeated(element: Element, tags: list[str], problems: Problems) -> None:
    seen: set[str] = set()
    for child, tag in zip(element, tags, strict=True):
        if element.tag == "geometry" and seen:
            problems.add(
                urdf_problems.REPEATED_ELEMENT,
                "a <geometry> has one shape: ROS 2 reads only the first",
                child,
            )
        elif (
            tag in seen
            and tag in TAGS[element.tag].children
            and tag not in TAGS[element.tag].repeated
        ):
            message = f"<{tag}> is repeated in this <{element.tag}>: ROS 2 reads only the first"
            problems.add(urdf_problems.REPEATED_ELEMENT, message, child)
        seen.add(tag)
