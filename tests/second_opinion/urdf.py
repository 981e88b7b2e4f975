"""A second reader of URDFs, written from urdfdom's rules: what ROS 2 makes of a text, with poses at any position."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple
from xml.etree import ElementTree as ET

import numpy as np

Matrix = np.ndarray[Any, Any]
_NUMBER = re.compile(r"\s*[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?\Z")
_BREAK = re.compile(rb"""=\s*(?:"[^"<>]*[\t\r\n]|'[^'<>]*[\t\r\n])""")
_TYPES = ("fixed", "continuous", "revolute", "prismatic", "floating", "planar")
BLACK = (0.0, 0.0, 0.0, 1.0)


class Bad(ValueError):
    """The part of the text that is read is one that urdfdom refuses."""


class Unclear(Exception):
    """ROS 2 refuses the file in a way that leaves open which robot is meant, so only its loading can be compared."""


@dataclass
class Shape:
    """A shape with its pose in the frame of its link; the sizes of a cylinder are radius and length."""

    kind: str
    size: tuple[float, ...]
    pose: Matrix
    colour: tuple[float, ...] | None = None

    @property
    def volume(self) -> float:
        """The volume in cubic metres; a mesh, whose size is unknown, is larger than everything."""
        a = [abs(number) for number in self.size]
        return {
            "box": lambda: a[0] * a[1] * a[2],
            "cylinder": lambda: np.pi * a[0] ** 2 * a[1],
            "sphere": lambda: 4 / 3 * np.pi * a[0] ** 3,
            "mesh": lambda: np.inf,
        }[self.kind]()

    @property
    def radius(self) -> float:
        """The distance of the farthest point from the centre."""
        sizes = np.abs(self.size)
        radii = {"box": np.linalg.norm(sizes) / 2, "cylinder": np.hypot(sizes[0], sizes[-1] / 2), "sphere": sizes[0]}
        return float(radii[self.kind])

    @property
    def has_size(self) -> bool:
        """Whether it has an area: a box without height is a plate, a cylinder without length is a disc."""
        return self.size.count(0) < 2 if self.kind == "box" else self.size[0] != 0 or any(self.size) and self.kind == "mesh"


@dataclass
class Link:
    """The shapes and the inertia of a link: mass, centre of mass, tensor about it in the frame of the link."""

    visuals: list[Shape] = field(default_factory=list)
    collisions: list[Shape] = field(default_factory=list)
    inertial: tuple[float, Matrix, Matrix] | None = None


@dataclass
class Joint:
    """A joint; `limit` is lower, upper, effort and velocity."""

    name: str
    type: str
    parent: str
    child: str
    origin: Matrix
    axis: Matrix
    limit: tuple[float, ...] | None
    mimic: tuple[str, float, float] | None

    @property
    def is_mimic(self) -> bool:
        """Whether the joint follows another."""
        return self.mimic is not None


def numbers(text: str | None, count: int) -> list[float]:
    """Return the numbers of an attribute, split at spaces only."""
    pieces = [piece for piece in (text or "").split(" ") if piece]
    if len(pieces) != count or not all(map(_NUMBER.match, pieces)):
        raise Bad(text)
    found = [float(piece) for piece in pieces]
    if not np.all(np.isfinite(found)):
        raise Bad(text)
    return found


def number(element: ET.Element | None, name: str, default: str | None = None) -> float:
    """Return the one number of an attribute, which has no trailing space."""
    text = element.get(name, default) if element is not None else default
    if text is None or not _NUMBER.match(text) or not np.isfinite(float(text)):
        raise Bad(text)
    return float(text)


def rotation(roll: float, pitch: float, yaw: float) -> Matrix:
    """Return the rotation about the fixed axes x, then y, then z."""
    (a, b, c), (d, e, f) = np.cos((roll, pitch, yaw)), np.sin((roll, pitch, yaw))
    return np.array(
        [[b * c, d * e * c - a * f, a * e * c + d * f], [b * f, d * e * f + a * c, a * e * f - d * c], [-e, d * b, a * b]]
    )


def turn(axis: Matrix, angle: float) -> Matrix:
    """Return the rotation about a unit vector."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def transform(rotated: Matrix, moved: Matrix | list[float]) -> Matrix:
    """Return a rotation and a translation as one matrix."""
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = rotated, moved
    return found


