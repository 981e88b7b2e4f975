"""The parts of a URDF as urdfdom reads them: numbers, origins, shapes, inertia, joints."""

import re
from dataclasses import dataclass, field
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np

Matrix = Any  # numpy's arrays, whose shapes no type says
_NUMBER = re.compile(r"\s*[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?\Z")
LINE_BREAK = re.compile(rb"""=\s*(?:"[^"<>]*[\t\r\n]|'[^'<>]*[\t\r\n])""")
TYPES = ("fixed", "continuous", "revolute", "prismatic", "floating", "planar")
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
        radii = {
            "box": np.linalg.norm(sizes) / 2,
            "cylinder": np.hypot(sizes[0], sizes[-1] / 2),
            "sphere": sizes[0],
        }
        return float(radii[self.kind])

    @property
    def has_size(self) -> bool:
        """Whether it has an area: a box without height is a plate, a cylinder without length is a disc."""
        return (
            self.size.count(0) < 2
            if self.kind == "box"
            else self.size[0] != 0 or (any(self.size) and self.kind == "mesh")
        )


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
        [
            [b * c, d * e * c - a * f, a * e * c + d * f],
            [b * f, d * e * f + a * c, a * e * f - d * c],
            [-e, d * b, a * b],
        ]
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


def origin_of(element: ET.Element) -> Matrix:
    origin = element.find("origin")
    if origin is None:
        return np.eye(4)
    xyz = numbers(origin.get("xyz", "0 0 0"), 3)
    rpy = numbers(origin.get("rpy", "0 0 0"), 3)
    return transform(rotation(*rpy), xyz)


def read_shape(element: ET.Element) -> Shape:
    pose, geometry = origin_of(element), element.find("geometry")
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


def read_inertial(element: ET.Element) -> tuple[float, Matrix, Matrix]:
    pose, inertia = origin_of(element), element.find("inertia")
    mass = number(element.find("mass"), "value")
    ixx, ixy, ixz, iyy, iyz, izz = (
        number(inertia, name) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    )
    tensor = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    return mass, pose[:3, 3], pose[:3, :3] @ tensor @ pose[:3, :3].T
