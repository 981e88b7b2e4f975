"""A second reader of URDFs, written from urdfdom's rules: what ROS 2 makes of a text, with poses at any position."""

from collections.abc import Mapping
from typing import NamedTuple
from xml.etree import ElementTree as ET

import numpy as np

from tests.second_opinion.elements import (
    BLACK,
    LINE_BREAK,
    TYPES,
    Bad,
    Joint,
    Link,
    Matrix,
    Shape,
    Unclear,
    number,
    numbers,
    origin_of,
    read_inertial,
    read_shape,
    transform,
    turn,
)


class Placed(NamedTuple):
    """The root of a link, the joint without a direction above it, if any, and the pose in the frame of these."""

    root: str
    below: str
    pose: Matrix


class Robot:
    """What ROS 2 reads of a text; raises ET.ParseError for what is not XML, and Unclear."""

    def __init__(self, text: bytes) -> None:
        if LINE_BREAK.search(text):
            raise Unclear(
                "a line break in an attribute, which an XML parser reads as a space, and urdfdom does not"
            )
        root = ET.fromstring(text)
        self.loads = root.tag == "robot" and "name" in root.attrib
        self.links: dict[str, Link] = {}
        self.named: list[Joint] = []
        self.materials: dict[str, tuple[float, ...]] = {}
        for element in root.findall("material"):
            name = element.get("name", "")  # one without a name is dropped, with an error
            if name in self.materials:
                raise Unclear(name)
            self.materials[name] = self._colour(element) or BLACK
        for element in root.findall("link"):
            if element.get("name") in (None, *self.links):
                raise Unclear(element.get("name"))
            self.links[element.attrib["name"]] = self._link(element)
        for element in root.findall("joint"):
            self._add_joint(element)
        if not self.links:
            raise Unclear("no links")
        self._build()

    def _colour(self, material: ET.Element) -> tuple[float, ...] | None:
        """Return the colour that an element defines; None if it defines none, or one that is refused."""
        color = material.find("color")
        if color is not None and color.get("rgba") is not None:
            pieces = [piece for piece in color.attrib["rgba"].split(" ") if piece]
            try:
                values = [numbers(piece, 1)[0] for piece in pieces]
            except Bad:
                return None
            if not all(0 <= value <= 1 for value in values):
                return None
            return tuple(values) if len(values) == 4 else BLACK
        texture = material.find("texture")
        return BLACK if texture is not None and texture.get("filename") is not None else None

    def _link(self, element: ET.Element) -> Link:
        link = Link()
        try:
            if (inertial := element.find("inertial")) is not None:
                link.inertial = read_inertial(inertial)
            for visual in element.findall("visual"):
                shape, material = read_shape(visual), visual.find("material")
                if material is not None:
                    name = material.attrib["name"]
                    colour = self._colour(material)
                    if name and colour is not None:
                        self.materials.setdefault(name, colour)
                    shape.colour = self.materials.get(name) if name else colour
                link.visuals.append(shape)
            link.collisions = [shape for shape in self._until_bad(element.findall("collision"))]
        except (Bad, KeyError):
            pass  # what was read before stays
        return link

    def _until_bad(self, elements: list[ET.Element]) -> list[Shape]:
        found = []
        for element in elements:
            try:
                found.append(read_shape(element))
            except Bad:
                break
        return found

    def _add_joint(self, element: ET.Element) -> None:
        name, kind, limit = element.get("name"), element.get("type"), element.find("limit")
        ends = [
            end.get("link") for tag in ("parent", "child") if (end := element.find(tag)) is not None
        ]
        axis, mimic = element.find("axis"), element.find("mimic")
        if (
            kind not in TYPES
            or len(ends) != 2
            or None in ends
            or name in (None, *(joint.name for joint in self.named))
        ):
            raise Unclear(name)
        if name is None or (mimic is not None and mimic.get("joint") is None):
            raise Unclear(name)
        try:
            origin = origin_of(element)
            direction = [1.0, 0.0, 0.0]
            if axis is not None and kind not in ("fixed", "floating"):
                direction = (
                    numbers(axis.get("xyz"), 3) if axis.get("xyz") is not None else [0.0, 0.0, 0.0]
                )
            follows = None
            if mimic is not None:
                follows = (
                    mimic.attrib["joint"],
                    number(mimic, "multiplier", "1"),
                    number(mimic, "offset", "0"),
                )
        except Bad as error:
            raise Unclear(name) from error
        limits = None
        if limit is not None:
            try:
                limits = (
                    number(limit, "lower", "0"),
                    number(limit, "upper", "0"),
                    number(limit, "effort"),
                    number(limit, "velocity"),
                )
            except Bad:
                self.loads = False
        elif kind in ("revolute", "prismatic"):
            self.loads = False
        parent, child = str(ends[0]), str(ends[1])
        self.named.append(
            Joint(name, kind, parent, child, origin, np.array(direction), limits, follows)
        )

    def _build(self) -> None:
        """Find the parent joints, the roots, and the links of each tree from its root downward."""
        self.joints = [
            joint for joint in self.named if {joint.parent, joint.child} <= self.links.keys()
        ]
        self.parents: dict[str, Joint] = {}
        for joint in sorted(self.joints, key=lambda joint: joint.name.encode()):
            self.parents[joint.child] = joint
        roots = [name for name in self.links if name not in self.parents]
        self.loads = self.loads and len(roots) == 1 and self.joints == self.named
        if _has_cycle(self.joints):
            raise Unclear("a loop, which ROS 2 follows for ever")
        if not self.loads and len(self.parents) < len(self.joints):
            raise Unclear("a link with two parents")
        children: dict[str, list[Joint]] = {}
        for joint in self.parents.values():
            children.setdefault(joint.parent, []).append(joint)
        self.trees: dict[str, list[str]] = {}
        for root in roots:
            tree = [root]
            for link in tree:  # grows
                tree += [joint.child for joint in children.get(link, ())]
            self.trees[root] = tree
        if sum(map(len, self.trees.values())) < len(self.links):
            raise Unclear("a loop")

    def child(self, name: str) -> str:
        """Return the link below a joint; the empty text if there is no such joint."""
        return next((joint.child for joint in self.joints if joint.name == name), "")

    def poses(self, positions: Mapping[str, float]) -> dict[str, Placed]:
        """Return the place of every link."""
        found: dict[str, Placed] = {}
        by_name = {joint.name: joint for joint in self.joints}

        def position(joint: Joint | None, before: tuple[str, ...] = ()) -> float:
            """Return the given position, or that which follows from the leader's; a leader that is missing is at 0."""
            if (
                joint is None
                or joint.name in positions
                or joint.mimic is None
                or joint.name in before
            ):
                return positions.get(joint.name, 0.0) if joint is not None else 0.0
            leader, factor, offset = joint.mimic
            return factor * position(by_name.get(leader), (*before, joint.name)) + offset

        for root, tree in self.trees.items():
            found[root] = Placed(root, "", np.eye(4))
            for link in tree[1:]:
                joint = self.parents[link]
                above, moved = found[joint.parent], _moved(joint, position(joint))
                if moved is None:
                    found[link] = Placed(root, joint.name, np.eye(4))
                else:
                    found[link] = Placed(root, above.below, above.pose @ joint.origin @ moved)
        return found


def _has_cycle(joints: list[Joint]) -> bool:
    """Return whether some joints form a loop: they stay if joints are removed whose child has none below it."""
    left = joints
    while True:
        parents = {joint.parent for joint in left}
        kept = [joint for joint in left if joint.child in parents]
        if len(kept) == len(left):
            return bool(left)
        left = kept


def _moved(joint: Joint, position: float) -> Matrix | None:
    """Return how far a joint moves its child; None for an axis without a direction, where KDL's poses are NaN."""
    if joint.type in ("fixed", "floating"):
        return np.eye(4)
    length = np.linalg.norm(joint.axis)
    if length == 0:
        return None
    if joint.type == "planar":  # one number moves none
        return np.eye(4)
    if joint.type == "prismatic":
        return transform(np.eye(3), joint.axis / length * position)
    return transform(turn(joint.axis / length, position), [0, 0, 0]) if position else np.eye(4)