def _origin(element: ET.Element) -> Matrix:
    origin = element.find("origin")
    if origin is None:
        return np.eye(4)
    xyz = numbers(origin.get("xyz", "0 0 0"), 3)
    rpy = numbers(origin.get("rpy", "0 0 0"), 3)
    return transform(rotation(*rpy), xyz)


def _shape(element: ET.Element) -> Shape:
    pose, geometry = _origin(element), element.find("geometry")
    if geometry is None or len(geometry) == 0:
        raise Bad("no geometry")
    form = geometry[0]
    match form.tag:
        case "box":
            size = numbers(form.get("size"), 3)
        case "cylinder":
            size = [number(form, "radius"), number(form, "length")]
        case "sphere":
            size = [number(form, "radius")]
        case "mesh" if form.get("filename") is not None:
            size = numbers(form.get("scale", "1 1 1"), 3)
        case _:
            raise Bad(form.tag)
    return Shape(form.tag, tuple(size), pose)


def _inertial(element: ET.Element) -> tuple[float, Matrix, Matrix]:
    pose, inertia = _origin(element), element.find("inertia")
    mass = number(element.find("mass"), "value")
    ixx, ixy, ixz, iyy, iyz, izz = (number(inertia, name) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    tensor = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    return mass, pose[:3, 3], pose[:3, :3] @ tensor @ pose[:3, :3].T


class Placed(NamedTuple):
    """The root of a link, the joint without a direction above it, if any, and the pose in the frame of these."""

    root: str
    below: str
    pose: Matrix


class Robot:
    """What ROS 2 reads of a text; raises ET.ParseError for what is not XML, and Unclear."""

    def __init__(self, text: bytes) -> None:
        if _BREAK.search(text):
            raise Unclear("a line break in an attribute, which an XML parser reads as a space, and urdfdom does not")
        root = ET.fromstring(text)
        self.loads = root.tag == "robot" and "name" in root.attrib
        self.links: dict[str, Link] = {}
        self.named: list[Joint] = []
        self.materials: dict[str, tuple[float, ...]] = {}
        for element in root.findall("material"):
            if element.get("name") in (None, *self.materials):
                raise Unclear(element.get("name"))
            self.materials[element.attrib["name"]] = self._colour(element) or BLACK
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
                link.inertial = _inertial(inertial)
            for visual in element.findall("visual"):
                shape, material = _shape(visual), visual.find("material")
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
                found.append(_shape(element))
            except Bad:
                break
        return found

    def _add_joint(self, element: ET.Element) -> None:
        name, kind, limit = element.get("name"), element.get("type"), element.find("limit")
        ends = [end.get("link") for tag in ("parent", "child") if (end := element.find(tag)) is not None]
        axis, mimic = element.find("axis"), element.find("mimic")
        try:
            if name is None or kind not in _TYPES or len(ends) != 2 or None in ends:
                raise Bad(name)
            if any(joint.name == name for joint in self.named):
                raise Bad(name)
            origin = _origin(element)
            direction = [1.0, 0.0, 0.0]
            if axis is not None and kind not in ("fixed", "floating"):
                direction = numbers(axis.get("xyz"), 3) if axis.get("xyz") is not None else [0.0, 0.0, 0.0]
            follows = None
            if mimic is not None:
                follows = (mimic.get("joint"), number(mimic, "multiplier", "1"), number(mimic, "offset", "0"))
                if follows[0] is None:
                    raise Bad(name)
        except Bad as error:
            raise Unclear(name) from error
        limits = None
        if limit is not None:
            try:
                limits = (number(limit, "lower", "0"), number(limit, "upper", "0"), number(limit, "effort"), number(limit, "velocity"))
            except Bad:
                self.loads = False
        elif kind in ("revolute", "prismatic"):
            self.loads = False
        parent, child = str(ends[0]), str(ends[1])
        self.named.append(Joint(name, kind, parent, child, origin, np.array(direction), limits, follows))

    def _build(self) -> None:
        """Find the parent joints, the roots, and the links of each tree from its root downward."""
        self.joints = [joint for joint in self.named if {joint.parent, joint.child} <= self.links.keys()]
        self.parents: dict[str, Joint] = {}
        for joint in sorted(self.joints, key=lambda joint: joint.name.encode()):
            self.parents[joint.child] = joint
        roots = [name for name in self.links if name not in self.parents]
        self.loads = self.loads and len(roots) == 1 and self.joints == self.named
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
            if joint is None or joint.name in positions or joint.mimic is None or joint.name in before:
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
