"""The problems that are found in a URDF while it is read, each with its location.

They are found in its elements and their values.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from math import nan
from typing import TypeVar

from grader.base.names import MAX_GUESSES, closest, did_you_mean
from grader.base.problems import NO_FIXES, Effect, Fix, Fixes, Kind, Problem
from grader.base.slips import Slip
from grader.base.source import LazyLocation
from grader.base.text import cut, quoted
from grader.base.transforms import FULL_TURN, Transform, Vector, rotation_from_quaternion
from grader.ros.urdf import urdf_problems
from grader.ros.urdf.model import Joint, Origin, UnresolvedPart, UnresolvedParts
from grader.ros.urdf.numbers import NumberError, number, quaternion, vector
from grader.ros.urdf.versions import WITH_CAPSULES, UrdfFormat, UrdfVersion, in_words
from grader.ros.xml.parsing import Element, XmlDocument
from grader.ros.xml.urdf_format import TAGS
from grader.ros.xml.xml_problems import RECOVERED

_FORMAT_DIRECTIVE = re.compile(r"%[-+ #0-9.$*'hlLqjzt]*n")  # %n, %1$n, %hhn
_MAX_PROBLEMS = 1000
NO_GUESSES = 0
_PRINTED = frozenset(
    {"origin", "box", "cylinder", "capsule", "sphere", "mass"}
)  # whose values urdfdom uses as printf's format
_OF_MISSING = (
    urdf_problems.UNKNOWN_LINK,
    urdf_problems.TWO_ROOTS,
    urdf_problems.NO_ROOT,
    urdf_problems.NO_LINKS,
    urdf_problems.MIMIC_TARGET,
    urdf_problems.CONTROLLED_JOINT,
)
_ZERO: Vector = (0.0, 0.0, 0.0)
_NOTHING: UnresolvedParts = {}

_FIRST_FORMAT = UrdfFormat()

_Value = TypeVar("_Value")


class Problems:
    """The problems of one file, and the locations of its elements."""

    def __init__(
        self,
        document: XmlDocument,
        root: Element,
        guesses: int = MAX_GUESSES,
        urdf_format: UrdfFormat = _FIRST_FORMAT,
    ) -> None:
        """`guesses` is how many names are compared with known ones."""
        self.format = urdf_format
        self.source = document.source
        self.root = root
        self.unresolved = document.unresolved
        self.is_broken = document.root is None  # whether tags in the text are broken
        self.rewrites = document.rewrites
        # the words for which ROS 2 rejects the file and that surely are others: tags and attributes
        self.undone: Mapping[tuple[Element, str | None], Fixes] = {}
        self.listed: list[Problem] = []
        self.effects: set[Effect] = set()
        self.unlisted = 0
        self._guesses = guesses
        self._elements = list(root.iter())
        self._indices = {element: index for index, element in enumerate(self._elements)}

    def location(self, element: Element) -> LazyLocation:
        """Return the location of an element, to be computed when it is needed."""
        return LazyLocation(self.source, self._indices[element])

    def parts(self, element: Element) -> UnresolvedParts:
        """Return what xacro left unresolved of a link, joint or material, by child tag.

        The key of an attribute is "@name".
        """
        if not self.unresolved:
            return _NOTHING
        parts: dict[str, UnresolvedPart] = {}
        for inner in element.iter():
            unresolved = self.unresolved.get(inner)
            if unresolved is None:
                continue
            above = inner
            while (
                above is not element
                and (parent := above.getparent()) is not element
                and parent is not None
            ):
                above = parent
            for name, reason in unresolved.attributes.items():
                key = f"@{name}" if inner is element else str(above.tag)
                parts.setdefault(
                    key, UnresolvedPart(reason, self.location(inner)._replace(attribute=name))
                )
            if unresolved.content is not None:
                key = "" if inner is element else str(above.tag)
                parts.setdefault(key, UnresolvedPart(unresolved.content, self.location(inner)))
        return parts

    def is_unresolved(self, element: Element) -> bool:
        """Return whether xacro left anything in an element unresolved."""
        return bool(self.unresolved) and any(inner in self.unresolved for inner in element.iter())

    def _explains(self, kind: Kind, element: Element, attribute: str | None) -> bool:
        """Return whether what xacro left unresolved explains a problem."""
        unresolved, of_root = self.unresolved.get(element), self.unresolved.get(self.root)
        if kind in _OF_MISSING and of_root is not None and of_root.content is not None:
            return True
        return unresolved is not None and (
            attribute in unresolved.attributes
            if attribute and element.get(attribute)
            else unresolved.content is not None
        )

    def line(self, element: Element) -> int:
        """Return the line of an element, counted from 1."""
        source, start = self.source.element(self._indices[element])
        return source.at(start).line

    def element(self, joint: Joint) -> Element:
        """Return the element that a joint was read from."""
        return self.root if joint.location is None else self._elements[joint.location.tag]

    def add(
        self,
        kind: Kind,
        message: str,
        element: Element,
        attribute: str | None = None,
        subject: str = "",
    ) -> None:
        """Add a problem at an element, unless xacro left that unresolved.

        The place is that of one of its attributes if it has it.
        """
        if self.unresolved and self._explains(kind, element, attribute):
            return
        self.effects.add(kind.effect)
        if len(self.listed) < _MAX_PROBLEMS:
            location = self.source.tag(self._indices[element], attribute)
            fixes = NO_FIXES
            if kind.effect == "rejects" or kind in urdf_problems.OF_SLIPS:
                fixes = Fixes(lambda: self._fixes_at(element, attribute))
            self.listed.append(Problem(kind, message, location, subject, fixes=fixes))
        else:
            self.unlisted += 1

    def ignores(self, element: Element, attribute: str, since: UrdfVersion) -> bool:
        """Return whether ROS 2 ignores an attribute, and add a problem then.

        It ignores one of a newer version than the file.
        """
        if self.format.version >= since:
            return False
        file_version = in_words(self.format.version)
        if self.format.warns:
            message = (
                f"ROS 2 ignores {attribute} in a file of version {file_version}: write "
                f'<robot version="{in_words(since)}">'
            )
            self.add(urdf_problems.NEWER_ATTRIBUTE, message, element, attribute)
        elif attribute == "quat_xyzw":
            message = (
                "ROS 2 ignores quat_xyzw, which turns nothing: write rpy (ROS 2 Lyrical reads it "
                f"in a file of version {in_words(since)})"
            )
            self.add(urdf_problems.IGNORED_QUATERNION, message, element, attribute)
        return True

    def _fixes_at(self, element: Element, attribute: str | None) -> Iterable[Fix]:
        """Return the fix of an element or an attribute that surely is another one."""
        if (element, attribute) in self.undone:
            return self.undone[element, attribute]
        slip = self._slips.get((element, attribute))
        return [slip.fix] if slip is not None else []

    @cached_property
    def _slips(self) -> Mapping[tuple[Element, str | None], Slip]:
        from grader.ros.urdf.robot_slips import RobotSlips  # late: few problems are fixed

        undone = {element for element, _ in self.undone}
        return RobotSlips(self.root, self.source, self.unresolved, undone).at_places()

    def assumed(
        self, element: Element, attribute: str | None, sentence: str, fixes: Fixes
    ) -> Problem:
        """Return what is assumed about a tag or an attribute for which ROS 2 rejects the file."""
        location = self.source.tag(self._indices[element], attribute)
        return Problem(RECOVERED, sentence, location, fixes=fixes)

    def duplicate(self, kind: Kind, element: Element, first: Element) -> None:
        """Add that an element has the name of an earlier one of its kind."""
        name = quoted(element.get("name") or "")
        message = (
            f"the {element.tag} {name} is already defined in line {self.line(first)}; ROS 2 "
            "rejects the file"
        )
        self.add(kind, message, element, "name")

    def closest(self, name: str, known: Iterable[str]) -> str | None:
        """Return the known name that is most like this one, if one is close."""
        self._guesses -= 1
        if self._guesses >= 0:
            return closest(name, known)
        return None

    def did_you_mean(self, name: str, known: Iterable[str]) -> str:
        """Return the end of a message: `; did you mean 'x'?`.

        Returns nothing if no known name is close.
        """
        self._guesses -= 1
        if self._guesses >= 0:
            return did_you_mean(name, known)
        return ""

    def check_printed(self, text: str, element: Element, attribute: str | None = None) -> None:
        """Add a problem if ROS 2 passes this text to printf and it can crash there.

        It can crash, as on Jazzy, if it contains a directive.
        """
        if self.format.warns:
            return
        if "%" in text and _FORMAT_DIRECTIVE.search(text):
            message = (
                "ROS 2 passes this value to printf as a format, where %n writes to memory: it "
                "can crash"
            )
            self.add(urdf_problems.FORMAT_DIRECTIVE, message, element, attribute)


class ElementReader:
    """Reads one element that ROS 2 keeps or loses as a whole.

    Every defect in it is a problem of one kind.

    A value that cannot be read is a problem and sets `failed`. A number is NaN then, any other
    value its default.
    """

    __slots__ = ("_consequence", "_kind", "_link", "_problems", "failed")

    def __init__(
        self,
        problems: Problems,
        kind: Kind,
        consequence: str = "ROS 2 rejects the file",
        link: str = "",
    ) -> None:
        """`consequence` says what ROS 2 does about a defect.

        The name of the `link` is put where it has {}.
        """
        self._problems = problems
        self._kind = kind
        self._consequence = consequence
        self._link = link
        self.failed = False

    def fail(self, reason: str, element: Element, attribute: str | None = None) -> None:
        """Add a problem: the element is lost."""
        self.failed = True
        consequence = self._consequence.format(quoted(self._link))
        self._problems.add(self._kind, f"{reason}; {consequence}", element, attribute, self._link)

    def number(self, element: Element, attribute: str) -> float:
        """Return an attribute's number, or its default if it is not given.

        It is a problem if the attribute has none.
        """
        if attribute in element.attrib:
            return self._value(element, attribute, number, nan)
        default = TAGS[element.tag].attributes[attribute].default
        if default is None:
            self.fail(f"<{element.tag}> has no {attribute}", element)
        return float(default or nan)

    def vector(self, element: Element, attribute: str, default: Vector = _ZERO) -> Vector:
        """Return an attribute's three numbers, or the default if it is not given."""
        return self._value(element, attribute, vector, default)

    def origin(self, element: Element | None) -> Origin:
        """Return an <origin>: the identity if there is none."""
        if element is None:
            return Origin()
        xyz = self._value(element, "xyz", vector, _ZERO)
        has_quaternion = "quat_xyzw" in element.attrib
        if has_quaternion and not self._problems.ignores(element, "quat_xyzw", WITH_CAPSULES):
            rpy = self._turn(element)
        else:
            rpy = self._value(element, "rpy", vector, _ZERO)
        if rpy != _ZERO and max(map(abs, rpy)) > FULL_TURN and not self.failed:
            angle = next(
                (angle for angle in rpy if abs(angle) > FULL_TURN and angle % 15 == 0), None
            )
            if angle is not None:
                message = (
                    f"rpy is in radians, and {angle:g} is more than a full turn: is it in degrees?"
                )
                self._problems.add(urdf_problems.DEGREES, message, element, "rpy")
        return Origin(xyz, rpy, self._problems.location(element))

    def _turn(self, element: Element) -> Vector:
        """Return the roll, pitch and yaw of a quaternion; a zero one turns nothing."""
        if "rpy" in element.attrib:
            self.fail("<origin> has both rpy and quat_xyzw", element, "quat_xyzw")
            return _ZERO
        value = self._value(element, "quat_xyzw", quaternion, (0.0, 0.0, 0.0, 1.0))
        return Transform(rotation_from_quaternion(value)).rpy

    def _value(
        self, element: Element, attribute: str, parse: Callable[[str], _Value], default: _Value
    ) -> _Value:
        text = element.get(attribute)
        if text is None:
            return default
        try:
            return parse(text)
        except NumberError as error:
            self.fail(
                f"cannot read {attribute}={quote_value(text)} of <{element.tag}>: {error}",
                element,
                attribute,
            )
            if element.tag in _PRINTED:
                self._problems.check_printed(text, element, attribute)
            return default


def first_children(element: Element) -> dict[str, Element]:
    """Return the first child of each name: urdfdom reads no other."""
    first: dict[str, Element] = {}
    for child in element:
        first.setdefault(child.tag, child)
    return first


def quote_value(text: str) -> str:
    """Return a value of the file between double quotes, cut where it is very long."""
    return f'"{cut(text, 60)}"'
